//! Adaptive quadrature, for solutions with one remaining integral.
//!
//! Source: R. Piessens et al., *QUADPACK*, Springer 1983, doi 10.1007/978-3-642-61786-7: the 7-point Gauss rule inside
//! the 15-point Kronrod rule, the worst interval bisected first.

use std::f64::consts::PI;

/// Target relative error of every integral.
const TOLERANCE: f64 = 1e-11;
/// Error allowed relative to the integral of the absolute value, for integrands that cancel.
const CANCELLATION: f64 = 1e-13;
/// Largest number of intervals of an integral.
const MOST_INTERVALS: usize = 2000;

/// Half of the symmetric rule on [−1, 1]: node, Kronrod weight, Gauss weight.
const RULE: [(f64, f64, f64); 8] = [
    (0.9914553711208126, 0.022935322010529224, 0.0),
    (0.9491079123427585, 0.06309209262997856, 0.1294849661688697),
    (0.8648644233597691, 0.10479001032225019, 0.0),
    (0.7415311855993945, 0.14065325971552592, 0.27970539148927664),
    (0.5860872354676911, 0.1690047266392679, 0.0),
    (0.4058451513773972, 0.19035057806478542, 0.3818300505051189),
    (0.20778495500789848, 0.20443294007529889, 0.0),
    (0.0, 0.20948214108472782, 0.4179591836734694),
];

/// One interval with its integral, the integral of the absolute value, and the error.
struct Interval {
    from: f64,
    to: f64,
    value: f64,
    size: f64,
    error: f64,
}

impl Interval {
    fn new(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (mut kronrod, mut gauss, mut size) = (0.0, 0.0, 0.0);
        for (node, kronrod_weight, gauss_weight) in RULE {
            let (left, right) = match node {
                0.0 => (f(middle), 0.0),
                _ => (f(middle - half * node), f(middle + half * node)),
            };
            kronrod += kronrod_weight * (left + right);
            gauss += gauss_weight * (left + right);
            size += kronrod_weight * (left.abs() + right.abs());
        }
        let error = half * (kronrod - gauss).abs();
        Self { from, to, value: half * kronrod, size: half * size, error }
    }
}

/// Integral of `f` from the first to the last of the increasing `points`, to about 1e-11
/// relative. Inner points mark kinks, jumps and both flanks of narrow peaks. NaN where the accuracy
/// is not reached.
pub fn integrate(f: impl Fn(f64) -> f64, points: &[f64]) -> f64 {
    let mut intervals: Vec<Interval> = points
        .windows(2)
        .filter(|pair| pair[1] > pair[0])
        .map(|pair| Interval::new(&f, pair[0], pair[1]))
        .collect();
    loop {
        let sum = |part: fn(&Interval) -> f64| intervals.iter().map(part).sum::<f64>();
        let (value, size, error) = (sum(|i| i.value), sum(|i| i.size), sum(|i| i.error));
        if error <= (TOLERANCE * value.abs()).max(CANCELLATION * size) {
            return value;
        }
        if !error.is_finite() || intervals.len() >= MOST_INTERVALS {
            return f64::NAN;
        }
        let by_error = |a: &usize, b: &usize| intervals[*a].error.total_cmp(&intervals[*b].error);
        let Some(worst) = (0..intervals.len()).max_by(by_error) else { return f64::NAN };
        let Interval { from, to, .. } = intervals.swap_remove(worst);
        let middle = 0.5 * (from + to);
        intervals.push(Interval::new(&f, from, middle));
        intervals.push(Interval::new(&f, middle, to));
    }
}

/// Integral over a disc of a function g of the distance ρ to a point at `distance` from the
/// centre, inside or outside the disc: `∮ F(ρ) dφ` along the rim, with φ the angle seen from the
/// point and `F(ρ) = ∫₀^ρ g ρ dρ` the `radial` integral.
///
/// With θ the angle seen from the centre, `dφ = R (R − r cos θ)/ρ² dθ`. Near the rim the integrand
/// may vary over any small angle, so that the range is cut in geometric progression.
pub fn integrate_over_disc(radius: f64, distance: f64, radial: impl Fn(f64) -> f64) -> f64 {
    let gap = radius - distance;
    let integrand = |theta: f64| {
        let sine = (0.5 * theta).sin();
        let bulge = 2.0 * distance * sine * sine;
        let square = gap * gap + 2.0 * radius * bulge;
        radial(square.sqrt()) * radius * (gap + bulge) / square
    };
    let mut angles = [0.0; 14];
    for (n, angle) in angles.iter_mut().skip(1).rev().enumerate() {
        *angle = PI / 4f64.powi(n as i32);
    }
    2.0 * integrate(integrand, &angles)
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within};
    use super::*;

    #[test]
    fn rules_are_exact_for_their_polynomials() {
        for power in (0..=22).step_by(2) {
            let rule = Interval::new(&|x: f64| x.powi(power), -1.0, 1.0);
            assert_close(rule.value, 2.0 / f64::from(power + 1), 1e-15);
            assert!(power > 12 || rule.error < 1e-15, "Gauss rule at power {power}");
        }
    }

    #[test]
    fn finds_singular_ends_jumps_and_marked_peaks() {
        assert_close(integrate(f64::sqrt, &[0.0, 1.0]), 2.0 / 3.0, 1e-11);
        assert_close(integrate(|x| f64::from(x > 0.3), &[0.0, 1.0]), 0.7, 1e-11);
        let peak = |x: f64| (-(x - 0.3).powi(2) / 1e-8).exp();
        assert_close(integrate(peak, &[0.0, 0.2995, 0.3005, 1.0]), 1e-4 * PI.sqrt(), 1e-11);
    }

    #[test]
    fn cancelling_and_empty_integrals_are_zero_and_divergent_ones_nan() {
        assert_within(integrate(|x| x * x.exp().ln_1p() - 0.5 * x * x, &[-1.0, 1.0]), 0.0, 1e-13);
        assert_eq!(integrate(f64::exp, &[1.0, 1.0]), 0.0);
        assert!(integrate(|x| 1.0 / x, &[0.0, 1.0]).is_nan());
    }

    #[test]
    fn disc_integral_gives_area_and_polar_moment_about_any_point() {
        for r in [0.0, 0.4, 0.999, 1.0 - 1e-9, 1.0, 1.001, 1.5, 4.0] {
            assert_close(integrate_over_disc(1.0, r, |rho| 0.5 * rho * rho), PI, 1e-9);
            let moment = integrate_over_disc(1.0, r, |rho| 0.25 * rho.powi(4));
            assert_close(moment, PI * (0.5 + r * r), 1e-9);
        }
    }
}
