//! `build-fmu`: packs a scene as an FMI unit, and checks units.

mod archive;
mod documentation;
mod library;
mod lint;
mod picture;
mod reference;
mod terminals;
mod version;
mod words;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use archive::Entries;
use clap::Parser;
use impinge::model::notes_on_walls;
use impinge::scene::{self, Scene};
use version::Version;

/// Pack a scene as an FMI co-simulation unit, or check a unit
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// The scene, a TOML file; with --lint the unit
    #[arg(value_name = "SCENE", required_unless_present_any = ["rules", "instantiate"])]
    file: Option<PathBuf>,
    /// Where to write the unit [default: NAME.fmu]
    #[arg(short, long, value_name = "FILE.fmu")]
    output: Option<PathBuf>,
    /// The version of FMI; with 3 rings, tiles and fields are array variables
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: Version,
    /// The library of impinge [default: the one beside this program]
    #[arg(long, value_name = "PATH")]
    library: Option<PathBuf>,
    /// Run the default experiment and pack its inputs and outputs too
    #[arg(long)]
    reference: bool,
    /// Write only the modelDescription.xml to this file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "library", "reference"])]
    xml: Option<PathBuf>,
    /// Check a unit of FMI 2.0, of any tool; its library is loaded to compare the GUID
    #[arg(long, conflicts_with_all = ["output", "library", "reference", "xml"])]
    lint: bool,
    /// Say what is checked
    #[arg(long, requires = "lint")]
    rules: bool,
    /// Leave the unit's library alone, as befits units that nobody vouches for
    #[arg(long, requires = "lint")]
    no_run: bool,
    #[arg(long, hide = true, num_args = 4, exclusive = true)]
    instantiate: Option<Vec<String>>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(details) = &arguments.instantiate {
        return lint::instantiate(details);
    }
    let (said, code) = match run(&arguments) {
        Ok(answer) => answer,
        Err(error) => {
            eprintln!("build-fmu: {error}");
            return ExitCode::FAILURE;
        }
    };
    println!("{said}");
    code
}

/// Does what is asked; answers with text for people and an exit code.
fn run(arguments: &Arguments) -> Result<(String, ExitCode), String> {
    let file = arguments.file.as_deref().unwrap_or(Path::new(""));
    if arguments.rules {
        return Ok((lint::rules(), ExitCode::SUCCESS));
    }
    if arguments.lint {
        let verdict = lint::lint(file, !arguments.no_run)?;
        return Ok((verdict.text, u8::from(verdict.has_errors).into()));
    }
    Ok((pack(arguments, file)?, ExitCode::SUCCESS))
}

/// Packs the scene in `path`; answers with one line for people.
fn pack(arguments: &Arguments, path: &Path) -> Result<String, String> {
    let file = path.display().to_string();
    let text = fs::read_to_string(path)
        .map_err(|error| format!("cannot read the scene {file}: {error}"))?;
    let (scene, warnings) =
        scene::parse_with_warnings(&text, &file).map_err(|error| error.to_string())?;
    for warning in warnings {
        eprintln!("build-fmu: warning: {warning}");
    }
    for note in notes_on_walls(&scene) {
        eprintln!("build-fmu: note: {note}");
    }
    if let Some(path) = &arguments.xml {
        return write(path, arguments.fmi.model_description(&scene, &text).as_bytes());
    }
    let library = library::read(arguments.library.as_deref(), arguments.fmi)?;
    let reference = if arguments.reference {
        reference::entries(&scene, arguments.fmi)?
    } else {
        Entries::new()
    };
    let unit = unit(&scene, &text, library, arguments.fmi, reference)?;
    let path = arguments.output.clone().unwrap_or_else(|| format!("{}.fmu", scene.name).into());
    write(&path, &unit)
}

/// The bytes of the unit; `entries` come from the options.
fn unit(
    scene: &Scene,
    text: &str,
    library: Vec<u8>,
    fmi: Version,
    mut entries: Entries,
) -> Result<Vec<u8>, String> {
    entries.append(&mut documentation::licences());
    entries.insert("modelDescription.xml".into(), fmi.model_description(scene, text).into());
    entries.insert("resources/scene.toml".into(), text.into());
    entries.insert("documentation/index.html".into(), documentation::page(scene, fmi).into());
    let icon = picture::png(scene)?;
    entries.append(&mut terminals::entries(scene, fmi, &icon)?);
    entries.insert(fmi.icon().into(), icon);
    entries.insert(library::entry(&scene.name, fmi), library);
    archive::zip(&entries)
}

/// Writes a file, into folders that are made where they are missing.
fn write(path: &Path, bytes: &[u8]) -> Result<String, String> {
    let folders = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = folders.and_then(|()| fs::write(path, bytes));
    written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(format!("{} ({:.1} kB)", path.display(), bytes.len() as f64 / 1e3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_folders_are_made() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out/units/plate.fmu");
        write(&path, b"unit").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"unit");
        assert!(write(&path.join("below_a_file"), b"").unwrap_err().starts_with("cannot write"));
    }

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    #[test]
    fn the_same_scene_makes_the_same_bytes() {
        let scene = scene::parse(SCENE, "scene.toml").unwrap();
        for version in [Version::Two, Version::Three] {
            let make = || unit(&scene, SCENE, vec![1, 2, 3], version, Entries::new()).unwrap();
            assert_eq!(make(), make());
        }
    }
}
