//! Every constant, size, time and load of a scene against its plausible range.

use super::Reviewer;
use super::ranges::{self, Range};
use crate::material::{Properties, Property};
use crate::scene::droplet::{Droplet, Wall};
use crate::scene::locate::Path;
use crate::scene::types::{CellValues, Load, Scene, Shape, Solid};

pub fn review(reviewer: &mut Reviewer) {
    let (scene, root) = (reviewer.scene, Path::default());
    reviewer.value(&root.key("stop_time"), scene.stop_time, &ranges::TIME);
    reviewer.value(&root.key("step"), scene.step, &ranges::TIME);
    let temperature = temperatures(scene);
    for (name, own) in &scene.material {
        material(reviewer, &root.key("material").key(name), own.properties());
    }
    for (name, body) in scene.solids() {
        let path = root.key("body").key(name);
        for (place, own) in body.materials(&path) {
            if place.is_within(&path) {
                material(reviewer, &place, own.properties());
            }
        }
        solid(reviewer, &path, body, &temperature);
    }
    for (name, body) in scene.droplets() {
        droplet(reviewer, &root.key("body").key(name), body, &temperature);
    }
    for (name, reservoir) in scene.reservoirs() {
        let path = root.key("body").key(name);
        let initial = reservoir.initial_temperature;
        reviewer.value(&path.key("initial_temperature"), initial, &temperature);
        if let Some(value) = reservoir.ambient {
            let ambient = Range { lowest: temperature.lowest, ..ranges::AMBIENT };
            reviewer.value(&path.key("ambient"), value, &ambient);
        }
    }
    for (i, entry) in scene.load.iter().enumerate() {
        load(reviewer, &root.key("load").index(i), entry);
    }
    for (i, Wall { start, .. }) in scene.wall.iter().enumerate() {
        if let Some(values) = &start.temperature {
            let path = root.key("wall").index(i).at("start.temperature");
            cells(reviewer, &path, values, &temperature);
        }
    }
}

/// Lowest temperature of surroundings that is not doubted: in the shade of space; 20 is meant in °C [K].
const CRYOGENIC_SKY: f64 = 60.0;

/// Density below which a liquid is hydrogen or helium [kg/m³].
const LIGHTEST_COMMON: f64 = 150.0;

/// The range of temperatures: cold ones are believed around the lightest liquids.
pub fn temperatures(scene: &Scene) -> Range {
    let mut droplets = scene.droplets();
    let cryogenic = droplets.any(|(_, droplet)| droplet.fluid.density < LIGHTEST_COMMON);
    if cryogenic { ranges::CRYOGENIC } else { ranges::TEMPERATURE }
}

fn solid(reviewer: &mut Reviewer, path: &Path, solid: &Solid, temperature: &Range) {
    match solid.shape {
        Shape::Box(extents) => {
            for (i, extent) in extents.into_iter().enumerate() {
                reviewer.value(&path.at("shape.box").index(i), extent, &ranges::EXTENT);
            }
        }
        Shape::Disc(disc) => {
            for (key, extent) in [("radius", disc.radius), ("thickness", disc.thickness)] {
                reviewer.value(&path.at("shape.disc").key(key), extent, &ranges::EXTENT);
            }
        }
    }
    for (i, layer) in solid.layers.iter().flatten().enumerate() {
        let path = path.key("layers").index(i);
        reviewer.value(&path.key("thickness"), layer.thickness, &ranges::LAYER);
        if let Some(resistance) = layer.contact_resistance {
            reviewer.value(&path.key("contact_resistance"), resistance, &ranges::CONTACT);
        }
    }
    reviewer.value(&path.key("initial_temperature"), solid.initial_temperature, temperature);
    if let Some(value) = solid.stress_free_temperature {
        reviewer.value(&path.key("stress_free_temperature"), value, temperature);
    }
    for (name, face) in &solid.faces {
        let path = path.key("faces").key(name.as_str());
        if let Some(value) = face.temperature {
            reviewer.value(&path.key("temperature"), value, temperature);
        }
        if let Some(flux) = face.flux {
            reviewer.value(&path.key("flux"), flux, &ranges::HEAT_FLUX);
        }
        if let Some(radiation) = face.radiation {
            let ambient = Range { lowest: CRYOGENIC_SKY, ..ranges::AMBIENT };
            reviewer.value(&path.key("radiation").key("ambient"), radiation.ambient, &ambient);
        }
        if let Some(convection) = face.convection {
            let path = path.key("convection");
            let ambient = Range { lowest: temperature.lowest, ..ranges::AMBIENT };
            reviewer.value(&path.key("ambient"), convection.ambient, &ambient);
            let coefficient = convection.coefficient;
            reviewer.value(&path.key("coefficient"), coefficient, &ranges::HEAT_TRANSFER);
        }
    }
}

