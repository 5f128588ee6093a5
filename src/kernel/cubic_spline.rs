//! The cubic spline.

use std::f64::consts::PI;

use super::{Number, Shape};

/// w(q) = 2 (1 − q)³₊ − 8 (½ − q)³₊, the B-spline M₄ of support H.
///
/// Source: Monaghan & Lattanzio (1985), Astron. Astrophys. 149, 135–143, whose smoothing length is H/2.
#[derive(Debug, Clone, Copy)]
pub struct CubicSpline;

impl Shape for CubicSpline {
    #[inline(always)]
    fn value<N: Number>(self, q: N) -> N {
        let outer = (N::constant(1.0) - q).max(N::constant(0.0));
        let inner = (N::constant(0.5) - q).max(N::constant(0.0));
        N::constant(2.0) * outer * outer * outer - N::constant(8.0) * inner * inner * inner
    }

    #[inline(always)]
    fn slope_over_q<N: Number>(self, q: N) -> N {
        // Inside ½ the two pieces leave −12q + 18q², which a quotient would lose near q = 0.
        let near = N::constant(18.0) * q - N::constant(12.0);
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        let far = N::constant(-6.0) * t * t / q.max(N::constant(0.25));
        q.choose_below(0.5, near, far)
    }

    #[inline(always)]
    fn bend_over_q<N: Number>(self, q: N) -> N {
        let near = N::constant(18.0) / q.max(N::constant(1e-3));
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        let r = q.max(N::constant(0.25));
        let far = N::constant(6.0) * t * (N::constant(2.0) * r + t) / (r * r * r);
        q.choose_below(0.5, near, far)
    }

    fn normalisation(self) -> [f64; 3] {
        [4.0 / 3.0, 40.0 / (7.0 * PI), 8.0 / PI]
    }
}
