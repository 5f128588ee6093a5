//! Energy of softening of the KCC law, in closed form, and constants that follow from it.
//!
//! Beyond the peak in uniaxial tension `p = −σ/3`, so `σ = 3 η f_t/(2 + η)`, the axial plastic strain per ε̄ᵖ is `(1 +
//! ωη/2)/√(1 + ω²η²/2)`, and `dε̄ᵖ = (2/(2 + η))^b₂ dλ`. The work of σ there per volume, times the width of the band in
//! which strain localises, is the fracture energy (crack band: Z. P. Bažant & B. H. Oh 1983, doi 10.1007/BF02486267).
//! Under equal tension from all sides it is `f_t ∫ η dλ/b₃`.

use super::{Concrete, DamageFunction};

/// Plastic work beyond the peak in uniaxial tension per volume [J/m³].
pub fn tension(function: &DamageFunction, tensile: f64, exponent: f64, dilatancy: f64) -> f64 {
    function.integral(|eta| stress(eta, tensile) * stretching(eta, exponent, dilatancy))
}

/// b₂ with which uniaxial tension takes an energy per volume [J/m³]; `None` beyond ±[`MOST`].
pub fn exponent(
    function: &DamageFunction,
    tensile: f64,
    dilatancy: f64,
    energy: f64,
) -> Option<f64> {
    // The energy falls with the exponent.
    let excess = |exponent: f64| tension(function, tensile, exponent, dilatancy) - energy;
    let (mut low, mut high) = (-MOST, MOST);
    if excess(low) < 0.0 || excess(high) > 0.0 {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if excess(middle) > 0.0 { &mut low } else { &mut high }) = middle;
    }
    Some(0.5 * (low + high))
}

/// b₃ with which equal tension from all sides takes an energy per volume [J/m³].
pub fn opening(function: &DamageFunction, tensile: f64, energy: f64) -> f64 {
    tensile * function.integral(|eta| eta) / energy
}

impl Concrete {
    /// Plastic work beyond the peak in uniaxial tension per volume [J/m³].
    pub fn energy_of_tension(&self) -> f64 {
        tension(&self.function, self.surfaces.tensile, self.exponents[1], self.dilatancy)
    }

    /// Largest fall of stress per plastic strain over the elastic modulus, in uniaxial tension and under equal tension
    /// from all sides: from 1 on, stress jumps.
    pub fn brittleness(&self, young: f64, bulk: f64) -> f64 {
        let tensile = self.surfaces.tensile;
        let steepest = |(fall, [start, end]): (f64, [f64; 2])| {
            let uniaxial = [start, 0.5 * (start + end), end].map(|eta| {
                let fall_of_stress = 6.0 * tensile / ((2.0 + eta) * (2.0 + eta)) * fall;
                fall_of_stress / stretching(eta, self.exponents[1], self.dilatancy) / young
            });
            let spherical = tensile * fall * self.opening / bulk;
            uniaxial.into_iter().fold(spherical, f64::max)
        };
        self.function.falls().map(steepest).fold(0.0, f64::max)
    }

    /// The same in uniaxial compression: from 1 on, a body without inertia has no equilibrium on its way down.
    pub fn brittleness_in_compression(&self, young: f64) -> f64 {
        let steepest = |(fall, [start, end]): (f64, [f64; 2])| {
            // By parts, as the slope over η may jump.
            let width = (start - end) / PARTS as f64;
            let of_part = |n: usize| {
                let [eta, next] = [n, n + 1].map(|n| start - width * n as f64);
                let [stress, left] = [eta, next].map(|eta| self.crushing_stress(eta));
                let (eta, p) = (0.5 * (eta + next), (stress + left) / 6.0);
                let growth = self.dilatancy * self.slope(p, |p| self.softened(p, eta));
                let whole = (1.0 + 2.0 / 9.0 * growth * growth).sqrt();
                let shortening = (1.0 - growth / 3.0) / whole;
                (stress - left) / width * fall * self.damaging(p) / shortening / young
            };
            (0..PARTS).map(of_part).fold(0.0, f64::max)
        };
        self.function.falls().map(steepest).fold(0.0, f64::max)
    }

    /// Stress of uniaxial compression beyond the peak at an η [Pa].
    fn crushing_stress(&self, eta: f64) -> f64 {
        let excess = |stress: f64| self.softened(stress / 3.0, eta) - stress;
        let (mut low, mut high) = (0.0, self.surfaces.compressive);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if excess(middle) > 0.0 { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

/// Largest magnitude of b₂.
pub const MOST: f64 = 20.0;
/// Parts of a segment of η over λ in which slopes are sought.
const PARTS: usize = 32;
const HALVINGS: usize = 60;

/// σ at an η.
fn stress(eta: f64, tensile: f64) -> f64 {
    3.0 * eta * tensile / (2.0 + eta)
}

/// Axial plastic strain per λ.
fn stretching(eta: f64, exponent: f64, dilatancy: f64) -> f64 {
    let growth = 0.5 * dilatancy * eta;
    (1.0 + growth) / (1.0 + 2.0 * growth * growth).sqrt() * (2.0 / (2.0 + eta)).powf(exponent)
}
