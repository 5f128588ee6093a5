//! The constants of solids of large strain: those of their material, or of each layer's, and of faces.

use super::solid::{coefficient, of_layer_material, places_in_layers};
use super::{Constant, OfferedConstant};
use crate::laws::MaterialConstant;
use crate::scene::large_strain::LargeStrain;

/// Constants on which the motion depends.
const MECHANICAL: [&str; 6] =
    ["density", "young", "poisson", "yield_stress", "isotropic_hardening", "kinematic_hardening"];
/// Constants on which the heat flow depends.
const THERMAL: [&str; 3] = ["specific_heat", "conductivity", "expansion"];

/// Returns true if the constant acts by heat alone, which has not moved at time zero.
pub fn is_thermal(constant: &MaterialConstant) -> bool {
    THERMAL.contains(&constant.key) && constant.key != "expansion"
}

pub fn offered(body: &str, solid: &LargeStrain) -> Vec<OfferedConstant> {
    let matters = |constant: &MaterialConstant| {
        MECHANICAL.contains(&constant.key)
            || constant.key == "expansion" && solid.has_temperature()
            || THERMAL.contains(&constant.key) && solid.conducts()
    };
    let own = solid.material.as_ref().map(|choice| choice.material());
    let given = |constant: &&MaterialConstant| {
        matters(constant) && own.is_some_and(|material| constant.is_given(material))
    };
    let offer = |constant: &'static MaterialConstant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Material(constant),
    };
    let own = MaterialConstant::all().into_iter().filter(given).map(offer);
    let layers = solid.layers.as_deref().unwrap_or_default();
    let of_layer = |place| of_layer_material(body, layers, place, matters);
    let convective = solid.faces.iter().filter(|(_, face)| face.convection.is_some());
    own.chain((0..layers.len()).flat_map(of_layer))
        .chain(convective.map(|(&face, _)| coefficient(body, face)))
        .collect()
}

/// Places of a constant in a solid of large strain.
///
/// # Panics
/// If no such solid offers the constant.
pub fn places<'a>(solid: &'a mut LargeStrain, constant: &Constant) -> Vec<&'a mut f64> {
    match constant {
        Constant::Material(constant) => {
            let own = solid.material.iter_mut();
            own.filter_map(|choice| choice.material_mut().number(constant.key)).collect()
        }
        Constant::LayerMaterial { layers, constant } => {
            places_in_layers(solid.layers.as_mut(), layers, constant)
        }
        Constant::ConvectionCoefficient { face } => {
            let convection = solid.faces.get_mut(face).and_then(|face| face.convection.as_mut());
            convection.map(|convection| &mut convection.coefficient).into_iter().collect()
        }
        _ => panic!("a solid of large strain offers constants of its materials and faces"),
    }
}
