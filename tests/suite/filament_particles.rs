//! Filaments of particles.

use std::f64::consts::PI;

use impinge::model::{Cache, Model, State, forecast};
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
    let layer = 0.2e-3 * 0.25e-6 * PI;
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

/// A thread that hangs from the nozzle gives heat to the air through its side: where heat passes easily across it, what
/// left the outlet a time s ago is `exp(−s/τ)` of its difference from the air, `τ = ρcD/(4h)`.
#[test]
fn threads_in_air_cool_through_their_side() {
    let (diameter, speed, coefficient): (f64, f64, f64) = (1e-3, 20e-3, 100.0);
    let decay = 1000.0 * 2000.0 * diameter / (4.0 * coefficient);
    let exact = |time: f64| {
        let cooled = decay * time - decay * decay * (1.0 - (-time / decay).exp());
        coefficient * 60.0 * PI * diameter * speed * cooled
    };
    for (across, wanted) in [(4.0, 0.91), (6.0, 0.93)] {
        let air = format!("convection = {{ coefficient = {coefficient}, ambient = 280.0 }}");
        let text = strand(&air)
            .replace("viscosity = 5.0", "viscosity = 50.0")
            .replace("conductivity = 0.2", "conductivity = 5.0")
            .replace("height = 1e-3", "height = 9e-3")
            .replace("time = [0.0, 0.1], x = [-1e-3, 1e-3]", "time = [0.0, 0.3], x = [0.0, 0.0]")
            .replace("spacing = 0.2e-3", &format!("spacing = {:e}\ngravity = 0.0", 1e-3 / across));
        let mut trial = Trial::new(&text);
        let lost = [0.15, 0.3].map(|time| {
            trial.step(0.15);
            (time, trial.get("ink.heat_lost"))
        });
        // Where the end has passed the surface is that of the side alone.
        let part = (lost[1].1 - lost[0].1) / (exact(lost[1].0) - exact(lost[0].0));
        assert!((part - wanted).abs() < 0.03, "{across}: {part}");
        let drift = trial.get("ink.heat_drift") / lost[1].1;
        assert!(drift.abs() < 1e-7 && trial.get("ink.heat") == 0.0, "{drift}");
    }
}

/// Paste that conducts heat sleeps as any other, and goes on cooling: long after it came to rest it is nearly as cold
/// as plate and air, and heat balances to rounding.
#[test]
fn paste_at_rest_cools() {
    let warm = "viscosity = 5.0, specific_heat = 2000.0, conductivity = 0.2";
    let paste = "viscosity = { law = \"bingham\", yield_stress = 100.0, plastic_viscosity = 1.0 }, specific_heat = 2000.0, \
                 conductivity = 0.5";
    let text = strand("convection = { coefficient = 100.0, ambient = 293.15 }")
        .replace(warm, paste)
        .replace("height = 1e-3", "height = 0.9e-3")
        .replace("spacing = 0.2e-3", "spacing = 0.25e-3")
        .replace("time = [0.0, 0.1], x = [-1e-3, 1e-3]", "time = [0.0, 0.3], x = [-3e-3, 3e-3]");
    let mut trial = Trial::new(&text);
    (0..12).for_each(|_| trial.step(0.025));
    assert!(trial.get("ink.resting") > 50.0, "{}", trial.get("ink.resting"));
    let balance = |trial: &mut Trial| {
        let heat = trial.get("ink.heat");
        let [drift, received] = ["ink.heat_drift", "plate.heat_in"].map(|key| trial.get(key));
        assert!(drift.abs() < 1e-9 * heat, "{drift} of {heat}");
        assert!((received / heat - 1.0).abs() < 1e-9, "{received} of {heat}");
    };
    balance(&mut trial);
    let early = trial.get("ink.min_temperature");
    (0..10).for_each(|_| trial.step(1.0));
    balance(&mut trial);
    // What the nozzle holds stays warm beside it, and warms plate and air, too.
    let [lost, heat] = ["ink.heat_lost", "ink.heat"].map(|key| trial.get(key));
    let all = 0.785398e-6 * 6e-3 * 2e6 * (340.0 - 293.15);
    let late = trial.get("ink.min_temperature");
    assert!(early > 302.0 && (293.15..297.0).contains(&late), "{early} {late}");
    assert!(
        lost > 0.05 * all && (0.9..1.3).contains(&((lost + heat) / all)),
        "{lost} {heat} {all}"
    );
}

