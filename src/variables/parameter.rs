use super::{DropletConstant, Quantity};
use crate::material::{Properties, Property};
use crate::scene::{Body, FaceName, Layer, Scene};

/// A constant of the scene that may be set until initialisation ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parameter {
    Material {
        body: String,
        constant: MaterialConstant,
    },
    /// Of what some layers of a body are made of.
    LayerMaterial {
        body: String,
        layers: LayersOf,
        constant: MaterialConstant,
    },
    /// Of a layer, counted from 0, with the one above.
    ContactResistance {
        body: String,
        layer: usize,
    },
    InitialTemperature {
        body: String,
    },
    ConvectionCoefficient {
        body: String,
        face: FaceName,
    },
    Droplet {
        body: String,
        constant: DropletConstant,
    },
}

/// The layers of a body that share a material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LayersOf {
    /// All of a named one.
    Named(String),
    /// The one of this number, counted from 0, whose material has no name.
    Single(usize),
}

impl LayersOf {
    fn contains(&self, index: usize, layer: &Layer) -> bool {
        match self {
            Self::Named(name) => layer.material.name.as_ref() == Some(name),
            Self::Single(single) => *single == index,
        }
    }
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
    YieldStress,
}

impl MaterialConstant {
    pub const ALL: [MaterialConstant; 7] = [
        MaterialConstant::Density,
        MaterialConstant::SpecificHeat,
        MaterialConstant::Conductivity,
        MaterialConstant::Young,
        MaterialConstant::Poisson,
        MaterialConstant::Expansion,
        MaterialConstant::YieldStress,
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
            MaterialConstant::YieldStress => "yield_stress",
        }
    }

    /// Whether a material names the constant as a number.
    pub fn is_given(self, properties: &Properties) -> bool {
        let property = match self {
            MaterialConstant::Density => return true,
            MaterialConstant::SpecificHeat => Some(&properties.specific_heat),
            MaterialConstant::Conductivity => Some(&properties.conductivity),
            MaterialConstant::Young => properties.young.as_ref(),
            MaterialConstant::Poisson => properties.poisson.as_ref(),
            MaterialConstant::Expansion => properties.expansion.as_ref(),
            MaterialConstant::YieldStress => properties.yield_stress.as_ref(),
        };
        matches!(property, Some(Property::Constant(_)))
    }

    pub fn description(self) -> &'static str {
        match self {
            MaterialConstant::Density => "mass density",
            MaterialConstant::SpecificHeat => "specific heat capacity",
            MaterialConstant::Conductivity => "thermal conductivity",
            MaterialConstant::Young => "Young's modulus",
            MaterialConstant::Poisson => "Poisson's ratio",
            MaterialConstant::Expansion => "coefficient of linear thermal expansion",
            MaterialConstant::YieldStress => "yield stress",
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
            MaterialConstant::YieldStress => Quantity::Stress,
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
        let places = self.places(&mut copy);
        places.first().map_or(f64::NAN, |place| **place)
    }

    /// Puts a value into `scene`; whether it makes sense is for the scene's check to say.
    pub fn set(&self, scene: &mut Scene, value: f64) {
        if let Some(body) = scene.body.get_mut(self.body()) {
            self.places(body).into_iter().for_each(|place| *place = value);
        }
    }

    fn body(&self) -> &str {
        match self {
            Parameter::Material { body, .. }
            | Parameter::LayerMaterial { body, .. }
            | Parameter::ContactResistance { body, .. }
            | Parameter::InitialTemperature { body }
            | Parameter::ConvectionCoefficient { body, .. }
            | Parameter::Droplet { body, .. } => body,
        }
    }

    /// Where the value stands in its body: once, or in each of some layers.
    fn places<'a>(&self, body: &'a mut Body) -> Vec<&'a mut f64> {
        match (self, body) {
            (Parameter::InitialTemperature { .. }, body) => vec![body.initial_temperature_mut()],
            (Parameter::ConvectionCoefficient { face, .. }, Body::Solid(solid)) => {
                let face = solid.faces.get_mut(face).expect("registered from this very face");
                vec![&mut face.convection.as_mut().expect("registered as convective").coefficient]
            }
            (Parameter::Material { constant, .. }, Body::Solid(solid)) => {
                let own = solid.material.iter_mut();
                own.map(|choice| constant.place(choice.properties_mut())).collect()
            }
            (Parameter::LayerMaterial { layers, constant, .. }, Body::Solid(solid)) => {
                let all = solid.layers.iter_mut().flatten().enumerate();
                all.filter(|(i, layer)| layers.contains(*i, layer))
                    .map(|(_, layer)| constant.place(layer.material.properties_mut()))
                    .collect()
            }
            (Parameter::ContactResistance { layer, .. }, Body::Solid(solid)) => {
                let layer = solid.layers.iter_mut().flatten().nth(*layer);
                layer.and_then(|layer| layer.contact_resistance.as_mut()).into_iter().collect()
            }
            (Parameter::Droplet { constant, .. }, Body::Droplet(droplet)) => {
                vec![constant.place(droplet)]
            }
            _ => panic!("a parameter is registered from a body of its kind"),
        }
    }
}

impl MaterialConstant {
    fn place(self, properties: &mut Properties) -> &mut f64 {
        match self {
            MaterialConstant::Density => &mut properties.density,
            MaterialConstant::SpecificHeat => number(Some(&mut properties.specific_heat)),
            MaterialConstant::Conductivity => number(Some(&mut properties.conductivity)),
            MaterialConstant::Young => number(properties.young.as_mut()),
            MaterialConstant::Poisson => number(properties.poisson.as_mut()),
            MaterialConstant::Expansion => number(properties.expansion.as_mut()),
            MaterialConstant::YieldStress => number(properties.yield_stress.as_mut()),
        }
    }
}

/// A constant that may be left out or be a table; parameters are registered where it is a number.
fn number(constant: Option<&mut Property>) -> &mut f64 {
    match constant {
        Some(Property::Constant(value)) => value,
        _ => panic!("registered from a constant that is a number"),
    }
}
