//! Inputs that change within a step, and how outputs change with inputs and in time.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::closed_form::{Conductor, GaussianFlux};
use impinge::model::start_rates;
use impinge::scene::{self, Constant};
use impinge::variables::{MaterialConstant, Output, Parameter};

/// A block of soft numbers with every kind of thermal face, loads of every footprint and probes off
/// all planes of symmetry. Its mesh is coarse, as what tests assert holds on any.
fn block(symmetry: &str, order: usize) -> String {
    format!(
        r#"
name = "Block"
stop_time = 1.0
step = 0.1
[body.block]
kind = "solid"
shape = {{ box = [2.0, 1.5, 0.5] }}
material = {{ model = "thermoelastic", density = 2.0, specific_heat = 3.0, conductivity = 5.0, young = 1000.0, poisson = 0.3, expansion = 1e-3 }}
initial_temperature = 300.0
symmetry = "{symmetry}"
mesh = {{ spacing = 0.25, depth_spacing = 0.25, order = {order} }}
[body.block.faces]
left = {{ temperature = 320.0, clamped = true }}
right = {{ temperature = 310.0, clamped = true }}
front = {{ convection = {{ coefficient = 8.0, ambient = 280.0 }} }}
back = {{ convection = {{ coefficient = 8.0, ambient = 290.0 }} }}
bottom = {{ flux = 30.0 }}
[refinement.block]
along = 0.5
through = 1.0
[[load]]
name = "spot"
on = "block.top"
footprint = {{ disc = {{ radius = 0.3 }} }}
carries = ["heat_flux", "pressure", "shear"]
start = {{ heat_flux = 4000.0, pressure = 3.0, shear_x = 2.0, shear_y = -1.0, x = 0.31, y = -0.22 }}
[[load]]
name = "wheel"
on = "block.bottom"
footprint = {{ rings = {{ count = 2, radius = 0.4 }} }}
carries = ["shear", "pressure", "heat_flux"]
start = {{ shear_r = [2.0, 1.0], pressure = 1.5, heat_flux = [500.0, 800.0], x = -0.23, y = 0.11 }}
[[load]]
name = "glow"
on = "block.top"
footprint = {{ gaussian = {{ radius = 0.2 }} }}
carries = ["heat_flux", "pressure"]
start = {{ heat_flux = 1500.0, pressure = 2.5, x = -0.4, y = 0.3 }}
[[load]]
name = "patch"
on = "block.top"
footprint = {{ tiles = {{ count = [2, 1], size = [0.5, 0.4] }} }}
carries = ["heat_flux", "pressure"]
start = {{ heat_flux = [[700.0], [900.0]], pressure = [[1.0], [2.0]], x = -0.11, y = -0.3 }}
[[field]]
name = "rings"
on = "block.top"
footprint = {{ rings = {{ count = 2, radius = 0.3 }} }}
at = [0.21, 0.13]
gives = ["temperature", "von_mises", "displacement"]
[[probe]]
name = "p"
in = "block"
at = [0.31, -0.21, -0.11]
gives = ["temperature", "stress", "max_principal", "displacement"]
[[field]]
name = "surface"
on = "block.top"
grid = [2, 2]
size = [1.0, 0.8]
gives = ["temperature", "von_mises"]
"#
    )
}

/// The same block with heat by particles at equal distances, where its balance is exact.
fn particles() -> String {
    let text =
        block("auto", 1).replace("depth_spacing = 0.25", "depth_spacing = 0.25, growth = 1.0");
    text.replace("initial_temperature", "heat = \"sph\"\ninitial_temperature")
}

/// Changes of inputs of every kind.
const DIRECTIONS: [&[(&str, f64)]; 14] = [
    &[("spot.pressure", 1.0)],
    &[("spot.shear_x", 1.0)],
    &[("spot.x", 0.1)],
    &[("spot.y", 0.1)],
    &[("spot.radius", 0.1)],
    &[("wheel.x", 0.1)],
    &[("wheel.radius", 0.1)],
    &[("wheel.shear_r[2]", 1.0)],
    &[("glow.x", 0.1)],
    &[("glow.radius", 0.1)],
    &[("patch.x", 0.1)],
    &[("block.left.temperature", 1.0)],
    &[("spot.heat_flux", 1.0), ("block.front.ambient", 1.0), ("block.bottom.flux", 1.0)],
    &[
        ("spot.x", 0.1),
        ("spot.pressure", 0.2),
        ("patch.y", -0.1),
        ("block.right.temperature", -1.0),
    ],
];

