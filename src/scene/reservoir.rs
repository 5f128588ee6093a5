//! Bodies of one temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lookup::BodyInput;
use crate::limits::{Limits, ambient, own_temperature, signed, temperature, within};
use crate::quantity::Quantity;

/// A body that conducts so well that it has one temperature: a chuck, a heated bed, a bath.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reservoir {
    /// Heat capacity C [J/K].
    #[schemars(transform = within(1e-30, 1e30, "J/K", "the heat capacity of a reservoir"))]
    pub heat_capacity: f64,
    /// Temperature at time zero; a parameter [K].
    #[schemars(transform = own_temperature())]
    pub initial_temperature: f64,
    /// Heating power P at the start; an input [W].
    #[serde(default)]
    #[schemars(transform = heating())]
    pub heating: f64,
    /// Conductance G to the surroundings [W/K].
    #[schemars(transform = within(0.0, 1e30, "W/K", "the conductance")
        .condition("with `ambient`")
        .otherwise("no loss"))]
    pub conductance: Option<f64>,
    /// Temperature T∞ of the surroundings; an input [K].
    #[schemars(transform = ambient()
        .condition("with `conductance`")
        .otherwise("no loss"))]
    pub ambient: Option<f64>,
}

/// Limits of the heating power of a reservoir [W].
const fn heating() -> Limits {
    signed("W", "the heating")
}

impl Reservoir {
    /// Inputs: the heating, and the temperature of the surroundings if heat is lost to them.
    pub fn inputs(&self) -> Vec<BodyInput> {
        let heating = BodyInput {
            key: "heating",
            words: "heat brought into the reservoir",
            quantity: Quantity::HeatFlow,
            start: self.heating,
            bounds: heating().bounds(),
        };
        let ambient = self.ambient.map(|start| BodyInput {
            key: "ambient",
            words: "temperature of what the reservoir loses heat to",
            quantity: Quantity::Temperature,
            start,
            bounds: temperature().bounds(),
        });
        std::iter::once(heating).chain(ambient).collect()
    }

    pub fn words(&self) -> String {
        let Self { heat_capacity, initial_temperature, .. } = self;
        let loss = match (self.conductance, self.ambient) {
            (Some(conductance), Some(ambient)) => {
                format!(", loses {conductance} W/K to {ambient} K")
            }
            _ => String::new(),
        };
        format!(
            "a reservoir of {heat_capacity} J/K, at {initial_temperature} K in the beginning{loss}"
        )
    }
}
