//! What outputs err by, from the same experiments on coarser meshes.

use super::responses::{Responses, Watched};
use crate::quantity::Quantity;

/// Part of the largest range of a quantity over the body below which no output's own range counts.
const FLOOR: f64 = 0.01;

/// Largest differences between the outputs of an experiment on two meshes over their ranges [1], output by output:
/// the ranges are those on the first.
pub fn differences(on: &Responses, other: &Responses, watched: &[Watched]) -> Vec<f64> {
    let mut all = vec![0.0_f64; watched.len()];
    for (rows, others) in on.iter().zip(other) {
        let scales = scales(rows, watched);
        for (place, worst) in all.iter_mut().enumerate() {
            // At time zero prescribed temperatures have jumped and heat has not moved.
            let apart = rows.iter().zip(others).skip(1).map(|(a, b)| (a[place] - b[place]).abs());
            let apart = apart.fold(0.0, f64::max);
            if scales[place] > 0.0 {
                *worst = worst.max(apart / scales[place]);
            }
        }
    }
    all
}

/// What errors of outputs in an experiment are a part of: their ranges, rest included, or a part of the largest of
/// their quantity.
pub fn scales(rows: &[Vec<f64>], watched: &[Watched]) -> Vec<f64> {
    let range = |place: usize| {
        let [low, high] = rows.iter().fold([watched[place].rest; 2], |[low, high], row| {
            [low.min(row[place]), high.max(row[place])]
        });
        high - low
    };
    let ranges: Vec<f64> = (0..watched.len()).map(range).collect();
    let largest = |quantity: Quantity| {
        let alike = watched.iter().zip(&ranges).filter(|(one, _)| one.quantity == quantity);
        alike.map(|(_, range)| *range).fold(0.0, f64::max)
    };
    let floor = |one: &Watched| match one.quantity {
        // Heat that left is a part of what came.
        Quantity::Energy => largest(one.quantity),
        quantity => FLOOR * largest(quantity),
    };
    ranges.iter().zip(watched).map(|(range, one)| range.max(floor(one))).collect()
}

/// Estimated relative errors of the outputs of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    pub outputs: Vec<OutputError>,
}

/// What an output errs by, of its range over the default experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputError {
    pub name: String,
    /// By elements along the surface [1].
    pub along: f64,
    /// By elements through the thickness [1].
    pub through: f64,
}

impl OutputError {
    /// By both.
    pub fn total(&self) -> f64 {
        self.along + self.through
    }
}

impl Estimate {
    /// The largest error of any output.
    pub fn worst(&self) -> f64 {
        self.outputs.iter().map(OutputError::total).fold(0.0, f64::max)
    }

    /// The largest error along the surface (0) or through the thickness (1).
    pub fn worst_of(&self, way: usize) -> f64 {
        let part = |one: &OutputError| if way == 0 { one.along } else { one.through };
        self.outputs.iter().map(part).fold(0.0, f64::max)
    }
}
