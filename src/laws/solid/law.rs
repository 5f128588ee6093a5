//! The interfaces of laws by which solids deform.

use std::sync::Arc;

use super::elastoplastic::respond_at;
use super::large_strain::{LargeStrainLaw, Thermal};
use super::{
    Elasticity, PlasticHistory, PointConstants, Relaxation, Relaxing, Saturation, Thermoelastic,
};
use crate::laws::{Part, Property};

/// Constants of a law as groups of keys.
pub trait Keys {
    fn parts(&self) -> Vec<&dyn Part>;

    fn parts_mut(&mut self) -> Vec<&mut dyn Part>;

    /// The given constants that may be tables over the temperature, each with its key.
    fn properties(&self) -> Vec<(&'static str, &Property)> {
        self.parts().into_iter().flat_map(|part| part.properties()).collect()
    }
}

/// A law as set in a scene.
pub trait Deformation: Keys {
    fn elasticity(&self) -> &Elasticity;

    /// Keys that a scene must set, each with its allowed values and the reason.
    fn needs(&self) -> Vec<Need> {
        Vec::new()
    }

    /// Returns true if the law allows permanent strain.
    fn yields(&self) -> bool {
        false
    }

    /// Returns true if strain continues under constant stress.
    fn creeps(&self) -> bool {
        false
    }

    /// Keys of moduli that relax; `None` if none does.
    fn relaxing(&self) -> Option<&Relaxing> {
        None
    }

    /// Returns true if the law is one of large strain alone.
    fn is_of_large_strain(&self) -> bool {
        false
    }

    /// Saturation of the yield stress; `None` if it does not saturate.
    fn saturation(&self) -> Option<Saturation> {
        None
    }

    /// Returns the law of large strain at a temperature [K]; `None` if there is none, or constants are missing or
    /// beyond it.
    fn large_strain(&self, _temperature: f64) -> Option<LargeStrainLaw> {
        None
    }

    /// Reason why constants make no law of large strain at a temperature [K], with what is allowed; `None` if they do,
    /// or a constant is missing.
    fn obstacle(&self, _temperature: f64) -> Option<(&'static str, String)> {
        None
    }

    /// Effects of a uniform temperature on a solid of large strain without stress at a temperature [K].
    fn thermal(&self, free: f64) -> Thermal {
        let shift = self.relaxing().and_then(|relaxing| relaxing.shift);
        Thermal::new(self.elasticity(), shift, free)
    }

    /// Returns true if stress is a linear function of deformation and temperature alone.
    fn is_linear(&self) -> bool {
        let has_history = self.yields() || self.relaxing().is_some();
        !has_history && self.properties().iter().all(|(_, property)| property.is_constant())
    }

    /// Returns the flow law, stress-free at a temperature [K].
    ///
    /// # Panics
    /// If constants of elasticity are missing; checked scenes with mechanics have them.
    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw>;
}

/// A key without which a law cannot respond.
#[derive(Debug, Clone, Copy)]
pub struct Need {
    pub key: &'static str,
    pub why: &'static str,
    /// Allowed values, in words.
    pub allowed: &'static str,
}

/// Response of a law to a strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Stress xx, yy, zz, xy, yz, xz [Pa].
    pub stress: [f64; 6],
    /// `∂σ_i/∂ε_j` with engineering shears [Pa], consistent with the integration of the law over the step.
    pub tangent: [[f64; 6]; 6],
    /// Energy dissipated per volume in the step [J/m³].
    pub dissipation: f64,
}

/// A constitutive law of small strains.
pub trait Law: Send + Sync {
    /// Length of the history at a point, a list of numbers that begins as zeros.
    fn history_len(&self) -> usize;

    /// Computes the response to a strain xx, yy, zz, xy, yz, xz (engineering shears) at a temperature [K] after a step
    /// of some duration [s].
    ///
    /// The last accepted step left the history `old`; this one would leave `new`. As `old` never changes, a strain may
    /// be tried and discarded at any time.
    fn respond(
        &self,
        strain: &[f64; 6],
        temperature: f64,
        duration: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Response;
}

/// A law whose stress returns along its deviator, for the equilibrium of whole bodies. It is a [`Law`], too.
pub trait FlowLaw: Send + Sync {
    /// Temperature without thermal strain [K].
    fn stress_free_temperature(&self) -> f64;

    /// Returns the constants at a temperature [K] over a step [s]; `None` if they are invalid.
    fn over_step(&self, temperature: f64, duration: f64) -> Option<PointConstants>;

    /// Returns the constants over a step [s] in which the temperature changes linearly [K].
    fn over_change(&self, temperatures: [f64; 2], duration: f64) -> Option<PointConstants> {
        self.over_step(temperatures[1], duration)
    }

    /// Relaxation of moduli; `None` if none relaxes.
    fn relaxation(&self) -> Option<&Relaxation> {
        None
    }

    /// Returns true if strain continues under constant stress.
    fn creeps(&self) -> bool {
        false
    }
}

impl<F: FlowLaw> Law for F {
    fn history_len(&self) -> usize {
        PlasticHistory::LEN + self.relaxation().map_or(0, Relaxation::history_len)
    }

    /// NaN if the constants are invalid at this temperature.
    fn respond(
        &self,
        strain: &[f64; 6],
        temperature: f64,
        duration: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Response {
        respond_at((self.over_step(temperature, duration), self.relaxation()), strain, old, new)
    }
}

/// Thermo-elasticity as a law without a history.
#[derive(Debug, Clone, PartialEq)]
pub struct Elastic {
    pub law: Thermoelastic,
    /// Temperature without thermal strain [K].
    pub stress_free_temperature: f64,
}

impl Law for Elastic {
    fn history_len(&self) -> usize {
        0
    }

    fn respond(
        &self,
        strain: &[f64; 6],
        temperature: f64,
        _: f64,
        _: &[f64],
        _: &mut [f64],
    ) -> Response {
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
