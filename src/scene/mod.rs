//! The scene: plain, checked data that describes what to model. Nothing here depends on the method.
//!
//! Text → `locate` (TOML with positions) → `shorthand` (units, substances) → `decode` (types) → `check` (consistency) →
//! [`Scene`].

mod bath;
mod cells;
pub(crate) mod check;
mod contact;
mod constants;
mod cracks;
mod decode;
mod defaults;
mod coupling;
mod droplet;
mod droplet_symmetry;
mod error;
mod excerpt;
mod expansion;
mod filament;
mod lattice;
mod face;
mod file;
mod files;
mod flaw;
mod footprint;
mod freezing;
mod gcode;
mod grid;
mod kinds;
mod large_strain;
mod load;
pub(crate) mod locate;
mod lookup;
mod materials;
mod notch;
mod part;
mod reading;
mod recording;
mod reduction;
mod refinement;
mod reservoir;
mod route;
mod sampling;
pub(crate) mod schema;
mod settings;
mod shorthand;
mod slip;
mod solid;
mod spelling;
mod types;
mod whole;

use std::io;
use std::path::Path;

pub use cells::Cells;
pub use check::takes_newton;
pub use constants::{
    BathConstant, Constant, DropletConstant, FilamentConstant, FluidConstant, LatticeConstant,
    LayersOf, OfferedConstant,
};
pub use contact::FirstContact;
pub use coupling::{Coupling, Wall, WallStart};
pub use droplet::{
    Arrival, Droplet, DropletMethod, DropletSymmetry, Governing, Placement, Precision,
    PressureAdvance, ReleaseBy, ViscousAdvance, velocity,
};
pub use error::{Problem, SceneError};
pub use filament::{
    ByInput, Filament, FilamentMethod, Nozzle, NozzlePath, PathFile, PathTable, Target,
};
pub use file::{bytes_of, open_file};
pub use flaw::{Flaw, FlawDepth, FlawGives, FlawShape, Worst};
pub use footprint::Profile;
pub use grid::{Grid, lateral_extents};
pub use kinds::Drawn;
pub use large_strain::{
    HeldFace, KernelIntegration, KernelSettings, LargeStrain, LoadComponent, Mechanics,
    MotionSteps, Quadrilateral, SmallStrain, SolidShape,
};
pub use lattice::{Lattice, LatticeArrangement, LatticeControl, LatticeNotch, LatticeSupport};
pub use lookup::{BodyInput, Place};
pub use materials::{MaterialChoice, Stratum};
pub use part::{Part, PartBody};
pub use recording::Recording;
pub use reduction::footprints_along;
pub use refinement::MeshFactors;
pub use reservoir::Reservoir;
pub use route::{Leg, Route};
pub use sampling::{FieldCells, Sampling};
pub use schema::{SCHEMA, derived_schema};
pub use shorthand::{NamedSubstance, quantity};
pub use spelling::hint;
pub use types::*;

pub(crate) use locate::Source;
use schema::Schema;

/// Reads and checks the scene in a file.
pub fn read(path: &Path) -> Result<Scene, SceneError> {
    let file = path.display().to_string();
    parse(&text_of(path, &file)?, &file)
}

/// Largest size of a scene's file in bytes: hundreds of thousands of lines.
pub const LARGEST_FILE: u64 = 16_000_000;

/// Reads the text of the scene in a file, unchecked, with the texts of the files that it names; `file` is the name in
/// messages.
pub fn text_of(path: &Path, file: &str) -> Result<String, SceneError> {
    let problem = |message: String, allowed: String| Problem {
        file: file.to_owned(),
        line: None,
        path: String::new(),
        value: String::new(),
        message,
        allowed,
        excerpt: None,
    };
    let unreadable = |error: io::Error| {
        problem(format!("cannot be read: {error}"), "a readable text file in UTF-8".to_owned())
    };
    let bytes = match bytes_of(path, LARGEST_FILE) {
        Err(error) if error.kind() == io::ErrorKind::FileTooLarge => {
            let message = "the file is too large for a scene".to_owned();
            return Err(problem(message, format!("at most {LARGEST_FILE} bytes")).into());
        }
        read => read.map_err(unreadable)?,
    };
    let text = String::from_utf8(bytes);
    let text =
        text.map_err(|error| unreadable(io::Error::new(io::ErrorKind::InvalidData, error)))?;
    files::with_files(text, path, file)
}

/// Number of bytes of a text that takes noticeable time to read.
const LARGE_TEXT: usize = 1_000_000;

/// Notice to show before a large text is read.
pub fn note_on_reading(text: &str, file: &str) -> Option<String> {
    let size = text.len() as f64 / 1e6;
    (text.len() > LARGE_TEXT).then(|| format!("reading {file}, {size:.1} MB"))
}

/// Parses and checks a scene's text; `file` is the name in messages.
pub fn parse(text: &str, file: &str) -> Result<Scene, SceneError> {
    parse_located(&mut Source::parse(text, file)?, &Schema::of_scenes())
}

/// Parses and checks a scene whose positions are known.
pub(crate) fn parse_located(source: &mut Source, schema: &Schema) -> Result<Scene, SceneError> {
    let misread = shorthand::expand(source, schema);
    let decoded =
        large_strain::with_names(source, |source| decode::decode(source, schema, misread));
    let mut scene = decoded?;
    scene.substances = source.substances().to_vec();
    scene.take_mean_expansions();
    scene.in_degrees = shorthand::in_degrees(source);
    scene.store_surfaces_below();
    scene.store_parts();
    check::check(&scene, source, schema)?;
    Ok(scene)
}

/// File name in messages about a modified scene.
pub(crate) const CHANGED: &str = "the scene with its parameters as set";

/// Checks a scene whose constants were modified after reading; problems have no line.
pub fn check(scene: &Scene) -> Result<(), SceneError> {
    let file = CHANGED;
    let text = toml::to_string(scene).map_err(|error| Problem {
        file: file.to_owned(),
        line: None,
        path: String::new(),
        value: String::new(),
        message: format!("cannot be written as text: {error}"),
        allowed: "values that a scene can hold".to_owned(),
        excerpt: None,
    })?;
    check::check(scene, &Source::parse(&text, file)?, &Schema::of_scenes()).map_err(|mut error| {
        error.problems.iter_mut().for_each(Problem::forget_text);
        error
    })
}
