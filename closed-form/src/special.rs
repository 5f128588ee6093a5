//! Special functions of conduction: repeated integrals of the complementary error function.
//!
//! Source: W. Gautschi, "Computational aspects of three-term recurrence relations", SIAM Rev. 9
//! (1967) 24–82, doi 10.1137/1009002: `iⁿerfc` is the minimal solution of
//! `2n iⁿerfc = iⁿ⁻²erfc − 2x iⁿ⁻¹erfc`, so that the ratios `r_n = iⁿ⁺¹erfc/iⁿerfc` obey the
//! continued fraction `r_{n−1} = 1/(2x + 2(n+1) r_n)`, free of cancellation.

use std::f64::consts::FRAC_2_SQRT_PI;

/// Above this argument the continued fraction replaces the defining formula.
const FRACTION_FROM: f64 = 2.0;
/// Terms of the continued fraction: its error is below 2e-16 for `x ≥ 2`.
const FRACTION_TERMS: u32 = 60;

/// Ratios `erfc x / i⁻¹erfc x` and `ierfc x / erfc x`, where `i⁻¹erfc x = 2/√π e^{−x²}`.
fn ratios(x: f64) -> (f64, f64) {
    let second = (2..=FRACTION_TERMS).rev().fold(0.0, |r, n| 1.0 / (2.0 * (x + f64::from(n) * r)));
    (1.0 / (2.0 * (x + second)), second)
}

/// Scaled complementary error function `e^{x²} erfc x`, to about 1e-14 relative for `x ≥ 0`.
pub fn erfcx(x: f64) -> f64 {
    if x < FRACTION_FROM {
        return (x * x).exp() * libm::erfc(x);
    }
    FRAC_2_SQRT_PI * ratios(x).0
}

/// First repeated integral `ierfc x = ∫ₓ^∞ erfc = e^{−x²}/√π − x erfc x`.
///
/// Relative accuracy 1e-13 up to `x = 10`; beyond, the rounding of `x²` in the exponent costs
/// about `x²` units in the last place.
pub fn ierfc(x: f64) -> f64 {
    let gauss = (-x * x).exp();
    if x < FRACTION_FROM {
        return 0.5 * FRAC_2_SQRT_PI * gauss - x * libm::erfc(x);
    }
    let (first, second) = ratios(x);
    FRAC_2_SQRT_PI * gauss * first * second
}

/// `ierfc x − ierfc(x + d)` for `x ≥ 0`, `d ≥ 0`, without cancellation when both arguments are
/// small: `ierfc x = −x + h(x)` with the even function `h(x) = e^{−x²}/√π + x erf x`.
pub fn ierfc_drop(x: f64, d: f64) -> f64 {
    let end = x + d;
    if end > 0.5 {
        return ierfc(x) - ierfc(end);
    }
    let even = |x: f64| 0.5 * FRAC_2_SQRT_PI * (-x * x).exp_m1() + x * libm::erf(x);
    d + even(x) - even(end)
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::*;

    /// `(x, ierfc x, e^{x²} erfc x)` computed with 40 digits.
    const REFERENCE: [(f64, f64, f64); 10] = [
        (-0.5, 1.1996412283742457, 1.952360489182557),
        (0.0, 0.5641895835477563, 1.0),
        (0.5, 0.19964122837424567, 0.6156903441929259),
        (1.0, 0.0502545416600122, 0.427583576155807),
        (1.5, 0.008622864324780776, 0.3215854164543175),
        (2.0, 0.0009780227149514952, 0.25539567631050575),
        (2.5, 7.176207156395751e-05, 0.2108063640611436),
        (5.0, 1.481342933684934e-13, 0.11070463773306863),
        (10.0, 1.0340531914663687e-46, 0.05614099274382259),
        (20.0, 1.3456148718190446e-177, 0.02817434874105132),
    ];

    #[test]
    fn ierfc_and_erfcx_match_multiprecision_values() {
        for (x, ierfc_value, erfcx_value) in REFERENCE {
            assert_close(ierfc(x), ierfc_value, 1e-13);
            assert_close(erfcx(x), erfcx_value, 2e-15);
        }
    }

    #[test]
    fn both_branches_agree_where_they_join() {
        let (below, above) = (FRACTION_FROM.next_down(), FRACTION_FROM);
        assert_close(ierfc(below), ierfc(above), 1e-13);
        assert_close(erfcx(below), erfcx(above), 1e-14);
    }

    #[test]
    fn derivative_of_ierfc_is_minus_erfc() {
        for x in [-0.7, 0.3, 1.2, 2.8, 6.0] {
            assert_close(derivative(ierfc, x, 2e-3), -libm::erfc(x), 1e-9);
        }
    }

    #[test]
    fn ierfc_drop_is_accurate_for_small_steps() {
        assert_close(ierfc_drop(0.1, 0.3), ierfc(0.1) - ierfc(0.4), 1e-14);
        assert_close(ierfc_drop(0.3, 1.0), ierfc(0.3) - ierfc(1.3), 1e-14);
        assert_close(ierfc_drop(0.0, 1e-9), 1e-9 * (1.0 - 0.5 * FRAC_2_SQRT_PI * 1e-9), 1e-15);
    }
}
