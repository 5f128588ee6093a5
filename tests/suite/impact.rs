//! Droplets in scenes: what leaves the fluid arrives, and a step is a function of the state.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::model::{BodyError, Cache, Model, ModelError};
use impinge::scene;

/// A coarse drop that falls at 20 m/s, with further keys.
fn drop(keys: &str) -> String {
    format!(
        r#"
name = "Drop"
stop_time = 4e-6
step = 1e-7
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
fluid = {{ density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }}
{keys}
"#
    )
}

fn wall(footprint: &str) -> String {
    format!(
        "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ {footprint} }}\nstart = {{ \
         temperature = 300.0 }}\n"
    )
}

const RINGS: &str = "rings = { count = 4, radius = 1.2e-4 }";
const BOX: &str = "box = [1e-3, 1e-3, 1e-4]";
const DISC: &str = "disc = { radius = 5e-4, thickness = 1e-4 }";
const QUARTER: &str = "symmetry = \"quarter\"";
const ROUND: &str = "symmetry = \"axisymmetric\"";

/// A plate below the drop, which is coupled with further keys.
fn plate(shape: &str, symmetry: &str, conductivity: f64, coupling: &str) -> String {
    format!(
        r#"
[body.plate]
kind = "solid"
shape = {{ {shape} }}
material = {{ model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = {conductivity:?}, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }}
initial_temperature = 300.0
symmetry = "{symmetry}"
mesh = {{ spacing = 2e-5, depth_spacing = 1e-6, growth = 2.0, order = 1 }}
faces = {{ bottom = {{ clamped = true }} }}
[[coupling]]
from = "drop"
to = "plate.top"
{coupling}
"#
    )
}

fn probe(x: f64) -> String {
    format!(
        "[[probe]]\nname = \"spot\"\nin = \"plate\"\nat = [{x:?}, 0.0, 0.0]\ngives = \
         [\"temperature\", \"stress\", \"displacement\"]\n"
    )
}

fn steps(trial: &mut Trial, count: usize, dt: f64) {
    (0..count).for_each(|_| trial.step(dt));
}

#[test]
fn all_heat_that_leaves_the_drop_enters_the_plate() {
    let aside = "arrivals = [{ x = 1.1e-4, y = -0.7e-4 }]";
    for (keys, shape, symmetry) in [
        ("", BOX, "auto"),
        (aside, BOX, "auto"),
        (aside, BOX, "none"),
        (QUARTER, DISC, "auto"),
        (ROUND, DISC, "auto"),
        (ROUND, BOX, "auto"),
        (ROUND, BOX, "none"),
    ] {
        let text = drop(keys) + &plate(shape, symmetry, 10.0, "traction = false");
        let mut trial = Trial::new(&text);
        steps(&mut trial, 20, 1e-7);
        let [given, taken] = ["drop.heat", "plate.heat_in"].map(|name| trial.get(name));
        assert!(given > 1e-9, "{shape} {symmetry}: {given} J");
        assert!(off(taken, given) < 1e-12, "{shape} {symmetry}: {given} J become {taken} J");
        assert!(off(-trial.get("drop.heat_stored"), given) < 1e-6);
        // Of 4180 J/(kg K), from 350 K.
        let cooled = given / (trial.get("drop.mass") * 4180.0);
        assert!(off(350.0 - trial.get("drop.mean_temperature"), cooled) < 1e-6);
        assert!(trial.heat_residual("plate") < 1e-9);
    }
}

