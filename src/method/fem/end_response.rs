//! How the top or the bottom of a solid answers to heat, by its modes along z.

use faer::Mat;

use super::columns::DepthProblem;
use super::heat::{depth_ends, end_conditions};
use super::modes::AxisModes;
use super::plan::Plan;
use crate::math::separable::{Side, transform};

/// The answer of that end to an impulse of heat per area, uniform along it: `Σ g e^{−λt}`.
pub struct EndResponse {
    /// λ [1/s]
    pub rates: Vec<f64>,
    /// g [K m²/J]
    pub gains: Vec<f64>,
    /// What each mode adds to the temperature of the end from the temperatures of nodes along z: `modes × nodes`.
    projection: Mat<f64>,
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
            projection: projection(&end, &modes.shapes, &modes.mass),
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
            projection: projection(&end, &column.shapes, &depth.capacity),
        }
    }

    /// What each mode adds to the temperature of the end's nodes [K], mode after mode, from nodal temperatures of
    /// which a plane has `nx · ny`; empty for none.
    pub fn amplitudes(&self, temperatures: &[f64], [nx, ny]: [usize; 2]) -> Vec<f64> {
        if temperatures.is_empty() {
            return Vec::new();
        }
        let [x, y] = [nx, ny].map(|n| Mat::<f64>::identity(n, n));
        transform(temperatures, [&x, &y, &self.projection], Side::Direct)
    }
}

/// `e_m φ_mᵀ M`, e at the end, of mass-orthonormal modes.
fn projection(end: &[f64], shapes: &Mat<f64>, mass: &Mat<f64>) -> Mat<f64> {
    let nodes = shapes.nrows();
    let part = |m: usize, i: usize, k: usize| shapes[(i, m)] * mass[(i, k)];
    let projected = |m: usize, k: usize| (0..nodes).map(|i| part(m, i, k)).sum::<f64>();
    Mat::from_fn(end.len(), nodes, |m, k| end[m] * projected(m, k))
}
