//! Converts a solid of a scene to its plan: refinements of its mesh, and the mechanics it needs.

use super::rows::Choice;
use super::shock;
use crate::body::{droplet, filament, large_strain};
use crate::method::fem::{Mechanics, Plan, PlanRequest, Refinement, conducts_along_thickness};
use crate::scene::{
    Coupling, FaceName, Load, MeshFactors, Scene, Shape, Solid, lateral_extents, takes_newton,
};

pub fn plan(scene: &Scene, name: &str, solid: &Solid) -> Plan {
    let on_body = scene.load.iter().filter(|load| load.body_and_face().0 == name);
    let mut refinements: Vec<Refinement> = on_body.map(refinement).collect();
    for coupling in scene.couplings_to(name) {
        if let Some(droplet) = scene.droplet(&coupling.from) {
            refinements.extend(droplet::refinements(coupling, droplet, scene.stop_time));
        }
        if let Some(own) = scene.filament(&coupling.from) {
            refinements.push(filament::refinement(scene, (coupling, own)));
        }
        if let Some(body) = scene.large_strain(&coupling.from) {
            refinements.push(large_strain::refinement(coupling, body));
        }
    }
    let is_uniform = refinements.is_empty() && has_uniform_heat(scene, name);
    refinements.extend(contacts(scene, name, solid));
    let shortest = scene.step.min(scene.stop_time);
    let mesh = scene.refinement.get(name);
    let is_asked = scene.asks_mechanics(name) && !mesh.is_some_and(|mesh| mesh.heat_alone);
    let mechanics = match (is_asked, scene.gives_mechanics(name)) {
        (false, _) => Mechanics::Absent,
        (true, false) => Mechanics::Offered,
        (true, true) => Mechanics::Wanted,
    };
    let newton = takes_newton(scene, solid).then_some(TEMPERATURES * scene.fidelity.tolerance);
    let factors = mesh.map_or([1.0; 2], MeshFactors::factors);
    let linear_heat = mesh.is_some_and(|mesh| mesh.linear_heat);
    let refinements = &refinements;
    let request =
        PlanRequest { mechanics, refinements, is_uniform, shortest, newton, factors, linear_heat };
    let mut plan = Plan::new(solid, request);
    let chosen = mesh.map(|mesh| note_on_mesh(mesh, solid, scene.fidelity.tolerance));
    plan.notes.extend(chosen);
    plan.notes.extend(solid.has_stress_peaks().then(|| NOTE_ON_PEAKS.to_owned()));
    plan.notes.extend(solid.has_flaws().then(|| NOTE_ON_FLAWS.to_owned()));
    plan.notes.extend(shock::note(scene, (name, solid)));
    plan.notes.extend(scene.has_growing_flaws(name).then(|| NOTE_ON_GROWTH.to_owned()));
    plan.notes.extend(Choice::of(scene, (name, solid), &plan).note());
    plan
}

/// Note on the fineness of the mesh, chosen for a tolerance or set by the scene.
fn note_on_mesh(mesh: &MeshFactors, solid: &Solid, tolerance: f64) -> String {
    let error = match mesh.estimated_error {
        Some(error) => format!(
            "outputs err by about {:.1e} of their ranges over the default experiment at most, where {tolerance:e} is wanted",
            error
        ),
        None => format!(
            "outputs are to err by {tolerance:e}; what they do is estimated when it is asked for"
        ),
    };
    match (solid.mesh.spacing.is_some(), solid.cracks()) {
        (true, _) => format!("on the mesh that the scene asks for {error}"),
        (false, true) => format!("on the mesh that cracks need {error}"),
        (false, false) => format!(
            "{:.2} times as many elements as usual along the surface and {:.2} times through the thickness: {error}",
            mesh.along, mesh.through
        ),
    }
}

const NOTE_ON_PEAKS: &str = "stress is solved at every communication point, for its running maxima; twice where a \
                             traction or a prescribed temperature jumps there";

const NOTE_ON_FLAWS: &str = "stress is solved at every communication point, for the largest that every flaw has met; \
                             the state has a number more for each node of the whole body";

const NOTE_ON_GROWTH: &str =
    "stress is solved at every communication point, for the growth of flaws until the next";

