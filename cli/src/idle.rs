//! Runs in which nothing happens.

use impinge::scene::{Body, Face, Scene, Solid};
use impinge::variables::{InputLayout, Quantity, Registry, Slot};

/// Returns a note if neither an input nor a face nor a droplet acts on any body.
pub fn note(scene: &Scene, inputs: &[f64]) -> Option<String> {
    let moves = |body: &Body| match body {
        Body::LargeStrain(solid) => solid.inertia || solid.gravity > 0.0,
        Body::Filament(filament) => !filament.moves_by_inputs(),
        _ => false,
    };
    if scene.droplets().next().is_some() || scene.body.values().any(moves) || acts_by_itself(scene)
    {
        return None;
    }
    let layout = InputLayout::of(scene);
    let mut idle = Vec::new();
    for variable in &Registry::of(scene).variables {
        let Slot::Input(at) = variable.slot else { continue };
        let Some(quantity) = variable.quantity else { continue };
        match rest(scene, &layout, (at, quantity)) {
            Some(rest) if rest == inputs[at] => idle.push(variable.family().to_owned()),
            Some(_) => return None,
            // Inputs that move a footprint or transfer heat have no effect alone.
            None => {}
        }
    }
    idle.dedup();
    let remedy = match idle.first() {
        Some(first) => format!(
            "set {} by `--set {first}=VALUE`, over time by `--inputs`, or where the scene has a key for it",
            idle.join(", ")
        ),
        None => "the scene has neither loads nor conditions on faces".to_owned(),
    };
    Some(format!(
        "nothing acts: all loads are zero and all faces at the initial temperature; {remedy}"
    ))
}

/// Returns true if solids heat each other, radiate, sink into a bath or are initially under stress.
fn acts_by_itself(scene: &Scene) -> bool {
    let start = |name: &str| scene.body.get(name).map(Body::initial_temperature);
    let touches =
        scene.coupling.iter().any(|coupling| match (coupling.lower(), coupling.upper()) {
            (Some((lower, _)), Some((upper, _))) => start(lower) != start(upper),
            _ => false,
        });
    let changes = |solid: &Solid| {
        let start = solid.initial_temperature;
        let radiates = |face: &Face| face.radiation.is_some_and(|r| r.ambient != start);
        let sinks = solid.bath.is_some_and(|bath| bath.ambient != start);
        sinks || solid.faces.values().any(radiates) || solid.temperature_without_stress() != start
    };
    touches || scene.solids().any(|(_, solid)| changes(solid))
}

/// The value at which an input has no effect; `None` for inputs without effect on their own.
fn rest(scene: &Scene, layout: &InputLayout, (at, quantity): (usize, Quantity)) -> Option<f64> {
    match quantity {
        Quantity::HeatFlux | Quantity::HeatFlow | Quantity::Stress => Some(0.0),
        Quantity::Displacement | Quantity::VolumeFlow => Some(0.0),
        Quantity::Temperature => {
            let face = layout.faces.iter().find(|face| face.index == at).map(|face| &face.body);
            let whole = || layout.bodies.iter().find(|(_, range)| range.contains(&at));
            let body = face.or_else(|| whole().map(|(body, _)| body))?;
            match scene.body.get(body)? {
                // Temperatures do nothing before fluid comes.
                Body::Filament(_) => None,
                other => Some(other.initial_temperature()),
            }
        }
        _ => None,
    }
}
