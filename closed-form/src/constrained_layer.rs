//! Heated layer of a body, laterally constrained and free in depth.
//!
//! Near a widely heated surface of a half space this holds exactly: `ε_xx = ε_yy = 0`, `σ_zz = 0`.
//!
//! Source: B. A. Boley and J. H. Weiner, *Theory of Thermal Stresses*, Wiley 1960.

use super::medium::Elastic;

/// In-plane stress [Pa] `σ_xx = σ_yy = −E α ΔT/(1 − ν)`, of a layer with expansion coefficient α
/// [1/K] heated by ΔT [K].
pub fn in_plane_stress(body: &Elastic, expansion: f64, rise: f64) -> f64 {
    -body.biaxial_modulus() * expansion * rise
}

/// Strain through the layer [1] `ε_zz = α ΔT (1 + ν)/(1 − ν)`. Its integral over the depth is the
/// outward displacement of the surface.
pub fn through_strain(body: &Elastic, expansion: f64, rise: f64) -> f64 {
    expansion * rise * (1.0 + body.poisson) / (1.0 - body.poisson)
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA_ELASTIC, ALUMINA_EXPANSION, assert_close, assert_within};
    use super::*;

    #[test]
    fn alumina_under_the_contact_temperature() {
        let stress = in_plane_stress(&ALUMINA_ELASTIC, ALUMINA_EXPANSION, 16.499);
        assert_close(stress, -50.75e6, 1e-4);
    }

    #[test]
    fn hooke_and_duhamel_give_no_side_strain_and_no_normal_stress() {
        let (body, alpha, rise) = (ALUMINA_ELASTIC, ALUMINA_EXPANSION, 100.0);
        let side = in_plane_stress(&body, alpha, rise);
        let side_strain = side * (1.0 - body.poisson) / body.young + alpha * rise;
        assert_within(side_strain, 0.0, 1e-17);
        let normal_strain = -2.0 * body.poisson * side / body.young + alpha * rise;
        assert_close(through_strain(&body, alpha, rise), normal_strain, 1e-14);
    }
}
