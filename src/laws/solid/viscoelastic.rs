//! Viscoelasticity of small strains: the generalised Maxwell model of [`Relaxation`].
//!
//! The constants of elasticity are the instantaneous ones. Thermal expansion is immediate.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::large_strain::{self, Deviator, LargeStrainLaw, MaxwellBranch};
use super::law::{Deformation, FlowLaw, Need};
use super::neo_hookean::moduli;
use super::relaxation::Branch;
use super::{Elasticity, Elastoplastic, PointConstants, Relaxation, Shift, Yielding, law_of_parts};
use crate::laws::Part;

law_of_parts! {
    /// Keys of viscoelasticity.
    ViscoelasticLaw { elasticity: Elasticity, relaxing: Relaxing }
}

/// Keys of moduli that relax.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Relaxing {
    /// Relaxation of the shear modulus: a list of branches (Prony series). `young` and `poisson` are the instantaneous
    /// constants; fractions that sum to less than 1 leave the rest as the long-term modulus.
    pub shear_relaxation: Vec<Branch>,
    /// Relaxation of the bulk modulus.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("otherwise" = "none: changes of volume are elastic"))]
    pub bulk_relaxation: Vec<Branch>,
    /// Change of all relaxation times with the temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "none: the same times at every temperature"))]
    pub shift: Option<Shift>,
}

impl Part for Relaxing {}

impl Relaxing {
    /// Fractions of the bulk and of the shear modulus that remain.
    pub fn lasting(&self) -> [f64; 2] {
        [&self.bulk_relaxation, &self.shear_relaxation].map(|branches| {
            let relaxing: f64 = branches.iter().map(|branch| branch.fraction).sum();
            (1.0 - relaxing).max(0.0)
        })
    }
}

impl Deformation for ViscoelasticLaw {
    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn needs(&self) -> Vec<Need> {
        Elasticity::needs("a viscoelastic material deforms").to_vec()
    }

    fn relaxing(&self) -> Option<&Relaxing> {
        Some(&self.relaxing)
    }

    fn large_strain(&self, temperature: f64) -> Option<LargeStrainLaw> {
        let [bulk, shear] = moduli(&self.elasticity, temperature)?;
        let Relaxing { shear_relaxation, bulk_relaxation, shift } = &self.relaxing;
        let slower = shift.map_or(1.0, |shift| shift.logarithm(temperature).exp());
        let branch = |branch: &Branch| MaxwellBranch {
            fraction: branch.fraction,
            time: branch.time * slower,
        };
        let branches = shear_relaxation.iter().map(branch).collect();
        let deviator = Deviator::Relaxing(large_strain::Relaxing { branches });
        bulk_relaxation.is_empty().then_some(LargeStrainLaw { bulk, shear, deviator })
    }

    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        let never = f64::INFINITY;
        let none = Yielding::default();
        let elastic = Elastoplastic::of(&self.elasticity, &none, never, stress_free_temperature);
        let Relaxing { shear_relaxation, bulk_relaxation, shift } = &self.relaxing;
        let relaxation = Relaxation::new(shear_relaxation, bulk_relaxation, *shift);
        Arc::new(Viscoelastic { elastic, relaxation })
    }
}

/// The viscoelastic law.
#[derive(Clone)]
pub struct Viscoelastic {
    /// Instantaneous elasticity, which never yields.
    pub elastic: Elastoplastic,
    pub relaxation: Relaxation,
}

impl FlowLaw for Viscoelastic {
    fn stress_free_temperature(&self) -> f64 {
        self.elastic.stress_free_temperature
    }

    fn over_step(&self, temperature: f64, duration: f64) -> Option<PointConstants> {
        self.over_change([temperature; 2], duration)
    }

    fn over_change(&self, temperatures: [f64; 2], duration: f64) -> Option<PointConstants> {
        let reduced_time = self.relaxation.reduced_time(temperatures, duration);
        Some(PointConstants { reduced_time, ..self.elastic.at(temperatures[1])? })
    }

    fn relaxation(&self) -> Option<&Relaxation> {
        Some(&self.relaxation)
    }
}
