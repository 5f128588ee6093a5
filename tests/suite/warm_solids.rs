//! Solids of large strain that conduct heat, deform by it, and warm what they touch.

use std::f64::consts::PI;

use impinge::advice::parse_with_warnings;
use impinge::closed_form::{
    Conductor, Contact, ConvectiveSlab, ResistiveContact, Rubber, ShockedHalfSpace, Sides,
};
use impinge::scene;
use impinge::warning::Warning;

use crate::common::{Trial, off};
use crate::driven_solids::rubber;

/// A scene of one body with further keys.
fn scene(material: &str, keys: &str) -> String {
    format!(
        r#"
name = "Warm"
stop_time = 1.0
step = 1e-2
[body.pad]
kind = "solid"
strain = "finite"
initial_temperature = 300.0
material = {{ model = "neo_hookean", {material} }}
{keys}
"#
    )
}

fn probe(name: &str, at: [f64; 3]) -> String {
    let gives = r#"["temperature", "displacement", "stress"]"#;
    format!("[[probe]]\nname = \"{name}\"\nin = \"pad\"\nat = {at:?}\ngives = {gives}\n")
}

/// Diffusivity 1 in units of the body, and a small expansion.
const UNIT: &str = "density = 1.0, specific_heat = 1.0, conductivity = 1.0, expansion = 1e-7";
const METHODS: [&str; 4] =
    ["", "mechanics = \"rkpm\"", "mechanics = \"efg\"", "mechanics = \"sph\""];

/// Heat in, stored and lost, and to the body below, balance.
fn balances(trial: &mut Trial, tolerance: f64) {
    let [stored, came, lost] =
        ["heat_stored", "heat_in", "heat_lost"].map(|key| trial.get(&format!("pad.{key}")));
    let scale = stored.abs() + came.abs() + lost.abs();
    assert!((stored - came + lost).abs() <= tolerance * scale, "{stored} {came} {lost}");
}

#[test]
fn quasi_static_danilovskaya_rod() {
    // Tip displacement over that in the end, without inertia: 1 − Σ 8/((2n−1)²π²) e^{−(2n−1)²π²τ/4}.
    let table =
        [(0.01, 0.112838), (0.1, 0.356823), (0.2, 0.504088), (0.5, 0.763950), (1.0, 0.931260)];
    let faces = "faces = { bottom = { roller = true }, sides = { roller = true }, top = { temperature = 400.0 } }";
    for (method, spacing) in METHODS.into_iter().zip([0.01, 0.025, 0.025, 0.025]) {
        let keys = format!(
            "shape = {{ box = [{}, 1.0, 1.0] }}\ndimension = 2\nmesh = {{ spacing = {spacing} }}\n{method}\n{faces}",
            2.0 * spacing
        );
        let text = scene(&format!("{UNIT}, young = 1.0, poisson = 0.25"), &keys);
        let mut trial = Trial::new(&format!("{text}{}", probe("tip", [0.0, 0.0, 0.0])));
        // In uniaxial strain the rod ends (1 + ν)/(1 − ν) times longer than a free one.
        let end = 1.25 / 0.75 * 1e-7 * 100.0;
        let mut before = 0.0;
        assert_eq!(trial.get("tip.temperature"), 400.0);
        for (time, expected) in table {
            trial.step(time - before);
            before = time;
            let found = trial.get("tip.displacement_z") / end;
            let tolerance = if time < 0.05 && !method.is_empty() { 5e-3 } else { 1e-3 };
            assert!(off(found, expected) < tolerance, "{method} {time} {found} {expected}");
            balances(&mut trial, 1e-10);
        }
        assert_eq!(trial.get("pad.heat_in"), 0.0);
    }
}

