//! What bodies can be asked for: each quantity stands once, in a table beside the body that has it.

use super::{droplet, reduced, reservoir, solid};
use crate::quantity::Quantity;
use crate::scene::{Body, Scene};

/// What a quantity is called and measured in, and which inputs it follows without delay.
#[derive(Debug, Clone, Copy)]
pub struct Descriptor {
    /// Last part of a variable's name.
    pub key: &'static str,
    pub words: &'static str,
    pub quantity: Quantity,
    pub direct: Direct,
}

/// Which inputs of its body a quantity follows at once. Heat takes time to move; prescribed temperatures and
/// tractions act immediately.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direct {
    /// None: it is summed up over steps, or the mean of the last one.
    Nothing,
    Temperatures,
    TemperaturesAndTractions,
}

/// A value of one body.
#[derive(Debug, Clone, PartialEq)]
pub enum Reading {
    /// Of a point; `quantity` is its place among the [point quantities](super::point_quantities), and `alone`
    /// whether the point is one of its own rather than of a grid.
    Point { quantity: usize, at: [f64; 3], alone: bool },
    /// Mean over a cell of the field at a place among the scene's; `quantity` as of a point.
    Mean { quantity: usize, field: usize, cell: usize },
    /// Of the whole body: its place among the [totals](totals) of the body.
    Total(usize),
    /// Of the running maximum of a number among those of the body. It is no part of the body's state but of the model's.
    Peak { which: usize, part: PeakPart },
    /// What the body's outputs err by: no part of its state either, but of what is known before time starts.
    Error,
    /// Of a cell of the wall below, or of what lies beyond its cells; `quantity` is the place among the
    /// [quantities of walls](super::wall_quantities).
    Cell { quantity: usize, cell: usize },
}

/// What is told of a running maximum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PeakPart {
    Value,
    /// When it was.
    Time,
    /// Where it was, along x, y or z.
    Along(usize),
}

/// The running maxima that are kept of a scene's body, in the order of their numbers.
pub fn peaks(scene: &Scene, name: &str) -> Vec<Descriptor> {
    scene.solid(name).map_or_else(Vec::new, solid::kept_peaks)
}

/// The totals that a scene's body offers, each with its place in the table of its kind.
pub fn totals(scene: &Scene, name: &str) -> Vec<(usize, Descriptor)> {
    match &scene.body[name] {
        Body::Solid(_) if scene.is_reduced(name) => reduced::offered_totals(scene, name),
        Body::Solid(solid) => solid::offered_totals(scene, (name, solid)),
        Body::Droplet(_) => droplet::offered_totals(scene, name),
        Body::Reservoir(_) => reservoir::offered_totals(),
    }
}
