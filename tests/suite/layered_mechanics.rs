//! Displacements and stresses of bodies of several materials, against laminates, and both sides of interfaces.

use crate::common::{Trial, off};
use crate::layers::*;
use impinge::closed_form::{BondedLayer, BondedPlate};

/// A body that has been heated by 10 K.
fn heated_evenly(stack: Stack, shape: &str, supports: &str, mesh: &str, probes: &str) -> Trial {
    let faces = format!("top = {{ temperature = 310.0 }}\n{supports}");
    let mut trial = Trial::new(&body(shape, &layers(stack), [1.0, 0.1], mesh, &faces, probes));
    trial.step(1e6);
    trial
}

#[test]
fn a_contact_keeps_temperatures_apart_and_displacements_together() {
    let flux = 1e5;
    for resistance in [1e-7, 1e-5, 1e-2] {
        let stack: Stack = &[(GLASS, 0.1e-3, 0.0), (COPPER, 0.2e-3, resistance)];
        let at = [0.0, 0.0, -0.1e-3];
        let probes = probe("above", at, "above", ALL)
            + &probe("below", at, "below", ALL)
            + &probe("plain", at, "", ALL);
        let faces = format!(
            "top = {{ flux = {flux:?} }}\nbottom = {{ temperature = 300.0, clamped = true }}"
        );
        let mut trial =
            Trial::new(&body(&disc(0.3e-3), &layers(stack), [1.0, 0.1], "", &faces, &probes));
        trial.step(1e4);
        let jump = trial.get("above.temperature") - trial.get("below.temperature");
        assert!(off(jump, flux * resistance) < 1e-6, "{resistance}: {jump}");
        assert_eq!(trial.get("plain.temperature"), trial.get("above.temperature"));
        for i in ["x", "y", "z"] {
            let of = |side: &str| format!("{side}.displacement_{i}");
            let difference = trial.get(&of("above")) - trial.get(&of("below"));
            assert!(
                difference.abs() <= 1e-12 * trial.get(&of("above")).abs(),
                "{i}: {difference:e}"
            );
        }
    }
}

#[test]
fn stress_of_a_film_on_a_thick_plate_is_that_of_the_laminate_and_jumps_at_the_interface() {
    // A bottom that slides keeps the plate flat, front and back keep it from straining across; far from its
    // free right end nothing else acts.
    for (film, substrate) in [(DIAMOND, GLASS), (PTFE, COPPER), (COPPER, ALUMINA), (LEAD, DIAMOND)]
    {
        for order in [1, 2] {
            let stack: Stack = &[(film, 0.02, 0.0), (substrate, 0.18, 0.0)];
            let at = [-2.0, 0.1, -0.02];
            let probes = probe("film", at, "", "\"stress\"")
                + &probe("base", at, "below", "\"stress\"")
                + &probe("top", [-2.0, 0.1, 0.0], "", "\"stress\"")
                + "[refinement.plate]\nalong = 0.5\nthrough = 1.0\n";
            // Twice as wide as the keys say, across, too, where nothing changes.
            let mesh =
                format!("mesh = {{ spacing = 0.05, depth_spacing = 0.02, order = {order} }}");
            let supports = "bottom = { temperature = 310.0, roller = true }\nleft = { roller = true }\n\
                            front = { roller = true }\nback = { roller = true }";
            let mut trial = heated_evenly(stack, "box = [4.0, 0.4, 0.2]", supports, &mesh, &probes);
            let laminate = BondedPlate { layers: vec![wide(substrate, 0.18), wide(film, 0.02)] };
            let strain = laminate.flat();
            for (probe, layer, row) in [("film", 1, film), ("top", 1, film), ("base", 0, substrate)]
            {
                let along = laminate.stress(layer, strain);
                let [_, _, _, young, poisson, expansion] = row;
                let across = poisson * along - young * expansion * 10.0;
                for (component, wanted) in [("xx", along), ("yy", across)] {
                    let value = trial.get(&format!("{probe}.stress_{component}"));
                    let error = (value - wanted).abs() / laminate.stress(1, strain).abs();
                    // Coarse linear elements make an error at the free end that the whole plate feels.
                    let most = if order == 1 { 1e-3 } else { 1e-6 };
                    assert!(
                        error < most,
                        "order {order} {probe} {component}: {value:e} {wanted:e}"
                    );
                }
            }
        }
    }
}

