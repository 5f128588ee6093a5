//! Readings of a body over its experiments.

use std::collections::{BTreeMap, BTreeSet};

use super::experiment::experiments;
use super::sample::sample;
use crate::body::Reading;
use crate::model::{Cache, Model, ModelError};
use crate::quantity::Quantity;
use crate::scene::Scene;
use crate::variables::{Output, Registry, Slot};

/// Number of times at which outputs are sampled, from the first step to the last, and the same for stresses.
const TIMES: usize = 8;
const TIMES_OF_STRESS: usize = 3;
/// Approximate number of sampled places of all fields, and the fewest of an array.
const PLACES: usize = 16;
const LEAST_PLACES: usize = 8;

/// Outputs of a body whose error is estimated.
#[derive(Debug, Clone)]
pub struct Watched {
    pub name: String,
    pub quantity: Quantity,
    /// Value before anything acts.
    pub rest: f64,
    /// Heat capacity of the body where the output is the heat stored in it [J/K].
    pub capacity: Option<f64>,
    pub output: Output,
}

impl Watched {
    /// Returns the probe, field or body of the output.
    pub fn group(&self) -> &str {
        self.name.split_once('.').map_or(&self.name, |(owner, _)| owner)
    }
}

/// Returns the outputs of a scene of one body that depend on its mesh.
pub fn watched(scene: &Scene, is_mechanical: bool) -> Vec<Watched> {
    let registry = Registry::structured(scene);
    let wanted = |quantity: Quantity| match is_mechanical {
        true => matches!(quantity, Quantity::Stress | Quantity::Displacement),
        false => matches!(quantity, Quantity::Temperature | Quantity::Energy),
    };
    let initial = scene.body.values().next().map_or(0.0, |body| body.initial_temperature());
    let stored = scene
        .body
        .iter()
        .next()
        .and_then(|(name, body)| Some((format!("{name}.heat_stored"), body.heat_capacity()?)));
    let outputs = registry.variables.into_iter().filter_map(|variable| {
        let Slot::Output(output) = variable.slot else { return None };
        let quantity = variable.quantity.filter(|&quantity| wanted(quantity))?;
        let is_peak = matches!(output.reading, Reading::Peak { .. });
        let rest = if quantity == Quantity::Temperature { initial } else { 0.0 };
        let name = variable.name;
        let own = stored.as_ref().filter(|(stored, _)| *stored == name);
        let capacity = own.map(|(_, capacity)| *capacity);
        (!is_peak).then_some(Watched { name, quantity, rest, capacity, output })
    });
    let all: Vec<Watched> = outputs.collect();
    let mut of_fields: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (place, own) in all.iter().enumerate().filter(|(_, own)| is_of_grid(own)) {
        let array = own.name.split('[').next().unwrap_or_default().to_owned();
        of_fields.entry(array).or_default().push(place);
    }
    let most = (PLACES / of_fields.len().max(1)).max(LEAST_PLACES);
    let of_field = |places: &Vec<usize>| -> Vec<usize> {
        let is_of_rows = all[places[0]].name.contains(',');
        let stride = places.len().div_ceil(most);
        let taken: Vec<usize> = match is_of_rows {
            // A sample that follows no period, as rows and columns have.
            true => sample(places.len(), most),
            false => (stride - 1..places.len()).step_by(stride).collect(),
        };
        taken.into_iter().map(|n| places[n]).collect()
    };
    let taken: BTreeSet<usize> = of_fields.values().flat_map(of_field).collect();
    let is_taken = |(place, own): &(usize, Watched)| !is_of_grid(own) || taken.contains(place);
    all.into_iter().enumerate().filter(is_taken).map(|(_, own)| own).collect()
}

fn is_of_grid(watched: &Watched) -> bool {
    matches!(watched.output.reading, Reading::Point { alone: false, .. } | Reading::Mean { .. })
}

/// Values of outputs, experiment by experiment, at each time; the first is time zero.
pub type Responses = Vec<Vec<Vec<f64>>>;

/// Returns the sample times of outputs after time zero [s].
pub fn times(scene: &Scene, is_mechanical: bool) -> Vec<f64> {
    let count = if is_mechanical { TIMES_OF_STRESS } else { TIMES };
    let (step, stop) = (scene.step.min(scene.stop_time), scene.stop_time);
    let ratio = step / stop;
    let last = count - 1;
    let time = |k: usize| stop * ratio.powf((last - k) as f64 / last as f64);
    if ratio > 0.99 { vec![stop] } else { (0..count).map(time).collect() }
}

/// Values of the outputs of a scene of one body.
pub fn responses(scene: &Scene, watched: &[Watched]) -> Result<Responses, ModelError> {
    let is_mechanical = watched.iter().any(|one| one.quantity == Quantity::Stress);
    responses_at(scene, watched, &times(scene, is_mechanical))
}

/// Returns the values at given times [s].
pub fn responses_at(
    scene: &Scene,
    watched: &[Watched],
    times: &[f64],
) -> Result<Responses, ModelError> {
    let experiments = experiments(scene);
    let model = Model::build_for_states(scene, 1, experiments.len() * times.len())?;
    let run = |inputs: Vec<f64>| -> Result<Vec<Vec<f64>>, ModelError> {
        let mut state = model.initial_state();
        state.inputs = inputs;
        let mut cache = Cache::default();
        let mut rows = Vec::new();
        for time in std::iter::once(&0.0).chain(times) {
            if *time > state.time {
                let dt = time - state.time;
                model.step(&mut state, &mut cache, dt)?;
            }
            let mut reader = model.reader(&state, &mut cache)?;
            let row: Result<Vec<f64>, ModelError> =
                watched.iter().map(|one| reader.value(&one.output)).collect();
            rows.push(row?);
        }
        Ok(rows)
    };
    experiments.into_iter().map(run).collect()
}
