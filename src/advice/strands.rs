//! Nozzles at unusual heights, targets beyond the plate, routes that run along themselves or beyond the run, and
//! strands of which nothing comes.

use super::retraced::{Laying, retraced};
use super::{Reviewer, number};
use crate::limits::two_digits;
use crate::scene::locate::Path;
use crate::scene::{Filament, Leg, Route, lateral_extents};
use crate::warning;

/// Usual heights of the outlet over its diameter.
const USUAL: [f64; 2] = [0.1, 10.0];
/// Relative difference of times that rounding may cause.
const ROUNDING: f64 = 1e-9;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, filament) in scene.filaments() {
        let path = Path::default().key("body").key(name);
        let route = scene.route(filament);
        height(reviewer, &path, (filament, route.as_ref()));
        if route.is_some() && !filament.path_sets_flow() && filament.nozzle.flow == 0.0 {
            reviewer.warn(&path.at("nozzle.flow"), warning::no_fluid_comes());
        }
        if let Some(route) = &route {
            course(reviewer, &path.key("path"), (filament, route));
        }
    }
    for (i, target) in scene.target.iter().enumerate() {
        let coupling = scene.coupling_from(&target.of).map(|place| &scene.coupling[place]);
        let below = coupling.and_then(|coupling| scene.solid_below(coupling));
        let Some((name, solid)) = below else { continue };
        let half = lateral_extents(&solid.shape).map(|extent| 0.5 * extent);
        let is_beyond = |place: &[f64; 2]| (0..2).any(|axis| place[axis].abs() > half[axis]);
        if target.line.iter().any(is_beyond) {
            let path = Path::default().key("target").index(i).key("line");
            reviewer.warn(&path, warning::target_beyond_plate(name));
        }
    }
}

/// Warns of a route that runs along itself without rising, or that lays fluid after the end of the run.
fn course(reviewer: &mut Reviewer, path: &Path, (filament, route): (&Filament, &Route)) {
    let nozzle = &filament.nozzle;
    let laying = Laying { diameter: nozzle.diameter, flow: nozzle.flow };
    if let Some([time, earlier]) = retraced(route, laying) {
        let finding = warning::strand_laid_along_itself(two_digits(time), two_digits(earlier));
        reviewer.warn(path, finding);
    }
    let stop = reviewer.scene.stop_time;
    let end = route.laid().map(Leg::stop).fold(0.0, f64::max);
    if end > stop * (1.0 + ROUNDING) {
        reviewer.warn(path, warning::route_outlasts_run(number(end), number(stop)));
    }
}

/// Warns of an outlet that is far above the plate, or almost on it, where fluid comes.
fn height(reviewer: &mut Reviewer, path: &Path, (filament, route): (&Filament, Option<&Route>)) {
    let own = filament.nozzle.height;
    let laid = route.into_iter().flat_map(Route::laid);
    let mut heights: Vec<f64> =
        laid.flat_map(|leg| [leg.place[0], leg.at(leg.duration)]).map(|place| place[2]).collect();
    if heights.is_empty() {
        heights.push(own);
    }
    let [low, high] = USUAL.map(|ratio| ratio * filament.nozzle.diameter);
    let unusual = heights.into_iter().find(|&height| height < low || height > high);
    if let Some(height) = unusual {
        let ratio = number(height / filament.nozzle.diameter);
        let key = if route.is_some() && height != own { "path" } else { "nozzle.height" };
        reviewer.warn(&path.at(key), warning::nozzle_height_unusual(number(height), ratio));
    }
}
