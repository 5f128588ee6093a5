//! History of plastic flow at a point.

/// History of J₂ plasticity at a point; shears of strains are engineering shears.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlasticHistory {
    /// Plastic strain xx, yy, zz, xy, yz, xz [1].
    pub plastic_strain: [f64; 6],
    /// The strain `a` of the back stress `β = ⅔ H_k a` [1]. It is stored instead of β, so that β follows a
    /// temperature-dependent H_k, and hardening conserves energy.
    pub back_strain: [f64; 6],
    /// Accumulated plastic strain `p = ∫ √(⅔ ε̇ₚ:ε̇ₚ) dt` [1].
    pub accumulated: f64,
    /// Energy dissipated per volume [J/m³].
    pub dissipated: f64,
}

impl PlasticHistory {
    /// Length of the list that stores a history.
    pub const LEN: usize = 14;

    /// Reads the first [`Self::LEN`] numbers: plastic strain, back strain, accumulated strain, dissipated energy.
    pub fn read(from: &[f64]) -> Self {
        let six = |first: usize| std::array::from_fn(|i| from[first + i]);
        Self {
            plastic_strain: six(0),
            back_strain: six(6),
            accumulated: from[12],
            dissipated: from[13],
        }
    }

    /// Writes the numbers that [`Self::read`] reads.
    pub fn write(&self, to: &mut [f64]) {
        to[..6].copy_from_slice(&self.plastic_strain);
        to[6..12].copy_from_slice(&self.back_strain);
        to[12] = self.accumulated;
        to[13] = self.dissipated;
    }
}