#[test]
fn danilovskaya_rod_with_inertia() {
    // A free rod of two halves, each a rod that is held at its base, from R = c h/κ and τ = κt/h². Poisson's ratio is 0,
    // so sides are free. With R = 100
    // a front, as long as κ/c, has come to the middle then.
    for (ratio, spacing, table) in [
        (10.0, 0.025, &[(0.1, 0.273_88), (0.5, 0.669_64)][..]),
        (100.0, 0.005, &[(0.01, 0.103_39)]),
    ] {
        let keys = format!(
            "shape = {{ box = [{}, 1.0, 2.0] }}\ndimension = 2\ninertia = true\nmesh = {{ spacing = {spacing} }}\n\
             start = {{ height = 1.0 }}\nfaces = {{ bottom = {{ temperature = 400.0 }}, top = {{ temperature = 400.0 }} }}",
            2.0 * spacing
        );
        let material = format!(
            "density = 1.0, specific_heat = 1.0, conductivity = {}, expansion = 1e-7, young = 1.0, poisson = 0.0",
            1.0 / ratio
        );
        let mut trial = Trial::new(&scene(&material, &keys));
        for &(scaled, expected) in table {
            let time = scaled * ratio;
            while trial.state.time < time - 1e-9 {
                trial.step(0.0125);
            }
            let found = (trial.get("pad.height") - 2.0) / (2.0 * 1e-7 * 100.0);
            println!("Danilovskaya, {ratio} {scaled}: {found} {expected}");
            assert!(off(found, expected) < 0.01, "{ratio} {scaled} {found} {expected}");
            balances(&mut trial, 1e-10);
        }
        // Thermal stretches have made the energy that is there.
        let energy = trial.get("pad.stored") + trial.get("pad.kinetic");
        assert!(trial.get("pad.dissipated").abs() < 1e-2 * energy, "{energy}");
    }
}

/// A front of stress leaves the end of a rod that is suddenly warm, over 200 nodes: it is where sound is, and its jump
/// is whole.
#[test]
fn a_warm_end_sends_a_front() {
    let space = ShockedHalfSpace { speed: 1.0, diffusivity: 1.0 };
    let [spacing, now] = [0.02, 2.0];
    let material = "density = 1.0, specific_heat = 1.0, conductivity = 1.0, expansion = 1e-7, young = 1.0, poisson = 0.0";
    for (method, reach) in [("", 1.0), ("mechanics = \"sph\"", 1.3)] {
        let keys = format!(
            "shape = {{ box = [{}, 1.0, 4.0] }}\ndimension = 2\ninertia = true\nmesh = {{ spacing = {spacing} }}\n\
             start = {{ height = 1.0 }}\nfaces = {{ top = {{ temperature = 400.0 }} }}\n{method}",
            2.0 * spacing
        );
        let depths: Vec<f64> = (80..120).map(|n| spacing * (f64::from(n) + 0.5)).collect();
        let named = |n: usize| format!("at{n}");
        let probes = depths.iter().enumerate().map(|(n, z)| probe(&named(n), [0.0, 0.0, -z]));
        let mut trial = Trial::new(&(scene(material, &keys) + &probes.collect::<String>()));
        (0..200).for_each(|_| trial.step(now / 200.0));
        // What the front leaves of the stress: e^{τ−ξ} behind it, nothing ahead.
        let mut jump = |n: usize| {
            let stress = trial.get(&format!("{}.stress_zz", named(n))) / (1e-7 * 100.0);
            stress - space.continuous_stress(depths[n], now)
        };
        let jumps: Vec<f64> = (0..depths.len()).map(&mut jump).collect();
        // Waves that a mesh delays swing about the jump: their mean over a distance behind it.
        let behind: Vec<f64> = (0..15).map(|n| jumps[n] * (depths[n] - now).exp()).collect();
        let mean = behind.iter().sum::<f64>() / behind.len() as f64;
        assert!((mean - 1.0).abs() < 0.05, "{method}: {mean}");
        assert!(jumps[30..].iter().all(|own| own.abs() < 0.02), "{method}: {jumps:?}");
        let last = (0..depths.len() - 1).rfind(|&n| jumps[n] > 0.5).unwrap();
        let part = (jumps[last] - 0.5) / (jumps[last] - jumps[last + 1]);
        let front = depths[last] + part * spacing;
        println!("front, {method}: {front}, jump {mean}");
        assert!((front - now).abs() < reach * spacing, "{method}: {front}");
    }
}

