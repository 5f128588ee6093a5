//! The constants of fluids: a row for each, and those of laws of viscosity.

use super::{Constant, OfferedConstant};
use crate::laws::{AtStart, Fluid};
use crate::quantity::Quantity;

/// A constant of a fluid.
#[derive(Debug)]
pub struct FluidConstant {
    /// Key in the scene and last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    pub start: AtStart,
    place: fn(&mut Fluid) -> Option<&mut f64>,
}

impl FluidConstant {
    pub const ALL: &[Self] = &[
        Self {
            key: "density",
            description: "mass density at rest",
            quantity: Quantity::Density,
            start: AtStart::PoleAtZero,
            place: |fluid| Some(&mut fluid.density),
        },
        Self {
            key: "viscosity",
            description: "dynamic viscosity",
            quantity: Quantity::Viscosity,
            start: AtStart::Never,
            place: |fluid| fluid.viscosity.number("viscosity"),
        },
        Self {
            key: "specific_heat",
            description: "specific heat capacity",
            quantity: Quantity::SpecificHeat,
            start: AtStart::Never,
            place: |fluid| Some(&mut fluid.specific_heat),
        },
        Self {
            key: "conductivity",
            description: "thermal conductivity",
            quantity: Quantity::Conductivity,
            start: AtStart::Never,
            place: |fluid| Some(&mut fluid.conductivity),
        },
        Self {
            key: "surface_tension",
            description: "surface tension",
            quantity: Quantity::SurfaceTension,
            start: AtStart::PoleAtZero,
            place: |fluid| Some(&mut fluid.surface_tension),
        },
        Self {
            key: "heat_of_fusion",
            description: "latent heat of melting",
            quantity: Quantity::LatentHeat,
            start: AtStart::Never,
            place: |fluid| Some(&mut fluid.melting.as_mut()?.latent_heat),
        },
        Self {
            key: "frozen_specific_heat",
            description: "specific heat capacity of the frozen fluid",
            quantity: Quantity::SpecificHeat,
            start: AtStart::Never,
            place: |fluid| {
                let molten = fluid.specific_heat;
                let frozen = fluid.frozen.get_or_insert_default();
                Some(frozen.specific_heat.get_or_insert(molten))
            },
        },
        Self {
            key: "frozen_conductivity",
            description: "thermal conductivity of the frozen fluid",
            quantity: Quantity::Conductivity,
            start: AtStart::Never,
            place: |fluid| {
                let molten = fluid.conductivity;
                let frozen = fluid.frozen.get_or_insert_default();
                Some(frozen.conductivity.get_or_insert(molten))
            },
        },
    ];

    /// The constant's place in a fluid; `None` where the scene sets no number. What the scene leaves out of the frozen
    /// fluid is filled in first.
    pub(super) fn place<'a>(&self, fluid: &'a mut Fluid) -> Option<&'a mut f64> {
        (self.place)(fluid)
    }
}

/// Keys of the constants that only fluids with `melting` have.
const OF_MELTING: [&str; 3] = ["heat_of_fusion", "frozen_specific_heat", "frozen_conductivity"];

/// Keys tell constants apart.
impl PartialEq for FluidConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for FluidConstant {}

/// The constants of a fluid, and those of its law of viscosity.
pub fn offered(body: &str, fluid: &Fluid) -> (Vec<OfferedConstant>, Vec<OfferedConstant>) {
    let has_viscosity = fluid.viscosity.clone().number("viscosity").is_some();
    let is_offered = |key: &str| {
        (has_viscosity || key != "viscosity")
            && (fluid.melting.is_some() || !OF_MELTING.contains(&key))
    };
    let rows = FluidConstant::ALL.iter().filter(|constant| is_offered(constant.key));
    let own = rows.map(|constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Fluid(constant),
    });
    let of_law = fluid.viscosity.parameters().iter().map(|constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Material(constant),
    });
    (own.collect(), of_law.collect())
}
