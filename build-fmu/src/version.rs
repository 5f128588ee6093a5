//! The versions of FMI that units are packed for.

use std::env::consts;

use clap::ValueEnum;
use impinge::fmi::{three, two};
use impinge::scene::Scene;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Version {
    #[value(name = "2")]
    Two,
    #[value(name = "3")]
    Three,
}

impl Version {
    pub fn name(self) -> &'static str {
        match self {
            Version::Two => "2.0",
            Version::Three => "3.0",
        }
    }

    pub fn model_description(self, scene: &Scene, text: &str) -> String {
        match self {
            Version::Two => two::xml::model_description(scene, text),
            Version::Three => three::xml::model_description(scene, text),
        }
    }

    /// A function that a library for this version exports.
    pub fn step_function(self) -> &'static str {
        match self {
            Version::Two => "fmi2DoStep",
            Version::Three => "fmi3DoStep",
        }
    }

    /// Path of the unit's icon.
    pub fn icon(self) -> &'static str {
        match self {
            Version::Two => "model.png",
            Version::Three => "terminalsAndIcons/icon.png",
        }
    }

    /// The standard's name of this platform: FMI 2.0.4, section 2.3; FMI 3.0, section 2.5.
    pub fn platform(self) -> String {
        let system = consts::OS;
        match (self, system) {
            (Version::Two, "windows") => "win64".into(),
            (Version::Two, "macos") => "darwin64".into(),
            (Version::Two, _) => "linux64".into(),
            (Version::Three, "macos") => format!("{}-darwin", consts::ARCH),
            (Version::Three, _) => format!("{}-{system}", consts::ARCH),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn platforms_have_the_names_of_the_standard() {
        assert_eq!(Version::Two.platform(), "linux64");
        assert_eq!(Version::Three.platform(), "x86_64-linux");
    }
}