/// A film that runs over the edge of its plate gives no heat there, and a force apart, and says so.
#[test]
fn what_lies_beyond_the_edge_is_counted_apart() {
    let dt = 1e-7;
    let small_box = "box = [1.2e-4, 1.2e-4, 1e-4]";
    let small_disc = "disc = { radius = 6e-5, thickness = 1e-4 }";
    for (keys, shape) in
        [("", small_box), (ROUND, small_box), ("", small_disc), (QUARTER, small_disc)]
    {
        let text = drop(keys) + &plate(shape, "auto", 10.0, "interval = 1e-7");
        let mut trial = Trial::new(&text);
        let mut impulse = 0.0;
        for _ in 0..80 {
            trial.step(dt);
            impulse += dt * trial.get("drop.force_outside");
        }
        let [given, taken] = ["drop.heat", "plate.heat_in"].map(|name| trial.get(name));
        assert!(off(taken, given) < 1e-10, "{shape}: {taken} of {given} J");
        assert!(impulse > 0.0, "{shape}");
        let said = trial.model.warnings(&trial.state);
        assert!(
            said.len() == 1 && said[0].to_string().starts_with("drop: fluid lies beyond"),
            "{said:?}"
        );
    }
    let wide = drop("") + &plate(BOX, "auto", 10.0, "");
    let mut trial = Trial::new(&wide);
    steps(&mut trial, 20, dt);
    assert_eq!(trial.get("drop.force_outside"), 0.0);
    assert_eq!(trial.model.warnings(&trial.state), []);
}

#[test]
fn a_plate_whose_temperature_alone_is_read_factors_nothing() {
    let elastic = ", young = 300e9, poisson = 0.21, expansion = 8.1e-6";
    let full = drop("") + &plate(BOX, "auto", 10.0, "");
    let bare = full.replace(elastic, "").replace("bottom = { clamped = true }", "");
    let mut temperatures = Vec::new();
    for text in [full, bare] {
        let mut trial = Trial::new(&text);
        steps(&mut trial, 10, 1e-7);
        temperatures.push(trial.get("plate.max_temperature"));
        assert_eq!(trial.model.factor_entries(), 0);
    }
    assert_eq!(temperatures[0], temperatures[1]);
}

/// A plate that is held at its bottom passes the force on to what holds it.
#[test]
fn the_force_of_the_drop_goes_through_the_plate() {
    [QUARTER, ROUND].into_iter().for_each(force_goes_through);
}

fn force_goes_through(keys: &str) {
    let field = "[[field]]\nname = \"below\"\non = \"plate.bottom\"\ngrid = [50, 50]\ngives = \
                 [\"stress\"]\n";
    let text = drop(keys) + &plate(BOX, "auto", 10.0, "") + &probe(0.0) + field;
    // As cold as the plate, which would else swell.
    let text = text.replace("initial_temperature = 350.0", "initial_temperature = 300.0");
    let mut trial = Trial::new(&text);
    steps(&mut trial, 8, 1e-7);
    let force = trial.get("drop.force");
    assert!(force > 1e-3, "{force} N");
    let cell = 1e-6 / 2500.0;
    let mut passed = 0.0;
    for i in 1..=50 {
        for j in 1..=50 {
            passed -= cell * trial.get(&format!("below.stress_zz[{i},{j}]"));
        }
    }
    assert!(off(passed, force) < 0.05, "{passed} N of {force} N");
    assert!(trial.get("spot.displacement_z") < 0.0);
}

#[test]
fn a_quarter_and_the_whole_say_the_same() {
    let values = |keys: &str, symmetry: &str| {
        let text = drop(keys) + &plate(BOX, symmetry, 10.0, "") + &probe(3e-5);
        let mut trial = Trial::new(&text);
        steps(&mut trial, 3, 1e-7);
        ["spot.temperature", "spot.stress_zz", "spot.displacement_x", "drop.heat", "drop.force"]
            .map(|name| trial.get(name))
    };
    let quarter = values("precision = \"double\"", "quarter");
    let whole = values("precision = \"double\"\nsymmetry = \"none\"", "none");
    for (a, b) in quarter.into_iter().zip(whole) {
        // The two plates have other nodes.
        assert!(off(a, b) < 2e-4, "{quarter:?} {whole:?}");
    }
}

