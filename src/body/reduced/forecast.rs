//! Cost of a reduced solid.

use super::drives::Drives;
use super::store;
use super::values::{Kind, Values};
use crate::body::BodyForecast;
use crate::body::solid::PARTS_OF_A_FOOTPRINT;
use crate::inputs::InputLayout;
use crate::scene::{Scene, footprints_along};

/// Time of a step with the readings other than unknowns [s], and time for each number involved.
const STEP: f64 = 5e-7;
const NUMBER: f64 = 1e-9;
/// Time to clump a mode for an input and an output, and to balance and bound a pair of these [s].
const CLUMPING: f64 = 1e-7;
const BALANCING: f64 = 8e-3;
/// Approximate number of columns of a Gramian's factor.
const RANK: f64 = 45.0;
/// Number of unknowns at the tolerance 1, and for each decimal of a smaller one, both times the root of the number of
/// inputs.
const UNKNOWNS: [f64; 2] = [6.0, 4.0];

/// Estimates the cost from that of the full solid.
pub fn forecast(scene: &Scene, name: &str, full: BodyForecast) -> BodyForecast {
    let drives = Drives::of(scene, &InputLayout::of(scene), name, footprints_along);
    let values = Values::of(scene, name);
    let is_mechanical = |kind: &Kind| matches!(kind, Kind::Stress | Kind::Displacement);
    let mechanical = values.kinds().filter(is_mechanical).count() as f64;
    let [inputs, outputs] = [drives.list.len(), values.list.len()].map(|count| count as f64);
    let known = store::held(scene, name);
    let order = known.as_ref().map_or_else(
        || {
            let decimals = -scene.fidelity.tolerance.log10();
            (UNKNOWNS[0] + UNKNOWNS[1] * decimals) * inputs.max(1.0).sqrt()
        },
        |known| known.system.order() as f64,
    );
    let numbers = order * (inputs + outputs) + outputs * inputs;
    let step_time = STEP + NUMBER * numbers;
    let reduced = Some(known.as_ref().map(|known| known.system.order()));
    // Each component of stress and displacement takes about as long as a reading of all stresses.
    let modes = full.unknowns[0] as f64;
    let build_time = full.build_time
        + mechanical * full.step_time
        + (CLUMPING * modes + BALANCING) * inputs * outputs;
    // If the reduction is held, nothing of the full solid is built in this process.
    let memory = match known {
        Some(_) => 8.0 * (numbers + 2.0 * inputs * outputs),
        None => full.memory + 8.0 * (modes * inputs + 4.0 * RANK * RANK * inputs * outputs),
    };
    let way_time = PARTS_OF_A_FOOTPRINT * step_time;
    BodyForecast { drawn: 0, memory, build_time, step_time, way_time, reduced, ..full }
}
