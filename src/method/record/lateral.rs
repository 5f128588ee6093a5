//! Lateral heat conduction along a wall during a step, from heated cells to their neighbours.

use crate::port::WallCells;

/// Squared distance over `4at` beyond which the spread is neglected.
const REACH: f64 = 9.0;

/// Cells of a wall with the positions of their middles [m].
pub struct Lateral {
    places: Vec<[f64; 2]>,
    areas: Vec<f64>,
    /// Largest diffusivity of the solid below [m²/s].
    diffusivity: f64,
}

impl Lateral {
    pub fn of(cells: &WallCells, areas: &[f64], diffusivity: f64) -> Self {
        Self { places: cells.middles(), areas: areas.to_vec(), diffusivity }
    }

    /// Cells among which the heat of a cell spreads within a time [s]: the cell itself and its neighbours, with their
    /// shares. The shares sum to 1, including those of cells that received nothing.
    pub fn around(&self, cell: usize, time: f64) -> Vec<(usize, f64)> {
        let scale = 4.0 * self.diffusivity * time;
        let near = (0..self.places.len()).filter_map(|other| {
            let [x, y] = [0, 1].map(|axis| self.places[cell][axis] - self.places[other][axis]);
            let square = x * x + y * y;
            let is_near = other == cell || square < REACH * scale;
            is_near.then(|| {
                (other, self.areas[other] * (-square / scale.max(f64::MIN_POSITIVE)).exp())
            })
        });
        let near: Vec<(usize, f64)> = near.collect();
        let all: f64 = near.iter().map(|(_, share)| share).sum();
        near.into_iter().map(|(other, share)| (other, share / all)).collect()
    }
}