#[test]
fn a_plate_that_never_warms_is_a_wall_at_its_temperature() {
    // So good a conductor spreads the heat at once over a mass that hardly feels it.
    let tiles = "tiles = { count = [2, 2], size = [1e-3, 1e-3] }";
    let rings = "rings = { count = 2, radius = 5e-4 }";
    for (keys, cells) in [(QUARTER, tiles), (ROUND, rings)] {
        let on_plate = drop(keys) + &plate(BOX, "auto", 1e9, "traction = false");
        let [plate, wall] = [on_plate, drop(keys) + &wall(cells)].map(|text| {
            let mut trial = Trial::new(&text);
            steps(&mut trial, 20, 1e-7);
            trial.get("drop.heat")
        });
        assert!(off(plate, wall) < 1e-3, "{keys}: {plate} J {wall} J");
    }
}

#[test]
fn a_disc_and_a_box_take_the_same_heat() {
    let run = |keys: &str, shape: &str, spacing: &str| {
        let text = drop(keys) + &plate(shape, "auto", 10.0, "traction = false") + &probe(2e-5);
        let mut trial = Trial::new(&text.replace("spacing = 2e-5", spacing));
        steps(&mut trial, 20, 1e-7);
        ["drop.heat", "spot.temperature"].map(|name| trial.get(name))
    };
    let coarse = "spacing = 2e-5";
    let [on_disc, on_box] = [DISC, BOX].map(|shape| run(QUARTER, shape, coarse));
    assert!(off(on_disc[0], on_box[0]) < 0.02, "{on_disc:?} {on_box:?}");
    // Rings are the same drop on both, and differ by the meshes below alone.
    let apart = [coarse, "spacing = 1e-5", "spacing = 5e-6"].map(|spacing| {
        let [on_disc, on_box] = [DISC, BOX].map(|shape| run(ROUND, shape, spacing));
        println!("{spacing}: {on_disc:?} on a disc, {on_box:?} on a box");
        [off(on_box[0], on_disc[0]), (on_box[1] - on_disc[1]) / (on_disc[1] - 300.0)]
    });
    println!("heat and rise of a box off those of a disc: {apart:?}");
    assert!(apart[2][0] < 0.003 && apart[2][1].abs() < 0.01, "{apart:?}");
    // Of first order at least: a cell is warmed as a whole where a wet edge crosses it.
    let orders = [0, 1].map(|n| (apart[n][0] / apart[n + 1][0]).log2());
    assert!(orders.iter().all(|order| *order > 0.9), "{orders:?}");
}

/// A coarse drop, whose particles are fifteen times as thick as the thermal layer, on plates into which
/// heat goes more and less easily than into the drop.
#[test]
fn the_surface_takes_the_contact_temperature_and_nothing_beyond() {
    let effusivity = |conductivity: f64, capacity: f64| (conductivity * capacity).sqrt();
    for (keys, conductivity) in [(QUARTER, 10.0), (QUARTER, 0.05), (ROUND, 10.0), (ROUND, 0.05)] {
        let text = drop(keys) + &plate(BOX, "auto", conductivity, "traction = false") + &probe(0.0);
        let mut trial = Trial::new(&text.replace("depth_spacing = 1e-6", "depth_spacing = 2e-7"));
        let (mut mean, mut highest) = (0.0, 0.0_f64);
        for _ in 0..8 {
            trial.step(1e-7);
            mean += (trial.get("spot.temperature") - 300.0) / 8.0;
            highest = highest.max(trial.get("plate.max_temperature"));
        }
        let [water, solid] = [effusivity(0.6, 4.18e6), effusivity(conductivity, 3950.0 * 900.0)];
        let contact = 50.0 * water / (water + solid);
        assert!((0.5..1.3).contains(&(mean / contact)), "{conductivity}: {mean} K of {contact} K");
        assert!(highest < 350.0, "{conductivity}: {highest} K");
    }
}

