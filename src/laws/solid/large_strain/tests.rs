use super::*;
use crate::math::matrix3::contraction;

fn laws() -> [LargeStrainLaw; 4] {
    let branches = vec![
        MaxwellBranch { fraction: 0.5, time: 0.3 },
        MaxwellBranch { fraction: 0.2, time: 5.0 },
    ];
    let plastic =
        Plastic { yield_stress: 0.4, hardening: 0.3, saturation: 0.6, rate: 17.0, kinematic: 0.0 };
    [
        LargeStrainLaw::elastic(7.0, 3.0),
        LargeStrainLaw {
            bulk: 7.0,
            shear: 3.0,
            deviator: Deviator::Relaxing(Relaxing { branches }),
        },
        LargeStrainLaw { bulk: 7.0, shear: 3.0, deviator: Deviator::Plastic(plastic) },
        LargeStrainLaw {
            bulk: 7.0,
            shear: 3.0,
            deviator: Deviator::Plastic(Plastic { kinematic: 0.5, ..plastic }),
        },
    ]
}

const FIRST: Matrix3 = [[1.1, 0.1, 0.0], [0.0, 0.9, 0.0], [0.2, 0.0, 1.0]];
const SECOND: Matrix3 = [[1.2, 0.3, -0.1], [0.05, 0.8, 0.2], [-0.2, 0.1, 1.1]];

/// A law's history after a first step.
fn after_first(law: &LargeStrainLaw) -> Vec<f64> {
    let mut history = vec![0.0; law.history()];
    law.respond(&Deformed::of(FIRST), 0.1, &mut history);
    history
}

