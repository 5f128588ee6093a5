//! Whether the solids of a scene can be what its level says.

use super::Checker;
use crate::scene::locate::Path;
use crate::scene::reduction::Place;
use crate::scene::types::FidelityLevel;

pub fn check(checker: &mut Checker) {
    // What is wrong by itself says so already.
    if checker.scene.fidelity.level != FidelityLevel::Reduced || !checker.problems.is_empty() {
        return;
    }
    let level = Path::default().at("fidelity.level");
    let is_there = checker.scene.solids().next().is_some();
    checker.require(is_there, &level, "only solids are reduced, and there is none", "full, auto");
    for (name, solid) in checker.scene.solids() {
        let Some(obstacle) = checker.scene.obstacle(name, solid) else { continue };
        let path = match obstacle.at {
            Place::Body(key) => Path::default().key("body").key(name).key(key),
            Place::Element(tables, number) => Path::default().key(tables).index(number),
            Place::Level => level.clone(),
        };
        checker.refuse(&path, obstacle.message, obstacle.allowed);
    }
}
