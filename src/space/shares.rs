//! Volumes that nodes represent.

use super::{Mesh, Samples};

/// Part of the volume that each node represents: the integral of its function if all of these are positive, as they are
/// with linear bases on usual meshes, and otherwise the volume in proportion to the integral of its function's square.
///
/// Source of the latter: Hinton, Rock & Zienkiewicz (1976), Earthq. Eng. Struct. Dyn. 4, 245–249,
/// doi 10.1002/eqe.4290040305.
pub(super) fn shares(mesh: &Mesh, volume: &Samples) -> Vec<f64> {
    let integrals = |of: fn(f64) -> f64| {
        let mut sums = vec![0.0; mesh.nodes.len()];
        for point in 0..volume.len() {
            for value in volume.row(point) {
                sums[value.node as usize] += volume.weights[point] * of(value.value);
            }
        }
        sums
    };
    let shares = integrals(|value| value);
    if shares.iter().all(|&share| share > 0.0) {
        return shares;
    }
    let squares = integrals(|value| value * value);
    let factor = volume.weights.iter().sum::<f64>() / squares.iter().sum::<f64>();
    squares.iter().map(|square| factor * square).collect()
}
