//! Constants of materials that units offer as parameters; laws list theirs in [`Part::parameters`].

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::{Brittleness, Conduction, Material, Part, PartVisitor, SolidLaw};
use crate::limits::Bounds;
use crate::quantity::Quantity;

/// A material constant that is a parameter of units if a scene sets it as a number.
#[derive(Debug)]
pub struct MaterialConstant {
    /// Key in the scene and last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    /// Declared least and largest value; the scene's own check also refuses the open ends.
    pub bounds: Bounds,
    pub start: AtStart,
}

/// Dependence of outputs at time zero, before heat has moved, on a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AtStart {
    Never,
    /// Smooth, except for a pole at zero.
    PoleAtZero,
    /// Smooth between two poles.
    PolesAt([f64; 2]),
    /// As a polynomial of low degree.
    Polynomial,
}

impl MaterialConstant {
    /// Bounds of constants that must be positive.
    pub const ABOVE_ZERO: Bounds = Bounds::from(0.0);

    /// The constants of all laws, each key once.
    pub fn all() -> Vec<&'static Self> {
        let mut found = Found(Vec::new());
        found.part::<Conduction>();
        SolidLaw::MODELS.iter().for_each(|model| SolidLaw::visit_parts(model, &mut found));
        found.part::<Brittleness>();
        found.0
    }

    /// Returns the constant with a key.
    pub fn named(key: &str) -> Option<&'static Self> {
        Self::all().into_iter().find(|constant| constant.key == key)
    }

    /// Returns true if a material names the constant as a number.
    pub fn is_given(&self, material: &Material) -> bool {
        self.place(&mut material.clone()).is_some()
    }

    /// Returns the constant's place in a material that sets it as a number.
    pub fn place<'a>(&self, material: &'a mut Material) -> Option<&'a mut f64> {
        material.number(self.key)
    }
}

struct Found(Vec<&'static MaterialConstant>);

impl PartVisitor for Found {
    fn part<P: Part + DeserializeOwned + JsonSchema>(&mut self) {
        let new = P::parameters().iter().filter(|own| self.0.iter().all(|known| known != own));
        let new: Vec<_> = new.collect();
        self.0.extend(new);
    }
}

/// Constants with equal keys are equal.
impl PartialEq for MaterialConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for MaterialConstant {}
