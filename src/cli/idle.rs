//! Runs in which nothing happens.

use impinge::scene::{Scene, Solid};
use impinge::variables::{Quantity, Registry, Slot, Variable};

/// What to say where neither an input nor a face nor a droplet acts on anything.
pub fn note(scene: &Scene, inputs: &[f64]) -> Option<String> {
    if scene.droplets().next().is_some() {
        return None;
    }
    let mut idle = Vec::new();
    for variable in &Registry::of(scene).variables {
        let Slot::Input(at) = variable.slot else { continue };
        match rest(scene, variable) {
            Some(rest) if rest.contains(&inputs[at]) => idle.push(variable.family().to_owned()),
            Some(_) => return None,
            // What moves a footprint or transfers heat does nothing alone.
            None => {}
        }
    }
    idle.dedup();
    let remedy = match idle.first() {
        Some(first) => format!("set {} by `--set {first}=VALUE` or in the scene", idle.join(", ")),
        None => "the scene has neither loads nor conditions on faces".to_owned(),
    };
    Some(format!(
        "nothing acts: all loads are zero and all faces at the initial temperature; {remedy}"
    ))
}

/// Values with which an input does nothing; `None` for inputs that do nothing alone.
fn rest(scene: &Scene, variable: &Variable) -> Option<Vec<f64>> {
    match variable.quantity? {
        Quantity::HeatFlux | Quantity::Stress => Some(vec![0.0]),
        Quantity::Temperature => {
            let is_own = |name: &str| variable.name.starts_with(name);
            let own = scene.solids().filter(|(name, _)| is_own(name));
            let initial = |(_, solid): (&str, &Solid)| solid.initial_temperature;
            Some(own.map(initial).collect())
        }
        _ => None,
    }
}
