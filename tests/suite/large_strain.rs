//! Solids of large strain: gels that fall, bounce and load plates, and blocks that are drawn.

use impinge::body::LargeStrainForecast;
use impinge::closed_form::{ElasticBall, Rubber, Sides};
use impinge::model::Model;
use impinge::scene;

use crate::common::{Trial, off};

/// A gel with further keys, that falls on the plane.
fn gel(keys: &str) -> String {
    format!(
        r#"
name = "Gel"
stop_time = 0.03
step = 1e-3
[body.gel]
kind = "solid"
strain = "finite"
initial_temperature = 293.15
material = {{ model = "neo_hookean", density = 1000.0, specific_heat = 4180.0, conductivity = 0.6, young = 5600.0, poisson = 0.4 }}
{keys}
"#
    )
}

const BALL: &str =
    "shape = { ball = { radius = 10e-3 } }\ninertia = true\nmesh = { spacing = 2e-3 }";
const FALLS: &str = "gravity = 9.81\nstart = { velocity = [0.0, 0.0, -1.0] }";

fn steps(trial: &mut Trial, count: usize, dt: f64) {
    (0..count).for_each(|_| trial.step(dt));
}

#[test]
fn a_free_body_falls_as_a_point() {
    let shapes = ["box = [4e-3, 6e-3, 8e-3]", "ball = { radius = 4e-3 }"];
    let disc = "disc = { radius = 4e-3, thickness = 3e-3 }";
    for (shape, symmetry) in [
        (shapes[0], "none"),
        (shapes[0], "quarter"),
        (shapes[1], "auto"),
        (disc, "auto"),
        (disc, "quarter"),
    ] {
        let mut trial = Trial::new(&gel(&format!(
            "shape = {{ {shape} }}\ninertia = true\nsymmetry = \"{symmetry}\"\nmesh = {{ spacing = 2e-3 }}\n\
             gravity = 9.81\nstart = {{ velocity = [0.0, 0.0, 1.0], height = 0.1 }}"
        )));
        let start = trial.get("gel.centre_z");
        steps(&mut trial, 10, 1e-3);
        let fallen = 1.0 * 0.01 - 0.5 * 9.81 * 0.01_f64.powi(2);
        assert!((trial.get("gel.centre_z") - start - fallen).abs() < 1e-12, "{shape} {symmetry}");
        assert!(trial.get("gel.max_von_mises") < 1e-6);
        assert_eq!(trial.get("gel.contact_force"), 0.0);
    }
}

#[test]
fn a_gel_bounces_and_all_balances_close() {
    for keys in [
        "dimension = 2",
        "mechanics = \"sph\"\ndimension = 2",
        "",
        "symmetry = \"quarter\"",
        "mechanics = \"rkpm\"",
        "mechanics = \"rkpm\"\nrkpm = { integration = \"scni\" }\ndimension = 2",
        "mechanics = \"efg\"\nrkpm = { integration = \"gauss\" }\ndimension = 2",
    ] {
        let mut trial = Trial::new(&gel(&format!("{BALL}\n{FALLS}\n{keys}")));
        let mass = trial.get("gel.mass");
        let (height, kinetic) = (trial.get("gel.centre_z"), trial.get("gel.kinetic"));
        let mut most: f64 = 0.0;
        for n in 1..=30 {
            trial.step(1e-3);
            let time = 1e-3 * f64::from(n);
            let momentum = trial.get("gel.momentum_z") + mass + mass * 9.81 * time;
            let pushed = -trial.get("gel.impulse_z");
            assert!((momentum - pushed).abs() < 1e-10 * mass, "{keys} {n}");
            let work = mass * 9.81 * (height - trial.get("gel.centre_z"));
            let energy = trial.get("gel.kinetic") + trial.get("gel.stored") - work;
            assert!((energy / kinetic - 1.0).abs() < 0.01, "{keys} {n} {}", energy / kinetic);
            assert!(trial.get("gel.dissipated").abs() < 0.01 * kinetic);
            most = most.max(trial.get("gel.width"));
        }
        assert!(trial.get("gel.lift_off_time") > 5e-3 && trial.get("gel.momentum_z") > 0.0);
        assert!(most > 1.2 * 20e-3 && trial.get("gel.least_jacobian") > 0.5);
    }
}

