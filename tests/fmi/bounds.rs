//! Values of inputs and lengths of steps beyond those of scenes: refused with what is allowed, and nothing is changed.

use crate::droplets::WALL;
use crate::master::three::Unit as Unit3;
use crate::master::{ERROR, Handle, OK, SCENE, Unit, call};

/// Scene, input, value, side.
const BEYOND: [(&str, &str, f64, &str); 22] = [
    (SCENE, "spot.heat_flux", 1e308, "at most 1e60"),
    (SCENE, "spot.heat_flux", -1.1e60, "at least -1e60"),
    (SCENE, "patch.heat_flux[1,3]", 1e61, "at most 1e60"),
    (SCENE, "spot.pressure", 1.7e308, "at most 1e60"),
    (SCENE, "spot.shear_x", -1e61, "at least -1e60"),
    (SCENE, "spot.x", 2e-4, "at most 1e-4"),
    (SCENE, "spot.radius", 1e-5, "at least 2e-5"),
    (SCENE, "patch.x", 1e300, "at most 1e6"),
    (SCENE, "patch.y", -2e6, "at least -1e6"),
    (SCENE, "plate.bottom.ambient", 1e12, "at most 1e9"),
    (SCENE, "plate.bottom.ambient", 0.0, "above 0"),
    (SCENE, "plate.bottom.ambient", -20.0, "above 0"),
    (WALL, "wall.temperature[1,1]", 1e12, "at most 1e9"),
    (WALL, "wall.temperature[2,2]", -273.15, "above 0"),
    (DEMAND, "drop.x", 2e3, "at most 1000"),
    (DEMAND, "drop.y", -2e3, "at least -1000"),
    (DEMAND, "drop.speed", 2e5, "at most 100000"),
    (DEMAND, "drop.speed", -1.0, "at least 0"),
    (DEMAND, "drop.temperature", 2e9, "at most 1e9"),
    (DEMAND, "drop.temperature", 0.0, "above 0"),
    (DEMAND, "drop.release", 4.0, "at most 3"),
    (DEMAND, "drop.direction", 7.0, "at most 6.28319"),
];

const DEMAND: &str = r#"
name = "Demand"
stop_time = 2e-6
step = 1e-7
[body.drop]
kind = "droplet"
diameter = 6e-5
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
release = "input"
most = 3
[[wall]]
name = "wall"
under = "drop"
footprint = { tiles = { count = [2, 2], size = [2.4e-4, 2e-4] } }
start = { temperature = 300.0 }
"#;

#[test]
fn inputs_beyond_what_scenes_allow_are_refused_and_change_nothing() {
    for text in [SCENE, WALL, DEMAND] {
        let unit = crate::droplets::started(text);
        let before = unit.snapshot();
        for (_, name, value, side) in BEYOND.iter().filter(|(scene, ..)| *scene == text) {
            assert_eq!(unit.set(name, *value), ERROR, "{name} = {value}");
            let said = [&format!("{name} = {value:?}: must be {side}"), "(allowed: "];
            unit.expect_message(ERROR, &said.map(|words| words as &str));
            assert_eq!(unit.snapshot(), before, "{name} = {value}");
        }
        assert_eq!(unit.step(0.0, 1e-8), OK, "{:?}", unit.messages.take());
    }
}

#[test]
fn one_value_beyond_refuses_all_of_a_call() {
    let unit = Unit::running();
    let names = ["spot.heat_flux", "spot.pressure", "plate.bottom.ambient"];
    let references = names.map(|name| unit.reference(name));
    let before = unit.snapshot();
    assert_eq!(unit.set_all(&references, &[1e6, 1e5, 1e10]), ERROR);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(unit.set_all(&references, &[1e6, 1e5, 1e9]), OK);
}

