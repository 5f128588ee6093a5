//! Checks what the fluid of droplets, and of strands of particles, says of its freezing.

use super::{Checker, material, number};
use crate::laws::{Fluid, Freezing, Melting};
use crate::scene::droplet::{Droplet, DropletMethod};
use crate::scene::locate::Path;

/// Largest ratio of the constants of both phases, either way, and of their diffusivities.
const MOST_DIFFERENT: f64 = 50.0;
/// Least heat between liquidus and solidus, over that which warms the fluid from 0 K to the liquidus: with far less a
/// front stalls between layers of particles.
const LEAST_CHANGE: f64 = 0.04;
/// Largest latent heat [J/kg]; that of no substance is above 1e8.
const MOST_LATENT: f64 = 1e9;

pub fn check(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let Some(freezing) = droplet.fluid.freezing() else {
        let message = "a fluid without `melting` does not freeze";
        let allowed = "no `frozen`, or a table `melting` of the fluid";
        checker.require(droplet.fluid.frozen.is_none(), &path.at("fluid.frozen"), message, allowed);
        return;
    };
    let at = path.at("fluid.melting");
    material::melting(checker, &at, freezing.melting);
    let message = "recorded drops and films stay liquid";
    let allowed = "no `melting`, or method = \"sph\"";
    checker.require(droplet.method == DropletMethod::Sph, &at, message, allowed);
    let message = "a fluid that conducts no heat does not freeze";
    let allowed = "no `melting`, or a `conductivity` of the fluid above 0";
    checker.require(droplet.fluid.conductivity > 0.0, &at, message, allowed);
    if checker.is_fine(&at) {
        temperatures(checker, path, droplet, freezing.melting);
        constants(checker, path, &droplet.fluid, &freezing);
    }
}

fn temperatures(checker: &mut Checker, path: &Path, droplet: &Droplet, melting: Melting) {
    let Melting { solidus, liquidus, .. } = melting;
    let shown = number(liquidus);
    let allowed = format!("> {shown}");
    let message = format!("drops are liquid when released, and the fluid's liquidus is {shown} K");
    let is_liquid = droplet.initial_temperature > liquidus;
    checker.require(is_liquid, &path.at("initial_temperature"), message, allowed.clone());
    if let Some(boils) = droplet.fluid.boils_at {
        let message = format!("the fluid would boil at or below its liquidus, {shown} K");
        checker.require(liquidus < boils, &path.at("fluid.boils_at"), message, allowed);
    }
    if let Some(freezes) = droplet.fluid.freezes_at {
        let message = "`melting` says at which temperature the fluid freezes";
        let range = match melting.is_isothermal() {
            true => shown,
            false => format!("{} to {shown}", number(solidus)),
        };
        let allowed = format!("no such key, or {range}");
        let agrees = (solidus..=liquidus).contains(&freezes);
        checker.require(agrees, &path.at("fluid.freezes_at"), message, allowed);
    }
}

/// Checks that both phases are alike enough for the law of contact, and that the latent heat matters.
pub fn constants(checker: &mut Checker, path: &Path, fluid: &Fluid, freezing: &Freezing) {
    let ratios = [
        ("fluid.frozen.conductivity", freezing.conductivity, fluid.conductivity),
        ("fluid.frozen.specific_heat", freezing.specific_heat, fluid.specific_heat),
    ];
    for (key, frozen, molten) in ratios {
        let (low, high) = (molten / MOST_DIFFERENT, molten * MOST_DIFFERENT);
        let message =
            format!("frozen and molten fluid differ by more than a factor of {MOST_DIFFERENT}");
        let allowed = format!("{} to {}", number(low), number(high));
        checker.require((low..=high).contains(&frozen), &path.at(key), message, allowed);
    }
    let conduction = freezing.conductivity / fluid.conductivity;
    let fastest = conduction * fluid.specific_heat / freezing.specific_heat;
    let message = format!(
        "heat spreads {} times as fast in the frozen fluid as in the molten one",
        number(fastest)
    );
    let allowed = format!("constants with which that is at most {MOST_DIFFERENT}");
    let at = path.at("fluid.frozen");
    if checker.is_fine(&at) {
        checker.require(fastest <= MOST_DIFFERENT, &at, message, allowed);
    }
    let Melting { solidus, liquidus, latent_heat } = freezing.melting;
    // Contents are linear in the temperature between solidus and liquidus.
    let sensible = 0.5 * (fluid.specific_heat + freezing.specific_heat) * (liquidus - solidus);
    let least = (LEAST_CHANGE * fluid.specific_heat * liquidus - sensible).max(f64::MIN_POSITIVE);
    let amount = if latent_heat > MOST_LATENT { "much" } else { "little" };
    let message = format!(
        "the law of a front does not hold for so {amount} heat between liquidus and solidus"
    );
    let allowed = format!("{} to {}, or no `melting`", number(least), number(MOST_LATENT));
    let is_enough = (least..=MOST_LATENT).contains(&latent_heat);
    checker.require(is_enough, &path.at("fluid.melting.latent_heat"), message, allowed);
}