#[test]
fn parts_of_a_ball_are_one_ball() {
    let outputs = ["width", "height", "contact_force", "stored", "kinetic", "max_von_mises"];
    let values = |keys: &str| {
        let mut trial = Trial::new(&gel(&format!("{BALL}\n{FALLS}\n{keys}")));
        steps(&mut trial, 6, 1e-3);
        outputs.map(|key| trial.get(&format!("gel.{key}")))
    };
    let whole = values("symmetry = \"none\"");
    let quarter = values("symmetry = \"quarter\"");
    let section = values("");
    for n in 0..outputs.len() {
        assert!(off(quarter[n], whole[n]) < 1e-9, "{} {quarter:?} {whole:?}", outputs[n]);
        // Stress at a point follows the mesh.
        let tolerance = if n == 5 { 0.35 } else { 0.06 };
        assert!(off(section[n], whole[n]) < tolerance, "{} {section:?} {whole:?}", outputs[n]);
    }
}

#[test]
fn a_slow_ball_touches_as_hertz_says() {
    let (speed, radius) = (0.1, 10e-3);
    let ball = ElasticBall { radius, density: 1000.0, young: 1e5, poisson: 0.4 };
    let text =
        gel("shape = { ball = { radius = 10e-3 } }\ninertia = true\nmesh = { spacing = 0.6e-3 }\n\
                    start = { velocity = [0.0, 0.0, -0.1] }")
        .replace("young = 5600.0", "young = 1e5");
    let mut trial = Trial::new(&text);
    let (mut force, mut reach): (f64, f64) = (0.0, 0.0);
    while trial.get("gel.lift_off_time") == 0.0 {
        trial.step(1e-4);
        force = force.max(trial.get("gel.contact_force"));
        reach = reach.max(trial.get("gel.contact_radius"));
    }
    assert!(off(force, ball.force(speed)) < 0.1, "{force} {}", ball.force(speed));
    assert!(
        off(reach, ball.contact_radius(speed)) < 0.15,
        "{reach} {}",
        ball.contact_radius(speed)
    );
    let time = trial.get("gel.lift_off_time");
    assert!(off(time, ball.contact_time(speed)) < 0.05, "{time} {}", ball.contact_time(speed));
}

/// A block with faces held in some way.
pub fn block(faces: &str, keys: &str) -> String {
    gel(&format!(
        "shape = {{ box = [10e-3, 8e-3, 12e-3] }}\nmesh = {{ spacing = 4e-3 }}\n{keys}\n{faces}"
    ))
}

#[test]
fn drawn_blocks_follow_the_closed_form() {
    let rubber = Rubber::of_young(5600.0, 0.4);
    let ends =
        "top = { roller = true, displacement = [0.0, 0.0, 0.0] }, bottom = { roller = true }";
    let lateral = "left = { roller = true }, front = { roller = true }";
    for (sides, faces) in [
        (Sides::Held, "sides = { roller = true }"),
        (
            Sides::OneHeld,
            "left = { roller = true }, front = { roller = true }, back = { roller = true }",
        ),
        (Sides::Free, lateral),
        (Sides::Free, ""),
    ] {
        let comma = if faces.is_empty() { "" } else { "," };
        for keys in [
            "",
            "mechanics = \"sph\"",
            "mechanics = \"rkpm\"",
            "mechanics = \"efg\"\nrkpm = { integration = \"scni\" }",
        ] {
            let mut trial =
                Trial::new(&block(&format!("faces = {{ {ends}{comma} {faces} }}"), keys));
            // The last two are so long that a first trial passes through the planes of symmetry.
            for stretch in [1.1, 2.0, 0.6, 5.0, 0.8] {
                trial.set("gel.top.displacement_z", 12e-3 * (stretch - 1.0));
                trial.step(1.0);
                let expected = 10e-3 * 8e-3 * rubber.force(stretch, sides);
                let found = trial.get("gel.top.force_z");
                assert!(off(found, expected) < 1e-8, "{sides:?} {stretch} {found} {expected}");
                assert!(off(trial.get("gel.height"), 12e-3 * stretch) < 1e-9);
                let width =
                    10e-3 * if sides == Sides::Held { 1.0 } else { rubber.lateral(stretch, sides) };
                assert!(off(trial.get("gel.width"), width) < 1e-8, "{sides:?} {stretch}");
            }
        }
    }
}

