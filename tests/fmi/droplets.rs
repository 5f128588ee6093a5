//! States and derivatives of inputs of units with droplets.

use crate::master::{DISCARD, ERROR, OK, Unit, WARNING};

/// Two drops, the second released after 0.4 µs, above a wall of tiles whose temperatures are inputs.
pub const WALL: &str = r#"
name = "Drops"
stop_time = 2e-6
step = 1e-7
[body.drop]
kind = "droplet"
diameter = 6e-5
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
arrivals = [{ time = 0.0 }, { time = 4e-7, x = 8e-5 }]
[[wall]]
name = "wall"
under = "drop"
footprint = { tiles = { count = [2, 2], size = [2.4e-4, 2e-4] } }
start = { temperature = 300.0 }
"#;

/// A drop on a plate that a spot heats.
pub const PLATE: &str = r#"
name = "DropOnPlate"
stop_time = 2e-6
step = 1e-7
[body.drop]
kind = "droplet"
diameter = 6e-5
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
[body.plate]
kind = "solid"
shape = { box = [3e-4, 3e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 300.0
mesh = { spacing = 2e-5, depth_spacing = 2e-5, order = 1 }
[body.plate.faces]
sides = { clamped = true }
[[coupling]]
from = "drop"
to = "plate.top"
interval = 5e-8
[[load]]
name = "spot"
on = "plate.top"
footprint = { disc = { radius = 4e-5 } }
carries = ["heat_flux"]
[[probe]]
name = "centre"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature", "stress"]
"#;

const STEP: f64 = 1e-7;

pub fn started(scene: &str) -> Unit {
    let unit = Unit::of_scene(scene);
    assert_eq!(unit.setup(0.0, None), OK);
    assert_eq!(unit.enter(), OK);
    assert_eq!(unit.exit(), OK, "{:?}", unit.messages.take());
    unit.messages.take();
    unit
}

/// Warnings of a drop above narrow rings whose temperatures, constant over a step, are then set to the response of a
/// half space of an effusivity to the flux of that step.
fn told_of_an_answer(effusivity: f64) -> Vec<String> {
    let rings = WALL
        .replace(
            "tiles = { count = [2, 2], size = [2.4e-4, 2e-4] }",
            "rings = { count = 4, radius = 4e-5 }",
        )
        .replace("arrivals = [{ time = 0.0 }, { time = 4e-7, x = 8e-5 }]\n", "");
    let unit = started(&rings);
    let cells: Vec<_> = (1..=4).map(|n| format!("wall.heat_flux[{n}]")).collect();
    for _ in 0..20 {
        assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
        let rises = cells
            .iter()
            .map(|name| 2.0 * unit.get(name) * (STEP / std::f64::consts::PI).sqrt() / effusivity);
        let rises: Vec<f64> = rises.collect();
        if rises.iter().any(|&rise| rise > 0.0) {
            for (n, rise) in (1..).zip(rises) {
                assert_eq!(unit.set(&format!("wall.temperature[{n}]"), 300.0 + rise), OK);
            }
            unit.messages.take();
            assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
            break;
        }
    }
    let messages = unit.messages.take().into_iter();
    messages.filter(|message| message.status == WARNING).map(|message| message.text).collect()
}

#[test]
fn a_held_wall_that_answers_is_told_of_with_its_effusivity() {
    let said = told_of_an_answer(600.0);
    assert!(said.len() == 1, "{said:?}");
    let number = said[0].split("effusivity = ").nth(1).and_then(|rest| rest.split('`').next());
    let found: f64 = number.unwrap().parse().unwrap();
    assert!((found / 600.0 - 1.0).abs() < 0.02, "{said:?}");
    assert_eq!(told_of_an_answer(37_000.0), [""; 0]);
}

#[test]
fn heights_of_a_few_particles_are_told_of_once() {
    let unit = started(WALL);
    let heard = || unit.messages.take().into_iter().filter(|m| m.text.starts_with("drop.height: "));
    assert!(unit.get("drop.height") > 3e-5 && heard().count() == 0);
    // Long after both drops have come down.
    assert_eq!(unit.step(0.0, 6e-6), OK, "{:?}", unit.messages.take());
    assert_eq!(heard().count(), 0, "nobody has read it");
    assert!(unit.get("drop.height") < 3e-5, "{}", unit.get("drop.height"));
    assert_eq!(heard().count(), 1);
}

/// Steps of different lengths under an input that changes; what is seen after each.
fn go_on(unit: &Unit, input: &str, value: f64) -> Vec<(Vec<u64>, i32, String)> {
    let steps = [STEP, 0.3 * STEP, 2.5 * STEP];
    let seen = steps.iter().enumerate().map(|(i, step)| {
        assert_eq!(unit.set(input, value * (1.0 + 0.1 * i as f64)), OK);
        assert_eq!(unit.set_derivative(input, 1, value / STEP), OK);
        assert_eq!(unit.step(unit.time(), *step), OK, "{:?}", unit.messages.take());
        unit.snapshot()
    });
    seen.collect()
}

fn repeats_to_the_bit(scene: &str, input: &str, value: f64) {
    go_on_from(started(scene), scene, input, value);
}

fn go_on_from(unit: Unit, scene: &str, input: &str, value: f64) {
    for _ in 0..3 {
        assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
    }
    let state = unit.save();
    let bytes = unit.serialize(state);
    let first = go_on(&unit, input, value);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(go_on(&unit, input, value), first, "in the same instance");
    assert_eq!(unit.reset(), OK);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(go_on(&unit, input, value), first, "after a reset");
    let other = Unit::of_scene(scene);
    assert_eq!(other.setup(0.0, None), OK);
    assert_eq!(other.set_threads(2), OK);
    assert_eq!(other.restore(other.deserialize(&bytes)), OK, "{:?}", other.messages.take());
    assert_eq!(go_on(&other, input, value), first, "in another instance");
}

/// The second drop is released only after the state was saved.
#[test]
fn drops_above_a_wall_go_on_from_a_state_to_the_bit() {
    repeats_to_the_bit(WALL, "wall.temperature[1,1]", 310.0);
}

/// A gel that touches a wall from the first step on.
const GEL: &str = r#"
name = "Gel"
stop_time = 2e-6
step = 1e-7
[body.gel]
kind = "solid"
strain = "finite"
inertia = true
shape = { disc = { radius = 2e-4, thickness = 1e-4 } }
mesh = { spacing = 2e-5 }
friction = 0.3
initial_temperature = 350.0
start = { velocity = [0.0, 0.0, -1.0] }
material = { model = "neo_hookean", density = 1000.0, specific_heat = 4180.0, conductivity = 0.6, young = 2e4, poisson = 0.4 }
[[wall]]
name = "wall"
under = "gel"
footprint = { rings = { count = 3, radius = 1.5e-4 } }
conductance = 1e4
start = { temperature = 300.0 }
"#;

#[test]
fn a_gel_on_a_wall_goes_on_from_a_state_to_the_bit() {
    let unit = started(GEL);
    assert_eq!(unit.step(0.0, STEP), OK);
    for touched in ["wall.pressure[1]", "wall.heat_flux[2]", "wall.force_outside"] {
        assert!(unit.get(touched) > 0.0, "{touched}");
    }
    repeats_to_the_bit(GEL, "wall.temperature[2]", 310.0);
}

/// Up to four drops that inputs release above the same wall.
pub fn on_demand() -> String {
    let arrivals = "arrivals = [{ time = 0.0 }, { time = 4e-7, x = 8e-5 }]";
    assert!(WALL.contains(arrivals));
    WALL.replace(arrivals, "release = \"input\"\nmost = 4\nheight = 1e-5")
}

#[test]
fn drops_that_wait_go_on_from_a_state_to_the_bit() {
    let scene = on_demand();
    let unit = started(&scene);
    for (name, value) in [("release", 3.0), ("x", 2e-5), ("temperature", 361.0)] {
        assert_eq!(unit.set(&format!("drop.{name}"), value), OK);
    }
    assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
    assert_eq!(["drop.released", "drop.waiting"].map(|name| unit.get(name)), [1.0, 2.0]);
    go_on_from(unit, &scene, "wall.temperature[1,1]", 310.0);
}

#[test]
fn drops_that_cannot_be_are_refused_and_change_nothing() {
    let unit = started(&on_demand());
    assert_eq!(unit.set("drop.release", 2.0), OK);
    assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
    for (name, value, words) in [
        ("drop.release", 1.0, "drop.release: 1 drops, where 2 have been asked for"),
        ("drop.release", 2.5, "drop.release: 2.5 is no number of drops"),
        ("drop.speed", 1e3, "drop.speed: a drop at 1000 m/s"),
    ] {
        let state = unit.save();
        let before = unit.get(name);
        unit.messages.take();
        assert_eq!(unit.set(name, value), OK);
        assert_eq!(unit.step(unit.time(), STEP), ERROR, "{name} = {value}");
        unit.expect_message(ERROR, &[words]);
        assert_eq!(unit.restore(state), OK);
        assert_eq!(unit.set(name, before), OK);
    }
    for (name, value) in [
        ("drop.release", 5.0),
        ("drop.release", -1.0),
        ("drop.speed", -1.0),
        ("drop.temperature", 0.0),
        ("drop.temperature", -1.0),
    ] {
        assert_eq!(unit.set(name, value), ERROR, "{name}");
        unit.expect_message(ERROR, &[name]);
    }
    assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
    // A count that is interpolated is none.
    assert_eq!(unit.set_derivative("drop.release", 1, 1.0 / STEP), OK);
    assert_eq!(unit.step(unit.time(), STEP), ERROR);
    unit.expect_message(ERROR, &["drop.release: a count has no time derivative"]);
}

#[test]
fn a_drop_on_a_plate_goes_on_from_a_state_to_the_bit() {
    repeats_to_the_bit(PLATE, "spot.heat_flux", 1e8);
}

/// One step over which the wall warms transfers the heat of eight short ones. Afterwards the input has its final value.
#[test]
fn droplet_on_a_warming_wall() {
    let (wall, parts, rise) = ("wall.temperature[1,1]", 8, 20.0);
    let slope = rise / (f64::from(parts) * STEP);
    let [whole, cut, held] = [(); 3].map(|()| started(WALL));
    for unit in [&whole, &cut, &held] {
        // The drop touches the wall first.
        (0..6).for_each(|_| assert_eq!(unit.step(unit.time(), STEP), OK));
    }
    let before = whole.get("drop.heat");
    assert_eq!(whole.set_derivative(wall, 1, slope), OK);
    for unit in [&whole, &held] {
        assert_eq!(unit.step(unit.time(), f64::from(parts) * STEP), OK);
    }
    for part in 0..parts {
        assert_eq!(cut.set(wall, 300.0 + slope * STEP * f64::from(part)), OK);
        assert_eq!(cut.set_derivative(wall, 1, slope), OK);
        assert_eq!(cut.step(cut.time(), STEP), OK);
    }
    let [whole_heat, cut_heat, held_heat] =
        [&whole, &cut, &held].map(|unit| unit.get("drop.heat") - before);
    let effect = (cut_heat - held_heat).abs();
    assert!((whole_heat - cut_heat).abs() < 0.05 * effect, "{whole_heat} {cut_heat} {held_heat}");
    let bend = slope / STEP;
    assert_eq!(whole.set_derivative(wall, 2, bend), OK);
    assert_eq!(whole.step(whole.time(), STEP), OK, "{:?}", whole.messages.take());
    let end = 300.0 + rise + 0.5 * bend * STEP * STEP;
    assert!((whole.get(wall) - end).abs() < 1e-9 * end, "{}", whole.get(wall));
}

#[test]
fn a_wall_that_would_cool_below_absolute_zero_is_discarded_and_may_be_repeated() {
    let unit = started(WALL);
    let state = unit.save();
    assert_eq!(unit.set_derivative("wall.temperature[2,1]", 1, -4e9), OK);
    assert_eq!(unit.step(0.0, STEP), DISCARD);
    unit.expect_message(DISCARD, &["wall.temperature[2,1]", "must be above 0"]);
    assert_eq!(unit.time(), 0.0);
    assert_eq!(unit.restore(state), OK);
    // It is as warm at the end as at the beginning, but not between them.
    let slope = -4.0 * 400.0 / STEP;
    assert_eq!(unit.set_derivative("wall.temperature[2,1]", 1, slope), OK);
    assert_eq!(unit.set_derivative("wall.temperature[2,1]", 2, -2.0 * slope / STEP), OK);
    assert_eq!(unit.step(0.0, STEP), DISCARD);
    unit.expect_message(DISCARD, &["wall.temperature[2,1]", "must be above 0"]);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.step(0.0, STEP), OK, "{:?}", unit.messages.take());
}

#[test]
fn fluid_that_would_boil_is_warned_of_once_and_leaves_states_alone() {
    let watched = WALL.replace("conductivity = 0.6", "conductivity = 0.6, boils_at = 351.0");
    let run = |text: &str| {
        let unit = started(text);
        let cells = ["[1,1]", "[1,2]", "[2,1]", "[2,2]"];
        let said = |unit: &Unit| {
            let messages = unit.messages.take();
            let boils =
                |text: &str| text.contains("above the 351 K at which it boils (`boils_at`)");
            messages.iter().filter(|m| m.status == WARNING && boils(&m.text)).count()
        };
        assert_eq!(unit.step(0.0, STEP), OK);
        assert_eq!(said(&unit), 0, "the wall is colder than the fluid");
        for cell in cells {
            assert_eq!(unit.set(&format!("wall.temperature{cell}"), 900.0), OK);
        }
        let saved = unit.save();
        let mut counts = Vec::new();
        for n in 1..12 {
            assert_eq!(unit.step(f64::from(n) * STEP, STEP), OK);
            counts.push(said(&unit));
        }
        let end = unit.snapshot();
        // A step that is repeated says nothing again.
        assert_eq!(unit.restore(saved), OK);
        for n in 1..12 {
            assert_eq!(unit.step(f64::from(n) * STEP, STEP), OK);
            assert_eq!(said(&unit), 0);
        }
        assert_eq!(unit.snapshot(), end);
        (counts.iter().sum::<usize>(), end)
    };
    let ((warned, watched), (silent, plain)) = (run(&watched), run(WALL));
    assert_eq!([warned, silent], [1, 0]);
    assert_eq!(watched, plain);
}

/// The plate below strands.
const BED: &str = r#"
[body.plate]
kind = "solid"
shape = { box = [3e-4, 3e-4, 1e-4] }
material = { model = "thermoelastic", density = 2500.0, specific_heat = 800.0, conductivity = 1.0, young = 7e10, poisson = 0.2, expansion = 9e-6 }
initial_temperature = 293.15
mesh = { spacing = 2e-5, depth_spacing = 2e-5, order = 1 }
faces = { bottom = { clamped = true } }
[[coupling]]
from = "ink"
to = "plate.top"
"#;

/// A strand of a fluid that freezes, above [`BED`].
const STRAND: &str = r#"
name = "Strand"
stop_time = 2e-6
step = 1e-7
[body.ink]
kind = "filament"
fluid = { density = 780.0, viscosity = 4e-3, specific_heat = 2200.0, conductivity = 0.15, melting = { solidus = 309.0, liquidus = 310.0, latent_heat = 247e3 } }
nozzle = { diameter = 2e-5, height = 1.5e-5, temperature = 343.0, flow = 1e-8 }
path = { time = [0.0, 2e-6, 4e-6], x = [-1e-4, 0.0, 0.0], y = [0.0, 0.0, 1e-4] }
most = 1e-12
convection = { coefficient = 20.0, ambient = 293.15 }
[[target]]
of = "ink"
line = [[-1e-4, 0.0], [0.0, 0.0], [0.0, 1e-4]]
"#;

fn on_plate(strand: &str) -> String {
    format!("{strand}{BED}")
}

#[test]
fn strands_go_on_from_a_state_to_the_bit() {
    repeats_to_the_bit(&on_plate(STRAND), "ink.flow", 1e-8);
}

#[test]
fn strands_that_cannot_be_laid_are_refused_and_change_nothing() {
    let unit = started(&on_plate(STRAND));
    for _ in 0..3 {
        assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
    }
    assert_eq!(unit.set("ink.flow", -1e-9), ERROR);
    unit.expect_message(ERROR, &["ink.flow"]);
    for (flow, rate, words) in [(1.0, 0.0, "more than `most`"), (1e-8, -1.0, "must be at least 0")]
    {
        let (before, state) = (unit.snapshot(), unit.save());
        assert_eq!(unit.set("ink.flow", flow), OK);
        assert_eq!(unit.set_derivative("ink.flow", 1, rate), OK);
        unit.messages.take();
        assert_eq!(unit.step(unit.time(), STEP), DISCARD);
        unit.expect_message(DISCARD, &[words]);
        assert_eq!(unit.restore(state), OK);
        assert_eq!(unit.snapshot().0, before.0);
    }
}

/// A strand of particles, four across the nozzle, of a fluid that conducts heat, above [`BED`].
const WARM_PARTICLES: &str = r#"
name = "Strand"
stop_time = 2e-6
step = 1e-7
[body.ink]
kind = "filament"
method = "particles"
fluid = { density = 1000.0, viscosity = 0.05, specific_heat = 2000.0, conductivity = 0.2 }
nozzle = { diameter = 2e-5, height = 1.5e-5, temperature = 340.0, flow = 2e-9 }
path = { time = [0.0, 2e-6, 4e-6], x = [-1e-5, 0.0, 0.0], y = [0.0, 0.0, 1e-5] }
most = 1e-13
spacing = 5e-6
[[target]]
of = "ink"
line = [[-1e-5, 0.0], [0.0, 0.0], [0.0, 1e-5]]
"#;

/// A strand of a paste, above a plane, whose nozzle inputs move.
const RESTING_PARTICLES: &str = r#"
name = "Strand"
stop_time = 2e-6
step = 1e-7
[body.ink]
kind = "filament"
method = "particles"
fluid = { density = 1000.0, viscosity = { law = "bingham", yield_stress = 1e5, plastic_viscosity = 0.05 }, specific_heat = 2000.0, conductivity = 0.0 }
nozzle = { diameter = 2e-5, height = 2e-5, temperature = 293.15, flow = 1.5e-9 }
path = "input"
most = 2e-13
spacing = 5e-6
"#;

#[test]
fn strands_of_particles_go_on_from_a_state_to_the_bit() {
    repeats_to_the_bit(&on_plate(WARM_PARTICLES), "ink.nozzle_temperature", 340.0);
}

/// Moves the nozzle by some diameters, so that what it laid first rests.
pub fn strand_at_rest() -> Unit {
    let unit = started(RESTING_PARTICLES);
    for _ in 0..30 {
        assert_eq!(unit.set_derivative("ink.nozzle_x", 1, 5.0), OK);
        assert_eq!(unit.step(unit.time(), 1e-6), OK, "{:?}", unit.messages.take());
    }
    let [resting, particles] = ["ink.resting", "ink.particles"].map(|name| unit.get(name));
    assert!(resting > 0.0 && resting < particles, "{resting} of {particles}");
    unit
}

/// States hold which particles rest, and these are woken alike.
#[test]
fn strands_at_rest_go_on_from_a_state_to_the_bit() {
    go_on_from(strand_at_rest(), RESTING_PARTICLES, "ink.nozzle_temperature", 293.15);
}

/// A step that cannot be taken leaves the state as it was, and the next goes on from there.
#[test]
fn strands_of_particles_that_cannot_be_laid_are_refused_and_change_nothing() {
    let unit = started(RESTING_PARTICLES);
    for _ in 0..3 {
        assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
    }
    for (name, value, words) in
        [("ink.flow", 1.0, "more than `most`"), ("ink.nozzle_z", 1e-6, "above the plate")]
    {
        let (before, state) = (unit.snapshot(), unit.save());
        let usual = unit.get(name);
        assert_eq!(unit.set(name, value), OK);
        unit.messages.take();
        assert_eq!(unit.step(unit.time(), STEP), DISCARD, "{name}");
        unit.expect_message(DISCARD, &[words]);
        assert_eq!(unit.restore(state), OK);
        assert_eq!(unit.set(name, usual), OK);
        assert_eq!(unit.snapshot().0, before.0);
    }
    assert_eq!(unit.step(unit.time(), STEP), OK, "{:?}", unit.messages.take());
}

/// A notched beam of concrete that breaks.
const BEAM: &str = r#"
name = "Beam"
stop_time = 2e-6
step = 1e-7
[body.beam]
kind = "lattice"
length = 0.2
depth = 0.06
thickness = 0.1
spacing = 7.5e-3
notch = { depth = 0.02 }
support = { three_point = { span = 0.18 } }
control = "opening"
material = { density = 2300.0, young = 30e9, poisson = 0.2, softening = { model = "openings", strength = 4e6, openings = [1e-5, 2e-4], share = 0.15 } }
"#;

#[test]
fn breaking_beams_go_on_from_a_state_to_the_bit() {
    let unit = started(BEAM);
    assert_eq!(unit.set("beam.opening", 2.5e-5), OK);
    go_on_from(unit, BEAM, "beam.opening", 8e-5);
}
