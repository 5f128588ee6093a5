//! Isotropic, linear, small-strain thermo-elasticity.

use std::sync::Arc;

use super::law::{Deformation, FlowLaw};
use super::{Elasticity, Elastoplastic, SolidLaw, Yielding, law_of_parts};

law_of_parts! {
    /// Keys of thermo-elasticity.
    ThermoelasticLaw { elasticity: Elasticity }
}

impl Deformation for ThermoelasticLaw {
    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        let never = f64::INFINITY;
        Arc::new(Elastoplastic::of(
            &self.elasticity,
            &Yielding::default(),
            never,
            stress_free_temperature,
        ))
    }
}

impl From<Elasticity> for SolidLaw {
    fn from(elasticity: Elasticity) -> Self {
        Self::Thermoelastic(ThermoelasticLaw { elasticity })
    }
}

/// Isotropic, linear, small-strain thermo-elasticity.
///
/// `σ = λ tr(ε) 1 + 2 G ε − (3 λ + 2 G) α ΔT 1`.
///
/// Source: B. A. Boley and J. H. Weiner, *Theory of Thermal Stresses*, Wiley 1960, §1.12.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermoelastic {
    /// Young's modulus E [Pa].
    pub young: f64,
    /// Poisson's ratio ν [1].
    pub poisson: f64,
    /// Coefficient of linear thermal expansion α [1/K].
    pub expansion: f64,
}

impl Thermoelastic {
    /// First Lamé constant `λ = E ν / ((1 + ν)(1 − 2ν))` [Pa].
    pub fn lame_first(&self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Shear modulus `G = E / (2 (1 + ν))` [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Thermal stress modulus `β = (3 λ + 2 G) α` [Pa/K].
    pub fn thermal_modulus(&self) -> f64 {
        (3.0 * self.lame_first() + 2.0 * self.shear_modulus()) * self.expansion
    }

    /// Strain per kelvin along the normal of a layer that is held laterally and free along its normal:
    /// `α (1 + ν) / (1 − ν)` [1/K].
    pub fn layer_strain(&self) -> f64 {
        self.expansion * (1.0 + self.poisson) / (1.0 - self.poisson)
    }
}

impl Thermoelastic {
    /// Stress [Pa] of the strain xx, yy, zz, xy, yz, xz (engineering shears) at `rise` kelvin above
    /// the stress-free temperature.
    pub fn stress(&self, [xx, yy, zz, xy, yz, xz]: [f64; 6], rise: f64) -> [f64; 6] {
        let shear = self.shear_modulus();
        let pressure = self.lame_first() * (xx + yy + zz) - self.thermal_modulus() * rise;
        [
            pressure + 2.0 * shear * xx,
            pressure + 2.0 * shear * yy,
            pressure + 2.0 * shear * zz,
            shear * xy,
            shear * yz,
            shear * xz,
        ]
    }
}
