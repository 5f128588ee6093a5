//! The folders of `binaries`, section 2.3.

use object::{Architecture, BinaryFormat};

/// A platform that the standard names.
pub struct Platform {
    /// Folder below `binaries`.
    pub folder: &'static str,
    /// Ending of the library, with its dot.
    pub ending: &'static str,
    pub format: BinaryFormat,
    pub architecture: Architecture,
}

use BinaryFormat::{Elf, MachO, Pe};

pub const PLATFORMS: [Platform; 6] = [
    platform("win32", ".dll", Pe, Architecture::I386),
    platform("win64", ".dll", Pe, Architecture::X86_64),
    platform("linux32", ".so", Elf, Architecture::I386),
    platform("linux64", ".so", Elf, Architecture::X86_64),
    platform("darwin32", ".dylib", MachO, Architecture::I386),
    platform("darwin64", ".dylib", MachO, Architecture::X86_64),
];

const fn platform(
    folder: &'static str,
    ending: &'static str,
    format: BinaryFormat,
    architecture: Architecture,
) -> Platform {
    Platform { folder, ending, format, architecture }
}

/// The platform of this machine, if the standard names it.
pub fn here() -> Option<&'static Platform> {
    let folder = match (std::env::consts::OS, std::env::consts::ARCH) {
        ("linux", "x86_64") => "linux64",
        ("linux", "x86") => "linux32",
        ("windows", "x86_64") => "win64",
        ("windows", "x86") => "win32",
        ("macos", "x86_64") => "darwin64",
        _ => return None,
    };
    PLATFORMS.iter().find(|platform| platform.folder == folder)
}
