//! Nodal enthalpies, solved for by Newton's method.

use super::{Heat, HeatFailure};
use crate::method::fem::heat::HeatLoads;
use crate::method::fem::nonlinear::NonlinearHeat;
use crate::method::heat_totals::HeatTotals;
use crate::runtime::allowance::Allowance;
use crate::state::Layout;

impl Heat for NonlinearHeat {
    fn layout(&self) -> Layout {
        self.layout()
    }

    fn initial_state(&self) -> Vec<f64> {
        self.initial_state()
    }

    fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure> {
        Ok(self.advance(state, loads, dt, allowance)?)
    }

    fn nodal(&self, state: &[f64], _faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.nodal(state)
    }

    fn stored(&self, state: &[f64]) -> f64 {
        self.stored(state)
    }

    fn totals(&self, state: &[f64]) -> HeatTotals {
        self.totals(state)
    }

    fn rates(&self, _state: &[f64], _loads: &HeatLoads, _rates: &HeatLoads) -> Option<Vec<f64>> {
        None
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn tolerance(&self) -> f64 {
        self.tolerance()
    }

    fn liquid_volume(&self, state: &[f64], copies: f64) -> f64 {
        self.liquid_volume(state, copies)
    }

    fn liquid_scatter(&self, state: &[f64], copies: f64) -> f64 {
        self.liquid_scatter(state, copies)
    }
}
