//! Film of thickness δ, insulated above, whose lower face is brought to another temperature and held there: the part
//! `F(Fo)` of all its heat that it has given after a time, `Fo = at/δ²`.
//!
//! Source: J. Crank, *The Mathematics of Diffusion*, 2nd ed., Oxford 1975, eqs. 4.18 and 4.20 (a sheet of twice the
//! thickness between two such faces).

use std::f64::consts::{FRAC_2_SQRT_PI, PI};

use super::special::ierfc;

/// Fourier number below which images replace the series. Both are at rounding there.
const EARLY: f64 = 0.2;
/// Images, or terms of the series, that are summed.
const TERMS: u32 = 8;
/// Halvings of the interval in which a Fourier number is searched for.
const HALVINGS: usize = 100;

/// F: `2√Fo [1/√π + 2 Σ (−1)ⁿ ierfc(n/√Fo)]`, n from 1, or `1 − Σ 8/(m²π²) e^{−m²π²Fo/4}`, m = 1, 3, 5 …
pub fn given_part(fourier: f64) -> f64 {
    if fourier <= 0.0 {
        return 0.0;
    }
    if fourier < EARLY {
        let root = fourier.sqrt();
        let sign = |n: u32| if n.is_multiple_of(2) { 1.0 } else { -1.0 };
        let images: f64 = (1..=TERMS).rev().map(|n| sign(n) * ierfc(f64::from(n) / root)).sum();
        return 2.0 * root * (0.5 * FRAC_2_SQRT_PI + 2.0 * images);
    }
    let term = |n: u32| {
        let square = (f64::from(2 * n + 1) * PI).powi(2);
        8.0 / square * (-0.25 * square * fourier).exp()
    };
    1.0 - (0..TERMS).rev().map(term).sum::<f64>()
}

/// The Fourier number at which a part of all heat, from 0 to below 1, has been given.
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
    fn it_solves_the_heat_equation() {
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