/// The constants of a solid, or the first of a table that is out of range.
fn material(reviewer: &mut Reviewer, path: &Path, law: &Properties) {
    reviewer.value(&path.key("density"), law.density, &ranges::DENSITY);
    for (key, property, range) in [
        ("specific_heat", Some(&law.specific_heat), &ranges::SPECIFIC_HEAT),
        ("conductivity", Some(&law.conductivity), &ranges::CONDUCTIVITY),
        ("young", law.young.as_ref(), &ranges::YOUNG),
        ("expansion", law.expansion.as_ref(), &ranges::EXPANSION),
        ("yield_stress", law.yield_stress.as_ref(), &ranges::YIELD_STRESS),
    ] {
        match property {
            Some(Property::Constant(value)) => reviewer.value(&path.key(key), *value, range),
            Some(Property::Table(table)) => {
                let odd = table.value.iter().position(|value| !range.holds(*value));
                if let Some(i) = odd {
                    reviewer.value(&path.key(key).key("value").index(i), table.value[i], range);
                }
            }
            None => {}
        }
    }
    if let Some(melting) = &law.melting {
        let path = path.key("melting");
        for (key, value) in [("solidus", melting.solidus), ("liquidus", melting.liquidus)] {
            reviewer.value(&path.key(key), value, &ranges::MELTING);
        }
        reviewer.value(&path.key("latent_heat"), melting.latent_heat, &ranges::LATENT_HEAT);
    }
}

fn droplet(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet, temperature: &Range) {
    let fluid = &droplet.fluid;
    for (key, value, range) in [
        ("diameter", droplet.diameter, &ranges::DIAMETER),
        ("impact_velocity", droplet.impact_velocity, &ranges::SPEED),
        ("height", droplet.gap(), &ranges::HEIGHT),
        ("gravity", droplet.gravity, &ranges::GRAVITY),
        ("initial_temperature", droplet.initial_temperature, temperature),
        ("fluid.density", fluid.density, &ranges::FLUID_DENSITY),
        ("fluid.specific_heat", fluid.specific_heat, &ranges::FLUID_SPECIFIC_HEAT),
        ("fluid.conductivity", fluid.conductivity, &ranges::FLUID_CONDUCTIVITY),
        ("fluid.viscosity", fluid.viscosity, &ranges::VISCOSITY),
        ("fluid.surface_tension", fluid.surface_tension, &ranges::SURFACE_TENSION),
    ] {
        reviewer.value(&path.at(key), value, range);
    }
}

fn load(reviewer: &mut Reviewer, path: &Path, load: &Load) {
    let start = &load.start;
    for (key, values, range) in [
        ("heat_flux", &start.heat_flux, &ranges::HEAT_FLUX),
        ("pressure", &start.pressure, &ranges::TRACTION),
        ("shear_x", &start.shear_x, &ranges::TRACTION),
        ("shear_y", &start.shear_y, &ranges::TRACTION),
        ("shear_r", &start.shear_r, &ranges::TRACTION),
    ] {
        if let Some(values) = values {
            cells(reviewer, &path.key("start").key(key), values, range);
        }
    }
}

/// Warns of the first cell that is out of range: the others are hardly better.
fn cells(reviewer: &mut Reviewer, path: &Path, values: &CellValues, range: &Range) {
    let odd = |value: &f64| !range.holds(*value);
    let found = match values {
        CellValues::Uniform(value) => Some((path.clone(), *value)),
        CellValues::Rings(list) => list.iter().position(odd).map(|i| (path.index(i), list[i])),
        CellValues::Tiles(rows) => rows.iter().enumerate().find_map(|(i, row)| {
            let j = row.iter().position(odd)?;
            Some((path.index(i).index(j), row[j]))
        }),
    };
    if let Some((path, value)) = found {
        reviewer.value(&path, value, range);
    }
}
