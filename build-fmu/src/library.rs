//! The prebuilt library that serves every scene.

use std::env::{self, consts};
use std::fs;
use std::path::{Path, PathBuf};

use crate::version::Version;

/// Path of the library inside the unit of a model.
pub fn entry(model: &str, fmi: Version) -> String {
    format!("binaries/{}/{model}{}", fmi.platform(), consts::DLL_SUFFIX)
}

/// Reads the library at `path`, or the one beside this program; it must serve units of this version.
pub fn read(path: Option<&Path>, fmi: Version) -> Result<Vec<u8>, String> {
    let path = path.map_or_else(beside_this_program, |path| Ok(path.to_owned()))?;
    let bytes = fs::read(&path).map_err(|error| {
        format!(
            "cannot read the library {}: {error}\n\
             Build it with `cargo build --release`, or name one with --library PATH.",
            path.display()
        )
    })?;
    let mark = fmi.step_function();
    if !bytes.windows(mark.len()).any(|window| window == mark.as_bytes()) {
        return Err(format!(
            "{} is no library of impinge: it does not export {mark}",
            path.display()
        ));
    }
    Ok(bytes)
}

fn beside_this_program() -> Result<PathBuf, String> {
    let program =
        env::current_exe().map_err(|error| format!("cannot find this program: {error}"))?;
    Ok(program.with_file_name(format!("{}impinge{}", consts::DLL_PREFIX, consts::DLL_SUFFIX)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_library_is_refused_with_the_way_to_build_it() {
        let message = read(Some(Path::new("/nowhere/libimpinge.so")), Version::Two).unwrap_err();
        assert!(message.contains("/nowhere/libimpinge.so") && message.contains("cargo build"));
    }

    #[test]
    fn another_file_is_no_library() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        for (version, name) in [(Version::Two, "fmi2DoStep"), (Version::Three, "fmi3DoStep")] {
            let message = read(Some(path), version).unwrap_err();
            assert!(message.contains("is no library of impinge") && message.contains(name));
        }
    }
}