/// Air that warms within a step is as warm at each time as its derivatives say.
#[test]
fn air_follows_its_derivatives_within_a_step() {
    let text = strand("convection = { coefficient = 100.0, ambient = 280.0 }")
        .replace("interval = 5e-3", "interval = 0.2");
    let lost = |steps: usize| {
        let mut trial = Trial::new(&text);
        for n in 0..steps {
            let time = 0.2 * n as f64 / steps as f64;
            trial.set("ink.ambient", 280.0 + time * 1500.0 * time);
            trial.set_derivative("ink.ambient", 1, 3000.0 * time);
            trial.set_derivative("ink.ambient", 2, 3000.0);
            trial.step(0.2 / steps as f64);
        }
        trial.get("ink.heat_lost")
    };
    let [long, short] = [1, 20].map(lost);
    assert!((long / short - 1.0).abs() < 0.03, "{long} J, {short} J");
}

/// Paste of which each bead is laid in 0.2 s, and then left alone.
fn bead(law: &str, path: &str) -> String {
    format!(
        r#"
name = "Bead"
stop_time = 0.6
step = 0.05
[body.ink]
kind = "filament"
method = "particles"
fluid = {{ density = 1400.0, viscosity = {law}, specific_heat = 1500.0, conductivity = 0.0 }}
nozzle = {{ diameter = 1e-3, height = 0.8e-3, temperature = 353.15 }}
path = {{ {path} }}
most = 3.2e-9
spacing = 0.25e-3
"#
    )
}

const PASTE: &str = "{ law = \"bingham\", yield_stress = 60.0, plastic_viscosity = 2.0 }";
const STILL: &str = "time = [0.0, 0.2, 1.0, 2.0], x = [-2e-3, 2e-3, 2e-3, 2e-3], y = [0.0, 0.0, 0.0, 0.0], flow = [1.57e-8, \
                     0.0, 0.0, 0.0]";

/// Moves after the stop time, or while nothing flows, leave the strand unchanged: its shape depends on the speed of
/// sound, which follows the fastest flow.
#[test]
fn strands_ignore_moves_that_lay_nothing() {
    let model_of = |path: &str| {
        let scene = scene::parse(&bead(PASTE, path), "bead.toml").unwrap();
        let notes = forecast(&scene).filaments.remove(0).notes;
        (notes.into_iter().find(|note| note.contains("sound passes at"))).expect("a note on sound")
    };
    let alone = model_of(STILL);
    let lifted = "z = [0.8e-3, 0.8e-3, 0.8e-3, 0.25]";
    assert_eq!(model_of(&format!("{STILL}, {lifted}")), alone);
    let late = STILL.replace("flow = [1.57e-8, 0.0, 0.0", "flow = [1.57e-8, 0.0, 5e-7");
    assert_eq!(model_of(&late), alone);
    let travels =
        STILL.replace("1.0, 2.0], x = [-2e-3, 2e-3, 2e-3", "0.25, 2.0], x = [-2e-3, 2e-3, 10e-3");
    assert_eq!(model_of(&travels), alone);
    // A nozzle that moves faster than a sixth of the speed of sound raises that.
    let races = travels.replace("10e-3", "200e-3");
    assert!(model_of(&races) != alone);
    let mut trial = Trial::new(&bead(PASTE, &races));
    trial.step(0.3);
    assert!(trial.get("ink.max_speed") > 0.0);
}

