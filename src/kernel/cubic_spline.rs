use std::f64::consts::PI;

use num_traits::Float;

use super::{Shape, real};

/// w(q) = 2 (1 − q)³₊ − 8 (½ − q)³₊, the B-spline M₄ of support H.
///
/// Source: Monaghan & Lattanzio (1985), Astron. Astrophys. 149, 135–143, whose smoothing length is H/2.
#[derive(Debug, Clone, Copy)]
pub struct CubicSpline;

impl Shape for CubicSpline {
    const NORMALISATION: [f64; 3] = [4.0 / 3.0, 40.0 / (7.0 * PI), 8.0 / PI];

    #[inline(always)]
    fn value<R: Float>(q: R) -> R {
        let outer = (R::one() - q).max(R::zero());
        let inner = (real::<R>(0.5) - q).max(R::zero());
        real::<R>(2.0) * outer * outer * outer - real::<R>(8.0) * inner * inner * inner
    }

    #[inline(always)]
    fn slope_over_q<R: Float>(q: R) -> R {
        // Inside ½ the two pieces leave −12q + 18q², which a quotient would lose near q = 0.
        let near = real::<R>(18.0) * q - real::<R>(12.0);
        let t = (R::one() - q).max(R::zero());
        let far = real::<R>(-6.0) * t * t / q.max(real(0.25));
        if q < real(0.5) { near } else { far }
    }
}