#[test]
fn fluxes_and_films_follow_closed_forms() {
    for method in METHODS {
        let faces = "faces = { bottom = { roller = true }, top = { flux = 3.0 } }";
        let keys = format!(
            "shape = {{ box = [0.1, 1.0, 1.0] }}\ndimension = 2\nmesh = {{ spacing = 0.05 }}\n{method}\nsymmetry = \"quarter\"\n{faces}"
        );
        let text = scene(&format!("{UNIT}, young = 1.0, poisson = 0.25"), &keys);
        let text = format!("{text}{}{}", probe("top", [0.0; 3]), probe("base", [0.0, 0.0, -1.0]));
        let mut trial = Trial::new(&text);
        (0..20).for_each(|_| trial.step(0.1));
        // Heat per metre of depth; in the end the profile is a parabola of q h/(2 k).
        assert!(off(trial.get("pad.heat_in"), 3.0 * 0.1 * 2.0) < 1e-5, "{method}");
        assert!(off(trial.get("pad.mean_temperature") - 300.0, 6.0) < 1e-5);
        let rise = trial.get("top.temperature") - trial.get("base.temperature");
        assert!(off(rise, 1.5) < 5e-3, "{method} {rise}");
        balances(&mut trial, 1e-10);

        let warm =
            text.replace("flux = 3.0", "convection = { coefficient = 2.0, ambient = 310.0 }");
        let mut trial = Trial::new(&warm);
        trial.set("pad.top.ambient", 320.0);
        (0..10).for_each(|_| trial.step(0.1));
        let body = Conductor { conductivity: 1.0, heat_capacity: 1.0 };
        let slab = ConvectiveSlab { body, thickness: 1.0, coefficient: 2.0, ambient: 20.0 };
        for (name, depth) in [("top", 0.0), ("base", 1.0)] {
            let (found, expected) =
                (trial.get(&format!("{name}.temperature")) - 300.0, slab.rise(depth, 1.0));
            assert!(off(found, expected) < 2e-3, "{method} {found} {expected}");
        }
        balances(&mut trial, 1e-10);
    }
}

#[test]
fn pressed_bodies_conduct_as_high_as_they_are() {
    let faces = "faces = { bottom = { roller = true, temperature = 300.0 }, \
                 top = { roller = true, displacement = [0.0, 0.0, 0.0], flux = 2.0 } }";
    let material =
        "density = 1.0, specific_heat = 1.0, conductivity = 1.0, young = 1.0, poisson = 0.3";
    for method in METHODS {
        let keys = format!(
            "shape = {{ box = [1.0, 1.0, 1.0] }}\nmesh = {{ spacing = 0.25 }}\n{method}\n\
             symmetry = \"quarter\"\n{faces}"
        );
        let text = format!("{}{}", scene(material, &keys), probe("top", [0.2, 0.1, 0.0]));
        let mut trial = Trial::new(&text);
        for height in [1.0, 0.5, 1.5] {
            trial.set("pad.top.displacement_z", height - 1.0);
            (0..3).for_each(|_| trial.step(100.0));
            let rise = trial.get("top.temperature") - 300.0;
            assert!(off(rise, 2.0 * height) < 1e-4, "{method} {height} {rise}");
        }
        balances(&mut trial, 1e-9);
    }
}