#[test]
fn a_stretched_body_returns() {
    let faces = "faces = { top = { displacement = [0.0, 0.0, 0.0] }, bottom = { clamped = true } }";
    for keys in ["", "dimension = 2", "symmetry = \"none\""] {
        let mut trial = Trial::new(&block(faces, keys));
        let along = [5e-3, 12e-3, 0.0, -4e-3, 0.0];
        for to in along {
            trial.set("gel.top.displacement_z", to);
            trial.step(1.0);
            let (force, stored) = (trial.get("gel.top.force_z"), trial.get("gel.stored"));
            assert!(force * to >= 0.0 && stored >= -1e-15, "{to} {force} {stored}");
            assert!(trial.get("gel.dissipated").abs() < 1e-15 + 1e-12 * stored);
        }
        assert!(trial.get("gel.stored").abs() < 1e-12 && trial.get("gel.top.force_z").abs() < 1e-9);
    }
}

#[test]
fn outputs_follow_the_inputs_before_any_step() {
    let faces =
        "faces = { top = { displacement = [0.0, 0.0, -1e-3] }, bottom = { clamped = true } }";
    let mut trial = Trial::new(&block(faces, ""));
    assert!(off(trial.get("gel.height"), 11e-3) < 1e-9);
    trial.set("gel.top.displacement_z", -3e-3);
    let at_once =
        ["height", "width", "top.force_z", "stored"].map(|key| trial.get(&format!("gel.{key}")));
    assert!(off(at_once[0], 9e-3) < 1e-9 && at_once[2] < 0.0, "{at_once:?}");
    trial.step(1.0);
    let later =
        ["height", "width", "top.force_z", "stored"].map(|key| trial.get(&format!("gel.{key}")));
    for (a, b) in at_once.iter().zip(later) {
        assert!(off(*a, b) < 1e-8, "{at_once:?} {later:?}");
    }
    assert!(
        trial
            .try_changes(&["gel.top.force_z".to_owned()], &[("gel.top.displacement_z", 1.0)])
            .is_err()
    );
}

#[test]
fn metals_dissipate_what_they_do_not_store() {
    let faces = "faces = { top = { roller = true, displacement = [0.0, 0.0, 0.0] }, bottom = { roller = true } }";
    let text = block(faces, "").replace(
        r#"model = "neo_hookean", density = 1000.0"#,
        r#"model = "elastoplastic", yield_stress = 100.0, isotropic_hardening = 200.0, density = 1000.0"#,
    );
    for count in [1, 4, 20, 200] {
        let mut trial = Trial::new(&text);
        for n in 1..=count {
            trial.set("gel.top.displacement_z", 5e-3 * f64::from(n) / f64::from(count));
            trial.step(1.0);
        }
        let (volume, plastic) = (10e-3 * 8e-3 * 12e-3, (17.0_f64 / 12.0).ln());
        // The Kirchhoff stress over the logarithmic plastic strain, less the elastic part of the strain.
        let plastic = plastic - (100.0 + 200.0 * plastic) / 5600.0;
        let expected = volume * (100.0 * plastic + 100.0 * plastic * plastic);
        let found = trial.get("gel.dissipated");
        assert!(off(found, expected) < 0.03, "{count}: {found} {expected}");
        let elastic = volume * (100.0_f64 + 200.0 * plastic).powi(2) / (2.0 * 5600.0);
        assert!(
            off(trial.get("gel.stored"), elastic) < 0.05,
            "{} {elastic}",
            trial.get("gel.stored")
        );
    }
}

#[test]
fn the_work_of_a_face_is_what_is_stored() {
    let faces = "faces = { top = { displacement = [0.0, 0.0, 0.0] }, bottom = { clamped = true } }";
    let mut trial = Trial::new(&block(faces, "symmetry = \"none\""));
    let (mut work, mut force) = (0.0, [0.0; 2]);
    let count = 200;
    for n in 1..=count {
        let part = f64::from(n) / f64::from(count);
        trial.set("gel.top.displacement_z", 6e-3 * part);
        trial.set("gel.top.displacement_x", 4e-3 * part);
        trial.step(1.0);
        let now = [trial.get("gel.top.force_x"), trial.get("gel.top.force_z")];
        let mean = [0, 1].map(|a| 0.5 * (force[a] + now[a]));
        work += (mean[0] * 4e-3 + mean[1] * 6e-3) / f64::from(count);
        force = now;
    }
    assert!(off(trial.get("gel.stored"), work) < 1e-4, "{} {work}", trial.get("gel.stored"));
}

