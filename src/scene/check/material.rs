//! The constants of materials: numbers, tables, melting and yield.

use super::{Checker, LARGEST, SMALLEST, number};
use crate::material::{Creep, Material, Melting, Properties, Property, PropertyError};
use crate::scene::locate::Path;

/// The materials that have names.
pub fn named(checker: &mut Checker) {
    for (name, material) in &checker.scene.material {
        check(checker, &Path::default().key("material").key(name), material);
    }
}

pub fn check(checker: &mut Checker, path: &Path, material: &Material) {
    let law = material.properties();
    checker.constant(&path.at("density"), law.density, "the density");
    let positive = [
        ("specific_heat", Some(&law.specific_heat), "the specific heat capacity"),
        ("conductivity", Some(&law.conductivity), "the thermal conductivity"),
        ("young", law.young.as_ref(), "Young's modulus"),
        ("yield_stress", law.yield_stress.as_ref(), "the yield stress"),
    ];
    for (key, property, what) in positive {
        if let Some(property) = property {
            each(checker, &path.key(key), property, |checker, path, value| {
                checker.constant(path, value, what);
            });
        }
    }
    if let Some(property) = &law.expansion {
        each(checker, &path.key("expansion"), property, expansion);
    }
    if let Some(property) = &law.poisson {
        each(checker, &path.key("poisson"), property, poisson);
    }
    for (key, property) in [
        ("isotropic_hardening", &law.isotropic_hardening),
        ("kinematic_hardening", &law.kinematic_hardening),
    ] {
        if let Some(property) = property {
            each(checker, &path.key(key), property, hardening);
        }
    }
    if let Some(melting) = &law.melting {
        check_melting(checker, &path.key("melting"), melting);
    }
    if let Some(creep) = &law.creep {
        check_creep(checker, &path.key("creep"), creep);
    }
    yields(checker, path, material);
}

/// Bounds of A, whose unit has a power of Pa in it, of n and of the activation temperature [K].
const COEFFICIENTS: [f64; 2] = [1e-300, 1e300];
const EXPONENTS: [f64; 2] = [1.0, 50.0];
const ACTIVATION: [f64; 2] = [0.0, 1e6];

fn check_creep(checker: &mut Checker, path: &Path, creep: &Creep) {
    let Creep { coefficient, exponent, activation_temperature } = *creep;
    let what = "the coefficient of creep";
    checker.positive_within(&path.key("coefficient"), coefficient, COEFFICIENTS, what);
    checker.within(&path.key("exponent"), exponent, EXPONENTS, "the exponent of creep");
    let path = path.key("activation_temperature");
    checker.within(&path, activation_temperature, ACTIVATION, "the activation temperature");
}

/// Looks at the number, or at the table and each of its values.
fn each(
    checker: &mut Checker,
    path: &Path,
    property: &Property,
    value: impl Fn(&mut Checker, &Path, f64),
) {
    let Property::Table(table) = property else {
        return property.values().iter().for_each(|&number| value(checker, path, number));
    };
    let ascending = "strictly ascending temperatures, at least two";
    if let Err(error) = table.check() {
        // What is allowed stands apart in a scene's errors.
        let message = error.to_string();
        let message = message.split(" (allowed").next().unwrap_or_default().to_owned();
        match error {
            PropertyError::Lengths { .. } => {
                checker.refuse(path, message, "one value for each temperature");
            }
            _ => checker.refuse(&path.key("temperature"), message, ascending),
        }
        return;
    }
    for (i, &temperature) in table.temperature.iter().enumerate() {
        checker.temperature(&path.key("temperature").index(i), temperature);
    }
    for (i, &number) in table.value.iter().enumerate() {
        value(checker, &path.key("value").index(i), number);
    }
}

fn expansion(checker: &mut Checker, path: &Path, value: f64) {
    let message = "the coefficient of expansion is beyond all bounds";
    checker.require(value.abs() <= LARGEST, path, message, format!("-{LARGEST:e} to {LARGEST:e}"));
}

fn hardening(checker: &mut Checker, path: &Path, value: f64) {
    let message = "a body that yields does not soften";
    checker.require((0.0..=LARGEST).contains(&value), path, message, format!("0 to {LARGEST:e}"));
}

/// Refuses ratios at which resistance to shear or to compression is lost, or lost in rounding.
fn poisson(checker: &mut Checker, path: &Path, ratio: f64) {
    const MARGIN: f64 = 1e-9;
    let message = match ratio {
        high if high > 0.5 - MARGIN => "Poisson's ratio must stay below one half",
        low if low < -1.0 + MARGIN => "Poisson's ratio must stay above minus one",
        _ => return,
    };
    checker.refuse(path, message, "-1 < poisson < 0.5");
}

fn check_melting(checker: &mut Checker, path: &Path, melting: &Melting) {
    let Melting { solidus, liquidus, latent_heat } = *melting;
    checker.temperature(&path.key("solidus"), solidus);
    checker.temperature(&path.key("liquidus"), liquidus);
    let message = "melting ends below where it begins";
    let allowed = format!("liquidus >= {}", number(solidus));
    checker.require(liquidus >= solidus, &path.key("liquidus"), message, allowed);
    let bounds = [SMALLEST, LARGEST];
    checker.positive_within(&path.key("latent_heat"), latent_heat, bounds, "the latent heat");
}

/// A yield stress goes with the model that has one.
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

/// Refuses materials without the constants of a body whose mechanics is needed.
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