#[test]
fn free_bodies_warm_without_stress() {
    let film = "convection = { coefficient = 50.0, ambient = 400.0 }";
    for (shape, method) in [
        ("box = [1.0, 0.8, 0.6]", ""),
        ("box = [1.0, 0.8, 0.6]", "mechanics = \"rkpm\""),
        ("disc = { radius = 0.5, thickness = 0.5 }", ""),
        ("disc = { radius = 0.5, thickness = 0.5 }", "mechanics = \"sph\""),
    ] {
        let faces = format!(
            "faces = {{ bottom = {{ roller = true, {film} }}, top = {{ {film} }}, sides = {{ {film} }} }}"
        );
        let symmetry = if shape.starts_with("box") { "symmetry = \"quarter\"" } else { "" };
        let keys = format!(
            "shape = {{ {shape} }}\nmesh = {{ spacing = 0.2 }}\n{method}\n{symmetry}\n{faces}"
        );
        let material = "density = 1.0, specific_heat = 1.0, conductivity = 1.0, expansion = 1e-3, young = 1.0, poisson = 0.3";
        let mut trial = Trial::new(&scene(material, &keys));
        let height = trial.get("pad.height");
        trial.step(0.02);
        assert!(trial.get("pad.max_von_mises") > 1e-4, "{method}");
        (0..4).for_each(|_| trial.step(10.0));
        assert!(trial.get("pad.max_von_mises") < 1e-8, "{method}");
        assert!(off(trial.get("pad.height"), 1.1 * height) < 1e-8, "{method}");
        assert!(off(trial.get("pad.max_temperature"), 400.0) < 1e-9);
        balances(&mut trial, 1e-9);
    }
}

#[test]
fn curvature_of_a_strip_between_two_temperatures() {
    let faces = "faces = { left = { clamped = true }, top = { temperature = 310.0 }, bottom = { temperature = 290.0 } }";
    for (method, tolerance) in
        [("", 0.02), ("mechanics = \"rkpm\"", 2e-3), ("mechanics = \"efg\"", 2e-3)]
    {
        let keys = format!(
            "shape = {{ box = [10.0, 1.0, 1.0] }}\ndimension = 2\nmesh = {{ spacing = 0.125 }}\n{method}\n{faces}"
        );
        let material = "density = 1.0, specific_heat = 1.0, conductivity = 1.0, expansion = 1e-5, young = 1.0, poisson = 0.3";
        let mut trial = Trial::new(&scene(material, &keys));
        (0..3).for_each(|_| trial.step(1.0));
        // Warmer above: the ends turn down, in plane strain by 1 + ν more.
        let expected = -1.3 * 1e-5 * 20.0;
        let found = trial.get("pad.curvature");
        assert!(off(found, expected) < tolerance, "{method} {found} {expected}");
    }
}

/// A disc of gel that is pressed on a plate of glass.
fn on_plate(shape: &str, keys: &str, coupling: &str) -> String {
    let own = format!(
        "shape = {{ disc = {{ radius = 0.2e-3, thickness = 60e-6 }} }}\ninertia = true\nmesh = {{ spacing = 6e-6 }}\n\
         faces = {{ top = {{ pressure = 0.0 }} }}\n{keys}"
    );
    let gel =
        "density = 1050.0, specific_heat = 4000.0, conductivity = 0.5, young = 20e3, poisson = 0.3";
    format!(
        r#"{}
[body.plate]
kind = "solid"
shape = {{ {shape} }}
material = {{ model = "thermoelastic", density = 2500.0, specific_heat = 840.0, conductivity = 1.1, young = 70e9, poisson = 0.22 }}
initial_temperature = 350.0
mesh = {{ spacing = 3e-6 }}
faces = {{ bottom = {{ clamped = true }} }}
[[coupling]]
from = "pad"
to = "plate.top"
interval = 2e-5
{coupling}
[[probe]]
name = "below"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#,
        scene(gel, &own)
    )
}

