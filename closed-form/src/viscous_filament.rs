//! Slender viscous filament and sheet that are drawn or that surface tension draws together, and a disc of fluid that
//! is squeezed between plates.
//!
//! The sides bear no stress but surface tension, so the state is uniform and the axial stress is Trouton's viscosity
//! times the strain rate: `3µ ε̇` in a filament, `4µ ε̇` in a wide sheet. With the radius a or the thickness h, the
//! dynamic viscosity µ [Pa s] and the surface tension σ [N/m]:
//!
//! - force of a filament `F = 3µ ε̇ πa² + πσa`, of a sheet per width `F = 4µ ε̇ h + 2σ`;
//! - free ends: `a = a₀ + σt/(6µ)` and `h = h₀ + σt/(2µ)`; the lengths shrink as the volume is conserved;
//! - disc of radius R between no-slip plates h apart that approach with V: `F = 3πµR⁴V/(2h³)`, so that a constant
//!   force closes the gap as `h^{−2} = h₀^{−2} + 4Ft/(3πµR⁴)`, the radius constant; between plates that slip
//!   `F = 3πµR²V/h`.
//!
//! Valid for negligible inertia and gravity, for a filament or sheet much longer than thick (the ends round off over
//! about a thickness), and for `h ≪ R` between no-slip plates.
//!
//! Sources: F. T. Trouton (1906), Proc. R. Soc. A 77, 426–440, doi 10.1098/rspa.1906.0038; J. Eggers and E. Villermaux
//! (2008), Rep. Prog. Phys. 71, 036601, doi 10.1088/0034-4885/71/3/036601 (slender jets with surface tension);
//! J. Engmann, C. Servais and A. S. Burbidge (2005), J. Non-Newtonian Fluid Mech. 132, 1–27,
//! doi 10.1016/j.jnnfm.2005.08.007 (squeezing, after J. Stefan 1874). The retraction follows from F = 0.

use std::f64::consts::PI;

/// A filament of circular section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscousFilament {
    /// Initial radius a₀ [m].
    pub radius: f64,
    /// Initial length [m].
    pub length: f64,
    /// Dynamic viscosity µ [Pa s].
    pub viscosity: f64,
    /// Surface tension σ [N/m].
    pub surface_tension: f64,
}

impl ViscousFilament {
    /// Force [N] that draws the filament at the rate ε̇ [1/s] when its radius is a.
    pub fn force(&self, radius: f64, rate: f64) -> f64 {
        let section = PI * radius * radius;
        3.0 * self.viscosity * rate * section + PI * self.surface_tension * radius
    }

    /// Radius [m] under a constant rate ε̇: `a₀ e^{−ε̇t/2}`.
    pub fn drawn_radius(&self, rate: f64, t: f64) -> f64 {
        self.radius * (-0.5 * rate * t).exp()
    }

    /// Radius [m] of the filament with free ends.
    pub fn free_radius(&self, t: f64) -> f64 {
        self.radius + self.surface_tension * t / (6.0 * self.viscosity)
    }

    /// Length [m] of the filament with free ends.
    pub fn free_length(&self, t: f64) -> f64 {
        self.length * (self.radius / self.free_radius(t)).powi(2)
    }
}

/// A wide sheet: its strain is plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscousSheet {
    /// Initial thickness h₀ [m].
    pub thickness: f64,
    /// Initial length [m].
    pub length: f64,
    /// Dynamic viscosity µ [Pa s].
    pub viscosity: f64,
    /// Surface tension σ [N/m].
    pub surface_tension: f64,
}

impl ViscousSheet {
    /// Force per width [N/m] that draws the sheet at the rate ε̇ [1/s] when it is h thick.
    pub fn force(&self, thickness: f64, rate: f64) -> f64 {
        4.0 * self.viscosity * rate * thickness + 2.0 * self.surface_tension
    }

    /// Thickness [m] of the sheet with free ends.
    pub fn free_thickness(&self, t: f64) -> f64 {
        self.thickness + self.surface_tension * t / (2.0 * self.viscosity)
    }

    /// Length [m] of the sheet with free ends.
    pub fn free_length(&self, t: f64) -> f64 {
        self.length * self.thickness / self.free_thickness(t)
    }
}

/// A disc of fluid that fills the gap between two plates of its radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SqueezedDisc {
    /// Radius R [m].
    pub radius: f64,
    /// Dynamic viscosity µ [Pa s].
    pub viscosity: f64,
}

impl SqueezedDisc {
    /// Force [N] between no-slip plates that approach at V [m/s] across the gap h [m].
    pub fn force(&self, gap: f64, speed: f64) -> f64 {
        1.5 * PI * self.viscosity * self.radius.powi(4) * speed / gap.powi(3)
    }

