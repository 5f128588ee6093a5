//! Constants of a scene as parameters of its unit.

use crate::scene::{Constant, FlawDepth, Scene};

/// A constant of a scene's body that may be set until initialisation ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    pub body: String,
    pub constant: Constant,
}

impl Parameter {
    /// The value that `scene` holds.
    pub fn get(&self, scene: &Scene) -> f64 {
        if let Constant::FlawDepth { flaw } = self.constant {
            return scene.flaw[flaw].depth.given().unwrap_or(f64::NAN);
        }
        // Reading uses the same place as writing, on a small copy.
        let mut copy = scene.body[&self.body].clone();
        let places = copy.places_of(&self.constant);
        places.first().map_or(f64::NAN, |place| **place)
    }

    /// Sets a value in `scene`; the scene's check decides whether it is valid.
    pub fn set(&self, scene: &mut Scene, value: f64) {
        if let Constant::FlawDepth { flaw } = self.constant {
            scene.flaw[flaw].depth = FlawDepth::Given(value);
            return;
        }
        if let Some(body) = scene.body.get_mut(&self.body) {
            body.places_of(&self.constant).into_iter().for_each(|place| *place = value);
        }
    }
}
