//! Thermal response of the top or the bottom of a solid, by its modes along z.

use faer::Mat;

use super::columns::DepthProblem;
use super::heat::{depth_ends, end_conditions};
use super::modes::AxisModes;
use super::plan::Plan;

/// Response of that end to an impulse of heat per area, uniform along it: `Σ g e^{−λt}`.
pub struct EndResponse {
    /// λ [1/s]
    pub rates: Vec<f64>,
    /// g [K m²/J]
    pub gains: Vec<f64>,
    /// Weights of the temperatures of nodes along z: a row for the temperature of the end, and one for each mode's
    /// contribution to that.
    pub rows: Mat<f64>,
}

impl EndResponse {
    pub fn of(plan: &Plan, high: bool) -> Self {
        if plan.strata.len() > 1 {
            return Self::of_layers(plan, high);
        }
        let ends = end_conditions(&plan.thermal_faces, 2, plan.constants.conductivity);
        let modes = AxisModes::of(&plan.mesh.axes[2], ends);
        let capacity = plan.constants.heat_capacity();
        let end = modes.at_node(if high { modes.shapes.nrows() - 1 } else { 0 });
        let rate = |decay: &f64| plan.constants.conductivity / capacity * decay;
        Self {
            rates: modes.decay.iter().map(rate).collect(),
            gains: end.iter().map(|value| value * value / capacity).collect(),
            rows: rows(high, &end, &modes.shapes, &modes.mass),
        }
    }

    fn of_layers(plan: &Plan, high: bool) -> Self {
        let depth = DepthProblem::new(
            &plan.mesh,
            &plan.constants_of_layers(),
            depth_ends(&plan.thermal_faces),
        );
        let column = depth.column(0.0, true);
        let node = if high { column.shapes.nrows() - 1 } else { 0 };
        let end: Vec<f64> = (0..column.decay.len()).map(|k| column.shapes[(node, k)]).collect();
        Self {
            rates: column.decay,
            gains: end.iter().map(|value| value * value).collect(),
            rows: rows(high, &end, &column.shapes, &depth.capacity),
        }
    }
}

/// 1 at the end's node, then `e_m φ_mᵀ M` of mass-orthonormal modes with their values `e` at the end.
fn rows(high: bool, end: &[f64], shapes: &Mat<f64>, mass: &Mat<f64>) -> Mat<f64> {
    let nodes = shapes.nrows();
    let node = if high { nodes - 1 } else { 0 };
    let part = |m: usize, i: usize, k: usize| shapes[(i, m)] * mass[(i, k)];
    let projected = |m: usize, k: usize| (0..nodes).map(|i| part(m, i, k)).sum::<f64>();
    Mat::from_fn(1 + end.len(), nodes, |row, k| match row.checked_sub(1) {
        None => f64::from(u8::from(k == node)),
        Some(m) => end[m] * projected(m, k),
    })
}
