use crate::quantity::Quantity;
use crate::scene::Droplet;

/// A constant of a droplet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DropletConstant {
    Diameter,
    ImpactVelocity,
    Density,
    Viscosity,
    SpecificHeat,
    Conductivity,
    SurfaceTension,
    SoundSpeed,
}

impl DropletConstant {
    pub const ALL: [DropletConstant; 8] = [
        DropletConstant::Diameter,
        DropletConstant::ImpactVelocity,
        DropletConstant::Density,
        DropletConstant::Viscosity,
        DropletConstant::SpecificHeat,
        DropletConstant::Conductivity,
        DropletConstant::SurfaceTension,
        DropletConstant::SoundSpeed,
    ];

    /// Key in the scene and last part of the variable's name.
    pub fn key(self) -> &'static str {
        match self {
            DropletConstant::Diameter => "diameter",
            DropletConstant::ImpactVelocity => "impact_velocity",
            DropletConstant::Density => "density",
            DropletConstant::Viscosity => "viscosity",
            DropletConstant::SpecificHeat => "specific_heat",
            DropletConstant::Conductivity => "conductivity",
            DropletConstant::SurfaceTension => "surface_tension",
            DropletConstant::SoundSpeed => "sound_speed",
        }
    }

    pub(super) fn description(self) -> &'static str {
        match self {
            DropletConstant::Diameter => "diameter of a drop",
            DropletConstant::ImpactVelocity => "speed towards the wall at the release",
            DropletConstant::Density => "mass density at rest",
            DropletConstant::Viscosity => "dynamic viscosity",
            DropletConstant::SpecificHeat => "specific heat capacity",
            DropletConstant::Conductivity => "thermal conductivity",
            DropletConstant::SurfaceTension => "surface tension",
            DropletConstant::SoundSpeed => "speed of sound of the model",
        }
    }

    pub(super) fn quantity(self) -> Quantity {
        match self {
            DropletConstant::Diameter => Quantity::Length,
            DropletConstant::ImpactVelocity | DropletConstant::SoundSpeed => Quantity::Velocity,
            DropletConstant::Density => Quantity::Density,
            DropletConstant::Viscosity => Quantity::Viscosity,
            DropletConstant::SpecificHeat => Quantity::SpecificHeat,
            DropletConstant::Conductivity => Quantity::Conductivity,
            DropletConstant::SurfaceTension => Quantity::SurfaceTension,
        }
    }

    /// Where a droplet holds it; a speed of sound that the scene leaves out is put there first.
    pub(super) fn place(self, droplet: &mut Droplet) -> &mut f64 {
        let sound_speed = droplet.sound_speed();
        let fluid = &mut droplet.fluid;
        match self {
            DropletConstant::Diameter => &mut droplet.diameter,
            DropletConstant::ImpactVelocity => &mut droplet.impact_velocity,
            DropletConstant::Density => &mut fluid.density,
            DropletConstant::Viscosity => &mut fluid.viscosity,
            DropletConstant::SpecificHeat => &mut fluid.specific_heat,
            DropletConstant::Conductivity => &mut fluid.conductivity,
            DropletConstant::SurfaceTension => &mut fluid.surface_tension,
            DropletConstant::SoundSpeed => fluid.sound_speed.get_or_insert(sound_speed),
        }
    }
}
