//! The quartic spline.

use super::Profile;

/// φ(s) = 1 − 6s² + 8s³ − 3s⁴ = (1 − s)³ (1 + 3s).
///
/// Source: Belytschko, Krongauz, Organ, Fleming & Krysl (1996), Comput. Methods Appl. Mech. Eng. 139, 3–47,
/// doi 10.1016/S0045-7825(96)01078-X.
pub(in crate::space::reproducing) struct QuarticSpline;

impl Profile for QuarticSpline {
    #[inline(always)]
    fn value(s: f64) -> f64 {
        let t = 1.0 - s;
        t * t * t * (1.0 + 3.0 * s)
    }

    #[inline(always)]
    fn slope(s: f64) -> f64 {
        s * Self::slope_over_s(s)
    }

    #[inline(always)]
    fn slope_over_s(s: f64) -> f64 {
        -12.0 * (1.0 - s) * (1.0 - s)
    }
}
