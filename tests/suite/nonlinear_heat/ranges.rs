//! Ends of ranges, states, symmetry and refusals of nonlinear heat.

use std::f64::consts::TAU;

use super::*;
use impinge::method::enthalpy::{Failure, SetupError, linear_mesh};
use impinge::runtime::allowance::Interrupt;

/// Mercury, ice, aluminium, iron, steel and aerogel, with a temperature at which each is near its change.
fn materials() -> Vec<(&'static str, f64, Conduction)> {
    let melting = |solidus: f64, liquidus: f64, latent_heat: f64| {
        Some(Melting { solidus, liquidus, latent_heat })
    };
    let of = |density: f64, specific_heat: Property, conductivity: Property, melting| Conduction {
        density,
        specific_heat,
        conductivity,
        melting,
    };
    vec![
        (
            "mercury",
            230.0,
            of(
                13600.0,
                140.0.into(),
                table(&[230.0, 240.0], &[28.0, 8.0]),
                melting(234.32, 234.32, 1.14e4),
            ),
        ),
        ("ice", 270.0, water(273.15, 273.15)),
        (
            "aluminium",
            900.0,
            of(
                2550.0,
                table(&[300.0, 933.0], &[900.0, 1180.0]),
                table(&[900.0, 933.0, 934.0], &[212.0, 208.0, 94.0]),
                melting(933.47, 933.47, 3.97e5),
            ),
        ),
        (
            "iron",
            1750.0,
            of(
                7300.0,
                table(
                    &[300.0, 1000.0, 1042.0, 1100.0, 1811.0],
                    &[450.0, 970.0, 1500.0, 750.0, 820.0],
                ),
                table(&[300.0, 1184.0], &[80.0, 29.0]),
                melting(1811.0, 1811.0, 2.47e5),
            ),
        ),
        ("steel", 1700.0, of(7200.0, 700.0.into(), 30.0.into(), melting(1720.0, 1770.0, 2.6e5))),
        ("aerogel", 300.0, of(100.0, 1000.0.into(), table(&[300.0, 700.0], &[0.015, 0.04]), None)),
    ]
}

#[test]
fn heat_balances_for_all_materials_over_steps_of_any_length_and_loads_that_switch() {
    let length = 1e-3;
    for (name, start, material) in materials() {
        let capacity = material.density * material.specific_heat.value(start);
        let k = material.conductivity.value(start);
        let time = length * length * capacity / k;
        for part in [1e-9_f64, 1e-4, 1e-1, 1e3] {
            let faces = [
                (TOP, Condition::Flux),
                (RIGHT, Condition::Convective(0.3 * k / length)),
                (BOTTOM, Condition::Radiative(0.9)),
                (MeshFace { axis: 1, high: false }, Condition::Prescribed),
            ];
            let mut run =
                Run::new(&setup(block([length; 3], [3, 4, 5]), start, material.clone(), &faces));
            let flux = 400.0 * k / length / (part * 10.0).sqrt().min(1.0);
            for (flux, moved) in [(flux, 0.0), (0.0, 20.0), (-0.1 * flux, 0.0)] {
                let rate = [0.0, 0.0, 0.0, moved / (part * time)];
                let values = [flux, start + 50.0, start, start];
                let loads = [&values, &rate].map(|faces| Loads { surface: &NONE, faces });
                run.load(&loads, part * time, 0.1);
                let t = run.temperatures();
                assert!(t.iter().all(|t| *t > 0.0 && t.is_finite()), "{name} {part} {t:?}");
            }
            assert!(run.steps() < 3000.0, "{name} {part}: {} steps", run.steps());
        }
    }
}

#[test]
fn layers_of_unlike_materials_melt_beside_each_other_under_a_spot() {
    // Aluminium on aerogel on steel, with a contact: conductivities differ by four orders.
    let all = materials();
    let of = |name: &str| all.iter().find(|entry| entry.0 == name).unwrap().2.clone();
    let mesh = disc(2e-3, 1.2e-3, [8, 12]);
    let faces = [(TOP, Condition::Radiative(0.5)), (BOTTOM, Condition::Prescribed)];
    let mut setup = setup(mesh.clone(), 850.0, of("steel"), &faces);
    setup.materials.extend([of("aerogel"), of("aluminium")]);
    setup.layers = [vec![0; 4], vec![1; 2], vec![2; 6]].concat();
    setup.contacts = vec![Contact { below: 6, conductance: 2e4 }];
    let mut run = Run::new(&setup);
    assert_eq!(run.heat.node_counts(), [9, 1, 14]);
    let areas = mesh.axes[0].integrals();
    let spot: Vec<f64> =
        areas.iter().enumerate().map(|(i, a)| if i < 3 { 5e7 * a } else { 0.0 }).collect();
    let on = [Vec::new(), spot];
    for _ in 0..4 {
        run.load(&[Loads { surface: &on, faces: &[300.0, 850.0] }], 0.03, 0.5);
    }
    let of_nodes = run.heat.liquid(&run.state);
    assert!(run.liquid() > 0.0 && of_nodes.iter().any(|[_, f]| *f < 1.0), "{of_nodes:?}");
    run.advance(&[300.0, 300.0], 1e4, 0.5);
    assert_eq!(run.liquid(), 0.0);
    assert!(run.temperatures().iter().all(|t| (t - 300.0).abs() < 0.1));
}

