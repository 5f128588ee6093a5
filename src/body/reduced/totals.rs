//! Readings of a whole reduced model.

use super::values::{Kind, Values};
use crate::body::{Descriptor, Direct};
use crate::quantity::Quantity;
use crate::scene::Scene;

/// A scalar of the whole body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Total {
    HeatIn,
    HeatStored,
    HeatLost,
    /// Error bound of the values of a kind.
    Bound(Kind),
}

const TOTALS: [(Total, Descriptor); 7] = [
    (Total::HeatIn, heat("heat_in", "heat that loads and prescribed fluxes have brought in")),
    (Total::HeatStored, heat("heat_stored", "heat stored since time zero")),
    (
        Total::HeatLost,
        heat("heat_lost", "heat that has left through convective and prescribed-temperature faces"),
    ),
    (
        Total::Bound(Kind::Temperature),
        bound(
            "error_bound_temperature",
            "bound of the error of all temperatures, by the reduction, under the inputs so far",
            Quantity::TemperatureDifference,
        ),
    ),
    (
        Total::Bound(Kind::Stress),
        bound(
            "error_bound_stress",
            "bound of the error of all stress components, by the reduction, under the inputs so far",
            Quantity::Stress,
        ),
    ),
    (
        Total::Bound(Kind::Displacement),
        bound(
            "error_bound_displacement",
            "bound of the error of all displacements, by the reduction, under the inputs so far",
            Quantity::Displacement,
        ),
    ),
    (
        Total::Bound(Kind::Heat),
        bound(
            "error_bound_heat",
            "bound of the error of heat stored and lost, by the reduction, under the inputs so far",
            Quantity::Energy,
        ),
    ),
];

const fn heat(key: &'static str, words: &'static str) -> Descriptor {
    Descriptor { key, words, quantity: Quantity::Energy, direct: Direct::Nothing }
}

const fn bound(key: &'static str, words: &'static str, quantity: Quantity) -> Descriptor {
    Descriptor { key, words, quantity, direct: Direct::Drives }
}

/// The totals that a reduced body of a scene offers, each with its place in the table.
pub fn offered_totals(scene: &Scene, name: &str) -> Vec<(usize, Descriptor)> {
    let values = Values::of(scene, name);
    let is_offered = |total: &Total| match total {
        Total::Bound(kind) => values.kinds().any(|own| own == *kind),
        _ => true,
    };
    let offered = TOTALS.iter().enumerate().filter(|(_, (total, _))| is_offered(total));
    offered.map(|(place, (_, descriptor))| (place, *descriptor)).collect()
}

pub fn total(place: usize) -> Total {
    TOTALS[place].0
}