/// `found` is the central difference of `values` at `±step`, to `tolerance` of the largest in each
/// kind of output.
#[track_caller]
fn assert_limit(
    names: &[String],
    found: &[f64],
    [above, below]: [Vec<f64>; 2],
    step: f64,
    tolerance: f64,
    what: &str,
) {
    let kind = |name: &str| {
        ["heat", "displacement", "temperature"]
            .into_iter()
            .find(|k| name.contains(k))
            .unwrap_or("stress")
    };
    for (i, name) in names.iter().enumerate() {
        let wanted = |i: usize| (above[i] - below[i]) / (2.0 * step);
        let same = (0..names.len()).filter(|&j| kind(&names[j]) == kind(name));
        let scale = same.map(|j| wanted(j).abs()).fold(0.0, f64::max);
        let error = (found[i] - wanted(i)).abs();
        let rounding = 1e-15 * above[i].abs() / step;
        assert!(
            error <= tolerance * scale + rounding,
            "{what}: {name}: {} {}",
            found[i],
            wanted(i)
        );
    }
}

fn values(trial: &mut Trial, names: &[String]) -> Vec<f64> {
    names.iter().map(|name| trial.get(name)).collect()
}

#[test]
fn changes_with_inputs_are_the_limit_of_differences() {
    // All directions on one block; on the others every second.
    let scenes = [
        (block("auto", 1), 0, 1),
        (block("none", 1), 0, 2),
        (block("auto", 2), 1, 2),
        (particles(), 0, 2),
    ];
    for (text, first, every) in scenes {
        let mut trial = Trial::new(&text);
        trial.step(0.05);
        let names = trial.outputs();
        let start = trial.state.clone();
        for direction in DIRECTIONS.into_iter().skip(first).step_by(every) {
            let found = trial.changes(&names, direction);
            let step = 1e-4;
            let differ = [step, -step].map(|by| {
                trial.restart(&start);
                for &(name, change) in direction {
                    let value = start.inputs[trial.input(name)];
                    trial.set(name, value + by * change);
                }
                values(&mut trial, &names)
            });
            trial.restart(&start);
            assert_limit(&names, &found, differ, step, 3e-5, &format!("{direction:?}"));
        }
    }
}

#[test]
fn outputs_at_the_start_follow_constants_as_the_theory_says() {
    for order in [1, 2] {
        let text = block("auto", order);
        let scene = scene::parse(&text, "scene").unwrap();
        let mut trial = Trial::new(&text);
        let names: Vec<String> =
            ["temperature", "stress_xx", "displacement_z"].map(|key| format!("p.{key}")).to_vec();
        let now = values(&mut trial, &names);
        // Without expansion, what tractions do alone; what temperatures do is the rest.
        let mut tractions = Trial::new(&text.replace("expansion = 1e-3", "expansion = 0.0"));
        let by_tractions = values(&mut tractions, &names);
        let by_heat: Vec<f64> = now.iter().zip(&by_tractions).map(|(a, b)| a - b).collect();
        let rates = |key| {
            let constant = MaterialConstant::named(key).unwrap();
            let parameter =
                Parameter { body: "block".into(), constant: Constant::Material(constant) };
            let outputs: Vec<Output> = names.iter().map(|name| trial.output(name)).collect();
            let outputs: Vec<&Output> = outputs.iter().collect();
            start_rates(&scene, &trial.state.inputs, &parameter, &outputs).unwrap()
        };
        let close = |value: f64, wanted: f64| {
            assert!((value - wanted).abs() < 1e-8 * wanted.abs().max(1e-9), "{value} {wanted}");
        };
        let young = rates("young");
        // Stresses by heat are proportional to E, displacements by tractions to 1/E.
        close(young[0], 0.0);
        close(young[1], by_heat[1] / 1000.0);
        close(young[2], -by_tractions[2] / 1000.0);
        let expansion = rates("expansion");
        close(expansion[1], by_heat[1] / 1e-3);
        close(expansion[2], by_heat[2] / 1e-3);
        assert_eq!(rates("conductivity"), [0.0; 3]);
    }
}