/// A layer that does not strain across and is heated by 10 K.
fn wide([_, _, _, young, poisson, expansion]: Row, thickness: f64) -> BondedLayer {
    BondedLayer {
        modulus: young / (1.0 - poisson * poisson),
        free_strain: (1.0 + poisson) * expansion * 10.0,
        thickness,
    }
}

#[test]
fn bimetals_bend_as_timoshenko_and_thin_films_as_stoney_say() {
    // A strip that is clamped on the left and does not strain across; curvature from three places away from the ends.
    for (upper, thickness) in [(COPPER, 0.05), (PTFE, 0.03), (DIAMOND, 1e-4), (LEAD, 0.08)] {
        let stack: Stack = &[(upper, thickness, 0.0), (GLASS, 0.1, 0.0)];
        let at = |x: f64| [x, 0.0, -0.05 - thickness];
        let probes: String = [-0.25, 0.0, 0.25]
            .iter()
            .enumerate()
            .map(|(i, &x)| probe(&format!("p{i}"), at(x), "", "\"displacement\""))
            .collect();
        let probes = probes + "[refinement.plate]\nalong = 0.5\nthrough = 1.0\n";
        let supports = "bottom = { temperature = 310.0 }\nleft = { clamped = true }\nfront = { roller = true }\nback = { roller = true }";
        let shape = format!("box = [2.0, 0.4, {:?}]", 0.1 + thickness);
        let mesh = "mesh = { spacing = 0.1, depth_spacing = 0.02 }";
        let mut trial = heated_evenly(stack, &shape, supports, mesh, &probes);
        let [left, middle, right] = [0, 1, 2].map(|i| trial.get(&format!("p{i}.displacement_z")));
        let curvature = -(left - 2.0 * middle + right) / 0.25_f64.powi(2);
        let pair = [wide(GLASS, 0.1), wide(upper, thickness)];
        let wanted = BondedPlate::timoshenko(pair);
        assert!(off(curvature, wanted) < 1e-4, "{upper:?}: {curvature:e} {wanted:e}");
        if thickness < 0.001 {
            let laminate = BondedPlate { layers: pair.to_vec() };
            let stoney =
                BondedPlate::stoney(pair[0], thickness, laminate.stress(1, pair[0].free_strain));
            assert!(off(curvature, stoney) < 0.1, "{curvature:e} {stoney:e}");
        }
    }
}

/// Traction on an interface is the same on both sides, and on default meshes as accurate as in the softer layer: on the
/// axis of a heated disc of copper on polyimide half a hundredth of the stress along the film.
#[test]
fn traction_on_interfaces_is_that_of_the_softer_layer() {
    const POLYIMIDE: Row = [1420.0, 1090.0, 0.12, 2.5e9, 0.34, 2e-5];
    const ALUMINIUM: Row = [2700.0, 900.0, 237.0, 70e9, 0.34, 2.3e-5];
    let stack: Stack = &[(COPPER, 18e-6, 0.0), (POLYIMIDE, 25e-6, 0.0), (ALUMINIUM, 50e-6, 0.0)];
    let read = |finer: usize| {
        let mut rest =
            "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint.gaussian.radius = 60e-6\n\
                        carries = [\"heat_flux\"]\nstart.heat_flux = 8e8\n"
                .to_string();
        for (n, x) in [0.0, 20e-6, 60e-6].into_iter().enumerate() {
            for side in ["above", "below"] {
                let at = [x, 0.0, -18e-6];
                rest += &probe(&format!("{side}_{n}"), at, side, "\"stress\"");
            }
        }
        rest += &format!("[refinement.plate]\nalong = {finer}.0\nthrough = {finer}.0\n");
        let shape = "disc = { radius = 0.6e-3, thickness = 93e-6 }";
        let faces = "bottom = { temperature = 300.0, roller = true }";
        let mut trial = Trial::new(&body(shape, &layers(stack), [2e-5, 2e-6], "", faces, &rest));
        trial.step(2e-5);
        [0, 1, 2].map(|n| {
            let mut value =
                |side: &str, slot: &str| trial.get(&format!("{side}_{n}.stress_{slot}"));
            let along = value("above", "xx").abs();
            for slot in ["zz", "xz", "yz"] {
                let jump = value("above", slot) - value("below", slot);
                assert!(jump.abs() <= 1e-12 * along, "{n} {slot}: {jump:e}");
            }
            value("above", "zz")
        })
    };
    let (coarse, fine) = (read(1), read(4));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(off(coarse, fine) < 0.03, "{coarse:e} {fine:e}");
    }
}

