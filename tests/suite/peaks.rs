//! Running maxima of solids with their times and places: against closed forms, and against what the same bodies say of
//! themselves at every communication point.

use std::f64::consts::PI;

use impinge::advice::parse_with_warnings;
use impinge::laws::stress::{max_principal, von_mises};
use impinge::model::{Cache, NodalFields, State, forecast};
use impinge::scene::{self, Scene};
use impinge::variables::{Registry, Slot};

use crate::common::{Trial, off};

const ALL: &str = "peaks = [\"temperature\", \"von_mises\", \"max_principal\"]\n";
const KEYS: [[&str; 2]; 3] = [
    ["max_temperature", "peak_temperature"],
    ["max_von_mises", "peak_von_mises"],
    ["max_principal", "peak_max_principal"],
];

const ALUMINA: &str = "model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, \
                       young = 300e9, poisson = 0.21, expansion = 8.1e-6";
const STEEL: &str = "model = \"elastoplastic\", density = 7900.0, specific_heat = 500.0, conductivity = 15.0, \
                     young = 200e9, poisson = 0.3, expansion = 16e-6, yield_stress = 2e8, isotropic_hardening = 1e9";
const ICE: &str = "model = \"thermoelastic\", density = 917.0, specific_heat = 2100.0, conductivity = 2.2, young = 9e9, \
                   poisson = 0.33, expansion = 5e-5, melting = { solidus = 273.15, liquidus = 273.15, latent_heat = 334e3 }";

const BOX: &str = "box = [4e-4, 3e-4, 1e-4]";
const DISC: &str = "disc = { radius = 2e-4, thickness = 1e-4 }";
const MOVING: &str = "range = { x = [-1e-4, 1e-4], y = [-8e-5, 8e-5] }";

/// A plate under a spot that brings heat and pressure, with further keys of the body and of the spot.
fn plate(shape: &str, made_of: &str, keys: &str, of_spot: &str) -> String {
    format!(
        "name = \"Plate\"\nstop_time = 1e-5\nstep = 1e-6\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         {made_of}\n{keys}\n[body.plate.faces]\nsides = {{ roller = true }}\n\
         bottom = {{ convection = {{ coefficient = 1e3, ambient = 290.0 }}, roller = true }}\n\
         [[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ gaussian = {{ radius = 6e-5 }} }}\n\
         carries = [\"heat_flux\", \"pressure\"]\n{of_spot}\n\
         [[probe]]\nname = \"centre\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [\"stress\"]\n"
    )
}

fn of(material: &str) -> String {
    format!("material = {{ {material} }}\ninitial_temperature = 270.0")
}

/// Adds running maxima to the body.
fn with_peaks(text: &str) -> String {
    text.replacen("initial_temperature", &format!("{ALL}initial_temperature"), 1)
}

const COARSE: &str = "mesh = { spacing = 4e-5, depth_spacing = 2e-5, growth = 1.0 }";
const LINEAR: &str =
    "heat = \"sph\"\nmesh = { spacing = 3e-5, depth_spacing = 2e-5, growth = 1.0 }";

/// Bodies of all kinds, each with whether the spot moves.
fn bodies() -> Vec<(&'static str, String, bool)> {
    let layers = format!(
        "layers = [{{ material = {{ {ALUMINA} }}, thickness = 3e-5, contact_resistance = 1e-6 }}, \
         {{ material = {{ {} }}, thickness = 7e-5 }}]\ninitial_temperature = 270.0",
        ALUMINA.replace("young = 300e9", "young = 70e9")
    )
    .replacen(", contact_resistance = 1e-6", "", 1);
    let whole = format!("symmetry = \"none\"\n{COARSE}");
    vec![
        ("a box", plate(BOX, &of(ALUMINA), COARSE, MOVING), true),
        ("a whole box", plate(BOX, &of(ALUMINA), &whole, MOVING), true),
        ("a disc", plate(DISC, &of(ALUMINA), COARSE, ""), false),
        ("layers", plate(BOX, &layers, COARSE, MOVING), true),
        ("particles", plate(BOX, &of(ALUMINA), LINEAR, MOVING), true),
        ("ice that melts", plate(BOX, &of(ICE), COARSE, ""), false),
        ("a box that yields", plate(BOX, &of(STEEL), COARSE, ""), false),
        ("a disc that yields", plate(DISC, &of(STEEL), COARSE, ""), false),
    ]
}

