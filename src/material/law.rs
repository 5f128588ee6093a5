//! Laws whose stress depends on what a point went through.

use super::{PointConstants, Thermoelastic};

/// What a point of a body remembers; shears of strains are engineering shears.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct History {
    /// Plastic strain xx, yy, zz, xy, yz, xz [1].
    pub plastic_strain: [f64; 6],
    /// The strain `a` that the back stress `β = ⅔ H_k a` follows from [1]. It is kept instead of β, so that β stays a
    /// function of temperature where H_k is one, and hardening neither makes nor loses energy.
    pub back_strain: [f64; 6],
    /// Accumulated plastic strain `p = ∫ √(⅔ ε̇ₚ:ε̇ₚ) dt` [1].
    pub accumulated: f64,
    /// Energy dissipated per volume [J/m³].
    pub dissipated: f64,
}

impl History {
    /// Numbers that a history takes.
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

    /// The opposite of [`Self::read`].
    pub fn write(&self, to: &mut [f64]) {
        to[..6].copy_from_slice(&self.plastic_strain);
        to[6..12].copy_from_slice(&self.back_strain);
        to[12] = self.accumulated;
        to[13] = self.dissipated;
    }
}

/// What a law answers to a strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Stress xx, yy, zz, xy, yz, xz [Pa].
    pub stress: [f64; 6],
    /// `∂σ_i/∂ε_j` with engineering shears [Pa]: consistent with how the law goes over the step.
    pub tangent: [[f64; 6]; 6],
    /// Energy dissipated per volume in the step [J/m³].
    pub dissipation: f64,
}

/// A constitutive law.
pub trait Law: Send + Sync {
    /// The response to a strain xx, yy, zz, xy, yz, xz (engineering shears) at a temperature [K] after a step of some
    /// duration [s].
    ///
    /// `old` is what the last accepted step left; what this one would leave goes into `new`. As `old` never changes, a
    /// strain may be tried and given up at any time.
    fn respond(
        &self,
        strain: &[f64; 6],
        temperature: f64,
        duration: f64,
        old: &History,
        new: &mut History,
    ) -> Response;
}

/// A law by which stress returns along its deviator, as equilibrium of whole bodies takes them.
pub trait FlowLaw: Law {
    /// Temperature without thermal strain [K].
    fn stress_free_temperature(&self) -> f64;

    /// The constants at a temperature [K] over a step [s]; nothing where they are none.
    fn over_step(&self, temperature: f64, duration: f64) -> Option<PointConstants>;

    /// Whether strain goes on under a stress that stays.
    fn creeps(&self) -> bool {
        false
    }
}

/// Thermo-elasticity as a law that remembers nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Elastic {
    pub law: Thermoelastic,
    /// Temperature without thermal strain [K].
    pub stress_free_temperature: f64,
}

impl Law for Elastic {
    fn respond(
        &self,
        strain: &[f64; 6],
        temperature: f64,
        _: f64,
        old: &History,
        new: &mut History,
    ) -> Response {
        *new = *old;
        let (lame, shear) = (self.law.lame_first(), self.law.shear_modulus());
        let mut tangent = [[0.0; 6]; 6];
        for i in 0..3 {
            tangent[i][..3].fill(lame);
            tangent[i][i] += 2.0 * shear;
            tangent[i + 3][i + 3] = shear;
        }
        let stress = self.law.stress(*strain, temperature - self.stress_free_temperature);
        Response { stress, tangent, dissipation: 0.0 }
    }
}
