//! What nobody built a case on: any material, thickness, size of input and length of step, with defaults.

use crate::common::{Trial, off};
use impinge::closed_form::HeatedSlab;
use impinge::closed_form::medium::Conductor;
use impinge::scene;

/// Density, specific heat and conductivity, from what conducts worst to what conducts best.
const SOLIDS: [(&str, [f64; 3]); 7] = [
    ("aerogel", [100.0, 1000.0, 0.015]),
    ("cork", [240.0, 1900.0, 0.045]),
    ("PMMA", [1180.0, 1450.0, 0.19]),
    ("alumina", [3950.0, 900.0, 10.0]),
    ("steel", [7850.0, 480.0, 45.0]),
    ("copper", [8960.0, 385.0, 400.0]),
    ("diamond", [3510.0, 520.0, 2000.0]),
];
const START: f64 = 300.0;

fn slab([density, specific_heat, conductivity]: [f64; 3], thickness: f64, step: f64) -> String {
    format!(
        "name = \"Slab\"\nstop_time = {:?}\nstep = {step:?}\n[body.slab]\nkind = \"solid\"\nshape = {{ box = [1e-3, 1e-3, \
         {thickness:?}] }}\nmaterial = {{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, \
         conductivity = {conductivity:?} }}\ninitial_temperature = {START:?}\nfaces = {{ top = {{ flux = 0.0 }} }}\n[[probe]]\n\
         name = \"surface\"\nin = \"slab\"\nat = [0.0, 0.0, 0.0]\ngives = [\"temperature\"]\n",
        100.0 * step
    )
}

fn heated([density, specific_heat, conductivity]: [f64; 3], thickness: f64) -> HeatedSlab {
    let body = Conductor { conductivity, heat_capacity: density * specific_heat };
    HeatedSlab { body, flux: 1.0, thickness }
}

/// Fluxes that change their sign with every step, by superposition of the closed form; steps are of `scene_step` or
/// longer.
fn follow_flips(name: &str, solid: [f64; 3], thickness: f64, (scene_step, step): (f64, f64)) {
    let exact = heated(solid, thickness);
    // 10 K in the first step.
    let size = 10.0 / exact.rise_with_insulated_back(0.0, step);
    let mut trial = Trial::new(&slab(solid, thickness, scene_step));
    let (mut jumps, mut last, mut highest, mut worst) = (Vec::new(), 0.0, 0.0_f64, 0.0_f64);
    for count in 0..8 {
        let flux = if count % 2 == 0 { size } else { -0.9 * size };
        jumps.push((count as f64 * step, flux - last));
        last = flux;
        trial.set("slab.top.flux", flux);
        trial.step(step);
        let now = (count + 1) as f64 * step;
        let rises =
            jumps.iter().map(|(from, jump)| jump * exact.rise_with_insulated_back(0.0, now - from));
        let wanted: f64 = rises.sum();
        highest = highest.max(wanted.abs());
        worst = worst.max((trial.get("surface.temperature") - START - wanted).abs());
    }
    let [came, stored] = ["heat_in", "heat_stored"].map(|key| trial.get(&format!("slab.{key}")));
    // Of all that came in one way or the other.
    let all = 8.0 * size * 1e-6 * step;
    assert!(
        (came - stored).abs() < 1e-9 * all,
        "{name}, {thickness} m, {step} s: {came} J, {stored} J"
    );
    let part = worst / highest;
    // Elements are never finer than a millionth of the thickness.
    let allowed = if step < 1e-11 { 0.03 } else { 0.01 };
    assert!(part < allowed, "{name}, {thickness} m, {step} s on a mesh for {scene_step} s: {part}");
}

#[test]
fn any_slab_follows_a_flux_that_flips_with_every_step() {
    for (name, solid) in SOLIDS {
        for thickness in [20e-6, 1e-3] {
            for step in [1e-12, 1e-6, 1.0, 1e3] {
                follow_flips(name, solid, thickness, (step, step));
            }
            // Steps may be longer than those that the mesh was chosen for.
            follow_flips(name, solid, thickness, (1e-6, 1e3));
        }
    }
}

/// Heat is linear: what comes in, is stored and rises is in proportion to the input, whatever its size.
#[test]
fn answers_are_in_proportion_to_inputs_of_any_size() {
    let solid = SOLIDS[3].1;
    let heat = |flux: f64| {
        let mut trial = Trial::new(&slab(solid, 1e-3, 1e-6));
        trial.set("slab.top.flux", flux);
        (0..3).for_each(|_| trial.step(1e-6));
        trial.get("slab.heat_stored") / flux
    };
    let one = heat(1e6);
    for flux in [1e-290, 1e-100, 1e-3, -1e3, 1e30, 1e150, 1e290] {
        assert!(off(heat(flux), one) < 1e-9, "{flux}: {} beside {one}", heat(flux));
    }
}

