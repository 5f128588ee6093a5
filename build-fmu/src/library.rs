//! The prebuilt library that serves every scene.

use std::env::{self, consts};
use std::path::{Path, PathBuf};

use impinge::scene::bytes_of;

use crate::version::Version;

/// Path of the library inside the unit of a model.
pub fn entry(model: &str, fmi: Version) -> String {
    format!("binaries/{}/{model}{}", fmi.platform(), consts::DLL_SUFFIX)
}

/// Largest size of a library in bytes.
const LARGEST: u64 = 1 << 30;

/// The library at `path`, or by default the one next to this program.
pub fn path(path: Option<&Path>) -> Result<PathBuf, String> {
    path.map_or_else(beside_this_program, |path| Ok(path.to_owned()))
}

/// Reads a library, which must serve units of this version.
pub fn read(path: &Path, fmi: Version) -> Result<Vec<u8>, String> {
    let bytes = bytes_of(path, LARGEST).map_err(|error| {
        format!(
            "cannot read the library {}: {error}\n\
             Build it with `cargo build --release`, or name one with --library PATH.",
            path.display()
        )
    })?;
    let refused =
        |reason: String| Err(format!("{} is no library of impinge: it {reason}", path.display()));
    let has = |mark: &[u8]| bytes.windows(mark.len()).any(|window| window == mark);
    let mark = fmi.step_function();
    if !is_shared_library(&bytes) {
        return refused(format!("is no shared library of {} for {}", consts::OS, consts::ARCH));
    }
    if !has(mark.as_bytes()) {
        return refused(format!("does not export {mark}"));
    }
    if !has(impinge::fmi::MARK.as_bytes()) {
        return refused(format!("is not of version {}", env!("CARGO_PKG_VERSION")));
    }
    if !has(impinge::scene::SCHEMA.as_bytes()) {
        return Err(format!(
            "{} is of another build: its scene keys differ from those of this program (allowed: what `cargo build \
             --release --workspace` makes)",
            path.display()
        ));
    }
    Ok(bytes)
}

/// Returns true if the bytes begin like a shared library of this platform: ELF (with type and machine), Mach-O or PE.
fn is_shared_library(bytes: &[u8]) -> bool {
    const SHARED: [u8; 2] = [3, 0];
    const INTERPRETER: u32 = 3;
    match consts::OS {
        "macos" => bytes.starts_with(&[0xcf, 0xfa, 0xed, 0xfe]),
        "windows" => bytes.starts_with(b"MZ"),
        _ => {
            let machine = match consts::ARCH {
                "x86_64" => Some([62, 0]),
                "aarch64" => Some([183, 0]),
                _ => None,
            };
            // Programs request an interpreter.
            bytes.starts_with(b"\x7fELF")
                && bytes.get(16..18) == Some(&SHARED[..])
                && !segments(bytes).any(|kind| kind == INTERPRETER)
                && machine.is_none_or(|machine| bytes.get(18..20) == Some(&machine[..]))
        }
    }
}

/// The types of the segments of a 64-bit little-endian ELF file.
fn segments(bytes: &[u8]) -> impl Iterator<Item = u32> + '_ {
    let number = |at: usize, size: usize| {
        let bytes = bytes.get(at..at.checked_add(size)?)?.iter().rev();
        Some(bytes.fold(0_u64, |all, &byte| (all << 8) | u64::from(byte)))
    };
    let [start, size, count] =
        [(32, 8), (54, 2), (56, 2)].map(|(at, n)| number(at, n).unwrap_or(0));
    let place = move |k: u64| usize::try_from(start.checked_add(k * size)?).ok();
    (0..count).filter_map(move |k| Some(number(place(k)?, 4)? as u32))
}

fn beside_this_program() -> Result<PathBuf, String> {
    let program =
        env::current_exe().map_err(|error| format!("cannot find this program: {error}"))?;
    Ok(program.with_file_name(format!("{}impinge{}", consts::DLL_PREFIX, consts::DLL_SUFFIX)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn missing_library_is_refused_with_build_instructions() {
        let message = read(Path::new("/nowhere/libimpinge.so"), Version::Two).unwrap_err();
        assert!(message.contains("/nowhere/libimpinge.so") && message.contains("cargo build"));
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
                let message = read(path, version).unwrap_err();
                assert!(message.contains("is no library of impinge"), "{message}");
            }
        }
    }
}
