//! A bar, or a film equally in both directions, under cyclic strain beyond yield, with linear hardening. The stress
//! follows straight lines, with the elastic modulus within the yield surface and with `E H/(E + H)` beyond it.
//!
//! Clamped parts that are heated and cooled undergo such cycles, with the strain `−α ΔT`: a bar between two walls, a
//! film on a substrate, each depth of a plate that is held flat.
//!
//! Source: R. Hill, *The Mathematical Theory of Plasticity*, Oxford 1950, §II; for plates B. A. Boley and J. H. Weiner,
//! *Theory of Thermal Stresses*, Wiley 1960, §15.

/// Bilinear relation between stress and strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bilinear {
    /// Elastic modulus [Pa].
    pub modulus: f64,
    /// First yield at this stress, σ_y [Pa].
    pub yield_stress: f64,
    /// Growth of the yield surface's radius with plastic strain [Pa].
    pub isotropic: f64,
    /// Shift of the yield surface with plastic strain [Pa].
    pub kinematic: f64,
}

impl Bilinear {
    /// A bar: `σ = E (ε − εₚ)`, `|σ − H_k εₚ| ≤ σ_y + H_i p`.
    pub fn bar(young: f64, yield_stress: f64, isotropic: f64, kinematic: f64) -> Self {
        Self { modulus: young, yield_stress, isotropic, kinematic }
    }

    /// A film, the same in both directions: `σ = E/(1 − ν) (ε − εₚ)`, and p is twice the plastic strain in its plane.
    pub fn film(
        young: f64,
        poisson: f64,
        yield_stress: f64,
        isotropic: f64,
        kinematic: f64,
    ) -> Self {
        let modulus = young / (1.0 - poisson);
        Self { modulus, yield_stress, isotropic: 2.0 * isotropic, kinematic: 2.0 * kinematic }
    }

    /// Stress [Pa] at each strain [1] of a path from rest.
    pub fn stresses(&self, strains: &[f64]) -> Vec<f64> {
        let hardening = self.isotropic + self.kinematic;
        let slope = self.modulus * hardening / (self.modulus + hardening);
        // Centre and radius of the yield surface, and the position on the path.
        let (mut middle, mut radius) = (0.0, self.yield_stress);
        let (mut strain, mut stress) = (0.0, 0.0);
        let mut out = Vec::with_capacity(strains.len());
        for &next in strains {
            let sign = f64::signum(next - strain);
            let to_yield = (middle + sign * radius - stress) / self.modulus;
            let beyond = (next - strain - to_yield) * sign;
            if beyond > 0.0 {
                stress = middle + sign * (radius + slope * beyond);
                let plastic = beyond * self.modulus / (self.modulus + hardening);
                middle += sign * self.kinematic * plastic;
                radius += self.isotropic * plastic;
            } else {
                stress += self.modulus * (next - strain);
            }
            strain = next;
            out.push(stress);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::assert_close;
    use super::*;

    #[test]
    fn isotropic_hardening_expands_and_kinematic_shifts() {
        let yields = |isotropic: f64, kinematic: f64| {
            let bar = Bilinear::bar(200e9, 200e6, isotropic, kinematic);
            let [up, down] = bar.stresses(&[5e-3, -5e-3])[..] else { panic!() };
            (up, down)
        };
        // Beyond ε_y = 10⁻³ both rise alike, with E H/(E + H).
        let rise = 200e9 * 20e9 / 220e9 * 4e-3;
        assert_close(yields(20e9, 0.0).0, 200e6 + rise, 1e-14);
        assert_close(yields(0.0, 20e9).0, 200e6 + rise, 1e-14);
        // Reverse yield, for a surface of radius σ_y + rise or of radius σ_y.
        let slope = 200e9 * 20e9 / 220e9;
        let expanded = -(200e6 + rise) - slope * (10e-3 - 2.0 * (200e6 + rise) / 200e9);
        assert_close(yields(20e9, 0.0).1, expanded, 1e-13);
        let shifted = rise - 200e6 - slope * (10e-3 - 2.0 * 200e6 / 200e9);
        assert_close(yields(0.0, 20e9).1, shifted, 1e-13);
    }

    #[test]
    fn residual_stress_without_hardening() {
        let film = Bilinear::film(70e9, 0.33, 100e6, 0.0, 0.0);
        let strain = 1.5 * 100e6 / film.modulus;
        assert_close(film.stresses(&[-strain, 0.0])[1], 50e6, 1e-13);
        assert_close(film.stresses(&[-4.0 * strain, 0.0])[1], 100e6, 1e-13);
    }
}
