//! `build-fmu`: packs a scene as an FMI unit.

mod archive;
mod documentation;
mod library;
mod picture;
mod words;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use impinge::fmi::xml::model_description;
use impinge::scene::{self, Scene};

/// Pack a scene as an FMI 2.0 co-simulation unit
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// The scene, a TOML file
    scene: PathBuf,
    /// Where to write the unit [default: NAME.fmu]
    #[arg(short, long, value_name = "FILE.fmu")]
    output: Option<PathBuf>,
    /// The library of impinge [default: the one beside this program]
    #[arg(long, value_name = "PATH")]
    library: Option<PathBuf>,
    /// Write only the modelDescription.xml to this file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "library"])]
    xml: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(done) => {
            println!("{done}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("build-fmu: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Does what is asked; answers with one line for people.
fn run(arguments: &Arguments) -> Result<String, String> {
    let file = arguments.scene.display().to_string();
    let text = fs::read_to_string(&arguments.scene)
        .map_err(|error| format!("cannot read the scene {file}: {error}"))?;
    let scene = scene::parse(&text, &file).map_err(|error| error.to_string())?;
    if let Some(path) = &arguments.xml {
        return write(path, model_description(&scene, &text).as_bytes());
    }
    let library = library::read(arguments.library.as_deref())?;
    let unit = unit(&scene, &text, library)?;
    let path = arguments.output.clone().unwrap_or_else(|| format!("{}.fmu", scene.name).into());
    write(&path, &unit)
}

/// The bytes of the unit.
fn unit(scene: &Scene, text: &str, library: Vec<u8>) -> Result<Vec<u8>, String> {
    let mut entries: archive::Entries = documentation::licences();
    entries.insert("modelDescription.xml".into(), model_description(scene, text).into());
    entries.insert("resources/scene.toml".into(), text.into());
    entries.insert("documentation/index.html".into(), documentation::page(scene).into());
    entries.insert("model.png".into(), picture::png(scene)?);
    entries.insert(library::entry(&scene.name), library);
    archive::zip(&entries)
}

fn write(path: &Path, bytes: &[u8]) -> Result<String, String> {
    fs::write(path, bytes).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(format!("{} ({:.1} kB)", path.display(), bytes.len() as f64 / 1e3))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    #[test]
    fn the_same_scene_makes_the_same_bytes() {
        let scene = scene::parse(SCENE, "scene.toml").unwrap();
        let make = || unit(&scene, SCENE, vec![1, 2, 3]).unwrap();
        assert_eq!(make(), make());
    }
}