/// Scenes of one body each, whose outputs at time zero follow constants of its kind.
const KINDS: [&str; 3] = [
    r#"
name = "Strip"
stop_time = 1.0
step = 0.1
[body.own]
kind = "lattice"
length = 0.2
depth = 0.05
thickness = 0.04
spacing = 5e-3
support = { three_point = { span = 0.15 } }
control = "displacement"
[body.own.material]
density = 2300.0
young = 30e9
poisson = 0.2
softening = { model = "openings", strength = 4e6, openings = [9e-6, 197e-6], share = 0.13 }
"#,
    r#"
name = "Drop"
stop_time = 1e-4
step = 1e-5
[body.own]
kind = "droplet"
diameter = 1e-4
impact_velocity = 1.0
initial_temperature = 300.0
spacing = 1e-5
precision = "double"
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4000.0, conductivity = 0.6, surface_tension = 0.07 }
"#,
    r#"
name = "Sheet"
stop_time = 1.0
step = 0.1
[body.own]
kind = "solid"
strain = "finite"
dimension = 2
shape = { box = [0.02, 0.01, 0.01] }
mesh = { spacing = 2.5e-3 }
initial_temperature = 300.0
gravity = 9.81
material = { model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e5, poisson = 0.3 }
faces.left = { clamped = true }
faces.right = { traction = [0.0, 0.0, 50.0] }
"#,
];

/// The rates at time zero of all outputs by all constants that a body offers are the limit of differences.
#[test]
fn outputs_at_the_start_follow_every_constant_of_every_kind() {
    for text in KINDS {
        let scene = scene::parse(text, "scene").unwrap_or_else(|error| panic!("{error}"));
        let mut trial = Trial::new(text);
        let names = trial.outputs();
        let now = values(&mut trial, &names);
        let outputs: Vec<Output> = names.iter().map(|name| trial.output(name)).collect();
        let outputs: Vec<&Output> = outputs.iter().collect();
        // Particles follow the size of their drop by leaps.
        let offered = scene.body["own"].constants("own").into_iter();
        for offered in offered.filter(|offered| offered.key != "diameter") {
            let parameter = Parameter { body: "own".into(), constant: offered.constant };
            let found = start_rates(&scene, &trial.state.inputs, &parameter, &outputs).unwrap();
            let value = parameter.get(&scene);
            let step = 1e-5 * value;
            let [above, below] = [step, -step].map(|by| {
                let mut moved = scene.clone();
                parameter.set(&mut moved, value + by);
                values(&mut Trial::of(moved), &names)
            });
            for (i, name) in names.iter().enumerate() {
                let wanted = (above[i] - below[i]) / (2.0 * step);
                // Components of one vector round alike.
                let vector = name.rsplit_once('_').map_or(&name[..], |(vector, _)| vector);
                let same = names.iter().zip(&now).filter(|(other, _)| other.starts_with(vector));
                let size = same.fold(0.0, |most: f64, (_, value)| most.max(value.abs()));
                let rounding = 1e-11 * size / step;
                let close = (found[i] - wanted).abs() <= 1e-4 * wanted.abs() + rounding;
                assert!(close, "{}: {name} by {}: {} {wanted}", scene.name, offered.key, found[i]);
            }
        }
    }
}

/// Inputs on the move: the same block, with amounts, places and face temperatures changing.
fn set_off(trial: &mut Trial) {
    for (name, order, value) in [
        ("spot.heat_flux", 1, 900.0),
        ("spot.heat_flux", 2, -4000.0),
        ("spot.pressure", 1, 2.0),
        ("spot.x", 1, -1.3),
        ("spot.radius", 1, 0.2),
        ("wheel.y", 1, 0.6),
        ("wheel.y", 2, -2.0),
        ("glow.heat_flux", 1, -700.0),
        ("glow.x", 1, 0.9),
        ("patch.x", 1, 0.5),
        ("block.left.temperature", 1, 40.0),
        ("block.left.temperature", 2, -90.0),
        ("block.front.ambient", 1, -60.0),
        ("block.bottom.flux", 1, 800.0),
    ] {
        trial.set_derivative(name, order, value);
    }
}

#[test]
fn changes_in_time_are_the_limit_of_differences() {
    for text in [block("auto", 1), block("none", 1), block("auto", 2), particles()] {
        let mut trial = Trial::new(&text);
        set_off(&mut trial);
        trial.step(0.05);
        let names = trial.outputs();
        let start = trial.state.clone();
        let h = 1e-5;
        trial.step(h);
        let found = trial.rates(&names);
        let below = {
            trial.restart(&start);
            values(&mut trial, &names)
        };
        trial.step(2.0 * h);
        let above = values(&mut trial, &names);
        assert_limit(&names, &found, [above, below], h, 3e-4, &text);
        assert_eq!(trial.rates(&["block.estimated_error".into()]), [0.0]);
    }
}

