use super::{DropletConstant, Quantity};
use crate::material::Material;
use crate::scene::{Body, FaceName, Scene};

/// A constant of the scene that may be set until initialisation ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parameter {
    Material { body: String, constant: MaterialConstant },
    InitialTemperature { body: String },
    ConvectionCoefficient { body: String, face: FaceName },
    Droplet { body: String, constant: DropletConstant },
}

/// A constant of the thermo-elastic law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaterialConstant {
    Density,
    SpecificHeat,
    Conductivity,
    Young,
    Poisson,
    Expansion,
}

impl MaterialConstant {
    pub const ALL: [MaterialConstant; 6] = [
        MaterialConstant::Density,
        MaterialConstant::SpecificHeat,
        MaterialConstant::Conductivity,
        MaterialConstant::Young,
        MaterialConstant::Poisson,
        MaterialConstant::Expansion,
    ];

    /// Key in the scene and last part of the variable's name.
    pub fn key(self) -> &'static str {
        match self {
            MaterialConstant::Density => "density",
            MaterialConstant::SpecificHeat => "specific_heat",
            MaterialConstant::Conductivity => "conductivity",
            MaterialConstant::Young => "young",
            MaterialConstant::Poisson => "poisson",
            MaterialConstant::Expansion => "expansion",
        }
    }

    /// Whether a material names the constant.
    pub fn is_given(self, Material::Thermoelastic(constants): &Material) -> bool {
        match self {
            MaterialConstant::Young => constants.young.is_some(),
            MaterialConstant::Poisson => constants.poisson.is_some(),
            MaterialConstant::Expansion => constants.expansion.is_some(),
            _ => true,
        }
    }

    pub fn description(self) -> &'static str {
        match self {
            MaterialConstant::Density => "mass density",
            MaterialConstant::SpecificHeat => "specific heat capacity",
            MaterialConstant::Conductivity => "thermal conductivity",
            MaterialConstant::Young => "Young's modulus",
            MaterialConstant::Poisson => "Poisson's ratio",
            MaterialConstant::Expansion => "coefficient of linear thermal expansion",
        }
    }

    pub fn quantity(self) -> Quantity {
        match self {
            MaterialConstant::Density => Quantity::Density,
            MaterialConstant::SpecificHeat => Quantity::SpecificHeat,
            MaterialConstant::Conductivity => Quantity::Conductivity,
            MaterialConstant::Young => Quantity::Modulus,
            MaterialConstant::Poisson => Quantity::Ratio,
            MaterialConstant::Expansion => Quantity::Expansion,
        }
    }

    /// Declared bounds; the scene's own check also refuses the open ends.
    pub fn bounds(self) -> (Option<f64>, Option<f64>) {
        match self {
            MaterialConstant::Poisson => (Some(-1.0), Some(0.5)),
            MaterialConstant::Expansion => (None, None),
            _ => (Some(0.0), None),
        }
    }
}

impl Parameter {
    /// The value that `scene` holds.
    pub fn get(&self, scene: &Scene) -> f64 {
        // Reading goes through the same place as writing, on a copy that is small.
        let mut copy = scene.body[self.body()].clone();
        *self.place(&mut copy)
    }

    /// Puts a value into `scene`; whether it makes sense is for the scene's check to say.
    pub fn set(&self, scene: &mut Scene, value: f64) {
        if let Some(body) = scene.body.get_mut(self.body()) {
            *self.place(body) = value;
        }
    }

    fn body(&self) -> &str {
        match self {
            Parameter::Material { body, .. }
            | Parameter::InitialTemperature { body }
            | Parameter::ConvectionCoefficient { body, .. }
            | Parameter::Droplet { body, .. } => body,
        }
    }

    fn place<'a>(&self, body: &'a mut Body) -> &'a mut f64 {
        match (self, body) {
            (Parameter::InitialTemperature { .. }, Body::Solid(solid)) => {
                &mut solid.initial_temperature
            }
            (Parameter::InitialTemperature { .. }, Body::Droplet(droplet)) => {
                &mut droplet.initial_temperature
            }
            (Parameter::ConvectionCoefficient { face, .. }, Body::Solid(solid)) => {
                let face = solid.faces.get_mut(face).expect("registered from this very face");
                &mut face.convection.as_mut().expect("registered as convective").coefficient
            }
            (Parameter::Material { constant, .. }, Body::Solid(solid)) => {
                let Material::Thermoelastic(law) = &mut solid.material;
                match constant {
                    MaterialConstant::Density => &mut law.density,
                    MaterialConstant::SpecificHeat => &mut law.specific_heat,
                    MaterialConstant::Conductivity => &mut law.conductivity,
                    MaterialConstant::Young => given(&mut law.young),
                    MaterialConstant::Poisson => given(&mut law.poisson),
                    MaterialConstant::Expansion => given(&mut law.expansion),
                }
            }
            (Parameter::Droplet { constant, .. }, Body::Droplet(droplet)) => {
                constant.place(droplet)
            }
            _ => panic!("a parameter is registered from a body of its kind"),
        }
    }
}

/// A constant that may be left out; parameters are registered where it is not.
fn given(constant: &mut Option<f64>) -> &mut f64 {
    constant.as_mut().expect("registered from a constant that is given")
}