/// Sets what the spot does from a step on: it comes and goes, and so does its pressure.
fn drive(trial: &mut Trial, step: usize, moves: bool) {
    let flux = [2e7, 6e7, 1.2e8, 0.0, -2e7, 9e7][step % 6];
    trial.set("spot.heat_flux", flux);
    trial.set("spot.pressure", if step % 4 == 2 { 4e8 } else { 0.0 });
    if moves {
        let way = step as f64 / 5.0 - 1.0;
        trial.set("spot.x", -8e-5 * way);
        trial.set("spot.y", 3e-5 * way);
    }
}

/// The highest of an output at all communication points so far, its time, and all values then.
#[derive(Default)]
struct Highest(Option<(f64, f64, NodalFields)>);

impl Highest {
    fn look(&mut self, trial: &mut Trial, key: &str) {
        let value = trial.get(&format!("plate.{key}"));
        if self.0.as_ref().is_none_or(|(highest, ..)| value > *highest) {
            self.0 = Some((value, trial.state.time, trial.fields("plate")));
        }
    }
}

/// Values of a quantity at the nodes of a place, of which there may be two on an interface.
fn values_at(fields: &NodalFields, quantity: usize, at: [f64; 3]) -> Vec<f64> {
    let [nx, ny] = [fields.axes[0].len(), fields.axes[1].len()];
    let node = |n: usize| {
        [fields.axes[0][n % nx], fields.axes[1][n / nx % ny], fields.axes[2][n / (nx * ny)]]
    };
    let there = (0..fields.temperature.len()).filter(|&n| node(n) == at);
    let value = |n: usize| match quantity {
        0 => fields.temperature[n],
        1 => von_mises(fields.stress[n]),
        _ => max_principal(fields.stress[n]),
    };
    there.map(value).collect()
}

fn place(trial: &mut Trial, key: &str) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| trial.get(&format!("plate.{key}_{axis}")))
}

#[test]
fn a_running_maximum_is_the_highest_of_what_the_body_tells_at_communication_points() {
    for (name, text, moves) in bodies() {
        let (mut plain, mut kept) = (Trial::new(&text), Trial::new(&with_peaks(&text)));
        let mut highest = [const { Highest(None) }; 3];
        let mut ahead = [false; 3];
        let mut times = std::collections::BTreeSet::new();
        for step in 0..9 {
            for trial in [&mut plain, &mut kept] {
                drive(trial, step, moves);
            }
            for (highest, [now, _]) in highest.iter_mut().zip(KEYS) {
                highest.look(&mut plain, now);
            }
            for trial in [&mut plain, &mut kept] {
                trial.step([1e-6, 3e-7][step % 2]);
            }
            assert_eq!(plain.state.bodies, kept.state.bodies, "{name}: noting changes nothing");
            for ((highest, ahead), [now, so_far]) in highest.iter_mut().zip(&mut ahead).zip(KEYS) {
                highest.look(&mut plain, now);
                let (value, time, _) = highest.0.as_ref().unwrap();
                let found = kept.get(&format!("plate.{so_far}"));
                // Outputs of a body with a history show what jumped as the step ends, maxima as it begins.
                *ahead |= name.contains("yields") && found > *value;
                if *ahead {
                    assert!(found >= *value, "{name}: {so_far} after {step}");
                    continue;
                }
                assert_eq!(found.to_bits(), value.to_bits(), "{name}: {so_far} after {step}");
                let found = kept.get(&format!("plate.{so_far}_time"));
                assert_eq!(found.to_bits(), time.to_bits(), "{name}: time of {so_far}");
                times.insert(found.to_bits());
            }
        }
        assert!(times.len() > 2, "{name}: maxima are of {} times", times.len());
        for (quantity, (highest, [_, so_far])) in highest.iter().zip(KEYS).enumerate() {
            if ahead[quantity] {
                continue;
            }
            let at = place(&mut kept, so_far);
            let (value, _, fields) = highest.0.as_ref().unwrap();
            let there = values_at(fields, quantity, at);
            let slack = if quantity == 0 { 1e-6 } else { 1.0 };
            assert!(
                there.iter().any(|other| (other - value).abs() < slack),
                "{name}: {so_far} is {value} at {at:?}, where the body has {there:?}"
            );
        }
        assert!(
            kept.heat_residual("plate") < if name == "particles" { 1e-2 } else { 1e-9 },
            "{name}"
        );
    }
}

