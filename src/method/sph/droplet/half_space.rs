//! Drops above a half space that nobody else computes.

use super::DropletSph;
use crate::method::sph::cloud::ledger_of;
use crate::method::sph::failure::Failure;
use crate::port::Surface;
use crate::port::WallExchange;
use crate::runtime::allowance::Allowance;

impl DropletSph {
    /// Advances by `duration` [s] above a half space of the plan's effusivity, which had one temperature [K] at time
    /// zero and has been warmed by the drops alone since; above a wall held at that temperature where the plan has no
    /// effusivity. What the cells got meanwhile. A failure leaves the state as it was.
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
