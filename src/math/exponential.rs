//! Weights of exponential integrators.

/// Number of weights that [`weights`] returns.
pub const COUNT: usize = 5;

/// `1/5, 1/6, …`: from one term of the Taylor series of φ₄ to the next.
const INVERSES: [f64; 14] = {
    let mut list = [0.0; 14];
    let mut j = 0;
    while j < list.len() {
        list[j] = 1.0 / (j + 5) as f64;
        j += 1;
    }
    list
};

/// `φ₀ … φ₄` of `−z` for `z ≥ 0`, free of cancellation: `φ₀ = e^{−z}` and
/// `φ_{k+1} = (1/k! − φ_k)/z`, which is `1/k!` at `z = 0`.
///
/// `d' = −λ d + Σ s_k t^k/k!` has the solution `d(t) = φ₀ d(0) + Σ t^{k+1} φ_{k+1} s_k` with
/// `z = λ t`, and the integral `t φ₁ d(0) + Σ t^{k+2} φ_{k+2} s_k` (M. Hochbruck and A. Ostermann
/// 2010, doi 10.1017/S0962492910000048, section 2.1).
pub fn weights(z: f64) -> [f64; COUNT] {
    if z < 1.0 {
        // Taylor series of φ₄, whose terms end below 1e-18, then down the recurrence.
        let terms = if z < 0.02 { 6 } else { INVERSES.len() };
        let series = INVERSES[..terms].iter().rev().fold(1.0, |sum, i| 1.0 - z * i * sum);
        let last = series / 24.0;
        let third = 1.0 / 6.0 - z * last;
        let second = 0.5 - z * third;
        let first = 1.0 - z * second;
        return [1.0 - z * first, first, second, third, last];
    }
    let decay = (-z).exp();
    let first = (1.0 - decay) / z;
    let second = (1.0 - first) / z;
    let third = (0.5 - second) / z;
    [decay, first, second, third, (1.0 / 6.0 - third) / z]
}

/// `φ₀ … φ₃` of `−z` for complex `z` with a real part that is not negative, real and imaginary parts each.
pub fn complex_weights(z: [f64; 2]) -> [[f64; 2]; 4] {
    let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let from = |value: f64, a: [f64; 2]| [value - a[0], -a[1]];
    if z[0].hypot(z[1]) < 1.0 {
        let mut series = [1.0, 0.0];
        for j in (4..22).rev() {
            series = from(1.0, times(z, series).map(|part| part / f64::from(j)));
        }
        let third = series.map(|part| part / 6.0);
        let second = from(0.5, times(z, third));
        let first = from(1.0, times(z, second));
        return [from(1.0, times(z, first)), first, second, third];
    }
    let square = z[0] * z[0] + z[1] * z[1];
    let inverse = [z[0] / square, -z[1] / square];
    let size = (-z[0]).exp();
    let decay = [size * z[1].cos(), -size * z[1].sin()];
    let first = times(from(1.0, decay), inverse);
    let second = times(from(1.0, first), inverse);
    [decay, first, second, times(from(0.5, second), inverse)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::gauss::gauss_on;

    #[test]
    fn complex_weights_match_their_integrals() {
        for z in [[0.0, 0.3], [0.6, 0.7999], [0.6, 0.8001], [1e-3, 5.0], [12.0, 3.0]] {
            let found = complex_weights(z);
            let mut factorial = 1.0;
            for (k, value) in found.into_iter().enumerate().skip(1) {
                factorial *= (k.max(2) - 1) as f64;
                let part = |imaginary: bool| -> f64 {
                    let at = |t: f64| {
                        let angle = -z[1] * (1.0 - t);
                        let turn = if imaginary { angle.sin() } else { angle.cos() };
                        (-z[0] * (1.0 - t)).exp() * turn * t.powi(k as i32 - 1) / factorial
                    };
                    gauss_on(24, 0.0, 1.0).map(|(t, w)| w * at(t)).sum()
                };
                let off = (value[0] - part(false)).hypot(value[1] - part(true));
                assert!(off < 1e-14, "φ{k}({z:?}): {off:e}");
            }
        }
    }

    #[test]
    fn weights_match_their_integrals() {
        // φ_k = ∫₀¹ e^{−z (1 − τ)} τ^{k−1}/(k − 1)! dτ
        for z in [0.0, 1e-9, 0.019_999, 0.020_001, 0.3, 0.999_999, 1.0, 1.000_001, 4.0, 20.0] {
            let found = weights(z);
            assert!((found[0] - (-z).exp()).abs() < 1e-15, "{z}");
            let mut factorial = 1.0;
            for (k, value) in found.into_iter().enumerate().skip(1) {
                if k > 1 {
                    factorial *= (k - 1) as f64;
                }
                let integrand = |t: f64| (-z * (1.0 - t)).exp() * t.powi(k as i32 - 1) / factorial;
                let wanted: f64 = gauss_on(20, 0.0, 1.0).map(|(t, w)| w * integrand(t)).sum();
                assert!((value / wanted - 1.0).abs() < 1e-14, "φ{k}({z}) = {value}, not {wanted}");
            }
        }
    }
}
