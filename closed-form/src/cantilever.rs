//! Cantilever of rectangular section, clamped at `x = 0`, under a load P at its end `x = L`.
//!
//! Source: S. P. Timoshenko, Phil. Mag. 41 (1921) 744–746, doi 10.1080/14786442108636264.

use super::medium::Elastic;

/// Shear correction factor κ of a rectangular section.
const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

/// The beam and its load. Deflection is positive along the load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cantilever {
    pub body: Elastic,
    /// Length L [m].
    pub length: f64,
    /// Height h of the section, along the load [m].
    pub height: f64,
    /// Width b of the section [m].
    pub width: f64,
    /// Load P [N].
    pub load: f64,
}

impl Cantilever {
    /// Deflection [m] `w = P x² (3L − x)/6EI + P x/κGA`, `I = b h³/12`, `A = b h`.
    pub fn deflection(&self, x: f64) -> f64 {
        let bending = self.body.young * self.width * self.height.powi(3) / 12.0;
        let shear = SHEAR_CORRECTION * self.body.shear_modulus() * self.width * self.height;
        self.load * (x * x * (3.0 * self.length - x) / (6.0 * bending) + x / shear)
    }

    /// Deflection of the end [m] `P L³/3EI + P L/κGA`.
    pub fn tip_deflection(&self) -> f64 {
        self.deflection(self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within, derivative, second_derivative};
    use super::*;

    const BEAM: Cantilever = Cantilever {
        body: Elastic { young: 200e9, poisson: 0.3 },
        length: 0.5,
        height: 0.02,
        width: 0.01,
        load: 100.0,
    };

    #[test]
    fn slender_beam_obeys_bernoullis_theory() {
        // PL³/3EI = 100 · 0.125 / (3 · 200e9 · 0.01 · 0.02³ / 12), shear adds κ⁻¹ (1+ν)/2 h²/L².
        let bending = 3.125e-3;
        let shear = 0.5 * 1.3 / SHEAR_CORRECTION * (0.02_f64 / 0.5).powi(2);
        assert_close(BEAM.tip_deflection(), bending * (1.0 + shear), 1e-14);
    }

    #[test]
    fn moment_and_shear_are_those_of_the_load() {
        let x = 0.2;
        let stiffness = BEAM.body.young * BEAM.width * BEAM.height.powi(3) / 12.0;
        let moment = stiffness * second_derivative(|x| BEAM.deflection(x), x, 0.01);
        assert_close(moment, BEAM.load * (BEAM.length - x), 1e-10);
        let shear = BEAM.body.shear_modulus() * BEAM.width * BEAM.height * SHEAR_CORRECTION;
        let root_slope = derivative(|x| BEAM.deflection(x), 0.0, 0.01);
        assert_close(shear * root_slope, BEAM.load, 1e-9);
        assert_within(BEAM.deflection(0.0), 0.0, 0.0);
    }
}