/// A half space under a flux q for a time t is warmest at its surface at the end: 2 q √(αt/π)/k (Carslaw and Jaeger
/// 1959, §2.9).
#[test]
fn a_pulse_is_hottest_at_the_surface_as_it_ends() {
    let materials = [
        ("mercury", 8.5, 13534.0, 140.0),
        ("copper", 400.0, 8960.0, 385.0),
        ("steel", 15.0, 7900.0, 500.0),
        ("alumina", 30.0, 3950.0, 900.0),
        ("glass", 1.0, 2500.0, 800.0),
        ("aerogel", 0.015, 100.0, 1000.0),
    ];
    let (pulse, rise): (f64, f64) = (1e-3, 100.0);
    for (name, conductivity, density, specific_heat) in materials {
        let reach = (conductivity / (density * specific_heat) * pulse).sqrt();
        let flux = rise * conductivity * PI.sqrt() / (2.0 * reach);
        let depth = 12.0 * reach;
        let text = format!(
            "name = \"Pulse\"\nstop_time = 2e-3\nstep = 1e-4\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [{depth:e}, {depth:e}, {depth:e}] }}\npeaks = [\"temperature\"]\n\
             material = {{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, \
             conductivity = {conductivity:?} }}\ninitial_temperature = 300.0\n\
             mesh = {{ spacing = {:e}, depth_spacing = {:e}, growth = 1.0 }}\n\
             [body.plate.faces]\ntop = {{ flux = {flux:e} }}\n",
            depth / 4.0,
            depth / 200.0
        );
        let mut trial = Trial::new(&text);
        for step in 0..20 {
            if step == 10 {
                trial.set("plate.top.flux", 0.0);
            }
            trial.step(pulse / 10.0);
        }
        let found = trial.get("plate.peak_temperature") - 300.0;
        assert!(off(found, rise) < 1e-5, "{name}: {found} K instead of {rise} K");
        assert!(off(trial.get("plate.peak_temperature_time"), pulse) < 1e-12, "{name}");
        assert_eq!(
            place(&mut trial, "peak_temperature"),
            [0.0; 3],
            "{name}: of all the top its centre"
        );
        assert!(trial.get("plate.max_temperature") < 300.0 + 0.5 * rise, "{name} has cooled");
        assert!(trial.heat_residual("plate") < 1e-9, "{name}");
    }
}

/// A column between smooth walls under a pressure p: σ₁ = −pν/(1−ν), von Mises stress p(1−2ν)/(1−ν).
#[test]
fn a_pressure_that_comes_and_goes_is_noted_as_it_comes() {
    let text = with_peaks(&plate(BOX, &of(ALUMINA), COARSE, ""))
        .replace("gaussian = { radius = 6e-5 }", "tiles = { count = [1, 1], size = [4e-4, 3e-4] }")
        .replace("coefficient = 1e3", "coefficient = 0.0");
    let mut trial = Trial::new(&text);
    let (p, nu) = (1e8, 0.21);
    for applied in [0.0, p, 0.5 * p, 0.0, 0.0] {
        trial.set("spot.pressure[1,1]", applied);
        trial.step(1e-6);
    }
    let wanted = p * (1.0 - 2.0 * nu) / (1.0 - nu);
    assert!(off(trial.get("plate.peak_von_mises"), wanted) < 1e-9);
    assert_eq!(trial.get("plate.peak_von_mises_time"), 1e-6, "as the second step begins");
    assert_eq!(trial.get("plate.max_von_mises"), 0.0);
    // In compression no principal stress is above the zero of the beginning.
    assert_eq!(trial.get("plate.peak_max_principal"), 0.0);
    assert_eq!(trial.get("plate.peak_max_principal_time"), 0.0);
    assert_eq!(place(&mut trial, "peak_max_principal"), [0.0; 3]);
}