/// A gel on a plate.
fn on_plate(shape: &str, keys: &str, coupling: &str) -> String {
    let text = gel(&format!("{BALL}\n{FALLS}\n{keys}"));
    format!(
        r#"{text}
[body.plate]
kind = "solid"
shape = {{ {shape} }}
material = {{ model = "thermoelastic", density = 2500.0, specific_heat = 840.0, conductivity = 1.1, young = 70e9, poisson = 0.22, expansion = 9e-6 }}
initial_temperature = 293.15
mesh = {{ spacing = 2e-3, order = 1, growth = 2.0 }}
faces = {{ bottom = {{ clamped = true }} }}
[[coupling]]
from = "gel"
to = "plate.top"
{coupling}
[[probe]]
name = "below"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["stress", "temperature"]
"#
    )
}

#[test]
fn what_the_gel_loses_the_plate_bears() {
    let disc = "disc = { radius = 40e-3, thickness = 4e-3 }";
    let square = "box = [80e-3, 80e-3, 4e-3]";
    for (shape, keys) in [(disc, ""), (square, ""), (square, "symmetry = \"quarter\"")] {
        let mut trial = Trial::new(&on_plate(shape, keys, "interval = 1e-3"));
        steps(&mut trial, 6, 1e-3);
        let force = trial.get("gel.contact_force");
        let stress = trial.get("below.stress_zz");
        assert!(force > 0.1 && stress < -100.0, "{shape} {keys} {force} {stress}");
        assert_eq!(trial.get("gel.force_outside"), 0.0);
        assert_eq!(trial.get("below.temperature"), 293.15);
        // The pressure below the middle is of the order of the force over the area in contact.
        let area = std::f64::consts::PI * trial.get("gel.contact_radius").powi(2);
        let mean = force / area;
        assert!((0.5..4.0).contains(&(-stress / mean)), "{shape} {keys} {stress} {mean}");
    }
    let mut free = Trial::new(&on_plate(square, "", "interval = 1e-3\ntraction = false"));
    steps(&mut free, 6, 1e-3);
    assert_eq!(free.get("below.stress_zz"), 0.0);
}

#[test]
fn states_continue_bit_for_bit_on_any_threads() {
    let text = gel(&format!("{BALL}\n{FALLS}\nsymmetry = \"none\""));
    let mut one = Trial::on_threads(&text, 1);
    let mut two = Trial::on_threads(&text, 3);
    steps(&mut one, 4, 1e-3);
    steps(&mut two, 4, 1e-3);
    assert_eq!(one.state, two.state);
    let saved = one.state.clone();
    steps(&mut one, 3, 1e-3);
    two.restart(&saved);
    steps(&mut two, 3, 1e-3);
    assert_eq!(one.state, two.state);
}

#[test]
fn states_that_no_run_produces_are_refused() {
    let moving = gel(&format!("{BALL}\n{FALLS}"));
    let faces =
        "faces = { top = { displacement = [0.0, 0.0, 1e-3] }, bottom = { clamped = true } }";
    for text in [moving, block(faces, "")] {
        let mut trial = Trial::new(&text);
        steps(&mut trial, 5, 1e-3);
        let model: &Model = &trial.model;
        assert_eq!(model.check_state(&trial.state), Ok(()));
        let mut refused = 0;
        let count = trial.state.bodies[0].len();
        for n in (0..count).step_by(7) {
            for damage in [f64::NAN, 1e30] {
                let mut state = trial.state.clone();
                state.bodies[0][n] = damage;
                refused += usize::from(model.check_state(&state).is_err());
            }
        }
        let tried = 2 * count.div_ceil(7);
        assert!(refused * 10 >= tried * 9, "{refused} of {tried}");
        let mut short = trial.state.clone();
        short.bodies[0].pop();
        assert!(model.check_state(&short).is_err());
    }
}

