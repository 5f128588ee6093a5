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

pub fn thermal(face: &Face) -> String {
    if let Some(temperature) = face.temperature {
        kelvin(temperature)
    } else if let Some(convection) = face.convection {
        format!("convection, {} W/(m² K) to {}", convection.coefficient, kelvin(convection.ambient))
    } else if let Some(flux) = face.flux {
        format!("flux {}", engineering(flux, "W/m²"))
    } else {
        "insulated".into()
    }
}

pub fn mechanical(face: &Face) -> &'static str {
    match (face.clamped, face.roller) {
        (true, _) => "clamped",
        (false, true) => "roller",
        (false, false) => "free",
    }
}