#[test]
fn time_and_place_follow_a_spot_that_moves() {
    let fine = COARSE.replace("4e-5", "1e-5");
    let text = plate("box = [4e-4, 4e-4, 1e-4]", &of(ALUMINA), &fine, MOVING)
        .replacen("initial_t", "peaks = [\"temperature\"]\ninitial_t", 1)
        .replace("[\"stress\"]", "[\"temperature\"]")
        .replace(", \"pressure\"]", "]");
    let mut seen = Vec::new();
    for way in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let mut trial = Trial::new(&text);
        let mut found = Vec::new();
        // The flux grows as long as the spot goes on, and once it is gone the last place was the hottest.
        for step in 0..12_i32 {
            let along = f64::from(step.min(8)) * 1e-5;
            trial.set("spot.x", way[0] * along);
            trial.set("spot.y", way[1] * 0.5 * along);
            trial.set("spot.heat_flux", if step <= 8 { 1e7 * 1.5_f64.powi(step) } else { 0.0 });
            trial.step(1e-6);
            let time = trial.get("plate.peak_temperature_time");
            assert!(
                (time - 1e-6 * f64::from(step.min(8) + 1)).abs() < 1e-15,
                "{time} in step {step}"
            );
            let [x, y, z] = place(&mut trial, "peak_temperature");
            assert!(
                (x - way[0] * along).abs() < 2.1e-5 && (y - way[1] * 0.5 * along).abs() < 2.1e-5
            );
            assert_eq!(z, 0.0);
            let value = trial.get("plate.peak_temperature");
            found.push([value, x * way[0], y * way[1]]);
        }
        assert!(trial.heat_residual("plate") < 1e-9);
        seen.push(found);
    }
    for (one, others) in seen[0].iter().zip(seen[1].iter().zip(&seen[2])) {
        for other in [others.0, others.1] {
            assert!(off(other[0], one[0]) < 1e-12 && other[1..] == one[1..], "{other:?} {one:?}");
        }
    }
}

/// A pressure that acts at once on a held block bears at once: `(1 − 2ν)/(1 − ν) p` with the moduli at once, in a block
/// that relaxes within the step, in one that creeps and in one that yields only above it. The same block that is free
/// of history says the same.
#[test]
fn stress_that_relaxes_is_seen_as_steps_begin() {
    let elastic = "density = 2000.0, specific_heat = 500.0, conductivity = 20.0, young = 10e9, poisson = 0.3, expansion = 1e-5";
    let laws = [
        "model = \"thermoelastic\"",
        "model = \"viscoelastic\", shear_relaxation = [{ fraction = 0.9, time = 1.0 }]",
        "model = \"elastoplastic\", yield_stress = 1e7",
    ];
    for law in laws {
        let text = format!(
            "name = \"Held\"\nstop_time = 300.0\nstep = 50.0\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [1e-3, 1e-3, 1e-3] }}\nmaterial = {{ {law}, {elastic} }}\ninitial_temperature = 300.0\n\
             peaks = [\"von_mises\"]\nmesh = {{ spacing = 5e-4, growth = 1.0 }}\n[body.plate.faces]\n\
             sides = {{ roller = true }}\nbottom = {{ roller = true }}\n[[load]]\nname = \"all\"\non = \"plate.top\"\n\
             footprint = {{ tiles = {{ count = [1, 1], size = [1e-3, 1e-3] }} }}\ncarries = [\"pressure\"]\n\
             start = {{ pressure = 1e6 }}\n"
        );
        // A tile over all of the face has no edge that the mesh could miss.
        let (_, warnings) = parse_with_warnings(&text, "scene").unwrap();
        assert_eq!(warnings, [], "{law}");
        let mut trial = Trial::new(&text);
        let shape = 0.4 / 0.7;
        let seen = |trial: &mut Trial, wanted: f64, time: f64| {
            let value = trial.get("plate.peak_von_mises");
            assert!(off(value, wanted) < 1e-6, "{law}: {value} for {wanted}");
            assert_eq!(trial.get("plate.peak_von_mises_time"), time, "{law}");
        };
        trial.step(50.0);
        seen(&mut trial, shape * 1e6, 0.0);
        trial.set("all.pressure[1,1]", 4e6);
        trial.step(50.0);
        let jumped = trial.get("plate.peak_von_mises");
        trial.set("all.pressure[1,1]", 1e6);
        trial.step(50.0);
        assert_eq!(trial.get("plate.peak_von_mises"), jumped, "{law}");
        // What has relaxed bears the first pressure as a fluid would, and the jump as it did at first.
        let stiff = 0.1 * 10e9 / 2.6;
        let bulk = 10e9 / 1.2;
        let relaxed = stiff * 2.0 / (bulk + 4.0 / 3.0 * stiff);
        let rest = if law.contains("relaxation") { relaxed * 1e6 } else { shape * 1e6 };
        seen(&mut trial, rest + shape * 3e6, 50.0);
    }
}

