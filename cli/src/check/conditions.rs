//! Tables of what acts on a scene's bodies: faces, loads, walls, couplings.

use impinge::scene::{Coupling, Face, Load, Scene, Wall};
use impinge::variables::Quantity;

use super::words::{key, keys, metres};
use crate::table::table;
use crate::units::{engineering, kelvin};

pub fn faces(scene: &Scene) -> String {
    let mut rows = Vec::new();
    for (body, solid) in scene.solids() {
        for (face, condition) in &solid.faces {
            let name = format!("{body}.{}", key(face));
            rows.push([name, thermal(condition), mechanical(condition).into()]);
        }
    }
    for (body, solid) in scene.large_strains() {
        for (face, condition) in &solid.faces {
            let conditions = condition.conditions();
            let words = if conditions.is_empty() { "free".into() } else { conditions.join(", ") };
            rows.push([format!("{body}.{}", key(face)), thermal(&condition.heated()), words]);
        }
    }
    table(["face", "thermal", "mechanical"], &rows)
}

pub fn loads(scene: &Scene) -> String {
    let row = |load: &Load| {
        [load.name.clone(), load.on.clone(), load.footprint.label(metres), keys(&load.carries)]
    };
    let rows: Vec<_> = scene.load.iter().map(row).collect();
    table(["load", "on", "footprint", "carries"], &rows)
}

pub fn walls(scene: &Scene) -> String {
    let row = |wall: &Wall| [wall.name.clone(), wall.under.clone(), wall.footprint.label(metres)];
    let rows: Vec<_> = scene.wall.iter().map(row).collect();
    table(["wall", "under", "cells"], &rows)
}

pub fn couplings(scene: &Scene) -> String {
    let row = |coupling: &Coupling| {
        let carried = match (coupling.conductance, coupling.traction) {
            (Some(conductance), _) => {
                format!(
                    "heat, {}",
                    engineering(conductance, Quantity::HeatTransferCoefficient.unit())
                )
            }
            (None, _) if scene.large_strain(&coupling.from).is_some() => "pressure".to_owned(),
            (None, true) => "heat, pressure, shear".to_owned(),
            (None, false) => "heat".to_owned(),
        };
        [coupling.from.clone(), coupling.to.clone(), carried]
    };
    let rows: Vec<_> = scene.coupling.iter().map(row).collect();
    table(["from", "to", "carries"], &rows)
}

/// Thermal conditions of a face; radiation may act beside a flux or convection.
pub fn thermal(face: &Face) -> String {
    let temperature = face.temperature.map(kelvin);
    let convection = face.convection.map(|convection| {
        format!("convection, {} W/(m² K) to {}", convection.coefficient, kelvin(convection.ambient))
    });
    let flux = face.flux.map(|flux| format!("flux {}", engineering(flux, "W/m²")));
    let radiation = face.radiation.map(|radiation| {
        format!("radiation, emissivity {} to {}", radiation.emissivity, kelvin(radiation.ambient))
    });
    let conditions = [temperature, convection, flux, radiation].into_iter().flatten();
    let words: Vec<String> = conditions.collect();
    if words.is_empty() { "insulated".into() } else { words.join("; ") }
}

pub fn mechanical(face: &Face) -> &'static str {
    match (face.clamped, face.roller) {
        (true, _) => "clamped",
        (false, true) => "roller",
        (false, false) => "free",
    }
}

#[cfg(test)]
mod tests {
    use impinge::scene::{Convection, Radiation};

    use super::*;

    #[test]
    fn radiation_is_named_alone_and_beside_convection() {
        let radiation = Some(Radiation { emissivity: 0.8, ambient: 300.0 });
        let alone = Face { radiation, ..Face::default() };
        assert_eq!(thermal(&alone), "radiation, emissivity 0.8 to 300.00 K");
        let convection = Some(Convection { coefficient: 5.0, ambient: 290.0 });
        let beside = Face { convection, ..alone };
        let words = "convection, 5 W/(m² K) to 290.00 K; radiation, emissivity 0.8 to 300.00 K";
        assert_eq!(thermal(&beside), words);
        assert_eq!(thermal(&Face::default()), "insulated");
    }
}
