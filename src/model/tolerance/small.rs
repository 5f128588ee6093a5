//! Errors of solids of large strain by their meshes: linear responses to small inputs on meshes of two sizes.

use super::estimate::{OutputError, differences};
use super::order::LINEAR;
use super::report::BodyEstimate;
use super::responses::{Responses, Watched};
use crate::body::{Reading, SmallTrials, forecast};
use crate::model::{Cache, Model, ModelError, check_memory};
use crate::quantity::{Quantity, percent};
use crate::scene::{Mechanics, Scene};
use crate::variables::{Output, Registry, Slot};
use crate::warning::{self, Warning};

/// Longest time of the trials on a mesh that is taken for an estimate [s].
const LONGEST: f64 = 1.0;
/// Estimate over the tolerance from which on a mesh causes a warning: it is not chosen by the tolerance, and the estimate
/// is that of small inputs.
pub const OVER: f64 = 5.0;
/// Part of the error of a mesh from which on another discretisation is no better.
const BETTER: f64 = 0.5;
/// Part of the usual size of an output below which it is zero but for rounding.
const FAINT: f64 = 1e-6;

/// Estimates the errors of the outputs of a solid of large strain; `None` for other bodies.
pub fn estimate(scene: &Scene, name: &str) -> Option<BodyEstimate> {
    let mut found =
        BodyEstimate { body: name.to_owned(), outputs: Vec::new(), notes: Vec::new(), stuck: None };
    match SmallTrials::of(scene, name)? {
        Err(why) => found.notes.push(format!("no estimate: {why}")),
        Ok(trials) => match of_trials(&trials, scene.fidelity.tolerance) {
            Ok((outputs, notes)) => (found.outputs, found.notes) = (outputs, notes),
            Err(why) => found.notes.push(format!("no estimate: {why}")),
        },
    }
    Some(found)
}

/// Warns of a body whose mesh is far from the tolerance, with the distance of nodes that would keep it.
pub fn beyond_tolerance(scene: &Scene, estimate: &BodyEstimate) -> Option<Warning> {
    let tolerance = scene.fidelity.tolerance;
    let worst = estimate.outputs.iter().max_by(|a, b| a.total().total_cmp(&b.total()))?;
    let error = worst.total();
    if error <= OVER * tolerance {
        return None;
    }
    let own = SmallTrials::of(scene, &estimate.body)?.ok()?;
    let spacing = own.spacing()? * (tolerance / error).sqrt();
    let found = format!("{} of its range", percent(error.min(1.0)));
    let remedy = format!(
        "about `mesh.spacing = {spacing:.1e}` would keep it, if errors fall with its square"
    );
    let warning = warning::mesh_beyond_tolerance(&worst.name, found, percent(tolerance), remedy);
    Some(warning.at(&estimate.body))
}

/// Errors of outputs, and notes on them.
fn of_trials(
    trials: &SmallTrials,
    tolerance: f64,
) -> Result<(Vec<OutputError>, Vec<String>), String> {
    let watched = watched(&trials.scene(1.0, 0.0));
    if watched.is_empty() {
        return Err(
            "none of its outputs is a deformation, a force or a stress at a place".to_owned()
        );
    }
    let ((finer, more), factor) = other_mesh(trials)?;
    let solve = |finer: f64, watched: &[Watched]| {
        responses(trials, finer, watched).map_err(|error| error.to_string())
    };
    let (watched, own) = clear(trials, &watched, &solve(1.0, &watched)?);
    let other = solve(finer, &watched)?;
    let errors: Vec<f64> =
        differences(&own, &other, &watched).into_iter().map(|part| factor * part).collect();
    if errors.iter().any(|error| !error.is_finite()) {
        return Err("the body is not held".to_owned());
    }
    let mut notes =
        vec![format!("errors are those of the linear response to small inputs, by a mesh {more}")];
    let worst = errors.iter().copied().fold(0.0, f64::max);
    if worst > tolerance {
        let best = extrapolated(&own, &other, if finer > 1.0 { factor } else { -factor });
        notes.extend(better(trials, &best, &watched, worst));
    }
    let outputs = watched.iter().zip(errors).map(|(one, error)| OutputError {
        name: one.name.clone(),
        along: error,
        through: 0.0,
    });
    Ok((outputs.collect(), notes))
}

/// Outputs without forces and curvatures that are zero but for rounding, and their responses.
fn clear(trials: &SmallTrials, watched: &[Watched], own: &Responses) -> (Vec<Watched>, Responses) {
    let is_clear = |place: &usize| {
        let least = FAINT * trials.size(watched[*place].quantity);
        own.iter().flatten().any(|row| row[*place].abs() >= least)
    };
    let places: Vec<usize> = (0..watched.len()).filter(is_clear).collect();
    let of_row = |row: &Vec<f64>| places.iter().map(|&place| row[place]).collect();
    let of_trial = |rows: &Vec<Vec<f64>>| rows.iter().map(of_row).collect();
    let watched = places.iter().map(|&place| watched[place].clone()).collect();
    (watched, own.iter().map(of_trial).collect())
}

