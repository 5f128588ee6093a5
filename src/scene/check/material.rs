//! Checks the constants of materials: tables, melting and yield.

use super::{Checker, number};
use crate::material::{Material, Melting, Properties, Property, PropertyError, Table};
use crate::scene::locate::Path;

/// Checks the named materials.
pub fn named(checker: &mut Checker) {
    for (name, material) in &checker.scene.material {
        check(checker, &Path::default().key("material").key(name), material);
    }
}

pub fn check(checker: &mut Checker, path: &Path, material: &Material) {
    let law = material.properties();
    for (key, property) in law.tables() {
        if let Some(Property::Table(values)) = property {
            table(checker, &path.key(key), values);
        }
    }
    if let Some(Melting { solidus, liquidus, .. }) = law.melting {
        let message = "melting ends below where it begins";
        let allowed = format!("liquidus >= {}", number(solidus));
        checker.require(liquidus >= solidus, &path.at("melting.liquidus"), message, allowed);
    }
    yields(checker, path, material);
}

fn table(checker: &mut Checker, path: &Path, table: &Table) {
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

/// Checks that a yield stress occurs only with a model that uses it.
fn yields(checker: &mut Checker, path: &Path, material: &Material) {
    let law = material.properties();
    let given = [
        ("yield_stress", law.yield_stress.is_some()),
        ("isotropic_hardening", law.isotropic_hardening.is_some()),
        ("kinematic_hardening", law.kinematic_hardening.is_some()),
    ];
    if !matches!(material, Material::Viscoplastic(_)) {
        let message = "only a viscoplastic material creeps";
        let allowed = "model = \"viscoplastic\", or no such key";
        checker.require(law.creep.is_none(), &path.key("creep"), message, allowed);
    }
    match material {
        Material::Thermoelastic(_) => {
            for (key, _) in given.iter().filter(|(_, given)| *given) {
                let message = "a thermoelastic material does not yield";
                checker.refuse(
                    &path.key(key),
                    message,
                    "model = \"elastoplastic\", or no such key",
                );
            }
        }
        Material::Elastoplastic(_) => {
            let message = "the key `yield_stress` is missing";
            let allowed = "a positive number or table (Pa)";
            checker.require(
                law.yield_stress.is_some(),
                &path.key("yield_stress"),
                message,
                allowed,
            );
            elasticity(checker, path, law, "an elastoplastic material deforms");
        }
        Material::Viscoplastic(_) => {
            let message = "the key `creep` is missing";
            let allowed = "creep = { coefficient = A, exponent = n }";
            checker.require(law.creep.is_some(), &path.key("creep"), message, allowed);
            elasticity(checker, path, law, "a viscoplastic material deforms");
        }
    }
}

/// Refuses materials that lack constants which the mechanics of their body requires.
pub fn elasticity(checker: &mut Checker, path: &Path, constants: &Properties, why: &str) {
    for (key, is_given, allowed) in [
        ("young", constants.young.is_some(), "a positive number (Pa)"),
        ("poisson", constants.poisson.is_some(), "-1 < poisson < 0.5"),
        ("expansion", constants.expansion.is_some(), "a number (1/K)"),
    ] {
        let message = format!("the key `{key}` is missing: {why}");
        checker.require(is_given, &path.at(key), message, allowed);
    }
}
