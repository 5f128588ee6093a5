//! Clamped circular plate under uniform pressure p.
//!
//! Sources: S. P. Timoshenko and S. Woinowsky-Krieger, *Theory of Plates and Shells*, 2nd ed.,
//! McGraw-Hill 1959, ch. 3 (Kirchhoff); R. D. Mindlin, J. Appl. Mech. 18 (1951) 31–38,
//! doi 10.1115/1.4010217 (shear).

use super::medium::Elastic;

/// Shear correction factor κ of a rectangular section.
const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

/// The plate and its load. Deflection is positive along the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CircularPlate {
    pub body: Elastic,
    /// Radius R [m].
    pub radius: f64,
    /// Thickness h [m].
    pub thickness: f64,
    /// Pressure p [Pa].
    pub pressure: f64,
}

impl CircularPlate {
    /// Deflection of the thin plate [m] `w = p (R² − r²)²/64D`.
    pub fn deflection(&self, r: f64) -> f64 {
        let rigidity = self.body.plate_rigidity(self.thickness);
        self.pressure * self.inset(r).powi(2) / (64.0 * rigidity)
    }

    /// Deflection with shear [m], Mindlin's: `w = p (R² − r²)²/64D + p (R² − r²)/(4κGh)`.
    pub fn deflection_with_shear(&self, r: f64) -> f64 {
        let stiffness = SHEAR_CORRECTION * self.body.shear_modulus() * self.thickness;
        self.deflection(r) + self.pressure * self.inset(r) / (4.0 * stiffness)
    }

    /// Radial bending moment [N], positive where the loaded face is compressed:
    /// `M_r = p/16 [(1+ν) R² − (3+ν) r²]`.
    pub fn radial_moment(&self, r: f64) -> f64 {
        let nu = self.body.poisson;
        self.pressure / 16.0 * ((1.0 + nu) * self.radius * self.radius - (3.0 + nu) * r * r)
    }

    /// `R² − r²` [m²].
    fn inset(&self, r: f64) -> f64 {
        (self.radius - r) * (self.radius + r)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{
        ALUMINA_ELASTIC, assert_close, assert_within, derivative, second_derivative,
    };
    use super::*;

    const PLATE: CircularPlate =
        CircularPlate { body: ALUMINA_ELASTIC, radius: 1e-3, thickness: 0.1e-3, pressure: 1e5 };

    #[test]
    fn thin_plate_obeys_its_equation_and_is_clamped() {
        let step = 2e-5;
        let slope = |r| derivative(|r| PLATE.deflection(r), r, step);
        let laplacian = |r| second_derivative(|r| PLATE.deflection(r), r, step) + slope(r) / r;
        // Shear force: D d(∇²w)/dr = p r/2.
        let rigidity = PLATE.body.plate_rigidity(PLATE.thickness);
        let shear = rigidity * derivative(laplacian, 0.5e-3, step);
        assert_close(shear, 0.5 * PLATE.pressure * 0.5e-3, 1e-6);
        assert_eq!(PLATE.deflection(PLATE.radius), 0.0);
        assert_within(slope(PLATE.radius) * PLATE.radius / PLATE.deflection(0.0), 0.0, 1e-9);
    }

    #[test]
    fn moment_follows_from_the_deflection() {
        let (r, nu) = (0.6e-3, PLATE.body.poisson);
        let slope = derivative(|r| PLATE.deflection(r), r, 2e-5);
        let bend = second_derivative(|r| PLATE.deflection(r), r, 2e-5);
        let rigidity = PLATE.body.plate_rigidity(PLATE.thickness);
        assert_close(-rigidity * (bend + nu * slope / r), PLATE.radial_moment(r), 1e-7);
        let edge = -PLATE.pressure * PLATE.radius.powi(2) / 8.0;
        assert_close(PLATE.radial_moment(PLATE.radius), edge, 1e-14);
    }

    #[test]
    fn shear_adds_the_slope_of_the_shear_force() {
        let shear = |r| PLATE.deflection_with_shear(r) - PLATE.deflection(r);
        let stiffness = PLATE.body.shear_modulus() * PLATE.thickness * SHEAR_CORRECTION;
        let force = -stiffness * derivative(shear, 0.5e-3, 2e-5);
        assert_close(force, 0.5 * PLATE.pressure * 0.5e-3, 1e-8);
        assert_eq!(PLATE.deflection_with_shear(PLATE.radius), 0.0);
    }
}
