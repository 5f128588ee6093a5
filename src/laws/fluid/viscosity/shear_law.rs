//! The interface of laws of viscosity.

/// Secant and tangent of the viscous part of a flow curve, `τ_v/γ̇` and `dτ_v/dγ̇` [Pa s].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shear {
    pub secant: f64,
    pub tangent: f64,
}

/// A law of simple shear at the reference temperature: `τ = τ_y + τ_v(γ̇)`, with a viscous part that grows with the
/// rate.
pub trait ShearLaw {
    /// Yield stress τ_y [Pa].
    fn yield_stress(&self) -> f64 {
        0.0
    }

    /// Viscous part at a shear rate [1/s], zero included.
    fn viscous(&self, rate: f64) -> Shear;

    /// Returns true if the viscosity does not depend on the rate with these constants.
    fn is_newtonian(&self) -> bool;

    /// Positive rate [1/s] at which the secant viscosity `(τ_y + factor · τ_v)/γ̇` has a minimum; `None` if it is
    /// monotone.
    fn thinnest_rate(&self, _factor: f64) -> Option<f64> {
        None
    }
}