#[test]
fn fields_hold_both_sides_of_interfaces() {
    let stack: Stack = &[(GLASS, 0.1e-3, 0.0), (COPPER, 0.2e-3, 1e-5)];
    let faces = "top = { flux = 1e5 }\nbottom = { temperature = 300.0, clamped = true }";
    for shape in [disc(0.3e-3), square(0.6e-3, 0.3e-3)] {
        let at = [0.0, 0.0, -0.1e-3];
        let probes = probe("above", at, "above", ALL) + &probe("below", at, "below", ALL);
        let mut trial = Trial::new(&body(&shape, &layers(stack), [1.0, 0.1], "", faces, &probes));
        trial.step(1e4);
        let fields = trial.fields("plate");
        let z = &fields.axes[2];
        let twice: Vec<usize> = (1..z.len()).filter(|&k| z[k] == z[k - 1]).collect();
        assert_eq!(twice.len(), 1);
        let plane = fields.axes[0].len() * fields.axes[1].len();
        let middle = |axis: &[f64]| axis.iter().position(|&x| x == 0.0).unwrap();
        let column = middle(&fields.axes[0]) + fields.axes[0].len() * middle(&fields.axes[1]);
        for (k, side) in [(twice[0] - 1, "below"), (twice[0], "above")] {
            let node = column + plane * k;
            let value = trial.get(&format!("{side}.temperature"));
            assert!((fields.temperature[node] - value).abs() < 1e-9, "{side}");
            let stress = trial.get(&format!("{side}.stress_xx"));
            assert!(
                off(fields.stress[node][0], stress) < 1e-6,
                "{side}: {} {stress}",
                fields.stress[node][0]
            );
        }
        let highest =
            fields.stress.iter().map(|&s| impinge::laws::stress::von_mises(s)).fold(0.0, f64::max);
        assert!(off(trial.get("plate.max_von_mises"), highest) < 1e-12);
        assert!(trial.get("plate.max_temperature") >= trial.get("above.temperature"));
    }
}

#[test]
fn large_layered_boxes_give_by_conjugate_gradients_what_discs_of_them_do() {
    // In the middle of a plate whose sides slide, heated evenly along it, nothing depends on its outline.
    let stack: Stack = &[(DIAMOND, 0.02e-3, 0.0), (COPPER, 0.2e-3, 1e-6), (GLASS, 0.08e-3, 0.0)];
    let faces = "top = { flux = 1e6 }\nbottom = { temperature = 300.0, roller = true }\nsides = { roller = true }";
    let at = [0.0, 0.0, -0.02e-3];
    let probes = probe("above", at, "above", ALL) + &probe("below", at, "below", ALL);
    let read = |shape: &str, mesh: &str| {
        let text = body(shape, &layers(stack), [1e-2, 2e-4], mesh, faces, &probes);
        let mut trial = Trial::new(&text);
        trial.step(2e-4);
        ["temperature", "stress_xx", "displacement_z"]
            .map(|key| ["above", "below"].map(|side| trial.get(&format!("{side}.{key}"))))
    };
    let disc = read("disc = { radius = 1e-3, thickness = 0.3e-3 }", "");
    let cube = read(&square(2e-3, 0.3e-3), "mesh = { spacing = 4e-5, depth_spacing = 1e-6 }");
    for (a, b) in disc.as_flattened().iter().zip(cube.as_flattened()) {
        assert!((a - b).abs() < 2e-3 * a.abs(), "{a:e} {b:e}");
    }
}
