//! Drops whose pressure is solved with viscosity at the end of steps, beside those that solve viscosity alone.

use crate::common::Trial;

/// A drop of glycerol that comes to rest on a cold wall: ν = 1e-3 m²/s, Re 0.8.
fn scene(keys: &str) -> String {
    format!(
        r#"name = "Thick"
stop_time = 0.02
step = 1e-3
[body.drop]
kind = "droplet"
diameter = 2e-3
impact_velocity = 0.4
initial_temperature = 350.0
gravity = 9.81
spacing = 2e-4
{keys}
fluid = {{ density = 1260.0, viscosity = 1.26, specific_heat = 2400.0, conductivity = 0.29, surface_tension = 0.063 }}
[[wall]]
name = "wall"
under = "drop"
footprint = {{ rings = {{ count = 8, radius = 4e-3 }} }}
start = {{ temperature = 300.0 }}
"#
    )
}

#[test]
fn thick_drops_spread_alike_in_fewer_steps() {
    let run = |keys: &str| {
        let mut trial = Trial::new(&scene(keys));
        (0..20).for_each(|_| trial.step(1e-3));
        trial
    };
    let mut sound = run("viscous = \"implicit\"");
    let mut solved = run("pressure = \"implicit\"");
    let both = |trial: [&mut Trial; 2], name: &str| trial.map(|trial| trial.get(name));
    let mut pair = |name: &str| both([&mut sound, &mut solved], name);
    let [slow, quick] = pair("drop.steps");
    assert!(quick < 0.05 * slow, "{quick} steps for {slow}");
    let close = |[a, b]: [f64; 2], part: f64| assert!((b / a - 1.0).abs() < part, "{a} {b}");
    close(pair("drop.mass"), 1e-12);
    close(pair("drop.height"), 0.05);
    close(pair("drop.spread_diameter"), 0.08);
    close(pair("drop.heat"), 0.15);
    // Weight and momentum arrive at the wall.
    close(pair("drop.impulse_z"), 5e-3);
    let [_, heat] = pair("drop.heat");
    let [_, drift] = pair("drop.heat_drift");
    assert!(drift.abs() < 1e-9 * heat, "{drift} of {heat}");
    let [low, high] = [pair("drop.min_density"), pair("drop.max_density")].map(|pair| pair[1]);
    assert!(low > 0.99 * 1260.0 && high < 1.01 * 1260.0, "{low} to {high}");
    assert!(solved.get("drop.pressure_iterations") < 60.0);
}

#[test]
fn a_saved_state_of_solved_pressure_goes_on_to_the_bit_on_any_threads() {
    let text = scene("pressure = \"implicit\"");
    let mut whole = Trial::on_threads(&text, 1);
    (0..4).for_each(|_| whole.step(1e-3));
    let half = whole.state.clone();
    (0..4).for_each(|_| whole.step(1e-3));
    let mut other = Trial::on_threads(&text, 2);
    other.restart(&half);
    (0..4).for_each(|_| other.step(1e-3));
    assert!(whole.state == other.state);
}

/// A drop that is let go above a wall falls freely in steps that its speed allows, however long a step of communication
/// is.
#[test]
fn drops_that_are_let_go_fall_freely() {
    let text = scene("pressure = \"implicit\"\nheight = 2e-3")
        .replace("impact_velocity = 0.4", "impact_velocity = 0.0")
        .replace("surface_tension = 0.063", "surface_tension = 0.0");
    let mut trial = Trial::new(&text);
    trial.step(0.015);
    let [mass, momentum] = ["mass", "momentum_z"].map(|key| trial.get(&format!("drop.{key}")));
    assert!((momentum / (-mass * 9.81 * 0.015) - 1.0).abs() < 1e-6, "{momentum}");
    trial.step(0.1);
    let weight = mass * 9.81;
    assert!((trial.get("drop.force") * 0.1 / (weight * 0.115) - 1.0).abs() < 0.02);
}
