//! Errors of outputs, from the same experiments on coarser meshes.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use super::responses::{Responses, Watched};
use crate::quantity::Quantity;

/// Fraction of the largest range of a quantity over the body below which an output's own range does not count.
const FLOOR: f64 = 0.01;
/// Heat over what the body holds over its range of temperatures, below which it is the rounding of what cancels.
const CANCELLED: f64 = 1e-9;

/// Largest differences between the outputs of an experiment on two meshes [1], output by output, relative to their
/// ranges on the first mesh.
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

/// Scales of the errors of outputs in an experiment. A scale is the largest range, rest included, of the same quantity
/// at the same probe or over the same field, or a fraction of the largest range of the quantity anywhere, of temperatures
/// that of the body's mean included. A small component among others of its tensor, a cell among others of its field, or
/// the core of a body that cools at its surface, is therefore not compared with its own range.
pub fn scales(rows: &[Vec<f64>], watched: &[Watched]) -> Vec<f64> {
    let range = |place: usize| {
        let [low, high] = rows.iter().fold([watched[place].rest; 2], |[low, high], row| {
            [low.min(row[place]), high.max(row[place])]
        });
        high - low
    };
    let (mut of_group, mut of_quantity) = (HashMap::new(), HashMap::new());
    for (place, one) in watched.iter().enumerate() {
        let range = range(place);
        let widen = |widest: &mut f64| *widest = widest.max(range);
        widen(of_group.entry((one.group(), one.quantity)).or_insert(0.0));
        widen(of_quantity.entry(one.quantity).or_insert(0.0));
        if let Some(capacity) = one.capacity {
            let mean = range / capacity;
            let warmed = of_quantity.entry(Quantity::Temperature).or_insert(0.0);
            *warmed = warmed.max(mean);
        }
    }
    let capacity = watched.iter().filter_map(|one| one.capacity).fold(0.0, f64::max);
    let warmed = of_quantity.get(&Quantity::Temperature).copied().unwrap_or(0.0);
    let scale = |one: &Watched| {
        let largest = of_quantity[&one.quantity];
        match one.quantity {
            // Heat that left is compared with heat that entered; both may cancel to rounding.
            Quantity::Energy => largest.max(CANCELLED * capacity * warmed),
            quantity => of_group[&(one.group(), quantity)].max(FLOOR * largest),
        }
    };
    watched.iter().map(scale).collect()
}

/// Estimated relative errors of the outputs of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    pub outputs: Vec<OutputError>,
}

/// Error of an output over its range in the default experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutputError {
    pub name: String,
    /// Error due to elements along the surface [1].
    pub along: f64,
    /// Error due to elements through the thickness [1].
    pub through: f64,
}

impl OutputError {
    /// Sum of both.
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
