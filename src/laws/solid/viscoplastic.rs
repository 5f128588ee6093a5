//! Viscoplasticity: rate-dependent J₂ plasticity.
//!
//! Beyond its yield surface (see `elastoplastic`) a body flows at the rate of a power of the overstress (P. Perzyna
//! 1966, doi 10.1016/S0065-2156(08)70009-7; F. H. Norton 1929)
//!
//! `ṗ = A ⟨√(3/2) ‖ξ‖ − (σ_y + H_i p)⟩ⁿ e^{−T_a/T}`, `ε̇ₚ = √(3/2) ṗ ξ/‖ξ‖`,
//!
//! with the activation temperature `T_a = Q/R`. Without a yield stress that is secondary creep.
//!
//! A step is implicit (Euler): with the flow `γ = c sⁿ` over it and the overstress `s = ‖ξ‖ − √⅔ (σ_y + H_i p)`, the
//! elastic trial's excess e over the yield surface is `e = s + m γ`, `m = 2G + ⅔ (H_i + H_k)`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use std::sync::Arc;

use super::elastoplastic::respond_at;
use super::law::{Deformation, FlowLaw, Law, Need, Response};
use super::{Elasticity, Elastoplastic, PlasticHistory, PointConstants, Yielding, law_of_parts};
use crate::laws::{MaterialConstant, Part, Property};
use crate::limits::within;

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

impl Part for Flow {
    fn parameters() -> &'static [MaterialConstant] {
        &[]
    }

    fn properties(&self) -> Vec<(&'static str, &Property)> {
        Vec::new()
    }

    fn number(&mut self, _: &str) -> Option<&mut f64> {
        None
    }
}

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
}

/// The viscoplastic law.
#[derive(Clone)]
pub struct Viscoplastic {
    /// Elasticity, yield and hardening.
    pub plastic: Elastoplastic,
    pub creep: Creep,
}

/// Flow over a step as a function of the overstress, `γ = c sⁿ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overstress {
    /// ln c, c in 1/Paⁿ; infinite for rate-independent flow.
    pub logarithm: f64,
    /// n
    pub exponent: f64,
}

/// Split of the excess of a trial over the yield surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parted {
    /// γ [1].
    pub flow: f64,
    /// s [Pa].
    pub overstress: f64,
    /// `m dγ/de`.
    pub share: f64,
}

/// Upper limit of iterations, above the number that any root needs.
const MOST_ITERATIONS: usize = 100;
/// `ln √(3/2)`
const LOGARITHM_OF_ROOT: f64 = 0.202_732_554_054_082_2;

impl Creep {
    /// Returns the flow function over a step [s] at a temperature [K].
    pub fn over_step(&self, temperature: f64, duration: f64) -> Overstress {
        let Self { coefficient, exponent, activation_temperature } = *self;
        // γ = √(3/2) p, of a stress that is √(3/2) times the norm.
        let logarithm = coefficient.ln() + duration.ln() - activation_temperature / temperature
            + (exponent + 1.0) * LOGARITHM_OF_ROOT;
        Overstress { logarithm, exponent }
    }
}

impl Overstress {
    /// Rate-independent flow, without overstress.
    pub const NONE: Self = Self { logarithm: f64::INFINITY, exponent: 1.0 };

    /// Flow at a constant overstress [Pa].
    pub fn flow(&self, overstress: f64) -> f64 {
        if overstress > 0.0 {
            (self.logarithm + self.exponent * overstress.ln()).exp()
        } else {
            0.0
        }
    }

    /// Logarithm of the flow at a constant overstress [Pa]; minus infinity without flow.
    pub fn logarithm_of_flow(&self, overstress: f64) -> f64 {
        if overstress > 0.0 {
            self.logarithm + self.exponent * overstress.ln()
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Overstress [Pa] at which the logarithm of the flow has a value.
    pub fn of_flow(&self, logarithm: f64) -> f64 {
        ((logarithm - self.logarithm) / self.exponent).exp()
    }

    /// Splits an excess e > 0 [Pa] by `e = s + m γ`, with a modulus m [Pa].
    ///
    /// With `s = e x`, `x + β xⁿ = 1` where `β = m c eⁿ⁻¹`. The root is below both 1 and β^(−1/n). Scaled by the
    /// smaller of them it solves `a t + b tⁿ = 1`, where one coefficient is 1 and the other is less. The left side is
    /// convex and increasing, so Newton's method from t = 1 decreases to the root, whatever the numbers.
    pub fn part(&self, excess: f64, modulus: f64) -> Parted {
        let n = self.exponent;
        let beta = self.logarithm + modulus.ln() + (n - 1.0) * excess.ln();
        let [a, b] = if beta > 0.0 { [(-beta / n).exp(), 1.0] } else { [1.0, beta.exp()] };
        let mut t = 1.0_f64;
        for _ in 0..MOST_ITERATIONS {
            let power = t.powf(n - 1.0);
            let change = (a * t + b * power * t - 1.0) / (a + n * b * power);
            // Rounding may reverse its sign at the root.
            if change.is_nan() || change <= 0.5 * f64::EPSILON * t {
                break;
            }
            t -= change;
        }
        let (linear, power) = (a * t, b * t.powf(n));
        let share = if power > 0.0 { 1.0 / (1.0 + linear / (n * power)) } else { 0.0 };
        // Each is computed from its own small expression, not from a difference.
        Parted { flow: excess / modulus * power, overstress: excess * linear, share }
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

impl Law for Viscoplastic {
    fn history_len(&self) -> usize {
        PlasticHistory::LEN
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
        respond_at(self.over_step(temperature, duration), strain, old, new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excess_is_split_for_all_magnitudes() {
        for exponent in [1.0, 1.5, 3.0, 5.0, 12.0, 50.0] {
            for beta in [-700.0, -300.0, -30.0, -3.0, -1e-9, 0.0, 1e-9, 2.0, 40.0, 300.0, 3e3, 1e5]
            {
                for (excess, modulus) in [(1e8, 2e11), (1e-3, 1e3), (1e40, 1e50)] {
                    let (e, m): (f64, f64) = (excess, modulus);
                    let logarithm = beta - m.ln() - (exponent - 1.0) * e.ln();
                    let law = Overstress { logarithm, exponent };
                    let Parted { flow, overstress, share } = law.part(e, m);
                    let sum = overstress + m * flow;
                    assert!((sum / e - 1.0).abs() < 1e-13, "{exponent} {beta}: {sum} {e}");
                    assert!(flow >= 0.0 && overstress >= 0.0 && (0.0..=1.0).contains(&share));
                    // ln γ = ln c + n ln s
                    if flow > 0.0 && overstress > 0.0 {
                        let off = flow.ln() - logarithm - exponent * overstress.ln();
                        assert!(
                            off.abs() < 1e-11 * (1.0 + logarithm.abs()),
                            "{exponent} {beta}: {off}"
                        );
                    }
                    // The share is the slope of the flow.
                    let h = 1e-5 * e;
                    let slope = m * (law.part(e + h, m).flow - law.part(e - h, m).flow) / (2.0 * h);
                    assert!((slope - share).abs() < 1e-6, "{exponent} {beta}: {slope} {share}");
                }
            }
        }
        let at_once = Overstress::NONE.part(3.0, 2.0);
        assert_eq!(at_once, Parted { flow: 1.5, overstress: 0.0, share: 1.0 });
        let never = Overstress { logarithm: f64::NEG_INFINITY, exponent: 5.0 }.part(3.0, 2.0);
        assert_eq!(never, Parted { flow: 0.0, overstress: 3.0, share: 0.0 });
    }
}
