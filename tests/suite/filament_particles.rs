//! Filaments of particles.

use impinge::model::{Cache, Model, State};
use impinge::scene;

use crate::common::Trial;

/// A short strand of warm, thick fluid on a colder plate, five particles across the nozzle.
fn strand(keys: &str) -> String {
    format!(
        r#"
name = "Strand"
stop_time = 0.1
step = 0.02
[body.ink]
kind = "filament"
method = "particles"
fluid = {{ density = 1000.0, viscosity = 5.0, specific_heat = 2000.0, conductivity = 0.2 }}
nozzle = {{ diameter = 1e-3, height = 1e-3, temperature = 340.0, flow = 15.7e-9 }}
path = {{ time = [0.0, 0.1], x = [-1e-3, 1e-3], y = [0.0, 0.0] }}
most = 1e-8
spacing = 0.2e-3
{keys}
[body.plate]
kind = "solid"
shape = {{ box = [8e-3, 6e-3, 1e-3] }}
material = "soda-lime-glass"
initial_temperature = 293.15
mesh = {{ spacing = 1e-3, order = 1 }}
faces = {{ bottom = {{ clamped = true }} }}
[[coupling]]
from = "ink"
to = "plate.top"
traction = false
interval = 5e-3
"#
    )
}

/// Volume balances to half a layer, heat to rounding, and the plate receives what the strand gives, which is wider and
/// lower than the outlet.
#[test]
fn balances_close() {
    let text = strand("") + "[[target]]\nof = \"ink\"\nline = [[-3e-3, 0.0], [3e-3, 0.0]]\n";
    let mut trial = Trial::new(&text);
    (0..5).for_each(|_| trial.step(0.02));
    let mut get = |key: &str| trial.get(&format!("ink.{key}"));
    let layer = 0.2e-3 * 0.25e-6 * std::f64::consts::PI;
    assert!((get("volume") / 15.7e-10 - 1.0).abs() < 1e-12);
    assert!(get("volume_drift").abs() < 0.5 * layer * (1.0 + 1e-9), "{}", get("volume_drift"));
    let [heat, drift] = ["heat", "heat_drift"].map(&mut get);
    assert!(heat > 0.0 && drift.abs() < 1e-9 * heat, "{drift} of {heat}");
    let [coldest, hottest] = ["min_temperature", "max_temperature"].map(&mut get);
    assert!(coldest > 293.0 && coldest < 339.0 && hottest < 340.0 + 1e-6, "{coldest} {hottest}");
    let [low, high] = ["min_density", "max_density"].map(&mut get);
    assert!(low > 970.0 && high < 1040.0, "{low} {high}");
    assert!(get("deviation") < 0.02e-3 && get("largest_deviation") < 0.05e-3);
    let [width, height] = ["width", "height"].map(&mut get);
    assert!(width > 1.2e-3 && width < 1.7e-3 && height < 1.1e-3, "{width} {height}");
    assert!(get("lag") < 1e-3);
    let received = trial.get("plate.heat_in");
    assert!((received / heat - 1.0).abs() < 1e-9, "{received} of {heat}");
}

/// A state continues to the bit on any number of threads, and damaged ones are refused.
#[test]
fn states_continue_to_the_bit() {
    let scene = scene::parse(&strand(""), "strand.toml").unwrap();
    let advance = |model: &Model, state: &mut State, steps: usize| {
        let mut cache = Cache::default();
        (0..steps).for_each(|_| model.step(state, &mut cache, 0.01).unwrap());
    };
    let [one, two] = [1, 2].map(|threads| Model::build(&scene, threads).unwrap());
    let mut whole = one.initial_state();
    advance(&one, &mut whole, 4);
    let mut halves = one.initial_state();
    advance(&one, &mut halves, 2);
    two.check_state(&halves).unwrap();
    advance(&two, &mut halves, 2);
    assert!(whole.bodies == halves.bodies);
    let place = whole.bodies.iter().position(|body| body.len() > 3000).unwrap();
    for (entry, value) in [(1, 3.0), (whole.bodies[place].len() - 1, 1.0)] {
        let mut forged = whole.clone();
        forged.bodies[place][entry] =
            if forged.bodies[place][entry] == value { 0.0 } else { value };
        assert!(two.check_state(&forged).is_err(), "{entry}");
    }
}