/// In a film that is held all along, σ_xx = σ_yy is the von Mises stress, which perfect plasticity bounds.
#[test]
fn a_held_film_bears_its_yield_stress_and_no_more() {
    let perfect = STEEL.replace(", isotropic_hardening = 1e9", "");
    for shape in [BOX, DISC] {
        let text = with_peaks(&plate(shape, &of(&perfect), COARSE, ""))
            .replacen("[body.plate.faces]", "[body.plate.faces]\ntop = { flux = 0.0 }", 1)
            .replace("coefficient = 1e3", "coefficient = 0.0");
        let mut trial = Trial::new(&text);
        let held = trial.get("plate.peak_von_mises");
        assert!(held < 1.0, "{shape}: {held} Pa at rest");
        // By 10 K/s, so slowly that the film is as warm all through.
        let flux = 7900.0 * 500.0 * 1e-4 * 10.0;
        trial.set("plate.top.flux", flux);
        trial.step(1.0);
        let elastic = 200e9 * 16e-6 * 10.0 / 0.7;
        let found = trial.get("plate.peak_von_mises");
        assert!(off(found, elastic) < 2e-3, "{shape}: {found} instead of {elastic}");
        (0..6).for_each(|_| trial.step(1.5));
        trial.set("plate.top.flux", -flux);
        trial.step(1.0);
        assert!(off(trial.get("plate.peak_von_mises"), 2e8) < 1e-8, "{shape}");
        assert!(trial.get("plate.peak_von_mises_time") > 4.0);
        assert!(trial.heat_residual("plate") < 1e-9, "{shape}");
    }
}

#[test]
fn a_state_that_is_put_back_goes_on_to_the_bit_on_any_number_of_threads() {
    for (name, text, moves) in bodies() {
        let text = with_peaks(&text);
        let (mut trial, mut other) = (Trial::new(&text), Trial::on_threads(&text, 4));
        let run = |trial: &mut Trial, steps: std::ops::Range<usize>| -> Vec<State> {
            let step = |step| {
                drive(trial, step, moves);
                trial.step(1e-6);
                trial.state.clone()
            };
            steps.map(step).collect()
        };
        let half = run(&mut trial, 0..3).pop().unwrap();
        assert_eq!(half.peaks.len(), 3);
        trial.model.check_state(&half).unwrap();
        let wanted = run(&mut trial, 3..6);
        trial.restart(&half);
        assert_eq!(run(&mut trial, 3..6), wanted, "{name}");
        other.restart(&half);
        assert_eq!(run(&mut other, 3..6), wanted, "{name} on four threads");
    }
}

#[test]
fn a_step_that_fails_notes_nothing() {
    let text = with_peaks(&plate(BOX, &of(ALUMINA), COARSE, ""));
    // Too cold for any body, and too hot for numbers of its stress.
    for (flux, dt) in [(-1e12, 1e-6), (1e308, 1e-5)] {
        let mut trial = Trial::new(&text);
        drive(&mut trial, 0, false);
        trial.step(1e-6);
        let before = trial.get("plate.peak_von_mises");
        trial.set("spot.heat_flux", flux);
        trial.set("spot.pressure", 1e12);
        let state = trial.state.clone();
        let error = trial.try_step(dt).unwrap_err().to_string();
        assert!(error.contains("absolute zero") || error.contains("grows beyond"), "{error}");
        assert_eq!(trial.state, state);
        trial.set("spot.heat_flux", 0.0);
        trial.set("spot.pressure", 0.0);
        trial.step(1e-6);
        assert!(trial.get("plate.peak_von_mises") < 2.0 * before, "the pressure was never there");
    }
}

