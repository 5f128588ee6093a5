//! The wall's share in surface tension.
//!
//! Images of the particles leave a fluid at right angles to the wall. For a contact angle θ, a unit of
//! wetted area has the energy `−σ cos θ` (Young 1805, Phil. Trans. R. Soc. 95, 65–87, doi
//! 10.1098/rstl.1805.0005), spread over the fluid near the wall: `E = −σ cos θ Σ V_i φ(z_i)`,
//! `φ = 3 (1 − z)²` with lengths over H, whose integral is 1. The forces are normal to the wall, which
//! gets their reaction. σ is over ρ₀c₀²H.

/// Energy of a particle over its volume.
pub fn energy(tension: f64, cosine: f64, height: f64) -> f64 {
    -3.0 * tension * cosine * (1.0 - height).max(0.0).powi(2)
}

/// Acceleration along z of a particle with r = ρ/ρ₀ − 1, over c₀²/H.
pub fn pull(tension: f64, cosine: f64, height: f64, density: f64) -> f64 {
    -6.0 * tension * cosine * (1.0 - height).max(0.0) / (1.0 + density)
}