#[test]
fn bodies_of_which_all_nodes_or_all_but_one_are_held_take_steps_too() {
    let (_, material) = kirchhoff();
    for (count, held) in [(1, 2), (1, 1), (2, 2)] {
        let places = [(TOP, Condition::Prescribed), (BOTTOM, Condition::Prescribed)];
        let mut run = Run::new(&setup(slab(1.0, count), 300.0, material.clone(), &places[..held]));
        run.advance(&[400.0, 400.0][..held], 1e3, 1e-3);
        assert!(run.temperatures().iter().all(|t| (t - 400.0).abs() < 1e-3));
        run.advance(&[300.0, 300.0][..held], 0.0, 1e-3);
    }
    // All sides of a box.
    let axes =
        [0, 1, 2].into_iter().flat_map(|axis| [false, true].map(|high| MeshFace { axis, high }));
    let faces: Vec<_> = axes.map(|place| (place, Condition::Prescribed)).collect();
    let mut run = Run::new(&setup(block([1.0; 3], [2; 3]), 300.0, material, &faces));
    let rates = [20.0; 6];
    let loads = [&[300.0; 6], &rates].map(|faces| Loads { surface: &NONE, faces });
    run.load(&loads, 10.0, 1e-3);
    let t = run.temperatures();
    assert!((t[0] - 500.0).abs() < 1e-9 && t[13] < 500.0 && t[13] > 490.0, "{t:?}");
}

#[test]
fn a_restored_state_goes_on_to_the_bit_and_a_step_that_halts_changes_nothing() {
    let faces = [(TOP, Condition::Convective(2e3)), (RIGHT, Condition::Radiative(0.5))];
    let mut run = Run::new(&setup(disc(5e-3, 3e-3, [6, 8]), 260.0, water(273.0, 273.3), &faces));
    run.advance(&[350.0, 300.0], 3.0, 0.05);
    let saved = run.state.clone();
    run.advance(&[350.0, 300.0], 3.0, 0.05);
    assert!(run.liquid() > 0.0);
    let mut other = Run::new(&setup(disc(5e-3, 3e-3, [6, 8]), 260.0, water(273.0, 273.3), &faces));
    other.state = saved.clone();
    other.advance(&[350.0, 300.0], 3.0, 0.05);
    assert!(other.state == run.state);

    other.state.clone_from(&saved);
    let loads = [Loads { surface: &NONE, faces: &[350.0, 300.0] }];
    let little = Allowance::of_updates(&Interrupt::default(), 3e5);
    let halted = other.heat.advance(&mut other.state, &loads, 1e4, 0.05, &little);
    assert!(matches!(halted, Err(Failure::Halted(_))), "{halted:?}");
    let bad = [Loads { surface: &NONE, faces: &[f64::NAN, 300.0] }];
    let allowance = Allowance::default();
    let mut refused = |loads: &[Loads], dt: f64, tolerance: f64| {
        other.heat.advance(&mut other.state, loads, dt, tolerance, &allowance).unwrap_err()
    };
    assert!(matches!(refused(&bad, 1.0, 0.1), Failure::NotFinite(_)));
    assert!(matches!(refused(&loads, f64::NAN, 0.1), Failure::Length(_)));
    assert!(matches!(refused(&loads, 1.0, 0.0), Failure::Tolerance(_)));
    let few = [Loads { surface: &NONE, faces: &[350.0] }];
    assert!(matches!(refused(&few, 1.0, 0.1), Failure::Loads { .. }));
    assert!(matches!(refused(&[], 1.0, 0.1), Failure::Loads { .. }));
    let many = [Vec::new(), vec![0.0; 8]];
    let many = [Loads { surface: &many, faces: &[350.0, 300.0] }];
    assert!(matches!(refused(&many, 1.0, 0.1), Failure::Loads { .. }));
    assert!(other.state == saved);
}