#[test]
fn the_time_of_a_step_that_is_known_better_is_that_of_what_it_noted() {
    let mut trial = Trial::new(&with_peaks(&plate(BOX, &of(ALUMINA), COARSE, "")));
    trial.set("spot.heat_flux", 1e7);
    trial.step(1e-6);
    let first = trial.state.time;
    trial.set("spot.pressure", 1e9);
    trial.step(1e-6);
    trial.state.set_time(2.5e-6);
    assert_eq!(trial.state.peaks[0].time, 2.5e-6);
    assert_eq!(trial.state.peaks[1].time, first, "noted as the step began");
    trial.model.check_state(&trial.state).unwrap();
}

/// Whatever inputs change, outputs are those that nothing but the state leads to.
#[test]
fn what_is_kept_as_inputs_change_is_what_would_be_found_anew() {
    for (name, text, moves) in bodies() {
        let text = with_peaks(&text).replacen(
            "[body.plate.faces]",
            "[body.plate.faces]\ntop = { flux = 0.0 }",
            1,
        );
        let mut trial = Trial::new(&text);
        let outputs = trial.outputs();
        let compare = |trial: &mut Trial, what: &str| {
            for output in &outputs {
                let found = trial.get(output);
                let (place, state) = (trial.output(output), trial.state.clone());
                let anew = trial.model.output(&state, &mut Cache::default(), &place).unwrap();
                assert_eq!(found.to_bits(), anew.to_bits(), "{name}: {output} after {what}");
            }
        };
        for step in 0..4 {
            drive(&mut trial, step, moves);
            compare(&mut trial, "a change of the spot");
            trial.set("plate.top.flux", 1e6 * step as f64);
            compare(&mut trial, "a change of the face");
            trial.set("spot.heat_flux", 3e7);
            compare(&mut trial, "a change of the flux");
            trial.step(1e-6);
            compare(&mut trial, "a step");
        }
    }
}

#[test]
fn running_maxima_follow_no_input_at_once_and_have_no_rate() {
    let text = with_peaks(&plate(BOX, &of(ALUMINA), COARSE, ""));
    let scene = scene::parse(&text, "scene").unwrap();
    let registry = Registry::of(&scene);
    let mut found = 0;
    for variable in &registry.variables {
        if let Slot::Output(output) = &variable.slot
            && variable.name.contains(".peak_")
        {
            assert!(registry.dependencies(&scene, output).is_empty(), "{}", variable.name);
            found += 1;
        }
    }
    assert_eq!(found, 15);
    let mut trial = Trial::new(&text);
    let [peak, now] = ["plate.peak_von_mises", "plate.max_von_mises"].map(str::to_owned);
    trial.set("spot.pressure", 1e8);
    // Before anything is noted it is that of the present.
    let changes = trial.changes(&[peak.clone(), now.clone()], &[("spot.pressure", 1.0)]);
    assert!(changes[0] == changes[1] && changes[0] > 0.1, "{changes:?}");
    trial.step(1e-6);
    assert_eq!(trial.changes(std::slice::from_ref(&peak), &[("spot.pressure", 1.0)]), [0.0]);
    let mut tangent = trial.model.time_tangent(&trial.state, &mut Cache::default()).unwrap();
    let output = trial.output(&peak);
    let rate = trial.model.output_rate(&trial.state, &mut Cache::default(), &mut tangent, &output);
    assert!(rate.unwrap_err().to_string().contains("have no derivative"));
}

