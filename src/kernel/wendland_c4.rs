use std::f64::consts::PI;

use num_traits::Float;

use super::{Shape, real};

/// w(q) = (1 − q)⁶ (1 + 6q + 35q²/3).
///
/// Source: Wendland (1995), Adv. Comput. Math. 4, 389–396, doi 10.1007/BF02123482, function φ₃,₂.
#[derive(Debug, Clone, Copy)]
pub struct WendlandC4;

impl Shape for WendlandC4 {
    const NORMALISATION: [f64; 3] = [27.0 / 16.0, 9.0 / PI, 495.0 / (32.0 * PI)];

    #[inline(always)]
    fn value<R: Float>(q: R) -> R {
        let t = (R::one() - q).max(R::zero());
        let t2 = t * t;
        t2 * t2 * t2 * (R::one() + q * (real::<R>(6.0) + real::<R>(35.0 / 3.0) * q))
    }

    #[inline(always)]
    fn slope_over_q<R: Float>(q: R) -> R {
        let t = (R::one() - q).max(R::zero());
        let t2 = t * t;
        real::<R>(-56.0 / 3.0) * t2 * t2 * t * (R::one() + real::<R>(5.0) * q)
    }
}
