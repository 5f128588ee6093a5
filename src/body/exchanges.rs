//! Cost of exchanges between solids in contact.

use std::f64::consts::PI;

use super::link::{halvings, parts};
use super::solid::{BodyForecast, may_melt};
use crate::scene::{Coupling, Scene, Shape, lateral_extents, takes_newton};

/// Relaxation times of solids in contact after which the flux between them is steady.
const TRANSIENT: f64 = 7.0;
/// Trials of fluxes in a part of a step while they change and when they are steady: of columns whose heat is linear,
/// of other columns, and of bodies in which heat varies along the surface.
const COLUMNS: [f64; 2] = [2.0, 1.5];
const NONLINEAR: [f64; 2] = [9.0, 4.0];
const LATERAL: [f64; 2] = [24.0, 9.0];
/// Time of a trial per node of a body [s], with linear and with nonlinear heat, and of any body; measured on pairs of
/// 14 000 to 19 000 nodes, and on columns in steps of many relaxation times.
const LINEAR_NODE: f64 = 2.1e-7;
const NONLINEAR_NODE: f64 = 3e-5;
const BODY: f64 = 1e-5;
/// Time per node for each of the moments at which a front crosses nodes [s], in all trials together.
const FRONT: f64 = 2e-5;

/// Work of exchanges in the default experiment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExchangeForecast {
    /// Number of trials of fluxes between solids.
    pub trials: f64,
    /// Their time [s].
    pub time: f64,
}

/// A solid or reservoir in contact.
struct End {
    /// Heat capacity per area of the contact [J/(m² K)].
    capacity: f64,
    /// Difference of its mean temperature and that of its face, per flux [m² K/W].
    resistance: f64,
}

impl ExchangeForecast {
    /// Estimates the exchanges of all solids in contact.
    pub fn of(scene: &Scene, bodies: &[BodyForecast]) -> Self {
        let groups = groups(scene);
        let all = groups.iter().map(|(names, couplings)| of_group(scene, bodies, names, couplings));
        all.fold(Self::default(), |sum, of| Self {
            trials: sum.trials + of.trials,
            time: sum.time + of.time,
        })
    }
}

/// Bodies that touch directly or through others, with their contacts.
fn groups(scene: &Scene) -> Vec<(Vec<&str>, Vec<&Coupling>)> {
    let mut groups: Vec<(Vec<&str>, Vec<&Coupling>)> = Vec::new();
    for coupling in &scene.coupling {
        let (Some((lower, _)), Some((upper, _))) = (coupling.lower(), coupling.upper()) else {
            continue;
        };
        let ends = [lower, upper];
        let touches = |group: &(Vec<&str>, _)| ends.iter().any(|end| group.0.contains(end));
        let (joined, others) = groups.into_iter().partition(touches);
        groups = others;
        let mut group = (Vec::new(), vec![coupling]);
        for (names, couplings) in joined {
            group.0.extend(names);
            group.1.extend(couplings);
        }
        group.0.extend(ends);
        group.0.sort_unstable();
        group.0.dedup();
        groups.push(group);
    }
    groups
}

fn of_group(
    scene: &Scene,
    bodies: &[BodyForecast],
    names: &[&str],
    couplings: &[&Coupling],
) -> ExchangeForecast {
    let own: Vec<&BodyForecast> =
        bodies.iter().filter(|body| names.contains(&body.name.as_str())).collect();
    let is_nonlinear = |body: &BodyForecast| {
        scene.solid(&body.name).is_some_and(|solid| takes_newton(scene, solid))
    };
    let is_column = |body: &&BodyForecast| body.nodes[0] <= COLUMN && body.nodes[1] <= COLUMN;
    let [changing, steady] = match own.iter().all(is_column) {
        true if own.iter().any(|body| is_nonlinear(body)) => NONLINEAR,
        true => COLUMNS,
        false => LATERAL,
    };
    let interval = couplings.iter().filter_map(|coupling| coupling.interval);
    let interval = interval.fold(f64::INFINITY, f64::min);
    let of_step = parts(interval, scene.step) as f64;
    let length = scene.step / of_step;
    let count = (scene.stop_time / scene.step).ceil() * of_step;
    let rates = couplings.iter().filter_map(|coupling| rate(scene, coupling));
    let rate = rates.fold(0.0, f64::max);
    let halvings = halvings(length, rate) as f64;
    // Parts that are not halved have one exchange each, whatever happens.
    let in_transient = match halvings > 0.0 {
        true => count.min((TRANSIENT / (length * rate)).ceil()),
        false => 0.0,
    };
    let trials = (count - in_transient) * steady + in_transient * (halvings + 1.0) * changing;
    let time = |body: &&BodyForecast| {
        let nodes = body.unknowns[0] as f64;
        match is_nonlinear(body) {
            true => BODY + NONLINEAR_NODE * nodes,
            false => BODY + LINEAR_NODE * nodes,
        }
    };
    let front = |body: &&BodyForecast| {
        let nodes = body.unknowns[0] as f64;
        let solid = scene.solid(&body.name)?;
        let crossings = if is_column(body) { body.nodes[2] as f64 } else { nodes };
        may_melt(scene, &body.name, solid).then_some(FRONT * nodes * crossings)
    };
    ExchangeForecast {
        trials,
        time: trials * own.iter().map(time).sum::<f64>()
            + own.iter().filter_map(front).sum::<f64>(),
    }
}

/// Largest number of nodes of a column along x and y.
const COLUMN: usize = 3;

/// Rate at which two bodies, each of uniform temperature, equilibrate [1/s].
fn rate(scene: &Scene, coupling: &Coupling) -> Option<f64> {
    let names = [coupling.lower()?.0, coupling.upper()?.0];
    let areas = names.map(|name| scene.solid(name).map(|solid| area_of(&solid.shape)));
    let area = areas.iter().flatten().fold(f64::INFINITY, |least, area| least.min(*area));
    let [from, to] = names.map(|name| end(scene, name, area));
    let (from, to) = (from?, to?);
    let through = 1.0 / coupling.conductance? + from.resistance + to.resistance;
    Some((1.0 / from.capacity + 1.0 / to.capacity) / through)
}

/// Area of the top of a solid [m²].
fn area_of(shape: &Shape) -> f64 {
    let [x, y] = lateral_extents(shape);
    match shape {
        Shape::Box(_) => x * y,
        Shape::Disc(_) => 0.25 * PI * x * y,
    }
}

fn end(scene: &Scene, name: &str, area: f64) -> Option<End> {
    if let Some(reservoir) = scene.reservoir(name) {
        return Some(End { capacity: reservoir.heat_capacity / area, resistance: 0.0 });
    }
    let strata = scene.solid(name)?.strata();
    let capacity: f64 =
        strata.iter().map(|layer| layer.thickness() * layer.constants.heat_capacity()).sum();
    let resistance = strata
        .iter()
        .map(|layer| layer.thickness() / layer.constants.conductivity + layer.contact_resistance);
    Some(End { capacity, resistance: resistance.sum::<f64>() / 3.0 })
}