#[test]
fn a_gel_on_a_plate_takes_its_heat() {
    let disc = "disc = { radius = 0.4e-3, thickness = 0.1e-3 }";
    let conductance = 2e4;
    let text = on_plate(disc, "", &format!("conductance = {conductance:e}"));
    let mut trial = Trial::new(&format!("{text}{}", probe("above", [0.0, 0.0, -60e-6])));
    let (duration, steps) = (6e-4_f64, 6);
    for n in 0..steps {
        // A pressure that grows evenly keeps the gel on the plate while it swings.
        let rate = 200.0 / duration;
        trial.set("pad.top.pressure", rate * duration * f64::from(n) / f64::from(steps));
        trial.set_derivative("pad.top.pressure", 1, rate);
        trial.step(duration / f64::from(steps));
    }
    let [given, stored, plate] =
        ["pad.heat", "pad.heat_stored", "plate.heat_stored"].map(|key| trial.get(key));
    assert!(given < 0.0 && (given + stored).abs() < 1e-12 * stored, "{given} {stored}");
    assert!((plate - given).abs() < 1e-12 * stored, "{given} {plate}");
    assert!((trial.get("plate.heat_in") - given).abs() < 1e-12 * stored);
    let gel = Conductor { conductivity: 0.5, heat_capacity: 1050.0 * 4000.0 };
    let glass = Conductor { conductivity: 1.1, heat_capacity: 2500.0 * 840.0 };
    let bodies =
        Contact { first: glass, first_temperature: 350.0, second: gel, second_temperature: 300.0 };
    let contact = ResistiveContact { bodies, conductance };
    let per_area = -given / (PI * 0.2e-3_f64.powi(2));
    assert!(off(per_area, contact.heat(duration)) < 0.03, "{per_area}");
    let [below, above] = contact.surfaces(duration);
    let found = [trial.get("below.temperature"), trial.get("above.temperature")];
    assert!((found[0] - below).abs() < 1.0 && (found[1] - above).abs() < 1.0, "{found:?}");
}

#[test]
fn parts_of_a_gel_pass_the_same_heat() {
    let square = "box = [0.6e-3, 0.6e-3, 0.1e-3]";
    let heat = |keys: &str| {
        let text = on_plate(square, keys, "conductance = 2e4")
            .replace("pressure = 0.0", "pressure = 200.0")
            .replace("spacing = 6e-6", "spacing = 30e-6")
            .replace("spacing = 3e-6", "spacing = 30e-6");
        let mut trial = Trial::new(&text);
        (0..3).for_each(|_| trial.step(1e-4));
        let [given, plate] = ["pad.heat", "plate.heat_in"].map(|key| trial.get(key));
        assert!((plate - given).abs() < 1e-12 * given.abs(), "{keys} {given} {plate}");
        given
    };
    let whole = heat("symmetry = \"none\"");
    assert!(off(heat("symmetry = \"quarter\""), whole) < 1e-9);
    assert!(off(heat(""), whole) < 0.05);
}

#[test]
fn warm_states_continue_bit_for_bit() {
    let disc = "disc = { radius = 0.4e-3, thickness = 0.1e-3 }";
    let coarse = on_plate(disc, "", "conductance = 2e4")
        .replace("pressure = 0.0", "pressure = 200.0")
        .replace("spacing = 6e-6", "spacing = 20e-6")
        .replace("spacing = 3e-6", "spacing = 20e-6");
    let faces = "faces = { bottom = { clamped = true, temperature = 350.0 }, top = { flux = 2.0, pressure = 0.1 } }";
    let resting = scene(
        &format!("{UNIT}, young = 1.0, poisson = 0.25"),
        &format!("shape = {{ box = [1.0, 1.0, 1.0] }}\nmesh = {{ spacing = 0.25 }}\n{faces}"),
    );
    for (text, dt) in [(coarse, 1e-4), (resting, 0.1)] {
        let mut one = Trial::on_threads(&text, 1);
        let mut two = Trial::on_threads(&text, 3);
        (0..2).for_each(|_| one.step(dt));
        (0..2).for_each(|_| two.step(dt));
        assert_eq!(one.state, two.state);
        let saved = one.state.clone();
        assert_eq!(one.model.check_state(&saved), Ok(()));
        (0..2).for_each(|_| one.step(dt));
        two.restart(&saved);
        (0..2).for_each(|_| two.step(dt));
        assert_eq!(one.state, two.state);
        let count = one.state.bodies[0].len();
        let mut refused = 0;
        for n in (0..count).step_by(7) {
            let mut damaged = one.state.clone();
            damaged.bodies[0][n] = 1e30;
            refused += usize::from(one.model.check_state(&damaged).is_err());
        }
        let tried = count.div_ceil(7);
        assert!(refused * 20 >= tried * 17, "{refused} of {tried}");
    }
}

