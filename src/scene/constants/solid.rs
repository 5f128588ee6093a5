//! The constants of solids: of their material or of each layer's, of contacts between layers, and of faces.

use super::{Constant, OfferedConstant};
use crate::laws::MaterialConstant;
use crate::scene::types::{FaceName, Layer, Solid};

/// The layers of a body that share a material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LayersOf {
    /// All of a named one.
    Named(String),
    /// The one of this number, counted from 0, whose material has no name.
    Single(usize),
}

impl LayersOf {
    fn contains(&self, index: usize, layer: &Layer) -> bool {
        match self {
            Self::Named(name) => layer.material.name.as_ref() == Some(name),
            Self::Single(single) => *single == index,
        }
    }
}

/// The constants of a solid: `constant` of its material; `MATERIAL.constant` of layers of named materials,
/// `layer[n].constant` of others and `layer[n].contact_resistance`, counted from the top, from one on; temperature and
/// faces.
pub fn offered(body: &str, solid: &Solid) -> Vec<OfferedConstant> {
    let own = solid.material.as_ref().map(|choice| choice.material());
    let given = MaterialConstant::all()
        .into_iter()
        .filter(|constant| own.is_some_and(|material| constant.is_given(material)));
    let mut list: Vec<_> = given
        .map(|constant| OfferedConstant {
            key: constant.key.to_owned(),
            description: format!("{} of {body}", constant.description),
            constant: Constant::Material(constant),
        })
        .collect();
    let layers = solid.layers.as_deref().unwrap_or_default();
    list.extend((0..layers.len()).flat_map(|place| of_layer(body, layers, place)));
    list.push(OfferedConstant {
        key: "initial_temperature".to_owned(),
        description: format!("uniform temperature of {body} at time zero, free of thermal stress"),
        constant: Constant::InitialTemperature,
    });
    let convective = solid.faces.iter().filter(|(_, face)| face.convection.is_some());
    list.extend(convective.map(|(&face, _)| coefficient(body, face)));
    list.extend(solid.bath.iter().flat_map(|_| super::bath::offered(body)));
    list
}

/// The heat transfer coefficient of a convective face.
pub(super) fn coefficient(body: &str, face: FaceName) -> OfferedConstant {
    OfferedConstant {
        key: format!("{}.coefficient", face.as_str()),
        description: format!("heat transfer coefficient of the {} of {body}", face.as_str()),
        constant: Constant::ConvectionCoefficient { face },
    }
}

/// Those of the layer at a place, and of its contact with the one above.
fn of_layer(body: &str, layers: &[Layer], place: usize) -> Vec<OfferedConstant> {
    let mut list = of_layer_material(body, layers, place, |_| true);
    if layers[place].contact_resistance.is_some() {
        list.push(OfferedConstant {
            key: format!("layer[{}].contact_resistance", place + 1),
            description: format!(
                "thermal resistance between the layers {place} and {} of {body}",
                place + 1
            ),
            constant: Constant::ContactResistance { layer: place },
        });
    }
    list
}

/// Those of a layer's material that matter.
pub(super) fn of_layer_material(
    body: &str,
    all: &[Layer],
    place: usize,
    matters: impl Fn(&MaterialConstant) -> bool,
) -> Vec<OfferedConstant> {
    let layer = &all[place];
    let (prefix, owner, layers) = match &layer.material.name {
        // Once for all layers of it.
        Some(name)
            if all[..place].iter().any(|other| other.material.name.as_ref() == Some(name)) =>
        {
            return Vec::new();
        }
        Some(name) => (name.clone(), format!("{name} in {body}"), LayersOf::Named(name.clone())),
        None => {
            let number = place + 1;
            let owner = format!("layer {number} of {body}");
            (format!("layer[{number}]"), owner, LayersOf::Single(place))
        }
    };
    let given = |constant: &&MaterialConstant| {
        constant.is_given(layer.material.material()) && matters(constant)
    };
    let offered = |constant: &'static MaterialConstant| OfferedConstant {
        key: format!("{prefix}.{}", constant.key),
        description: format!("{} of {owner}", constant.description),
        constant: Constant::LayerMaterial { layers: layers.clone(), constant },
    };
    MaterialConstant::all().into_iter().filter(given).map(offered).collect()
}

/// Places of a constant in the layers of a body that share a material.
pub(super) fn places_in_layers<'a>(
    layers: Option<&'a mut Vec<Layer>>,
    own: &LayersOf,
    constant: &MaterialConstant,
) -> Vec<&'a mut f64> {
    let all = layers.into_iter().flatten().enumerate();
    all.filter(|(i, layer)| own.contains(*i, layer))
        .filter_map(|(_, layer)| constant.place(layer.material.material_mut()))
        .collect()
}

/// Places of a constant in a solid.
///
/// # Panics
/// If no solid offers the constant, or not this one.
pub fn places<'a>(solid: &'a mut Solid, constant: &Constant) -> Vec<&'a mut f64> {
    match constant {
        Constant::InitialTemperature => vec![&mut solid.initial_temperature],
        Constant::Material(constant) => {
            let own = solid.material.iter_mut();
            own.filter_map(|choice| constant.place(choice.material_mut())).collect()
        }
        Constant::LayerMaterial { layers: own, constant } => {
            places_in_layers(solid.layers.as_mut(), own, constant)
        }
        Constant::ContactResistance { layer } => {
            let layer = solid.layers.iter_mut().flatten().nth(*layer);
            layer.and_then(|layer| layer.contact_resistance.as_mut()).into_iter().collect()
        }
        Constant::ConvectionCoefficient { face } => {
            let face = solid.faces.get_mut(face).expect("offered by this very face");
            vec![&mut face.convection.as_mut().expect("offered as convective").coefficient]
        }
        Constant::Bath(constant) => {
            vec![constant.place(solid.bath.as_mut().expect("offered by this very bath"))]
        }
        Constant::FlawDepth { .. } => panic!("the scene itself holds its flaws"),
        Constant::Droplet(_)
        | Constant::Filament(_)
        | Constant::Lattice(_)
        | Constant::Fluid(_) => {
            panic!("a solid has no constants of other bodies")
        }
    }
}
