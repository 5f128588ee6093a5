//! Derivatives of inputs and of outputs, as a master asks for them.

use std::ffi::c_int;
use std::ptr::null;

use crate::master::{DISCARD, ERROR, Handle, OK, Unit, call, registry};

use impinge::scene;
use impinge::variables::{Causality, Slot};

/// A unit with load on all that it has, between two steps.
fn loaded() -> Unit {
    let unit = Unit::running();
    for (name, value) in [
        ("spot.pressure", 3e6),
        ("spot.shear_x", 1e6),
        ("spot.shear_y", -2e6),
        ("spot.x", 3.1e-5),
        ("spot.y", -1.7e-5),
        ("patch.pressure[1,2]", 2e6),
        ("patch.pressure[2,3]", -1e6),
        ("patch.x", 1.3e-5),
        ("patch.y", 0.9e-5),
    ] {
        assert_eq!(unit.set(name, value), OK);
    }
    assert_eq!(unit.step(0.0, 5e-8), OK);
    unit
}

/// The Jacobian of all outputs with respect to all inputs agrees with central differences, and is zero
/// where the XML names no dependency.
#[test]
fn every_declared_dependency_is_served_exactly_and_no_other() {
    let unit = loaded();
    let registry = registry();
    let scene = scene::parse(crate::master::SCENE, "scene.toml").unwrap();
    let dependencies = registry.all_dependencies(&scene);
    let outputs: Vec<u32> = dependencies.iter().map(|(output, _)| *output as u32).collect();
    let mut served = 0;
    for input in registry.of_causality(Causality::Input) {
        let name = &registry.variables[input].name;
        let found = unit.directional_derivative(&outputs, &[input as u32], &[1.0]);
        let value = unit.get(name);
        let step = match name.rsplit('.').next().unwrap() {
            "x" | "y" | "radius" => 2e-9,
            "ambient" => 1.0,
            _ => 1e4,
        };
        let at = |by: f64| {
            assert_eq!(unit.set(name, value + by), OK);
            let mut values = vec![0.0; outputs.len()];
            assert_eq!(unit.get_in(&outputs, &mut values), OK);
            values
        };
        let (above, below) = (at(step), at(-step));
        assert_eq!(unit.set(name, value), OK);
        let wanted: Vec<f64> =
            above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        let largest = |kind: &str| {
            let of_kind = |i: &usize| registry.variables[outputs[*i] as usize].name.contains(kind);
            (0..outputs.len()).filter(of_kind).map(|i| wanted[i].abs()).fold(0.0, f64::max)
        };
        let (stresses, displacements) = (largest("stress"), largest("displacement"));
        for (i, (output, follows)) in dependencies.iter().enumerate() {
            let output = &registry.variables[*output].name;
            let scale = if output.contains("displacement") { displacements } else { stresses };
            if follows.contains(&input) {
                let error = (found[i] - wanted[i]).abs();
                assert!(error <= 1e-5 * scale, "{output} by {name}: {} {}", found[i], wanted[i]);
                served += 1;
            } else {
                assert_eq!((found[i], wanted[i]), (0.0, 0.0), "{output} by {name}");
            }
        }
    }
    assert!(served > 100, "{served}");
}

#[test]
fn a_directional_derivative_sums_its_directions() {
    let unit = loaded();
    let outputs = ["centre.stress_zz", "centre.von_mises"].map(|name| unit.reference(name));
    let inputs = ["spot.pressure", "spot.x"].map(|name| unit.reference(name));
    let alone = inputs.map(|input| unit.directional_derivative(&outputs, &[input], &[1.0]));
    let both = unit.directional_derivative(&outputs, &inputs, &[2.0, -3e-7]);
    for i in 0..2 {
        let wanted = 2.0 * alone[0][i] - 3e-7 * alone[1][i];
        assert!((both[i] - wanted).abs() < 1e-11 * wanted.abs(), "{} {wanted}", both[i]);
    }
    assert_eq!(unit.directional_derivative(&outputs, &[], &[]), [0.0, 0.0]);
    assert_eq!(unit.directional_derivative(&[], &inputs, &[1.0, 1.0]), [0.0; 0]);
}

