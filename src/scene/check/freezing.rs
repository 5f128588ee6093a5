//! Checks what a droplet's fluid says of its freezing.

use super::{Checker, material, number};
use crate::scene::droplet::{Droplet, DropletMethod};
use crate::scene::locate::Path;

pub fn check(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let Some(melting) = droplet.fluid.melting else {
        let message = "a fluid without `melting` does not freeze";
        let allowed = "no `frozen`, or a table `melting` of the fluid";
        checker.require(droplet.fluid.frozen.is_none(), &path.at("fluid.frozen"), message, allowed);
        return;
    };
    let at = path.at("fluid.melting");
    material::melting(checker, &at, melting);
    let message = "recorded drops and films stay liquid";
    let allowed = "no `melting`, or method = \"sph\"";
    checker.require(droplet.method == DropletMethod::Sph, &at, message, allowed);
    let message = "a fluid that conducts no heat does not freeze";
    let allowed = "no `melting`, or a `conductivity` of the fluid above 0";
    checker.require(droplet.fluid.conductivity > 0.0, &at, message, allowed);
    let liquidus = number(melting.liquidus);
    let allowed = format!("> {liquidus}");
    let message =
        format!("drops are liquid when released, and the fluid's liquidus is {liquidus} K");
    let is_liquid = droplet.initial_temperature > melting.liquidus;
    checker.require(is_liquid, &path.at("initial_temperature"), message, allowed.clone());
    if let Some(boils) = droplet.fluid.boils_at {
        let message = format!("the fluid would boil at or below its liquidus, {liquidus} K");
        checker.require(melting.liquidus < boils, &path.at("fluid.boils_at"), message, allowed);
    }
}