/// A mesh to compare with: how much finer it is, in words, too, and the error of the body's own mesh over the difference
/// to it.
fn other_mesh(trials: &SmallTrials) -> Result<((f64, &'static str), f64), String> {
    let takes_too_long = |finer: f64| time(trials, finer) > LONGEST;
    if takes_too_long(1.0) {
        return Err("the mesh is too large to be tried".to_owned());
    }
    let [twice, barely] = [LINEAR.twice, LINEAR.barely].map(|(_, factor)| factor);
    let root = 2f64.sqrt();
    Ok(match () {
        () if !takes_too_long(2.0) => ((2.0, "twice as fine"), twice),
        () if !takes_too_long(root) => ((root, "1.4 times as fine"), barely),
        () => ((1.0 / root, "1.4 times as coarse"), LINEAR.coarser[0]),
    })
}

/// Time of the trials on a mesh that is finer by a factor [s].
fn time(trials: &SmallTrials, finer: f64) -> f64 {
    let scene = trials.scene(finer, 0.0);
    let of_one = forecast(&Scene { stop_time: scene.step, ..scene }).run_time();
    of_one * trials.inputs.len() as f64
}

/// Outputs that respond in proportion to small inputs.
fn watched(scene: &Scene) -> Vec<Watched> {
    let responds = |quantity: Quantity, output: &Output| match quantity {
        Quantity::Stress => matches!(output.reading, Reading::Point { .. }),
        Quantity::Length
        | Quantity::Displacement
        | Quantity::Force
        | Quantity::ForcePerLength
        | Quantity::Curvature => true,
        _ => false,
    };
    let registry = Registry::structured(scene);
    let own = registry.variables.into_iter().filter_map(|variable| {
        let Slot::Output(output) = variable.slot else { return None };
        let quantity = variable.quantity.filter(|&quantity| responds(quantity, &output))?;
        Some(Watched { name: variable.name, quantity, rest: 0.0, capacity: None, output })
    });
    own.collect()
}

/// Changes of outputs by each input: a row of zeros, and one of changes for each trial.
fn responses(
    trials: &SmallTrials,
    finer: f64,
    watched: &[Watched],
) -> Result<Responses, ModelError> {
    let rows = |gravity: f64, inputs: &[Vec<f64>]| -> Result<Vec<Vec<f64>>, ModelError> {
        let scene = trials.scene(finer, gravity);
        check_memory(&scene, f64::INFINITY)?;
        let model = Model::build_for_states(&scene, 1, inputs.len())?;
        let mut state = model.initial_state();
        let row = |own: &Vec<f64>| {
            state.inputs[trials.place()].copy_from_slice(own);
            let mut cache = Cache::default();
            let mut reader = model.reader(&state, &mut cache)?;
            watched.iter().map(|one| reader.value(&one.output)).collect()
        };
        inputs.iter().map(row).collect()
    };
    let mut all = rows(0.0, &trials.inputs)?;
    if let Some(gravity) = trials.gravity {
        all.extend(rows(gravity, &trials.inputs[..1])?);
    }
    let rest = all.remove(0);
    let change = |row: Vec<f64>| row.iter().zip(&rest).map(|(a, b)| a - b).collect();
    // One experiment, as an input that leaves an output alone has no range of its own.
    let changes = all.into_iter().map(change);
    Ok(vec![std::iter::once(vec![0.0; rest.len()]).chain(changes).collect()])
}

/// Responses of the limit of fine meshes, by the error over the difference to another mesh.
fn extrapolated(own: &Responses, other: &Responses, factor: f64) -> Responses {
    let of_row = |(own, other): (&Vec<f64>, &Vec<f64>)| {
        own.iter().zip(other).map(|(a, b)| a + factor * (b - a)).collect()
    };
    let of_trial = |(own, other): (&Vec<Vec<f64>>, &Vec<Vec<f64>>)| {
        own.iter().zip(other).map(of_row).collect()
    };
    own.iter().zip(other).map(of_trial).collect()
}

/// Note on another discretisation with the same distance of nodes and a smaller error.
fn better(
    trials: &SmallTrials,
    best: &Responses,
    watched: &[Watched],
    worst: f64,
) -> Option<String> {
    let quadratic = (Mechanics::Fem, 2);
    let own = trials.discretisation()?;
    let others = match own {
        (Mechanics::Fem, 1) => vec![quadratic, (Mechanics::Rkpm, 1), (Mechanics::Efg, 1)],
        (Mechanics::Fem, _) => vec![(Mechanics::Rkpm, 1), (Mechanics::Efg, 1)],
        _ => vec![quadratic, (Mechanics::Fem, 1), (Mechanics::Rkpm, 1)],
    };
    let tried = others.into_iter().filter_map(|discretisation| {
        let other = trials.with(discretisation).filter(|other| time(other, 1.0) <= LONGEST)?;
        let found = responses(&other, 1.0, watched).ok()?;
        let error = differences(best, &found, watched).into_iter().fold(0.0, f64::max);
        Some((discretisation, error))
    });
    let ((mechanics, order), error) = tried.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let is_better = error < BETTER * worst;
    is_better.then(|| {
        let mut keys = Vec::new();
        if mechanics != own.0 {
            keys.push(format!("`mechanics = \"{}\"`", mechanics.key()));
        }
        if order != own.1 {
            keys.push(format!("`mesh.order = {order}`"));
        }
        let keys = keys.join(" and ");
        format!("{keys} with the same `mesh.spacing` would err by about {}", percent(error))
    })
}
