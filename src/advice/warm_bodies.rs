//! Heat of solids of large strain that their meshes do not resolve, or that no contact passes.

use super::Reviewer;
use crate::limits::{number, two_digits};
use crate::scene::locate::Path;
use crate::scene::{LargeStrain, Scene};
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
        insulated(reviewer, name, solid);
    }
}

/// A surface below a body.
struct Below<'a> {
    path: Path,
    name: &'a str,
    temperature: f64,
    conductance: Option<f64>,
}

impl<'a> Below<'a> {
    fn of(scene: &'a Scene, body: &str) -> Option<Self> {
        if let Some(place) = scene.coupling_from(body) {
            let coupling = &scene.coupling[place];
            let (name, solid) = scene.solid_below(coupling)?;
            let (temperature, conductance) = (solid.initial_temperature, coupling.conductance);
            return Some(Self { path: root("coupling", place), name, temperature, conductance });
        }
        let place = scene.wall_under(body)?;
        let wall = &scene.wall[place];
        let temperature = wall.start.temperature.as_ref()?.numbers().next()?;
        let (name, conductance) = (&wall.name, wall.conductance);
        Some(Self { path: root("wall", place), name, temperature, conductance })
    }
}

fn root(table: &str, place: usize) -> Path {
    Path::default().key(table).index(place)
}

/// Warns of a contact of different temperatures through which no heat passes.
fn insulated(reviewer: &mut Reviewer, name: &str, solid: &LargeStrain) {
    let Some(below) = Below::of(reviewer.scene, name) else { return };
    let difference = (solid.initial_temperature - below.temperature).abs();
    if below.conductance.is_none() && difference > DIFFERENT {
        let finding = warning::no_heat_passes(name, below.name, two_digits(difference));
        reviewer.warn(&below.path.key("conductance"), finding);
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