/// Faces that rest on the plane touch it by rounding, an energy that was there at the start.
#[test]
fn states_at_rest_on_the_plane_are_accepted() {
    for mechanics in ["fem", "rkpm", "efg", "sph"] {
        let keys = "shape = { box = [6e-3, 4e-3, 5e-3] }\nmesh = { spacing = 1e-3 }";
        let text = gel(&format!("{keys}\ninertia = true\nmechanics = \"{mechanics}\""));
        let mut trial = Trial::new(&text);
        for n in 0..3 {
            assert_eq!(trial.model.check_state(&trial.state), Ok(()), "{mechanics}: {n} steps");
            trial.step(1e-4);
        }
    }
}

/// Nothing gives a body momentum along z: what it has is rounding. Momentum of a node is none.
#[test]
fn states_without_momentum_along_z_are_accepted() {
    let flies = "start = { velocity = [1.0, 0.0, 0.0], height = 0.03 }\nsymmetry = \"none\"";
    let flies = gel(&format!("{BALL}\n{flies}").replace("2e-3", "4e-3"));
    let block =
        "shape = { box = [10e-3, 10e-3, 10e-3] }\nmesh = { spacing = 4e-3 }\ninertia = true";
    let keys = "motion = \"explicit\"\nstart = { height = 0.03 }\nfaces = { top = { temperature = 393.15 } }";
    let warms = gel(&format!("{block}\n{keys}"));
    let warms = warms.replace("poisson = 0.4", "poisson = 0.4, expansion = 1e-4");
    for (text, dt) in [(flies, 1e-3), (warms, 0.05)] {
        let mut trial = Trial::new(&text);
        for n in 0..3 {
            assert_eq!(trial.model.check_state(&trial.state), Ok(()), "{n} steps of {text}");
            trial.step(dt);
        }
        let count = trial.state.bodies[0].len();
        let own = &trial.state.bodies[0];
        let Some(first) = (0..count).find(|&n| (own[n] - 1.0).abs() < 1e-9) else { continue };
        let mut forged = trial.state.clone();
        forged.bodies[0][first + 2] = 0.1;
        let refusal = trial.model.check_state(&forged).unwrap_err().to_string();
        assert!(refusal.contains("momentum along z"), "{refusal}");
    }
}

/// A quarter of a body that moves by explicit steps may pass its planes, too.
#[test]
fn nodes_beyond_a_plane_of_symmetry_are_warned_of() {
    let trial = Trial::new(&gel(&format!("{BALL}\n{FALLS}\nsymmetry = \"quarter\"")));
    let is_warned = |state: &impinge::model::State| {
        let found = trial.model.warnings(state);
        found.iter().any(|own| own.finding().id == "body_is_through_its_mirror")
    };
    assert!(!is_warned(&trial.state));
    // Nine numbers of the whole body come before the displacements.
    let through = |node: usize| {
        let mut state = trial.state.clone();
        state.bodies[0][9 + 3 * node] = -0.1;
        is_warned(&state)
    };
    assert!((0..5).any(through));
}

#[test]
fn what_tears_a_mesh_is_refused_and_changes_nothing() {
    let text = gel(&format!("{BALL}\nstart = {{ velocity = [0.0, 0.0, -60.0] }}"));
    let mut trial = Trial::new(&text);
    let before = trial.state.clone();
    let refused = trial.try_step(1e-2).unwrap_err().to_string();
    assert!(refused.contains("gel") && refused.contains("turned inside out"), "{refused}");
    assert_eq!(trial.state, before);
    let scene = scene::parse(&text, "scene").unwrap();
    assert_eq!(scene.large_strains().count(), 1);
}

const BLOCK_ON_PLANE: &str = "shape = { box = [12e-3, 8e-3, 6e-3] }\ninertia = true\ngravity = 9.81\nmesh = { spacing = 3e-3 }\n\
                              start = { velocity = [0.5, 0.0, 0.0] }";

