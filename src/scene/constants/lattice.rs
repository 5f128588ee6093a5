//! The constants of lattices: a row for each.

use super::{Constant, OfferedConstant};
use crate::laws::AtStart;
use crate::limits::Bounds;
use crate::quantity::Quantity;
use crate::scene::Lattice;

/// A constant of a lattice.
#[derive(Debug)]
pub struct LatticeConstant {
    /// Last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    pub bounds: Bounds,
    pub start: AtStart,
    place: fn(&mut Lattice) -> Option<&mut f64>,
}

impl LatticeConstant {
    pub const ALL: &[Self] = &[
        Self {
            key: "young",
            description: "Young's modulus",
            quantity: Quantity::Modulus,
            bounds: Bounds::from(0.0),
            start: AtStart::PoleAtZero,
            place: |lattice| Some(&mut lattice.material.young),
        },
        Self {
            key: "poisson",
            description: "Poisson's ratio",
            quantity: Quantity::Ratio,
            bounds: Bounds::between(-1.0, 1.0 / 3.0),
            start: AtStart::PolesAt([-1.0, 1.0 / 3.0]),
            place: |lattice| Some(&mut lattice.material.poisson),
        },
        Self {
            key: "strength",
            description: "tensile strength",
            quantity: Quantity::Stress,
            bounds: Bounds::from(0.0),
            start: AtStart::PoleAtZero,
            place: |lattice| lattice.material.softening.strength.as_mut(),
        },
        Self {
            key: "knee_opening",
            description: "opening of links at the knee of their softening",
            quantity: Quantity::Length,
            bounds: Bounds::from(0.0),
            start: AtStart::PoleAtZero,
            place: |lattice| lattice.material.softening.openings.as_mut().map(|own| &mut own[0]),
        },
        Self {
            key: "end_opening",
            description: "opening of links without force",
            quantity: Quantity::Length,
            bounds: Bounds::from(0.0),
            start: AtStart::PoleAtZero,
            place: |lattice| lattice.material.softening.openings.as_mut().map(|own| &mut own[1]),
        },
        Self {
            key: "thickness",
            description: "extent across the plane",
            quantity: Quantity::Length,
            bounds: Bounds::from(0.0),
            start: AtStart::PoleAtZero,
            place: |lattice| Some(&mut lattice.thickness),
        },
    ];

    /// The constant's place in a lattice; `None` where the scene sets no number.
    pub(super) fn place<'a>(&self, lattice: &'a mut Lattice) -> Option<&'a mut f64> {
        (self.place)(lattice)
    }
}

/// Constants of one key are equal.
impl PartialEq for LatticeConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for LatticeConstant {}

/// The constants of a lattice.
pub fn offered(body: &str, lattice: &Lattice) -> Vec<OfferedConstant> {
    let is_offered = |constant: &&LatticeConstant| constant.place(&mut lattice.clone()).is_some();
    let own = LatticeConstant::ALL.iter().filter(is_offered).map(|constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Lattice(constant),
    });
    own.collect()
}
