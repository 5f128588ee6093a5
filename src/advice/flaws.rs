//! Flaws whose stress intensity the run or the theory misses.

use super::Reviewer;
use crate::limits::number;
use crate::quantity::percent;
use crate::scene::locate::Path;
use crate::scene::{Flaw, FlawShape, Solid};
use crate::warning;

/// Depth over diffusion length √(κt) at which a suddenly cooled edge crack has its highest stress intensity.
const WORST_DEPTH: f64 = 1.13;
/// Depth over the extent of the body behind it up to which the formula of a half plane holds: there a strip under
/// uniform tension has 6 % more.
const SHALLOW: f64 = 0.1;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, solid) in scene.solids() {
        let own = scene.flaw.iter().enumerate().filter(|(_, flaw)| flaw.body == name);
        for (i, flaw) in own {
            let path = Path::default().key("flaw").index(i);
            if solid.yields() {
                reviewer.warn(&path.key("in"), warning::flaw_in_yielding_body());
            }
            if let Some(depth) = flaw.depth.given() {
                peak(reviewer, &path, (flaw, depth), solid);
                deep(reviewer, &path, (flaw, depth), solid);
            }
        }
    }
}

/// Warns of steps in which the highest stress intensity after a shock comes and goes.
fn peak(reviewer: &mut Reviewer, path: &Path, (flaw, depth): (&Flaw, f64), solid: &Solid) {
    let Some(layer) = solid.strata().get(flaw.layer(solid)).copied() else { return };
    let time = (depth / WORST_DEPTH).powi(2) / layer.constants.diffusivity();
    let step = reviewer.scene.step;
    if step > time {
        let [step, time] = [step, time].map(|time| format!("{time:.1e}"));
        reviewer.warn(&path.key("depth"), warning::flaw_peak_missed(step, time));
    }
}

/// Warns of edge cracks that are deep compared with the body.
fn deep(reviewer: &mut Reviewer, path: &Path, (flaw, depth): (&Flaw, f64), solid: &Solid) {
    let is_edge = flaw.shape == FlawShape::Edge;
    let Some(face) = flaw.face(&solid.shape).filter(|_| is_edge) else { return };
    let part = depth / flaw.reach(solid, face);
    if part > SHALLOW {
        let most = number(SHALLOW * flaw.reach(solid, face));
        reviewer.warn(&path.key("depth"), warning::flaw_deep(percent(part), most));
    }
}
