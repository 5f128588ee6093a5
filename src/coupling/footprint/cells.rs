//! Nodal vector of the value 1 on each single cell of a footprint.

use super::{Pattern, Placement, disc, gaussian, outer, tile_strips};
use crate::method::mesh::Axis;
use crate::scene::{Footprint, Profile};

/// Entries of a vector that are not zero, with their places.
pub type SparseVector = Vec<(usize, f64)>;

/// Fraction of the largest entry below which entries are rounding errors of differences of discs.
const ROUNDING: f64 = 1e-13;

/// Nodal vectors `∫ N dA` over each cell (weighted with its profile on a Gaussian spot), on the face with axes `x` and
/// `y` (x fastest), of the footprint at the mirror image of each point.
pub fn cells_on_plane(
    [x, y]: [&Axis; 2],
    footprint: &Footprint,
    place: &Placement,
    image: [bool; 2],
) -> Vec<SparseVector> {
    let place = place.mirrored(image);
    let of_disc = |radius: f64| disc([x, y], &place, radius, Pattern::Scalar);
    match footprint.profile(place.radius, &unit(footprint, 0)) {
        Profile::Discs(_) => sums_of_discs(footprint, place.radius, of_disc),
        Profile::Gaussian(_) => {
            let along = |axis, centre| gaussian(axis, centre, place.radius);
            vec![sparse(&outer(&along(x, place.x), &along(y, place.y)))]
        }
        Profile::Tiles { count, size } => {
            let [columns, rows] = tile_strips([x, y], &place, count, size).map(|strips| {
                strips.iter().map(|strip| sparse(strip)).collect::<Vec<SparseVector>>()
            });
            tiles(&columns, &rows, x.len(), image)
        }
    }
}

/// Nodal vectors on the face with the radial axis of an axisymmetric body.
pub fn cells_on_radius(axis: &Axis, footprint: &Footprint, radius: f64) -> Vec<SparseVector> {
    match footprint.profile(radius, &unit(footprint, 0)) {
        Profile::Discs(_) => {
            sums_of_discs(footprint, radius, |radius| axis.integrate(0.0, radius, |_| 1.0))
        }
        Profile::Gaussian(_) => vec![sparse(&gaussian(axis, 0.0, radius))],
        // Scenes with tiles on a disc are refused.
        Profile::Tiles { .. } => Vec::new(),
    }
}

/// The value 1 on one cell alone.
fn unit(footprint: &Footprint, cell: usize) -> Vec<f64> {
    let mut values = vec![0.0; footprint.cell_count()];
    values[cell] = 1.0;
    values
}

/// Vectors of cells that are sums of discs; those of neighbours share a disc, which is integrated once.
fn sums_of_discs(
    footprint: &Footprint,
    radius: f64,
    of_disc: impl Fn(f64) -> Vec<f64>,
) -> Vec<SparseVector> {
    let mut known: Vec<(f64, Vec<f64>)> = Vec::new();
    let of_cell = |cell: usize| {
        let Profile::Discs(discs) = footprint.profile(radius, &unit(footprint, cell)) else {
            return Vec::new();
        };
        let mut sum: Vec<f64> = Vec::new();
        let vectors: Vec<(f64, Vec<f64>)> = discs
            .iter()
            .map(|&(radius, _)| match known.iter().position(|(other, _)| *other == radius) {
                Some(place) => known.swap_remove(place),
                None => (radius, of_disc(radius)),
            })
            .collect();
        for ((_, vector), (_, factor)) in vectors.iter().zip(&discs) {
            sum.resize(vector.len(), 0.0);
            sum.iter_mut().zip(vector).for_each(|(s, v)| *s += factor * v);
        }
        known = vectors;
        sparse(&sum)
    };
    (0..footprint.cell_count()).map(of_cell).collect()
}

/// Products of columns and rows, which are in reverse order in a mirror.
fn tiles(
    columns: &[SparseVector],
    rows: &[SparseVector],
    width: usize,
    image: [bool; 2],
) -> Vec<SparseVector> {
    let seen = |strips: &[SparseVector], i: usize, mirror: bool| {
        strips[if mirror { strips.len() - 1 - i } else { i }].clone()
    };
    let mut cells = Vec::with_capacity(columns.len() * rows.len());
    for i in 0..columns.len() {
        let column = seen(columns, i, image[0]);
        for j in 0..rows.len() {
            let row = seen(rows, j, image[1]);
            let products = row.iter().flat_map(|&(place, b)| {
                column.iter().map(move |&(along, a)| (along + width * place, a * b))
            });
            cells.push(products.collect());
        }
    }
    cells
}

fn sparse(vector: &[f64]) -> SparseVector {
    let least = ROUNDING * vector.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    vector.iter().copied().enumerate().filter(|(_, v)| v.abs() > least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::Weight;

    const FOOTPRINTS: [Footprint; 5] = [
        Footprint::Disc { radius: 0.3 },
        Footprint::Gaussian { radius: 0.05 },
        Footprint::Ring { inner: 0.1, outer: 0.3 },
        Footprint::Rings { count: 7, radius: 0.4 },
        Footprint::Tiles { count: [3, 5], size: [0.6, 0.4] },
    ];

    fn axis(order: usize) -> Axis {
        let ends = [-1.0, -0.6, -0.55, -0.1, 0.0, 0.03, 0.2, 0.7, 1.0];
        Axis::from_element_ends(&ends, order, Weight::Uniform)
    }

    /// Largest difference of `Σ value × cell` and the nodal vector of the load, over its largest entry.
    fn difference(cells: &[SparseVector], values: &[f64], load: &[f64]) -> f64 {
        let mut rest = load.to_vec();
        for (cell, value) in cells.iter().zip(values) {
            cell.iter().for_each(|&(node, weight)| rest[node] -= value * weight);
        }
        let most = |v: &[f64]| v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        most(&rest) / most(load)
    }

    fn values(footprint: &Footprint) -> Vec<f64> {
        (0..footprint.cell_count()).map(|i| 1.0 + (i as f64).sin()).collect()
    }

    #[test]
    fn cells_sum_to_the_load_with_their_values() {
        for order in [1, 2] {
            let x = axis(order);
            let y = Axis::from_element_ends(&[-0.9, -0.2, 0.0, 0.3, 0.8], order, Weight::Uniform);
            for footprint in FOOTPRINTS {
                let radius = footprint.radius().unwrap_or_default();
                let place = Placement { x: 0.11, y: -0.07, radius };
                for image in [[false, false], [true, false], [false, true], [true, true]] {
                    let cells = cells_on_plane([&x, &y], &footprint, &place, image);
                    let values = values(&footprint);
                    let load =
                        Pattern::Scalar.on_plane([&x, &y], &footprint, &place, &values, image);
                    let difference = difference(&cells, &values, &load);
                    assert!(difference < 1e-12, "{footprint:?} {image:?}: {difference}");
                }
            }
        }
    }

    #[test]
    fn cells_on_a_radius_sum_to_the_load_with_their_values() {
        let axis = Axis::from_element_ends(&[0.0, 0.07, 0.1, 0.5, 1.0], 2, Weight::Radial);
        for footprint in &FOOTPRINTS[..4] {
            let radius = footprint.radius().unwrap_or_default();
            let cells = cells_on_radius(&axis, footprint, radius);
            let values = values(footprint);
            let load = Pattern::Scalar.on_radius(&axis, footprint, radius, &values);
            assert!(difference(&cells, &values, &load) < 1e-12, "{footprint:?}");
        }
    }
}