    /// Force [N] between plates that slip: Trouton's, of a filament that shortens.
    pub fn slipping_force(&self, gap: f64, speed: f64) -> f64 {
        3.0 * PI * self.viscosity * self.radius.powi(2) * speed / gap
    }

    /// Gap [m] between no-slip plates under a constant force F [N], from the initial gap.
    pub fn gap(&self, initial: f64, force: f64, t: f64) -> f64 {
        let closing = 4.0 * force * t / (3.0 * PI * self.viscosity * self.radius.powi(4));
        (initial.powi(-2) + closing).sqrt().recip()
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within, derivative};
    use super::super::quadrature::integrate;
    use super::*;

    const FILAMENT: ViscousFilament =
        ViscousFilament { radius: 1e-3, length: 0.1, viscosity: 50.0, surface_tension: 0.03 };
    const SHEET: ViscousSheet =
        ViscousSheet { thickness: 1e-3, length: 0.1, viscosity: 50.0, surface_tension: 0.03 };

    #[test]
    fn power_of_a_drawn_filament_is_dissipated_and_stored_in_its_surface() {
        let (rate, t) = (0.4, 1.5);
        let radius = FILAMENT.drawn_radius(rate, t);
        let length = |t: f64| FILAMENT.length * (rate * t).exp();
        let volume = PI * radius * radius * length(t);
        assert_close(volume, PI * 1e-6 * 0.1, 1e-12);
        let surface = |t: f64| 2.0 * PI * FILAMENT.drawn_radius(rate, t) * length(t);
        // D = diag(ε̇, −ε̇/2, −ε̇/2): 2µ D:D = 3µ ε̇².
        let squares = rate * rate * (1.0 + 0.25 + 0.25);
        let lost = 2.0 * FILAMENT.viscosity * squares * volume;
        let stored = FILAMENT.surface_tension * derivative(surface, t, 1e-3);
        let power = FILAMENT.force(radius, rate) * derivative(length, t, 1e-3);
        assert_close(power, lost + stored, 1e-9);
        let bare = ViscousFilament { surface_tension: 0.0, ..FILAMENT };
        assert_close(bare.force(radius, rate), 3.0 * 50.0 * rate * PI * radius * radius, 1e-14);
    }

    #[test]
    fn retraction_needs_no_force_and_surface_energy_is_dissipated() {
        let t = 2.0;
        let (radius, length) = (FILAMENT.free_radius(t), FILAMENT.free_length(t));
        let rate = derivative(|t| FILAMENT.free_length(t).ln(), t, 1e-2);
        assert_within(FILAMENT.force(radius, rate), 0.0, 1e-11);
        let energy = |t: f64| {
            2.0 * PI * FILAMENT.free_radius(t) * FILAMENT.free_length(t) * FILAMENT.surface_tension
        };
        let lost = 3.0 * FILAMENT.viscosity * rate * rate * PI * radius * radius * length;
        assert_close(-derivative(energy, t, 1e-2), lost, 1e-8);
        let strain = derivative(|t| SHEET.free_length(t).ln(), t, 1e-2);
        assert_within(SHEET.force(SHEET.free_thickness(t), strain), 0.0, 1e-10);
        // D = diag(ε̇, −ε̇): 2µ D:D = 4µ ε̇², and both faces lose surface.
        let area = SHEET.thickness * SHEET.length;
        let faces = -2.0 * derivative(|t| SHEET.free_length(t), t, 1e-2) * SHEET.surface_tension;
        assert_close(4.0 * SHEET.viscosity * strain * strain * area, faces, 1e-8);
    }

    #[test]
    fn squeezing_by_quadrature_of_the_lubrication_pressure() {
        let disc = SqueezedDisc { radius: 0.02, viscosity: 3.0 };
        let (gap, speed) = (1e-3_f64, 2e-4);
        // Flow through the radius r, πr²V = 2πr h³/(12µ) (−dp/dr); the force weights the slope of the pressure by πr².
        let slope = |r: f64| 6.0 * disc.viscosity * speed * r / gap.powi(3);
        let force = integrate(|r| PI * r * r * slope(r), &[0.0, disc.radius]);
        assert_close(disc.force(gap, speed), force, 1e-11);
        let (t, load) = (3.0, 5.0);
        let closing = -derivative(|t| disc.gap(gap, load, t), t, 1e-3);
        assert_close(disc.force(disc.gap(gap, load, t), closing), load, 1e-8);
        let bare =
            ViscousFilament { radius: 0.02, viscosity: 3.0, surface_tension: 0.0, ..FILAMENT };
        assert_close(disc.slipping_force(gap, speed), -bare.force(0.02, -speed / gap), 1e-13);
    }
}
