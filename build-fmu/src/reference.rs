//! Reference results inside a unit: the default experiment as computed by this program, for comparison with other
//! tools.
//!
//! Layered standard FMI-LS-REF 1.0.0-alpha.1 of the Modelica Association, and the format of experiments that it refers
//! to (ma-hs-experiments). Both are drafts.

use std::ops::Range;

use impinge::model::{Cache, Model, ModelError, Timeline, check_memory};
use impinge::runtime::available_memory;
use impinge::scene::Scene;
use impinge::variables::{
    ArrayRegistry, ArrayVariable, Causality, Content, Output, Registry, Slot, Variable,
};

use crate::archive::Entries;
use crate::documentation::escape;
use crate::version::Version;

const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
const EXPERIMENTS: &str = "experiments.exp";
const STIMULI: &str = "default_in.csv";
const RESULTS: &str = "default_ref.csv";

/// A column of a CSV file: a variable of the unit and the registry indices of its elements.
struct Column {
    name: String,
    elements: Range<usize>,
}

/// Runs the default experiment of a scene under its start values; its inputs and outputs as files of
/// the unit.
pub fn entries(scene: &Scene, fmi: Version) -> Result<Entries, String> {
    let registry = Registry::of(scene);
    let [inputs, outputs] = [Causality::Input, Causality::Output]
        .map(|causality| columns(scene, &registry, causality, fmi));
    check_memory(scene, available_memory()).map_err(|error| error.to_string())?;
    let model = Model::build(scene, scene.solver.threads)
        .map_err(|error| format!("no model for the reference results: {error}"))?;
    let results = results(&model, &registry, &outputs)
        .map_err(|error| format!("the run for the reference results failed: {error}"))?;
    let files = [
        ("fmi-ls-manifest.xml", manifest()),
        (EXPERIMENTS, experiments(scene)),
        (STIMULI, stimuli(scene, &registry, &inputs)),
        (RESULTS, results),
    ];
    Ok(files.map(|(name, text)| (format!("{FOLDER}/{name}"), text.into_bytes())).into())
}

fn columns(scene: &Scene, registry: &Registry, causality: Causality, fmi: Version) -> Vec<Column> {
    match fmi {
        Version::Two => {
            let column =
                |i: usize| Column { name: registry.variables[i].name.clone(), elements: i..i + 1 };
            registry.of_causality(causality).map(column).collect()
        }
        Version::Three => {
            let arrays = ArrayRegistry::of(scene).variables.into_iter();
            let wanted = arrays.filter(|array| array.causality(registry) == Some(causality));
            let column = |array: ArrayVariable| match array.content {
                Content::Elements(elements) => Some(Column { name: array.name, elements }),
                Content::Time | Content::Constants(..) => None,
            };
            wanted.filter_map(column).collect()
        }
    }
}

/// Manifest of the files.
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

/// The inputs, constant at their start values.
fn stimuli(scene: &Scene, registry: &Registry, columns: &[Column]) -> String {
    let starts: Vec<f64> = elements(registry, columns).filter_map(Variable::real_start).collect();
    let rows = [0.0, scene.stop_time].map(|time| row(time, columns, &starts));
    header(columns) + &rows.concat()
}

/// The outputs at the beginning and after every communication step.
fn results(model: &Model, registry: &Registry, columns: &[Column]) -> Result<String, ModelError> {
    let outputs: Vec<&Output> = elements(registry, columns).filter_map(output).collect();
    let scene = model.scene();
    let timeline = Timeline::new(scene.step, scene.stop_time);
    let (mut state, mut cache) = (model.initial_state(), Cache::default());
    let mut text = header(columns);
    for done in 0..=timeline.count {
        if done > 0 {
            model.step(&mut state, &mut cache, timeline.length(done - 1))?;
            state.set_time(timeline.time(done));
        }
        let mut reader = model.reader(&state, &mut cache)?;
        let values: Result<Vec<f64>, _> = outputs.iter().map(|out| reader.value(out)).collect();
        text += &row(state.time, columns, &values?);
    }
    Ok(text)
}