#[test]
fn a_step_is_the_sum_of_its_exchanges() {
    let text = drop("") + &plate(BOX, "auto", 10.0, "interval = 1e-7") + &probe(3e-5);
    let (mut once, mut often) = (Trial::new(&text), Trial::new(&text));
    once.step(4e-7);
    steps(&mut often, 4, 1e-7);
    assert_eq!(once.state.bodies, often.state.bodies);
    for name in ["spot.temperature", "spot.stress_xx", "plate.heat_in", "drop.force"] {
        assert_eq!(once.get(name), often.get(name), "{name}");
    }
}

#[test]
fn the_interval_hardly_matters() {
    // Shifted particles stand elsewhere for the least reason.
    let drop = drop("shifting = false");
    let heat = |interval: f64| {
        let coupling = format!("traction = false\ninterval = {interval:e}");
        let mut trial = Trial::new(&(drop.clone() + &plate(BOX, "auto", 10.0, &coupling)));
        steps(&mut trial, 2, 1e-6);
        trial.get("drop.heat")
    };
    let [coarse, middle, fine] = [1e-6, 2.5e-7, 6.25e-8].map(heat);
    assert!(off(coarse, fine) < 0.03 && off(middle, fine) < 0.03, "{coarse} {middle} {fine}");
}

#[test]
fn outputs_are_a_function_of_the_state() {
    let text = drop("") + &plate(BOX, "auto", 10.0, "") + &probe(3e-5);
    let mut trial = Trial::new(&text);
    let names = ["spot.temperature", "spot.stress_zz", "drop.force", "drop.kinetic_energy"];
    steps(&mut trial, 5, 1e-7);
    let saved = trial.state.clone();
    let first = names.map(|name| trial.get(name));
    steps(&mut trial, 3, 1e-7);
    let later = names.map(|name| trial.get(name));
    trial.restart(&saved);
    assert_eq!(names.map(|name| trial.get(name)), first);
    steps(&mut trial, 3, 1e-7);
    assert_eq!(names.map(|name| trial.get(name)), later);
    assert_ne!(first, later);
}

#[test]
fn the_cells_of_a_wall_and_what_lies_outside_make_the_whole() {
    let mut trial = Trial::new(&(drop("") + &wall("rings = { count = 4, radius = 4e-5 }")));
    for _ in 0..20 {
        let before = trial.get("drop.heat");
        trial.step(1e-7);
        let area = |ring: usize| PI * 1e-10 * (2 * ring - 1) as f64;
        let sum = |trial: &mut Trial, key: &str| -> f64 {
            (1..=4).map(|ring| area(ring) * trial.get(&format!("wall.{key}[{ring}]"))).sum()
        };
        let heat = sum(&mut trial, "heat_flux") + trial.get("wall.heat_flow_outside");
        assert!((heat - trial.get("drop.heat_flow")).abs() <= 1e-12 * heat.abs());
        let gained = trial.get("drop.heat") - before;
        assert!((1e-7 * heat - gained).abs() <= 1e-9 * gained.abs());
        let force = sum(&mut trial, "pressure") + trial.get("wall.force_outside");
        assert!((force - trial.get("drop.force")).abs() <= 1e-9 * force.abs());
    }
    assert!(trial.get("wall.heat_flow_outside") > 0.0, "the drop has not spread beyond the rings");
    assert!(trial.get("wall.shear_r[3]") > 0.0, "a spreading drop drags the wall outward");
}

#[test]
fn a_warmer_wall_takes_less_heat() {
    let heat = |temperature: f64| {
        let mut trial = Trial::new(&(drop("") + &wall(RINGS)));
        (1..=4).for_each(|ring| trial.set(&format!("wall.temperature[{ring}]"), temperature));
        steps(&mut trial, 10, 1e-7);
        trial.get("drop.heat")
    };
    let [cold, warm, alike] = [300.0, 325.0, 350.0].map(heat);
    assert!(off(warm, 0.5 * cold) < 1e-3, "{cold} {warm}");
    assert!(alike.abs() < 1e-9 * cold, "{alike}");
}

