//! Smoothing kernels of particle methods, one per file.
//!
//! One convention everywhere: the smoothing length *H is the support radius*, q = r/H, and
//! `W(r, H) = σ_d / H^d · w(q)` with w(q) = 0 for q ≥ 1 and ∫ W dV = 1 in d dimensions.

mod cubic_spline;
mod quintic_spline;
mod wendland_c2;
mod wendland_c4;

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Sub};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use cubic_spline::CubicSpline;
pub use quintic_spline::QuinticSpline;
pub use wendland_c2::WendlandC2;
pub use wendland_c4::WendlandC4;

use crate::math::gauss::gauss_on;

/// Argument of the kernels' formulas: a number, or many numbers in the lanes of a vector.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    fn constant(value: f64) -> Self;

    fn max(self, other: Self) -> Self;

    fn sqrt(self) -> Self;

    /// Returns `low` where this is below the limit, `high` elsewhere.
    fn choose_below(self, limit: f64, low: Self, high: Self) -> Self;
}

macro_rules! number {
    ($real:ty) => {
        impl Number for $real {
            #[inline(always)]
            fn constant(value: f64) -> Self {
                value as $real
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                <$real>::sqrt(self)
            }

            #[inline(always)]
            fn choose_below(self, limit: f64, low: Self, high: Self) -> Self {
                if self < limit as $real { low } else { high }
            }
        }
    };
}

number!(f32);
number!(f64);

/// The dimensionless shape of a kernel. No formula branches on q, so that loops over many pairs compile to vector
/// instructions.
pub trait Shape: Copy + Sync {
    /// w(q), zero for q ≥ 1.
    fn value<N: Number>(self, q: N) -> N;

    /// w′(q)/q: zero for q ≥ 1; smooth kernels have a finite limit at q = 0.
    fn slope_over_q<N: Number>(self, q: N) -> N;

    /// F′(q)/q of F = w′(q)/q, which completes the second derivatives of W:
    /// `∂²w/∂x_a∂x_b = F δ_ab + (F′/q) x_a x_b`.
    fn bend_over_q<N: Number>(self, q: N) -> N;

    /// σ_d for d = 1, 2, 3.
    fn normalisation(self) -> [f64; 3];
}

/// A kernel by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// Also called Wendland's quintic: smooth, cheap and without clumping.
    #[default]
    WendlandC2,
    /// Wendland's kernel of the next order of smoothness.
    WendlandC4,
    /// The cubic B-spline.
    CubicSpline,
    /// The quintic B-spline.
    QuinticSpline,
}

/// Evaluates an expression with the shape of a kernel.
macro_rules! with_shape {
    ($kernel:expr, $shape:ident => $call:expr) => {
        match $kernel {
            Kernel::WendlandC2 => {
                let $shape = WendlandC2;
                $call
            }
            Kernel::WendlandC4 => {
                let $shape = WendlandC4;
                $call
            }
            Kernel::CubicSpline => {
                let $shape = CubicSpline;
                $call
            }
            Kernel::QuinticSpline => {
                let $shape = QuinticSpline;
                $call
            }
        }
    };
}

/// Shape of a kernel that is chosen at run time, for one code of all kernels. Each value costs a branch.
#[derive(Debug, Clone, Copy)]
pub struct Chosen(pub Kernel);

impl Shape for Chosen {
    #[inline(always)]
    fn value<N: Number>(self, q: N) -> N {
        with_shape!(self.0, shape => shape.value(q))
    }

    #[inline(always)]
    fn slope_over_q<N: Number>(self, q: N) -> N {
        with_shape!(self.0, shape => shape.slope_over_q(q))
    }

    #[inline(always)]
    fn bend_over_q<N: Number>(self, q: N) -> N {
        with_shape!(self.0, shape => shape.bend_over_q(q))
    }

    fn normalisation(self) -> [f64; 3] {
        with_shape!(self.0, shape => shape.normalisation())
    }
}

impl Kernel {
    pub const ALL: [Kernel; 4] =
        [Kernel::WendlandC2, Kernel::WendlandC4, Kernel::CubicSpline, Kernel::QuinticSpline];

    /// W(r, H) [1/m^d].
    pub fn value(self, r: f64, support: f64, dimension: usize) -> f64 {
        self.scale(support, dimension) * Chosen(self).value(r / support)
    }

    /// The factor F of ∇W = F · (r_i − r_j), i.e. (1/r) ∂W/∂r [1/m^(d+2)]; never positive.
    pub fn gradient_factor(self, r: f64, support: f64, dimension: usize) -> f64 {
        let slope = Chosen(self).slope_over_q(r / support);
        self.scale(support, dimension) * slope / (support * support)
    }

    /// ∫ r² W dV over H².
    pub fn second_moment(self, dimension: usize) -> f64 {
        let square = |q: f64| q * q * self.value(q, 1.0, dimension);
        integral(dimension, 1.0, square)
    }

    /// −∫ F dV times H², with ∇W = F r.
    pub fn mean_slope(self, dimension: usize) -> f64 {
        -integral(dimension, 1.0, |q| self.gradient_factor(q, 1.0, dimension))
    }

    /// σ_d / H^d [1/m^d].
    pub fn scale(self, support: f64, dimension: usize) -> f64 {
        Chosen(self).normalisation()[dimension - 1] / support.powi(dimension as i32)
    }
}