/// The elements of all columns, one after another.
fn elements<'a>(
    registry: &'a Registry,
    columns: &'a [Column],
) -> impl Iterator<Item = &'a Variable> {
    columns.iter().flat_map(|column| &registry.variables[column.elements.clone()])
}

fn output(variable: &Variable) -> Option<&Output> {
    match &variable.slot {
        Slot::Output(output) => Some(output),
        _ => None,
    }
}

/// Header of names in quotes: names of elements contain commas.
fn header(columns: &[Column]) -> String {
    let quoted = columns.iter().map(|column| format!(",\"{}\"", column.name));
    format!("\"time\"{}\n", quoted.collect::<String>())
}

/// A line of the values of all columns; those of an array with spaces between them.
fn row(time: f64, columns: &[Column], values: &[f64]) -> String {
    let mut texts = values.iter().map(|value| format!("{value:?}"));
    let cell = |column: &Column| {
        let values: Vec<String> = texts.by_ref().take(column.elements.len()).collect();
        format!(",{}", values.join(" "))
    };
    format!("{time:?}{}\n", columns.iter().map(cell).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    /// The rows of inputs and outputs, the values of a column together.
    fn rows(fmi: Version) -> [Vec<Vec<Vec<f64>>>; 2] {
        rows_of(SCENE, fmi)
    }

    fn rows_of(scene: &str, fmi: Version) -> [Vec<Vec<Vec<f64>>>; 2] {
        let scene = impinge::scene::parse(scene, "scene.toml").unwrap();
        let files = entries(&scene, fmi).unwrap();
        [STIMULI, RESULTS].map(|name| {
            let text = str::from_utf8(&files[&format!("{FOLDER}/{name}")]).unwrap();
            let cell = |text: &str| text.split(' ').map(|v| v.parse().unwrap()).collect();
            let lines = text.lines().skip(1);
            lines.map(|line| line.split(',').map(cell).collect()).collect()
        })
    }

    #[test]
    fn rows_have_one_value_per_name() {
        let registry = Registry::of(&impinge::scene::parse(SCENE, "scene.toml").unwrap());
        let count = |causality| 1 + registry.of_causality(causality).count();
        let [inputs, outputs] = rows(Version::Two);
        assert_eq!((inputs.len(), outputs.len()), (2, 21));
        assert!(inputs.iter().all(|row| row.len() == count(Causality::Input)));
        assert!(outputs.iter().all(|row| row.len() == count(Causality::Output)));
        assert_eq!((&outputs[0][0][..], &outputs[20][0][..]), (&[0.0][..], &[2e-7][..]));
    }

    /// Under a constant flux the highest temperature rises, so each row has its maximum at its own time.
    #[test]
    fn maxima_have_the_times_of_their_rows() {
        let scene = SCENE.replace("[body.plate]", "[body.plate]\npeaks = [\"temperature\"]");
        let registry = Registry::of(&impinge::scene::parse(&scene, "scene.toml").unwrap());
        let mut names = registry.of_causality(Causality::Output);
        let is_time = |i: usize| registry.variables[i].name == "plate.peak_temperature_time";
        let column = 1 + names.position(is_time).unwrap();
        let [_, outputs] = rows_of(&scene, Version::Two);
        assert!(outputs.iter().all(|row| row[0] == row[column]), "{outputs:?}");
    }

    #[test]
    fn arrays_are_columns_of_the_same_values() {
        let [scalars, arrays] = [Version::Two, Version::Three].map(rows);
        for (scalars, arrays) in scalars.iter().zip(&arrays) {
            assert!(arrays[0].len() < scalars[0].len());
            let flat = |rows: &[Vec<Vec<f64>>]| rows.concat().concat();
            assert_eq!(flat(scalars), flat(arrays));
        }
    }
}
