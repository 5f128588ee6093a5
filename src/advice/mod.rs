//! Whether what a scene says is plausible: values in wrong units, sizes that do not go together, parts
//! that were forgotten. Nothing here is refused; each finding is a [`Warning`].

mod arrangement;
mod cold;
mod films;
mod moved;
mod particles;
mod phases;
mod relations;
mod resolution;
mod values;

use std::fmt;

use crate::limits::number;
use crate::limits::plausible::{self, BESIDE_WARM, CRYOGENIC, Cold, Range};
use crate::scene::locate::{Path, Source};
use crate::scene::schema::Schema;
use crate::scene::{self, Problem, Scene, SceneError};

pub use films::MEASURED_FILMS;
pub use moved::implausible_place;
pub use resolution::{HeatError, Resolution};

/// Something that a scene says, and that is hardly meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    problem: Problem,
}

impl fmt::Display for Warning {
    /// `FILE:LINE: KEY = VALUE: why (did you mean …?)`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.problem.write_place(f)?;
        write!(f, " {}", self.problem.message)
    }
}

impl Warning {
    /// What the warning is about, wherever in a file it stands.
    pub fn subject(&self) -> String {
        format!("{}: {}", self.problem.path, self.problem.message)
    }

    /// The same of a scene that has no lines of its own.
    fn without_line(mut self) -> Self {
        self.problem.line = None;
        self
    }
}

/// Reads and checks a scene's text, and warns of what is implausible in it.
pub fn parse_with_warnings(text: &str, file: &str) -> Result<(Scene, Vec<Warning>), SceneError> {
    let (source, schema) = (Source::parse(text, file)?, Schema::of_scenes());
    let scene = scene::parse_located(&source, &schema)?;
    let found = found(&scene, &source, &schema);
    Ok((scene, found))
}

/// What is implausible in a scene whose constants were changed after it was read; no lines are named.
pub fn warnings(scene: &Scene) -> Vec<Warning> {
    let Ok(text) = toml::to_string(scene) else { return Vec::new() };
    let Ok(source) = Source::parse(&text, scene::CHANGED) else { return Vec::new() };
    let found = found(scene, &source, &Schema::of_scenes());
    found.into_iter().map(Warning::without_line).collect()
}

/// Everything in a checked scene that is hardly meant, in the order of the lines.
fn found(scene: &Scene, source: &Source, schema: &Schema) -> Vec<Warning> {
    let mut reviewer = Reviewer { scene, source, found: Vec::new() };
    let cold = scene.cold();
    values::review(&mut reviewer, schema, cold);
    phases::review(&mut reviewer, cold);
    relations::review(&mut reviewer);
    arrangement::review(&mut reviewer);
    particles::review(&mut reviewer);
    films::review(&mut reviewer);
    reviewer.found.sort_by_key(|warning| warning.problem.line);
    reviewer.found
}

/// Collects the warnings about a scene.
struct Reviewer<'a> {
    scene: &'a Scene,
    source: &'a Source<'a>,
    found: Vec<Warning>,
}

impl Reviewer<'_> {
    fn warn(&mut self, path: &Path, message: String) {
        let problem = self.source.problem(path, message, String::new());
        self.found.push(Warning { problem });
    }
}

/// What to say of a value outside of its plausible range.
fn implausible(range: &Range, value: f64) -> Option<String> {
    if range.holds(value) {
        return None;
    }
    let Range { what, unit, lowest, highest, .. } = range;
    let (low, high) = (number(*lowest), number(*highest));
    let mut message = format!("{what} is plausible from {low} to {high} {unit}");
    let is_cold = *unit == "K" && value < *lowest;
    if is_cold {
        let beside = if *lowest == BESIDE_WARM { " beside warmer ones" } else { "" };
        message += &format!("{beside}, and {} K is {}", number(value), celsius(value));
    }
    if let Some((meant, unit)) = range.meant(value) {
        let (meant, value) = (number(meant), number(value));
        message += &format!("; did you mean {meant} ({value} {unit})?");
    }
    if is_cold && value >= CRYOGENIC {
        message += " `cryogenic = true` says that a scene is meant to be this cold";
    }
    Some(message)
}

/// 0 °C [K].
const CELSIUS: f64 = 273.15;

/// A temperature [K] in °C.
fn celsius(temperature: f64) -> String {
    format!("{} °C", number(temperature - CELSIUS).replace('-', "−"))
}

/// What inputs are that act on bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    Temperature,
    /// Temperature of what flows by.
    Ambient,
    HeatTransfer,
    HeatFlux,
    Traction,
}

/// `NAME = VALUE: why (did you mean …?)` of a value that is hardly meant for an input of a unit of the scene.
pub fn implausible_input(
    scene: &Scene,
    name: &str,
    measure: Measure,
    value: f64,
) -> Option<String> {
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
    why.map(|why| format!("{name} = {}: {why}", number(value)))
}
