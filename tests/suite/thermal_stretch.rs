//! Solids of large strain that expand, relax faster where it is warm, and bend as layers of them differ.

use impinge::closed_form::{BentLayer, BentStrip, BondedLayer, BondedPlate, Rubber};

use crate::common::{Trial, off, sweep};

fn scene(body: &str) -> String {
    format!(
        r#"
name = "Warm"
stop_time = 10.0
step = 1.0
[body.pad]
kind = "solid"
strain = "finite"
initial_temperature = 300.0
{body}
"#
    )
}

/// A block of rubber with further keys of its material.
fn block(material: &str, faces: &str) -> String {
    scene(&format!(
        "shape = {{ box = [10e-3, 8e-3, 12e-3] }}\nmesh = {{ spacing = 4e-3 }}\nfaces = {{ {faces} }}\n\
         material = {{ density = 1000.0, specific_heat = 2000.0, conductivity = 0.2, young = 5e6, poisson = 0.45, \
         {material} }}"
    ))
}

const RUBBER: &str = "model = \"neo_hookean\", expansion = 2e-3";
const FLAT: &str =
    "top = { roller = true, displacement = [0.0, 0.0, 0.0] }, bottom = { roller = true }";

#[test]
fn temperatures_beyond_a_substance_are_warned_of() {
    let copper = "material = { substance = \"copper\", at = 300.0, model = \"neo_hookean\" }";
    let mut trial = Trial::new(&scene(&format!(
        "shape = {{ box = [10e-3, 8e-3, 12e-3] }}\nmesh = {{ spacing = 4e-3 }}\nfaces = {{ bottom = {{ roller = true \
         }} }}\n{copper}"
    )));
    for (temperature, said) in [(400.0, 0), (1600.0, 1)] {
        trial.set("pad.temperature", temperature);
        trial.step(1.0);
        let found = trial.model.warnings(&trial.state);
        assert_eq!(found.len(), said, "{found:?}");
    }
}

#[test]
fn free_blocks_expand_without_stress() {
    for keys in
        ["", "mechanics = \"rkpm\"", "mechanics = \"efg\"", "mechanics = \"sph\"", "dimension = 2"]
    {
        let mut trial =
            Trial::new(&format!("{}\n{keys}", block(RUBBER, "bottom = { roller = true }")));
        trial.set("pad.temperature", 400.0);
        trial.step(1.0);
        if keys == "dimension = 2" {
            // Held along the third axis.
            assert!(trial.get("pad.height") > 1.2 * 12e-3 && trial.get("pad.max_von_mises") > 1e5);
            continue;
        }
        assert!(off(trial.get("pad.height"), 1.2 * 12e-3) < 1e-9, "{keys}");
        assert!(off(trial.get("pad.width"), 1.2 * 10e-3) < 1e-9, "{keys}");
        assert!(off(trial.get("pad.least_jacobian"), 1.2_f64.powi(3)) < 1e-9, "{keys}");
        assert!(trial.get("pad.max_von_mises") < 1.0 && trial.get("pad.stored").abs() < 1e-12);
    }
}

#[test]
fn blocks_between_plates_press_as_the_closed_form_says() {
    let rubber = Rubber::of_young(5e6, 0.45);
    for temperature in [250.0, 360.0] {
        let free: f64 = 1.0 + 2e-3 * (temperature - 300.0);
        let mut trial = Trial::new(&block(RUBBER, FLAT));
        for stretch in [1.0, 1.3, 0.8] {
            trial.set("pad.temperature", temperature);
            trial.set("pad.top.displacement_z", 12e-3 * (stretch - 1.0));
            // At once, and after a step.
            for _ in 0..2 {
                let elastic = stretch / free;
                let force =
                    80e-6 * free * free * rubber.force(elastic, impinge::closed_form::Sides::Free);
                assert!(off(trial.get("pad.top.force_z"), force) < 1e-8, "{temperature} {stretch}");
                let width =
                    10e-3 * free * rubber.lateral(elastic, impinge::closed_form::Sides::Free);
                assert!(off(trial.get("pad.width"), width) < 1e-8, "{temperature} {stretch}");
                trial.step(1.0);
            }
            let (stored, gone) = (trial.get("pad.stored"), trial.get("pad.dissipated"));
            assert!(gone.abs() < 1e-12 * stored, "{gone} of {stored}");
        }
    }
}

#[test]
fn warm_blocks_relax_in_their_reduced_time() {
    let law = "model = \"viscoelastic\", expansion = 0.0, shear_relaxation = [{ fraction = 0.7, time = 2.0 }], \
               shift = { law = \"arrhenius\", activation_energy = 6e4, reference_temperature = 300.0 }";
    let faster = (6e4 / 8.314_462_618 * (1.0 / 300.0 - 1.0 / 330.0_f64)).exp();
    let force = |temperature: f64, step: f64| {
        let mut trial = Trial::new(&block(law, FLAT));
        trial.set("pad.temperature", temperature);
        trial.set("pad.top.displacement_z", -3e-3);
        (0..5).for_each(|_| trial.step(step));
        [trial.get("pad.top.force_z"), trial.get("pad.dissipated"), trial.get("pad.stored")]
    };
    let [warm, cold] = [force(330.0, 0.4), force(300.0, 0.4 * faster)];
    for n in 0..3 {
        assert!(off(warm[n], cold[n]) < 1e-9, "{warm:?} {cold:?}");
    }
    assert!(off(warm[0], force(300.0, 0.4)[0]) > 0.1);
}

