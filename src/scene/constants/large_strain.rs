//! The constants of solids of large strain: those of their material.

use super::{Constant, OfferedConstant};
use crate::laws::MaterialConstant;
use crate::scene::large_strain::LargeStrain;

/// Constants on which the motion depends.
const MECHANICAL: [&str; 5] =
    ["density", "young", "poisson", "yield_stress", "isotropic_hardening"];

pub fn offered(body: &str, solid: &LargeStrain) -> Vec<OfferedConstant> {
    let material = solid.material.material();
    let acts = |constant: &&MaterialConstant| {
        MECHANICAL.contains(&constant.key) && constant.is_given(material)
    };
    let offer = |constant: &'static MaterialConstant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Material(constant),
    };
    MaterialConstant::all().into_iter().filter(acts).map(offer).collect()
}
