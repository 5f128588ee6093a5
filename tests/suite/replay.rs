//! Drops that are repeated: what they give is what the one drop gives that is known, wherever and whenever it comes down.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::scene;

const DIAMETER: f64 = 1e-4;
const SPEED: f64 = 20.0;
const DENSITY: f64 = 1000.0;
const HEAT: f64 = 4180.0;
const STEP: f64 = 2.5e-7;
const STOP: f64 = 2e-5;
const AWAY: f64 = 3.5e-4;

/// A coarse drop of water at 350 K with further keys.
fn drop(method: &str, keys: &str) -> String {
    let spacing = if method == "film" { "" } else { "spacing = 5e-6\n" };
    format!(
        "name = \"Drops\"\nstop_time = {STOP:?}\nstep = {STEP:?}\n[body.drop]\nkind = \"droplet\"\nmethod = \
         \"{method}\"\ndiameter = {DIAMETER:?}\nimpact_velocity = {SPEED:?}\ninitial_temperature = 350.0\n{spacing}fluid = \
         {{ density = {DENSITY:?}, viscosity = 1e-3, specific_heat = {HEAT:?}, conductivity = 0.6 }}\n{keys}\n"
    )
}

/// A plate below it.
fn plate(temperature: f64) -> String {
    format!(
        "[body.plate]\nkind = \"solid\"\nshape = {{ box = [1e-3, 1e-3, 1e-4] }}\nmaterial = {{ model = \"thermoelastic\", \
         density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }}\ninitial_temperature = {temperature:?}\nmesh = {{ \
         spacing = 1.5e-5, depth_spacing = 1e-6, growth = 1.3, order = 1 }}\n[[coupling]]\nfrom = \"drop\"\nto = \
         \"plate.top\"\ntraction = false\nradius = 2e-4\n"
    )
}

const TILES: &str = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = { tiles = { count = [8, 8], size = [5e-4, \
                     5e-4] } }\nstart = { temperature = 300.0 }\n";

fn mass() -> f64 {
    PI / 6.0 * DIAMETER.powi(3) * DENSITY
}

/// Heat that a drop has to give to what is at 300 K.
fn content() -> f64 {
    mass() * HEAT * 50.0
}

fn run(trial: &mut Trial, until: f64) {
    let count = (until / STEP).round() as usize;
    (0..count).for_each(|_| trial.step(STEP));
}

#[test]
fn a_single_drop_gives_what_its_particles_give() {
    let mut heats = Vec::new();
    for method in ["sph", "record", "film"] {
        let mut trial = Trial::new(&(drop(method, "") + &plate(300.0)));
        run(&mut trial, STOP);
        let names = ["drop.heat", "plate.heat_in", "drop.impulse_z", "drop.heat_stored"];
        let [given, taken, pushed, stored] = names.map(|name| trial.get(name));
        assert!(off(taken, given) < 1e-12, "{method}: {given} J become {taken} J");
        assert!(off(-stored, given) < 1e-6, "{method}: {stored} {given}");
        assert!(trial.heat_residual("plate") < 1e-9);
        eprintln!("{method}: heat {} of content, impulse {} mU", given / content(), pushed / (mass() * SPEED));
        heats.push(given);
        assert!((pushed / (mass() * SPEED) + 1.0).abs() < 0.1, "{method}: {pushed}");
    }
    assert!(off(heats[1], heats[0]) < 0.05, "{heats:?}");
}