/// Heating to and fro with a history: no energy is made.
#[test]
fn energy_is_balanced_through_heat_and_relaxation() {
    let law = "model = \"viscoelastic\", expansion = 1e-3, shear_relaxation = [{ fraction = 0.5, time = 5.0 }]";
    let dissipated = |count: u32| {
        let mut trial =
            Trial::new(&block(law, "top = { clamped = true }, bottom = { clamped = true }"));
        let mut last = 0.0;
        for n in 1..=count {
            let part = f64::from(n) / f64::from(count);
            trial.set("pad.temperature", 300.0 + 60.0 * (std::f64::consts::PI * part).sin());
            trial.step(10.0 / f64::from(count));
            let now = trial.get("pad.dissipated");
            assert!(now > last - 1e-3 * now.abs(), "{n}: {last} {now}");
            last = now;
        }
        last
    };
    let [coarse, fine, finer] = [20, 40, 80].map(dissipated);
    // First order.
    let order = (coarse - fine) / (fine - finer);
    assert!((1.5..2.6).contains(&order), "{coarse} {fine} {finer}");
}

/// A strip of two layers, from the top.
fn strip(size: [f64; 2], layers: [(f64, f64, f64, f64); 2], spacing: f64) -> String {
    let [length, height] = size;
    let of = |(young, poisson, expansion, thickness): (f64, f64, f64, f64)| {
        format!(
            "{{ thickness = {thickness:?}, material = {{ model = \"neo_hookean\", density = 1000.0, specific_heat = 1000.0, \
             conductivity = 1.0, young = {young:?}, poisson = {poisson:?}, expansion = {expansion:?} }} }}"
        )
    };
    scene(&format!(
        "shape = {{ box = [{length:?}, 1.0, {height:?}] }}\ndimension = 2\nmesh = {{ spacing = {spacing:?} }}\n\
         faces = {{ left = {{ clamped = true }} }}\nlayers = [{}, {}]",
        of(layers[0]),
        of(layers[1])
    ))
}

#[test]
fn strips_of_two_layers_bend_as_timoshenko_says() {
    for (ratio, part) in [(1.0, 0.5), (5.0, 0.5), (0.2, 0.2), (20.0, 0.1)] {
        let (height, rise, more) = (1e-3, 1.0, 1e-5);
        let upper = (ratio * 1e9, 0.3, more, part * height);
        let lower = (1e9, 0.2, 0.0, height - part * height);
        let mut trial = Trial::new(&strip([12e-3, height], [upper, lower], 1e-4));
        trial.set("pad.temperature", 300.0 + rise);
        trial.step(1.0);
        let layer = |(young, poisson, expansion, thickness): (f64, f64, f64, f64)| BondedLayer {
            modulus: young / (1.0 - poisson * poisson),
            free_strain: (1.0 + poisson) * expansion * rise,
            thickness,
        };
        let expected = -BondedPlate { layers: vec![layer(lower), layer(upper)] }.free()[1];
        let found = trial.get("pad.curvature");
        assert!(off(found, expected) < 5e-3, "{ratio} {part}: {found} {expected}");
    }
}

#[test]
fn a_strip_bends_by_half_a_turn() {
    let (height, length) = (1e-3, 30e-3);
    let [upper, lower] = [(2e6, 0.4, 0.0, 0.4e-3), (1e6, 0.3, 1.2e-3, 0.6e-3)];
    let bend = |mesh: &str| {
        let text = strip([length, height], [upper, lower], 1.0);
        let mut trial = Trial::new(&text.replace("spacing = 1.0", mesh));
        for step in 1..=8 {
            trial.set("pad.temperature", 300.0 + 6.0 * f64::from(step));
            trial.step(1.0);
        }
        trial.get("pad.curvature")
    };
    let layer = |(young, poisson, expansion, thickness): (f64, f64, f64, f64)| BentLayer {
        material: Rubber::of_young(young, poisson),
        free_stretch: 1.0 + 48.0 * expansion,
        thickness,
    };
    let exact = BentStrip { layers: vec![layer(lower), layer(upper)] }.curvature(80.0);
    assert!(exact * length > std::f64::consts::PI, "{}", exact * length);
    let errors: Vec<f64> =
        sweep(&[2e-4, 1e-4], &[0]).into_iter().map(|h| bend(&format!("spacing = {h:?}"))).collect();
    let errors: Vec<f64> = errors.into_iter().map(|found| found / exact - 1.0).collect();
    assert!(errors[0].abs() < 0.012, "{errors:?}");
    // One quadratic element through the upper layer, two through the lower one.
    let quadratic = bend("spacing = 2e-4, order = 2") / exact - 1.0;
    assert!(quadratic.abs() < 5e-4, "{quadratic}");
    if let [coarse, fine] = errors[..] {
        assert!((1.8..2.2).contains(&(coarse / fine).log2()), "{errors:?}");
    }
}
