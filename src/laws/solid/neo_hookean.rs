//! Rubber and gels: compressible neo-Hookean solids, for strains of any size.

use std::sync::Arc;

use super::large_strain::LargeStrainLaw;
use super::law::{Deformation, FlowLaw, Need};
use super::{Elasticity, SolidLaw, law_of_parts};
use crate::laws::Property;

law_of_parts! {
    /// Keys of a neo-Hookean solid: those of thermo-elasticity, to which it tends for small strains.
    NeoHookeanLaw { elasticity: Elasticity }
}

impl Deformation for NeoHookeanLaw {
    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn needs(&self) -> Vec<Need> {
        let why = "a solid of large strain is elastic";
        Elasticity::needs(why).into_iter().filter(|need| need.key != "expansion").collect()
    }

    fn is_of_large_strain(&self) -> bool {
        true
    }

    fn large_strain(&self, temperature: f64) -> Option<LargeStrainLaw> {
        let [bulk, shear] = moduli(&self.elasticity, temperature)?;
        Some(LargeStrainLaw::elastic(bulk, shear))
    }

    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        SolidLaw::from(self.elasticity.clone()).deformation().flow_law(stress_free_temperature)
    }
}

/// Bulk and shear modulus at a temperature [K], `κ = E/(3(1 − 2ν))` and `µ = E/(2(1 + ν))` [Pa]; `None` if a constant
/// is missing.
pub fn moduli(elasticity: &Elasticity, temperature: f64) -> Option<[f64; 2]> {
    let value = |property: &Option<Property>| Some(property.as_ref()?.value(temperature));
    let (young, poisson) = (value(&elasticity.young)?, value(&elasticity.poisson)?);
    Some([young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))])
}
