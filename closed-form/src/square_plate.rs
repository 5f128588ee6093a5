//! Clamped thin square plate under uniform pressure.
//!
//! Source: R. L. Taylor and S. Govindjee, Commun. Numer. Meth. Engng 20 (2004) 757–765,
//! doi 10.1002/cnm.652.

use super::medium::Elastic;

/// Deflection of the centre over `p a⁴/D` [1].
const CENTRE_DEFLECTION: f64 = 0.00126532;

/// The plate and its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquarePlate {
    pub body: Elastic,
    /// Side a [m].
    pub side: f64,
    /// Thickness h [m].
    pub thickness: f64,
    /// Pressure p [Pa].
    pub pressure: f64,
}

impl SquarePlate {
    /// Deflection of the centre along the pressure [m] `w = 0.00126532 p a⁴/D`.
    pub fn deflection_at_centre(&self) -> f64 {
        let rigidity = self.body.plate_rigidity(self.thickness);
        CENTRE_DEFLECTION * self.pressure * self.side.powi(4) / rigidity
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::super::checks::{ALUMINA_ELASTIC, assert_close};
    use super::super::circular_plate::CircularPlate;
    use super::*;

    /// Centre deflection over `p a⁴/D` by Ritz' method on [−1, 1]² with the functions
    /// `φ_i(x) φ_j(y)`, `φ_i = (1 − x²)² x^{2i}`, which minimise `∫ ½ (∇²w)² − w`.
    fn ritz(order: usize) -> f64 {
        type Polynomial = Vec<(f64, i32)>;
        let shape = |i: usize| -> Polynomial {
            let power = 2 * i as i32;
            vec![(1.0, power), (-2.0, power + 2), (1.0, power + 4)]
        };
        let bend = |i: usize| -> Polynomial {
            shape(i).iter().map(|&(c, n)| (c * f64::from(n * (n - 1)), n - 2)).collect()
        };
        let product = |left: &Polynomial, right: &Polynomial| -> f64 {
            let pairs = left.iter().flat_map(|l| right.iter().map(move |r| (l, r)));
            let nonzero = pairs.filter(|(l, r)| l.0 * r.0 != 0.0);
            nonzero.map(|(l, r)| 2.0 * l.0 * r.0 / f64::from(l.1 + r.1 + 1)).sum()
        };
        let matrix = |left: &dyn Fn(usize) -> Polynomial, right: &dyn Fn(usize) -> Polynomial| {
            DMatrix::from_fn(order, order, |i, j| product(&left(i), &right(j)))
        };
        let (mass, stiff) = (matrix(&shape, &shape), matrix(&bend, &bend));
        let mixed = matrix(&bend, &shape);
        let energy = stiff.kronecker(&mass)
            + mass.kronecker(&stiff)
            + mixed.kronecker(&mixed.transpose())
            + mixed.transpose().kronecker(&mixed);
        let load = DVector::from_fn(order, |i, _| product(&shape(i), &vec![(1.0, 0)]));
        let weights = energy.lu().solve(&load.kronecker(&load)).expect("a regular energy");
        weights[0] / 16.0
    }

    #[test]
    fn ritz_method_converges_to_the_coefficient() {
        assert_close(ritz(3), CENTRE_DEFLECTION, 1e-3);
        assert_close(ritz(6), CENTRE_DEFLECTION, 4e-6);
    }

    #[test]
    fn lies_between_the_inscribed_and_the_circumscribed_circle() {
        let square =
            SquarePlate { body: ALUMINA_ELASTIC, side: 2e-3, thickness: 0.1e-3, pressure: 1e5 };
        let circle = |radius: f64| CircularPlate {
            body: square.body,
            radius,
            thickness: 0.1e-3,
            pressure: 1e5,
        };
        assert!(square.deflection_at_centre() > circle(1e-3).deflection(0.0));
        assert!(square.deflection_at_centre() < circle(2f64.sqrt() * 1e-3).deflection(0.0));
    }
}
