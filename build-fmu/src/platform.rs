//! The platforms for which a unit may carry a library.

use std::env::consts;

use object::{Architecture, BinaryFormat};

use crate::version::Version;

/// A system on a kind of processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Platform {
    /// Name in FMI 2.0.4, section 2.3. That version distinguishes no processors of 64 bits.
    two: &'static str,
    /// Name in FMI 3.0, section 2.5.
    three: &'static str,
    pub format: BinaryFormat,
    pub architecture: Architecture,
    /// File name of the prebuilt library.
    pub library: &'static str,
    /// Ending of the library's file name in a unit.
    pub suffix: &'static str,
}

const fn linux(three: &'static str, architecture: Architecture) -> Platform {
    let (two, format) = ("linux64", BinaryFormat::Elf);
    Platform { two, three, format, architecture, library: "libimpinge.so", suffix: ".so" }
}

const fn darwin(three: &'static str, architecture: Architecture) -> Platform {
    let (two, format) = ("darwin64", BinaryFormat::MachO);
    Platform { two, three, format, architecture, library: "libimpinge.dylib", suffix: ".dylib" }
}

/// All platforms. A name of FMI 2.0 means the first that has it.
pub const ALL: [Platform; 5] = [
    linux("x86_64-linux", Architecture::X86_64),
    Platform {
        two: "win64",
        three: "x86_64-windows",
        format: BinaryFormat::Pe,
        architecture: Architecture::X86_64,
        library: "impinge.dll",
        suffix: ".dll",
    },
    darwin("x86_64-darwin", Architecture::X86_64),
    linux("aarch64-linux", Architecture::Aarch64),
    darwin("aarch64-darwin", Architecture::Aarch64),
];

impl Platform {
    /// The platform of this program.
    pub fn own() -> Result<Self, String> {
        let system = if consts::OS == "macos" { "darwin" } else { consts::OS };
        let name = format!("{}-{system}", consts::ARCH);
        named(&name).ok_or_else(|| format!("there are no units for {name}"))
    }

    /// Its name in a version of the standard.
    pub fn name(&self, fmi: Version) -> &'static str {
        match fmi {
            Version::Two => self.two,
            Version::Three => self.three,
        }
    }

    /// The folder that holds its library among those of several platforms.
    pub fn folder(&self) -> &'static str {
        if named(self.two) == Some(*self) { self.two } else { self.three }
    }

    /// Path of its library inside the unit of a model.
    pub fn entry(&self, model: &str, fmi: Version) -> String {
        format!("binaries/{}/{model}{}", self.name(fmi), self.suffix)
    }
}

fn named(name: &str) -> Option<Platform> {
    ALL.into_iter().find(|platform| [platform.two, platform.three].contains(&name))
}

/// The platform that a user names, by either version of the standard.
pub fn parse(name: &str) -> Result<Platform, String> {
    named(name).ok_or_else(|| {
        let names: Vec<_> = ALL.iter().map(Platform::folder).collect();
        format!("there is no platform {name} (allowed: {})", names.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn platforms_have_the_names_of_the_standard() {
        for (two, three, entry) in [
            ("linux64", "x86_64-linux", "binaries/x86_64-linux/Plate.so"),
            ("win64", "x86_64-windows", "binaries/x86_64-windows/Plate.dll"),
            ("darwin64", "x86_64-darwin", "binaries/x86_64-darwin/Plate.dylib"),
        ] {
            let platform = parse(two).unwrap();
            assert_eq!(parse(three), Ok(platform));
            assert_eq!((platform.name(Version::Two), platform.name(Version::Three)), (two, three));
            assert_eq!(platform.entry("Plate", Version::Three), entry);
        }
        assert!(parse("win32").unwrap_err().contains("allowed: linux64, win64, darwin64"));
    }

    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn this_program_knows_its_own_platform() {
        assert_eq!(Platform::own().unwrap().folder(), "linux64");
    }
}
