//! Kernels of reproducing-kernel functions, one per file: φ(s) over the distance s in units of the support.

mod cubic_spline;
mod quartic_spline;

pub(super) use cubic_spline::CubicSpline;
pub(super) use quartic_spline::QuarticSpline;

/// Smoothness and width of the functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kernel {
    /// The cubic B-spline, usual in the reproducing kernel particle method.
    #[default]
    CubicSpline,
    /// The quartic spline, usual in the element-free Galerkin method.
    QuarticSpline,
}

/// φ on 0 ≤ s < 1; its scale is arbitrary, because moment matrices divide by it.
pub(super) trait Profile {
    fn value(s: f64) -> f64;

    /// φ′(s).
    fn slope(s: f64) -> f64;

    /// φ′(s)/s, finite at s = 0.
    fn slope_over_s(s: f64) -> f64;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<P: Profile>(at_half: f64) {
        assert!((P::value(0.5) / P::value(0.0) - at_half).abs() < 1e-15);
        assert_eq!((P::value(1.0), P::slope(1.0)), (0.0, 0.0));
        for s in [0.0, 0.1, 0.3, 0.5, 0.6, 0.99] {
            let difference = (P::value(s + 1e-6) - P::value(s - 1e-6)) / 2e-6;
            assert!(s == 0.0 || (P::slope(s) - difference).abs() < 1e-9, "{s}");
            assert!((s * P::slope_over_s(s) - P::slope(s)).abs() < 1e-14, "{s}");
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        check::<CubicSpline>(0.25);
        check::<QuarticSpline>(0.3125);
    }
}