#[test]
fn states_that_no_run_leads_to_are_refused() {
    let mut trial = Trial::new(&with_peaks(&plate(BOX, &of(ALUMINA), COARSE, "")));
    drive(&mut trial, 0, false);
    trial.step(1e-6);
    let refused = |change: &dyn Fn(&mut State), words: &str| {
        let mut state = trial.state.clone();
        change(&mut state);
        let error = trial.model.check_state(&state).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(&|s| s.peaks.truncate(2), "2 running maxima; the scene has 3");
    refused(&|s| s.peaks[1].time = 1.5e-6, "after the state's 0.000001 s");
    refused(&|s| s.peaks[1].time = f64::NAN, "is not finite");
    refused(&|s| s.peaks[2].highest.value = f64::INFINITY, "is not finite");
    refused(&|s| s.peaks[0].highest.value = 0.0, "0 as a running maximum of plate");
    refused(&|s| s.peaks[1].highest.value = -1.0, "-1 as a running maximum of plate");
    refused(&|s| s.peaks[1].highest.at[0] = 2.1e-4, "outside of it");
    refused(&|s| s.peaks[1].highest.at[1] = -1.6e-4, "outside of it");
    refused(&|s| s.peaks[0].highest.at[2] = 1e-6, "outside of it");
    refused(&|s| s.peaks[0].highest.at[2] = -1.1e-4, "outside of it");
}

fn scene_of(text: &str) -> Result<Scene, String> {
    scene::parse(text, "scene").map_err(|error| error.to_string())
}

#[test]
fn lists_that_make_no_sense_are_refused() {
    let text = plate(BOX, &of(ALUMINA), COARSE, "");
    let with = |list: &str| {
        scene_of(&text.replacen("initial_t", &format!("peaks = [{list}]\ninitial_t"), 1))
    };
    assert!(with("").is_ok());
    let twice = with("\"temperature\", \"von_mises\", \"temperature\"").unwrap_err();
    assert!(twice.contains("named twice") && twice.contains("scene:8"), "{twice}");
    let unknown = with("\"tresca\"").unwrap_err();
    assert!(unknown.contains("temperature") && unknown.contains("max_principal"), "{unknown}");
    let heat = ALUMINA.split(", young").next().unwrap();
    let bare = text.replace(ALUMINA, heat).replace("[\"stress\"]", "[\"temperature\"]");
    let bare = bare.replace(", \"pressure\"]", "]");
    assert!(
        scene_of(&bare.replacen("initial_t", "peaks = [\"temperature\"]\ninitial_t", 1)).is_ok()
    );
    let stress = bare.replacen("initial_t", "peaks = [\"von_mises\"]\ninitial_t", 1);
    let error = scene_of(&stress).unwrap_err();
    assert!(error.contains("`young` is missing") && error.contains("scene:7"), "{error}");
    let chuck =
        "[body.chuck]\nkind = \"reservoir\"\nheat_capacity = 1.0\ninitial_temperature = 300.0\n";
    let error = scene_of(&format!("{text}{chuck}{ALL}")).unwrap_err();
    assert!(error.contains("peaks"), "{error}");
}

#[test]
fn mechanics_that_only_running_maxima_ask_for_is_prepared_and_counted() {
    let bare = plate(BOX, &of(ALUMINA), COARSE, "")
        .replace("[\"stress\"]", "[\"temperature\"]")
        .replace(", \"pressure\"]", "]");
    let stress = bare.replacen("initial_t", "peaks = [\"von_mises\"]\ninitial_t", 1);
    let [without, with] = [&bare, &stress].map(|text| forecast(&scene_of(text).unwrap()).bodies);
    assert!(with[0].unknowns[1] > 0 && without[0].unknowns[1] == 0);
    assert!(with[0].step_time > without[0].step_time);
    assert!(with[0].notes.iter().any(|note| note.contains("every communication point")));
    let mut trial = Trial::new(&stress);
    trial.set("spot.heat_flux", 1e7);
    trial.step(1e-6);
    assert!(trial.get("plate.peak_von_mises") > 1e5);
}

/// The face of a quenched body bears `E α ΔT/(1 − ν)` at most; elements beside a face whose temperature has just jumped
/// would show up to a quarter more.
#[test]
fn jumps_of_prescribed_temperatures_leave_no_false_stress() {
    for (material, bound) in [
        (ALUMINA, 300e9 * 8.1e-6 * 100.0 / 0.79),
        (ICE.split(", melting").next().expect("a start"), 9e9 * 5e-5 * 100.0 / 0.67),
    ] {
        let text = format!(
            "name = \"Quench\"\nstop_time = 1e-3\nstep = 1e-4\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ disc = {{ radius = 2e-2, thickness = 1e-2 }} }}\nmaterial = {{ {material} }}\n\
             initial_temperature = 270.0\npeaks = [\"max_principal\"]\nfaces.top = {{ temperature = 270.0 }}\n\
             faces.sides = {{ roller = true }}\nfaces.bottom = {{ roller = true }}\n\
             mesh = {{ spacing = 2e-3, depth_spacing = 1e-5, growth = 1.3, order = 1 }}\n"
        );
        let mut trial = Trial::new(&text);
        trial.set("plate.top.temperature", 170.0);
        (0..20).for_each(|_| trial.step(1e-4));
        let peak = trial.get("plate.peak_max_principal");
        assert!(peak > 0.97 * bound && peak < 1.02 * bound, "{peak:e} {bound:e}");
    }
}
