//! Surface tension of droplets: balances, and motions that it drives.

use std::f64::consts::PI;

use crate::capillary::{
    DENSITY, RADIUS, SphericalCap, TENSION, core_pressure, elongation, elongations, fitted,
    found_half_width, half_width, normal_mode, on_wall, period, plan, stretched, viscosity,
};
use crate::common::Trial;
use impinge::method::sph::{DropletPlan, DropletSph};

/// Samples in a period.
const SAMPLES: f64 = 100.0;

#[test]
fn a_stretched_drop_swings_at_rayleighs_period_under_laplaces_pressure() {
    let (drop, mut state) = stretched(plan(3, 20.0, 1e-3), 1.1);
    let energy = |state: &[f64]| {
        let totals = drop.totals(state);
        totals.kinetic_energy + totals.compression_energy + totals.surface_energy
    };
    let start = energy(&state);
    let plane = 4.0 * PI * RADIUS * RADIUS * TENSION;
    assert!((start / plane - 1.0).abs() < 0.03, "{}", start / plane);
    let mut crossings = Vec::new();
    let mut elongations = vec![elongation(&drop.particles(&state))];
    let mut pressures = Vec::new();
    for step in 1..=135 {
        drop.advance(&mut state, &[], period() / SAMPLES).unwrap();
        let ratio = energy(&state) / start;
        assert!((0.97..1.001).contains(&ratio), "{step}: {ratio}");
        let particles = drop.particles(&state);
        let (before, now) = (elongations[elongations.len() - 1], elongation(&particles));
        if now * before < 0.0 {
            crossings.push((f64::from(step) - now / (now - before)) / SAMPLES);
        }
        elongations.push(now);
        pressures.push(core_pressure(&particles));
    }
    assert!(crossings.len() >= 3, "{crossings:?}");
    let swing = crossings[2] - crossings[0];
    assert!((swing - 1.0).abs() < 0.05, "period over Rayleigh's: {swing}");
    let left = elongations[70..].iter().copied().fold(0.0, f64::max) / elongations[0];
    assert!((0.85..1.0).contains(&left), "amplitude after a swing: {left}");
    let pressure = pressures.iter().sum::<f64>() / pressures.len() as f64;
    assert!((pressure - 1.0).abs() < 0.05, "pressure over Laplace's: {pressure}");
}

#[test]
fn a_swing_dies_away_at_the_rate_of_a_viscous_drop() {
    for ohnesorge in [0.03, 0.1] {
        let plan = plan(3, 18.0, viscosity(ohnesorge));
        let mode = normal_mode(&plan);
        let exact = mode.decay_and_frequency().map(|rate| rate * period());
        let found = fitted(&elongations(plan), exact);
        println!("Oh {ohnesorge}: decay and frequency {found:?}, normal mode {exact:?}");
        assert!((found[0] / exact[0] - 1.0).abs() < 0.1, "{ohnesorge}: {found:?} {exact:?}");
        assert!((found[1] / exact[1] - 1.0).abs() < 0.03, "{ohnesorge}: {found:?} {exact:?}");
    }
}

/// A scene of a free drop of radius 1 mm that names neither a speed of sound nor anything else it can do without.
fn scene(fluid: &str, across: f64, keys: &str) -> String {
    format!(
        r#"
name = "Drop"
stop_time = 1.0
step = 1e-3
[body.drop]
kind = "droplet"
diameter = 2e-3
initial_temperature = 300.0
spacing = {:?}
fluid = {{ {fluid}, specific_heat = 4000.0, conductivity = 0.0 }}
{keys}
"#,
        2e-3 / across
    )
}

/// Seven periods of a drop of water on defaults, 14 particles over its diameter.
fn keeps_its_mass(keys: &str) {
    let fluid = "density = 998.0, viscosity = 1e-3, surface_tension = 0.072";
    let period = 2.0 * PI * (998e-9_f64 / (8.0 * 0.072)).sqrt();
    let mut trial = Trial::new(&scene(fluid, 14.0, keys));
    let start = trial.get("drop.height");
    let speed = -trial.get("drop.momentum_z") / trial.get("drop.mass");
    for step in 1..=7 {
        trial.step(period);
        assert_eq!(trial.get("drop.stray_particles"), 0.0, "{keys} {step}");
        let height = trial.get("drop.height") + speed * period * f64::from(step);
        assert!((height - start).abs() < 0.17e-3, "{keys} {step}: {height} {start}");
    }
    assert_eq!(trial.get("drop.stray_mass"), 0.0);
    assert_eq!(trial.model.closing_warnings(&trial.state), []);
}

#[test]
fn a_drop_at_rest_keeps_its_mass_for_seven_periods() {
    keeps_its_mass("impact_velocity = 0.0");
}

/// At We 2.
#[test]
fn a_drop_in_flight_keeps_its_mass_for_seven_periods() {
    keeps_its_mass("impact_velocity = 0.26859\nheight = 1.0");
}

