//! Checks that the solids of a scene admit the level of fidelity.

use super::Checker;
use crate::scene::locate::Path;
use crate::scene::reduction::Place;
use crate::scene::types::FidelityLevel;

pub fn check(checker: &mut Checker) {
    // Errors of the solid itself are reported elsewhere.
    if !checker.problems.is_empty() {
        return;
    }
    let level = Path::default().at("fidelity.level");
    let resolved = Path::default().key("resolved");
    if checker.scene.fidelity.level == FidelityLevel::Reduced {
        let is_there = checker.scene.solids().next().is_some();
        let message = "only solids are reduced, and there is none";
        checker.require(is_there, &level, message, "full, auto");
    }
    let is_auto = checker.scene.fidelity.level == FidelityLevel::Auto;
    for name in checker.scene.resolved.keys() {
        let path = resolved.key(name);
        if checker.body(&path, name).is_some() {
            let message = "only the level `auto` is resolved";
            checker.require(is_auto, &path, message, "fidelity.level = \"auto\", or no such table");
        }
    }
    for (name, _) in checker.scene.solids() {
        let is_asked = !checker.scene.is_open_level(name) && checker.scene.is_reduced(name);
        let Some(obstacle) = checker.scene.obstacle(name).filter(|_| is_asked) else {
            continue;
        };
        let path = match obstacle.at {
            Place::Body(key) => Path::default().key("body").key(name).key(key),
            Place::Element(tables, number) => Path::default().key(tables).index(number),
            Place::Level if is_auto => resolved.key(name).key("level"),
            Place::Level => level.clone(),
        };
        checker.refuse(&path, obstacle.message, obstacle.allowed);
    }
}
