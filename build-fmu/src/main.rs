//! `build-fmu`: packs a scene as an FMI unit, and checks units.

mod archive;
mod cells;
mod documentation;
mod library;
mod picture;
mod platform;
mod reference;
mod terminals;
mod version;
mod words;

use std::fs;
use std::io::{self, Read, Write};
use std::iter;
use std::path::{Path, PathBuf};
use std::process::{self, ExitCode};

use archive::Entries;
use assessments::{Meshes, Store};
use clap::{CommandFactory, Parser};
use clap_complete::Shell;
use impinge::advice;
use impinge::model::{Model, notes_on_walls, records, to_be_recorded, tolerance};
use impinge::runtime::available_memory;
use impinge::scene::{self, Scene};
use platform::Platform;
use version::Version;

/// Pack a scene as an FMI co-simulation unit, or check a unit
#[derive(Parser)]
#[command(name = "build-fmu", version)]
struct Arguments {
    /// The scene, a TOML file; with --lint the unit
    #[arg(value_name = "SCENE", required_unless_present_any = ["rules", "instantiate", "completions", "man"])]
    file: Option<PathBuf>,
    /// Path of the unit [default: NAME.fmu]
    #[arg(short, long, value_name = "FILE.fmu")]
    output: Option<PathBuf>,
    /// The version of FMI; with 3 rings, tiles and fields are array variables
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: Version,
    /// A library of impinge, for this or another platform; repeatable [default: those installed with this program]
    #[arg(long, value_name = "[PLATFORM=]PATH", value_parser = library::Named::parse)]
    library: Vec<library::Named>,
    /// Pack for these platforms alone, such as linux64 and win64; repeatable [default: all whose library is there]
    #[arg(long, value_name = "PLATFORM", value_parser = platform::parse)]
    platform: Vec<Platform>,
    /// Run the default experiment and pack its inputs and outputs too
    #[arg(long)]
    reference: bool,
    /// Choose meshes and estimate errors anew, instead of reusing those stored for an equal scene
    #[arg(long)]
    fresh: bool,
    /// Write only the modelDescription.xml to this file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "library", "platform", "reference"])]
    xml: Option<PathBuf>,
    /// Check a unit of FMI 2.0, of any tool; its library is loaded to compare the GUID
    #[arg(long, conflicts_with_all = ["output", "library", "platform", "reference", "fresh", "xml"])]
    lint: bool,
    /// List the rules
    #[arg(long, requires = "lint")]
    rules: bool,
    /// Do not load the unit's library; use this for units of unknown origin
    #[arg(long, requires = "lint")]
    no_run: bool,
    /// Print completions for a shell
    #[arg(long, value_name = "SHELL", exclusive = true)]
    completions: Option<Shell>,
    /// Write the manual page, build-fmu.1, to a folder
    #[arg(long, value_name = "FOLDER", exclusive = true)]
    man: Option<PathBuf>,
    #[arg(long, hide = true, num_args = 4, exclusive = true)]
    instantiate: Option<Vec<String>>,
}

fn main() -> ExitCode {
    impinge::runtime::file_size::report_limits();
    let arguments = Arguments::parse();
    if let Some(details) = &arguments.instantiate {
        return fmu_lint::instantiate(details);
    }
    let answer = run(&arguments).and_then(|(said, code)| print(&said).map(|()| code));
    answer.unwrap_or_else(|error| {
        complain(&error);
        ExitCode::FAILURE
    })
}

/// Prints a text; a reader that closes the pipe early is not an error.
fn print(said: &str) -> Result<(), String> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{said}").and_then(|()| out.flush()) {
        Err(reason) if reason.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot print: {reason}"))
        }
        _ => Ok(()),
    }
}

/// Prints an error to standard error; ignores a failure to do so.
fn complain(message: &str) {
    let _ = writeln!(io::stderr(), "build-fmu: {message}");
}

