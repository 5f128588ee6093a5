//! Directional, adjoint and output derivatives over arrays, and dependencies.

use std::ffi::c_int;

use impinge::variables::Causality;

use crate::master::three::Unit;
use crate::master::{self, ERROR, Handle, OK, call};

/// Numbers between −1 and 1 that follow no pattern.
fn numbers(count: usize, seed: u64) -> Vec<f64> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..count).map(|_| 2.0 * random.f64() - 1.0).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A unit amid a run under all kinds of loads.
fn loaded() -> Unit {
    let unit = Unit::running();
    assert_eq!(unit.set("patch.pressure", &[1e6, 2e6, 3e6, 1e6, 5e5, 2e6]), OK);
    assert_eq!(unit.set("spot.shear_x", &[1e6]), OK);
    assert_eq!(unit.set("spot.x", &[2e-5]), OK);
    assert_eq!(unit.step(0.0, 5e-8).0, OK, "{:?}", unit.messages.take());
    unit
}

/// u·(J v) = (Jᵀ u)·v for weights u in the units of each output and changes v in those of each known.
#[track_caller]
fn check_adjoint(unit: &Unit, unknowns: &[u32], knowns: &[u32], tolerance: f64) {
    let scale = |references: &[u32]| -> Vec<f64> {
        let names = unit.scalar_names(references);
        let quantity =
            |name: &str| unit.registry.variables[unit.registry.find(name).unwrap()].quantity;
        names.iter().map(|name| quantity(name).unwrap().nominal()).collect()
    };
    let times = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>();
    let inverse = |a: Vec<f64>| a.iter().map(|a| 1.0 / a).collect::<Vec<_>>();
    let v = times(numbers(unit.size(knowns), 1), scale(knowns));
    let u = times(numbers(unit.size(unknowns), 2), inverse(scale(unknowns)));
    let forward = unit.directional(unknowns, knowns, &v);
    let backward = unit.adjoint(unknowns, knowns, &u);
    let (left, right) = (dot(&u, &forward), dot(&backward, &v));
    let size = u.iter().zip(&forward).map(|(u, f)| (u * f).abs()).sum::<f64>();
    assert!(size > 0.0 && (left - right).abs() <= tolerance * size, "{left} {right} of {size}");
}

/// The extremes of a body follow the node that has them, so that they are no linear function of a change
/// at a kink; away from kinks they are, as everything else.
#[test]
fn adjoint_derivatives_are_the_transpose_of_directional_ones() {
    let unit = loaded();
    let inputs = unit.floats(Some(Causality::Input));
    let outputs = unit.floats(Some(Causality::Output));
    check_adjoint(&unit, &outputs, &inputs, 1e-12);
    let field = [unit.reference("surface.von_mises")];
    check_adjoint(&unit, &field, &[unit.reference("patch.pressure")], 1e-12);
}

#[test]
fn parameters_have_adjoint_derivatives_in_initialization_mode() {
    let unit = Unit::initializing();
    assert_eq!(unit.set("patch.pressure", &[1e6, 2e6, 3e6, 1e6, 5e5, 2e6]), OK);
    let knowns = unit.references(&["plate.young", "patch.pressure", "plate.poisson"]);
    let outputs = unit.references(&["centre.displacement_z", "centre.stress_xx"]);
    check_adjoint(&unit, &outputs, &knowns, 1e-12);
    assert_eq!(unit.exit(), OK);
    unit.messages.take();
    let mut found = [0.0; 1];
    let name = "fmi3GetAdjointDerivative";
    let status = unit.differentiate_in(name, [&outputs, &knowns[..1]], &[1.0; 2], &mut found);
    assert_eq!(status, ERROR);
    unit.expect_message(ERROR, &[name, "plate.young is no input"]);
}

/// One row of the transpose, against the derivatives by one input after another.
#[test]
fn an_adjoint_derivative_lists_the_derivatives_by_each_element() {
    let unit = loaded();
    let (stress, pressure) = (unit.reference("centre.stress_xx"), unit.reference("patch.pressure"));
    let row = unit.adjoint(&[stress], &[pressure], &[1.0]);
    for (element, found) in row.iter().enumerate() {
        let mut seed = [0.0; 6];
        seed[element] = 1.0;
        assert_eq!(unit.directional(&[stress], &[pressure], &seed), [*found]);
        assert!(*found != 0.0);
    }
}

