//! Experiments with a body: its start values, and each load and flux that is zero at the start. Loads whose range
//! allows a smaller radius are also tried at the smallest.

use std::ops::Range;

use crate::inputs::{FaceInputKind, InputLayout, LoadInputs};
use crate::model::initial_inputs;
use crate::scene::{Load, Scene};

/// Largest number of experiments with a body.
const MOST: usize = 8;

/// Returns the inputs of the experiments with a scene of one body. First come its start values, unless all are at rest,
/// then a unit of every input that is zero at the start. Face temperatures are included only if everything is at rest.
/// If the radius of a load may decrease from its start value, each experiment is listed twice.
pub fn experiments(scene: &Scene) -> Vec<Vec<f64>> {
    let layout = InputLayout::of(scene);
    let start = initial_inputs(scene);
    let initial = scene.body.values().next().map_or(0.0, |body| body.initial_temperature());
    let groups = groups(scene, &layout);
    let rest = |group: &Group| if group.is_temperature { initial } else { 0.0 };
    let is_at_rest =
        |group: &&Group| start[group.range.clone()].iter().all(|&value| value == rest(group));
    let resting: Vec<&Group> = groups.iter().filter(is_at_rest).collect();
    let mut all = Vec::new();
    if resting.len() < groups.len() {
        all.push(start.clone());
    }
    let mut at_rest = start.clone();
    for group in &groups {
        at_rest[group.range.clone()].fill(rest(group));
    }
    // Constant face temperatures need no experiment if something else acts.
    let is_asked = |group: &&Group| !group.is_temperature || resting.len() == groups.len();
    for group in resting.iter().copied().filter(is_asked) {
        let mut inputs = at_rest.clone();
        inputs[group.range.clone()].fill(rest(group) + group.unit);
        all.push(inputs);
        // Among many cells, a single one has the finest shape.
        if group.range.len() > 1 {
            let mut inputs = at_rest.clone();
            inputs[group.range.start + group.range.len() / 2] = rest(group) + group.unit;
            all.push(inputs);
        }
    }
    let least = least_radii(scene, &layout, &start);
    if !least.is_empty() {
        all = all.into_iter().flat_map(|inputs| [shrunk(&inputs, &least), inputs]).collect();
    }
    all.truncate(MOST);
    all
}

/// Returns true if loads are also tried at the lower ends of their ranges of radius.
pub fn tries_least_radii(scene: &Scene) -> bool {
    !least_radii(scene, &InputLayout::of(scene), &initial_inputs(scene)).is_empty()
}

/// Places of the radii that inputs may make smaller than at the start, with their lower limits [m].
fn least_radii(scene: &Scene, layout: &InputLayout, start: &[f64]) -> Vec<(usize, f64)> {
    let loads = scene.load.iter().zip(&layout.loads);
    let least = |(load, places): (&Load, &LoadInputs)| {
        let ([lowest, _], place) = (load.range.radius?, places.radius?);
        (lowest < start[place]).then_some((place, lowest))
    };
    loads.filter_map(least).collect()
}

fn shrunk(inputs: &[f64], radii: &[(usize, f64)]) -> Vec<f64> {
    let mut inputs = inputs.to_vec();
    radii.iter().for_each(|&(place, radius)| inputs[place] = radius);
    inputs
}

/// Inputs of one amount.
struct Group {
    range: Range<usize>,
    is_temperature: bool,
    /// Value of a small experiment: 1 K, 1 Pa, 1 W/m², or the power of a load that makes this heat flux.
    unit: f64,
}

fn groups(scene: &Scene, layout: &InputLayout) -> Vec<Group> {
    let loads = scene.load.iter().zip(&layout.loads).flat_map(|(load, places)| {
        let radius = load.start_radius().unwrap_or_default();
        places.amounts.iter().map(move |(channel, range)| {
            let [density, _] = load.density(*channel, radius);
            Group { range: range.clone(), is_temperature: false, unit: 1.0 / density }
        })
    });
    let faces = layout.faces.iter().map(|face| Group {
        range: face.index..face.index + 1,
        is_temperature: face.kind != FaceInputKind::Flux,
        unit: 1.0,
    });
    loads.chain(faces).collect()
}