/// A block is slowed by μ g until it rests; what it had goes into heat, and its momentum into the plane.
#[test]
fn blocks_slide_as_far_as_friction_lets_them() {
    for (keys, friction) in [("", 0.4), ("dimension = 2", 0.2), ("mechanics = \"sph\"", 0.3)] {
        let text = gel(&format!("{BLOCK_ON_PLANE}\n{keys}\nfriction = {friction:?}"));
        let mut trial = Trial::new(&text.replace("young = 5600.0", "young = 1e6"));
        let [mass, kinetic] = ["mass", "kinetic"].map(|key| trial.get(&format!("gel.{key}")));
        let deceleration = friction * 9.81;
        let until = 0.5 / deceleration;
        // Half of the time, in which it hops by fractions of a micrometre, and long after the end.
        trial.step(0.5 * until);
        let [speed, along, down] = ["momentum_x", "impulse_x", "impulse_z"]
            .map(|key| trial.get(&format!("gel.{key}")) / mass);
        assert!(off(along, -friction * down) < 0.002, "{keys}: {along} {down} m/s");
        assert!(off(speed, 0.25) < 0.03, "{keys}: {speed} m/s");
        trial.step(1.5 * until);
        let [momentum, impulse, heat, left, stored] =
            ["momentum_x", "impulse_x", "friction_heat", "kinetic", "stored"]
                .map(|key| trial.get(&format!("gel.{key}")));
        assert!((momentum + impulse - 0.5 * mass).abs() < 1e-9 * mass, "{keys}");
        assert!(momentum.abs() < 0.02 * 0.5 * mass, "{keys}: {momentum} N s");
        assert!(off(heat, kinetic) < 0.03, "{keys}: {heat} J of {kinetic} J");
        let fallen = mass * 9.81 * (3e-3 - trial.get("gel.centre_z"));
        let missing = heat + left + stored - kinetic - fallen;
        assert!(missing.abs() < 0.01 * kinetic, "{keys}: {missing} J of {kinetic} J");
        trial.model.check_state(&trial.state).unwrap();
    }
}

/// Whatever the friction, what a block that hops and tips loses is heat.
#[test]
fn energy_balances_with_any_friction() {
    for friction in [0.6, 3.0, 10.0] {
        let text = gel(&format!(
            "shape = {{ box = [20e-3, 16e-3, 8e-3] }}\ninertia = true\ngravity = 9.81\nmesh = {{ spacing = 2e-3 }}\n\
             start = {{ velocity = [0.5, 0.0, 0.0] }}\nfriction = {friction:?}"
        ));
        let mut trial = Trial::new(&text.replace("young = 5600.0", "young = 2e5"));
        let [mass, kinetic] = ["mass", "kinetic"].map(|key| trial.get(&format!("gel.{key}")));
        steps(&mut trial, 5, 0.03);
        let [heat, left, stored, dissipated] = ["friction_heat", "kinetic", "stored", "dissipated"]
            .map(|key| trial.get(&format!("gel.{key}")));
        let fallen = mass * 9.81 * (4e-3 - trial.get("gel.centre_z"));
        let missing = heat + left + stored + dissipated - kinetic - fallen;
        // What steps miss of the contact's springs as points land and come off.
        assert!(missing.abs() < 5e-3 * kinetic, "{friction}: {missing} J of {kinetic} J");
        assert!(heat > 0.3 * kinetic, "{friction}: {heat} J of {kinetic} J");
        trial.model.check_state(&trial.state).unwrap();
    }
}

/// A cylinder that slides without spin rolls at two thirds of its speed in the end, whatever the friction; a third of its
/// energy is heat.
#[test]
fn cylinders_begin_to_roll() {
    for friction in [0.1, 0.3] {
        let text = gel(&format!(
            "shape = {{ ball = {{ radius = 10e-3 }} }}\ninertia = true\ndimension = 2\ngravity = 9.81\n\
             mesh = {{ spacing = 1.5e-3 }}\nstart = {{ velocity = [0.3, 0.0, 0.0] }}\nfriction = {friction:?}"
        ));
        let mut trial = Trial::new(&text.replace("young = 5600.0", "young = 1e6"));
        let [mass, kinetic] = ["mass", "kinetic"].map(|key| trial.get(&format!("gel.{key}")));
        trial.step(1.5 * 0.3 / (3.0 * friction * 9.81));
        let speed = trial.get("gel.momentum_x") / mass;
        assert!(off(speed, 0.2) < 0.02, "{friction}: {speed} m/s");
        let heat = trial.get("gel.friction_heat");
        assert!(off(heat, kinetic / 3.0) < 0.05, "{friction}: {heat} J of {kinetic} J");
    }
}

