use super::*;
use crate::laws::solid::large_strain::{Deviator, LargeStrainLaw};
use crate::laws::{Elastic, Elastoplastic, Law, PlasticHistory, Thermoelastic, constant};
use crate::math::matrix3::IDENTITY;

const METAL: Plastic = Plastic {
    yield_stress: 0.004,
    hardening: 0.01,
    saturation: 0.006,
    rate: 17.0,
    kinematic: 0.03,
};
const SHEAR: f64 = 1.0;

fn law(shear: f64, metal: Plastic) -> LargeStrainLaw {
    LargeStrainLaw { bulk: 2.0 * shear, shear, deviator: Deviator::Plastic(metal) }
}

fn rotation(axis: [f64; 3], angle: f64) -> Matrix3 {
    let size = norm(axis);
    let [x, y, z] = axis.map(|a| a / size);
    let (s, c) = angle.sin_cos();
    let of = |a: f64, b: f64| a * b * (1.0 - c);
    [
        [c + of(x, x), of(x, y) - z * s, of(x, z) + y * s],
        [of(x, y) + z * s, c + of(y, y), of(y, z) - x * s],
        [of(x, z) - y * s, of(y, z) + x * s, c + of(z, z)],
    ]
}

/// Deviatoric Kirchhoff stress after a step to F.
fn step(law: &LargeStrainLaw, gradient: &Matrix3, history: &mut [f64]) -> (Matrix3, Isochoric) {
    let response = law.respond(&Deformed::of(*gradient), 0.0, history);
    (product(&response.stress, &transposed(gradient)), response)
}

