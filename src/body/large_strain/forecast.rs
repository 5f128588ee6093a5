//! Cost of solids of large strain.

use std::f64::consts::PI;

use super::plan;
use crate::body::threads_for;
use crate::laws::solid::large_strain::{LargeStrainLaw, Thermal};
use crate::scene::{Coupling, LargeStrain, Mechanics, MotionSteps, Scene};
use crate::space::{Form, Integration, Mesh};

#[derive(Debug, Clone, PartialEq)]
pub struct LargeStrainForecast {
    pub name: String,
    /// Nodes of the model, and points of its volume.
    pub nodes: usize,
    pub points: usize,
    /// Nodes with their mirror images, in files.
    pub drawn: usize,
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

/// Time of a point and of a function there, in a step of motion and in one of equilibrium with five iterations, and of
/// the factorisation there, which grows with the power 1.5 of the nodes in a plane and the square in space [s].
const MOVING: [f64; 2] = [0.15e-6, 0.04e-6];
const RESTING: [f64; 2] = [5e-6, 0.4e-6];
/// Time of an implicit step over that of an equilibrium: its matrix is not symmetric, and stress has two stations.
const IMPLICIT: f64 = 4.0;
const FACTOR_IN_PLANE: f64 = 4.0e-8;
const FACTOR_IN_SPACE: f64 = 6.0e-8;
/// Parts of a usual step of heat, and time of a pair of functions at a point in one [s].
const PARTS: f64 = 4.0;
const HEAT: f64 = 0.05e-6;
/// Time of a step of concrete in equilibrium over that of an elastic body: its tangent is made of differences, and
/// softening takes many iterations.
const OF_CONCRETE: f64 = 30.0;
/// Memory of a point, and of a function there [B].
const POINT: f64 = 500.0;
const FUNCTION: f64 = 90.0;

impl LargeStrainForecast {
    /// Estimates the cost from the mesh alone.
    pub fn of(scene: &Scene, name: &str, solid: &LargeStrain) -> Self {
        let mesh = plan::mesh(solid);
        let nodes = mesh.nodes.len();
        let (points, functions) = points(solid, &mesh);
        let threads = threads_for(scene.solver.threads, super::is_large(points)) as f64;
        let layers = plan::layers(solid);
        let speeds = layers.iter().map(|own| (own.law.wave_modulus() / own.density).sqrt());
        let speed = speeds.fold(0.0, f64::max);
        let history = layers.iter().map(|own| own.law.history()).max().unwrap_or(0);
        // Four fifths of the largest stable step, with the plane as stiff as the body.
        let explicit = solid.is_above();
        let time_step = explicit.then(|| OF_CROSSING * solid.spacing() / speed);
        let exchanges = (scene.stop_time / scene.step).ceil();
        let steps = time_step.map_or(exchanges, |dt| (scene.stop_time / dt).max(exchanges));
        let of_step = match (explicit, solid.inertia) {
            (true, _) => points as f64 * (MOVING[0] + MOVING[1] * functions),
            (false, inertia) => {
                let assembly = points as f64 * (RESTING[0] + RESTING[1] * functions * functions);
                let resting = assembly + 5.0 * factor_time(solid.form(), nodes as f64);
                if inertia { IMPLICIT * resting } else { resting }
            }
        };
        let heat = match solid.conducts() {
            true => {
                PARTS
                    * (points as f64 * HEAT * functions * functions
                        + factor_time(solid.form(), nodes as f64) / 9.0)
            }
            false => 0.0,
        };
        let is_concrete = layers.iter().any(|own| own.law.concrete().is_some());
        let of_step = if is_concrete && !explicit { OF_CONCRETE * of_step } else { of_step };
        let of_point = POINT + FUNCTION * functions + 8.0 * history as f64;
        let solver = if explicit { 0.0 } else { solver_memory(&mesh, functions) };
        let memory = of_point * points as f64 + solver;
        Self {
            name: name.to_owned(),
            nodes,
            points,
            drawn: nodes * super::snapshot::copies(solid.mirrors()) as usize,
            time_step,
            steps,
            memory,
            run_time: steps * of_step / if explicit { threads } else { 1.0 } + exchanges * heat,
            notes: notes(solid),
        }
    }
}

/// Stable step over the time in which sound crosses an element.
const OF_CROSSING: f64 = 0.45;

/// Number of points of the volume, and of functions at each.
fn points(solid: &LargeStrain, mesh: &Mesh) -> (usize, f64) {
    let axes = mesh.form.axes().len();
    let corners = 1 << axes;
    let kernels = plan::kernels(solid, mesh);
    match (solid.mechanics, kernels.integration) {
        (Mechanics::Fem, _) => (mesh.cells.len() * corners, corners as f64),
        (Mechanics::Sph, _) => {
            let support = solid.sph.unwrap_or_default().support;
            let ball = if axes == 3 { 4.0 / 3.0 * PI } else { PI };
            (plan::cells(mesh) * corners, ball * support.powi(axes as i32))
        }
        (_, integration) => {
            // Averaged gradients have the functions of all cells within the radius.
            let averaged = kernels.smoothing.map_or(0.0, |radius| radius / solid.spacing());
            let reach = (2.0 * (kernels.support + averaged)).powi(axes as i32);
            let cells = match integration {
                Integration::Scni | Integration::Nsni => mesh.nodes.len(),
                Integration::Gauss(_) => mesh.cells.len(),
            };
            let points = integration.points_of_cell(mesh.form) * cells;
            // Means over the cell of a node have the functions of all of its corners.
            let wider = if matches!(integration, Integration::Gauss(_)) { 1.0 } else { 1.6 };
            (points, wider * reach)
        }
    }
}

/// Memory of the stiffness and its factor [B]: the entries of all blocks with their places, and fill that grows with
/// the power 4/3 of the unknowns in space; measured on blocks of 1000 to 9300 nodes.
fn solver_memory(mesh: &Mesh, functions: f64) -> f64 {
    let axes = mesh.form.axes().len() as f64;
    let unknowns = axes * mesh.nodes.len() as f64;
    let blocks = plan::cells(mesh) as f64 * (axes * functions).powi(2);
    let fill = match mesh.form {
        Form::Solid => unknowns.powf(4.0 / 3.0),
        Form::Plane | Form::Axisymmetric => unknowns * unknowns.max(2.0).log2(),
    };
    OF_ENTRY * blocks + OF_FILL * fill
}

/// Memory of an entry of a block, and of the fill [B].
const OF_ENTRY: f64 = 48.0;
const OF_FILL: f64 = 400.0;

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
    let mut notes = vec![part, note_on_motion(solid)];
    notes.extend(note_on_temperature(solid).map(str::to_owned));
    notes.extend(match solid.mechanics {
        Mechanics::Fem => None,
        Mechanics::Rkpm => {
            Some("nodes have reproducing kernels, which reach over several elements".to_owned())
        }
        Mechanics::Efg => {
            Some("nodes have moving least squares, which reach over several elements".to_owned())
        }
        Mechanics::Sph => Some(
            "particles keep the neighbours of the undeformed body; in bending they are soft, by 2 % at 14 across"
                .to_owned(),
        ),
    });
    let layers = plan::layers(solid);
    let hardly_changes = layers.iter().any(|own| own.law.is_nearly_incompressible());
    notes.extend(layers.iter().filter_map(|own| note_on_concrete(&own.law)));
    let is_kernel = matches!(solid.mechanics, Mechanics::Rkpm | Mechanics::Efg);
    // A sheet may change its thickness.
    if is_kernel && hardly_changes && !solid.is_sheet() {
        notes.push(NOTE_ON_LOCKING.to_owned());
    }
    notes
}