#[test]
fn the_tangent_is_the_derivative_of_the_stress() {
    for law in laws() {
        let before = after_first(&law);
        let pressure = 1.7;
        let stress = |gradient: Matrix3| {
            let at = Deformed::of(gradient);
            let mut history = before.clone();
            let response = law.respond(&at, 0.2, &mut history);
            let jp = at.dilatation * pressure;
            let entry =
                |n: usize| response.stress[n / 3][n % 3] + jp * at.inverse_transposed[n / 3][n % 3];
            std::array::from_fn::<f64, 9, _>(entry)
        };
        let tangent = law.tangent(&Deformed::of(SECOND), 0.2, &before, pressure);
        for column in 0..9 {
            let moved = |by: f64| {
                let mut gradient = SECOND;
                gradient[column / 3][column % 3] += by;
                stress(gradient)
            };
            let (up, down) = (moved(1e-6), moved(-1e-6));
            for row in 0..9 {
                let found = (up[row] - down[row]) / 2e-6;
                let error = (found - tangent[row][column]).abs();
                assert!(error < 1e-7, "{row} {column}: {found} {}", tangent[row][column]);
                if law.is_symmetric() {
                    assert!((tangent[row][column] - tangent[column][row]).abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn stress_turns_with_the_body_and_needs_no_volume() {
    let (s, c) = 0.7_f64.sin_cos();
    let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    for law in laws() {
        let mut histories = [after_first(&law), after_first(&law)];
        let plain = law.respond(&Deformed::of(SECOND), 0.1, &mut histories[0]);
        let turned = law.respond(&Deformed::of(product(&turn, &SECOND)), 0.1, &mut histories[1]);
        let expected = product(&turn, &plain.stress);
        for n in 0..9 {
            let error = (turned.stress[n / 3][n % 3] - expected[n / 3][n % 3]).abs();
            assert!(error < 1e-13, "{error:e}");
        }
        for (a, b) in histories[0].iter().zip(&histories[1]) {
            assert!((a - b).abs() < 1e-13);
        }
        // P : F of a deviator is its trace.
        assert!(contraction(&plain.stress, &SECOND).abs() < 1e-13);
    }
}

#[test]
fn metals_end_on_their_yield_surface_and_dissipate() {
    let law = &laws()[2];
    let Deviator::Plastic(plastic) = &law.deviator else { unreachable!() };
    let mut history = vec![0.0; law.history()];
    let mut gradient = crate::math::matrix3::IDENTITY;
    let (mut work, mut before) = (0.0, [[0.0; 3]; 3]);
    for n in 1..=200 {
        let stretch = 1.0 + 1e-3 * f64::from(n);
        let next =
            [[stretch, 0.0, 0.0], [0.0, stretch.powf(-0.5), 0.0], [0.0, 0.0, stretch.powf(-0.5)]];
        let response = law.respond(&Deformed::of(next), 0.0, &mut history);
        for k in 0..9 {
            let (a, b) = (k / 3, k % 3);
            work += 0.5 * (response.stress[a][b] + before[a][b]) * (next[a][b] - gradient[a][b]);
        }
        (gradient, before) = (next, response.stress);
        // The Kirchhoff stress is P Fᵀ.
        let s = product(&response.stress, &transposed(&gradient));
        let equivalent = (1.5 * contraction(&s, &s)).sqrt();
        let alpha = history[6];
        let most = plastic.saturation
            - (plastic.saturation - plastic.yield_stress) * (-plastic.rate * alpha).exp()
            + plastic.hardening * alpha;
        assert!(equivalent <= most * (1.0 + 1e-12), "{n} {equivalent} {most}");
        if alpha > 0.0 {
            assert!((equivalent / most - 1.0).abs() < 1e-12);
        }
        assert!(work >= response.energy * (1.0 - 1e-3), "{work} {}", response.energy);
    }
    assert!(history[6] > 0.1);
    // Flow keeps the volume, and little of the work is elastic.
    let mut inverse = full_of(&history);
    (0..3).for_each(|a| inverse[a][a] += 1.0);
    let (_, determinant) = crate::math::matrix3::inverse(&inverse);
    assert!((determinant - 1.0).abs() < 1e-12, "{determinant}");
    let energy = law.respond(&Deformed::of(gradient), 0.0, &mut history.clone()).energy;
    let elastic = 2.0 / 3.0 * plastic.saturation.powi(2) / (4.0 * law.shear);
    assert!(energy < 3.0 * elastic && work > 2.0 * energy, "{energy} {work}");
}

/// A flow of any size beyond rounding has the tangent of its direction.
#[test]
fn points_that_hardly_flow_have_a_tangent() {
    let metal = Plastic {
        yield_stress: 0.004,
        hardening: 0.01,
        saturation: 0.006,
        rate: 17.0,
        kinematic: 0.0,
    };
    let law = LargeStrainLaw { bulk: 2.0, shear: 1.0, deviator: Deviator::Plastic(metal) };
    let sheared =
        |by: f64| [[1.0 + 0.3 * by, by, 0.0], [0.0, 1.0 - 0.2 * by, 0.1 * by], [0.0, 0.0, 1.0]];
    let flows = |by: f64| {
        let mut history = vec![0.0; law.history()];
        law.respond(&Deformed::of(sheared(by)), 0.0, &mut history);
        history[Plastic::STRAIN] > 0.0
    };
    let [mut low, mut high] = [0.0, 0.1];
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if flows(middle) { high = middle } else { low = middle }
    }
    let none = vec![0.0; law.history()];
    let tangent =
        |more: f64| law.tangent(&Deformed::of(sheared(high * (1.0 + more))), 0.0, &none, 0.0);
    let wanted = tangent(1e-6);
    for more in [1e-11, 1e-10, 1e-9, 1e-8] {
        let found = tangent(more);
        for (own, other) in found.as_flattened().iter().zip(wanted.as_flattened()) {
            assert!((own - other).abs() < 1e-4, "{more:e}: {own} {other}");
        }
    }
}

fn full_of(history: &[f64]) -> Matrix3 {
    crate::math::matrix3::full(std::array::from_fn(|n| history[n]))
}
