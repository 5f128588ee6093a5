//! The command `impinge report`: one HTML page of a run, or of a document that another program has made.

mod balances;
mod clips;
mod document;
mod error;
mod fields;
mod figures;
mod folder;
mod histories;
mod maps;
mod model;
mod names;
mod outputs;
mod packed;
mod page;
mod sketch;
mod story;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use impinge::output::replace;
use impinge::scene::{self, bytes_of};

use super::CliError;
use super::run::{Options, Run};
use document::{Document, FORMAT};

pub use document::Fact;
pub use error::ReportError;
pub use story::{FILE, Stopwatch, Story};

/// Name of the page in the folder of a run.
const PAGE: &str = "report.html";
/// Part of the head of every page, by which those of earlier runs are recognised.
const MARK: &str = "<meta name=\"generator\" content=\"impinge report\">";

/// Write one HTML page of a run: scene, droplets, maps, curves, balances, errors, warnings
#[derive(Args)]
pub struct Report {
    /// A scene (TOML), which is run first; the folder of a run; or a document (JSON), as of Python
    of: PathBuf,
    /// Name of the page [default: report.html in the folder of the run]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    options: Options,
}

impl Report {
    /// Writes the page; runs a scene first.
    pub fn execute(self) -> Result<String, CliError> {
        let Self { of, output, options } = self;
        let overwrites = options.overwrites();
        if of.is_dir() {
            options.refuse_settings("the folder of a run")?;
            let page = output.unwrap_or_else(|| of.join(PAGE));
            return Ok(written(&folder::document(&of)?, &page, overwrites)?);
        }
        if of.extension().is_some_and(|ending| ending == "json") {
            options.refuse_settings("a document")?;
            let page = output.unwrap_or_else(|| of.with_extension("html"));
            return Ok(written(&read_document(&of)?, &page, overwrites)?);
        }
        if let Some(page) = &output {
            refuse_foreign(page, overwrites)?;
        }
        let (text, folder) = Run::of(of, options).execute_in_folder()?;
        let page = output.unwrap_or_else(|| folder.join(PAGE));
        Ok(text + &written(&folder::document(&folder)?, &page, overwrites)?)
    }
}

/// Writes a page; returns where it is.
fn written(document: &Document, path: &Path, overwrites: bool) -> Result<String, ReportError> {
    refuse_foreign(path, overwrites)?;
    let html = page::page(document)?;
    replace(path, |out| out.write_all(html.as_bytes()))?;
    Ok(format!("report in {}\n", path.display()))
}

/// Largest file that is read as a whole [B].
const LARGEST: u64 = 1_000_000_000;

/// Reads a file of text.
fn text_of(path: &Path) -> Result<String, ReportError> {
    let bytes = bytes_of(path, LARGEST).map_err(ReportError::read(path))?;
    String::from_utf8(bytes).map_err(|_| ReportError::Damaged {
        path: path.to_owned(),
        what: "it is no text in UTF-8".to_owned(),
    })
}

/// Refuses to replace a file that is no page of this command.
fn refuse_foreign(path: &Path, overwrites: bool) -> Result<(), ReportError> {
    let is_own = || text_of(path).is_ok_and(|text| text.contains(MARK));
    match path.symlink_metadata().is_ok() && !overwrites && !is_own() {
        true => Err(ReportError::Exists { path: path.to_owned() }),
        false => Ok(()),
    }
}

/// Removes the page of an earlier run, which a new one would contradict.
pub fn remove_page(folder: &Path) -> Result<(), ReportError> {
    let path = folder.join(PAGE);
    match text_of(&path) {
        Ok(text) if text.contains(MARK) => {
            fs::remove_file(&path).map_err(ReportError::write(&path))
        }
        _ => Ok(()),
    }
}

/// Reads a document, and adds sketch and model of its scenes.
fn read_document(path: &Path) -> Result<Document, ReportError> {
    let text = text_of(path)?;
    let mut document: Document = serde_json::from_str(&text).map_err(|reason| {
        ReportError::Document { path: path.to_owned(), reason, allowed: FORMAT }
    })?;
    if document.format != FORMAT {
        let (path, found) = (path.to_owned(), document.format);
        return Err(ReportError::Format { path, found, allowed: FORMAT });
    }
    for named in std::mem::take(&mut document.scenes) {
        let of_unit = |title: &str| match (named.name.as_str(), title) {
            ("", title) => title.to_owned(),
            (name, "") => name.to_owned(),
            (name, title) => format!("{name}: {title}"),
        };
        match scene::parse(&named.text, &format!("scene of {}", named.name)) {
            Err(error) => document.notes.push(error.to_string()),
            Ok(scene) => {
                let mut sketches = sketch::sketches(&scene);
                sketches.iter_mut().for_each(|sketch| sketch.title = of_unit(&sketch.title));
                document.sketches.extend(sketches);
                let mut parts = model::parts(&scene, &[]);
                parts.iter_mut().for_each(|part| part.title = of_unit(&part.title));
                document.model.extend(parts);
            }
        }
    }
    Ok(document)
}