/// Motions that a step cannot follow are refused, and leave the state unchanged.
#[test]
fn steps_beyond_the_nozzle_are_refused() {
    let path = "{ time = [0.0, 0.1], x = [-1e-3, 1e-3], y = [0.0, 0.0] }";
    let text = strand("").replace(path, "\"input\"");
    for (name, value, wanted) in [
        ("ink.nozzle_z", 0.1e-3, "above the plate"),
        ("ink.flow", 1e-3, "`most`"),
        ("ink.flow", -1e-8, "goes back"),
        ("ink.nozzle_temperature", -1.0, "absolute zero"),
    ] {
        let mut trial = Trial::new(&text);
        trial.set(name, value);
        let before = trial.state.bodies.clone();
        let refusal = trial.try_step(0.02).unwrap_err().to_string();
        assert!(refusal.contains(wanted) && trial.state.bodies == before, "{refusal}");
    }
    let mut trial = Trial::new(&text);
    trial.set_derivative("ink.nozzle_x", 1, 50.0);
    let refusal = trial.try_step(1e-4).unwrap_err().to_string();
    assert!(refusal.contains("speed of sound"), "{refusal}");
    // Before memory for all places on its way is asked for.
    let mut trial = Trial::new(&text);
    trial.set_derivative("ink.nozzle_x", 1, 5e7);
    let refusal = trial.try_step(0.02).unwrap_err().to_string();
    assert!(refusal.contains("speed of sound"), "{refusal}");
}

/// Paths into the plate are refused when the scene is read.
#[test]
fn paths_into_the_plate_are_refused() {
    let own = "y = [0.0, 0.0]";
    let into = |height: &str| strand("").replace(own, &format!("{own}, z = [1e-3, {height}]"));
    assert!(scene::parse(&into("0.3e-3"), "scene").is_ok());
    for height in ["0.0", "0.1e-3"] {
        let refusal = scene::parse(&into(height), "scene").unwrap_err().to_string();
        assert!(refusal.contains("above the plate at 0.1 s"), "{refusal}");
    }
    // A table without flow lets it come where the scene has one; a line needs less room.
    let line = |height: &str, flow: &str| {
        let text =
            into(height).replace("method = \"particles\"\n", "").replace("flow = 15.7e-9", flow);
        scene::parse(&text, "scene").is_ok()
    };
    assert!(line("0.1e-3", "flow = 15.7e-9") && !line("0.0", "flow = 15.7e-9"));
    assert!(line("0.0", "flow = 0.0"));
}

/// Paste behind the nozzle comes to rest, and its weight and momentum reach the plate all the same.
#[test]
fn paste_comes_to_rest() {
    let warm = "viscosity = 5.0, specific_heat = 2000.0, conductivity = 0.2";
    let paste = "viscosity = { law = \"bingham\", yield_stress = 100.0, plastic_viscosity = 1.0 }, specific_heat = 2000.0, \
                 conductivity = 0.0";
    let text = strand("").replace(warm, paste).replace("height = 1e-3", "height = 0.9e-3");
    let text = text.replace("spacing = 0.2e-3", "spacing = 0.25e-3");
    // Long enough that what is laid first lies out of reach of what moves.
    let text = text
        .replace("time = [0.0, 0.1], x = [-1e-3, 1e-3]", "time = [0.0, 0.3], x = [-3e-3, 3e-3]");
    let mut trial = Trial::new(&text[..text.find("[body.plate]").unwrap()]);
    (0..10).for_each(|_| trial.step(0.03));
    let [resting, particles] = ["resting", "particles"].map(|key| trial.get(&format!("ink.{key}")));
    assert!(resting > 0.0 && resting < particles, "{resting} of {particles}");
    let before = trial.get("ink.impulse_z");
    trial.step(0.5);
    let pushes = (before - trial.get("ink.impulse_z")) / 0.5;
    // The nozzle bears a part of the weight, or presses on what yields below its outlet.
    let [weight, pressed] = [9.81 * trial.get("ink.mass"), 2.0 * 100.0 * 0.785e-6];
    assert!(pushes > 0.3 * weight && pushes < weight + pressed, "{pushes} N of {weight} N");
    assert!(trial.get("ink.max_speed") < 1e-3);
    trial.model.check_state(&trial.state).unwrap();
}

/// Paste that falls from a high nozzle as one bears hardly any stress; its solves end, and it reaches the plate.
#[test]
fn paste_falls_from_high_nozzles() {
    let text = r#"
name = "Paste"
stop_time = 0.1
step = 0.02
[body.ink]
kind = "filament"
method = "particles"
nozzle = { diameter = 1e-3, height = 1.5e-3, temperature = 293.15, flow = 15.7e-9 }
path = { time = [0.0, 0.1], x = [-1e-3, 1e-3], y = [0.0, 0.0] }
most = 5e-9
spacing = 0.25e-3
[body.ink.fluid]
density = 1400.0
viscosity = { law = "bingham", yield_stress = 60.0, plastic_viscosity = 2.0 }
specific_heat = 1500.0
conductivity = 0.0
"#;
    let mut trial = Trial::new(text);
    (0..5).for_each(|_| trial.step(0.02));
    let [length, width] = ["length", "last_width"].map(|name| trial.get(&format!("ink.{name}")));
    assert!(length > 0.1e-3 && width > 0.9e-3 && width < 2.5e-3, "{length} {width}");
}
