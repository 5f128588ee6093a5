//! Exported symbols of a shared library.

use std::collections::BTreeSet;

use object::read::macho::{FatArch, MachOFatFile32, MachOFatFile64};
use object::{Architecture, BinaryFormat, File, FileKind, NameOrOrdinal, Object};

/// One library; a universal Mach-O file holds several.
pub struct Library {
    pub format: BinaryFormat,
    pub architecture: Architecture,
    /// Names in C spelling.
    pub symbols: BTreeSet<String>,
}

/// Parses a file: a shared library, or a universal Mach-O file of several.
pub fn read(bytes: &[u8]) -> Result<Vec<Library>, String> {
    let slices = slices(bytes).map_err(|error| error.to_string())?;
    slices.into_iter().map(|slice| one(slice).map_err(|error| error.to_string())).collect()
}

fn slices(bytes: &[u8]) -> object::Result<Vec<&[u8]>> {
    match FileKind::parse(bytes)? {
        FileKind::MachOFat32 => {
            MachOFatFile32::parse(bytes)?.arches().iter().map(|arch| arch.data(bytes)).collect()
        }
        FileKind::MachOFat64 => {
            MachOFatFile64::parse(bytes)?.arches().iter().map(|arch| arch.data(bytes)).collect()
        }
        _ => Ok(vec![bytes]),
    }
}

fn one(bytes: &[u8]) -> object::Result<Library> {
    let file = File::parse(bytes)?;
    let format = file.format();
    // Mach-O prepends an underscore to C names.
    let prefix = if format == BinaryFormat::MachO { "_" } else { "" };
    let mut symbols = BTreeSet::new();
    for export in file.exports()? {
        if let NameOrOrdinal::Name(name) = export?.name() {
            let name = String::from_utf8_lossy(name);
            symbols.insert(name.strip_prefix(prefix).unwrap_or(&name).to_owned());
        }
    }
    Ok(Library { format, architecture: file.architecture(), symbols })
}
