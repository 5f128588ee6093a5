//! The scene: plain, checked data that says what to model. Nothing here knows how.
//!
//! Text → `locate` (TOML with places) → `decode` (types) → `check` (sense) → [`Scene`].

mod check;
mod decode;
mod droplet;
mod error;
mod grid;
mod locate;
mod lookup;
mod types;

use std::fs;
use std::path::Path;

pub use droplet::{
    Arrival, Coupling, Droplet, DropletMethod, Fluid, Placement, Precision, Wall, WallStart,
};
pub use error::{Problem, SceneError};
pub use grid::Grid;
pub use lookup::Place;
pub use types::*;

use locate::Source;

/// Reads and checks the scene in a file.
pub fn read(path: &Path) -> Result<Scene, SceneError> {
    let file = path.display().to_string();
    let text = fs::read_to_string(path).map_err(|error| Problem {
        file: file.clone(),
        line: None,
        path: String::new(),
        value: String::new(),
        message: format!("cannot be read: {error}"),
        allowed: "a readable text file in UTF-8".to_owned(),
    })?;
    parse(&text, &file)
}

/// Reads and checks a scene's text; `file` is the name that messages show.
pub fn parse(text: &str, file: &str) -> Result<Scene, SceneError> {
    let source = Source::parse(text, file)?;
    let scene = decode::decode(&source)?;
    check::check(&scene, &source)?;
    Ok(scene)
}

/// Checks a scene whose constants were changed after it was read; problems name no line.
pub fn check(scene: &Scene) -> Result<(), SceneError> {
    let file = "the scene with its parameters as set";
    let text = toml::to_string(scene).map_err(|error| Problem {
        file: file.to_owned(),
        line: None,
        path: String::new(),
        value: String::new(),
        message: format!("cannot be written as text: {error}"),
        allowed: "values that a scene can hold".to_owned(),
    })?;
    check::check(scene, &Source::parse(&text, file)?).map_err(|mut error| {
        for problem in &mut error.problems {
            problem.line = None;
        }
        error
    })
}
