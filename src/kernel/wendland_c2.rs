//! The Wendland C² kernel.

use std::f64::consts::PI;

use super::{Number, Shape};

/// w(q) = (1 − q)⁴ (1 + 4q).
///
/// Source: Wendland (1995), Adv. Comput. Math. 4, 389–396, doi 10.1007/BF02123482, function φ₃,₁.
#[derive(Debug, Clone, Copy)]
pub struct WendlandC2;

impl Shape for WendlandC2 {
    #[inline(always)]
    fn value<N: Number>(self, q: N) -> N {
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        let t2 = t * t;
        t2 * t2 * (N::constant(1.0) + N::constant(4.0) * q)
    }

    #[inline(always)]
    fn slope_over_q<N: Number>(self, q: N) -> N {
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        N::constant(-20.0) * t * t * t
    }

    #[inline(always)]
    fn bend_over_q<N: Number>(self, q: N) -> N {
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        N::constant(60.0) * t * t / q.max(N::constant(1e-3))
    }

    fn normalisation(self) -> [f64; 3] {
        [3.0 / 2.0, 7.0 / PI, 21.0 / (2.0 * PI)]
    }
}
