//! Laws of solids of large strain: elastic changes of volume, with a deviator that relaxes or flows.
//!
//! The energy of the dilatation `J = det F` per reference volume is `U(J) = ½ κ (½ (J² − 1) − ln J)`, source: J. C.
//! Simo and T. J. R. Hughes, *Computational Inelasticity*, Springer 1998, eq. 9.2.3. Deviators have no part in the
//! volume: [`relaxing`] is neo-Hooke with Maxwell branches, [`plastic`] multiplicative J₂ plasticity, to which
//! [`kinematic`] adds a back stress. [`concrete`] has the whole stress, and U is 0. [`thermal`] adds expansion, and
//! [`thin`] sections without stress across them.

pub mod concrete;
mod deformed;
mod isotropic;
mod kinematic;
mod plastic;
mod relaxing;
mod thermal;
mod thin;

pub use concrete::Concrete;
pub use deformed::Deformed;
pub use plastic::Plastic;
pub use relaxing::{MaxwellBranch, Relaxing};
pub use thermal::Thermal;

use crate::math::matrix3::{Matrix3, eigenvalue_bound, product, transposed};

/// A law of large strain.
#[derive(Debug, Clone, PartialEq)]
pub struct LargeStrainLaw {
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
    /// Instantaneous shear modulus µ [Pa].
    pub shear: f64,
    pub deviator: Deviator,
}

/// Law of the change of shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Deviator {
    Relaxing(Relaxing),
    Plastic(Plastic),
    /// The change of volume included.
    Concrete(Concrete),
}

/// Response of a point to a change of shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isochoric {
    /// First Piola–Kirchhoff stress P, without that of the dilatation [Pa].
    pub stress: Matrix3,
    /// Energy stored per reference volume, without that of the dilatation [J/m³].
    pub energy: f64,
    /// Bound on the modulus of shear in plane waves of the reference configuration [Pa].
    pub wave: f64,
}

/// `∂P/∂F`: row `3 i + J`, column `3 k + L`.
pub type Tangent = [[f64; 9]; 9];

impl LargeStrainLaw {
    /// Returns the law without history whose moduli for small strains are these.
    pub fn elastic(bulk: f64, shear: f64) -> Self {
        Self { bulk, shear, deviator: Deviator::Relaxing(Relaxing::default()) }
    }

    /// Young's modulus of small strains [Pa].
    pub fn young(&self) -> f64 {
        9.0 * self.bulk * self.shear / (3.0 * self.bulk + self.shear)
    }

    /// Numbers of history of a point, which begin as zeros.
    pub fn history(&self) -> usize {
        match &self.deviator {
            Deviator::Relaxing(relaxing) => relaxing.history(),
            Deviator::Plastic(_) => Plastic::HISTORY,
            Deviator::Concrete(_) => Concrete::HISTORY,
        }
    }

    /// Returns true if the material yields.
    pub fn yields(&self) -> bool {
        matches!(self.deviator, Deviator::Plastic(_) | Deviator::Concrete(_))
    }

    /// Returns the law of a metal that never yields, for the tangent of a point that is about to yield or to unload; all
    /// other laws are unchanged.
    pub fn without_flow(&self) -> Self {
        let mut law = self.clone();
        if let Deviator::Plastic(plastic) = &mut law.deviator {
            (plastic.yield_stress, plastic.saturation) = (f64::MAX, f64::MAX);
        }
        law
    }

    /// Returns true if a run may produce a history of a point.
    pub fn is_sound(&self, history: &[f64]) -> bool {
        match &self.deviator {
            Deviator::Relaxing(_) => true,
            Deviator::Plastic(_) => Plastic::is_sound(history),
            Deviator::Concrete(_) => Concrete::is_sound(history),
        }
    }

    /// Returns the law of concrete, if it is one.
    pub fn concrete(&self) -> Option<&Concrete> {
        match &self.deviator {
            Deviator::Concrete(concrete) => Some(concrete),
            Deviator::Relaxing(_) | Deviator::Plastic(_) => None,
        }
    }

    /// Accumulated plastic strain of a history of a point.
    pub fn plastic_strain(&self, history: &[f64]) -> f64 {
        match &self.deviator {
            Deviator::Relaxing(_) => 0.0,
            Deviator::Plastic(_) => history[Plastic::STRAIN],
            Deviator::Concrete(_) => history[Concrete::STRAIN],
        }
    }

