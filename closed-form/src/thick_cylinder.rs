//! Thick cylinder under internal pressure, in plane strain. As `ν → ½` it shows volumetric locking
//! of axisymmetric elements.
//!
//! Source: G. Lamé 1852; S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*, 3rd ed.,
//! McGraw-Hill 1970, §28.

use super::medium::Elastic;

/// Cylinder `a ≤ r ≤ b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThickCylinder {
    pub body: Elastic,
    /// Inner radius a [m].
    pub inner: f64,
    /// Outer radius b [m].
    pub outer: f64,
    /// Pressure p on the inner face [Pa].
    pub pressure: f64,
}

impl ThickCylinder {
    /// Radial stress [Pa] `σ_rr = A (1 − b²/r²)`, `A = p a²/(b² − a²)`.
    pub fn radial_stress(&self, r: f64) -> f64 {
        self.mean_stress_in_plane() * (1.0 - (self.outer / r).powi(2))
    }

    /// Hoop stress [Pa] `σ_θθ = A (1 + b²/r²)`.
    pub fn hoop_stress(&self, r: f64) -> f64 {
        self.mean_stress_in_plane() * (1.0 + (self.outer / r).powi(2))
    }

    /// Axial stress [Pa] `σ_zz = 2ν A`.
    pub fn axial_stress(&self) -> f64 {
        2.0 * self.body.poisson * self.mean_stress_in_plane()
    }

    /// Radial displacement [m] `u = (1+ν)/E · A [(1−2ν) r + b²/r]`.
    pub fn radial_displacement(&self, r: f64) -> f64 {
        let nu = self.body.poisson;
        let shape = (1.0 - 2.0 * nu) * r + self.outer * self.outer / r;
        (1.0 + nu) / self.body.young * self.mean_stress_in_plane() * shape
    }

    /// `A = p a²/(b² − a²)` [Pa].
    fn mean_stress_in_plane(&self) -> f64 {
        let square = self.inner * self.inner;
        self.pressure * square / (self.outer * self.outer - square)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::*;

    fn cylinder(poisson: f64) -> ThickCylinder {
        let body = Elastic { young: 200e9, poisson };
        ThickCylinder { body, inner: 0.1, outer: 0.2, pressure: 50e6 }
    }

    #[test]
    fn faces_carry_their_loads() {
        let cylinder = cylinder(0.3);
        assert_close(cylinder.radial_stress(0.1), -50e6, 1e-14);
        assert_eq!(cylinder.radial_stress(0.2), 0.0);
        assert_close(cylinder.hoop_stress(0.1), 50e6 * 5.0 / 3.0, 1e-14);
    }

    #[test]
    fn stress_is_in_equilibrium() {
        let (cylinder, r) = (cylinder(0.3), 0.13);
        let slope = derivative(|r| cylinder.radial_stress(r), r, 1e-3);
        assert_close(slope, (cylinder.hoop_stress(r) - cylinder.radial_stress(r)) / r, 1e-8);
    }

    #[test]
    fn strains_obey_hookes_law_up_to_near_incompressibility() {
        for nu in [0.0, 0.3, 0.4999] {
            let (cylinder, r) = (cylinder(nu), 0.13);
            let (radial, hoop) = (cylinder.radial_stress(r), cylinder.hoop_stress(r));
            let axial = cylinder.axial_stress();
            let strain = |along: f64, across: f64| (along - nu * across) / cylinder.body.young;
            let slope = derivative(|r| cylinder.radial_displacement(r), r, 1e-3);
            assert_close(slope, strain(radial, hoop + axial), 1e-8);
            assert_close(cylinder.radial_displacement(r) / r, strain(hoop, radial + axial), 1e-12);
            assert!(strain(axial, radial + hoop).abs() < 1e-18);
        }
    }
}
