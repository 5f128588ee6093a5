//! The prebuilt libraries that serve every scene, one for each platform.

use std::collections::BTreeMap;
use std::env;
use std::path::{Path, PathBuf};

use fmu_lint::library as shared;
use impinge::scene::bytes_of;

use crate::archive::Entries;
use crate::platform::{self, Platform};
use crate::version::Version;

/// Largest size of a library in bytes.
const LARGEST: u64 = 1 << 30;

/// A library that the user names: `PATH` for this platform, or `PLATFORM=PATH`.
#[derive(Debug, Clone)]
pub struct Named {
    platform: Option<Platform>,
    path: PathBuf,
}

impl Named {
    /// Reads an argument. A path may contain `=` where no name of a platform precedes it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (platform, path) = match text.split_once('=') {
            Some((name, path)) if !name.contains(['/', '\\', '.']) => {
                (Some(platform::parse(name)?), path)
            }
            _ => (None, text),
        };
        if path.is_empty() {
            return Err("the path is empty (allowed: PATH or PLATFORM=PATH)".into());
        }
        Ok(Self { platform, path: path.into() })
    }
}

/// A library to be packed.
#[derive(Debug)]
pub struct Library {
    platform: Platform,
    pub path: PathBuf,
    /// A user asks for it, or the unit could not run here without it.
    is_required: bool,
}

/// Finds the libraries of a unit: those that the user names, and for other platforms those beside this program. `only`
/// lists the platforms if the user wants no others.
pub fn find(named: &[Named], only: &[Platform], fmi: Version) -> Result<Vec<Library>, String> {
    let own = Platform::own()?;
    let mut places = BTreeMap::new();
    for Named { platform, path } in named {
        let platform = platform.unwrap_or(own);
        let name = platform.name(fmi);
        if !only.is_empty() && !only.contains(&platform) {
            return Err(format!(
                "--library names one for {name}, --platform does not (allowed: both or none)"
            ));
        }
        let library = Library { platform, path: path.clone(), is_required: true };
        if places.insert(name, library).is_some() {
            return Err(format!("two libraries are for {name} (allowed: one for each platform)"));
        }
    }
    for platform in platform::ALL {
        let is_required = if only.is_empty() { platform == own } else { only.contains(&platform) };
        let name = platform.name(fmi);
        if places.contains_key(name) || !only.is_empty() && !is_required {
            continue;
        }
        let candidates = candidates(&platform, platform == own)?;
        match candidates.iter().find(|path| path.is_file()) {
            Some(path) => {
                places.insert(name, Library { platform, path: path.clone(), is_required });
            }
            None if is_required => return Err(missing(&platform, &candidates)),
            None => {}
        }
    }
    Ok(places.into_values().collect())
}

/// Places of a platform's library: the folder of this program, where cargo leaves it, and the folder of shared data of
/// an installation.
fn candidates(platform: &Platform, is_own: bool) -> Result<Vec<PathBuf>, String> {
    let program =
        env::current_exe().map_err(|error| format!("cannot find this program: {error}"))?;
    let folder = program.parent().unwrap_or(Path::new(""));
    let below = Path::new(platform.folder()).join(platform.library);
    let mut places = Vec::new();
    if is_own {
        places.push(folder.join(platform.library));
    }
    places.push(folder.join(&below));
    if let Some(prefix) = folder.parent() {
        places.push(prefix.join("share/impinge").join(below));
    }
    Ok(places)
}

fn missing(platform: &Platform, places: &[PathBuf]) -> String {
    let name = platform.folder();
    let places: Vec<_> = places.iter().map(|path| path.display().to_string()).collect();
    let remedy = match Platform::own() {
        Ok(own) if own == *platform => {
            "`cargo build --release` in the checkout makes it as target/release/".to_owned()
                + platform.library
        }
        _ => format!("docs/install.md shows how to make it for {name}"),
    };
    format!(
        "there is no library for {name} at {}\n{remedy}; copy it there, or name it with --library {name}=PATH.",
        places.join(" or ")
    )
}

/// The libraries as entries of a unit. A library that was found but does not fit is left out with a warning, which
/// `warn` receives, unless the unit requires it.
pub fn entries(
    libraries: &[Library],
    model: &str,
    fmi: Version,
    mut warn: impl FnMut(&str),
) -> Result<Entries, String> {
    let mut entries = Entries::new();
    for Library { platform, path, is_required } in libraries {
        match read(path, platform, fmi) {
            Ok(bytes) => {
                entries.insert(platform.entry(model, fmi), bytes);
            }
            Err(reason) if *is_required => return Err(reason),
            Err(reason) => {
                let name = platform.folder();
                warn(&format!("{reason}; the unit cannot run on {name}"));
            }
        }
    }
    Ok(entries)
}