/// Root of a falling function.
fn root(of: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A bar that keeps its volume is drawn and pressed three times between stretches. With the plastic stretch λ_p the
/// difference of the principal stresses is `µ (λ²/λ_p² − λ_p/λ) = h (λ_p² − 1/λ_p) ± σ_y(α)`, and each way is exact in
/// one step or many.
#[test]
fn bars_follow_their_closed_form_through_cycles() {
    let isotropic = Plastic { kinematic: 0.0, ..METAL };
    for (metal, parts) in [(METAL, 1), (METAL, 7), (isotropic, 1), (isotropic, 7)] {
        let back = metal.kinematic / 3.0;
        let law = law(SHEAR, metal);
        let mut history = vec![0.0; law.history()];
        let (mut plastic, mut accumulated, mut before) = (1.0_f64, 0.0, 1.0);
        for turn in 0..6 {
            let [sign, end] = if turn % 2 == 0 { [1.0, 1.3] } else { [-1.0, 0.8] };
            for part in 1..=parts {
                let stretch = before + (end - before) * f64::from(part) / f64::from(parts);
                let elastic = |own: f64| SHEAR * ((stretch / own).powi(2) - own / stretch);
                let rest = |own: f64| {
                    let [radius, _] = metal.yield_stress(accumulated + (own / plastic).ln().abs());
                    elastic(own) - back * (own * own - 1.0 / own) - sign * radius
                };
                if sign * rest(plastic) > 0.0 {
                    let own = root(rest, [0.1, 10.0]);
                    accumulated += (own / plastic).ln().abs();
                    plastic = own;
                }
                let across = stretch.powf(-0.5);
                let gradient = [[stretch, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]];
                let (found, response) = step(&law, &gradient, &mut history);
                let wanted = elastic(plastic);
                let difference = found[0][0] - found[1][1];
                assert!(
                    (difference - wanted).abs() < 1e-11 * wanted.abs(),
                    "{difference} {wanted}"
                );
                assert!((found[1][1] - found[2][2]).abs() < 1e-13);
                assert!((history[Plastic::STRAIN] - accumulated).abs() < 1e-12 * accumulated);
                let own = |x: f64| x * x + 2.0 / x - 3.0;
                let stored = 0.5 * (SHEAR * own(stretch / plastic) + back * own(plastic));
                assert!((response.energy - stored).abs() < 1e-13, "{} {stored}", response.energy);
            }
            before = end;
        }
        assert!(accumulated > 2.0);
    }
}

/// Without elastic strain, F_p is F up to a rotation: `s = h dev FFᵀ + √⅔ σ_y d/‖d‖`, so in simple shear by γ the shear
/// stress is `h γ + σ_y/√3`.
#[test]
fn shear_stress_rises_steadily_in_finite_simple_shear() {
    let metal = Plastic { hardening: 0.0, saturation: METAL.yield_stress, ..METAL };
    for shear in [1.0, 100.0] {
        let law = law(shear, metal);
        let mut history = vec![0.0; law.history()];
        let mut last = 0.0;
        for n in 1..=1000 {
            let gamma = 0.01 * f64::from(n);
            let gradient = [[1.0, gamma, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let (stress, _) = step(&law, &gradient, &mut history);
            assert!(stress[0][1] > last, "{gamma}: {} {last}", stress[0][1]);
            last = stress[0][1];
            let back = METAL.kinematic / 3.0;
            let mut wanted = deviator(&product(&gradient, &transposed(&gradient)));
            wanted.iter_mut().flatten().for_each(|value| *value *= back);
            wanted[0][1] += metal.yield_stress / 3.0_f64.sqrt();
            wanted[1][0] = wanted[0][1];
            let size = contraction(&wanted, &wanted).sqrt();
            let far: f64 =
                (0..9).map(|n| (stress[n / 3][n % 3] - wanted[n / 3][n % 3]).powi(2)).sum();
            // Elastic strain, and the turn of the axes within a step.
            let allowed = 2.0 * size / shear + 6e-3;
            assert!(n < 100 || far.sqrt() < allowed * size, "{gamma}: {:e}", far.sqrt() / size);
        }
    }
}

/// The same history seen from a frame that turns by another angle in each step.
#[test]
fn stress_turns_with_the_frame_in_finite_shear_and_back() {
    let law = law(SHEAR, METAL);
    let mut histories = [vec![0.0; law.history()], vec![0.0; law.history()]];
    for n in 0..200 {
        let phase = 0.05 * f64::from(n);
        let (gamma, across) = (2.0 * phase.sin(), 0.3 * (1.7 * phase).sin());
        let gradient = [[1.0, gamma, 0.0], [0.0, 1.0, across], [0.1 * gamma, 0.0, 1.0]];
        let turn = rotation([1.0, phase.cos(), 0.3], 3.0 * phase);
        let (plain, _) = step(&law, &gradient, &mut histories[0]);
        let (turned, _) = step(&law, &product(&turn, &gradient), &mut histories[1]);
        let wanted = product(&product(&turn, &plain), &transposed(&turn));
        let size = contraction(&plain, &plain).sqrt();
        for (a, b) in turned.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((a - b).abs() < 1e-12 * size.max(METAL.yield_stress), "{n}: {a} {b}");
        }
    }
    assert!(histories[0][Plastic::STRAIN] > 1.0);
}

/// Random non-proportional steps, small beside 1, of a metal that yields at a small strain.
#[test]
fn small_strains_are_those_of_small_strain_plasticity() {
    let small = 1e-6;
    let [yields, isotropic, kinematic] = [0.5 * small, 0.2, 0.4];
    let metal = Plastic {
        yield_stress: yields,
        hardening: isotropic,
        saturation: yields,
        rate: 0.0,
        kinematic,
    };
    let law = law(SHEAR, metal);
    let bulk = law.bulk;
    let young = 9.0 * bulk * SHEAR / (3.0 * bulk + SHEAR);
    let elastic = Thermoelastic { young, poisson: young / (2.0 * SHEAR) - 1.0, expansion: 0.0 };
    let rigid = Elastic { law: elastic, stress_free_temperature: 300.0 };
    let other = Elastoplastic {
        yield_stress: constant(yields),
        isotropic: constant(isotropic),
        kinematic: constant(kinematic),
        ..Elastoplastic::elastic(&rigid.law, rigid.stress_free_temperature)
    };
    let mut random = fastrand::Rng::with_seed(3);
    let mut history = vec![0.0; law.history()];
    let mut old = [0.0; PlasticHistory::LEN];
    for _ in 0..50 {
        let m: Matrix3 = std::array::from_fn(|_| std::array::from_fn(|_| random.f64() - 0.5));
        let gradient = std::array::from_fn(|a| {
            std::array::from_fn(|b| IDENTITY[a][b] + 4.0 * small * m[a][b])
        });
        let sums = packed(&std::array::from_fn(|a| std::array::from_fn(|b| m[a][b] + m[b][a])));
        let strain = std::array::from_fn(|n| {
            let shears = if n < 3 { 0.5 } else { 1.0 };
            4.0 * small * shears * sums[n]
        });
        let (stress, _) = step(&law, &gradient, &mut history);
        let mut new = old;
        let length = other.history_len();
        let wanted = other.respond(&strain, 300.0, 1.0, &old[..length], &mut new[..length]).stress;
        old = new;
        let mean = (wanted[0] + wanted[1] + wanted[2]) / 3.0;
        for (n, stress) in packed(&stress).into_iter().enumerate() {
            let wanted = wanted[n] - if n < 3 { mean } else { 0.0 };
            assert!((stress - wanted).abs() < 2e-4 * yields, "{stress} {wanted}");
        }
        let accumulated = PlasticHistory::read(&old).accumulated;
        assert!((history[Plastic::STRAIN] - accumulated).abs() < 2e-4 * accumulated);
    }
    assert!(history[Plastic::STRAIN] > 20.0 * small);
}

/// Around closed paths of F whose axes turn, work is stored or dissipated, and what is dissipated is the yield stress
/// times the plastic strain; the point ends on its yield surface.
#[test]
fn cycles_dissipate_the_yield_stress_over_the_plastic_strain() {
    let law = law(SHEAR, METAL);
    let mut history = vec![0.0; law.history()];
    let count = 2000;
    let at = |n: usize| -> Matrix3 {
        let phase = 2.0 * std::f64::consts::PI * n as f64 / count as f64;
        let (x, y) = (0.3 * phase.sin(), 0.2 * (1.0 - phase.cos()));
        [[1.0 + 0.5 * y, x, 0.0], [0.2 * x, 1.0, y], [0.0, 0.1 * x, 1.0 - 0.3 * y]]
    };
    let (mut before, mut stored, mut lost, mut wanted) = ([[0.0; 3]; 3], 0.0, 0.0, 0.0);
    let (mut at_turn, mut gradient) = ([0.0; 2], IDENTITY);
    for n in 1..=3 * count {
        let (next, from) = (at(n), history[Plastic::STRAIN]);
        let (_, response) = step(&law, &next, &mut history);
        let mean = |a: usize, b: usize| 0.5 * (before[a][b] + response.stress[a][b]);
        let work: f64 = (0..9)
            .map(|k| mean(k / 3, k % 3) * (next[k / 3][k % 3] - gradient[k / 3][k % 3]))
            .sum();
        let gone = work - (response.energy - stored);
        let strain = history[Plastic::STRAIN] - from;
        let [radius, _] = METAL.yield_stress(history[Plastic::STRAIN]);
        // The trapezoidal rule is of second order.
        assert!(gone > -1e-9 && (gone - radius * strain).abs() < 2e-7, "{n}: {gone:e}");
        let point = Point::new(&METAL, SHEAR, &Deformed::of(next), &history);
        let driving = point.driving(&point.elastic, &point.plastic);
        let size = contraction(&driving, &driving).sqrt();
        assert!(size < ROOT * radius * (1.0 + 1e-12));
        assert!(strain == 0.0 || size > ROOT * radius * (1.0 - 1e-12));
        let (_, determinant) = inverse(&unpacked(&history));
        assert!((determinant - 1.0).abs() < 1e-11, "{determinant}");
        (lost, wanted) = (lost + gone, wanted + radius * strain);
        (before, stored, gradient) = (response.stress, response.energy, next);
        if n % count == 0 {
            at_turn = [at_turn[1], lost];
        }
    }
    assert!((lost / wanted - 1.0).abs() < 2e-3, "{lost} {wanted}");
    assert!(at_turn[1] > at_turn[0] && history[Plastic::STRAIN] > 1.0);
}

/// Steps to any deformation from any history of flow find their return, however far beyond the yield surface.
#[test]
fn returns_are_found_from_far_away() {
    let mut random = fastrand::Rng::with_seed(11);
    for kinematic in [1e-6, 1e-3, 0.1, 1.0, 10.0] {
        for yield_stress in [1e-5, 1e-2, 0.5] {
            let metal = Plastic { yield_stress, saturation: yield_stress, kinematic, ..METAL };
            let law = law(SHEAR, metal);
            for size in [1e-12, 1e-6, 1e-3, 0.1, 1.0, 2.0] {
                let mut history = vec![0.0; law.history()];
                for _ in 0..20 {
                    let mut draw = || size * (2.0 * random.f64() - 1.0);
                    let stretch = [draw(), draw(), draw()].map(f64::exp);
                    let axes = rotation([draw(), draw(), size], draw() / size);
                    let turn = rotation([size, draw(), draw()], draw() / size);
                    let diagonal: Matrix3 = std::array::from_fn(|a| {
                        std::array::from_fn(|b| if a == b { stretch[a] } else { 0.0 })
                    });
                    let gradient = product(&turn, &turned(&axes, &diagonal));
                    let (_, response) = step(&law, &gradient, &mut history);
                    assert!(response.energy.is_finite(), "{kinematic} {yield_stress} {size}");
                    assert!(Plastic::is_sound(&history));
                }
            }
        }
    }
}

/// Without a back stress the step of isotropic hardening is the same, by other means.
#[test]
fn vanishing_back_stress_is_isotropic_hardening() {
    let [isotropic, vanishing] = [0.0, 1e-13].map(|kinematic| Plastic { kinematic, ..METAL });
    let first = [[1.1, 0.1, 0.0], [0.0, 0.9, 0.0], [0.2, 0.0, 1.0]];
    let second = [[1.6, 0.3, -0.1], [0.05, 0.7, 0.2], [-0.2, 0.1, 1.1]];
    let of = |metal: Plastic| {
        let law = law(SHEAR, metal);
        let mut history = vec![0.0; law.history()];
        step(&law, &first, &mut history);
        let tangent = law.tangent(&Deformed::of(second), 0.0, &history, 0.0);
        let (stress, _) = step(&law, &second, &mut history);
        (stress, tangent, history)
    };
    let (found, wanted) = (of(isotropic), of(vanishing));
    let near = |a: &f64, b: &f64| assert!((a - b).abs() < 1e-10, "{a} {b}");
    found.0.as_flattened().iter().zip(wanted.0.as_flattened()).for_each(|(a, b)| near(a, b));
    found.1.as_flattened().iter().zip(wanted.1.as_flattened()).for_each(|(a, b)| near(a, b));
    found.2.iter().zip(&wanted.2).for_each(|(a, b)| near(a, b));
}