#[test]
fn the_rates_of_heat_balance() {
    for text in [block("auto", 2), particles()] {
        let mut trial = Trial::new(&text);
        set_off(&mut trial);
        for dt in [1e-5, 0.01, 0.1] {
            trial.step(dt);
            let names = ["heat_in", "heat_stored", "heat_lost"].map(|key| format!("block.{key}"));
            let rates = trial.rates(&names);
            let largest = rates.iter().fold(0.0_f64, |largest, r| largest.max(r.abs()));
            let residual = (rates[0] - rates[1] - rates[2]) / largest;
            assert!(residual.abs() < 1e-11, "{rates:?}: {residual}\n{text}");
        }
    }
}

#[test]
fn heat_balances_under_inputs_that_change_within_steps() {
    for text in [block("auto", 1), block("auto", 2), particles()] {
        let mut trial = Trial::new(&text);
        set_off(&mut trial);
        for dt in [1e-6, 0.03, 1e-3, 0.15, 0.02] {
            trial.step(dt);
            let residual = trial.heat_residual("block");
            assert!(residual < 1e-11, "step {dt}: {residual}\n{text}");
        }
    }
}

const RESTING: [&str; 6] =
    ["spot.x", "spot.radius", "wheel.y", "glow.x", "patch.x", "spot.pressure"];

/// Outputs of particles at equal distances that are zero but for rounding.
const OF_ROUNDING: [&str; 2] = ["block.heat_drift", "block.fallback_particles"];

#[test]
fn amounts_that_change_within_steps_make_no_time_error() {
    let run = |text: &str, steps: &[f64]| {
        let mut trial = Trial::new(text);
        set_off(&mut trial);
        for name in RESTING {
            (1..=2).for_each(|order| trial.set_derivative(name, order, 0.0));
        }
        steps.iter().for_each(|&dt| trial.step(dt));
        let names = trial.outputs();
        (values(&mut trial, &names), names)
    };
    for text in [block("auto", 1), particles()] {
        let (once, names) = run(&text, &[0.2]);
        let (often, _) = run(&text, &[1e-4, 0.05, 0.03, 0.0199, 0.1]);
        let values = once.iter().zip(&often).zip(&names);
        for ((a, b), name) in values.filter(|(_, name)| !OF_ROUNDING.contains(&name.as_str())) {
            assert!(off(*a, *b) < 1e-9, "{name}: {a} {b}");
        }
    }
}

