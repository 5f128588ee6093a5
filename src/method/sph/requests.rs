//! Requested drops: their number, and those that wait for free space.

use std::slice::from_mut;

use super::plan::Release;
use crate::state::{Field, Per};

/// Numbers of a waiting drop: x and y of its centre [m], its velocity [m/s] and its temperature
/// [K].
const NUMBERS: usize = 6;

/// Part of a state that concerns drops on demand.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Requests {
    /// Number of drops requested so far.
    pub asked: f64,
    /// Waiting drops in the order of their requests, then zeros up to the largest number.
    pub waiting: Vec<[f64; NUMBERS]>,
}

impl Requests {
    /// No requests yet, with room for so many drops.
    pub fn none(most: usize) -> Self {
        Self { waiting: vec![[0.0; NUMBERS]; most], ..Self::default() }
    }

    pub fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let field = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| field(name, words, Per::Body, 1);
        let waits = "position [m], velocity [m/s] and temperature [K] of a waiting drop";
        vec![
            (body("asked", "drops asked for so far"), from_mut(&mut self.asked)),
            (field("waiting", waits, Per::Drop, NUMBERS), self.waiting.as_flattened_mut()),
        ]
    }

    /// Number of waiting drops, given the number of released ones.
    pub fn waiting(&self, released: f64) -> usize {
        ((self.asked - released) as usize).min(self.waiting.len())
    }

    /// Replaces the waiting drops.
    pub fn wait(&mut self, drops: &[Release]) {
        self.waiting.fill([0.0; NUMBERS]);
        for (place, drop) in self.waiting.iter_mut().zip(drops) {
            let ([x, y, _], [u, v, w]) = (drop.centre, drop.velocity);
            *place = [x, y, u, v, w, drop.temperature];
        }
    }

    /// The waiting drops, built from the expected one.
    pub fn drops(&self, released: f64, expected: &Release) -> Vec<Release> {
        let drop = |&[x, y, u, v, w, temperature]: &[f64; NUMBERS]| Release {
            centre: [x, y, expected.centre[2]],
            velocity: [u, v, w],
            temperature,
            ..*expected
        };
        self.waiting[..self.waiting(released)].iter().map(drop).collect()
    }
}