#[test]
fn fluid_that_comes_off_is_spoken_of() {
    // Eight particles over the diameter make a film of less than one.
    let fluid = "density = 998.0, viscosity = 1e-3, surface_tension = 0.072";
    let wall = "symmetry = \"quarter\"\nimpact_velocity = 1.0\n[[wall]]\nname = \"wall\"\nunder = \"drop\"\n\
                footprint = { rings = { count = 1, radius = 8e-3 } }\nstart = { temperature = 300.0 }";
    let mut trial = Trial::new(&scene(fluid, 8.0, wall));
    trial.step(5e-3);
    let part = trial.get("drop.stray_mass") / trial.get("drop.mass");
    assert!(part > 0.05, "{part}");
    let said = trial.model.closing_warnings(&trial.state);
    assert!(
        said.len() == 1
            && said[0].to_string().contains(&format!("{:.0} % of the fluid", 100.0 * part)),
        "{said:?}"
    );
}

/// A hemisphere becomes the cap that Young's angle asks for and comes to rest.
fn comes_to_rest_as_a_cap(degrees: f64) {
    let cap = SphericalCap::of(PI * degrees / 180.0);
    // It rests in the same form however viscous it is, and sooner the more it is.
    let (drop, mut state) = cap.drop(16.0, 0.1);
    drop.advance(&mut state, &[300.0], 3.0 * period()).unwrap();
    let totals = drop.totals(&state);
    let surface = 4.0 * PI * RADIUS * RADIUS * TENSION;
    assert!(totals.kinetic_energy < 1e-4 * surface, "{degrees}: {:e}", totals.kinetic_energy);
    assert_eq!(totals.stray_mass, 0.0, "{degrees}");
    let [height, radius] = cap.found(&drop.particles(&state));
    println!("{degrees}°: height of the centre {height:.4}, root mean square radius {radius:.4}");
    assert!((height - 1.0).abs() < 0.02, "{degrees}: {height}");
    assert!((radius - 1.0).abs() < 0.01, "{degrees}: {radius}");
}

#[test]
fn a_drop_on_a_wetted_wall_comes_to_rest_as_a_spherical_cap() {
    comes_to_rest_as_a_cap(60.0);
}

#[test]
fn a_drop_on_a_wall_that_it_avoids_comes_to_rest_as_a_spherical_cap() {
    comes_to_rest_as_a_cap(120.0);
}

#[test]
fn surface_tension_gives_a_drop_no_momentum() {
    let whole = DropletPlan { mirrors: [false; 2], ..plan(3, 12.0, 1e-3) };
    let (drop, mut state) = stretched(whole, 1.2);
    drop.advance(&mut state, &[], 0.2 * period()).unwrap();
    let totals = drop.totals(&state);
    let speed = (TENSION / (DENSITY * RADIUS)).sqrt();
    for momentum in totals.momentum {
        assert!(momentum.abs() < 1e-7 * totals.mass * speed, "{momentum:e}");
    }
    assert!(totals.kinetic_energy > 0.0);
}

#[test]
fn a_drop_meets_the_wall_at_its_contact_angle() {
    for degrees in [60.0, 90.0, 120.0] {
        let angle = PI * degrees / 180.0;
        let (drop, mut state) = on_wall(32.0, angle);
        drop.advance(&mut state, &[300.0], 5.0 * period()).unwrap();
        let found = found_half_width(&drop.particles(&state), drop.plan().spacing);
        let asked = half_width(angle);
        // A spacing of particles is 0.06.
        assert!((found - asked).abs() < 0.09, "{degrees}: {found}, {asked}");
    }
}

#[test]
fn what_pulls_a_drop_to_the_wall_pulls_at_the_wall() {
    let (drop, mut state) = on_wall(24.0, PI / 3.0);
    for _ in 0..10 {
        drop.advance(&mut state, &[300.0], 0.02 * period()).unwrap();
        let totals = drop.totals(&state);
        let speed = (TENSION / (DENSITY * RADIUS)).sqrt();
        let balance = totals.momentum[2] + totals.impulse_to_wall[2];
        assert!(balance.abs() < 1e-6 * totals.mass * speed, "{balance:e}");
        assert!(totals.momentum[2].abs() > 1e-4 * totals.mass * speed);
    }
}

#[test]
fn tension_that_acts_every_few_steps_drives_the_same_swing() {
    // Sound is so fast that a step is short beside capillary waves.
    let mut plan = plan(3, 12.0, 1e-3);
    plan.fluid.sound_speed *= 4.0;
    let step = 0.9 * DropletSph::forecast(&plan).1;
    let (drop, start) = stretched(plan, 1.1);
    const STEPS: usize = 400;
    let (mut at_once, mut one_by_one) = (start.clone(), start.clone());
    drop.advance(&mut at_once, &[], STEPS as f64 * step).unwrap();
    for _ in 0..STEPS {
        drop.advance(&mut one_by_one, &[], step).unwrap();
    }
    assert_eq!(drop.totals(&one_by_one).steps, STEPS as f64);
    assert_ne!(at_once, one_by_one);
    let [before, rare, often] =
        [&start, &at_once, &one_by_one].map(|state| elongation(&drop.particles(state)));
    let energy = |state: &[f64]| {
        let totals = drop.totals(state);
        totals.kinetic_energy + totals.compression_energy + totals.surface_energy
    };
    assert!((often - before).abs() > 0.1 * before, "the drop moved: {before} {often}");
    assert!((rare - often).abs() < 0.01 * (often - before).abs(), "{before} {rare} {often}");
    let lost = [&at_once, &one_by_one].map(|state| 1.0 - energy(state) / energy(&start));
    assert!((lost[0] - lost[1]).abs() < 2e-4, "{lost:?}");
}
