//! The cubic B-spline.

use super::Profile;

/// φ(s) = (4/3) [(1 − s)³₊ − 4 (½ − s)³₊].
///
/// Source: Liu, Jun & Zhang (1995), Int. J. Numer. Methods Fluids 20, 1081–1106, doi 10.1002/fld.1650200824.
pub(in crate::space::reproducing) struct CubicSpline;

impl Profile for CubicSpline {
    #[inline(always)]
    fn value(s: f64) -> f64 {
        let (outer, inner) = (1.0 - s, (0.5 - s).max(0.0));
        4.0 / 3.0 * (outer * outer * outer - 4.0 * inner * inner * inner)
    }

    #[inline(always)]
    fn slope(s: f64) -> f64 {
        let (outer, inner) = (1.0 - s, (0.5 - s).max(0.0));
        16.0 * inner * inner - 4.0 * outer * outer
    }

    #[inline(always)]
    fn slope_over_s(s: f64) -> f64 {
        // Both squares equal 4 at s = 0, which a quotient would lose.
        if s < 0.5 { 12.0 * s - 8.0 } else { Self::slope(s) / s }
    }
}
