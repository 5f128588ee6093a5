//! Embeds a checksum of the library's sources, which libraries of one build for several platforms have in common.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// What the library is compiled from.
const SOURCES: [&str; 5] =
    ["Cargo.lock", "Cargo.toml", "closed-form/src", "docs/scene.schema.json", "src"];

fn main() -> io::Result<()> {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut files = BTreeSet::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
        collect(&root.join(source), &mut files)?;
    }
    let mut checksum = Checksum::new();
    for file in files {
        let name = file.strip_prefix(&root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        checksum.add(name.as_bytes());
        checksum.add(&fs::read(&file)?);
    }
    println!("cargo::rustc-env=IMPINGE_SOURCES={:016x}", checksum.0);
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

/// Fowler–Noll–Vo hash FNV-1a of 64 bits: it distinguishes builds, not forgeries.
struct Checksum(u64);

impl Checksum {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Adds a part and its length.
    fn add(&mut self, part: &[u8]) {
        for byte in part.iter().chain(&(part.len() as u64).to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