#[test]
fn derivatives_are_there_in_initialization_mode_and_change_nothing() {
    let unit = Unit::initializing();
    assert_eq!(unit.set("spot.pressure", 1e6), OK);
    let (output, input) = (unit.reference("centre.stress_zz"), unit.reference("spot.pressure"));
    let before = unit.snapshot();
    let slope = unit.directional_derivative(&[output], &[input], &[1.0])[0];
    assert_eq!(unit.snapshot(), before);
    assert!((slope * 1e6 / unit.get("centre.stress_zz") - 1.0).abs() < 1e-12);
}

/// In initialization mode outputs depend on inputs and parameters alike, as the XML says by naming
/// no dependencies there. An estimate of errors follows nothing that is differentiated: it has rates of zero.
#[test]
fn every_parameter_is_known_in_initialization_mode() {
    let unit = Unit::initializing();
    assert_eq!(unit.set("spot.pressure", 1e6), OK);
    let registry = registry();
    let is_estimate = |&i: &usize| registry.variables[i].name.ends_with(".estimated_error");
    let outputs: Vec<u32> = registry
        .of_causality(Causality::Output)
        .filter(|i| !is_estimate(i))
        .map(|i| i as u32)
        .collect();
    let estimate = unit.reference("plate.estimated_error");
    let by = unit.reference("plate.conductivity");
    assert_eq!(unit.directional_derivative(&[estimate], &[by], &[1.0]), [0.0]);
    let read = || {
        let mut values = vec![0.0; outputs.len()];
        assert_eq!(unit.get_in(&outputs, &mut values), OK);
        values
    };
    let before = unit.snapshot();
    for (reference, variable) in registry.variables.iter().enumerate() {
        let Slot::Parameter(_) = variable.slot else { continue };
        let name = &variable.name;
        let found = unit.directional_derivative(&outputs, &[reference as u32], &[1.0]);
        let value = unit.get(name);
        let step = 1e-3 * value;
        let [above, below] = [step, -step].map(|by| {
            assert_eq!(unit.set(name, value + by), OK);
            read()
        });
        assert_eq!(unit.set(name, value), OK);
        for (i, &output) in outputs.iter().enumerate() {
            let wanted = (above[i] - below[i]) / (2.0 * step);
            let rounding = 1e-11 * above[i].abs() / step;
            let error = (found[i] - wanted).abs();
            let output = &registry.variables[output as usize].name;
            assert!(
                error <= 1e-4 * wanted.abs() + rounding,
                "{output} by {name}: {} {wanted}",
                found[i]
            );
        }
    }
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn what_cannot_be_differentiated_is_refused_by_name() {
    let unit = loaded();
    let r = |name: &str| unit.reference(name);
    unit.messages.take();
    let directional = |unknown: u32, known: u32, change: f64| {
        let mut found = [7.0];
        let status = unit.directional_derivative_in(&[unknown], &[known], &[change], &mut found);
        assert_eq!(found, [7.0]);
        status
    };
    assert_eq!(directional(r("spot.x"), r("spot.x"), 1.0), ERROR);
    unit.expect_message(ERROR, &["fmi2GetDirectionalDerivative", "spot.x is no output"]);
    assert_eq!(directional(r("centre.stress_xx"), r("plate.young"), 1.0), ERROR);
    unit.expect_message(ERROR, &["fmi2GetDirectionalDerivative", "plate.young is no input"]);
    assert_eq!(directional(r("centre.stress_xx"), r("spot.x"), f64::NAN), ERROR);
    unit.expect_message(ERROR, &["spot.x = NaN", "finite"]);
    assert_eq!(directional(99_999, r("spot.x"), 1.0), ERROR);
    unit.expect_message(ERROR, &["99999 is unknown"]);

    let before = unit.snapshot();
    assert_eq!(unit.set_derivative("centre.temperature", 1, 1.0), ERROR);
    unit.expect_message(ERROR, &["fmi2SetRealInputDerivatives", "centre.temperature is no input"]);
    for order in [0, 3, -1] {
        assert_eq!(unit.set_derivative("spot.x", order, 1.0), ERROR);
        unit.expect_message(ERROR, &["spot.x", &format!("order {order}"), "allowed: 1 to 2"]);
    }
    assert_eq!(unit.set_derivative("spot.x", 1, f64::INFINITY), ERROR);
    unit.expect_message(ERROR, &["spot.x = inf", "finite"]);

    for order in [0, 2] {
        let mut found = [7.0];
        assert_eq!(
            unit.output_derivatives_in(&[r("centre.temperature")], &[order], &mut found),
            ERROR
        );
        unit.expect_message(ERROR, &["centre.temperature", &format!("order {order}"), "1 to 1"]);
        assert_eq!(found, [7.0]);
    }
    assert_eq!(unit.output_derivatives_in(&[r("spot.x")], &[1], &mut [7.0]), ERROR);
    unit.expect_message(ERROR, &["fmi2GetRealOutputDerivatives", "spot.x is no output"]);
    assert_eq!(unit.snapshot(), before);
    let status = call!("fmi2SetRealInputDerivatives", unit.handle => Handle,
        &raw const before.1 => *const c_int, 1 => usize, null() => *const c_int,
        null() => *const f64);
    assert_eq!(status, ERROR);
    unit.expect_message(ERROR, &["order is a null pointer"]);
}

/// All outputs, and their derivatives.
fn all_outputs(unit: &Unit) -> (Vec<u32>, Vec<f64>, Vec<f64>) {
    let registry = registry();
    let outputs: Vec<u32> = registry.of_causality(Causality::Output).map(|i| i as u32).collect();
    let mut values = vec![0.0; outputs.len()];
    assert_eq!(unit.get_in(&outputs, &mut values), OK);
    let mut rates = vec![f64::NAN; outputs.len()];
    let orders = vec![1; outputs.len()];
    let status = unit.output_derivatives_in(&outputs, &orders, &mut rates);
    assert_eq!(status, OK, "{:?}", unit.messages.take());
    (outputs, values, rates)
}

#[test]
fn output_derivatives_lead_to_the_next_values() {
    let unit = loaded();
    assert_eq!(unit.set_derivative("spot.heat_flux", 1, 3e15), OK);
    assert_eq!(unit.set_derivative("spot.pressure", 1, 2e14), OK);
    assert_eq!(unit.set_derivative("spot.x", 1, 200.0), OK);
    assert_eq!(unit.step(5e-8, 2e-8), OK);
    let h = 1e-13;
    let (outputs, before, rates) = all_outputs(&unit);
    let pause = unit.save();
    // The inputs go on as they did for a moment.
    let continued = [("spot.heat_flux", 3e15), ("spot.pressure", 2e14), ("spot.x", 200.0)];
    for (name, slope) in continued {
        assert_eq!(unit.set_derivative(name, 1, slope), OK);
    }
    assert_eq!(unit.step(unit.time(), h), OK);
    let (_, after, _) = all_outputs(&unit);
    let registry = registry();
    for i in 0..outputs.len() {
        let name = &registry.variables[outputs[i] as usize].name;
        let wanted = (after[i] - before[i]) / h;
        // The difference loses digits against the value, and has an error of first order.
        let lost = 1e-15 * after[i].abs() / h;
        let error = (rates[i] - wanted).abs();
        assert!(error <= 1e-3 * wanted.abs() + 20.0 * lost, "{name}: {} {wanted}", rates[i]);
    }
    assert_eq!(unit.restore(pause), OK);
    assert_eq!(all_outputs(&unit).2, rates, "a saved state keeps its derivatives");
}

#[test]
fn input_derivatives_act_in_the_next_step_only() {
    let unit = Unit::running();
    assert_eq!(unit.set_derivative("spot.heat_flux", 1, 2e15), OK);
    assert_eq!(unit.set("spot.heat_flux", 1e7), OK, "the order of sets does not matter");
    assert_eq!(unit.step(0.0, 1e-8), OK);
    // ∫ (1e7 + 2e15 s) ds over the disc; then the flux stays where it is.
    let area = std::f64::consts::PI * 60e-6_f64.powi(2);
    let first = area * (1e7 * 1e-8 + 0.5 * 2e15 * 1e-16);
    let heat = unit.get("plate.heat_in");
    assert!((heat / first - 1.0).abs() < 1e-9, "{heat} {first}");
    assert!((unit.get("spot.heat_flux") / 3e7 - 1.0).abs() < 1e-12);
    assert_eq!(unit.step(1e-8, 1e-8), OK);
    let second = unit.get("plate.heat_in") - heat;
    assert!((second / (area * 3e7 * 1e-8) - 1.0).abs() < 1e-9, "{second}");
    // A value that is set ends what the past step did.
    assert_eq!(unit.set("spot.heat_flux", 0.0), OK);
    let power = unit.reference("plate.heat_in");
    let mut rate = [f64::NAN];
    assert_eq!(unit.output_derivatives_in(&[power], &[1], &mut rate), OK);
    assert_eq!(rate, [0.0]);
}

#[test]
fn a_step_that_cannot_be_completed_is_discarded_and_may_be_repeated() {
    let unit = loaded();
    let state = unit.save();
    let before = unit.snapshot();
    assert_eq!(unit.set_derivative("spot.x", 1, 1e4), OK);
    unit.messages.take();
    assert_eq!(unit.step(5e-8, 2e-8), DISCARD);
    unit.expect_message(DISCARD, &["fmi2DoStep", "spot.x", "into the step"]);
    assert_eq!((unit.time(), unit.wants_to_end()), (5e-8, 0));
    assert_eq!(unit.snapshot(), before);
    assert_eq!(unit.step(5e-8, 1e-9), ERROR, "a failed step is followed by a saved state");
    unit.expect_message(ERROR, &["stepFailed"]);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.set_derivative("spot.x", 1, 1e4), OK);
    assert_eq!(unit.step(5e-8, 1e-9), OK, "{:?}", unit.messages.take());
    assert!((unit.get("spot.x") - (3.1e-5 + 1e-5)).abs() < 1e-15);
}

