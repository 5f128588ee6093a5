//! The record of a run in `run.json` beside its files: its scene with all choices, messages and times.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use impinge::model::tolerance::BodyEstimate;
use impinge::model::{Model, Timeline};
use impinge::output::replace;
use impinge::runtime::Usage;
use impinge::scene::Scene;
use serde::{Deserialize, Serialize};

use super::document::{BodyErrors, ErrorOf, Errors, Fact, Part, Timing};
use super::error::ReportError;
use super::{model, text_of};
use crate::messages::{self, Message};

/// Name of the file.
pub const FILE: &str = "run.json";
/// Version of the file.
const FORMAT: u32 = 1;

/// The record of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Story {
    pub format: u32,
    pub made_by: String,
    /// False while the run goes on, and of one that was interrupted.
    pub is_finished: bool,
    /// The scene with all modifications and choices.
    pub scene: String,
    pub steps: usize,
    /// Files and settings.
    pub source: Vec<Fact>,
    pub messages: Vec<Message>,
    pub model: Vec<Part>,
    pub errors: Option<Errors>,
    pub timings: Vec<Timing>,
}

/// Times of the parts of a run.
pub struct Stopwatch {
    last: Instant,
    timings: Vec<Timing>,
}

impl Stopwatch {
    pub fn start() -> Self {
        Self { last: Instant::now(), timings: Vec::new() }
    }

    /// Ends a part.
    pub fn lap(&mut self, label: &str) {
        let now = Instant::now();
        let seconds = (now - self.last).as_secs_f64();
        self.timings.push(Timing { label: label.to_owned(), seconds });
        self.last = now;
    }
}

impl Story {
    /// The story of a run that begins; `source` are its files and settings.
    pub fn begin(
        model: &Model,
        estimates: &[BodyEstimate],
        source: &[Fact],
    ) -> Result<Self, toml::ser::Error> {
        let scene = model.scene();
        Ok(Self {
            format: FORMAT,
            made_by: made_by(),
            is_finished: false,
            scene: toml::to_string(scene)?,
            steps: Timeline::new(scene.step, scene.stop_time).count,
            source: source.to_vec(),
            messages: Vec::new(),
            model: model::parts(scene, &model.notes()),
            errors: errors(scene, estimates),
            timings: Vec::new(),
        })
    }

    /// Adds what is known at the end.
    pub fn end(&mut self, stopwatch: &Stopwatch) {
        self.is_finished = true;
        self.timings.clone_from(&stopwatch.timings);
        let usage = Usage::now();
        let memory = format!("{:.0} MB", usage.peak_memory / 1e6);
        self.source.push(Fact::new("memory at most", memory));
    }

    /// Writes the file, with all messages that have been printed.
    pub fn write(&mut self, folder: &Path) -> Result<(), ReportError> {
        self.messages = messages::printed();
        let path = folder.join(FILE);
        let text = serde_json::to_string_pretty(self)?;
        Ok(replace(&path, |out| out.write_all(text.as_bytes()))?)
    }

    /// Reads the file of a run.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let path = folder.join(FILE);
        if !path.is_file() {
            return Err(ReportError::NoRun { path: folder.to_owned() });
        }
        let text = text_of(&path)?;
        let story: Self = serde_json::from_str(&text).map_err(|reason| ReportError::Damaged {
            path: path.clone(),
            what: reason.to_string(),
        })?;
        match story.format {
            FORMAT => Ok(story),
            found => Err(ReportError::Format { path, found, allowed: FORMAT }),
        }
    }
}

/// The program and its version.
pub fn made_by() -> String {
    format!("impinge {}", env!("CARGO_PKG_VERSION"))
}

/// Estimated errors of solids, if any were estimated.
fn errors(scene: &Scene, estimates: &[BodyEstimate]) -> Option<Errors> {
    let of_body = |estimate: &BodyEstimate| BodyErrors {
        body: estimate.body.clone(),
        outputs: estimate
            .outputs
            .iter()
            .map(|one| ErrorOf { name: one.name.clone(), along: one.along, through: one.through })
            .collect(),
        notes: estimate.notes.clone(),
    };
    let bodies: Vec<_> = estimates.iter().map(of_body).collect();
    (!bodies.is_empty()).then_some(Errors { tolerance: scene.fidelity.tolerance, bodies })
}
