//! Readings of bodies: each quantity is listed once, in a table beside the body that has it.

use super::{droplet, filament, large_strain, lattice, reduced, reservoir, solid};
use crate::quantity::Quantity;
use crate::scene::{Body, Flaw, Scene};

/// Name and unit of a quantity, and the inputs that it follows without delay.
#[derive(Debug, Clone, Copy)]
pub struct Descriptor {
    /// Last part of a variable's name.
    pub key: &'static str,
    pub words: &'static str,
    pub quantity: Quantity,
    pub direct: Direct,
}

/// Inputs of its body that a quantity follows without delay. Heat takes time to move; prescribed temperatures and
/// tractions act immediately.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direct {
    /// None: the quantity is a sum over steps, or the mean of the last step.
    Nothing,
    Temperatures,
    TemperaturesAndTractions,
    /// All inputs of the body itself.
    OwnInputs,
    /// All inputs of loads on the body and of its faces.
    Drives,
}

/// A value of one body.
#[derive(Debug, Clone, PartialEq)]
pub enum Reading {
    /// Value at a point. `quantity` is its place among the [point quantities](super::point_quantities); `alone` is true
    /// for a probe of its own and false for a point of a grid.
    Point { quantity: usize, at: [f64; 3], alone: bool },
    /// Mean over a cell of the field at a place among the scene's fields; `quantity` as for a point.
    Mean { quantity: usize, field: usize, cell: usize },
    /// Value of the whole body: its place among the [totals](totals) of the body.
    Total(usize),
    /// Value of a running maximum, by its number within the body. The maximum is part of the model's state, not of the
    /// body's.
    Peak { which: usize, part: PeakPart },
    /// Error estimate of the body's outputs. It is known before time starts and not part of the body's state.
    Error,
    /// Value of a flaw: its place among the scene's flaws, and that of the quantity among [those of
    /// flaws](flaw_quantities).
    Flaw { flaw: usize, quantity: usize },
    /// Value of a cell of the wall below, or of the region beyond its cells; `quantity` is its place among the
    /// [quantities of walls](super::wall_quantities).
    Cell { quantity: usize, cell: usize },
}

/// Parts of a running maximum that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PeakPart {
    Value,
    /// Time at which it occurred.
    Time,
    /// Position at which it occurred, along x, y or z.
    Along(usize),
}

/// Returns the running maxima of a scene's body, in the order of their numbers.
pub fn peaks(scene: &Scene, name: &str) -> Vec<Descriptor> {
    scene.solid(name).map_or_else(Vec::new, solid::kept_peaks)
}

/// Returns the quantities that a scene's flaw offers, each with its place among all.
pub fn flaw_quantities(flaw: &Flaw) -> Vec<(usize, Descriptor)> {
    solid::flaw_quantities(flaw)
}

/// Returns the inputs of a scene's body that a quantity at a point follows without delay.
pub fn direct_of_point(scene: &Scene, name: &str, quantity: usize) -> Direct {
    match &scene.body[name] {
        // Bodies in equilibrium follow their inputs at once, others in time.
        Body::LargeStrain(solid) if solid.inertia => Direct::Nothing,
        Body::LargeStrain(_) => Direct::OwnInputs,
        _ => solid::point_quantities()[quantity].descriptor.direct,
    }
}

/// Returns the totals that a scene's body offers, each with its place in the table of its kind.
pub fn totals(scene: &Scene, name: &str) -> Vec<(usize, Descriptor)> {
    match &scene.body[name] {
        Body::Solid(_) if scene.is_reduced(name) => reduced::offered_totals(scene, name),
        Body::Solid(solid) => solid::offered_totals(scene, (name, solid)),
        Body::Droplet(_) => droplet::offered_totals(scene, name),
        Body::Reservoir(_) => reservoir::offered_totals(),
        Body::Filament(own) => filament::offered_totals(scene, (name, own)),
        Body::Lattice(own) => lattice::offered_totals(own),
        Body::LargeStrain(solid) => {
            large_strain::offered_totals(solid, scene.coupling_from(name).is_some())
        }
    }
}
