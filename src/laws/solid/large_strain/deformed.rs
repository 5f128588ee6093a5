//! Kinematics of a point.

use crate::math::matrix3::{Matrix3, inverse, transposed};

/// Deformation of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deformed {
    /// F.
    pub gradient: Matrix3,
    /// F^(−T).
    pub inverse_transposed: Matrix3,
    /// J.
    pub dilatation: f64,
}

impl Deformed {
    pub fn of(gradient: Matrix3) -> Self {
        let (inverse, dilatation) = inverse(&gradient);
        Self { gradient, inverse_transposed: transposed(&inverse), dilatation }
    }
}
