//! State of the heat in a body of large strain.

use std::slice::from_mut;

use crate::state::{Field, Per};

/// Temperatures of the nodes and heat that has passed. A body that conducts no heat has none of its fields.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Warmth {
    /// Rise of each node above the initial temperature [K].
    pub rise: Vec<f64>,
    /// The same that its stress has followed, where that lags behind [K].
    pub felt: Vec<f64>,
    /// Heat that fluxes have brought in, that has left through other faces, and to the body below [J].
    pub brought_in: f64,
    pub lost: f64,
    pub given: f64,
    /// Heat to each cell below in the last step [J].
    pub exchange: Vec<f64>,
    /// The same beyond the cells of a wall [J].
    pub outside: f64,
    /// Work of thermal stretches on the body [J].
    pub swelling: f64,
}

impl Warmth {
    pub fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        if self.rise.is_empty() {
            return Vec::new();
        }
        let of = |name, words, per| Field { name, words, per, width: 1 };
        vec![
            (of("rise", "temperature above the initial one [K]", Per::Node), &mut self.rise[..]),
            (of("felt", "the same that stress has followed [K]", Per::Node), &mut self.felt),
            (of("brought_in", "heat of fluxes [J]", Per::Body), from_mut(&mut self.brought_in)),
            (
                of("lost", "heat that has left through faces [J]", Per::Body),
                from_mut(&mut self.lost),
            ),
            (of("given", "heat to the body below [J]", Per::Body), from_mut(&mut self.given)),
            (of("warmed", "heat to cells in the last step [J]", Per::Cell), &mut self.exchange),
            (
                of("warmed_outside", "heat beyond the cells in the last step [J]", Per::Body),
                from_mut(&mut self.outside),
            ),
            (
                of("swelling", "work of thermal stretches [J]", Per::Body),
                from_mut(&mut self.swelling),
            ),
        ]
    }
}
