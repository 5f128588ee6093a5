//! Tests that find what is implausible in a scene: values in wrong units, sizes that contradict each other, forgotten
//! parts. Nothing here is refused; the texts are the rules of `warning`.

mod arrangement;
mod bending;
mod cold;
mod cracks;
mod drying;
mod films;
mod flaws;
mod freezing;
mod hardening;
mod lattices;
mod moved;
mod particles;
mod phases;
mod power;
mod pressure;
mod relations;
mod resolution;
mod retraced;
mod strands;
mod stress_of_kernels;
mod substances;
mod symmetry;
mod values;
mod viscosity;
mod warm_bodies;
mod wide_supports;

use crate::limits::number;
use crate::limits::plausible::{self, BESIDE_WARM, CRYOGENIC, Cold, MELTS_BESIDE_WARM, Range};
use crate::scene::locate::{Path, Source};
use crate::scene::schema::Schema;
use crate::scene::{self, Scene, SceneError};
use crate::warning::{self, Finding, Warning};

pub use films::MEASURED_FILMS;
pub use lattices::LatticeErrors;
pub use moved::implausible_place;
pub use power::implausible_power;
pub use pressure::may_be_solved;
pub use resolution::{HeatError, Resolution};

/// Reads and checks a scene's text, and warns of what is implausible in it.
pub fn parse_with_warnings(text: &str, file: &str) -> Result<(Scene, Vec<Warning>), SceneError> {
    let (mut source, schema) = (Source::parse(text, file)?, Schema::of_scenes());
    let scene = scene::parse_located(&mut source, &schema)?;
    let found = found(&scene, (&source, true), &schema);
    Ok((scene, found))
}

/// Returns warnings about a scene whose constants were changed after it was read; no lines are named.
pub fn warnings(scene: &Scene) -> Vec<Warning> {
    let Ok(text) = toml::to_string(scene) else { return Vec::new() };
    let Ok(source) = Source::parse(&text, scene::CHANGED) else { return Vec::new() };
    found(scene, (&source, false), &Schema::of_scenes())
}

/// Returns the warnings of a checked scene in the order of its lines; `names_lines` is set if the source is the user's
/// file.
fn found(scene: &Scene, (source, names_lines): (&Source, bool), schema: &Schema) -> Vec<Warning> {
    let mut reviewer = Reviewer { scene, source, names_lines, found: Vec::new() };
    let cold = scene.cold();
    values::review(&mut reviewer, schema, cold);
    phases::review(&mut reviewer, cold);
    drying::review(&mut reviewer);
    pressure::review(&mut reviewer);
    viscosity::review(&mut reviewer);
    substances::review(&mut reviewer, schema);
    relations::review(&mut reviewer);
    hardening::review(&mut reviewer);
    arrangement::review(&mut reviewer);
    particles::review(&mut reviewer);
    films::review(&mut reviewer);
    flaws::review(&mut reviewer);
    cracks::review(&mut reviewer);
    symmetry::review(&mut reviewer);
    freezing::review(&mut reviewer);
    strands::review(&mut reviewer);
    bending::review(&mut reviewer);
    stress_of_kernels::review(&mut reviewer);
    wide_supports::review(&mut reviewer);
    warm_bodies::review(&mut reviewer);
    lattices::review(&mut reviewer);
    reviewer.found.sort_by_key(|(line, _)| *line);
    reviewer.found.into_iter().map(|(_, warning)| warning).collect()
}

/// Collects the warnings about a scene.
struct Reviewer<'a> {
    scene: &'a Scene,
    source: &'a Source<'a>,
    names_lines: bool,
    /// With the line of each.
    found: Vec<(Option<usize>, Warning)>,
}

impl Reviewer<'_> {
    /// Returns true if the text has a temperature [K] in degrees Celsius or Fahrenheit, so that nobody meant others.
    fn is_in_degrees(&self, path: &Path, temperature: f64) -> bool {
        self.scene.in_degrees.get(path) == Some(&temperature)
    }

    fn warn(&mut self, path: &Path, finding: Finding) {
        let mut problem = self.source.problem(path, String::new(), String::new());
        let line = problem.line;
        if !self.names_lines {
            problem.forget_text();
        }
        let subject = format!("{}: {finding}", problem.path);
        self.found.push((line, finding.at(problem.place()).of_subject(subject)));
    }
}

/// The finding of a value outside of its plausible range.
fn implausible(range: &Range, value: f64) -> Option<Finding> {
    if range.holds(value) {
        return None;
    }
    let Range { what, unit, lowest, highest, .. } = range;
    let (low, high) = (number(*lowest), number(*highest));
    let meant = range.meant(value);
    if *unit == "K" && value < *lowest {
        let beside = if [BESIDE_WARM, MELTS_BESIDE_WARM].contains(lowest) {
            " beside warmer ones"
        } else {
            ""
        };
        let (high, permit) = (format!("{high} K{beside}"), value >= CRYOGENIC);
        let (value, celsius) = (number(value), celsius(value));
        return Some(match meant {
            Some((meant, unit)) => {
                let meant = format!("{} ({value} {unit})", number(meant));
                let permit = if permit { COLD_ON_PURPOSE } else { "" };
                warning::celsius(what, low, high, &value, celsius, meant, permit)
            }
            None if permit => warning::cold_value(what, low, high, value, celsius),
            None => warning::implausible_value(what, low, high, ""),
        });
    }
    Some(match meant {
        Some((meant, unit_of_value)) => {
            let given = format!("{} {unit_of_value}", number(value));
            warning::wrong_unit(what, low, high, unit, number(meant), given)
        }
        None if *unit == "1" => warning::implausible_number(what, low, high),
        None => warning::implausible_value(what, low, high, unit),
    })
}

/// Remedy for scenes that are cold.
const COLD_ON_PURPOSE: &str = " If the scene is meant to be this cold, set `cryogenic = true`";

/// 0 °C [K].
const CELSIUS: f64 = 273.15;

/// A temperature [K] in °C.
fn celsius(temperature: f64) -> String {
    format!("{} °C", number(temperature - CELSIUS).replace('-', "−"))
}

/// Kinds of inputs that act on bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    Temperature,
    /// Temperature of a passing fluid.
    Ambient,
    HeatTransfer,
    HeatFlux,
    Traction,
}

/// Returns a warning about an implausible value of an input of a scene's unit.
pub fn implausible_input(
    scene: &Scene,
    name: &str,
    measure: Measure,
    value: f64,
) -> Option<Warning> {
    let range = match measure {
        Measure::Temperature => &plausible::TEMPERATURE,
        Measure::Ambient => &plausible::AMBIENT,
        Measure::HeatTransfer => &plausible::HEAT_TRANSFER,
        Measure::HeatFlux => &plausible::HEAT_FLUX,
        Measure::Traction => &plausible::TRACTION,
    };
    let is_temperature = matches!(measure, Measure::Temperature | Measure::Ambient);
    if range.holds(value) && (!is_temperature || value >= BESIDE_WARM) {
        return None;
    }
    let lowest = match scene.cold() {
        Cold::Meant if is_temperature => CRYOGENIC,
        Cold::BesideWarm if is_temperature => BESIDE_WARM,
        _ => range.lowest,
    };
    let why = implausible(&Range { lowest, ..range.clone() }, value);
    why.map(|why| why.at(place_of_input(name, value)))
}

/// `NAME = VALUE`
pub(crate) fn place_of_input(name: &str, value: f64) -> String {
    format!("{name} = {}", number(value))
}
