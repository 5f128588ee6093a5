//! The command `impinge check`.

mod accuracy;
pub mod bodies;
mod brief;
pub mod conditions;
mod cost;
mod errors;
mod model;
pub mod omissions;
mod readings;
mod variables;
pub mod words;

use std::fmt::Write;
use std::path::PathBuf;

use assessments::{Assessed, Meshes, Store};
use clap::Args;
use impinge::model::tolerance::{self, BodyEstimate};
use impinge::model::{Forecast, Model, Timeline, check_memory, forecast};
use impinge::output::{Discs, FilesForecast};
use impinge::runtime::{Usage, available_memory};
use impinge::scene::Scene;

use super::patience;
use super::{CliError, run};
use brief::{Findings, brief};
use cost::Preparation;
use variables::variables;

/// Report what a scene models and leaves out, its cost and its expected errors
#[derive(Args)]
pub struct Check {
    /// The scene, a TOML file
    scene: PathBuf,
    /// Add conditions, meshes and the errors of all outputs
    #[arg(long, short)]
    verbose: bool,
    /// List parameters, inputs and outputs
    #[arg(long)]
    list: bool,
    /// List them with the meaning of every output
    #[arg(long)]
    outputs: bool,
    /// Choose meshes and estimate errors anew, instead of reusing those stored for an equal scene
    #[arg(long)]
    fresh: bool,
}

impl Check {
    /// Reports on the scene.
    pub fn execute(&self) -> Result<String, CliError> {
        let begun = Usage::now();
        let (scene, mut warnings) = patience::read(&self.scene)?;
        check_memory(&scene, available_memory()).map_err(CliError::Model)?;
        if let Some(note) = tolerance::note_on_sample(&scene) {
            super::print_message("note", &note);
        }
        let store = Store::of_user(self.fresh);
        let levels = store.levels(&scene, available_memory());
        let Assessed { found: meshes, cost, is_stored } = store.meshes(&levels.found.scene);
        let preparation = Preparation { begun, costs: [levels.cost, cost] };
        let Meshes { scene, estimates, warnings: of_meshes } = meshes;
        warnings.extend(of_meshes);
        let reduced =
            tolerance::reduced_model(&scene, available_memory()).map_err(CliError::Model)?;
        warnings.extend(reduced.iter().flat_map(Model::reduction_warnings));
        super::warn(&warnings);
        let forecast = forecast(&scene);
        let rows = Timeline::new(scene.step, scene.stop_time).count + 1;
        let times = run::snapshots(rows - 1, run::default_fields_every(rows - 1));
        let mut text = brief(
            &scene,
            &Findings {
                forecast: &forecast,
                preparation: &preparation,
                estimates: &estimates,
                files: FilesForecast::of(&scene, &forecast, [rows, times], Discs::Sections),
                warnings: warnings.len(),
            },
        );
        if self.verbose {
            text.push_str(&sections(&scene, &forecast, &estimates));
            text.push_str(&reductions(reduced.as_ref(), &levels.found.notes));
            if is_stored {
                text.push_str(STORED);
            }
        }
        if self.list || self.outputs {
            text.push_str(&variables(&scene, self.outputs));
        }
        Ok(text)
    }
}

/// Note on meshes from the store.
const STORED: &str =
    "\nMeshes and errors were stored for an equal scene; --fresh finds them anew.\n";

/// Everything about the scene's parts.
fn sections(scene: &Scene, forecast: &Forecast, estimates: &[BodyEstimate]) -> String {
    let sections = [
        ("Bodies", bodies::bodies(scene)),
        ("Bodies without extent", bodies::lumps(scene)),
        ("Bodies of large strain", bodies::large_strains(scene)),
        ("Droplets", bodies::droplets(scene)),
        ("Filaments", bodies::filaments(scene)),
        ("Lattices", bodies::lattices(scene)),
        ("Faces", conditions::faces(scene)),
        ("Loads", conditions::loads(scene)),
        ("Probes", readings::probes(scene)),
        ("Fields", readings::fields(scene)),
        ("Walls", conditions::walls(scene)),
        ("Couplings", conditions::couplings(scene)),
        ("Model", model::notes(forecast)),
        ("Errors by the mesh", errors::errors(estimates)),
    ];
    let mut text = String::new();
    for (title, body) in sections.iter().filter(|(_, body)| !body.is_empty()) {
        let _ = write!(text, "\n{title}\n{body}");
    }
    text
}

/// Lists orders and bounds of reduced solids, and the levels chosen for open ones.
fn reductions(model: Option<&Model>, levels: &[String]) -> String {
    let mut notes = levels.to_vec();
    notes.extend(model.into_iter().flat_map(Model::notes));
    let lines: String = notes.into_iter().map(|note| format!("  {note}\n")).collect();
    if lines.is_empty() { lines } else { format!("\nReduction\n{lines}") }
}
