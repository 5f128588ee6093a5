use std::io;
use std::path::PathBuf;

use impinge::model::{BodyError, ModelError};
use impinge::output::OutputError;
use impinge::scene::{Scene, SceneError};
use impinge::variables::{Registry, Slot};

use super::inputs::TableError;
use super::report::ReportError;
use super::set::SetErrors;

/// Reasons why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    #[error("{}", .0.with_excerpts())]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Set(#[from] SetErrors),
    #[error(transparent)]
    Table(#[from] TableError),
    #[error("{name} is set (--set) and has a column in the table (--inputs); allowed: one of them")]
    GivenTwice { name: String },
    /// The run would take too long for anyone to wait.
    #[error(
        "the run would take about {time}; allowed: {most}, as with `--until {until}` ({proposed}), a larger `spacing` or a \
         lower `sound_speed` of droplets, or a lower speed"
    )]
    Months { time: String, most: String, until: String, proposed: String },
    /// The model refuses the value of an input.
    #[error("{name}: {message}")]
    Input { name: String, message: String },
    #[error(transparent)]
    Model(ModelError),
    #[error("in the step from t = {time} s: {reason}")]
    Step { time: f64, reason: Box<CliError> },
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(
        "{} holds the files of an earlier run, or others of their names ({}); allowed: another folder (--out), or \
         --overwrite",
        folder.display(),
        file.display()
    )]
    Taken { folder: PathBuf, file: PathBuf },
    #[error("{} is not a folder; allowed: a folder, or a name that is free (--out)", path.display())]
    NoFolder { path: PathBuf },
    #[error("{} could be one of the files of the run; allowed: another folder (--out)", file.display())]
    ReadInFolder { file: PathBuf },
    #[error(
        "there is no substance `{name}`{hint}; allowed: a name that `impinge substances` lists"
    )]
    UnknownSubstance { name: String, hint: String },
    #[error(
        "cannot write {}: {reason}; allowed: another file (--out) in a folder that exists",
        path.display()
    )]
    NewScene { path: PathBuf, reason: io::Error },
    #[error("there is no scene `{name}` to start from{hint}; allowed: {allowed}")]
    UnknownTemplate { name: String, hint: String, allowed: String },
    #[error("cannot write manual pages to {}: {reason}", folder.display())]
    Pages { folder: PathBuf, reason: io::Error },
    #[error("{option} is a setting of a run, and {what} is not run again; allowed: a scene")]
    NoRun { option: &'static str, what: String },
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error("cannot write the scene as it runs: {0}")]
    Text(#[from] toml::ser::Error),
    #[error("cannot print: {0}")]
    Print(io::Error),
}

impl CliError {
    /// Converts a model error; names the refused input.
    pub fn from_model(error: ModelError, scene: &Scene) -> Self {
        match error {
            ModelError::Body(BodyError::Input { index, message }) => {
                Self::Input { name: input_name(scene, index), message }
            }
            ModelError::Body(BodyError::Underway { index, message, after }) => {
                let message = format!("{message}, {after} s into the step");
                Self::Input { name: input_name(scene, index), message }
            }
            other => Self::Model(other),
        }
    }
}

/// Name of the input at a place.
pub fn input_name(scene: &Scene, index: usize) -> String {
    let variables = Registry::of(scene).variables;
    let input = variables.into_iter().find(|variable| variable.slot == Slot::Input(index));
    input.map_or_else(|| format!("input {index}"), |variable| variable.name)
}
