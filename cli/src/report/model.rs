//! The model of a scene: bodies, reductions with their reasons, and omissions.

use impinge::model::{BodyForecast, DropletForecast, Timeline, forecast};
use impinge::scene::Scene;

use super::document::{Fact, Part};
use crate::check::bodies::{law, shape, speed};
use crate::check::conditions::{mechanical, thermal};
use crate::check::omissions::omissions;
use crate::check::words::{key, keys, metres};
use crate::units::{engineering, kelvin};

/// Describes the model of a scene; `reductions` are notes of its reduced bodies.
pub fn parts(scene: &Scene, reductions: &[String]) -> Vec<Part> {
    let forecast = forecast(scene);
    let mut parts = vec![run(scene)];
    parts.extend(forecast.bodies.iter().map(|body| solid(scene, body)));
    parts.extend(forecast.droplets.iter().map(|body| droplet(scene, body)));
    parts.extend(lumps(scene));
    parts.extend(acting(scene));
    let of_reduced =
        |note: &&String| note.split_once(": ").is_some_and(|(body, _)| scene.is_reduced(body));
    let own: Vec<String> = reductions.iter().filter(of_reduced).cloned().collect();
    parts.extend(lines("Reduction", own));
    parts.extend(lines("Not modelled", omissions(scene, &forecast)));
    parts
}

/// Times and level of detail.
fn run(scene: &Scene) -> Part {
    let steps = Timeline::new(scene.step, scene.stop_time).count;
    let [step, stop] = [scene.step, scene.stop_time].map(|time| engineering(time, "s"));
    let facts = vec![
        Fact::new("steps", format!("{steps} of {step} to {stop}")),
        Fact::new("level of detail", key(&scene.fidelity.level)),
        Fact::new("tolerance", format!("{}", scene.fidelity.tolerance)),
    ];
    Part { facts, ..Part::default() }
}

fn solid(scene: &Scene, body: &BodyForecast) -> Part {
    let mut facts = Vec::new();
    if let Some(solid) = scene.solid(&body.name) {
        facts.push(Fact::new("shape", shape(&solid.shape)));
        facts.push(Fact::new("material", law(solid.material.as_ref(), solid.layers.as_deref())));
        facts.push(Fact::new("initially", kelvin(solid.initial_temperature)));
        facts.push(Fact::new("heat by", key(&solid.heat)));
        facts.push(Fact::new("symmetry", key(&solid.symmetry)));
        for (face, condition) in &solid.faces {
            let words = format!("{}, {}", thermal(condition), mechanical(condition));
            facts.push(Fact::new(key(face), words));
        }
    }
    facts.extend(mesh(body));
    let title = format!("{}: solid", body.name);
    Part { title, facts, lines: body.notes.clone(), tables: Vec::new() }
}

/// Nodes, unknowns and distances of a solid.
fn mesh(body: &BodyForecast) -> Vec<Fact> {
    let nodes: Vec<_> =
        body.nodes.iter().filter(|count| **count > 1).map(usize::to_string).collect();
    let mut facts = vec![Fact::new(
        "mesh",
        format!("{} nodes of order {} in the meshed part", nodes.join(" × "), body.order),
    )];
    for (axis, [least, most]) in ["x", "y", "z"].iter().zip(body.spacing) {
        if most > 0.0 {
            let words = format!("{} to {}", metres(least), metres(most));
            facts.push(Fact::new(format!("nodes apart along {axis}"), words));
        }
    }
    let [heat, mechanics] = body.unknowns;
    let unknowns = match body.reduced {
        Some(Some(count)) => format!("{count}, reduced from heat {heat}, displacement {mechanics}"),
        Some(None) => format!("reduced from heat {heat}, displacement {mechanics}"),
        None => format!("heat {heat}, displacement {mechanics}"),
    };
    facts.push(Fact::new("unknowns", unknowns));
    facts
}

fn droplet(scene: &Scene, body: &DropletForecast) -> Part {
    let mut facts = Vec::new();
    if let Some(droplet) = scene.droplet(&body.name) {
        let drops = match (droplet.drops(), droplet.is_on_demand()) {
            (count, true) => format!("up to {count}, released by an input"),
            (count, false) => count.to_string(),
        };
        facts.push(Fact::new("drops", drops));
        facts.push(Fact::new("diameter", metres(droplet.diameter)));
        facts.push(Fact::new("speed", speed(droplet)));
        facts.push(Fact::new("initially", kelvin(droplet.initial_temperature)));
        facts.push(Fact::new("method", key(&droplet.method)));
        if droplet.has_particles() {
            facts.push(Fact::new("distance of particles", metres(droplet.spacing)));
        }
        facts.push(Fact::new("symmetry", key(&droplet.symmetry)));
    }
    let particles = match body.particles {
        0 => "closed forms".to_owned(),
        count => format!("{count} particles in the modelled part"),
    };
    facts.push(Fact::new("model", particles));
    let title = format!("{}: droplet", body.name);
    Part { title, facts, lines: body.notes.clone(), tables: Vec::new() }
}

/// Bodies of one temperature.
fn lumps(scene: &Scene) -> Option<Part> {
    let facts: Vec<_> = scene.lumps().map(|(name, words)| Fact::new(name, words)).collect();
    let title = "Bodies without extent".to_owned();
    (!facts.is_empty()).then_some(Part { title, facts, ..Part::default() })
}

/// Loads, walls and couplings.
fn acting(scene: &Scene) -> Option<Part> {
    let loads = scene.load.iter().map(|load| {
        let words =
            format!("{} on {}: {}", load.footprint.label(metres), load.on, keys(&load.carries));
        Fact::new(format!("load {}", load.name), words)
    });
    let walls = scene.wall.iter().map(|wall| {
        let words = format!("{} under {}", wall.footprint.label(metres), wall.under);
        Fact::new(format!("wall {}", wall.name), words)
    });
    let couplings = scene.coupling.iter().map(|coupling| {
        let words = match (coupling.conductance, coupling.traction) {
            (Some(conductance), _) => format!("heat, {}", engineering(conductance, "W/(m² K)")),
            (None, true) => "heat, pressure and shear".to_owned(),
            (None, false) => "heat".to_owned(),
        };
        Fact::new(format!("{} on {}", coupling.from, coupling.to), words)
    });
    let facts: Vec<_> = loads.chain(walls).chain(couplings).collect();
    let title = "Loads and couplings".to_owned();
    (!facts.is_empty()).then_some(Part { title, facts, ..Part::default() })
}

fn lines(title: &str, lines: Vec<String>) -> Option<Part> {
    (!lines.is_empty()).then_some(Part { title: title.to_owned(), lines, ..Part::default() })
}
