//! The Wendland C⁴ kernel.

use std::f64::consts::PI;

use super::{Number, Shape};

/// w(q) = (1 − q)⁶ (1 + 6q + 35q²/3).
///
/// Source: Wendland (1995), Adv. Comput. Math. 4, 389–396, doi 10.1007/BF02123482, function φ₃,₂.
#[derive(Debug, Clone, Copy)]
pub struct WendlandC4;

impl Shape for WendlandC4 {
    #[inline(always)]
    fn value<N: Number>(self, q: N) -> N {
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        let t2 = t * t;
        t2 * t2 * t2 * (N::constant(1.0) + q * (N::constant(6.0) + N::constant(35.0 / 3.0) * q))
    }

    #[inline(always)]
    fn slope_over_q<N: Number>(self, q: N) -> N {
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        let t2 = t * t;
        N::constant(-56.0 / 3.0) * t2 * t2 * t * (N::constant(1.0) + N::constant(5.0) * q)
    }

    #[inline(always)]
    fn bend_over_q<N: Number>(self, q: N) -> N {
        let t = (N::constant(1.0) - q).max(N::constant(0.0));
        let t2 = t * t;
        N::constant(560.0) * t2 * t2
    }

    fn normalisation(self) -> [f64; 3] {
        [27.0 / 16.0, 9.0 / PI, 495.0 / (32.0 * PI)]
    }
}
