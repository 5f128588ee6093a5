//! The parameters of bodies that are made of layers.

use super::{LayersOf, MaterialConstant, Parameter, Quantity};
use crate::limits::Bounds;
use crate::scene::{Layer, Solid};

/// Adds `body.material.constant` of named materials, `body.layer[n].constant` of others, and
/// `body.layer[n].contact_resistance` where there is one; layers are counted from the top, from one on.
pub fn parameters(
    (body, solid): (&str, &Solid),
    add: &mut impl FnMut(String, String, Parameter, Quantity, Bounds),
) {
    let layers = solid.layers.as_deref().unwrap_or_default();
    for (i, layer) in layers.iter().enumerate() {
        constants(body, (i, layer), layers, add);
        if layer.contact_resistance.is_some() {
            add(
                format!("{body}.layer[{}].contact_resistance", i + 1),
                format!("thermal resistance between the layers {i} and {} of {body}", i + 1),
                Parameter::ContactResistance { body: body.to_owned(), layer: i },
                Quantity::ThermalResistance,
                Bounds::from(0.0),
            );
        }
    }
}

fn constants(
    body: &str,
    (i, layer): (usize, &Layer),
    all: &[Layer],
    add: &mut impl FnMut(String, String, Parameter, Quantity, Bounds),
) {
    let (prefix, owner, layers) = match &layer.material.name {
        // Once for all layers of it.
        Some(name) if all[..i].iter().any(|other| other.material.name.as_ref() == Some(name)) => {
            return;
        }
        Some(name) => {
            let owner = format!("{name} in {body}");
            (format!("{body}.{name}"), owner, LayersOf::Named(name.clone()))
        }
        None => {
            let owner = format!("layer {} of {body}", i + 1);
            (format!("{body}.layer[{}]", i + 1), owner, LayersOf::Single(i))
        }
    };
    let given = |constant: &&MaterialConstant| constant.is_given(layer.material.material());
    for constant in MaterialConstant::all().into_iter().filter(given) {
        let (body, layers) = (body.to_owned(), layers.clone());
        add(
            format!("{prefix}.{}", constant.key),
            format!("{} of {owner}", constant.description),
            Parameter::LayerMaterial { body, layers, constant },
            constant.quantity,
            constant.bounds,
        );
    }
}