#[test]
fn derivatives_are_those_of_fmi_2() {
    let (two, three) = (master::Unit::running(), Unit::running());
    assert_eq!(two.step(0.0, 5e-8), OK);
    assert_eq!(three.step(0.0, 5e-8).0, OK);
    let inputs = three.references(&["patch.pressure", "spot.x", "spot.heat_flux"]);
    let outputs = three.floats(Some(Causality::Output));
    let of_two = |references: &[u32]| -> Vec<u32> {
        three.scalar_names(references).iter().map(|name| two.reference(name)).collect()
    };
    let seed = numbers(three.size(&inputs), 5);
    let expected = two.directional_derivative(&of_two(&outputs), &of_two(&inputs), &seed);
    assert_eq!(three.directional(&outputs, &inputs, &seed), expected);

    let scalars = of_two(&outputs);
    let mut expected = vec![0.0; scalars.len()];
    assert_eq!(two.output_derivatives_in(&scalars, &vec![1; scalars.len()], &mut expected), OK);
    let mut found = vec![0.0; scalars.len()];
    let orders = vec![1; outputs.len()];
    assert_eq!(three.output_derivatives_in(&outputs, &orders, &mut found), OK);
    assert_eq!(found, expected);
    assert!(found.iter().any(|rate| *rate != 0.0));
}

#[test]
fn wrong_counts_and_variables_are_refused() {
    let unit = loaded();
    let before = unit.snapshot();
    let field = unit.references(&["surface.temperature"]);
    let pressure = unit.references(&["patch.pressure"]);
    for (name, seeds, room) in
        [("fmi3GetDirectionalDerivative", 6, 16), ("fmi3GetAdjointDerivative", 16, 6)]
    {
        for (seeds, room, argument) in
            [(seeds - 1, room, "nSeed"), (seeds, room + 1, "nSensitivity")]
        {
            let mut found = vec![-1.0; room];
            let lists = [&field[..], &pressure];
            let status = unit.differentiate_in(name, lists, &vec![1.0; seeds], &mut found);
            assert_eq!(status, ERROR);
            unit.expect_message(ERROR, &[name, argument, "elements"]);
            assert!(found.iter().all(|value| *value == -1.0));
        }
    }
    let mut found = [-1.0; 4];
    let coordinates = unit.references(&["surface.x"]);
    let name = "fmi3GetDirectionalDerivative";
    let status = unit.differentiate_in(name, [&coordinates, &pressure], &[1.0; 6], &mut found);
    assert_eq!(status, ERROR);
    unit.expect_message(ERROR, &["surface.x is constant"]);
    assert_eq!(unit.output_derivatives_in(&field, &[2], &mut [0.0; 16]), ERROR);
    unit.expect_message(ERROR, &["derivative of order 2", "surface.temperature"]);
    assert_eq!(unit.output_derivatives_in(&field, &[1], &mut [0.0; 15]), ERROR);
    unit.expect_message(ERROR, &["nValues is 15"]);
    assert_eq!(unit.snapshot(), before);
}

fn dependencies(unit: &Unit, output: &str) -> Vec<u32> {
    let (output, mut count) = (unit.reference(output), usize::MAX);
    let status = call!("fmi3GetNumberOfVariableDependencies", unit.handle => Handle,
        output => u32, &raw mut count => *mut usize);
    assert_eq!(status, OK);
    let (mut inputs, mut kinds) = (vec![0; count], vec![0; count]);
    let mut elements = [vec![9; count], vec![9; count]];
    let [of_output, of_inputs] = &mut elements;
    let status = call!("fmi3GetVariableDependencies", unit.handle => Handle, output => u32,
        of_output.as_mut_ptr() => *mut usize, inputs.as_mut_ptr() => *mut u32,
        of_inputs.as_mut_ptr() => *mut usize, kinds.as_mut_ptr() => *mut c_int, count => usize);
    assert_eq!(status, OK);
    assert_eq!(elements.concat(), vec![0; 2 * count], "0 stands for all elements");
    assert_eq!(kinds, vec![5; count], "fmi3Dependent");
    inputs
}

#[test]
fn outputs_tell_the_arrays_that_they_follow_at_once() {
    let unit = Unit::running();
    assert!(dependencies(&unit, "surface.temperature").is_empty());
    let stress = dependencies(&unit, "surface.von_mises");
    for name in ["patch.pressure", "spot.pressure", "spot.x"] {
        assert!(stress.contains(&unit.reference(name)), "{name}");
    }
    assert!(!stress.contains(&unit.reference("patch.heat_flux")));
    let status = call!("fmi3GetNumberOfVariableDependencies", unit.handle => Handle,
        unit.reference("spot.x") => u32, &mut 0_usize => *mut usize);
    assert_eq!(status, ERROR);
    unit.expect_message(ERROR, &["spot.x is no output"]);
}
