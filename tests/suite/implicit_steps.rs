//! Solids of large strain that move by implicit steps.

use crate::common::{Trial, off};
use crate::driven_solids::{BLOCK, probe, rubber};

/// A steel column between frictionless walls, that stands on its bottom and is pressed at its top.
fn column() -> String {
    let keys = "shape = { box = [4e-3, 1e-3, 100e-3] }\ndimension = 2\nmesh = { spacing = 2e-3 }\ninertia = true\nmotion = \"implicit\"\n\
                faces = { bottom = { roller = true }, sides = { roller = true }, top = { pressure = 1e8 } }";
    rubber(keys)
        .replace("young = 1e6, poisson = 0.4", "young = 200e9, poisson = 0.3")
        .replace("density = 1000.0", "density = 7800.0")
}

#[test]
fn column_rings_with_the_period_of_its_length() {
    let modulus = 200e9 * 0.7 / (1.3 * 0.4);
    let (period, settled) = (0.4 / (modulus / 7800.0_f64).sqrt(), -0.1 * 1e8 / modulus);
    let mut trial = Trial::new(&column());
    let start = trial.get("pad.height");
    let count = 40;
    let mut places = Vec::new();
    for _ in 0..2 * count {
        trial.step(period / f64::from(count));
        places.push((trial.get("pad.height") - start) / settled);
    }
    // A triangle between nothing and twice the settlement; waves that the steps do not resolve round its corners.
    assert!((places[9] - 1.0).abs() < 0.02 && (places[29] - 1.0).abs() < 0.02, "{places:?}");
    assert!((places[19] - 2.0).abs() < 0.12 && places[39].abs() < 0.12, "{places:?}");
    assert!((places[49] - 1.0).abs() < 0.05 && (places[69] - 1.0).abs() < 0.05, "{places:?}");
    let [kinetic, stored, work] =
        ["kinetic", "stored", "load_work"].map(|key| trial.get(&format!("pad.{key}")));
    assert!((kinetic + stored - work).abs() < 1e-6 * work.abs().max(stored));
}

#[test]
fn moved_face_takes_the_body_along() {
    let keys = format!(
        "{BLOCK}\ninertia = true\nmotion = \"implicit\"\nfaces = {{ bottom = {{ displacement = [0.0, 0.0, 0.0] }} }}"
    );
    let mut trial = Trial::new(&rubber(&keys));
    let mass = trial.get("pad.mass");
    // Slow beside the body's own periods.
    let (size, rate) = (1e-3, 20.0);
    let dt = 2e-3;
    let (mut impulse, mut work) = (0.0, 0.0);
    for n in 1..=150 {
        let time = dt * f64::from(n);
        let before = size * (1.0 - (rate * (time - dt)).cos());
        let to = size * (1.0 - (rate * time).cos());
        trial.set("pad.bottom.displacement_z", to);
        trial.step(dt);
        impulse += dt * trial.get("pad.bottom.force_z");
        work += trial.get("pad.bottom.force_z") * (to - before);
        assert!((trial.get("pad.momentum_z") - impulse).abs() < 1e-9 * mass, "{n}");
        let expected = mass * size * rate * (rate * time).sin();
        assert!((trial.get("pad.momentum_z") - expected).abs() < 0.1 * mass * size * rate, "{n}");
    }
    let energy = trial.get("pad.kinetic") + trial.get("pad.stored");
    // The work of the mean force misses that of the impulses on the nodes of the face.
    assert!((energy - work).abs() < 0.05 * mass * (size * rate).powi(2), "{energy} {work}");
}

