//! The quintic spline.

use std::f64::consts::PI;

use super::{Number, Shape};

/// w(q) = (3 − s)⁵₊ − 6 (2 − s)⁵₊ + 15 (1 − s)⁵₊ with s = 3q, the B-spline M₆ of support H.
///
/// Source: Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214–226, doi 10.1006/jcph.1997.5776, whose
/// smoothing length is H/3.
#[derive(Debug, Clone, Copy)]
pub struct QuinticSpline;

impl Shape for QuinticSpline {
    #[inline(always)]
    fn value<N: Number>(self, q: N) -> N {
        let s = N::constant(3.0) * q;
        let power = |reach: f64| {
            let t = (N::constant(reach) - s).max(N::constant(0.0));
            let t2 = t * t;
            t2 * t2 * t
        };
        power(3.0) - N::constant(6.0) * power(2.0) + N::constant(15.0) * power(1.0)
    }

    #[inline(always)]
    fn slope_over_q<N: Number>(self, q: N) -> N {
        let s = N::constant(3.0) * q;
        // Inside s = 1 the pieces leave s (120 − 120 s² + 50 s³) · (−1), whose quotient is exact.
        let near = s * s * (N::constant(120.0) - N::constant(50.0) * s) - N::constant(120.0);
        let power = |reach: f64| {
            let t = (N::constant(reach) - s).max(N::constant(0.0));
            let t2 = t * t;
            t2 * t2
        };
        let far = N::constant(-5.0) * (power(3.0) - N::constant(6.0) * power(2.0))
            / s.max(N::constant(0.5));
        N::constant(9.0) * s.choose_below(1.0, near, far)
    }

    #[inline(always)]
    fn bend_over_q<N: Number>(self, q: N) -> N {
        let s = N::constant(3.0) * q;
        let near = N::constant(19440.0) - N::constant(12150.0) * s;
        let power = |reach: f64| {
            let t = (N::constant(reach) - s).max(N::constant(0.0));
            [t * t * t, t * t * t * t]
        };
        let ([a3, a4], [b3, b4]) = (power(3.0), power(2.0));
        let value = a4 - N::constant(6.0) * b4;
        let slope = N::constant(24.0) * b3 - N::constant(4.0) * a3;
        let t = s.max(N::constant(0.5));
        let far = N::constant(-405.0) * (slope * t - value) / (t * t * t);
        s.choose_below(1.0, near, far)
    }

    fn normalisation(self) -> [f64; 3] {
        [1.0 / 40.0, 63.0 / (478.0 * PI), 9.0 / (40.0 * PI)]
    }
}
