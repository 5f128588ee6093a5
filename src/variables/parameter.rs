use super::DropletConstant;
use crate::laws::MaterialConstant;
use crate::scene::{Body, FaceName, Layer, Scene};

/// A constant of the scene that may be set until initialisation ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parameter {
    Material {
        body: String,
        constant: &'static MaterialConstant,
    },
    /// Of what some layers of a body are made of.
    LayerMaterial {
        body: String,
        layers: LayersOf,
        constant: &'static MaterialConstant,
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
        constant: &'static DropletConstant,
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
                own.filter_map(|choice| constant.place(choice.material_mut())).collect()
            }
            (Parameter::LayerMaterial { layers, constant, .. }, Body::Solid(solid)) => {
                let all = solid.layers.iter_mut().flatten().enumerate();
                all.filter(|(i, layer)| layers.contains(*i, layer))
                    .filter_map(|(_, layer)| constant.place(layer.material.material_mut()))
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