#[test]
fn temperatures_below_absolute_zero_are_refused() {
    let faces = "faces = { bottom = { clamped = true }, top = { flux = -1e6 } }";
    let keys = format!("shape = {{ box = [1.0, 1.0, 1.0] }}\nmesh = {{ spacing = 0.25 }}\n{faces}");
    let mut trial = Trial::new(&scene(&format!("{UNIT}, young = 1.0, poisson = 0.25"), &keys));
    let before = trial.state.clone();
    let refused = trial.try_step(1.0).unwrap_err().to_string();
    assert!(refused.contains("pad") && refused.contains("absolute zero"), "{refused}");
    assert_eq!(trial.state, before);

    let text = scene(&format!("{UNIT}, young = 1.0, poisson = 0.25"), &keys)
        .replace("flux = -1e6", "temperature = 300.0");
    let mut trial = Trial::new(&text);
    trial.set("pad.top.temperature", -5.0);
    let refused = trial.try_step(1.0).unwrap_err().to_string();
    assert!(refused.contains("-5 K is not above absolute zero"), "{refused}");
}

#[test]
fn heat_is_a_matter_of_conditions() {
    let keys = "shape = { box = [1.0, 1.0, 1.0] }\nfaces = { bottom = { clamped = true } }";
    let text = scene(&format!("{UNIT}, young = 1.0, poisson = 0.25"), keys);
    let conducts = |text: &str| {
        let scene = scene::parse(text, "scene").unwrap();
        scene.large_strains().next().unwrap().1.conducts()
    };
    assert!(!conducts(&text));
    assert!(conducts(&text.replace("clamped = true", "clamped = true, temperature = 300.0")));
}

#[test]
fn fields_have_the_values_of_probes() {
    let faces = "faces = { bottom = { clamped = true, temperature = 350.0 }, top = { pressure = 0.1, flux = 2.0 } }";
    let gives = r#"gives = ["temperature", "displacement", "stress"]"#;
    for (shape, keys, field, points) in [
        (
            "box = [1.0, 0.8, 0.6]",
            "symmetry = \"quarter\"",
            "on = \"pad.top\"",
            [[-0.25, -0.2, 0.0], [-0.25, 0.2, 0.0], [0.25, -0.2, 0.0], [0.25, 0.2, 0.0]],
        ),
        (
            "disc = { radius = 0.5, thickness = 0.6 }",
            "mechanics = \"rkpm\"\nrkpm = { integration = \"scni\" }",
            "in = \"pad\"\nplane = { y = 0.0 }",
            [[-0.25, 0.0, -0.45], [-0.25, 0.0, -0.15], [0.25, 0.0, -0.45], [0.25, 0.0, -0.15]],
        ),
    ] {
        let keys = format!("shape = {{ {shape} }}\nmesh = {{ spacing = 0.1 }}\n{keys}\n{faces}");
        let mut text = scene(&format!("{UNIT}, young = 1.0, poisson = 0.25"), &keys);
        text += &format!("[[field]]\nname = \"grid\"\n{field}\ngrid = [2, 2]\n{gives}\n");
        if shape.starts_with("disc") {
            text = text.replace("grid = [2, 2]", "grid = [2, 2]\nsize = [1.0, 0.6]");
        }
        for (n, at) in points.into_iter().enumerate() {
            text += &probe(&format!("probe{n}"), at);
        }
        let mut trial = Trial::new(&text);
        trial.step(0.05);
        for (n, index) in ["1,1", "1,2", "2,1", "2,2"].into_iter().enumerate() {
            for key in ["temperature", "displacement_x", "displacement_z", "stress_zz", "stress_xz"]
            {
                let [field, probe] = [format!("grid.{key}[{index}]"), format!("probe{n}.{key}")];
                let [field, probe] = [field, probe].map(|name| trial.get(&name));
                assert!(
                    (field - probe).abs() <= 1e-12 * probe.abs(),
                    "{key} {index} {field} {probe}"
                );
                assert!(probe != 0.0, "{key}");
            }
        }
    }
}

