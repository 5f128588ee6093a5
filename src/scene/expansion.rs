//! Mean coefficients of expansion of substances whose constants are those of one temperature.

use super::locate::Path;
use super::types::{Body, Scene};

impl Body {
    /// Temperature at which a solid is free of thermal stress [K]; `None` of other bodies.
    pub fn temperature_without_stress(&self) -> Option<f64> {
        match self {
            Body::Solid(solid) => Some(solid.temperature_without_stress()),
            Body::LargeStrain(solid) => Some(solid.initial_temperature),
            _ => None,
        }
    }
}

impl Scene {
    /// Gives each solid the mean coefficients from its own temperature without stress on, also of a material that it
    /// shares with others.
    pub(super) fn take_mean_expansions(&mut self) {
        for (name, body) in &mut self.body {
            let Some(free) = body.temperature_without_stress() else { continue };
            let own = Path::default().key("body").key(name);
            for (layer, choice) in body.materials_mut() {
                let place = layer.map_or(own.clone(), |layer| own.key("layers").index(layer));
                let table = match &choice.name {
                    Some(name) => Path::default().key("material").key(name),
                    None => place.key("material"),
                };
                let Some(named) = self.substances.iter_mut().find(|own| own.table == table) else {
                    continue;
                };
                let Some(mean) = named.mean_expansion_from(free) else { continue };
                if let Some(expansion) = choice.material_mut().number("expansion") {
                    *expansion = mean;
                    named.stress_free.insert(name.clone(), free);
                }
            }
        }
    }
}