#[test]
fn implicit_states_continue_bit_for_bit_and_forged_ones_are_refused() {
    let keys = format!(
        "{BLOCK}\ninertia = true\nmotion = \"implicit\"\nsymmetry = \"none\"\ngravity = 9.81\n\
         faces = {{ bottom = {{ clamped = true }}, top = {{ traction = [1e4, 0.0, 0.0], pressure = 1e4 }} }}"
    );
    let text = rubber(&keys);
    let (mut one, mut two) = (Trial::on_threads(&text, 1), Trial::on_threads(&text, 3));
    (0..3).for_each(|_| one.step(2e-3));
    (0..3).for_each(|_| two.step(2e-3));
    assert_eq!(one.state, two.state);
    let saved = one.state.clone();
    (0..3).for_each(|_| one.step(2e-3));
    two.restart(&saved);
    (0..3).for_each(|_| two.step(2e-3));
    assert_eq!(one.state, two.state);
    let model = &one.model;
    assert_eq!(model.check_state(&one.state), Ok(()));
    let count = one.state.bodies[0].len();
    let mut refused = 0;
    for n in 0..count {
        let mut state = one.state.clone();
        state.bodies[0][n] = f64::NAN;
        refused += usize::from(model.check_state(&state).is_err());
        state.bodies[0][n] = 1e30;
        refused += usize::from(model.check_state(&state).is_err());
    }
    assert!(refused * 10 >= 2 * count * 9, "{refused} of {}", 2 * count);
}

/// Work that is rounding, before anything moves and after a return to rest, has no cause; more than that is refused.
#[test]
fn states_at_rest_are_accepted_before_and_after_motion() {
    for (top, input, size) in [
        ("displacement = [0.0, 0.0, 0.0], roller = true", "pad.top.displacement_z", 1e-3),
        ("pressure = 0.0", "pad.top.pressure", 1e4),
    ] {
        let keys = format!(
            "{BLOCK}\ninertia = true\nmotion = \"implicit\"\n\
             faces = {{ bottom = {{ roller = true }}, top = {{ {top} }} }}"
        );
        let mut trial = Trial::new(&rubber(&keys));
        for part in [0.0, 1.0, 2.0, 1.0, 0.0, 0.0, 0.0] {
            trial.set(input, part * size);
            trial.step(1.0);
            assert_eq!(trial.model.check_state(&trial.state), Ok(()), "{input} {part}");
        }
        // Fields begin with time, steps, the length of the last one and works.
        let mut forged = trial.state.clone();
        forged.bodies[0][3] += 1e-6;
        let refusal = trial.model.check_state(&forged).unwrap_err().to_string();
        assert!(refusal.contains("no cause"), "{refusal}");
    }
}

/// Pressures that jump by as much as the body is stiff add no energy: such steps are halved.
#[test]
fn violent_steps_gain_no_energy() {
    let faces = "faces = { bottom = { roller = true }, top = { pressure = 0.0 } }";
    let keys =
        format!("{BLOCK}\nsymmetry = \"quarter\"\ninertia = true\nmotion = \"implicit\"\n{faces}");
    let mut trial = Trial::new(&rubber(&keys));
    for pressure in [1e4, 5e5, -3e5, 1e4, 0.0] {
        trial.set("pad.top.pressure", pressure);
        trial.step(2e-3);
        let of = |key: &str| trial.get(&format!("pad.{key}"));
        let [work, dissipated] = ["load_work", "dissipated"].map(of);
        assert!(dissipated.abs() < 0.03 * work.abs().max(1e-6), "{dissipated} J of {work} J");
    }
}

/// Linear elasticity has no smallest load: energy without a cause is no more than what rounding leaves of it.
#[test]
fn implicit_steps_bear_the_smallest_loads() {
    let faces = "faces = { bottom = { clamped = true }, top = { traction = [0.0, 0.0, 0.0] } }";
    let text = rubber(&format!("inertia = true\nmotion = \"implicit\"\n{BLOCK}\n{faces}"));
    let end = probe("end", [0.0; 3], "\"displacement\"");
    let moved = |traction: f64| {
        let mut trial = Trial::new(&format!("{text}{end}").replace("young = 1e6", "young = 2e11"));
        (0..5).for_each(|_| {
            trial.set("pad.top.traction_x", traction);
            trial.step(1e-3);
        });
        trial.get("end.displacement_x") / traction
    };
    let wanted = moved(1e6);
    // Strains of 1e-11 are known to 1e-4 of themselves, as rounding leaves 1e-15.
    for (traction, rough) in [(1.0, 2e-3), (100.0, 1e-4), (1e4, 1e-5)] {
        let found = moved(traction);
        assert!(off(found, wanted) < rough, "{traction}: {found} {wanted}");
    }
}