/// A gel that is warmer than its plate without a conductance passes no heat, and one whose elements are thicker than
/// what heat penetrates passes too much: `check` warns of both.
#[test]
fn heat_that_does_not_pass_or_is_not_resolved_is_warned_of() {
    let told = |conductance: &str, stop: f64| -> Vec<&'static str> {
        let text = format!(
            "name = \"Drop\"\nstop_time = {stop:?}\nstep = 1e-3\n[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\n\
             inertia = true\nshape = {{ ball = {{ radius = 5e-3 }} }}\ninitial_temperature = 340.0\ngravity = 9.81\n\
             material = {{ model = \"neo_hookean\", density = 1000.0, specific_heat = 4180.0, conductivity = 0.6, \
             young = 2e4, poisson = 0.4 }}\n[body.plate]\nkind = \"solid\"\nshape = {{ box = [30e-3, 30e-3, 3e-3] }}\n\
             material = \"soda-lime-glass\"\ninitial_temperature = 300.0\nfaces = {{ bottom = {{ clamped = true }} }}\n\
             [[coupling]]\nfrom = \"gel\"\nto = \"plate.top\"\n{conductance}\n"
        );
        let (_, found) = impinge::advice::parse_with_warnings(&text, "scene.toml").unwrap();
        found.iter().map(|warning| warning.finding().id).collect()
    };
    assert!(told("", 0.02).contains(&"no_heat_passes"));
    assert!(told("conductance = 1e5", 0.02).contains(&"warm_layer_unresolved"));
    for (conductance, stop) in [("conductance = 100.0", 0.02), ("conductance = 1e5", 1e3)] {
        assert_eq!(told(conductance, stop), [""; 0], "{conductance} {stop}");
    }
}

/// Fluxes that no solid bears are warned of before a run, and temperatures beyond a substance's range during it.
#[test]
fn overheated_bodies_are_warned_of() {
    let text = scene("X", "").replace(
        "{ model = \"neo_hookean\", X }",
        "{ model = \"neo_hookean\", substance = \"pdms\" }",
    );
    let shape = "shape = { box = [10e-3, 1.0, 10e-3] }\ndimension = 2\nmesh = { spacing = 1e-3 }";
    let heated = |flux: f64| {
        let faces =
            format!("faces = {{ bottom = {{ roller = true }}, top = {{ flux = {flux:?} }} }}");
        format!("{text}{shape}\n{faces}\n")
    };
    let ids = |found: Vec<Warning>| found.iter().map(|own| own.finding().id).collect::<Vec<_>>();
    for (flux, checked, warned) in [(1e3, false, false), (4e4, false, true), (1e9, true, true)] {
        let (_, found) = parse_with_warnings(&heated(flux), "scene").unwrap();
        assert_eq!(ids(found).contains(&"flux_overheats_surface"), checked, "{flux}");
        let mut trial = Trial::new(&heated(flux.min(4e4)));
        (0..10).for_each(|_| trial.step(1.0));
        let found = ids(trial.model.warnings(&trial.state));
        let expected: &[&str] = if warned { &["solid_beyond_substance"] } else { &[] };
        assert_eq!(found, expected, "{flux}");
    }
}

