//! Checks everything outside bodies, loads, probes, fields, flaws and walls, and the names of all of these.

use std::collections::BTreeMap;

use super::{Checker, number};
use crate::scene::Naming;
use crate::scene::locate::Path;

/// Prefixes of variables that belong to no body, load, probe, field, flaw or wall.
const RESERVED: [&str; 2] = ["solver", "output"];
/// Largest number of bytes of a name: files are named after it, and file names have at most 255 bytes with all endings.
const LONGEST_NAME: usize = 200;
/// Number of communication steps that no run reaches.
const MOST_STEPS: f64 = 1e9;
/// Share by which a quotient may exceed its limit.
const ROUNDING: f64 = 1e-12;

pub fn check(checker: &mut Checker) {
    description(checker);
    times(checker);
    names(checker);
    let path = Path::default().key("refinement");
    for name in checker.scene.refinement.keys() {
        checker.body(&path.key(name), name);
    }
}

fn description(checker: &mut Checker) {
    let fine = !checker.scene.description.contains(char::is_control);
    let path = Path::default().key("description");
    checker.require(fine, &path, "the description has control characters", "one line of text");
}

fn times(checker: &mut Checker) {
    let root = Path::default();
    let (stop_time, step) = (checker.scene.stop_time, checker.scene.step);
    if checker.is_fine(&root.key("stop_time")) && checker.is_fine(&root.key("step")) {
        let message = format!("the run takes {} steps", number((stop_time / step).ceil()));
        let allowed = format!(">= {}, for at most {MOST_STEPS:e}", number(stop_time / MOST_STEPS));
        let is_fine = stop_time / step <= MOST_STEPS * (1.0 + ROUNDING);
        checker.require(is_fine, &root.key("step"), message, allowed);
        let message = "the step is longer than the whole run";
        let allowed = format!("<= stop_time = {}", number(stop_time));
        checker.require(step <= stop_time, &root.key("step"), message, allowed);
    }
}

/// Checks that names are identifiers, because they become prefixes of FMI variables.
fn names(checker: &mut Checker) {
    let scene = checker.scene;
    let root = Path::default();
    identifier(checker, &root.key("name"), &scene.name);
    checker.require(!scene.body.is_empty(), &root.key("body"), "there is no body", "[body.NAME]");

    for name in scene.material.keys() {
        let path = root.key("material").key(name);
        identifier(checker, &path, name);
        let fine = name != "layer" && !name.starts_with("layer_");
        let message = "the name is reserved for layers without names";
        checker.require(fine, &path, message, "any name but layer and layer_…");
    }
    let element = |kind: &str, i: usize| root.key(kind).index(i).key("name");
    let bodies = scene.body.keys().map(|name| (root.key("body").key(name), name));
    let loads = scene.load.iter().enumerate().map(|(i, load)| (element("load", i), &load.name));
    let probes =
        scene.probe.iter().enumerate().map(|(i, probe)| (element("probe", i), &probe.name));
    let fields =
        scene.field.iter().enumerate().map(|(i, field)| (element("field", i), &field.name));
    let flaws = scene.flaw.iter().enumerate().map(|(i, flaw)| (element("flaw", i), &flaw.name));
    let walls = scene.wall.iter().enumerate().map(|(i, wall)| (element("wall", i), &wall.name));
    let mut owners = BTreeMap::new();
    for (path, name) in bodies.chain(loads).chain(probes).chain(fields).chain(flaws).chain(walls) {
        prefix(checker, &mut owners, path, name);
    }
    if scene.naming == Naming::Flat {
        apart(checker, &owners);
    }
}

/// Checks that flat names are unambiguous. They concatenate prefix and rest, so they could coincide where one prefix
/// begins with another one and `_`.
fn apart(checker: &mut Checker, owners: &BTreeMap<&str, Path>) {
    for (&name, path) in owners {
        let mut others = name.match_indices('_').map(|(at, _)| &name[..at]);
        let is_taken = |other: &&str| owners.contains_key(other) || RESERVED.contains(other);
        if let Some(other) = others.find(is_taken) {
            let message = format!("with flat names it is ambiguous with a part of `{other}`");
            checker.refuse(path, message, format!("a name that does not begin with `{other}_`"));
        }
    }
}

fn prefix<'a>(
    checker: &mut Checker,
    owners: &mut BTreeMap<&'a str, Path>,
    path: Path,
    name: &'a str,
) {
    identifier(checker, &path, name);
    let free = !RESERVED.contains(&name);
    let reserved = format!("any name but {}", RESERVED.join(" and "));
    checker.require(free, &path, "the name is reserved for the unit's own variables", reserved);
    match owners.get(name) {
        Some(owner) => {
            let message = format!("the name is taken by {owner}");
            checker.refuse(
                &path,
                message,
                "a name for each body, load, probe, field, flaw and wall",
            );
        }
        None => {
            owners.insert(name, path);
        }
    }
}

fn identifier(checker: &mut Checker, path: &Path, name: &str) {
    let mut letters = name.chars();
    let starts = letters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    let fine = starts && letters.all(|c| c.is_ascii_alphanumeric() || c == '_');
    let allowed = "letters a-z and A-Z, digits and _, no digit first";
    checker.require(fine, path, format!("{name:?} is not a C identifier"), allowed);
    let length = name.len();
    let message = format!("a name of {length} bytes is too long for a file name");
    checker.require(length <= LONGEST_NAME, path, message, format!("at most {LONGEST_NAME} bytes"));
}