/// ∫ f(r) dV over the support by Gauss quadrature, exact for piecewise polynomials: knots of the splines
/// lie at multiples of H/6.
fn integral(dimension: usize, support: f64, f: impl Fn(f64) -> f64) -> f64 {
    const PIECES: usize = 6;
    let sphere = [2.0, 2.0 * PI, 4.0 * PI][dimension - 1];
    let mut sum = 0.0;
    for piece in 0..PIECES {
        let [a, b] = [piece, piece + 1].map(|knot| support * knot as f64 / PIECES as f64);
        for (r, weight) in gauss_on(8, a, b) {
            sum += weight * sphere * r.powi(dimension as i32 - 1) * f(r);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUPPORT: f64 = 0.7;

    fn for_all(test: impl Fn(Kernel, usize)) {
        for kernel in Kernel::ALL {
            (1..=3).for_each(|dimension| test(kernel, dimension));
        }
    }

    #[test]
    fn integral_is_one() {
        for_all(|kernel, d| {
            let sum = integral(d, SUPPORT, |r| kernel.value(r, SUPPORT, d));
            assert!((sum - 1.0).abs() < 1e-13, "{kernel:?} {d}-D: {sum}");
        });
    }

    #[test]
    fn gradient_is_the_derivative_of_the_value() {
        for_all(|kernel, d| {
            for q in [0.05, 0.2, 0.4, 0.6, 0.75, 0.95] {
                let (r, step) = (q * SUPPORT, 1e-5);
                let ahead = kernel.value(r + step, SUPPORT, d);
                let behind = kernel.value(r - step, SUPPORT, d);
                let slope = (ahead - behind) / (2.0 * step);
                let factor = kernel.gradient_factor(r, SUPPORT, d);
                let scale = kernel.value(0.0, SUPPORT, d) / SUPPORT;
                assert!((slope - factor * r).abs() < 1e-7 * scale, "{kernel:?} {d}-D at {q}");
                assert!(factor < 0.0, "{kernel:?} {d}-D at {q}");
            }
        });
    }

    #[test]
    fn bend_is_the_derivative_of_the_gradient_factor() {
        for kernel in Kernel::ALL {
            let shape = Chosen(kernel);
            for q in [0.05, 0.2, 0.45, 0.6, 0.75, 0.95, 1.2] {
                let step = 1e-6;
                let ahead: f64 = shape.slope_over_q(q + step);
                let slope = (ahead - shape.slope_over_q(q - step)) / (2.0 * step);
                let scale = shape.slope_over_q(0.01f64).abs();
                assert!(
                    (slope - shape.bend_over_q(q) * q).abs() < 1e-6 * scale,
                    "{kernel:?} at {q}"
                );
            }
        }
    }

    #[test]
    fn first_moment_of_the_gradient_is_minus_one() {
        // ∫ r ⊗ ∇W dV = −1, one diagonal entry: ∫ F r² dV / d = −1.
        for_all(|kernel, d| {
            let factor = |r| kernel.gradient_factor(r, SUPPORT, d) * r * r;
            let moment = integral(d, SUPPORT, factor) / d as f64;
            assert!((moment + 1.0).abs() < 1e-13, "{kernel:?} {d}-D: {moment}");
        });
    }

    #[test]
    fn second_moment_matches_quadrature() {
        // By parts, ∫ F r⁴ dV = −(d + 2) ∫ r² W dV.
        for_all(|kernel, d| {
            let fourth = |r: f64| kernel.gradient_factor(r, SUPPORT, d) * r.powi(4);
            let expected = -(d as f64 + 2.0) * SUPPORT * SUPPORT * kernel.second_moment(d);
            let moment = integral(d, SUPPORT, fourth);
            assert!((moment / expected - 1.0).abs() < 1e-12, "{kernel:?} {d}-D: {moment}");
        });
        assert!((Kernel::WendlandC2.second_moment(3) - 0.2).abs() < 1e-14);
    }

    #[test]
    fn support_is_compact() {
        for_all(|kernel, d| {
            for q in [1.0, 1.0 + 1e-12, 1.5, 30.0] {
                assert_eq!(kernel.value(q * SUPPORT, SUPPORT, d), 0.0);
                assert_eq!(kernel.gradient_factor(q * SUPPORT, SUPPORT, d), 0.0);
            }
        });
    }

    #[test]
    fn value_decreases_monotonically() {
        for_all(|kernel, d| {
            let values: Vec<f64> = (0..=100)
                .map(|i| kernel.value(0.01 * f64::from(i) * SUPPORT, SUPPORT, d))
                .collect();
            assert!(values.windows(2).all(|pair| pair[1] < pair[0]), "{kernel:?} {d}-D");
        });
    }

    #[test]
    fn single_precision_agrees_with_double() {
        for i in 0..=120 {
            let q = 0.01 * f64::from(i);
            let check = |single: f32, double: f64, scale: f64| {
                assert!((f64::from(single) - double).abs() < 2e-6 * scale, "{q}");
            };
            for kernel in Kernel::ALL {
                let shape = Chosen(kernel);
                check(shape.value(q as f32), shape.value(q), shape.value(0.0f64));
                let near = shape.slope_over_q(0.01f64).abs();
                check(shape.slope_over_q(q as f32), shape.slope_over_q(q), near);
                let bend = (shape.bend_over_q(0.01f64) * 0.01).abs() + near;
                check(
                    shape.bend_over_q(q as f32) * q as f32,
                    shape.bend_over_q(q) * q,
                    10.0 * bend,
                );
            }
        }
    }
}
