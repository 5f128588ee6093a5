//! Inputs that an output follows without delay.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::registry::{Causality, Output, Registry, Slot};
use crate::body::{Direct, Reading, direct_of_point, totals};
use crate::inputs::{FaceInputKind, InputLayout, LoadInputs};
use crate::scene::Scene;

impl Registry {
    /// Value references of the inputs that an output follows without delay.
    ///
    /// Heat takes time to move; prescribed temperatures and tractions act immediately.
    pub fn dependencies(&self, scene: &Scene, output: &Output) -> Vec<usize> {
        let reach = Reach::of(scene, output);
        self.inputs_within(scene, &InputLayout::of(scene), reach)
    }

    /// Every output with its [`dependencies`](Self::dependencies); outputs that follow the same
    /// inputs share one list.
    pub fn all_dependencies(&self, scene: &Scene) -> Vec<(usize, Rc<[usize]>)> {
        let layout = InputLayout::of(scene);
        let mut lists: BTreeMap<Reach, Rc<[usize]>> = BTreeMap::new();
        let outputs = self.variables.iter().enumerate().filter_map(|(i, variable)| {
            let Slot::Output(output) = &variable.slot else { return None };
            let reach = Reach::of(scene, output);
            let list = lists
                .entry(reach)
                .or_insert_with(|| self.inputs_within(scene, &layout, reach).into());
            Some((i, Rc::clone(list)))
        });
        outputs.collect()
    }

    fn inputs_within(&self, scene: &Scene, layout: &InputLayout, reach: Reach) -> Vec<usize> {
        let direct = direct_inputs(scene, layout, reach);
        self.of_causality(Causality::Input)
            .filter(|&i| matches!(self.variables[i].slot, Slot::Input(at) if direct[at]))
            .collect()
    }
}

/// Returns, for each input by its place in a state, whether any of these outputs follows it without delay. Tunable
/// parameters count as inputs.
pub fn followed_inputs(scene: &Scene, outputs: &[&Output]) -> Vec<bool> {
    let layout = InputLayout::of(scene);
    let reaches: BTreeSet<Reach> = outputs.iter().map(|output| Reach::of(scene, output)).collect();
    let mut followed = vec![false; layout.len];
    for reach in reaches {
        let direct = direct_inputs(scene, &layout, reach);
        followed.iter_mut().zip(direct).for_each(|(any, direct)| *any |= direct);
    }
    followed
}

/// Returns true if an output is declared to follow no input without delay.
pub fn follows_nothing(scene: &Scene, output: &Output) -> bool {
    Reach::of(scene, output).direct == Direct::Nothing
}

/// All data that determine which inputs an output follows without delay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Reach<'a> {
    body: &'a str,
    direct: Direct,
}

impl<'a> Reach<'a> {
    fn of(scene: &'a Scene, output: &Output) -> Self {
        let body = scene.body.keys().nth(output.body).expect("registered from a body");
        let direct = match output.reading {
            Reading::Point { quantity, .. } | Reading::Mean { quantity, .. } => {
                direct_of_point(scene, body, quantity)
            }
            Reading::Total(place) => {
                let mut totals = totals(scene, body).into_iter();
                let found = totals.find(|(other, _)| *other == place);
                found.map_or(Direct::Nothing, |(_, descriptor)| descriptor.direct)
            }
            Reading::Flaw { .. } => Direct::TemperaturesAndTractions,
            Reading::Cell { .. } | Reading::Peak { .. } | Reading::Error => Direct::Nothing,
        };
        Self { body, direct }
    }
}

fn direct_inputs(scene: &Scene, layout: &InputLayout, reach: Reach) -> Vec<bool> {
    let mut direct = vec![false; layout.len];
    if reach.direct == Direct::Nothing {
        return direct;
    }
    if reach.direct == Direct::OwnInputs {
        direct[layout.of_body(reach.body)].fill(true);
    }
    let follows_heat = reach.direct == Direct::Drives;
    for face in &layout.faces {
        let acts = follows_heat || face.kind == FaceInputKind::Temperature;
        if face.body == reach.body && acts {
            direct[face.index] = true;
        }
    }
    if follows_heat || reach.direct == Direct::TemperaturesAndTractions {
        for (load, inputs) in scene.load.iter().zip(&layout.loads) {
            if load.body_and_face().0 == reach.body {
                mark_amounts(inputs, follows_heat, &mut direct);
            }
        }
    }
    direct
}

/// Marks the tractions of a load, its heat too where that is followed, and where they act.
fn mark_amounts(inputs: &LoadInputs, follows_heat: bool, direct: &mut [bool]) {
    let followed = inputs.amounts.iter().filter(|(channel, _)| follows_heat || !channel.is_heat());
    let mut any = false;
    for (_, range) in followed {
        direct[range.clone()].fill(true);
        any = true;
    }
    if any {
        for index in [inputs.x, inputs.y, inputs.radius].into_iter().flatten() {
            direct[index] = true;
        }
    }
}
