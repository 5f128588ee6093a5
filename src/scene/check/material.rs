//! Checks the constants of materials: tables, melting and yield.

use super::{Checker, number};
use crate::laws::solid::Need;
use crate::laws::{Material, Melting, Property, PropertyError, Table, Weibull};
use crate::scene::locate::Path;

/// Checks the named materials.
pub fn named(checker: &mut Checker) {
    for (name, material) in &checker.scene.material {
        check(checker, &Path::default().key("material").key(name), material);
    }
}

pub fn check(checker: &mut Checker, path: &Path, material: &Material) {
    for (key, property) in material.properties() {
        if let Property::Table(values) = property {
            table(checker, &path.key(key), values);
        }
    }
    if let Some(range) = material.heat.melting {
        melting(checker, &path.key("melting"), range);
    }
    if let Some(weibull) = material.fracture.weibull {
        flaws(checker, &path.key("weibull"), &weibull);
    }
    needs(checker, path, material, material.law.deformation().needs());
}

/// Flaws are either in the volume or on faces.
fn flaws(checker: &mut Checker, path: &Path, weibull: &Weibull) {
    const EITHER: &str = "`volume = …` (m³) or `area = …` (m²)";
    match (weibull.volume, weibull.area) {
        (None, None) => {
            checker.refuse(path, "flaws have neither a reference volume nor an area", EITHER);
        }
        (Some(_), Some(_)) => {
            let message = "flaws are either in the volume or on the faces, not both";
            checker.refuse(&path.key("area"), message, EITHER);
        }
        _ => {}
    }
}

pub fn melting(checker: &mut Checker, path: &Path, Melting { solidus, liquidus, .. }: Melting) {
    let message = "melting ends below where it begins";
    let allowed = format!("liquidus >= {}", number(solidus));
    checker.require(liquidus >= solidus, &path.key("liquidus"), message, allowed);
}

pub fn table(checker: &mut Checker, path: &Path, table: &Table) {
    let Err(error) = table.check() else { return };
    // The allowed values are a separate part of a scene's errors.
    let message = error.to_string();
    let message = message.split(" (allowed").next().unwrap_or_default().to_owned();
    match error {
        PropertyError::Lengths { .. } => {
            checker.refuse(path, message, "one value for each temperature");
        }
        _ => {
            let ascending = "strictly ascending temperatures, at least two";
            checker.refuse(&path.key("temperature"), message, ascending);
        }
    }
}

/// Refuses a material that does not give all keys that are needed.
pub fn needs(
    checker: &mut Checker,
    path: &Path,
    material: &Material,
    needs: impl IntoIterator<Item = Need>,
) {
    let given = material.properties();
    for Need { key, why, allowed } in needs {
        let is_given = given.iter().any(|(own, _)| *own == key);
        let reason = if why.is_empty() { String::new() } else { format!(": {why}") };
        let message = format!("the key `{key}` is missing{reason}");
        checker.require(is_given, &path.at(key), message, allowed);
    }
}
