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
}

/// Largest magnitude of b₂.
pub const MOST: f64 = 20.0;
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
