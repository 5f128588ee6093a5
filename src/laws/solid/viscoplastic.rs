//! Viscoplasticity: rate-dependent J₂ plasticity.
//!
//! Beyond its yield surface (see `elastoplastic`) a body flows at the rate of a power of the overstress (P. Perzyna
//! 1966, doi 10.1016/S0065-2156(08)70009-7; F. H. Norton 1929)
//!
//! `ṗ = A ⟨√(3/2) ‖ξ‖ − (σ_y + H_i p)⟩ⁿ e^{−T_a/T}`, `ε̇ₚ = √(3/2) ṗ ξ/‖ξ‖`,
//!
//! with the activation temperature `T_a = Q/R`. Without a yield stress that is secondary creep. Where a power law
//! breaks down, as in solders, the stress σ in it becomes `σ_b sinh(σ/σ_b)` (F. Garofalo, Trans. AIME 227 (1963) 351).
//!
//! A step is implicit (Euler): with the flow `γ = c sⁿ` over it and the overstress `s = ‖ξ‖ − √⅔ (σ_y + H_i p)`, the
//! elastic trial's excess e over the yield surface is `e = s + m γ`, `m = 2G + ⅔ (H_i + H_k)`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use std::sync::Arc;

use super::law::{Deformation, FlowLaw, Need};
use super::overstress::Overstress;
use super::{Elasticity, Elastoplastic, PointConstants, Yielding, law_of_parts};
use crate::laws::Part;
use crate::limits::{positive, within};

law_of_parts! {
    /// Keys of viscoplasticity.
    ViscoplasticLaw { elasticity: Elasticity, yielding: Yielding, flow: Flow }
}

/// Keys of flow that takes time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Flow {
    /// Rate at which the body flows.
    pub creep: Creep,
}

impl Part for Flow {}

impl Deformation for ViscoplasticLaw {
    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn needs(&self) -> Vec<Need> {
        Elasticity::needs("a viscoplastic material deforms").to_vec()
    }

    fn yields(&self) -> bool {
        true
    }

    fn creeps(&self) -> bool {
        true
    }

    /// Without a yield stress the body creeps under any stress.
    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        let plastic =
            Elastoplastic::of(&self.elasticity, &self.yielding, 0.0, stress_free_temperature);
        Arc::new(Viscoplastic { plastic, creep: self.flow.creep })
    }
}

/// Constants of the rate of flow as a scene names them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ coefficient = A, exponent = n }`")]
pub struct Creep {
    /// A, whose unit has a power of Pa in it [1/(s Paⁿ)].
    #[schemars(transform = within(1e-300, 1e300, "1/(s Paⁿ)", "the coefficient of creep"))]
    pub coefficient: f64,
    /// n [1].
    #[schemars(transform = within(1.0, 50.0, "1", "the exponent of creep"))]
    pub exponent: f64,
    /// T_a, the activation energy over the gas constant [K].
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e6, "K", "the activation temperature"))]
    pub activation_temperature: f64,
    /// Stress σ_b at which the power law breaks down [Pa]: `σ_b sinh(σ/σ_b)` takes the place of the stress σ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("Pa", "the stress of power-law breakdown").otherwise("none: a power law at any stress"))]
    pub breakdown: Option<f64>,
}

/// The viscoplastic law.
#[derive(Clone)]
pub struct Viscoplastic {
    /// Elasticity, yield and hardening.
    pub plastic: Elastoplastic,
    pub creep: Creep,
}

/// `√(3/2)` and its logarithm.
const ROOT: f64 = 1.224_744_871_391_589;
const LOGARITHM_OF_ROOT: f64 = 0.202_732_554_054_082_2;

impl Creep {
    /// Returns the flow function over a step [s] at a temperature [K].
    pub fn over_step(&self, temperature: f64, duration: f64) -> Overstress {
        let Self { coefficient, exponent, activation_temperature, breakdown } = *self;
        // γ = √(3/2) p, of a stress that is √(3/2) times the norm.
        let logarithm = coefficient.ln() + duration.ln() - activation_temperature / temperature
            + (exponent + 1.0) * LOGARITHM_OF_ROOT;
        let breakdown = breakdown.map_or(f64::INFINITY, |stress| stress / ROOT);
        Overstress { logarithm, exponent, breakdown }
    }
}

impl FlowLaw for Viscoplastic {
    fn stress_free_temperature(&self) -> f64 {
        self.plastic.stress_free_temperature
    }

    fn over_step(&self, temperature: f64, duration: f64) -> Option<PointConstants> {
        let overstress = self.creep.over_step(temperature, duration);
        Some(PointConstants { overstress, ..self.plastic.at(temperature)? })
    }

    fn creeps(&self) -> bool {
        true
    }
}
