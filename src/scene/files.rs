//! Texts of the files that a scene names, added to its own: the scene is whole wherever its text goes.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io;
use std::path::{self, Component};

use toml::de::DeValue;

use super::LARGEST_FILE;
use super::error::{Problem, SceneError};
use super::file::bytes_of;
use super::locate::{Path, Source};

/// Comment above the texts.
const HEADING: &str = "\n# The texts of the files named above.\n";

/// Adds the texts of the files that a scene's text names to it; `path` is the place of the scene, `file` its name in
/// messages. Text that is no scene is returned unchanged.
pub fn with_files(text: String, path: &path::Path, file: &str) -> Result<String, SceneError> {
    let Ok(source) = Source::parse(&text, file) else { return Ok(text) };
    let folder = path.parent().unwrap_or_else(|| path::Path::new(""));
    let (mut found, mut problems) = (BTreeMap::new(), Vec::new());
    if source.value(&Path::default().key("files")).is_some() {
        SceneError::unless_empty(differences(&source, folder))?;
        return Ok(text);
    }
    for place in places(&source) {
        let name = source.value(&place).and_then(DeValue::as_str).unwrap_or_default();
        match read(folder, name) {
            Ok(content) => drop(found.insert(name.to_owned(), content)),
            Err([message, allowed]) => problems.push(source.problem(&place, message, allowed)),
        }
    }
    SceneError::unless_empty(problems)?;
    if found.is_empty() {
        return Ok(text);
    }
    let table = BTreeMap::from([("files", found)]);
    let Ok(added) = toml::to_string_pretty(&table) else { return Ok(text) };
    Ok(format!("{text}\n{HEADING}{added}"))
}

/// Places of the names of files: the G-code of filaments, and the parts of solids.
fn places(source: &Source) -> Vec<Path> {
    let bodies = Path::default().key("body");
    let Some(DeValue::Table(table)) = source.value(&bodies) else { return Vec::new() };
    let files = |name: &str| ["path.file", "shape.part.file"].map(|key| bodies.key(name).at(key));
    let places = table.keys().flat_map(|name| files(name.get_ref()));
    places
        .filter(|place| source.value(place).is_some_and(|value| value.as_str().is_some()))
        .collect()
}

/// Ends lines by line feeds, if carriage returns alone end some.
pub(super) fn with_line_feeds(text: &str) -> Cow<'_, str> {
    let mut after = text.split('\r').skip(1);
    match after.any(|rest| !rest.starts_with('\n')) {
        true => unified(text).into(),
        false => text.into(),
    }
}

/// A text whose lines end by line feeds.
fn unified(text: &str) -> String {
    text.replace("\r\n", "\n").replace('\r', "\n")
}

/// Reports texts in a scene that are not those of the files, where there are files, too.
fn differences(source: &Source, folder: &path::Path) -> Vec<Problem> {
    let differs = |place: &Path| {
        let name = source.value(place)?.as_str()?;
        let own = source.value(&Path::default().key("files").key(name))?.as_str()?;
        let content = read(folder, name).ok()?;
        (unified(own) != unified(&content)).then(|| {
            let message =
                format!("the text in `[files]` is not that of {}", folder.join(name).display());
            let allowed = "one of both: without its text in `[files]`, the file is read";
            source.problem(place, message, allowed.to_owned())
        })
    };
    places(source).iter().filter_map(differs).collect()
}

/// Returns true if links lead a name out of its folder: a scene of someone else would pack files of one's own.
fn leaves(folder: &path::Path, relative: &path::Path) -> bool {
    let own = if folder.as_os_str().is_empty() { path::Path::new(".") } else { folder };
    match (own.canonicalize(), own.join(relative).canonicalize()) {
        (Ok(folder), Ok(file)) => !file.starts_with(folder),
        // Reading a file that does not exist reports it.
        _ => false,
    }
}

/// Reads a file below a folder; the error is what is wrong and what is allowed.
fn read(folder: &path::Path, name: &str) -> Result<String, [String; 2]> {
    let is_plain = |part: Component| matches!(part, Component::Normal(_));
    let relative = path::Path::new(name);
    let plain = !name.is_empty() && !name.contains('\\') && relative.components().all(is_plain);
    if !plain || leaves(folder, relative) {
        let message = "the file is not below the folder of the scene".to_owned();
        return Err([message, "a file beside the scene, or in a folder below it".to_owned()]);
    }
    let bytes = bytes_of(&folder.join(relative), LARGEST_FILE / 2);
    let text = bytes.and_then(|bytes| {
        String::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    });
    text.map_err(|error| {
        let place = folder.join(relative);
        let message = format!("{} cannot be read: {error}", place.display());
        [message, "a readable text file in UTF-8".to_owned()]
    })
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;

    #[test]
    fn texts_that_are_not_those_of_the_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.toml");
        let text = |code: &str| {
            format!("[body.a.path]\nfile = \"a.gcode\"\n[files]\n\"a.gcode\" = \"{code}\"\n")
        };
        let read = |code: &str| with_files(text(code), &scene, "scene.toml");
        assert_eq!(read("G1").unwrap(), text("G1"));
        fs::write(folder.path().join("a.gcode"), "G1\r\n").unwrap();
        assert_eq!(read("G1\\n").unwrap(), text("G1\\n"));
        let error = read("G2").unwrap_err().to_string();
        assert!(error.contains("is not that of") && error.contains("a.gcode"), "{error}");
        assert!(error.contains("scene.toml:2"), "{error}");
    }

    #[test]
    fn carriage_returns_alone_end_lines() {
        for (text, lines) in [("a\rb\r", "a\nb\n"), ("a\r\nb\r", "a\nb\n"), ("a\r\n", "a\r\n")] {
            assert_eq!(with_line_feeds(text), lines);
        }
    }

    #[test]
    fn links_out_of_the_folder_are_refused() {
        let outer = tempfile::tempdir().unwrap();
        let own = outer.path().join("scene");
        fs::create_dir(&own).unwrap();
        fs::write(outer.path().join("secret"), "G1").unwrap();
        fs::write(own.join("a.gcode"), "G1").unwrap();
        symlink(outer.path().join("secret"), own.join("out.gcode")).unwrap();
        symlink(own.join("a.gcode"), own.join("in.gcode")).unwrap();
        assert_eq!(read(&own, "a.gcode").unwrap(), "G1");
        assert_eq!(read(&own, "in.gcode").unwrap(), "G1");
        let [message, _] = read(&own, "out.gcode").unwrap_err();
        assert!(message.contains("not below the folder"), "{message}");
        let [message, _] = read(&own, "none.gcode").unwrap_err();
        assert!(message.contains("cannot be read"), "{message}");
    }
}
