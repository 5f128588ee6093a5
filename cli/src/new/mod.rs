//! The command `impinge new`.

use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::PathBuf;

use clap::Args;

use super::CliError;

/// Write a commented scene to start from, or list those that there are
#[derive(Args)]
pub struct New {
    /// Name of the scene
    kind: Option<String>,
    /// File to write [default: KIND.toml]
    #[arg(long, short, value_name = "FILE", requires = "kind")]
    out: Option<PathBuf>,
}

/// A scene to start from.
struct Template {
    name: &'static str,
    about: &'static str,
    text: &'static str,
}

const TEMPLATES: [Template; 6] = [
    Template {
        name: "drop-on-plate",
        about: "a drop of molten tin lands on steel: temperature below it",
        text: include_str!("drop-on-plate.toml"),
    },
    Template {
        name: "heated-box",
        about: "a pad heats a box in air: the plant of a controller",
        text: include_str!("heated-box.toml"),
    },
    Template {
        name: "laser-on-disc",
        about: "a laser heats a ceramic disc: temperature and stress",
        text: include_str!("laser-on-disc.toml"),
    },
    Template {
        name: "notched-beam",
        about: "a notched beam of concrete bends and breaks: load and crack over its opening",
        text: include_str!("notched-beam.toml"),
    },
    Template {
        name: "pressed-rubber",
        about: "a pad of rubber is pressed by a fifth: the force that it takes",
        text: include_str!("pressed-rubber.toml"),
    },
    Template {
        name: "strand-on-bed",
        about: "a nozzle lays a strand of molten wax on a heated bed: its shape and heat",
        text: include_str!("strand-on-bed.toml"),
    },
];

impl New {
    pub fn execute(&self) -> Result<String, CliError> {
        let Some(kind) = &self.kind else { return Ok(list()) };
        let template = TEMPLATES.iter().find(|template| template.name == kind);
        let template = template.ok_or_else(|| unknown(kind))?;
        let path = self.out.clone().unwrap_or_else(|| PathBuf::from(format!("{kind}.toml")));
        let write = || File::create_new(&path)?.write_all(template.text.as_bytes());
        write().map_err(|reason| CliError::NewScene { path: path.clone(), reason })?;
        let path = path.display();
        Ok(format!("{path}: {}\nnext: impinge check {path}\n", template.about))
    }
}

fn list() -> String {
    let mut text = String::new();
    for Template { name, about, .. } in TEMPLATES {
        let _ = writeln!(text, "  {name:16}{about}");
    }
    text
}

fn unknown(kind: &str) -> CliError {
    let names = TEMPLATES.map(|template| template.name);
    CliError::UnknownTemplate {
        name: kind.to_owned(),
        hint: impinge::scene::hint(kind, names.iter().copied()),
        allowed: names.join(", "),
    }
}