/// The first step of a drop on a poor conductor, whose surface a half space's heat would drive far beyond the
/// drop's temperature.
#[test]
fn a_wall_of_known_effusivity_gets_no_more_than_it_can_answer() {
    const EFFUSIVITY: f64 = 400.0;
    let flux = |key: &str| {
        let text = wall(RINGS).replace("under =", &format!("{key}\nunder ="));
        let mut trial = Trial::new(&(drop("") + &text));
        trial.step(1e-7);
        trial.get("wall.heat_flux[1]")
    };
    let answer = |flux: f64| 2.0 * flux * (1e-7 / PI).sqrt() / EFFUSIVITY;
    let [held, solid] = ["", &format!("effusivity = {EFFUSIVITY:?}")].map(flux).map(answer);
    // As a flux that is held, that of contact with a half space takes its surface by 4/π of 39.9 K.
    assert!(held > 1.5 * solid && (10.0..51.0).contains(&solid), "{held} K, {solid} K");
}

#[test]
fn nothing_has_happened_before_the_first_step() {
    let mut trial = Trial::new(&(drop("") + &wall(RINGS)));
    for name in ["drop.heat", "drop.force", "wall.heat_flux[1]", "wall.pressure[4]"] {
        assert_eq!(trial.get(name), 0.0, "{name}");
    }
    assert!(off(trial.get("drop.mass"), 1000.0 * PI / 6.0 * 1e-12) < 1e-9);
    assert!(off(trial.get("drop.momentum_z"), -20.0 * trial.get("drop.mass")) < 1e-9);
    assert_eq!(trial.get("drop.min_temperature"), 350.0);
}

#[test]
fn a_train_of_drops_is_released_drop_by_drop() {
    let train = "height = 1e-4\narrivals = [{ time = 2e-7, x = -2e-4 }, { time = 4e-7, x = 2e-4 }]";
    let tiles = "tiles = { count = [2, 1], size = [1e-3, 1e-3] }";
    let mut trial = Trial::new(&(drop(train) + &wall(tiles)));
    let one = 1000.0 * PI / 6.0 * 1e-12;
    let mut masses = Vec::new();
    for _ in 0..3 {
        masses.push((trial.get("drop.mass") / one).round());
        assert!(trial.get("drop.max_temperature").is_finite());
        trial.step(2e-7);
    }
    assert_eq!(masses, [0.0, 1.0, 2.0]);
}

#[test]
fn a_drop_in_free_space_moves_on() {
    let mut trial = Trial::new(&drop("height = 1e-4"));
    let momentum = trial.get("drop.momentum_z");
    trial.step(1e-7);
    let height = trial.get("drop.height");
    steps(&mut trial, 5, 1e-7);
    assert!(off(trial.get("drop.momentum_z"), momentum) < 1e-6);
    let fallen = height - trial.get("drop.height");
    assert!((fallen - 20.0 * 5e-7).abs() < 1e-6, "{fallen}");
}

#[test]
fn a_plane_drop_is_the_same_on_both_sides() {
    let tiles = "tiles = { count = [6, 1], size = [3e-4, 1e-3] }";
    let mut trial = Trial::new(&(drop("dimension = 2") + &wall(tiles)));
    steps(&mut trial, 10, 1e-7);
    let pressures: Vec<f64> =
        (1..=6).map(|i| trial.get(&format!("wall.pressure[{i},1]"))).collect();
    let highest = pressures.iter().copied().fold(0.0, f64::max);
    assert!(highest > 1e5, "{pressures:?}");
    for i in 0..3 {
        assert!((pressures[i] - pressures[5 - i]).abs() <= 1e-9 * highest);
    }
    let shear = [1, 6].map(|i| trial.get(&format!("wall.shear_x[{i},1]")));
    assert!((shear[0] + shear[1]).abs() <= 1e-9 * highest);
}

