//! Loads whose heat is a power in watts.

use std::f64::consts::PI;

use impinge::scene::{self, Scene};
use impinge::variables::Registry;

use crate::common::{Trial, off};

const POWER: f64 = 2.0;
const RADIUS: f64 = 1.2e-4;
const DISC: &str = "disc = { radius = 1.2e-4 }";
const GAUSSIAN: &str = "gaussian = { radius = 1.2e-4 }";
const RING: &str = "ring = { inner = 6e-5, outer = 1.2e-4 }";
const FOOTPRINTS: [&str; 3] = [DISC, GAUSSIAN, RING];

const PROBES: [&str; 2] = ["p.temperature", "q.temperature"];

const BOX: &str = "box = [8e-4, 6e-4, 2e-4]";
const ROUND: &str = "disc = { radius = 4e-4, thickness = 2e-4 }";

/// Heat flux of a power on a footprint of an outer radius, by the formulas of the manual.
fn flux(footprint: &str, power: f64, radius: f64) -> f64 {
    let area = PI * radius * radius;
    match footprint {
        DISC => power / area,
        GAUSSIAN => 2.0 * power / area,
        _ => power / (area - PI * (radius / 2.0).powi(2)),
    }
}

/// A plate under a load; `carried` is its heat and the start values.
fn plate(shape: &str, footprint: &str, [carried, start]: [&str; 2], rest: &str) -> String {
    let place = if shape == BOX { ", x = 5e-5, y = -8e-5" } else { "" };
    format!(
        "name = \"Plate\"\nstop_time = 1e-3\nstep = 1e-4\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = 300.0\nmaterial = {{ model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, \
         conductivity = 30.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }}\n\
         mesh = {{ spacing = 6e-5, depth_spacing = 4e-5 }}\n[body.plate.faces]\nbottom = {{ clamped = true }}\n\
         [[load]]\nname = \"beam\"\non = \"plate.top\"\nfootprint = {{ {footprint} }}\ncarries = [\"{carried}\"]\n\
         start = {{ {start}{place} }}\n{rest}\n\
         [[probe]]\nname = \"p\"\nin = \"plate\"\nat = [5e-5, 0.0, 0.0]\ngives = [\"temperature\"]\n\
         [[probe]]\nname = \"q\"\nin = \"plate\"\nat = [1e-4, 0.0, -5e-5]\ngives = [\"temperature\"]\n"
    )
}

fn powered(shape: &str, footprint: &str, rest: &str) -> String {
    plate(shape, footprint, ["power", "power = \"2 W\""], rest)
}

/// Largest difference of temperatures over the largest rise.
fn difference(trials: [&mut Trial; 2]) -> f64 {
    let [found, wanted] = trials.map(|trial| PROBES.map(|name| trial.get(name)));
    let largest = wanted.iter().fold(0.0, |largest: f64, t| largest.max((t - 300.0).abs()));
    let apart = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs() / largest);
    apart.fold(0.0, f64::max)
}

#[test]
fn power_and_equivalent_flux_heat_alike() {
    for shape in [BOX, ROUND] {
        for footprint in FOOTPRINTS {
            let flux = format!("heat_flux = {:?}", flux(footprint, POWER, RADIUS));
            let mut by_power = Trial::new(&powered(shape, footprint, ""));
            let mut by_flux = Trial::new(&plate(shape, footprint, ["heat_flux", &flux], ""));
            for _ in 0..2 {
                by_power.step(1e-4);
                by_flux.step(1e-4);
                let apart = difference([&mut by_power, &mut by_flux]);
                assert!(apart < 1e-12, "{shape} {footprint}: {apart:e}");
            }
            assert!(by_power.get("p.temperature") > 310.0);
        }
    }
}

#[test]
fn heat_that_enters_is_the_power_times_the_time_while_the_radius_changes() {
    for shape in [BOX, ROUND] {
        for footprint in [DISC, RING] {
            let mut trial = Trial::new(&powered(shape, footprint, ""));
            trial.set_derivative("beam.radius", 1, 0.2);
            trial.set_derivative("beam.power", 1, 1e4);
            trial.step(1e-4);
            let heat = (POWER + 0.5 * 1e4 * 1e-4) * 1e-4;
            assert!(off(trial.get("plate.heat_in"), heat) < 1e-12, "{shape} {footprint}");
            assert!(trial.heat_residual("plate") < 1e-9);
        }
    }
}