/// Reads a library, which must serve units of this version on this platform.
fn read(path: &Path, platform: &Platform, fmi: Version) -> Result<Vec<u8>, String> {
    let bytes = bytes_of(path, LARGEST)
        .map_err(|error| format!("cannot read the library {}: {error}", path.display()))?;
    let refused =
        |reason: String| Err(format!("{} is no library of impinge: it {reason}", path.display()));
    let Some(library) = shared_library(&bytes, platform) else {
        return refused(format!("is no shared library for {}", platform.folder()));
    };
    if let Some(function) = fmi.functions().iter().find(|name| !library.symbols.contains(**name)) {
        return refused(format!("does not export {function}"));
    }
    let has = |mark: &str| bytes.windows(mark.len()).any(|window| window == mark.as_bytes());
    if !has(impinge::fmi::RELEASE) {
        return refused(format!("is not of version {}", env!("CARGO_PKG_VERSION")));
    }
    if !has(impinge::fmi::MARK) {
        return Err(format!(
            "{} is of another build: its sources differ from those of this program (allowed: a library built from the \
             same sources, as by `cargo build --release --workspace` and `make win64`)",
            path.display()
        ));
    }
    Ok(bytes)
}

/// The part of a file that is a shared library for this platform, if there is one.
fn shared_library(bytes: &[u8], platform: &Platform) -> Option<shared::Library> {
    let libraries = shared::read(bytes).ok()?;
    libraries.into_iter().find(|library| {
        library.format == platform.format && library.architecture == platform.architecture
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn own() -> Platform {
        Platform::own().unwrap()
    }

    #[test]
    fn missing_library_is_refused_with_its_places() {
        let found = find(&[], &[platform::parse("darwin64").unwrap()], Version::Two).unwrap_err();
        assert!(found.contains("there is no library for darwin64 at "), "{found}");
        assert!(found.contains("darwin64/libimpinge.dylib or ") && found.contains("--library"));
        let message = read(Path::new("/nowhere/lib.so"), &own(), Version::Two).unwrap_err();
        assert!(message.contains("cannot read the library /nowhere/lib.so"), "{message}");
    }

    #[test]
    fn another_file_is_no_library() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let folder = tempfile::tempdir().unwrap();
        let text = folder.path().join("notlib.txt");
        fs::write(&text, "fmi2DoStep fmi3DoStep").unwrap();
        let itself = env::current_exe().unwrap();
        for version in [Version::Two, Version::Three] {
            for path in [path, &text, &itself] {
                let message = read(path, &own(), version).unwrap_err();
                assert!(message.contains("is no library of impinge"), "{message}");
            }
        }
    }

    #[test]
    fn arguments_name_a_path_or_a_platform_with_its_path() {
        let win64 = platform::parse("win64").unwrap();
        for (text, platform, path) in [
            ("lib.so", None, "lib.so"),
            ("win64=a=b.dll", Some(win64), "a=b.dll"),
            ("x86_64-windows=C:\\impinge.dll", Some(win64), "C:\\impinge.dll"),
            ("./a=b/lib.so", None, "./a=b/lib.so"),
        ] {
            let named = Named::parse(text).unwrap();
            assert_eq!((named.platform, named.path.as_path()), (platform, Path::new(path)));
        }
        assert!(Named::parse("win32=a.dll").unwrap_err().contains("no platform win32"));
        assert!(Named::parse("win64=").unwrap_err().contains("the path is empty"));
    }

    #[test]
    fn a_platform_has_one_library() {
        let named = |texts: &[&str]| -> Vec<Named> {
            texts.iter().map(|text| Named::parse(text).unwrap()).collect()
        };
        let twice = named(&["win64=a.dll", "x86_64-windows=b.dll"]);
        let refused = find(&twice, &[], Version::Two).unwrap_err();
        assert!(refused.contains("two libraries are for win64"), "{refused}");
        let win64 = platform::parse("win64").unwrap();
        let refused = find(&named(&["a.so"]), &[win64], Version::Two).unwrap_err();
        assert!(refused.contains("--platform does not"), "{refused}");
        let found = find(&named(&["win64=a.dll"]), &[win64], Version::Two).unwrap();
        assert_eq!(
            found.iter().map(|library| library.path.as_path()).collect::<Vec<_>>(),
            [Path::new("a.dll")]
        );
    }
}
