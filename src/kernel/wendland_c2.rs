use std::f64::consts::PI;

use num_traits::Float;

use super::{Shape, real};

/// w(q) = (1 − q)⁴ (1 + 4q).
///
/// Source: Wendland (1995), Adv. Comput. Math. 4, 389–396, doi 10.1007/BF02123482, function φ₃,₁.
#[derive(Debug, Clone, Copy)]
pub struct WendlandC2;

impl Shape for WendlandC2 {
    const NORMALISATION: [f64; 3] = [3.0 / 2.0, 7.0 / PI, 21.0 / (2.0 * PI)];

    #[inline(always)]
    fn value<R: Float>(q: R) -> R {
        let t = (R::one() - q).max(R::zero());
        let t2 = t * t;
        t2 * t2 * (R::one() + real::<R>(4.0) * q)
    }

    #[inline(always)]
    fn slope_over_q<R: Float>(q: R) -> R {
        let t = (R::one() - q).max(R::zero());
        real::<R>(-20.0) * t * t * t
    }
}
