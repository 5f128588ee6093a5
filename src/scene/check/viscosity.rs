//! Checks the viscosity of a droplet's fluid: its table, its size, and the methods that take it.

use super::{Checker, material, number};
use crate::laws::Viscosity;
use crate::limits::Bounds;
use crate::scene::droplet::{Droplet, DropletMethod, PressureAdvance, ViscousAdvance};
use crate::scene::locate::Path;

/// Bounds of the reference viscosity of a law, those of a plain number [Pa s].
const BOUNDS: Bounds = Bounds::between(1e-9, 1e6);

pub fn check(checker: &mut Checker, droplet_path: &Path, droplet: &Droplet) {
    let path = &droplet_path.at("fluid.viscosity");
    let viscosity = &droplet.fluid.viscosity;
    if let Viscosity::Table(table) = viscosity {
        material::table(checker, path, table);
    }
    if checker.is_fine(path) {
        size(checker, path, droplet);
    }
    if checker.is_fine(path) && viscosity.constant().is_none() {
        method(checker, path, droplet);
        explicit(checker, &droplet_path.key("viscous"), droplet);
    }
    if droplet.has_particles() && droplet.pressure == PressureAdvance::Implicit {
        pressure(checker, droplet_path, droplet);
    }
}

/// Refuses laws whose viscosity at the reference temperature and rate is beyond that of any fluid.
fn size(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let flow = droplet.fastest_flow();
    let reference = droplet.reference_viscosity();
    // Without flow there is no rate, which another check refuses.
    if flow == 0.0 || BOUNDS.hold(reference) {
        return;
    }
    let [temperature, rate] = [droplet.initial_temperature, flow / droplet.diameter].map(number);
    let viscosity = number(reference);
    let message = format!(
        "at {temperature} K and the shear rate U/D = {rate} 1/s of the drop the viscosity is {viscosity} Pa s"
    );
    checker.refuse(path, message, format!("constants that give {BOUNDS} (Pa s) there"));
}

/// Refuses what a method repeats for drops of all speeds or temperatures and cannot adapt.
fn method(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let viscosity = &droplet.fluid.viscosity;
    let message = match droplet.method {
        DropletMethod::Film => {
            "the closed forms of a film hold for Newtonian fluids of constant viscosity"
        }
        DropletMethod::Record if viscosity.depends_on_temperature() => {
            "a recorded drop is repeated for any temperatures, which do not change its flow"
        }
        DropletMethod::Record | DropletMethod::Sph => return,
    };
    let allowed = match droplet.method {
        DropletMethod::Film => "a number, or another `method`",
        _ => "a number, a law without `arrhenius`, or method = \"sph\"",
    };
    checker.refuse(path, message, allowed);
}

/// Refuses to solve pressure without viscosity, or with a speed of sound that is not that of the model.
fn pressure(checker: &mut Checker, droplet_path: &Path, droplet: &Droplet) {
    if droplet.viscous == ViscousAdvance::Explicit {
        let message = "pressure is solved together with viscosity, which is explicit here";
        checker.refuse(
            &droplet_path.key("viscous"),
            message,
            "no `viscous`, \"auto\", \"implicit\"",
        );
    }
    if droplet.fluid.sound_speed.is_some() {
        let message = "pressure is solved with the speed of sound of the model";
        let allowed = "no `sound_speed`, or `pressure = \"explicit\"`";
        checker.refuse(&droplet_path.at("fluid.sound_speed"), message, allowed);
    }
}

/// Refuses explicit steps for viscosities that are not constant.
fn explicit(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    if droplet.has_particles() && droplet.viscous == ViscousAdvance::Explicit {
        let message = "explicit steps take Newtonian fluids of constant viscosity";
        checker.refuse(path, message, "\"auto\", \"implicit\"");
    }
}