/// The share of the beam on its face is that of its integral over the face.
#[test]
fn heat_of_a_gaussian_is_its_share_on_the_face() {
    for shape in [BOX, ROUND] {
        let wide = "gaussian = { radius = 2.2e-4 }";
        let text = powered(shape, wide, "");
        let parsed: Scene = scene::parse(&text, "scene.toml").unwrap();
        let share = parsed.load[0].least_share_on(&parsed.solid("plate").unwrap().shape);
        let mut trial = Trial::new(&text);
        trial.step(1e-4);
        assert!((0.9..0.999).contains(&share), "{shape}: {share}");
        assert!(off(trial.get("plate.heat_in"), share * POWER * 1e-4) < 1e-6, "{shape}");
    }
}

/// Against a flux that is given anew as a quadratic in time over each of many short steps.
#[test]
fn defocused_beams_keep_their_power() {
    let (rate, step, count) = (0.4, 1e-4, 16);
    for (shape, footprint) in [(BOX, GAUSSIAN), (BOX, DISC), (ROUND, RING), (ROUND, GAUSSIAN)] {
        let range = "range = { radius = [6e-5, 1.7e-4] }";
        let mut by_power = Trial::new(&powered(shape, footprint, range));
        by_power.set_derivative("beam.radius", 1, rate);
        by_power.step(step);
        let start = "heat_flux = 0.0";
        let mut by_flux = Trial::new(&plate(shape, footprint, ["heat_flux", start], range));
        let h = step / f64::from(count);
        for n in 0..count {
            let radius = RADIUS + rate * f64::from(n) * h;
            let (flux, growth) = (flux(footprint, POWER, radius), rate / radius);
            by_flux.set("beam.heat_flux", flux);
            by_flux.set("beam.radius", radius);
            by_flux.set_derivative("beam.heat_flux", 1, -2.0 * flux * growth);
            by_flux.set_derivative("beam.heat_flux", 2, 6.0 * flux * growth * growth);
            by_flux.set_derivative("beam.radius", 1, rate);
            by_flux.step(h);
        }
        // Both steps have a fourth-order error while the footprint grows by an eighth of itself.
        let apart = difference([&mut by_power, &mut by_flux]);
        assert!(apart < 2e-4, "{shape} {footprint}: {apart:e}");
        let heat = by_power.get("plate.heat_in");
        assert!(off(by_flux.get("plate.heat_in"), heat) < 1e-5, "{shape} {footprint}");
    }
}

const REDUCED: &str =
    "range = { radius = [8e-5, 1.6e-4] }\n[fidelity]\nlevel = \"reduced\"\ntolerance = 1e-4\n";

#[test]
fn reduced_solids_follow_power_and_radius_within_bounds() {
    let text = powered(ROUND, GAUSSIAN, REDUCED);
    let mut reduced = Trial::new(&text);
    let mut full = Trial::new(&text.replace("\"reduced\"", "\"full\""));
    for n in 0..8 {
        for trial in [&mut full, &mut reduced] {
            trial.set("beam.radius", 8e-5 + 1e-5 * f64::from(n));
            trial.set_derivative("beam.radius", 1, 0.1);
            trial.set("beam.power", POWER * f64::from(1 + n % 3));
            trial.step(1e-4);
        }
        let bound = reduced.get("plate.error_bound_temperature");
        for name in PROBES {
            let (wanted, found) = (full.get(name), reduced.get(name));
            assert!((wanted - found).abs() <= bound, "{name}: {wanted} {found} {bound:e}");
        }
        // As tight as that of a flux on a footprint that changes.
        let rise = full.get("p.temperature") - 300.0;
        assert!(bound < 0.4 * rise, "{bound:e} {rise}");
        let (wanted, found) = (full.get("plate.heat_in"), reduced.get("plate.heat_in"));
        assert!(off(found, wanted) < 1e-6, "{found} {wanted}");
    }
}

/// Central differences of outputs between two states of a trial.
fn slopes(names: &[String], [above, below]: [Vec<f64>; 2], step: f64) -> Vec<f64> {
    (0..names.len()).map(|i| (above[i] - below[i]) / (2.0 * step)).collect()
}

fn values(trial: &mut Trial, names: &[String]) -> Vec<f64> {
    names.iter().map(|name| trial.get(name)).collect()
}

