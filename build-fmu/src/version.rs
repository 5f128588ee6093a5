//! The versions of FMI that units are packed for.

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

    /// Functions that a library for this version exports: the one that makes an instance, and those that act on it.
    pub fn functions(self) -> Vec<&'static str> {
        match self {
            Version::Two => two::functions().chain(["fmi2Instantiate"]).collect(),
            Version::Three => three::functions().chain(["fmi3InstantiateCoSimulation"]).collect(),
        }
    }

    /// Path of the unit's icon.
    pub fn icon(self) -> &'static str {
        match self {
            Version::Two => "model.png",
            Version::Three => "terminalsAndIcons/icon.png",
        }
    }
}
