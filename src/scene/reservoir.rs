//! Bodies of one temperature.

use serde::{Deserialize, Serialize};

use super::lookup::BodyInput;
use crate::quantity::Quantity;

/// A body that conducts so well that it has one temperature: a chuck, a heated bed, a bath.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reservoir {
    /// [J/K]
    pub heat_capacity: f64,
    /// Temperature at time zero [K].
    pub initial_temperature: f64,
    /// Heat brought in at the start [W].
    #[serde(default)]
    pub heating: f64,
    /// Heat lost to the surroundings over the difference of temperatures [W/K].
    pub conductance: Option<f64>,
    /// Temperature of the surroundings at the start [K].
    pub ambient: Option<f64>,
}

impl Reservoir {
    /// The heating, and the surroundings where heat is lost to any.
    pub fn inputs(&self) -> Vec<BodyInput> {
        let heating = BodyInput {
            key: "heating",
            words: "heat brought into the reservoir",
            quantity: Quantity::HeatFlow,
            start: self.heating,
        };
        let ambient = self.ambient.map(|start| BodyInput {
            key: "ambient",
            words: "temperature of what the reservoir loses heat to",
            quantity: Quantity::Temperature,
            start,
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
