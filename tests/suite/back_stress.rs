//! Metals of large strain with a back stress: cycles beside their closed form, and states.

use impinge::advice::parse_with_warnings;
use impinge::model::Model;
use impinge::scene;

use crate::common::{Trial, off};
use crate::large_strain::block;

/// Root of a rising function.
fn root(of: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A bar of metal with all kinds of hardening under uniaxial stress, with constants in Pa.
struct Bar {
    shear: f64,
    bulk: f64,
    /// σ_y, H_i, H_k, σ_∞ and δ.
    metal: [f64; 5],
    /// λ_p and α.
    plastic: f64,
    accumulated: f64,
}

impl Bar {
    /// Force over the undeformed area at a stretch, towards which the bar goes monotonically: with the isochoric
    /// elastic stretch λ_e, `τ = µ (λ_e² − 1/λ_e) = ⅓ H_k (λ_p² − 1/λ_p) ± σ_y(α)`, `½ κ (J² − 1) = ⅓ τ` and
    /// `λ = J^(1/3) λ_e λ_p`.
    fn force(&mut self, stretch: f64, sign: f64) -> f64 {
        let dilatation = |stress: f64| (1.0 + 2.0 / 3.0 * stress / self.bulk).sqrt().cbrt();
        let elastic = |stress: f64| {
            let own = root(|x| self.shear * (x * x - 1.0 / x) - stress, [0.1, 10.0]);
            own * dilatation(stress)
        };
        let [yields, isotropic, kinematic, most, rate] = self.metal;
        let alpha = |own: f64| self.accumulated + (own / self.plastic).ln().abs();
        let stress = |own: f64| {
            let a = alpha(own);
            let radius = most - (most - yields) * (-rate * a).exp() + isotropic * a;
            kinematic / 3.0 * (own * own - 1.0 / own) + sign * radius
        };
        if sign * (stretch - elastic(stress(self.plastic)) * self.plastic) <= 0.0 {
            let within = [-2.0 * most, 2.0 * most];
            return root(|s| elastic(s) * self.plastic - stretch, within) / stretch;
        }
        let own = root(|own| elastic(stress(own)) * own - stretch, [0.2, 5.0]);
        let stress = stress(own);
        (self.accumulated, self.plastic) = (alpha(own), own);
        stress / stretch
    }
}

/// A block that is drawn and pressed by up to a third, in steps large and small.
#[test]
fn cycles_follow_the_closed_form() {
    let faces = "faces = { top = { roller = true, displacement = [0.0, 0.0, 0.0] }, bottom = { roller = true } }";
    let metal = "model = \"elastoplastic\", yield_stress = 100.0, isotropic_hardening = 50.0, \
                 kinematic_hardening = 300.0, hardening = { saturation = 150.0, rate = 8.0 }, density = 1000.0";
    for (mechanics, parts) in [("fem", 1), ("fem", 6), ("sph", 3), ("rkpm", 3), ("efg", 3)] {
        let text = block(faces, &format!("mechanics = \"{mechanics}\""))
            .replace("model = \"neo_hookean\", density = 1000.0", metal);
        let mut bar = Bar {
            shear: 2000.0,
            bulk: 5600.0 / 0.6,
            metal: [100.0, 50.0, 300.0, 150.0, 8.0],
            plastic: 1.0,
            accumulated: 0.0,
        };
        let mut trial = Trial::new(&text);
        let (mut from, mut dissipated) = (1.0, 0.0);
        let turns = [(1.3, 1.0), (0.75, -1.0), (1.3, 1.0), (0.75, -1.0), (1.1, 1.0)];
        for (to, sign) in turns {
            for n in 1..=parts {
                let stretch = from + (to - from) * f64::from(n) / f64::from(parts);
                trial.set("gel.top.displacement_z", 12e-3 * (stretch - 1.0));
                trial.step(1.0);
                let wanted = 10e-3 * 8e-3 * bar.force(stretch, sign);
                let found = trial.get("gel.top.force_z");
                let size = 10e-3 * 8e-3 * 100.0;
                assert!((found - wanted).abs() < 1e-8 * size, "{mechanics}: {found} {wanted}");
                let now = trial.get("gel.dissipated");
                assert!(now >= dissipated, "{now} {dissipated}");
                dissipated = now;
            }
            from = to;
        }
        assert!(bar.accumulated > 1.5);
        // What came in and is no longer stored is the yield stress times the plastic strain.
        let volume = 10e-3 * 8e-3 * 12e-3;
        let a = bar.accumulated;
        let wanted = 150.0 * a - 50.0 / 8.0 * (1.0 - (-8.0 * a).exp()) + 25.0 * a * a;
        let rough = if parts > 3 { 0.06 } else { 0.3 };
        assert!(off(dissipated, volume * wanted) < rough, "{dissipated} {}", volume * wanted);
    }
}

/// States of metals with back stress go on to the bit, and those that no run produces are refused.
#[test]
fn back_stress_is_part_of_the_state() {
    let metal = "model = \"elastoplastic\", yield_stress = 100.0, kinematic_hardening = 300.0, density = 1000.0";
    let faces = "faces = { top = { displacement = [0.0, 0.0, 0.0] }, bottom = { clamped = true } }";
    let text = block(faces, "").replace("model = \"neo_hookean\", density = 1000.0", metal);
    let mut trials = [1, 3].map(|threads| Trial::on_threads(&text, threads));
    let go = |trial: &mut Trial, phases: std::ops::Range<i32>| {
        for n in phases {
            let phase = 0.7 * f64::from(n);
            trial.set("gel.top.displacement_z", 3e-3 * phase.sin());
            trial.set("gel.top.displacement_x", 2e-3 * (1.0 - phase.cos()));
            trial.step(1.0);
        }
    };
    let [one, two] = &mut trials;
    go(one, 1..6);
    let saved = one.state.clone();
    go(one, 6..9);
    two.restart(&saved);
    go(two, 6..9);
    assert_eq!(one.state, two.state);
    assert!(one.get("gel.dissipated") > 0.0);
    let model: &Model = &one.model;
    assert_eq!(model.check_state(&one.state), Ok(()));
    // The history ends the state: C_p⁻¹ − 1 and α of each point.
    let count = one.state.bodies[0].len();
    for (place, damage) in [(7, -3.0), (6, -3.0), (5, -3.0), (4, 5.0), (1, -1e-6)] {
        let mut state = one.state.clone();
        state.bodies[0][count - place] = damage;
        assert!(model.check_state(&state).is_err(), "{place}");
    }
    let scene = scene::parse(&text, "scene").unwrap();
    let keys = scene.body["gel"].constants("gel").into_iter().map(|offered| offered.key);
    let keys: Vec<String> = keys.filter(|key| key.contains("hardening")).collect();
    assert_eq!(keys, ["kinematic_hardening"]);
}

#[test]
fn hardening_that_no_metal_has_is_warned_of() {
    let told = |modulus: &str, key: &str| {
        let metal = format!(
            "model = \"elastoplastic\", yield_stress = 100.0, {key} = {modulus}, density = 1000.0"
        );
        let held = "faces = { bottom = { clamped = true } }";
        let text = block(held, "").replace("model = \"neo_hookean\", density = 1000.0", &metal);
        let (_, found) = parse_with_warnings(&text, "scene.toml").unwrap();
        found.iter().any(|warning| warning.finding().id == "hardens_beyond_young")
    };
    for key in ["isotropic_hardening", "kinematic_hardening"] {
        assert!(told("5601.0", key) && told("1e22", key), "{key}");
        assert!(!told("0.0", key) && !told("5599.0", key), "{key}");
    }
}
