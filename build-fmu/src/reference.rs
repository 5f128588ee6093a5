//! Reference results inside a unit: the default experiment as this program computes it, for whoever
//! wants to know whether the unit does the same in another tool.
//!
//! Layered standard FMI-LS-REF 1.0.0-alpha.1 of the Modelica Association, and the format of
//! experiments that it refers to (ma-hs-experiments). Both are drafts.

use impinge::model::{Cache, Model, ModelError, Timeline};
use impinge::scene::Scene;
use impinge::variables::{Causality, Output, Registry, Slot, Variable};

use crate::archive::Entries;
use crate::documentation::escape;

const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
const EXPERIMENTS: &str = "experiments.exp";
const STIMULI: &str = "default_in.csv";
const RESULTS: &str = "default_ref.csv";

/// Runs the default experiment of a scene under its start values; its inputs and outputs as files of
/// the unit.
pub fn entries(scene: &Scene) -> Result<Entries, String> {
    let registry = Registry::of(scene);
    let model = Model::build(scene, scene.solver.threads)
        .map_err(|error| format!("no model for the reference results: {error}"))?;
    let results = results(&model, &registry)
        .map_err(|error| format!("the run for the reference results failed: {error}"))?;
    let files = [
        ("fmi-ls-manifest.xml", manifest()),
        (EXPERIMENTS, experiments(scene)),
        (STIMULI, stimuli(scene, &registry)),
        (RESULTS, results),
    ];
    Ok(files.map(|(name, text)| (format!("{FOLDER}/{name}"), text.into_bytes())).into())
}

/// What the files are.
fn manifest() -> String {
    let related = [
        (
            "application/x-ma-hs-experiments",
            EXPERIMENTS,
            "experiment/smoke-test",
            "The default experiment under the start values",
        ),
        ("text/csv", STIMULI, "other", "Inputs of the default experiment"),
        ("text/csv", RESULTS, "result", "Outputs of the default experiment"),
        (
            "application/toml",
            "../../resources/scene.toml",
            "model",
            "The scene that the unit was made from",
        ),
    ];
    let mut xml = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiReferences xmlns:fmi-ls=\"http://fmi-standard.org/fmi-ls-manifest\" \
         fmi-ls:fmi-ls-name=\"org.fmi-standard.fmi-ls-ref\" \
         fmi-ls:fmi-ls-version=\"1.0.0-alpha.1\" \
         fmi-ls:fmi-ls-description=\"Layered Standard providing information on related files \
         included in an FMU.\">\n",
    );
    for (kind, source, role, description) in related {
        xml += &format!(
            "  <Related type=\"{kind}\" source=\"{source}\" role=\"{role}\" \
             description=\"{description}\"/>\n"
        );
    }
    xml + "</fmiReferences>\n"
}

fn experiments(scene: &Scene) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <Experiments name=\"{name}\">\n  \
         <Experiment name=\"default\" description=\"The default experiment under the start values\" \
         startTime=\"0.0\" stopTime=\"{:?}\" stepSize=\"{:?}\">\n    \
         <Stimuli source=\"{STIMULI}\"/>\n    <References source=\"{RESULTS}\"/>\n  \
         </Experiment>\n</Experiments>\n",
        scene.stop_time,
        scene.step,
        name = escape(&scene.name),
    )
}

/// The inputs, held at their start values.
fn stimuli(scene: &Scene, registry: &Registry) -> String {
    let inputs = registry.of_causality(Causality::Input).map(|i| &registry.variables[i]);
    let (names, starts): (Vec<&str>, Vec<f64>) =
        inputs.filter_map(|input| Some((input.name.as_str(), input.real_start()?))).unzip();
    let rows = [0.0, scene.stop_time].map(|time| row(time, &starts));
    header(&names) + &rows.concat()
}

/// The outputs at the beginning and after every communication step.
fn results(model: &Model, registry: &Registry) -> Result<String, ModelError> {
    let (names, outputs): (Vec<&str>, Vec<&Output>) =
        registry.variables.iter().filter_map(output).unzip();
    let scene = model.scene();
    let timeline = Timeline::new(scene.step, scene.stop_time);
    let (mut state, mut cache) = (model.initial_state(), Cache::default());
    let mut text = header(&names);
    for done in 0..=timeline.count {
        if done > 0 {
            model.step(&mut state, &mut cache, timeline.length(done - 1))?;
            state.time = timeline.time(done);
        }
        let mut reader = model.reader(&state, &mut cache)?;
        let values: Result<Vec<f64>, _> = outputs.iter().map(|out| reader.value(out)).collect();
        text += &row(state.time, &values?);
    }
    Ok(text)
}

fn output(variable: &Variable) -> Option<(&str, &Output)> {
    match &variable.slot {
        Slot::Output(output) => Some((variable.name.as_str(), output)),
        _ => None,
    }
}

/// Names in quotes: those of arrays have commas.
fn header(names: &[&str]) -> String {
    let quoted = names.iter().map(|name| format!(",\"{name}\""));
    format!("\"time\"{}\n", quoted.collect::<String>())
}

fn row(time: f64, values: &[f64]) -> String {
    let values: String = values.iter().map(|value| format!(",{value:?}")).collect();
    format!("{time:?}{values}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    #[test]
    fn every_row_has_a_value_for_each_name() {
        let scene = impinge::scene::parse(SCENE, "scene.toml").unwrap();
        let files = entries(&scene).unwrap();
        let rows = |name: &str| -> Vec<Vec<f64>> {
            let text = str::from_utf8(&files[&format!("{FOLDER}/{name}")]).unwrap();
            let lines = text.lines().skip(1);
            lines.map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
        };
        let registry = Registry::of(&scene);
        let count = |causality| 1 + registry.of_causality(causality).count();
        let (inputs, outputs) = (rows(STIMULI), rows(RESULTS));
        assert_eq!((inputs.len(), outputs.len()), (2, 21));
        assert!(inputs.iter().all(|row| row.len() == count(Causality::Input)));
        assert!(outputs.iter().all(|row| row.len() == count(Causality::Output)));
        assert_eq!((outputs[0][0], outputs[20][0]), (0.0, 2e-7));
    }
}
