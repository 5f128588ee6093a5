//! Which constants of materials units offer as parameters: a row for each.

use super::{Properties, Property};
use crate::limits::Bounds;
use crate::quantity::Quantity;

/// A constant of materials that is a parameter of units where a scene gives it as a number.
#[derive(Debug)]
pub struct MaterialConstant {
    /// Key in the scene and last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    /// Declared least and largest value; the scene's own check also refuses the open ends.
    pub bounds: Bounds,
    pub start: AtStart,
    number: fn(&mut Properties) -> Option<&mut f64>,
}

/// How what a body shows at time zero, before heat has moved, follows a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AtStart {
    Never,
    /// Smoothly, but for a pole at zero.
    PoleAtZero,
    /// Smoothly between two poles.
    PolesAt([f64; 2]),
    /// As a polynomial of low degree.
    Polynomial,
}

const ABOVE_ZERO: Bounds = Bounds::from(0.0);

impl MaterialConstant {
    pub const ALL: &[Self] = &[
        Self {
            key: "density",
            description: "mass density",
            quantity: Quantity::Density,
            bounds: ABOVE_ZERO,
            start: AtStart::Never,
            number: |properties| Some(&mut properties.density),
        },
        Self {
            key: "specific_heat",
            description: "specific heat capacity",
            quantity: Quantity::SpecificHeat,
            bounds: ABOVE_ZERO,
            start: AtStart::Never,
            number: |properties| properties.specific_heat.number(),
        },
        Self {
            key: "conductivity",
            description: "thermal conductivity",
            quantity: Quantity::Conductivity,
            bounds: ABOVE_ZERO,
            start: AtStart::Never,
            number: |properties| properties.conductivity.number(),
        },
        Self {
            key: "young",
            description: "Young's modulus",
            quantity: Quantity::Modulus,
            bounds: ABOVE_ZERO,
            start: AtStart::PoleAtZero,
            number: |properties| properties.young.as_mut()?.number(),
        },
        Self {
            key: "poisson",
            description: "Poisson's ratio",
            quantity: Quantity::Ratio,
            bounds: Bounds::between(-1.0, 0.5),
            start: AtStart::PolesAt([-1.0, 0.5]),
            number: |properties| properties.poisson.as_mut()?.number(),
        },
        Self {
            key: "expansion",
            description: "coefficient of linear thermal expansion",
            quantity: Quantity::Expansion,
            bounds: Bounds { low: None, high: None },
            start: AtStart::Polynomial,
            number: |properties| properties.expansion.as_mut()?.number(),
        },
        Self {
            key: "yield_stress",
            description: "yield stress",
            quantity: Quantity::Stress,
            bounds: ABOVE_ZERO,
            start: AtStart::Never,
            number: |properties| properties.yield_stress.as_mut()?.number(),
        },
        Self {
            key: "isotropic_hardening",
            description: "growth of the yield stress per plastic strain",
            quantity: Quantity::Stress,
            bounds: ABOVE_ZERO,
            start: AtStart::Never,
            number: |properties| properties.isotropic_hardening.as_mut()?.number(),
        },
        Self {
            key: "kinematic_hardening",
            description: "motion of the middle of elasticity per plastic strain",
            quantity: Quantity::Stress,
            bounds: ABOVE_ZERO,
            start: AtStart::Never,
            number: |properties| properties.kinematic_hardening.as_mut()?.number(),
        },
    ];

    /// The constant with that key.
    pub fn named(key: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|constant| constant.key == key)
    }

    /// Whether a material names the constant as a number.
    pub fn is_given(&self, properties: &Properties) -> bool {
        (self.number)(&mut properties.clone()).is_some()
    }

    /// Where it stands in a material that names it as a number.
    pub fn place<'a>(&self, properties: &'a mut Properties) -> Option<&'a mut f64> {
        (self.number)(properties)
    }
}

/// Keys tell constants apart.
impl PartialEq for MaterialConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for MaterialConstant {}

impl Property {
    /// The number, unless it is a table.
    fn number(&mut self) -> Option<&mut f64> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Table(_) => None,
        }
    }
}