/// A column whose top is heated evenly: a half space as long as the heat has not come through.
const COLUMN: &str = r#"
name = "Column"
stop_time = 1e-3
step = 1e-5
[body.column]
kind = "solid"
shape = { box = [1e-4, 1e-4, 5e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 293.15
mesh = { spacing = 5e-5, depth_spacing = 0.5e-6, growth = 1.1, order = 2 }
[body.column.faces]
top = { flux = 0.0 }
[[probe]]
name = "surface"
in = "column"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#;

#[test]
fn a_flux_that_grows_linearly_heats_a_half_space_as_the_closed_form_says() {
    // q = b t: ΔT = 4 b t^(3/2)/(3 √(π k ρ c)) at the surface, by Duhamel's integral.
    let (slope, t) = (1e10, 1e-3);
    let effusivity = (10.0_f64 * 3950.0 * 900.0).sqrt();
    let wanted = 4.0 * slope * t * f64::sqrt(t) / (3.0 * PI.sqrt() * effusivity);
    let particles =
        COLUMN.replace("0.5e-6, growth = 1.1, order = 2", "1e-6, growth = 1.1, order = 1");
    assert_ne!(particles, COLUMN);
    let particles = particles.replace("initial_temperature", "heat = \"sph\"\ninitial_temperature");
    for (text, steps, tolerance) in
        [(COLUMN, 1, 1e-4), (COLUMN, 7, 1e-4), (&particles, 1, 2e-3), (&particles, 7, 2e-3)]
    {
        let mut trial = Trial::new(text);
        trial.set_derivative("column.top.flux", 1, slope);
        (0..steps).for_each(|_| trial.step(t / f64::from(steps)));
        let rise = trial.get("surface.temperature") - 293.15;
        assert!(off(rise, wanted) < tolerance, "{rise} {wanted}");
        // Its rate is 3/2 of the rise over the time.
        let rate = trial.rates(&["surface.temperature".into()])[0];
        assert!(off(rate, 1.5 * wanted / t) < tolerance, "{rate}");
        assert!(off(trial.get("column.heat_in"), 0.5 * slope * t * t * 1e-8) < 1e-12);
    }
}

#[test]
fn a_flux_that_bends_heats_a_half_space_as_the_closed_form_says() {
    // q = c t²/2: ΔT = 8 c t^(5/2)/(15 √(π k ρ c)).
    let (bend, t) = (1e13, 1e-3_f64);
    let effusivity = (10.0_f64 * 3950.0 * 900.0).sqrt();
    let wanted = 8.0 * bend * t.powf(2.5) / (15.0 * PI.sqrt() * effusivity);
    let mut trial = Trial::new(COLUMN);
    trial.set_derivative("column.top.flux", 2, bend);
    trial.step(t);
    let rise = trial.get("surface.temperature") - 293.15;
    assert!(off(rise, wanted) < 1e-4, "{rise} {wanted}");
}

#[test]
fn a_footprint_that_moves_within_one_step_heats_as_the_closed_form_says() {
    let (speed, duration, start) = (1.0, 4e-4, -2e-4);
    let text = r#"
name = "Plate"
stop_time = 4e-4
step = 4e-4
[body.plate]
kind = "solid"
shape = { box = [2e-3, 2e-3, 0.6e-3] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 293.15
mesh = { spacing = 12e-6, depth_spacing = 3e-6, growth = 1.3, order = 2 }
[[load]]
name = "spot"
on = "plate.top"
footprint = { gaussian = { radius = 50e-6 } }
carries = ["heat_flux"]
start = { heat_flux = 1e8, x = -2e-4 }
range = { x = [-2e-4, 2e-4] }
[[probe]]
name = "centre"
in = "plate"
at = [2e-4, 0.0, 0.0]
gives = ["temperature"]
[[probe]]
name = "behind"
in = "plate"
at = [1e-4, 0.0, 0.0]
gives = ["temperature"]
"#;
    let body = Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 };
    let exact = GaussianFlux { body, peak: 1e8, radius: 50e-6, velocity: speed };
    let run = |steps: usize| {
        let mut trial = Trial::new(text);
        trial.set_derivative("spot.x", 1, speed);
        (0..steps).for_each(|_| trial.step(duration / steps as f64));
        assert!(trial.heat_residual("plate") < 1e-11);
        ["centre", "behind"].map(|name| trial.get(&format!("{name}.temperature")) - 293.15)
    };
    let once = run(1);
    for (rise, x) in once.iter().zip([2e-4, 1e-4]) {
        let wanted = exact.rise([x - start, 0.0, 0.0], duration);
        assert!(off(*rise, wanted) < 3e-3, "{x}: {rise} {wanted}");
    }
    // What is left is the mesh's error. In time, the step has 64 parts, so that two and four times as
    // many steps halve these; the error falls with the fourth power.
    let [halves, quarters] = [128, 256].map(run);
    for i in 0..2 {
        let [error, half] = [once, halves].map(|rises| off(rises[i], quarters[i]));
        assert!(error < 2e-5, "{error}");
        let order = (error / half).log2();
        assert!(order > 3.5, "order {order} of {error:e} and {half:e}");
    }
}

#[test]
fn a_path_that_leaves_the_face_or_its_range_is_refused_and_changes_nothing() {
    let mut trial = Trial::new(&block("auto", 1));
    trial.step(0.01);
    for (name, slope, bend) in [
        ("spot.x", 50.0, 0.0),
        // Out and back again within the step.
        ("spot.x", 40.0, -800.0),
        ("block.front.ambient", -1.2e4, 2.4e5),
        ("spot.radius", -4.0, 0.0),
        ("spot.x", 1e300, 0.0),
    ] {
        trial.set_derivative(name, 1, slope);
        trial.set_derivative(name, 2, bend);
        let before = trial.state.clone();
        let error = trial.try_step(0.1).unwrap_err().to_string();
        assert!(error.contains("into the step"), "{name}: {error}");
        assert_eq!(trial.state, before, "{name}");
        trial.set_derivative(name, 1, 0.0);
        trial.set_derivative(name, 2, 0.0);
    }
    trial.step(0.1);
}

#[test]
fn a_solution_beyond_all_numbers_is_refused_and_changes_nothing() {
    let mut trial = Trial::new(&block("auto", 1));
    trial.step(0.01);
    trial.set("spot.heat_flux", 1e308);
    let before = trial.state.clone();
    let error = trial.try_step(1e9).unwrap_err().to_string();
    assert!(error.contains("grows beyond"), "{error}");
    assert_eq!(trial.state, before);
}
