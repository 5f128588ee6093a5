//! Readings of a droplet in a state.

use super::memo::DropletMemo;
use super::{DropletBody, Rest};
use crate::method::sph::DropletTotals;
use crate::port::WallExchange;

/// A droplet in a state.
pub struct DropletReader<'a> {
    pub body: &'a DropletBody,
    pub state: &'a [f64],
    pub memo: &'a mut DropletMemo,
}

impl DropletReader<'_> {
    /// Sums over the fluid; before the first drop, extremes are those of the fluid at rest.
    pub fn totals(&mut self) -> &DropletTotals {
        let Self { body, state, memo } = self;
        memo.totals.get_or_insert_with(|| {
            let totals = body.droplet.totals(state);
            if totals.particles > 0.0 {
                return totals;
            }
            DropletTotals {
                max_pressure: 0.0,
                density_range: [1.0; 2],
                temperature_range: [body.rest.temperature; 2],
                mean_temperature: body.rest.temperature,
                ..totals
            }
        })
    }

    /// Amounts transferred to the wall during the last step.
    pub fn exchange(&mut self) -> &WallExchange {
        let Self { body, state, memo } = self;
        memo.exchange.get_or_insert_with(|| body.droplet.exchange(state))
    }

    /// Thickness of the frozen fluid above each cell of the wall [m].
    pub fn frozen_on_wall(&mut self) -> &[f64] {
        let Self { body, state, memo } = self;
        memo.frozen_on_wall.get_or_insert_with(|| body.droplet.frozen_on_wall(state))
    }

    /// Density at rest [kg/m³].
    pub fn rest_density(&self) -> f64 {
        let Rest { density, .. } = self.body.rest;
        density
    }

    /// Number of mirror images of each particle.
    pub fn copies(&self) -> f64 {
        self.body.copies
    }
}