/// Widths of a short bead of paste depend on the distance of particles and on the speed of sound, as `docs/scene.md`
/// says: at 4 across, by default, at 1.4 m/s and at 30 m/s, and at 6 across.
#[test]
fn widths_of_paste_depend_on_spacing_and_sound() {
    let width = |spacing: &str, sound: &str| {
        let text = bead(PASTE, STILL).replace("0.25e-3", spacing);
        let text = text.replace("conductivity = 0.0", &format!("conductivity = 0.0{sound}"));
        let mut trial = Trial::new(&text);
        (0..5).for_each(|_| trial.step(0.05));
        1e3 * trial.get("ink.width")
    };
    let widths = [
        width("0.25e-3", ""),
        width("0.25e-3", ", sound_speed = 1.4"),
        width("0.25e-3", ", sound_speed = 30.0"),
        width("0.1667e-3", ""),
    ];
    println!("widths of paste: {widths:.3?} mm");
    for (found, wanted) in widths.iter().zip([1.746, 1.417, 1.857, 1.559]) {
        assert!((found / wanted - 1.0).abs() < 0.02, "{widths:?} mm");
    }
}

/// A jet is noted where the path sets the flow, too.
#[test]
fn jets_of_paths_are_noted() {
    let is_jet = |flow: &str| {
        let text =
            bead("1e-3", &STILL.replace("1.57e-8", flow)).replace("most = 3.2e-9", "most = 1e-6");
        let text = text.replace("conductivity = 0.0", "conductivity = 0.0, surface_tension = 0.07");
        [text.clone(), text.replace("method = \"particles\"\n", "")].map(|text| {
            let scene = scene::parse(&text, "bead.toml").unwrap();
            forecast(&scene).filaments[0].notes.iter().any(|note| note.contains("as a jet"))
        })
    };
    assert_eq!([is_jet("1e-6"), is_jet("1e-8")], [[true; 2], [false; 2]]);
}

/// A yield stress that bears nothing holds nothing: such a strand spreads on as one without, at the rate to which both
/// solvers resolve it.
#[test]
fn faint_yield_stresses_hold_nothing() {
    let long = STILL.replace("0.2, 1.0, 2.0", "0.2, 30.0, 31.0");
    let grown = |law: &str| {
        let mut trial = Trial::new(&bead(law, &long));
        trial.step(1.0);
        let before = trial.get("ink.width");
        trial.step(2.0);
        trial.get("ink.width") - before
    };
    let faint = grown("{ law = \"bingham\", yield_stress = 1e-3, plastic_viscosity = 20.0 }");
    let none = grown("20.0");
    assert!((0.8..1.4).contains(&(faint / none)), "{faint} m, {none} m");
}

/// Fluid at rest gives the plate as much heat in long exchanges as in short ones.
#[test]
fn heat_of_fluid_at_rest_does_not_follow_the_interval() {
    let heat = |interval: f64| {
        // The plate takes all heat: its own response does not follow the interval.
        let text = bead(PASTE, &STILL.replace("0.2, 1.0, 2.0", "0.2, 5.0, 6.0"))
            .replace("conductivity = 0.0", "conductivity = 20.0")
            + &format!(
                "convection = {{ coefficient = 100.0, ambient = 293.15 }}\n[body.plate]\nkind = \"solid\"\nshape = {{ box = \
                 [8e-3, 8e-3, 2e-3] }}\nmaterial = {{ model = \"thermoelastic\", density = 9e3, specific_heat = 4e4, \
                 conductivity = 4e4 }}\ninitial_temperature = 293.15\nmesh = {{ spacing = 1e-3 }}\n[[coupling]]\nfrom = \
                 \"ink\"\nto = \"plate.top\"\ntraction = false\ninterval = {interval}\n"
            );
        let mut trial = Trial::new(&text);
        (0..2).for_each(|_| trial.step(0.25));
        ["heat", "heat_lost"].map(|key| trial.get(&format!("ink.{key}")))
    };
    let [usual, long] = [0.01, 0.25].map(heat);
    for (long, usual) in long.iter().zip(usual) {
        assert!((long / usual - 1.0).abs() < 0.05, "{long} J, {usual} J");
    }
}