/// The plate below a block that slides bears its shear, and states continue to the bit while it does.
#[test]
fn plates_bear_the_friction_of_what_slides_on_them() {
    let text = format!(
        "{}\n[body.plate]\nkind = \"solid\"\nshape = {{ box = [60e-3, 40e-3, 1e-3] }}\nmaterial = \"alumina\"\n\
         initial_temperature = 293.15\nmesh = {{ spacing = 1.5e-3, depth_spacing = 0.25e-3 }}\nfaces = {{ bottom = {{ clamped = true }} }}\n\
         [[coupling]]\nfrom = \"gel\"\nto = \"plate.top\"\ninterval = 2e-3\n\
         [[field]]\nname = \"below\"\nin = \"plate\"\nplane = {{ z = -0.5e-3 }}\ngrid = [61, 41]\ngives = [\"stress\"]\n",
        gel(&format!("{BLOCK_ON_PLANE}\nfriction = 0.5"))
            .replace("young = 5600.0", "young = 1e5")
            .replace("[0.5, 0.0, 0.0]", "[0.05, 0.0, 0.0]")
    );
    let mut trial = Trial::new(&text);
    trial.step(4e-3);
    let before = trial.get("gel.impulse_x");
    let state = trial.state.clone();
    trial.step(2e-3);
    let force = (trial.get("gel.impulse_x") - before) / 2e-3;
    // What crosses the middle of the plate, by the trapezoidal rule; its stress vanishes towards the edges.
    let places = (1..=61).flat_map(|i| (1..=41).map(move |j| format!("below.stress_xz[{i},{j}]")));
    let borne: f64 = places.map(|name| trial.get(&name) * 1e-6).sum();
    assert!(force > 0.0 && off(borne, force) < 0.05, "{borne} N, not {force} N");
    let end = trial.state.bodies.clone();
    trial.restart(&state);
    trial.step(2e-3);
    assert!(trial.state.bodies == end);
}

#[test]
fn friction_is_that_of_bodies_above_something() {
    for keys in ["", "inertia = true\nmotion = \"implicit\""] {
        let text =
            block("faces = { bottom = { clamped = true } }", &format!("{keys}\nfriction = 0.3"));
        let refusal = scene::parse(&text, "gel.toml").unwrap_err().to_string();
        assert!(refusal.contains("rubs on nothing"), "{refusal}");
    }
}

#[test]
fn notes_tell_how_bodies_slide() {
    let notes = |keys: &str| {
        let scene = scene::parse(&gel(&format!("{BALL}\n{keys}")), "scene.toml").unwrap();
        LargeStrainForecast::of(&scene, "gel", scene.large_strain("gel").unwrap()).notes
    };
    let says = |notes: &[String], words: &str| notes.iter().any(|note| note.contains(words));
    let (free, zero, rubs) = (notes(""), notes("friction = 0.0"), notes("friction = 0.3"));
    assert!(says(&free, "slides on what lies below without friction"), "{free:?}");
    assert_eq!(free, zero);
    assert!(says(&rubs, "rubs on what lies below with a coefficient of friction of 0.3"));
    assert!(!says(&rubs, "without friction"), "{rubs:?}");
}

/// Constants that a substance brings along, or that another body has a use for, are not refused.
#[test]
fn constants_of_substances_may_be_idle() {
    let own = r#"material = { model = "neo_hookean", density = 1000.0, specific_heat = 4180.0, conductivity = 0.6, young = 5600.0, poisson = 0.4 }"#;
    for substance in ["soda-lime-glass", "tin"] {
        let material =
            format!(r#"material = {{ substance = "{substance}", model = "neo_hookean" }}"#);
        let text = gel(&format!("{BALL}\n{FALLS}")).replace(own, &material);
        let read = scene::parse(&text, "scene.toml").unwrap();
        // The scene is written with all constants where parameters change.
        scene::check(&read).unwrap();
    }
    let text = gel(&format!("{BALL}\n{FALLS}")).replace(own, r#"material = "glass""#);
    let plate = r#"
[material.glass]
model = "neo_hookean"
density = 2500.0
specific_heat = 800.0
conductivity = 1.0
young = 7e10
poisson = 0.22
expansion = 9e-6
[body.pad]
kind = "solid"
strain = "finite"
initial_temperature = 293.15
material = "glass"
shape = { box = [1e-2, 1e-2, 1e-2] }
faces.top = { clamped = true }
"#;
    assert!(scene::parse(&(text.clone() + plate), "scene.toml").is_ok());
    let alone = plate.split("[body.pad]").next().unwrap();
    let refusal = scene::parse(&(text + alone), "scene.toml").unwrap_err().to_string();
    assert!(refusal.contains("nothing expands"), "{refusal}");
}
