//! Heat of solids of large strain that their meshes do not resolve, or that no coupling passes.

use super::Reviewer;
use crate::limits::{number, two_digits};
use crate::scene::LargeStrain;
use crate::scene::locate::Path;
use crate::warning;

/// Biot number of half an element from which on the temperature of a surface node differs from that of the surface.
const STEEP: f64 = 0.5;
/// Difference of temperatures of bodies that touch from which on heat between them matters [K].
const DIFFERENT: f64 = 1.0;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, solid) in scene.large_strains() {
        let path = Path::default().key("body").key(name);
        if let Some([depth, fine]) = coarse(solid, scene.stop_time) {
            let spacing = number(solid.spacing());
            let finding =
                warning::warm_layer_unresolved(two_digits(depth), spacing, two_digits(fine));
            reviewer.warn(&path.at("mesh.spacing"), finding);
        }
        let Some(place) = scene.coupling_from(name) else { continue };
        let coupling = &scene.coupling[place];
        let Some((below, other)) = scene.solid_below(coupling) else { continue };
        let difference = (solid.initial_temperature - other.initial_temperature).abs();
        if coupling.conductance.is_none() && difference > DIFFERENT {
            let path = Path::default().key("coupling").index(place);
            let finding = warning::no_heat_passes(name, below, two_digits(difference));
            reviewer.warn(&path.key("conductance"), finding);
        }
    }
}

/// Depth to which heat goes until a stop time, where nodes are farther apart, and the distance that resolves it [m].
fn coarse(solid: &LargeStrain, stop: f64) -> Option<[f64; 2]> {
    let heat = &solid.materials_of_layers().first()?.heat;
    let conductivity = heat.conductivity.value(solid.initial_temperature);
    let capacity = heat.density * heat.specific_heat.value(solid.initial_temperature);
    let on_faces = solid.faces.values().map(|face| match (face.temperature, face.convection) {
        (Some(_), _) => f64::INFINITY,
        (None, convection) => convection.map_or(0.0, |own| own.coefficient),
    });
    let steepest = on_faces.chain(solid.conductance_below).fold(0.0, f64::max);
    let depth = (conductivity * stop / capacity).sqrt();
    let biot = steepest * 0.5 * solid.spacing() / conductivity;
    (solid.conducts() && biot > STEEP && depth < solid.spacing()).then_some([depth, 0.5 * depth])
}
