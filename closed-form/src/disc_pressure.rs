//! Half space `z ≥ 0` under uniform pressure p on the disc `r ≤ R` of its surface.
//!
//! Sources: A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377–420, doi 10.1098/rsta.1929.0009;
//! K. L. Johnson, *Contact Mechanics*, Cambridge 1985, doi 10.1017/CBO9781139171731, §3.4.

use std::f64::consts::PI;

use super::medium::Elastic;
use super::quadrature::integrate_over_disc;

/// The load and the body. Displacements are positive into the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscPressure {
    pub body: Elastic,
    /// Pressure p [Pa].
    pub pressure: f64,
    /// Radius R of the disc [m].
    pub radius: f64,
}

impl DiscPressure {
    /// Normal stress on the axis [Pa] `σ_zz = −p [1 − z³/d³]`, `d = √(R²+z²)`.
    pub fn axial_stress_on_axis(&self, z: f64) -> f64 {
        let c = z / z.hypot(self.radius);
        -self.pressure * (1.0 - c.powi(3))
    }

    /// Side stress on the axis [Pa] `σ_rr = σ_θθ = −p/2 [(1+2ν) − 2(1+ν) z/d + z³/d³]`.
    pub fn radial_stress_on_axis(&self, z: f64) -> f64 {
        let nu = self.body.poisson;
        let c = z / z.hypot(self.radius);
        -0.5 * self.pressure * (1.0 + 2.0 * nu - 2.0 * (1.0 + nu) * c + c.powi(3))
    }

    /// Displacement on the axis [m] `u_z = p(1+ν)/E · [R²/d + (1−2ν)(d − z)]`: the integral of
    /// `−ε_zz = (2ν σ_rr − σ_zz)/E` from z to ∞. At the surface it is `2(1−ν²) p R/E`.
    pub fn displacement_on_axis(&self, z: f64) -> f64 {
        let nu = self.body.poisson;
        let square = self.radius * self.radius;
        let d = z.hypot(self.radius);
        let shape = square / d + (1.0 - 2.0 * nu) * square / (d + z);
        self.pressure * (1.0 + nu) / self.body.young * shape
    }

    /// Displacement of the surface [m] at distance r from the axis, by quadrature to 1e-9: the
    /// point load `(1−ν²) p dA/(πE ρ)` over the disc.
    pub fn surface_displacement(&self, r: f64) -> f64 {
        let nu = self.body.poisson;
        let sum = integrate_over_disc(self.radius, r, |rho| rho);
        (1.0 - nu * nu) * self.pressure / (PI * self.body.young) * sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA_ELASTIC, assert_close, derivative};
    use super::super::quadrature::integrate;
    use super::*;

    const LOAD: DiscPressure =
        DiscPressure { body: ALUMINA_ELASTIC, pressure: 25e6, radius: 30e-6 };

    #[test]
    fn stresses_in_alumina_at_20_um() {
        assert_close(LOAD.axial_stress_on_axis(20e-6), -20.733e6, 3e-5);
        assert_close(LOAD.radial_stress_on_axis(20e-6), -3.104e6, 2e-4);
    }

    #[test]
    fn stresses_are_boussinesq_point_loads_summed_over_the_disc() {
        // Point load P: σ_zz = −3P z³/(2π d⁵), σ_xx + σ_yy + σ_zz = −(1+ν) P z/(π d³).
        let (nu, z) = (LOAD.body.poisson, 20e-6_f64);
        let ring = |f: &dyn Fn(f64) -> f64| {
            integrate(|r| 2.0 * PI * LOAD.pressure * r * f(z.hypot(r)), &[0.0, LOAD.radius])
        };
        let axial = ring(&|d| -1.5 * z.powi(3) / (PI * d.powi(5)));
        let trace = ring(&|d| -(1.0 + nu) * z / (PI * d.powi(3)));
        assert_close(LOAD.axial_stress_on_axis(z), axial, 1e-10);
        assert_close(LOAD.radial_stress_on_axis(z), 0.5 * (trace - axial), 1e-10);
    }

    #[test]
    fn strain_on_the_axis_obeys_hookes_law() {
        for z in [5e-6, 20e-6, 100e-6] {
            let strain = derivative(|z| -LOAD.displacement_on_axis(z), z, 1e-7);
            let side = 2.0 * LOAD.body.poisson * LOAD.radial_stress_on_axis(z);
            let hooke = -(LOAD.axial_stress_on_axis(z) - side) / LOAD.body.young;
            assert_close(strain, hooke, 1e-7);
        }
    }

    #[test]
    fn surface_displacement_at_centre_edge_and_on_average() {
        let DiscPressure { body, pressure, radius } = LOAD;
        let unit = (1.0 - body.poisson.powi(2)) * pressure * radius / body.young;
        assert_close(LOAD.displacement_on_axis(0.0), 2.0 * unit, 1e-14);
        assert_close(LOAD.surface_displacement(0.0), 2.0 * unit, 1e-10);
        assert_close(LOAD.surface_displacement(radius), 4.0 / PI * unit, 1e-10);
        let under = |r: f64| 2.0 * r * LOAD.surface_displacement(r) / (radius * radius);
        assert_close(integrate(under, &[0.0, radius]), 16.0 / (3.0 * PI) * unit, 1e-8);
    }

    #[test]
    fn far_field_is_a_point_load() {
        let (z, nu) = (100.0 * LOAD.radius, LOAD.body.poisson);
        let load = PI * LOAD.radius.powi(2) * LOAD.pressure;
        assert_close(LOAD.axial_stress_on_axis(z), -1.5 * load / (PI * z * z), 1e-3);
        let sunk = load * (1.0 + nu) * (3.0 - 2.0 * nu) / (2.0 * PI * LOAD.body.young * z);
        assert_close(LOAD.displacement_on_axis(z), sunk, 1e-3);
        let surface = (1.0 - nu * nu) * load / (PI * LOAD.body.young * z);
        assert_close(LOAD.surface_displacement(z), surface, 1e-3);
    }
}
