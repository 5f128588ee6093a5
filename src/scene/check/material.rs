//! Checks the constants of materials: tables, melting, yield and relaxation.

use super::{Checker, number};
use crate::laws::solid::{Branch, Need, Relaxing, Saturation};
use crate::laws::{Material, Melting, Property, PropertyError, Table, Weibull};
use crate::scene::locate::Path;
use crate::scene::types::Body;

/// Checks the named materials. What a law needs at small strain is not asked of one that bodies of large strain alone
/// are made of.
pub fn named(checker: &mut Checker) {
    for (name, material) in &checker.scene.material {
        let path = Path::default().key("material").key(name);
        let is_of = |body: &&Body| {
            body.materials().into_iter().any(|choice| choice.name.as_ref() == Some(name))
        };
        let mut bodies = checker.scene.body.values().filter(is_of).peekable();
        let is_of_large =
            bodies.peek().is_some() && bodies.all(|body| matches!(body, Body::LargeStrain(_)));
        match is_of_large {
            true => sound(checker, &path, material),
            false => check(checker, &path, material),
        }
    }
}

/// Checks a material of a body of small strain, or a named one.
pub fn check(checker: &mut Checker, path: &Path, material: &Material) {
    sound(checker, path, material);
    needs(checker, path, material, material.law.deformation().needs());
    saturation(checker, path, material);
}

/// Checks the constants that are given.
pub fn sound(checker: &mut Checker, path: &Path, material: &Material) {
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
    material.law.deformation().relaxing().into_iter().for_each(|own| relaxing(checker, path, own));
}

/// Refuses a yield stress that falls to its saturation, at a temperature of its table.
fn saturation(checker: &mut Checker, path: &Path, material: &Material) {
    let Some(Saturation { saturation, .. }) = material.law.deformation().saturation() else {
        return;
    };
    let properties = material.properties();
    let found = properties.iter().find(|(key, _)| *key == "yield_stress");
    let Some((_, yield_stress)) = found else { return };
    let highest = yield_stress.values().iter().copied().fold(0.0, f64::max);
    let place = path.key("hardening").key("saturation");
    if checker.is_fine(&place) && checker.is_fine(&path.key("yield_stress")) {
        let message = "a body that yields does not soften to its saturated yield stress";
        checker.require(saturation >= highest, &place, message, format!(">= {}", number(highest)));
    }
}

/// Rounding of fractions that are to sum to 1.
const ROUNDING: f64 = 1e-12;

fn relaxing(checker: &mut Checker, path: &Path, relaxing: &Relaxing) {
    let Relaxing { shear_relaxation, bulk_relaxation, .. } = relaxing;
    let is_empty = shear_relaxation.is_empty() && bulk_relaxation.is_empty();
    let message = "no modulus relaxes";
    let allowed = "a branch or more, `{ fraction = g, time = τ }`, or model = \"thermoelastic\"";
    checker.require(!is_empty, &path.key("shear_relaxation"), message, allowed);
    let lists = [("shear_relaxation", shear_relaxation), ("bulk_relaxation", bulk_relaxation)];
    for (key, branches) in lists {
        fractions(checker, &path.key(key), branches);
    }
}

fn fractions(checker: &mut Checker, path: &Path, branches: &[Branch]) {
    let sum: f64 = branches.iter().map(|branch| branch.fraction).sum();
    let message = format!(
        "the fractions sum to {}: `young` and `poisson` are the instantaneous constants, of which no more can relax",
        number(sum)
    );
    checker.require(sum <= 1.0 + ROUNDING, path, message, "fractions that sum to at most 1");
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
