//! Flaws whose stress intensity the run or the theory misses.

use super::Reviewer;
use crate::limits::number;
use crate::quantity::percent;
use crate::scene::locate::Path;
use crate::scene::{Face, Flaw, FlawGives, FlawShape, Scene, Solid};
use crate::warning;

/// Depth over diffusion length √(κt) at which a suddenly cooled edge crack has its highest stress intensity.
const WORST_DEPTH: f64 = 1.13;
/// Biot number of the depth from which on convection is like a jump of the temperature.
const SUDDEN: f64 = 1.0;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, solid) in scene.solids() {
        let own = scene.flaw.iter().enumerate().filter(|(_, flaw)| flaw.body == name);
        for (i, flaw) in own {
            let path = Path::default().key("flaw").index(i);
            if solid.yields() {
                reviewer.warn(&path.key("in"), warning::flaw_in_yielding_body());
            }
            if solid.relaxes() && flaw.gives.contains(&FlawGives::EnergyReleaseRate) {
                reviewer.warn(&path.key("gives"), warning::flaw_in_relaxing_body());
            }
            on_symmetry(reviewer, &path, flaw, solid);
            let Some(depth) = flaw.depth.given() else { continue };
            if is_shocked(scene, (name, solid), depth) {
                peak(reviewer, &path, (flaw, depth), solid);
            }
            deep(reviewer, &path, (flaw, depth), solid);
            beside(reviewer, &path, flaw, solid);
        }
    }
}

/// Returns true if the surface temperature may jump, seen from a depth [m]: it is prescribed, or convection, a bath or
/// another body brings it about faster than heat reaches the depth.
pub(super) fn is_shocked(scene: &Scene, (name, solid): (&str, &Solid), depth: f64) -> bool {
    let conductivity = solid.strata().into_iter().map(|layer| layer.constants.conductivity);
    let conductivity = conductivity.fold(f64::INFINITY, f64::min);
    let is_strong = |coefficient: f64| coefficient * depth / conductivity > SUDDEN;
    let is_sudden = |face: &Face| {
        face.temperature.is_some() || face.convection.is_some_and(|own| is_strong(own.coefficient))
    };
    let is_dipped = solid.bath.is_some_and(|bath| is_strong(bath.coefficient));
    is_dipped || solid.faces.values().any(is_sudden) || scene.couplings_to(name).next().is_some()
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
    if part > Flaw::SHALLOW {
        let most = number(Flaw::SHALLOW * flaw.reach(solid, face));
        reviewer.warn(&path.key("depth"), warning::flaw_deep(percent(part), most));
    }
}

/// Warns of cracks near a face that is not the one of their mouth.
fn beside(reviewer: &mut Reviewer, path: &Path, flaw: &Flaw, solid: &Solid) {
    let Some((face, lengths)) = flaw.beside(solid) else { return };
    let [distance, free] = lengths.map(number);
    reviewer.warn(&path.key("at"), warning::flaw_near_face(face.as_str(), distance, free));
}

/// Warns of edge cracks that begin on a plane of symmetry.
fn on_symmetry(reviewer: &mut Reviewer, path: &Path, flaw: &Flaw, solid: &Solid) {
    let is_edge = flaw.shape == FlawShape::Edge;
    let face = flaw.face(&solid.shape).filter(|face| is_edge && solid.face(*face).roller);
    if let Some(face) = face {
        reviewer.warn(&path.key("at"), warning::flaw_on_symmetry(face.as_str()));
    }
}