/// Temperature differences to which a tolerance refers if heat advances in inner steps [K].
const TEMPERATURES: f64 = 10.0;

/// Refinements where another body touches this one: heat enters over the common area, most of it at first near the edge
/// of the smaller body.
fn contacts(scene: &Scene, name: &str, solid: &Solid) -> Vec<Refinement> {
    let refinement = |coupling: &Coupling| {
        let (lower, upper) = (coupling.lower()?, coupling.upper()?);
        let (own, other) = if lower.0 == name { (lower, upper) } else { (upper, lower) };
        if own.0 != name {
            return None;
        }
        // What has no extent touches all of the face.
        let other = scene.solid(other.0).unwrap_or(solid);
        let [one, two] = [solid, other].map(|solid| lateral_extents(&solid.shape));
        let half = [0, 1].map(|axis| 0.5 * one[axis].min(two[axis]));
        let [x, y] = half.map(|half| [-half, half]);
        let feature = PART_OF_CONTACT * half[0].min(half[1]);
        Some(Refinement {
            x,
            y,
            top: own.1 == FaceName::Top,
            feature,
            heats: true,
            edges: [None; 2],
        })
    };
    scene.coupling.iter().filter_map(refinement).collect()
}

/// Returns true if heat does not vary along the surface of a solid, nor of any that it touches, directly or through
/// others: they touch over equal, whole faces, and nothing acts on a part of one.
fn has_uniform_heat(scene: &Scene, name: &str) -> bool {
    let mut known = vec![name];
    let mut next = 0;
    while let Some(&own) = known.get(next) {
        next += 1;
        // A reservoir has one temperature.
        let Some(solid) = scene.solid(own) else {
            if scene.reservoir(own).is_some() {
                continue;
            }
            return false;
        };
        let is_alone =
            scene.loads_on(own).next().is_none() && scene.couplings_to(own).next().is_none();
        if !is_alone || !conducts_along_thickness(solid) {
            return false;
        }
        let touched = scene.coupling.iter().filter_map(|coupling| {
            let ends = [coupling.lower()?.0, coupling.upper()?.0];
            ends.iter().position(|&end| end == own).map(|place| ends[1 - place])
        });
        for other in touched {
            let is_as_wide = |other: &Solid| has_same_face(&solid.shape, &other.shape);
            if scene.solid(other).is_some_and(|other| !is_as_wide(other)) {
                return false;
            }
            if !known.contains(&other) {
                known.push(other);
            }
        }
    }
    true
}

fn has_same_face(one: &Shape, other: &Shape) -> bool {
    match (one, other) {
        (Shape::Box([x, y, _]), Shape::Box([other_x, other_y, _])) => x == other_x && y == other_y,
        (Shape::Disc(disc), Shape::Disc(other)) => disc.radius == other.radius,
        _ => false,
    }
}

/// Fraction of the contact size that the mesh resolves.
const PART_OF_CONTACT: f64 = 0.5;

/// Area where a load may act, for all positions that its inputs may set.
fn refinement(load: &Load) -> Refinement {
    let start = [load.start.x.unwrap_or(0.0), load.start.y.unwrap_or(0.0)];
    let range = [load.range.x, load.range.y];
    let own = load.footprint.radius().unwrap_or(0.0);
    let [_, radius] = load.range.radius.unwrap_or([0.0, load.start.radius.unwrap_or(own).max(own)]);
    let half = load.footprint.half_extents(Some(radius)).map(|half| load.footprint.reach() * half);
    let least = load.range.radius.map_or(own, |[lowest, _]| lowest);
    let feature = load.footprint.feature([least, radius]);
    let stretch = |a: usize| {
        let [low, high] = range[a].unwrap_or([start[a]; 2]);
        [low - half[a], high + half[a]]
    };
    let top = load.body_and_face().1 == FaceName::Top;
    let heats = load.heats();
    let moves = range.iter().any(Option::is_some) || load.range.radius.is_some();
    let edges = if moves { [None; 2] } else { load.footprint.edges(load.start.radius) };
    Refinement { x: stretch(0), y: stretch(1), top, feature, heats, edges }
}