/// Wax that freezes on a cold plate comes to rest there, and continues to the bit from a state in between.
#[test]
fn wax_freezes_and_rests() {
    let warm = "density = 1000.0, viscosity = 5.0, specific_heat = 2000.0, conductivity = 0.2";
    let wax = "density = 780.0, viscosity = 0.5, specific_heat = 2300.0, conductivity = 1.0, melting = { solidus = 330.0, \
               liquidus = 332.0, latent_heat = 4e4 }";
    let text = strand("convection = { coefficient = 100.0, ambient = 293.15 }")
        .replace(warm, wax)
        .replace("height = 1e-3", "height = 0.9e-3")
        .replace("spacing = 0.2e-3", "spacing = 0.25e-3")
        .replace("flow = 15.7e-9", "flow = 3e-9")
        .replace("time = [0.0, 0.1], x = [-1e-3, 1e-3]", "time = [0.0, 2.4], x = [-3e-3, 3e-3]");
    let scene = scene::parse(&text, "wax.toml").unwrap();
    let [one, two] = [1, 2].map(|threads| Model::build(&scene, threads).unwrap());
    let advance = |model: &Model, state: &mut State, steps: usize| {
        let mut cache = Cache::default();
        (0..steps).for_each(|_| model.step(state, &mut cache, 0.1).unwrap());
    };
    let mut whole = one.initial_state();
    advance(&one, &mut whole, 20);
    let mut halves = one.initial_state();
    // In between some fluid rests.
    advance(&one, &mut halves, 16);
    two.check_state(&halves).unwrap();
    advance(&two, &mut halves, 4);
    assert!(whole.bodies == halves.bodies);
    let mut trial = Trial::new(&text);
    trial.restart(&whole);
    let mut get = |key: &str| trial.get(&format!("ink.{key}"));
    let [frozen, resting, heat] = ["solid_fraction", "resting", "heat"].map(&mut get);
    assert!(frozen > 0.7 && resting > 50.0, "{frozen} {resting}");
    let [drift, lost] = ["heat_drift", "heat_lost"].map(&mut get);
    assert!(drift.abs() < 1e-8 * heat && lost > 0.0, "{drift} of {heat}, {lost}");
    trial.set("ink.nozzle_temperature", 331.0);
    let refusal = trial.try_step(0.1).unwrap_err().to_string();
    assert!(refusal.contains("frozen") && refusal.contains("332"), "{refusal}");
}

/// Air so cold that fluid freezes at the outlet is warned of.
#[test]
fn fluid_that_freezes_at_the_outlet_is_warned_of() {
    let warm = "density = 1000.0, viscosity = 5.0, specific_heat = 2000.0, conductivity = 0.2";
    let wax = "density = 780.0, viscosity = 0.5, specific_heat = 2300.0, conductivity = 1.0, melting = { solidus = 330.0, \
               liquidus = 332.0, latent_heat = 4e4 }";
    let warned = |coefficient: &str| {
        let air = format!("convection = {{ coefficient = {coefficient}, ambient = 253.15 }}");
        let text = strand(&air).replace(warm, wax).replace("spacing = 0.2e-3", "spacing = 0.25e-3");
        let mut trial = Trial::new(&text);
        (0..3).for_each(|_| trial.step(0.02));
        let told = trial.model.warnings(&trial.state);
        told.iter().any(|one| one.finding().id == "strand_freezes_at_outlet")
    };
    assert!(warned("1e5") && !warned("50.0"));
}

/// A plate whose constants depend on the temperature costs more than the strand, which `check` notes.
#[test]
fn nonlinear_plates_below_strands_are_noted() {
    let costs = |material: &str| {
        let text = strand("").replace("material = \"soda-lime-glass\"", material);
        let text = text.replace("spacing = 1e-3, order", "spacing = 1e-4, order");
        let scene = scene::parse(&text, "strand.toml").unwrap();
        let notes = &forecast(&scene).filaments[0].notes;
        notes.iter().any(|note| note.contains("heat is not linear"))
    };
    assert!(costs("material = \"aluminium\""));
    assert!(!costs("material = { substance = \"aluminium\", at = 300.0 }"));
}