#[test]
fn values_at_the_ends_of_their_bounds_are_taken() {
    let unit = Unit::running();
    for (name, value) in [
        ("spot.heat_flux", 1e60),
        ("spot.pressure", -1e60),
        ("plate.bottom.ambient", 1e9),
        ("plate.bottom.ambient", 5e-324),
        ("spot.x", 1e-4),
    ] {
        assert_eq!(unit.set(name, value), OK, "{name}");
        assert_eq!(unit.get(name).to_bits(), value.to_bits());
    }
}

#[test]
fn fmi_3_refuses_the_same_values_and_steps() {
    let unit = Unit3::running();
    let before = unit.snapshot();
    for (name, value, side) in [
        ("spot.heat_flux", 1e308, "at most 1e60"),
        ("plate.bottom.ambient", 1e12, "at most 1e9"),
        ("plate.bottom.ambient", -1.0, "above 0"),
        ("spot.radius", 1.0, "at most 9e-5"),
    ] {
        assert_eq!(unit.set(name, &[value]), ERROR, "{name}");
        unit.expect_message(ERROR, &[name, side]);
    }
    for step in [1.1e60, 1e304, 1.7e308, 1e-61] {
        assert_eq!(unit.step(0.0, step).0, ERROR, "{step}");
        unit.expect_message(ERROR, &["step size", "allowed: 1e-60 to 1e60 s"]);
        assert_eq!(unit.snapshot(), before);
    }
    assert_eq!(unit.step(0.0, 1e-8).0, OK);
}

/// The steady state of the whole unit, up to the longest step; longer ones are refused.
#[test]
fn the_steady_state_does_not_depend_on_how_long_a_step_is() {
    let mut found = Vec::new();
    for step in [1e12, 1e30, 1e60] {
        let unit = Unit::running();
        assert_eq!(unit.step(0.0, step), OK, "{:?}", unit.messages.take());
        found.push(unit.get("centre.temperature"));
        assert_eq!(unit.time(), step);
    }
    assert!(found.iter().all(|t| (t / found[0] - 1.0).abs() < 1e-9), "{found:?}");
    let unit = Unit::running();
    let before = unit.snapshot();
    for step in [1.1e60, 1e304, 1e306, f64::MAX, 1e-61, 5e-324] {
        assert_eq!(unit.step(0.0, step), ERROR, "{step}");
        unit.expect_message(ERROR, &["fmi2DoStep", "step size", "allowed: 1e-60 to 1e60 s"]);
        assert_eq!((unit.snapshot(), unit.time()), (before.clone(), 0.0));
    }
    assert_eq!(unit.step(0.0, 1e-8), OK);
}

#[test]
fn a_time_beyond_which_no_step_is_resolved_ends_the_run() {
    let unit = Unit::instantiated();
    assert_eq!([unit.setup(1.7e308, None), unit.enter(), unit.exit()], [OK; 3]);
    unit.messages.take();
    assert_eq!(unit.step(1.7e308, 1e60), ERROR);
    unit.expect_message(ERROR, &["is lost in rounding"]);
    assert_eq!(unit.time(), 1.7e308);
}

/// Counts whose bytes wrap are no counts of anything.
#[test]
fn counts_beyond_any_memory_are_refused() {
    let unit = crate::droplets::started(SCENE);
    let (reference, mut value) = (unit.reference("spot.heat_flux"), 7.0);
    for count in [1_usize << 61, (1 << 62) + 1, 1 << 63, usize::MAX] {
        let read = call!("fmi2GetReal", unit.handle => Handle, &raw const reference => *const u32,
            count => usize, &raw mut value => *mut f64);
        assert_eq!((read, value), (ERROR, 7.0), "{count}");
        let set = call!("fmi2SetReal", unit.handle => Handle, &raw const reference => *const u32,
            count => usize, &raw const value => *const f64);
        assert_eq!(set, ERROR, "{count}");
    }
    for message in unit.messages.take() {
        assert!(message.text.contains("more than fit any memory"), "{message:?}");
    }
}