#[test]
fn rates_in_time_are_the_limit_of_differences() {
    let names: Vec<String> = PROBES
        .into_iter()
        .chain(["plate.heat_in", "plate.heat_stored"])
        .map(String::from)
        .collect();
    let of_level =
        [powered(BOX, GAUSSIAN, ""), powered(ROUND, RING, ""), powered(ROUND, DISC, REDUCED)];
    for text in of_level {
        let mut trial = Trial::new(&text);
        trial.set_derivative("beam.radius", 1, 0.2);
        trial.set_derivative("beam.power", 1, 1e4);
        trial.step(5e-5);
        let (start, h) = (trial.state.clone(), 1e-8);
        trial.step(h);
        let found = trial.rates(&names);
        trial.restart(&start);
        let below = values(&mut trial, &names);
        trial.step(2.0 * h);
        let above = values(&mut trial, &names);
        for (i, wanted) in slopes(&names, [above, below], h).into_iter().enumerate() {
            assert!(off(found[i], wanted) < 1e-3, "{}: {} {wanted}", names[i], found[i]);
        }
        // Power enters at the rate that it has.
        let share = if text.contains("gaussian") { 0.995..1.0 } else { 1.0 - 1e-9..1.0 + 1e-9 };
        let power = POWER + 1e4 * (5e-5 + h);
        assert!(share.contains(&(found[2] / power)), "{} {power}", found[2]);
    }
}

#[test]
fn directional_derivatives_are_the_limit_of_differences_beside_a_power() {
    let text = powered(ROUND, GAUSSIAN, "")
        .replace("[\"power\"]", "[\"power\", \"pressure\"]")
        .replace("power = \"2 W\"", "power = \"2 W\", pressure = \"1 MPa\"")
        .replacen("gives = [\"temperature\"]", "gives = [\"temperature\", \"stress\"]", 1);
    let mut trial = Trial::new(&text);
    trial.step(1e-4);
    let names = ["p.temperature", "p.stress_xx", "p.stress_zz"].map(String::from).to_vec();
    let start = trial.state.clone();
    for (input, step) in [("beam.power", 1e-3), ("beam.radius", 1e-8), ("beam.pressure", 1.0)] {
        let found = trial.changes(&names, &[(input, 1.0)]);
        let differ = [step, -step].map(|by| {
            trial.restart(&start);
            let value = start.inputs[trial.input(input)];
            trial.set(input, value + by);
            values(&mut trial, &names)
        });
        trial.restart(&start);
        // Temperatures, and stresses by them, follow a power with delay; stresses follow a pressure at once.
        let wanted = slopes(&names, differ, step);
        assert_eq!(found[0], 0.0, "{input}");
        assert_eq!(input == "beam.power", found[1] == 0.0, "{input}");
        for i in 0..names.len() {
            let error = (found[i] - wanted[i]).abs();
            let rounding = 1e-2 * if input == "beam.radius" { 1e8 } else { 1e-4 };
            assert!(error < 1e-4 * wanted[i].abs() + rounding, "{input} {} {wanted:?}", found[i]);
        }
    }
}

#[test]
fn implausible_powers_are_warned_of_by_flux() {
    let warned = |power: &str, radius: &str| {
        let text = powered(ROUND, GAUSSIAN, "").replace("\"2 W\"", power);
        let text = text.replace("radius = 1.2e-4", &format!("radius = {radius}"));
        let (_, warnings) = impinge::advice::parse_with_warnings(&text, "scene.toml").unwrap();
        let texts = warnings.iter().map(ToString::to_string);
        texts.filter(|text| text.contains("load[0].start.power")).collect::<Vec<String>>()
    };
    assert_eq!(warned("\"2 W\"", "1.2e-4"), [""; 0]);
    let [message] = &warned("\"2 MW\"", "1e-4")[..] else { panic!("not one warning") };
    assert!(message.contains("makes a heat flux of 1.3e14 W/m²"), "{message}");
    let [message] = &warned("\"200 kW\"", "1e-4")[..] else { panic!("not one warning") };
    assert!(message.contains("would heat the surface"), "{message}");
}

/// A radius that an input makes small focuses the beam.
#[test]
fn powers_are_judged_with_the_current_radius() {
    let parsed = scene::parse(&powered(ROUND, DISC, ""), "scene.toml").unwrap();
    let registry = Registry::of(&parsed);
    let told = |name: &str, [power, radius]: [f64; 2]| {
        let mut trial = Trial::of(parsed.clone());
        trial.set("beam.power", power);
        trial.set("beam.radius", radius);
        let variable = &registry.variables[registry.find(name).unwrap()];
        variable.implausible_among(&parsed, &trial.state.inputs).map(|told| told.to_string())
    };
    assert_eq!(told("beam.power", [1e4, 1e-4]), None);
    assert_eq!(told("beam.radius", [10.0, 1e-6]), None);
    let message = told("beam.radius", [100.0, 1e-6]).unwrap();
    assert!(message.starts_with("beam.radius = 1e-6: a power of 100 W makes"), "{message}");
    assert!(told("beam.power", [1e7, 1e-4]).unwrap().starts_with("beam.power = "));
}