/// Temperatures below a substance's range are warned of during a run, at small strain and at large, and those of a bath
/// before it; heating from the end of the range is not.
#[test]
fn undercooled_bodies_are_warned_of() {
    let body = |strain: &str, start: f64, top: &str| {
        format!(
            "name = \"Cold\"\nstop_time = 10.0\nstep = 1.0\n[body.pad]\nkind = \"solid\"\n\
             shape = {{ box = [10e-3, 10e-3, 10e-3] }}\nmesh = {{ spacing = 2e-3 }}\n{strain}\n\
             initial_temperature = {start:?}\nfaces = {{ bottom = {{ roller = true }}, top = {{ {top} }} }}\n"
        )
    };
    let small = "material = \"pdms\"";
    let large = "strain = \"finite\"\nmaterial = { model = \"neo_hookean\", substance = \"pdms\" }";
    for strain in [small, large] {
        // A jump that the mesh does not resolve leaves nodes below their surroundings.
        for (start, top, is_warned) in [
            (300.0, "flux = -5e3", true),
            (300.0, "flux = -10.0", false),
            (293.15, "flux = 4e3", false),
            (293.15, "temperature = 420.0", false),
        ] {
            let mut trial = Trial::new(&body(strain, start, top));
            let mut found = Vec::new();
            for _ in 0..10 {
                trial.step(1.0);
                found.extend(trial.model.warnings(&trial.state));
            }
            let cold = found.iter().any(|own| own.to_string().contains("below the 293 K from"));
            assert_eq!(cold, is_warned, "{strain} {top}: {found:?}");
        }
    }
    let plate = |ambient: f64| {
        let bath = format!(
            "bath = {{ coefficient = 2000.0, ambient = {ambient:?}, speed = 5e-3, depth = 2e-3 }}"
        );
        let text = format!(
            "name = \"Dip\"\nstop_time = 4.0\nstep = 0.2\ncryogenic = true\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [24e-3, 2e-3, 30e-3] }}\ninitial_temperature = 300.0\nmaterial = \"alumina-99\"\n\
             mesh = {{ depth_spacing = 2.5e-3, growth = 1.0 }}\n{bath}\n"
        );
        let (_, found) = parse_with_warnings(&text, "scene").unwrap();
        found.iter().any(|own| own.finding().id == "substance_out_of_range")
    };
    assert_eq!([80.0, 293.0].map(plate), [true, false]);
}

/// Heat passes the shape that a step begins with, where a face that has jumped has drawn it, too.
#[test]
fn flux_enters_through_the_deformed_area() {
    for (stretch, laws) in [(2.0, "0.4999"), (0.5, "0.4999"), (1.5, "0.3")] {
        let drawn = 10e-3 * (stretch - 1.0);
        let faces = format!(
            "faces = {{ bottom = {{ roller = true, temperature = 293.15 }}, \
             top = {{ roller = true, displacement = [0.0, 0.0, {drawn:?}], flux = 100.0 }} }}"
        );
        let shape = "shape = { box = [10e-3, 10e-3, 10e-3] }\nsymmetry = \"quarter\"";
        let text = rubber(&format!("{shape}\nmesh = {{ spacing = 2.5e-3 }}\n{faces}"))
            .replace("poisson = 0.4 ", &format!("poisson = {laws} "));
        let law = Rubber::of_young(1e6, laws.parse().unwrap());
        let lateral = law.lateral(stretch, Sides::Free);
        for parts in [1, 4] {
            let mut trial = Trial::new(&text);
            (0..parts).for_each(|_| trial.step(4.0 / f64::from(parts)));
            let wanted = 4.0 * 100.0 * (10e-3 * lateral).powi(2);
            assert!(off(trial.get("pad.heat_in"), wanted) < 1e-9, "{stretch} in {parts}");
        }
    }
}
