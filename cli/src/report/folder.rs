//! The document of a run, from the files in its folder.

use std::path::Path;

use impinge::scene::{self, Scene};
use impinge::variables::{ArrayRegistry, CellFamily, Registry};

use super::balances::balances;
use super::clips::clips;
use super::document::{Document, FORMAT, Fact, Map};
use super::error::ReportError;
use super::figures::figures;
use super::histories::{arrays, histories, ranges, scalars};
use super::maps::maps;
use super::outputs::Outputs;
use super::sketch::sketches;
use super::story::{FILE, Story};
use crate::messages::Message;
use crate::run::TABLE;

/// Reads the folder of a run.
pub fn document(folder: &Path) -> Result<Document, ReportError> {
    let story = Story::read(folder)?;
    let path = folder.join(FILE);
    let scene = scene::parse(&story.scene, &path.display().to_string())
        .map_err(|error| ReportError::Damaged { path, what: error.to_string() })?;
    let outputs = Outputs::read(&folder.join(TABLE))?;
    let (registry, families) = (Registry::of(&scene), ArrayRegistry::of(&scene));
    let scalars = scalars(&registry, &families, &outputs);
    let mut maps = maps(&scene, folder)?;
    let of_cells = cells(&scene, &maps, &outputs);
    maps.extend(of_cells);
    let (warnings, notes) = messages(&story);
    Ok(Document {
        format: FORMAT,
        title: scene.name.clone(),
        description: scene.description.clone(),
        made_by: story.made_by.clone(),
        source: source(&story, folder),
        scenes: Vec::new(),
        figures: figures(&scene, &outputs, &story.timings),
        warnings,
        notes,
        sketches: sketches(&scene),
        clips: clips(&scene, folder)?,
        maps,
        histories: Some(histories(&scalars, &outputs)),
        tables: vec![ranges(&scalars)],
        balances: balances(&scene, &outputs),
        errors: story.errors,
        model: story.model,
        timings: story.timings,
        study: None,
    })
}

fn source(story: &Story, folder: &Path) -> Vec<Fact> {
    let mut facts = story.source.clone();
    facts.push(Fact::new("folder", folder.display().to_string()));
    facts.push(Fact::new("steps", story.steps.to_string()));
    facts
}

/// Maps of arrays, but for fields of solids whose nodes are shown.
fn cells(scene: &Scene, maps: &[Map], outputs: &Outputs) -> Vec<Map> {
    let is_shown = |body: &str| maps.iter().any(|map| map.title.starts_with(&format!("{body}: ")));
    let body = |family: &CellFamily| family.on.split('.').next().unwrap_or_default().to_owned();
    arrays(scene, outputs, |family| family.kind != "field" || !is_shown(&body(family)))
}

/// Warnings and notes of a run.
fn messages(story: &Story) -> (Vec<Message>, Vec<String>) {
    let of_kind = |kind: &'static str| story.messages.iter().filter(move |one| one.kind == kind);
    let mut warnings: Vec<Message> = of_kind("warning").cloned().collect();
    if !story.is_finished {
        warnings.push(Message {
            kind: "warning".to_owned(),
            place: FILE.to_owned(),
            message: "the run has not ended: the report shows what it had written".to_owned(),
            remedy: "make the report again once it has".to_owned(),
            id: String::new(),
        });
    }
    (warnings, of_kind("note").map(|one| one.message.clone()).collect())
}