/// Density, viscosity, specific heat, conductivity, surface tension, temperature.
const LIQUIDS: [(&str, [f64; 6]); 5] = [
    ("wax", [780.0, 4e-3, 2100.0, 0.15, 0.027, 380.0]),
    ("glycerol", [1260.0, 1.4, 2400.0, 0.28, 0.063, 340.0]),
    ("mercury", [13_500.0, 1.5e-3, 140.0, 8.5, 0.485, 380.0]),
    ("tin", [6980.0, 1.8e-3, 250.0, 30.0, 0.55, 550.0]),
    ("steel", [7000.0, 6e-3, 800.0, 30.0, 1.8, 1900.0]),
];

fn impact(liquid: [f64; 6], solid: [f64; 3], diameter: f64, thickness: f64, across: f64) -> String {
    let [density, viscosity, specific_heat, conductivity, tension, temperature] = liquid;
    let step = diameter / 5.0 / 20.0;
    let disc = format!(
        "shape = {{ disc = {{ radius = {:?}, thickness = {thickness:?} }} }}",
        4.0 * diameter
    );
    format!(
        "name = \"Impact\"\nstop_time = {:?}\nstep = {step:?}\n[body.drop]\nkind = \"droplet\"\ndiameter = \
         {diameter:?}\nimpact_velocity = 5.0\ninitial_temperature = {temperature:?}\nspacing = {:?}\nfluid = {{ density = \
         {density:?}, viscosity = {viscosity:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?}, \
         surface_tension = {tension:?} }}\n[body.plate]\nkind = \"solid\"\n{disc}\nmaterial = {{ model = \"thermoelastic\", \
         density = {:?}, specific_heat = {:?}, conductivity = {:?} }}\ninitial_temperature = {START:?}\n[[coupling]]\nfrom = \
         \"drop\"\nto = \"plate.top\"\n",
        20.0 * step,
        diameter / across,
        solid[0],
        solid[1],
        solid[2],
    )
}

/// Nothing gets hotter than the drop or colder than the plate, and what one loses the other gets.
fn lands(what: &str, text: &str, temperature: f64) {
    let mut trial = Trial::new(text);
    let step = trial.model.scene().step;
    let beyond = 0.005 * (temperature - START);
    for _ in 0..20 {
        trial.step(step);
        let highest = trial.get("plate.max_temperature");
        assert!(highest < temperature + beyond, "{what}: the plate is at {highest} K");
        let ends = ["drop.min_temperature", "drop.max_temperature"].map(|name| trial.get(name));
        assert!(ends[0] > START - beyond && ends[1] < temperature + beyond, "{what}: {ends:?}");
    }
    let [given, taken] = ["drop.heat", "plate.heat_in"].map(|name| trial.get(name));
    assert!(given > 0.0 && off(taken, given) < 1e-12, "{what}: {given} J become {taken} J");
    assert!(trial.get("drop.impulse_z") < 0.0, "{what}");
}

#[test]
fn molten_metals_and_waxes_land_on_anything() {
    for (liquid, fluid) in LIQUIDS {
        for (name, solid) in [SOLIDS[0], SOLIDS[4], SOLIDS[6]] {
            let text = impact(fluid, solid, 1e-4, 1e-4, 10.0);
            lands(&format!("{liquid} on {name}"), &text, fluid[5]);
        }
    }
}

#[test]
fn small_drops_and_thin_plates_are_like_others() {
    let (liquid, fluid) = LIQUIDS[3];
    for (diameter, thickness) in [(2e-5, 1e-4), (1e-4, 2e-5), (2e-6, 2e-6)] {
        let text = impact(fluid, SOLIDS[3].1, diameter, thickness, 10.0);
        lands(&format!("{diameter} m of {liquid} on {thickness} m"), &text, fluid[5]);
    }
}

#[test]
fn drops_of_three_particles_are_refused_with_what_would_do() {
    let text = impact(LIQUIDS[0].1, SOLIDS[0].1, 1e-4, 1e-4, 3.0);
    let refusal = scene::parse(&text, "scene.toml").unwrap_err().to_string();
    for words in ["scene.toml:9:", "body.drop.spacing", "3.0 particles", "1.66667e-5"] {
        assert!(refusal.contains(words), "{words} is not in {refusal}");
    }
}
