//! The constants of droplets other than those of their fluid: a row for each.

use super::{Constant, OfferedConstant, fluid};
use crate::laws::AtStart;
use crate::quantity::Quantity;
use crate::scene::{Droplet, PressureAdvance};

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
            key: "sound_speed",
            description: "speed of sound of the model",
            quantity: Quantity::Velocity,
            start: AtStart::PoleAtZero,
            place: |droplet| {
                let chosen = droplet.sound_speed();
                Some(droplet.fluid.sound_speed.get_or_insert(chosen))
            },
        },
    ];

    /// The constant's place in a droplet. If the scene leaves out the speed of sound, it is filled in first.
    pub(super) fn place<'a>(&self, droplet: &'a mut Droplet) -> Option<&'a mut f64> {
        (self.place)(droplet)
    }
}

/// Keys tell constants apart.
impl PartialEq for DropletConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for DropletConstant {}

/// The constants of a droplet, with those of its fluid. Inputs set speed and temperature of drops on demand. Only
/// particles whose pressure is not solved have a speed of sound that may be set.
pub fn offered(body: &str, droplet: &Droplet) -> Vec<OfferedConstant> {
    let is_input = |key: &str| droplet.is_on_demand() && key == "impact_velocity";
    let has_sound = droplet.has_particles() && droplet.pressure == PressureAdvance::Explicit;
    let is_of_sound = |key: &str| !has_sound && key == "sound_speed";
    let offer = |constant: &'static DropletConstant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Droplet(constant),
    };
    let own = DropletConstant::ALL.iter();
    let own = own.filter(|constant| !is_input(constant.key) && !is_of_sound(constant.key));
    let (last, first): (Vec<_>, Vec<_>) = own.partition(|constant| constant.key == "sound_speed");
    let (of_fluid, of_law) = fluid::offered(body, &droplet.fluid);
    let temperature = (!droplet.is_on_demand()).then(|| OfferedConstant {
        key: "initial_temperature".to_owned(),
        description: format!("uniform temperature of {body} at the release"),
        constant: Constant::InitialTemperature,
    });
    let first = first.into_iter().map(offer).chain(of_fluid);
    first.chain(last.into_iter().map(offer)).chain(of_law).chain(temperature).collect()
}
