use super::*;
use crate::kernel::Kernel;
use crate::math::random::Random;

const IDENTITY: Tensor = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A lattice of spacing one around the origin, perturbed by up to `disorder`, on the side where `keep` holds.
fn cloud(dimension: usize, disorder: f64, keep: impl Fn([i32; 3]) -> bool) -> Vec<[f64; 3]> {
    let mut random = Random::of(7);
    let reach = |axis: usize| if axis < dimension { -4..=4 } else { 0..=0 };
    let mut out = Vec::new();
    for k in reach(2) {
        for j in reach(1) {
            for i in reach(0) {
                let mut shaken = [i, j, k].map(f64::from);
                for x in &mut shaken[..dimension] {
                    *x += disorder * (2.0 * random.number() - 1.0);
                }
                if [i, j, k] != [0; 3] && keep([i, j, k]) {
                    out.push(shaken);
                }
            }
        }
    }
    out
}

fn seen(points: &[[f64; 3]], kernel: Kernel, dimension: usize, support: f64) -> Vec<Neighbour> {
    points.iter().filter_map(|&r| Neighbour::new(r, 1.0, (kernel, support, dimension))).collect()
}

fn applied(coefficients: &[f64], neighbours: &[Neighbour], f: impl Fn([f64; 3]) -> f64) -> f64 {
    let terms = coefficients.iter().zip(neighbours);
    terms.map(|(c, n)| c * (f(n.offset) - f([0.0; 3]))).sum()
}

#[test]
fn corrected_operator_is_exact_for_quadratics() {
    let tensor = [[1.3, 0.4, -0.2], [0.4, 0.7, 0.1], [-0.2, 0.1, 2.0]];
    type Keep = fn([i32; 3]) -> bool;
    let sides: [Keep; 3] = [|_| true, |[i, ..]| i >= 0, |[i, j, k]| i >= 0 && j >= 0 && k >= 0];
    for (dimension, kernel) in (1..=3).flat_map(|d| Kernel::ALL.map(|kernel| (d, kernel))) {
        for (disorder, keep) in [0.0, 0.25].into_iter().flat_map(|d| sides.map(|side| (d, side))) {
            let neighbours = seen(&cloud(dimension, disorder, keep), kernel, dimension, 3.4);
            let coefficients = corrected(&neighbours, dimension, &tensor).unwrap();
            let size: f64 = coefficients.iter().map(|c| c.abs()).sum();
            for p in 0..dimension {
                let linear = applied(&coefficients, &neighbours, |r| r[p]);
                assert!(linear.abs() < 1e-12 * size, "{dimension}-D {kernel:?}: {linear}");
                for q in 0..dimension {
                    let value = applied(&coefficients, &neighbours, |r| r[p] * r[q]);
                    let wanted = 2.0 * tensor[p][q];
                    assert!(
                        (value - wanted).abs() < 1e-11 * size,
                        "{dimension}-D {kernel:?}: {value}"
                    );
                }
            }
        }
    }
}

#[test]
fn renormalised_gradient_is_exact_for_linear_functions() {
    for dimension in 1..=3 {
        let points = cloud(dimension, 0.3, |[i, ..]| i >= 0);
        let neighbours = seen(&points, Kernel::WendlandC2, dimension, 3.0);
        let b = renormalisation(&neighbours, dimension).unwrap();
        let slope = [2.0, -1.0, 0.5];
        for axis in 0..dimension {
            let direction = [0, 1, 2].map(|a| f64::from(u8::from(a == axis)));
            let coefficients = b.derivative(&neighbours, direction);
            let value = applied(&coefficients, &neighbours, |r| dot(slope, r));
            assert!((value - slope[axis]).abs() < 1e-13, "{dimension}-D: {value}");
        }
    }
}

#[test]
fn both_operators_agree_on_full_lattices_up_to_one_factor() {
    for dimension in 1..=3 {
        let neighbours = seen(&cloud(dimension, 0.0, |_| true), Kernel::WendlandC2, dimension, 3.0);
        let exact = corrected(&neighbours, dimension, &IDENTITY).unwrap();
        let plain = plain(&neighbours, dimension, &IDENTITY);
        let factor = exact[0] / plain[0];
        assert!((factor - 1.0).abs() < 0.1, "{dimension}-D: {factor}");
        for (a, b) in exact.iter().zip(&plain) {
            assert!((a / b / factor - 1.0).abs() < 1e-11);
        }
    }
}

#[test]
fn plain_operator_converges_to_the_tensor_for_full_supports() {
    let tensor = [[1.0, 0.0, 0.0], [0.0, 2.5, 0.0], [0.0, 0.0, 0.0]];
    let error = |support: f64| {
        let reach = support.ceil() as i32;
        let line = -reach..=reach;
        let points: Vec<[f64; 3]> = line
            .clone()
            .flat_map(|i| line.clone().map(move |j| [f64::from(i), f64::from(j), 0.0]))
            .collect();
        let neighbours = seen(&points, Kernel::WendlandC2, 2, support);
        let c = plain(&neighbours, 2, &tensor);
        (0..2).map(|a| (applied(&c, &neighbours, |r| r[a] * r[a]) / 2.0 - tensor[a][a]).abs()).sum()
    };
    let errors: [f64; 2] = [4.0, 16.0].map(error);
    assert!(errors[1] < 0.02 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn neighbours_on_too_few_lines_are_refused() {
    // Nearest neighbours along the axes alone do not determine mixed derivatives.
    let cross = cloud(3, 0.0, |p| p.iter().filter(|&&i| i != 0).count() == 1);
    assert_eq!(corrected(&seen(&cross, Kernel::WendlandC2, 3, 3.0), 3, &IDENTITY), None);
    let plane = cloud(3, 0.0, |[_, _, k]| k == 0);
    assert_eq!(corrected(&seen(&plane, Kernel::WendlandC2, 3, 3.0), 3, &IDENTITY), None);
    let almost = cloud(3, 1e-4, |[_, _, k]| k == 0);
    assert_eq!(corrected(&seen(&almost, Kernel::WendlandC2, 3, 3.0), 3, &IDENTITY), None);
}

#[test]
fn heat_flows_through_an_interface_without_a_jump() {
    // Steady rod of two unlike halves: the harmonic mean of a pair has the flux of two resistors in series.
    let [k_i, k_j] = [400.0, 0.6];
    let resistance = 0.5 / k_i + 0.5 / k_j;
    assert!((conductivity_between(k_i, k_j) * resistance - 1.0).abs() < 1e-15);
    let mut neighbours = seen(&[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], Kernel::WendlandC2, 1, 2.0);
    neighbours[0].conductivity = k_i;
    neighbours[1].conductivity = conductivity_between(k_i, k_j);
    let c = plain(&neighbours, 1, &IDENTITY);
    // Unit spacing: k_ij is the conductance between the middles of the two.
    assert!((c[1] / c[0] * k_i * resistance - 1.0).abs() < 1e-12);
}
