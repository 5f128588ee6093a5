//! The constants of droplets: a row for each.

use super::{Constant, OfferedConstant};
use crate::laws::AtStart;
use crate::quantity::Quantity;
use crate::scene::Droplet;

/// A constant of a droplet.
#[derive(Debug)]
pub struct DropletConstant {
    /// Key in the scene and last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    pub start: AtStart,
    place: fn(&mut Droplet) -> Option<&mut f64>,
}

impl DropletConstant {
    pub const ALL: &[Self] = &[
        Self {
            key: "diameter",
            description: "diameter of a drop",
            quantity: Quantity::Length,
            start: AtStart::PoleAtZero,
            place: |droplet| Some(&mut droplet.diameter),
        },
        Self {
            key: "impact_velocity",
            description: "speed towards the wall at the release",
            quantity: Quantity::Velocity,
            start: AtStart::Polynomial,
            place: |droplet| Some(&mut droplet.impact_velocity),
        },
        Self {
            key: "density",
            description: "mass density at rest",
            quantity: Quantity::Density,
            start: AtStart::PoleAtZero,
            place: |droplet| Some(&mut droplet.fluid.density),
        },
        Self {
            key: "viscosity",
            description: "dynamic viscosity",
            quantity: Quantity::Viscosity,
            start: AtStart::Never,
            place: |droplet| droplet.fluid.viscosity.number("viscosity"),
        },
        Self {
            key: "specific_heat",
            description: "specific heat capacity",
            quantity: Quantity::SpecificHeat,
            start: AtStart::Never,
            place: |droplet| Some(&mut droplet.fluid.specific_heat),
        },
        Self {
            key: "conductivity",
            description: "thermal conductivity",
            quantity: Quantity::Conductivity,
            start: AtStart::Never,
            place: |droplet| Some(&mut droplet.fluid.conductivity),
        },
        Self {
            key: "surface_tension",
            description: "surface tension",
            quantity: Quantity::SurfaceTension,
            start: AtStart::Never,
            place: |droplet| Some(&mut droplet.fluid.surface_tension),
        },
        Self {
            key: "heat_of_fusion",
            description: "latent heat of melting",
            quantity: Quantity::LatentHeat,
            start: AtStart::Never,
            place: |droplet| Some(&mut droplet.fluid.melting.as_mut()?.latent_heat),
        },
        Self {
            key: "frozen_specific_heat",
            description: "specific heat capacity of the frozen fluid",
            quantity: Quantity::SpecificHeat,
            start: AtStart::Never,
            place: |droplet| {
                let molten = droplet.fluid.specific_heat;
                let frozen = droplet.fluid.frozen.get_or_insert_default();
                Some(frozen.specific_heat.get_or_insert(molten))
            },
        },
        Self {
            key: "frozen_conductivity",
            description: "thermal conductivity of the frozen fluid",
            quantity: Quantity::Conductivity,
            start: AtStart::Never,
            place: |droplet| {
                let molten = droplet.fluid.conductivity;
                let frozen = droplet.fluid.frozen.get_or_insert_default();
                Some(frozen.conductivity.get_or_insert(molten))
            },
        },
        Self {
            key: "sound_speed",
            description: "speed of sound of the model",
            quantity: Quantity::Velocity,
            start: AtStart::Never,
            place: |droplet| {
                let chosen = droplet.sound_speed();
                Some(droplet.fluid.sound_speed.get_or_insert(chosen))
            },
        },
    ];

    /// The constant's place in a droplet; `None` where the scene sets no number. What the scene leaves out of
    /// the speed of sound and of the frozen fluid is filled in first.
    pub(super) fn place<'a>(&self, droplet: &'a mut Droplet) -> Option<&'a mut f64> {
        (self.place)(droplet)
    }
}

/// Keys of the constants that only fluids with `melting` have.
const OF_MELTING: [&str; 3] = ["heat_of_fusion", "frozen_specific_heat", "frozen_conductivity"];

/// Keys tell constants apart.
impl PartialEq for DropletConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for DropletConstant {}

/// The constants of a droplet, with those of its law of viscosity. Inputs set speed and temperature of drops on demand, and only particles have a speed of
/// sound.
pub fn offered(body: &str, droplet: &Droplet) -> Vec<OfferedConstant> {
    let is_input = |key: &str| droplet.is_on_demand() && key == "impact_velocity";
    let is_of_particles = |key: &str| !droplet.has_particles() && key == "sound_speed";
    let has_viscosity = droplet.fluid.viscosity.clone().number("viscosity").is_some();
    let is_of_law = |key: &str| !has_viscosity && key == "viscosity";
    let melts = droplet.fluid.melting.is_some();
    let is_of_melting = |key: &str| !melts && OF_MELTING.contains(&key);
    let is_offered = |key: &str| {
        !is_input(key) && !is_of_particles(key) && !is_of_law(key) && !is_of_melting(key)
    };
    let rows = DropletConstant::ALL.iter().filter(|constant| is_offered(constant.key));
    let own = rows.map(|constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Droplet(constant),
    });
    let of_law = droplet.fluid.viscosity.parameters().iter().map(|constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Material(constant),
    });
    let temperature = (!droplet.is_on_demand()).then(|| OfferedConstant {
        key: "initial_temperature".to_owned(),
        description: format!("uniform temperature of {body} at the release"),
        constant: Constant::InitialTemperature,
    });
    own.chain(of_law).chain(temperature).collect()
}
