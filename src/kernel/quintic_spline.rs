use std::f64::consts::PI;

use num_traits::Float;

use super::{Shape, real};

/// w(q) = (3 − s)⁵₊ − 6 (2 − s)⁵₊ + 15 (1 − s)⁵₊ with s = 3q, the B-spline M₆ of support H.
///
/// Source: Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214–226, doi 10.1006/jcph.1997.5776, whose
/// smoothing length is H/3.
#[derive(Debug, Clone, Copy)]
pub struct QuinticSpline;

impl Shape for QuinticSpline {
    const NORMALISATION: [f64; 3] = [1.0 / 40.0, 63.0 / (478.0 * PI), 9.0 / (40.0 * PI)];

    #[inline(always)]
    fn value<R: Float>(q: R) -> R {
        let s = real::<R>(3.0) * q;
        let power = |reach: f64| {
            let t = (real::<R>(reach) - s).max(R::zero());
            let t2 = t * t;
            t2 * t2 * t
        };
        power(3.0) - real::<R>(6.0) * power(2.0) + real::<R>(15.0) * power(1.0)
    }

    #[inline(always)]
    fn slope_over_q<R: Float>(q: R) -> R {
        let s = real::<R>(3.0) * q;
        // Inside s = 1 the pieces leave s (120 − 120 s² + 50 s³) · (−1), whose quotient is exact.
        let near = -(real::<R>(120.0) - s * s * (real::<R>(120.0) - real::<R>(50.0) * s));
        let power = |reach: f64| {
            let t = (real::<R>(reach) - s).max(R::zero());
            let t2 = t * t;
            t2 * t2
        };
        let far = real::<R>(-5.0) * (power(3.0) - real::<R>(6.0) * power(2.0)) / s.max(real(0.5));
        real::<R>(9.0) * if s < R::one() { near } else { far }
    }
}