#[test]
fn a_step_that_fails_changes_nothing_and_says_where() {
    let scene = scene::parse(&(drop("") + &wall(RINGS)), "scene").unwrap();
    let model = Model::build(&scene, 1).unwrap();
    let (mut state, mut cache) = (model.initial_state(), Cache::default());
    model.step(&mut state, &mut cache, 1e-7).unwrap();
    state.inputs.fill(1e300);
    let before = state.clone();
    let error = model.step(&mut state, &mut cache, 1e-6).unwrap_err();
    assert!(matches!(error, ModelError::Body(BodyError::Droplet { .. })), "{error}");
    assert!(error.to_string().starts_with("drop: ") && error.to_string().contains("t = "));
    assert_eq!(state, before);

    state.inputs[2] = 0.0;
    let error = model.step(&mut state, &mut cache, 1e-6).unwrap_err();
    assert!(matches!(error, ModelError::Body(BodyError::Input { index: 2, .. })), "{error}");
}

/// Time steps fit into communication steps, so that these change how long they are, but little of what comes out.
#[test]
fn communication_steps_change_little() {
    let text = drop("") + &wall(RINGS);
    let names = ["drop.kinetic_energy", "drop.height", "drop.spread_diameter", "drop.impulse_z"];
    let run = |steps: usize| {
        let mut trial = Trial::new(&text);
        (0..steps).for_each(|_| trial.step(4e-6 / steps as f64));
        names.map(|name| trial.get(name))
    };
    let once = run(1);
    for steps in [7, 40, 400] {
        for (name, (a, b)) in names.iter().zip(run(steps).iter().zip(&once)) {
            assert!((a / b - 1.0).abs() < 0.03, "{name} in {steps} steps: {a} {b}");
        }
    }
}

#[test]
fn the_speed_of_sound_is_chosen_and_said() {
    let mut trial = Trial::new(&drop("gravity = 9.81"));
    let notes = trial.model.notes().join("\n");
    assert!(notes.contains("speed of sound chosen: 200."), "{notes}");
    assert!(notes.contains("surface tension is left out"), "{notes}");
    assert!(trial.get("drop.max_speed") > 0.0);
    let slow = drop("").replace("conductivity = 0.6", "conductivity = 0.6, sound_speed = 140.0");
    let notes = Trial::new(&slow).model.notes().join("\n");
    assert!(notes.contains("only 7.00 times"), "{notes}");
}

/// Glycerol at Re 2.7: nothing drives the drop once it has hit, so its energies only fall together.
#[test]
fn viscosity_that_rules_makes_no_energy() {
    let mut trial = Trial::new(
        r#"
name = "Glycerol"
stop_time = 1e-3
step = 4e-5
[body.drop]
kind = "droplet"
diameter = 2e-3
impact_velocity = 2.0
spacing = 8.333e-5
initial_temperature = 300.0
[body.drop.fluid]
density = 1260.0
viscosity = 0.95
specific_heat = 2400.0
conductivity = 0.285
surface_tension = 0.063
[[wall]]
name = "wall"
under = "drop"
footprint = { rings = { count = 1, radius = 4e-3 } }
start = { temperature = 300.0 }
"#,
    );
    let energies = ["drop.kinetic_energy", "drop.compression_energy", "drop.surface_energy"];
    let energy = |trial: &mut Trial| energies.iter().map(|name| trial.get(name)).sum::<f64>();
    let start = energy(&mut trial);
    let mut last = start;
    for step in 1..=25 {
        trial.step(4e-5);
        let next = energy(&mut trial);
        assert!(next < last + 1e-4 * start, "step {step}: {last:e} J before, {next:e} J after");
        last = next;
        let [low, high] = ["drop.min_density", "drop.max_density"].map(|name| trial.get(name));
        assert!(low > 0.97 * 1260.0 && high < 1.08 * 1260.0, "step {step}: {low} to {high} kg/m³");
        let force = trial.get("drop.force");
        assert!(force > 0.0, "step {step}: {force} N");
    }
}