fn note_on_motion(solid: &LargeStrain) -> String {
    match solid.steps() {
        Some(MotionSteps::Explicit) => {
            let friction = match solid.friction.filter(|&friction| friction > 0.0) {
                Some(friction) => {
                    format!("rubs on what lies below with a coefficient of friction of {friction}")
                }
                None => "slides on what lies below without friction".to_owned(),
            };
            let heat = if solid.conducts() { "" } else { ", and the body conducts no heat" };
            format!(
                "the body {friction}; what lies below is rigid for it{heat}; time steps follow the speed of sound"
            )
        }
        Some(MotionSteps::Implicit) => {
            "each communication step is one implicit time step, of second order, which conserves energy; nothing is below \
             the body, and it conducts no heat"
                .to_owned()
        }
        None => {
            "the body has no inertia: it is in equilibrium at every communication point".to_owned()
        }
    }
}

/// Note on what follows from the constants of concrete.
fn note_on_concrete(law: &LargeStrainLaw) -> Option<String> {
    let concrete = law.concrete()?;
    let brittleness = concrete.brittleness_in_compression(law.young());
    let breaks = match brittleness < 1.0 {
        true => "",
        false => {
            ", so without inertia it has no equilibrium on its way down; a longer `lambda` of `damage` helps"
        }
    };
    Some(format!(
        "the concrete bears {:.3e} Pa in uniaxial compression, and softens there at most {brittleness:.2} times as fast as \
         elastic strain recovers{breaks}; beyond the peak uniaxial tension takes {:.3e} J/m³, with the exponent {:.3} and \
         {:.3} of damage by opening",
        concrete.surfaces.compressive,
        concrete.energy_of_tension(),
        concrete.exponents[1],
        concrete.opening
    ))
}

fn note_on_temperature(solid: &LargeStrain) -> Option<&'static str> {
    if solid.conducts() {
        return Some(match solid.conductance_below {
            Some(_) => {
                "heat flows in the body as it is deformed, and to the body below where they touch; constants are those of its \
                 initial temperature"
            }
            None => {
                "heat flows in the body as it is deformed; constants are those of its initial temperature"
            }
        });
    }
    if solid.has_temperature() {
        return Some("the body has one temperature, which is an input: no heat flows in it");
    }
    let acts = solid.thermal().iter().any(Thermal::acts);
    acts.then_some("the body keeps its initial temperature: it neither expands nor relaxes faster where it is warm")
}

/// Note on kernels of a material that hardly changes its volume.
const NOTE_ON_LOCKING: &str = "the material hardly changes its volume, so the points of a kernel's cell share its dilatation; on coarse meshes \
                               it is too stiff all the same: at a Poisson's ratio of 0.4999 Cook's membrane of 16 cells a side by 4 %, with \
                               `rkpm = { integration = \"gauss\" }` by 0.8 %, with finite elements by 2.4 %";

/// Longest time between exchanges with the body below [s]: the value of the scene, or the time in which the body falls
/// by an element.
pub fn contact_interval(coupling: &Coupling, solid: &LargeStrain) -> f64 {
    let start = solid.start;
    let speed = (start.velocity[2].powi(2) + 2.0 * solid.gravity * start.height).sqrt();
    coupling.interval.unwrap_or(solid.spacing() / speed)
}
