//! Cost of solids of large strain.

use super::plan;
use crate::body::threads_for;
use crate::scene::{Coupling, LargeStrain, Scene};
use crate::space::Form;

#[derive(Debug, Clone, PartialEq)]
pub struct LargeStrainForecast {
    pub name: String,
    /// Nodes of the model, and points of its volume.
    pub nodes: usize,
    pub points: usize,
    /// Time step of the undeformed body [s]; `None` for a body in equilibrium.
    pub time_step: Option<f64>,
    /// Time steps of the default experiment, or steps of equilibrium.
    pub steps: f64,
    /// Memory [B].
    pub memory: f64,
    /// Time to run the default experiment [s].
    pub run_time: f64,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
}

/// Time of a point in a step of motion, of a step of equilibrium with five iterations, and of the factorisation there,
/// which grows with the power 1.5 of the nodes in a plane and the square in space [s].
const MOVING: f64 = 0.35e-6;
const RESTING: f64 = 2.0e-5;
const FACTOR_IN_PLANE: f64 = 4.0e-8;
const FACTOR_IN_SPACE: f64 = 6.0e-8;
/// Memory of a point [B], and of a node for a factorisation.
const POINT: f64 = 900.0;

impl LargeStrainForecast {
    /// Estimates the cost from the mesh alone.
    pub fn of(scene: &Scene, name: &str, solid: &LargeStrain) -> Self {
        let mesh = plan::mesh(solid);
        let corners = mesh.cells.first().map_or(0, Vec::len);
        let (nodes, points) = (mesh.nodes.len(), mesh.cells.len() * corners);
        let threads = threads_for(scene.solver.threads, super::is_large(points)) as f64;
        let law = plan::law(solid);
        let density = solid.material.material().heat.density;
        let speed = (law.wave_modulus() / density).sqrt();
        // Four fifths of the largest stable step, with the plane as stiff as the body.
        let time_step = solid.inertia.then(|| OF_CROSSING * solid.spacing() / speed);
        let exchanges = (scene.stop_time / scene.step).ceil();
        let steps = time_step.map_or(exchanges, |dt| (scene.stop_time / dt).max(exchanges));
        let of_step = match solid.inertia {
            true => MOVING * points as f64,
            false => RESTING * points as f64 + 5.0 * factor_time(plan::form(solid), nodes as f64),
        };
        let memory = POINT * points as f64 + 8.0 * (1.0 + law.history() as f64) * points as f64;
        Self {
            name: name.to_owned(),
            nodes,
            points,
            time_step,
            steps,
            memory,
            run_time: steps * of_step / if solid.inertia { threads } else { 1.0 },
            notes: notes(solid),
        }
    }
}

/// Stable step over the time in which sound crosses an element.
const OF_CROSSING: f64 = 0.45;

fn factor_time(form: Form, nodes: f64) -> f64 {
    match form {
        Form::Plane | Form::Axisymmetric => FACTOR_IN_PLANE * nodes.powf(1.5),
        Form::Solid => FACTOR_IN_SPACE * nodes.powi(2),
    }
}

/// Notes on choices and simplifications, with reasons: one sentence each.
pub fn notes(solid: &LargeStrain) -> Vec<String> {
    let part = match (solid.is_axisymmetric(), solid.mirrors()) {
        (true, _) => "a meridian section of the body is modelled: it is round about z".to_owned(),
        (_, [true, true]) => {
            "a quarter of the body is modelled: it mirrors itself in x = 0 and y = 0".to_owned()
        }
        (_, [true, false]) => "half of the body is modelled: it mirrors itself in x = 0".to_owned(),
        (_, [false, true]) => "half of the body is modelled: it mirrors itself in y = 0".to_owned(),
        _ => "the whole body is modelled: nothing makes it mirror itself, or the scene asks for it"
            .to_owned(),
    };
    let motion = match solid.inertia {
        true => {
            "the body slides on what lies below without friction, which is rigid for it, and conducts no heat: time steps \
             follow the speed of sound"
        }
        false => "the body has no inertia: it is in equilibrium at every communication point",
    };
    vec![part, motion.to_owned()]
}

/// Longest time between exchanges with the body below [s]: the value of the scene, or the time in which the body falls by
/// an element.
pub fn contact_interval(coupling: &Coupling, solid: &LargeStrain) -> f64 {
    let start = solid.start;
    let speed = (start.velocity[2].powi(2) + 2.0 * solid.gravity * start.height).sqrt();
    coupling.interval.unwrap_or(solid.spacing() / speed)
}