#[test]
fn a_mirrored_quarter_is_the_whole_and_a_disc_has_its_area() {
    let (_, material) = kirchhoff();
    let whole = block([2.0, 2.0, 0.5], [8, 8, 4]);
    let mut quarter = block([1.0, 1.0, 0.5], [4, 4, 4]);
    quarter.mirrored = [true; 2];
    let faces = [(TOP, Condition::Flux), (RIGHT, Condition::Convective(9.0))];
    let all = [(MeshFace { axis: 0, high: false }, Condition::Convective(9.0))];
    let mut part = Run::new(&setup(quarter, 300.0, material.clone(), &faces));
    let mut body = Run::new(&setup(whole, 300.0, material.clone(), &[&faces[..], &all].concat()));
    part.advance(&[3000.0, 250.0], 0.2, 1e-4);
    body.advance(&[3000.0, 250.0, 250.0], 0.2, 1e-4);
    let totals = [&part, &body].map(|run| run.heat.totals(&run.state));
    assert!((totals[0].brought_in / 2400.0 - 1.0).abs() < 1e-12);
    assert!((totals[0].lost / totals[1].lost - 1.0).abs() < 1e-6, "{totals:?}");

    let faces = [(TOP, Condition::Flux), (RIGHT, Condition::Prescribed)];
    let content = material.enthalpy(300.0).content(100.0);
    let mut round = Run::new(&setup(disc(2.0, 1.0, [5, 5]), 300.0, material, &faces));
    round.advance(&[100.0, 300.0], 0.5, 1e-3);
    let brought_in = round.heat.totals(&round.state).brought_in;
    assert!((brought_in / (0.5 * 100.0 * 0.5 * TAU * 4.0) - 1.0).abs() < 1e-12, "{brought_in}");
    round.advance(&[0.0, 400.0], 1e4, 1e-3);
    let stored = round.heat.stored(&round.state);
    assert!((stored / (content * 0.5 * TAU * 4.0) - 1.0).abs() < 1e-6, "{stored}");
}

#[test]
fn mid_nodes_of_quadratic_elements_make_linear_ones() {
    let (_, material) = kirchhoff();
    let mut mesh = slab(1.0, 4);
    mesh.axes[2] = Axis::from_element_ends(&[0.0, 0.5, 1.0], 2, Weight::Uniform);
    assert!(linear_mesh(&mesh) == slab(1.0, 4));
    let faces = [(TOP, Condition::Flux)];
    let mut runs =
        [mesh, slab(1.0, 4)].map(|mesh| Run::new(&setup(mesh, 300.0, material.clone(), &faces)));
    runs.iter_mut().for_each(|run| run.advance(&[2e3], 0.3, 1e-3));
    assert!(runs[0].state == runs[1].state);
}

#[test]
fn what_is_no_body_is_refused() {
    let refused = |change: &dyn Fn(&mut Setup)| {
        let mut setup = setup(slab(1.0, 4), 300.0, plain(1.0, 1.0, 1.0), &[]);
        change(&mut setup);
        EnthalpyHeat::new(&setup).err().unwrap()
    };
    assert_eq!(refused(&|s| s.reference = 0.0), SetupError::Reference(0.0));
    assert!(matches!(refused(&|s| s.layers = vec![0; 3]), SetupError::Layers { .. }));
    assert!(matches!(refused(&|s| s.layers = vec![0, 0, 1, 0]), SetupError::NoMaterial { .. }));
    assert!(matches!(refused(&|s| s.materials.clear()), SetupError::NoMaterial { .. }));
    for below in [0, 4] {
        let contact = Contact { below, conductance: 1.0 };
        let error = refused(&|s| s.contacts = vec![contact]);
        assert_eq!(error, SetupError::ContactPlace { below, most: 3 });
    }
    for (condition, place) in [
        (Condition::Convective(-1.0), TOP),
        (Condition::Radiative(1.1), TOP),
        (Condition::Flux, RIGHT),
    ] {
        assert!(!matches!(
            refused(&|s| s.faces = vec![Face { place, condition }]),
            SetupError::Nodes
        ));
    }
    let cold = |s: &mut Setup| s.materials[0].conductivity = table(&[300.0, 300.0], &[1.0, 2.0]);
    assert!(matches!(refused(&cold), SetupError::Material(0, _)));
}
