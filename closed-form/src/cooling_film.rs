//! Film of thickness δ, insulated above, whose lower face suddenly has another temperature. `F(Fo)` is the fraction of
//! its heat released after a time, `Fo = at/δ²`.
//!
//! Source: J. Crank, *The Mathematics of Diffusion*, 2nd ed., Oxford 1975, eqs. 4.18 and 4.20 (a sheet of twice the
//! thickness between two such faces).

use std::f64::consts::{FRAC_2_SQRT_PI, PI};

use super::special::ierfc;

/// Fourier number below which images replace the series. Both are accurate to rounding there.
const EARLY: f64 = 0.2;
/// Distance of an image over the diffusion length beyond which it is below rounding: erfc(6) = 2e-17.
const FARTHEST: f64 = 6.0;
/// Terms of the series, in m² and 8/m²; at [`EARLY`] the next one is e⁻⁴⁰.
const ODD_SQUARES: [i32; 4] = [1, 9, 25, 49];
/// Number of bisections in the search for a Fourier number.
const HALVINGS: usize = 100;

/// F: `2√Fo [1/√π + 2 Σ (−1)ⁿ ierfc(n/√Fo)]`, n from 1, or `1 − Σ 8/(m²π²) e^{−m²π²Fo/4}`, m = 1, 3, 5 …
pub fn given_part(fourier: f64) -> f64 {
    if fourier <= 0.0 {
        return 0.0;
    }
    if fourier < EARLY {
        let root = fourier.sqrt();
        let images = (1..).map(|n| f64::from(n) / root).take_while(|&distance| distance < FARTHEST);
        let (sum, _) =
            images.fold((0.0, -1.0), |(sum, sign), distance| (sum + sign * ierfc(distance), -sign));
        return 2.0 * root * (0.5 * FRAC_2_SQRT_PI + 2.0 * sum);
    }
    let decay = (-0.25 * PI * PI * fourier).exp();
    let term = |square: i32| 8.0 / (f64::from(square) * PI * PI) * decay.powi(square);
    1.0 - ODD_SQUARES.into_iter().rev().map(term).sum::<f64>()
}

/// The Fourier number at which a fraction of all heat, from 0 to below 1, has been released.
pub fn fourier_number(part: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while given_part(high) < part && high < 1e3 {
        high *= 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if given_part(middle) < part { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_and_series_meet() {
        let [before, after] = [EARLY * (1.0 - 1e-12), EARLY].map(given_part);
        assert!((before - after).abs() < 1e-12, "{before} {after}");
    }

    /// Explicit differences on 400 intervals, of second order.
    #[test]
    fn matches_finite_differences_of_the_heat_equation() {
        let n = 400_usize;
        let (h, mut rise) = (1.0 / n as f64, vec![1.0; n + 1]);
        (rise[0], rise[n]) = (0.0, 1.0);
        let (step, mut fourier) = (0.4 * h * h, 0.0);
        for wanted in [0.02, 0.1, 0.5, 1.2] {
            while fourier < wanted {
                let old = rise.clone();
                for i in 1..n {
                    rise[i] += 0.4 * (old[i - 1] - 2.0 * old[i] + old[i + 1]);
                }
                rise[n] += 0.8 * (old[n - 1] - old[n]);
                fourier += step;
            }
            let inner: f64 = rise[1..n].iter().sum();
            let given = 1.0 - h * (inner + 0.5 * rise[n]);
            assert!((given_part(fourier) - given).abs() < 2e-3, "{wanted}: {given}");
        }
    }

    #[test]
    fn the_inverse_is_one() {
        for part in [1e-6, 0.01, 0.3, 0.5, 0.9, 0.999] {
            assert!((given_part(fourier_number(part)) / part - 1.0).abs() < 1e-12, "{part}");
        }
        assert_eq!(given_part(0.0), 0.0);
    }
}
