//! Bonded layers with different free expansions, away from the edges: bimetals, and films on substrates.
//!
//! Sources: S. Timoshenko, J. Opt. Soc. Am. 11 (1925) 233, doi 10.1364/JOSA.11.000233; G. G. Stoney, Proc. R. Soc.
//! Lond. A 82 (1909) 172, doi 10.1098/rspa.1909.0021.

/// A layer of the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondedLayer {
    /// In-plane stress per strain [Pa]: E of a strip, `E/(1−ν)` of a plate with equal strains along both directions,
    /// `E/(1−ν²)` of one without strain along one direction.
    pub modulus: f64,
    /// Free strain [1]: αΔT, or `(1+ν)αΔT` without strain along one direction.
    pub free_strain: f64,
    /// Thickness [m].
    pub thickness: f64,
}

/// The plate, from its bottom at z = 0 upward.
#[derive(Debug, Clone, PartialEq)]
pub struct BondedPlate {
    pub layers: Vec<BondedLayer>,
}

impl BondedPlate {
    /// Strain at z = 0 [1] and its growth with z [1/m] of the free plate, which bends: no force and no moment.
    pub fn free(&self) -> [f64; 2] {
        let [stiffness, forces] = self.moments();
        let [a, b, c] = stiffness;
        let determinant = a * c - b * b;
        [
            (c * forces[0] - b * forces[1]) / determinant,
            (a * forces[1] - b * forces[0]) / determinant,
        ]
    }

    /// Strain of the plate that is kept flat [1]: no force.
    pub fn flat(&self) -> f64 {
        let [[a, ..], forces] = self.moments();
        forces[0] / a
    }

    /// Stress in a layer [Pa] at a strain.
    pub fn stress(&self, layer: usize, strain: f64) -> f64 {
        self.layers[layer].modulus * (strain - self.layers[layer].free_strain)
    }

    /// `∫M dz, ∫Mz dz, ∫Mz² dz`, and `∫Mε dz, ∫Mεz dz`.
    fn moments(&self) -> [[f64; 3]; 2] {
        let (mut stiffness, mut forces) = ([0.0; 3], [0.0; 3]);
        let mut bottom: f64 = 0.0;
        for BondedLayer { modulus, free_strain, thickness } in &self.layers {
            let top = bottom + thickness;
            for (k, (sum, force)) in stiffness.iter_mut().zip(&mut forces).enumerate() {
                let n = k as i32 + 1;
                let part = modulus * (top.powi(n) - bottom.powi(n)) / f64::from(n);
                *sum += part;
                *force += part * free_strain;
            }
            bottom = top;
        }
        [stiffness, forces]
    }

    /// Timoshenko's curvature of two layers [1/m]: `6 Δε (1+m)² / {h [3(1+m)² + (1+mn)(m² + 1/mn)]}`. m and n are the
    /// lower layer's thickness and modulus over the upper one's, h their total thickness, Δε the excess of the upper
    /// one's expansion.
    pub fn timoshenko([lower, upper]: [BondedLayer; 2]) -> f64 {
        let (m, n) = (lower.thickness / upper.thickness, lower.modulus / upper.modulus);
        let h = lower.thickness + upper.thickness;
        let more = upper.free_strain - lower.free_strain;
        let square = (1.0 + m).powi(2);
        6.0 * more * square / (h * (3.0 * square + (1.0 + m * n) * (m * m + (m * n).recip())))
    }

    /// Stoney's curvature [1/m] under a thin film with the stress σ: `−6 σ t / (M h²)`.
    pub fn stoney(substrate: BondedLayer, film: f64, stress: f64) -> f64 {
        -6.0 * stress * film / (substrate.modulus * substrate.thickness.powi(2))
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within};
    use super::*;

    fn layer(modulus: f64, free_strain: f64, thickness: f64) -> BondedLayer {
        BondedLayer { modulus, free_strain, thickness }
    }

    #[test]
    fn two_layers_obey_timoshenkos_formula() {
        for (upper, thickness) in [(70e9, 1e-3), (200e9, 0.3e-3), (1e9, 5e-3)] {
            let pair = [layer(110e9, 1e-3, 1e-3), layer(upper, 2.3e-3, thickness)];
            let plate = BondedPlate { layers: pair.to_vec() };
            assert_close(plate.free()[1], BondedPlate::timoshenko(pair), 1e-11);
        }
    }

    #[test]
    fn thin_film_obeys_stoneys_formula_to_first_order() {
        let off = |film: f64| {
            let pair = [layer(110e9, 0.0, 1e-3), layer(300e9, -1e-3, film)];
            let plate = BondedPlate { layers: pair.to_vec() };
            let stress = plate.stress(1, 0.0);
            plate.free()[1] / BondedPlate::stoney(pair[0], film, stress) - 1.0
        };
        assert!(off(1e-6).abs() < 1e-2);
        assert_close(off(1e-6) / off(5e-7), 2.0, 0.02);
    }

    #[test]
    fn layers_of_one_material_stay_straight_and_forces_cancel() {
        let same = [1e-3, 2e-3, 5e-4].map(|thickness| layer(5e9, 1e-3, thickness));
        let [strain, growth] = BondedPlate { layers: same.to_vec() }.free();
        assert_close(strain, 1e-3, 1e-12);
        assert_within(growth, 0.0, 1e-11);
        let mixed = vec![layer(5e9, 1e-3, 1e-3), layer(9e9, 2e-3, 2e-3), layer(1e9, 0.0, 1e-3)];
        let plate = BondedPlate { layers: mixed };
        let force = |i: usize| plate.stress(i, plate.flat()) * plate.layers[i].thickness;
        assert_within((0..3).map(force).sum::<f64>(), 0.0, 1e-3);
    }
}
