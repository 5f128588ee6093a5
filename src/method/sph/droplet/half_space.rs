//! Drops above a half space that they model themselves.

use super::DropletSph;
use crate::method::sph::cloud::ledger_of;
use crate::method::sph::failure::Failure;
use crate::port::Surface;
use crate::port::WallExchange;
use crate::runtime::allowance::Allowance;

impl DropletSph {
    /// Advances by `duration` [s] above a half space of the plan's effusivity; above a wall of this
    /// temperature if the plan has none. The half space was at this temperature [K] at time zero;
    /// only the drops have heated it since. Returns what the cells received. A failure leaves the
    /// state unchanged.
    pub fn advance_on_half_space(
        &self,
        state: &mut Vec<f64>,
        temperature: f64,
        duration: f64,
        allowance: &Allowance,
    ) -> Result<WallExchange, Failure> {
        let ledger = ledger_of(state, self.head());
        let temperatures = vec![temperature; self.head().cells];
        let mut surface = Surface::held(&temperatures);
        if !self.below.is_empty() {
            surface.response = self.below.clone();
            surface.amplitudes = ledger.memory.given;
        }
        self.advance_above(state, &surface, duration, allowance)?;
        Ok(self.exchange(state))
    }
}
