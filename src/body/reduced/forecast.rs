//! What a reduced solid will cost.

use super::drives::Drives;
use super::store;
use super::values::{Kind, Values};
use crate::body::BodyForecast;
use crate::inputs::InputLayout;
use crate::scene::{Scene, footprints_along};

/// Time of a step and of reading what is offered beside the unknowns [s], and for each number that goes into them.
const STEP: f64 = 5e-7;
const NUMBER: f64 = 1e-9;
/// Time to clump a mode for an input and an output, and to balance and bound what is between these [s].
const CLUMPING: f64 = 1e-7;
const BALANCING: f64 = 8e-3;
/// Columns of the factor of a Gramian, about.
const RANK: f64 = 45.0;
/// Unknowns at the tolerance 1, and for each decimal that it is smaller, times the root of inputs.
const UNKNOWNS: [f64; 2] = [6.0, 4.0];

/// From what the full solid costs.
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
    // Each component of stress and displacement takes about what a reading of all stresses does.
    let modes = full.unknowns[0] as f64;
    let build_time = full.build_time
        + mechanical * full.step_time
        + (CLUMPING * modes + BALANCING) * inputs * outputs;
    // Where the reduction is held nothing of the full solid is built in this process.
    let memory = match known {
        Some(_) => 8.0 * (numbers + 2.0 * inputs * outputs),
        None => full.memory + 8.0 * (modes * inputs + 4.0 * RANK * RANK * inputs * outputs),
    };
    BodyForecast { memory, build_time, step_time, reduced, ..full }
}