/// Executes the command; returns its text and an exit code.
fn run(arguments: &Arguments) -> Result<(String, ExitCode), String> {
    let file = arguments.file.as_deref().unwrap_or(Path::new(""));
    if let Some(shell) = arguments.completions {
        return Ok((completions(shell), ExitCode::SUCCESS));
    }
    if let Some(folder) = &arguments.man {
        return Ok((manual_page(folder)?, ExitCode::SUCCESS));
    }
    if arguments.rules {
        return Ok((fmu_lint::rules(), ExitCode::SUCCESS));
    }
    if arguments.lint {
        let verdict = fmu_lint::lint(file, !arguments.no_run)?;
        return Ok((verdict.text, u8::from(verdict.has_errors).into()));
    }
    Ok((pack(arguments, file)?, ExitCode::SUCCESS))
}

/// Returns the completions of this program for a shell.
fn completions(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "build-fmu", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// Writes the manual page; returns its path.
fn manual_page(folder: &Path) -> Result<String, String> {
    let pages = || clap_mangen::generate_to(Arguments::command(), folder);
    let written = fs::create_dir_all(folder).and_then(|()| pages());
    let page = folder.join("build-fmu.1").display().to_string();
    written.map_err(|error| format!("cannot write {page}: {error}"))?;
    Ok(page)
}

/// Packs the scene in `path`; returns a one-line summary.
fn pack(arguments: &Arguments, path: &Path) -> Result<String, String> {
    let file = path.display().to_string();
    let text = scene::text_of(path, &file).map_err(|error| error.to_string())?;
    if let Some(note) = scene::note_on_reading(&text, &file) {
        complain(&format!("note: {note}"));
    }
    let (scene, warnings) =
        advice::parse_with_warnings(&text, &file).map_err(|error| error.with_excerpts())?;
    for warning in warnings {
        complain(&format!("warning: {warning}"));
    }
    for note in notes_on_walls(&scene) {
        complain(&format!("note: {note}"));
    }
    let store = Store::of_user(arguments.fresh);
    let levels = store.levels(&scene, available_memory()).found;
    for note in &levels.notes {
        complain(&format!("note: {note}"));
    }
    if let Some(target) = &arguments.xml {
        refuse_inputs(target, &[path])?;
        refuse_other_files(target, b"<?xml")?;
        return write(target, arguments.fmi.model_description(&levels.scene, &text).as_bytes());
    }
    let libraries = library::find(&arguments.library, &arguments.platform, arguments.fmi)?;
    let target = arguments.output.clone().unwrap_or_else(|| format!("{}.fmu", scene.name).into());
    let paths = libraries.iter().map(|library| library.path.as_path());
    refuse_inputs(&target, &iter::once(path).chain(paths).collect::<Vec<_>>())?;
    refuse_other_files(&target, b"PK")?;
    let warn = |warning: &str| complain(&format!("warning: {warning}"));
    let libraries = library::entries(&libraries, &scene.name, arguments.fmi, warn)?;
    for note in to_be_recorded(&scene).into_iter().chain(tolerance::note_on_sample(&scene)) {
        complain(&format!("note: {note}"));
    }
    let Meshes { scene: known, warnings, .. } = store.meshes(&levels.scene).found;
    for warning in warnings {
        complain(&format!("warning: {warning}"));
    }
    let text = tolerance::packed_text(&scene, &text, &known);
    let scene = known;
    // Kept alive, so that its shared parts are made only once.
    let reduced = tolerance::reduced_model(&scene, available_memory());
    let reduced = reduced.map_err(|error| error.to_string())?;
    for warning in reduced.iter().flat_map(Model::reduction_warnings) {
        complain(&format!("warning: {warning}"));
    }
    let reference = if arguments.reference {
        reference::entries(&scene, arguments.fmi)?
    } else {
        Entries::new()
    };
    let notes = reduced.as_ref().map_or(Vec::new(), Model::notes);
    let unit = unit((&scene, &text), &notes, arguments.fmi, [libraries, reference])?;
    write(&target, &unit)
}

/// Refuses to overwrite an input.
fn refuse_inputs(target: &Path, inputs: &[&Path]) -> Result<(), String> {
    let Ok(place) = target.canonicalize() else { return Ok(()) };
    let is_it = |input: &&&Path| {
        input.canonicalize().is_ok_and(|input| input == place) || is_same_file(input, target)
    };
    match inputs.iter().find(is_it) {
        None => Ok(()),
        Some(input) => Err(format!(
            "{} is {}, which is an input (allowed: another output file)",
            target.display(),
            input.display()
        )),
    }
}

/// Refuses to replace a file that does not begin like the new one.
fn refuse_other_files(target: &Path, begins: &[u8]) -> Result<(), String> {
    let is_other = |path: &Path| {
        let mut head = vec![0; begins.len()];
        let Ok(mut file) = fs::File::open(path) else { return false };
        match file.read(&mut head) {
            Ok(0) | Err(_) => false,
            Ok(count) => head[..count] != begins[..count],
        }
    };
    if !target.is_file() || !is_other(target) {
        return Ok(());
    }
    Err(format!(
        "{} exists and was not made by this program (allowed: another file, or remove this one first)",
        target.display()
    ))
}

#[cfg(unix)]
fn is_same_file(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |path: &Path| fs::metadata(path).map(|data| (data.dev(), data.ino())).ok();
    place(a).is_some_and(|place_of_a| place(b) == Some(place_of_a))
}

#[cfg(not(unix))]
fn is_same_file(_a: &Path, _b: &Path) -> bool {
    false
}

/// The bytes of the unit; `notes` describe its reductions, `others` are its libraries and what the options ask for.
fn unit(
    (scene, text): (&Scene, &str),
    notes: &[String],
    fmi: Version,
    others: [Entries; 2],
) -> Result<Vec<u8>, String> {
    let mut entries: Entries = others.into_iter().flatten().collect();
    entries.append(&mut documentation::licences());
    entries.insert("modelDescription.xml".into(), fmi.model_description(scene, text).into());
    entries.insert("resources/scene.toml".into(), text.into());
    entries.insert("resources/cells.json".into(), cells::json(scene).into());
    let page = documentation::page(scene, fmi, notes);
    entries.insert("documentation/index.html".into(), page.into());
    let icon = picture::png(scene)?;
    entries.append(&mut terminals::entries(scene, fmi, &icon)?);
    entries.insert(fmi.icon().into(), icon);
    let records = records(scene, scene.solver.threads);
    for (body, bytes) in records.map_err(|error| format!("no record of its drops: {error}"))? {
        entries.insert(format!("resources/records/{body}.record"), bytes);
    }
    let reductions = tolerance::stored_reductions(scene);
    for (body, bytes) in reductions.map_err(|error| format!("no reduction: {error}"))? {
        entries.insert(format!("resources/reduced/{body}.reduced"), bytes);
    }
    archive::zip(&entries)
}

/// Writes a file and creates missing folders. The file is written under a temporary name first, so that an earlier file
/// stays whole until then. A target that is not a regular file, such as a pipe, is written directly.
fn write(path: &Path, bytes: &[u8]) -> Result<String, String> {
    // A link is followed to its target.
    let place = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folders = place.parent().map_or(Ok(()), fs::create_dir_all);
    let written = folders.and_then(|()| match fs::metadata(&place) {
        Ok(data) if !data.is_file() => fs::write(&place, bytes),
        _ => replace(&place, bytes),
    });
    written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(format!("{} ({:.1} kB)", path.display(), bytes.len() as f64 / 1e3))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name = format!(".build-fmu.part{}", process::id());
    let unfinished = path.with_file_name(name);
    let filled = fs::write(&unfinished, bytes).and_then(|()| {
        if let Ok(data) = fs::metadata(path) {
            fs::set_permissions(&unfinished, data.permissions())?;
        }
        fs::rename(&unfinished, path)
    });
    filled.inspect_err(|_| {
        let _ = fs::remove_file(&unfinished);
    })
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
    fn equal_scenes_produce_equal_bytes() {
        let scene = scene::parse(SCENE, "scene.toml").unwrap();
        for version in [Version::Two, Version::Three] {
            let library = Entries::from([("binaries/linux64/Plate.so".into(), vec![1, 2, 3])]);
            let others = [library, Entries::new()];
            let make = || unit((&scene, SCENE), &[], version, others.clone()).unwrap();
            assert_eq!(make(), make());
        }
    }
}
