//! Positions of the cells of footprints.

use std::f64::consts::PI;

use super::types::Footprint;

/// The cells of a footprint about its centre, in the order of their values.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Inner and outer radius of each ring [m].
    Rings(Vec<[f64; 2]>),
    /// Middle of each tile along x and y, and the common size of all tiles [m].
    Tiles { middles: Vec<[f64; 2]>, size: [f64; 2] },
}

impl Footprint {
    /// Cells of a footprint about its centre; a round footprint has the outer radius `radius` [m].
    pub fn cells_about_centre(&self, radius: f64) -> Cells {
        match *self {
            Footprint::Disc { .. } | Footprint::Gaussian { .. } => {
                Cells::Rings(vec![[0.0, radius]])
            }
            Footprint::Ring { inner, outer } => {
                Cells::Rings(vec![[radius * (inner / outer), radius]])
            }
            Footprint::Rings { count, .. } => {
                let at = |i: usize| radius * (i as f64 / count as f64);
                Cells::Rings((0..count).map(|i| [at(i), at(i + 1)]).collect())
            }
            Footprint::Tiles { count, size } => {
                let middle = |axis: usize, i: usize| {
                    size[axis] * ((i as f64 + 0.5) / count[axis] as f64 - 0.5)
                };
                let [nx, ny] = count;
                let row = |i: usize| (0..ny).map(move |j| [middle(0, i), middle(1, j)]);
                let size = [size[0] / nx as f64, size[1] / ny as f64];
                Cells::Tiles { middles: (0..nx).flat_map(row).collect(), size }
            }
        }
    }

    /// Area of each cell [m²]: the integral of the value 1 on it; for a Gaussian spot `π R²/2`.
    pub fn areas(&self, radius: f64) -> Vec<f64> {
        let share = if let Footprint::Gaussian { .. } = self { 0.5 } else { 1.0 };
        match self.cells_about_centre(radius) {
            Cells::Rings(rings) => {
                let area =
                    |[inner, outer]: [f64; 2]| PI * (outer - inner) * (outer + inner) * share;
                rings.into_iter().map(area).collect()
            }
            Cells::Tiles { middles, size: [x, y] } => vec![x * y; middles.len()],
        }
    }
}