    /// Returns false if the tangent is not symmetric.
    pub fn is_symmetric(&self) -> bool {
        match &self.deviator {
            Deviator::Relaxing(_) => true,
            Deviator::Plastic(metal) => metal.kinematic == 0.0,
            Deviator::Concrete(_) => false,
        }
    }

    /// Returns true if the bulk modulus is more than ten times that of shear: at a Poisson's ratio above 0.45.
    pub fn is_nearly_incompressible(&self) -> bool {
        self.bulk > 10.0 * self.shear
    }

    /// Modulus of plane waves in the undeformed body [Pa].
    pub fn wave_modulus(&self) -> f64 {
        self.bulk + 4.0 / 3.0 * self.shear
    }

    /// U′ and U″ at a dilatation [Pa].
    pub fn pressure(&self, j: f64) -> [f64; 2] {
        if self.concrete().is_some() {
            return [0.0; 2];
        }
        [0.5 * self.bulk * (j - 1.0 / j), 0.5 * self.bulk * (1.0 + 1.0 / (j * j))]
    }

    /// U [J/m³].
    pub fn energy_of_dilatation(&self, j: f64) -> f64 {
        if self.concrete().is_some() {
            return 0.0;
        }
        0.5 * self.bulk * (0.5 * (j * j - 1.0) - j.ln())
    }

    /// Advances the history by a time step [s]; returns the response at its end.
    pub fn respond(&self, at: &Deformed, dt: f64, history: &mut [f64]) -> Isochoric {
        match &self.deviator {
            Deviator::Relaxing(relaxing) => relaxing.respond(self.shear, at, dt, history),
            Deviator::Plastic(plastic) => plastic.respond(self.shear, at, history),
            Deviator::Concrete(concrete) => concrete.respond([self.bulk, self.shear], at, history),
        }
    }

    /// `∂P/∂F` over a step from a history, at a pressure of the dilatation that stays the same.
    pub fn tangent(&self, at: &Deformed, dt: f64, before: &[f64], pressure: f64) -> Tangent {
        let mut tangent = self.tangent_of_deviator(at, dt, before);
        let (g, jp) = (&at.inverse_transposed, at.dilatation * pressure);
        for (row, line) in tangent.iter_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                let ((i, a), (k, b)) = ((row / 3, row % 3), (column / 3, column % 3));
                *value += jp * (g[i][a] * g[k][b] - g[i][b] * g[k][a]);
            }
        }
        tangent
    }

    /// The same of the deviator.
    fn tangent_of_deviator(&self, at: &Deformed, dt: f64, before: &[f64]) -> Tangent {
        match &self.deviator {
            Deviator::Relaxing(relaxing) => relaxing.tangent(self.shear, at, dt, before),
            Deviator::Plastic(plastic) => plastic.tangent(self.shear, at, before),
            Deviator::Concrete(concrete) => concrete.tangent([self.bulk, self.shear], at, before),
        }
    }

    /// `P_aa` of the deviator and its derivative by `F_aa`, over a step from a history.
    fn deviator_along(&self, a: usize, at: &Deformed, dt: f64, before: &[f64]) -> [f64; 2] {
        if let Deviator::Plastic(plastic) = &self.deviator {
            return plastic.along(self.shear, at, before, a);
        }
        let stress = self.respond(at, dt, &mut before.to_vec()).stress;
        [stress[a][a], self.tangent_of_deviator(at, dt, before)[4 * a][4 * a]]
    }

    /// Bound on the modulus of compression in plane waves of the reference configuration [Pa]: along the axis of the
    /// smallest stretch.
    pub fn wave_of_dilatation(&self, at: &Deformed, mean: f64) -> f64 {
        let [_, stiffness] = self.pressure(mean);
        stiffness * at.dilatation * at.dilatation * at.steepest()
    }
}

impl Deformed {
    /// Bound on the inverse square of the smallest stretch, exact without shear.
    fn steepest(&self) -> f64 {
        let g = &self.inverse_transposed;
        eigenvalue_bound(&product(&transposed(g), g))
    }
}

#[cfg(test)]
mod tests;
