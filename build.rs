//! Embeds a checksum of the library's sources, which libraries of one build for several platforms have in common.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// Files and folders that the library is compiled from.
const SOURCES: [&str; 5] =
    ["Cargo.lock", "Cargo.toml", "closed-form/src", "docs/scene.schema.json", "src"];

fn main() -> io::Result<()> {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut files = BTreeSet::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
        collect(&root.join(source), &mut files)?;
    }
    let mut checksum = Sha256::new();
    for file in files {
        let name = file.strip_prefix(&root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        for part in [name.into_bytes(), fs::read(&file)?] {
            checksum.update((part.len() as u64).to_le_bytes());
            checksum.update(part);
        }
    }
    let digest: String =
        checksum.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=IMPINGE_SOURCES={digest}");
    Ok(())
}

/// Adds a file, or all files below a folder.
fn collect(path: &Path, files: &mut BTreeSet<PathBuf>) -> io::Result<()> {
    if !path.is_dir() {
        files.insert(path.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(path)? {
        collect(&entry?.path(), files)?;
    }
    Ok(())
}