#[test]
fn an_input_that_leaves_its_bounds_within_a_step_discards_it() {
    let unit = loaded();
    let before = unit.snapshot();
    let state = unit.save();
    for (order, value) in [(1, 1e100), (2, -1e130)] {
        assert_eq!(unit.set_derivative("spot.heat_flux", order, value), OK);
        assert_eq!(unit.step(5e-8, 1e-8), DISCARD);
        let words = ["spot.heat_flux: ", "(allowed: -1e60 to 1e60 W/m2), 1e-8 s into the step"];
        unit.expect_message(DISCARD, &words);
        assert_eq!((unit.restore(state), unit.snapshot() == before), (OK, true));
    }
    assert_eq!(unit.step(5e-8, 1e-8), OK);
}

#[test]
fn derivatives_beyond_what_steps_resolve_are_refused_and_change_nothing() {
    let unit = loaded();
    let before = unit.snapshot();
    for (name, order, value, allowed) in [
        ("spot.heat_flux", 1, 1e121, "±2e120"),
        ("spot.pressure", 2, -1e181, "±2e180"),
        ("plate.bottom.ambient", 1, 1e70, "±1e69"),
        ("spot.x", 1, 1e57, "±2e56"),
    ] {
        assert_eq!(unit.set_derivative(name, order, value), ERROR, "{name}");
        unit.expect_message(ERROR, &["derivative of order", name, allowed]);
        assert_eq!(unit.snapshot(), before);
    }
}

#[test]
fn every_input_takes_derivatives() {
    let unit = Unit::running();
    for variable in &registry().variables {
        if matches!(variable.slot, Slot::Input(_)) {
            assert_eq!(unit.set_derivative(&variable.name, 1, 1e-9), OK, "{}", variable.name);
            assert_eq!(unit.set_derivative(&variable.name, 2, 1e-9), OK, "{}", variable.name);
        }
    }
    assert_eq!(unit.step(0.0, 1e-8), OK, "{:?}", unit.messages.take());
}
