//! Checks that a scene fits into the available memory before anything large is built.

use super::{Forecast, Model, ModelError, State, forecast};
use crate::body::Need;
use crate::runtime::address_space::{self, ARENA, PRODUCTS, SPARE, TooLittle};
use crate::runtime::thread::{SPACE, STACK};
use crate::scene::Scene;

/// Memory per unknown of a step or a reading of temperatures, beyond the state itself [B].
const WORK: usize = 100;
/// Memory of any call that reads no bodies [B].
const LITTLE: usize = 1 << 20;
/// Data that fit into the space that the C library reserves for a thread [B].
const WITHIN_ARENA: f64 = 0.6 * ARENA as f64;

impl Forecast {
    /// Memory of all bodies [B].
    pub fn memory(&self) -> f64 {
        self.needs().iter().map(|need| need.memory).sum()
    }

    /// Memory of the bodies whose steps are made on a thread of their own, where there are any [B].
    pub(super) fn memory_of_steps(&self) -> f64 {
        let needs = self.needs().into_iter();
        needs.filter(|need| need.particles.is_some()).fold(0.0, |sum, need| sum + need.memory)
    }
}

/// Refuses a scene whose forecast memory exceeds the `available` one [B] or the scene's own limit, or whose address
/// space exceeds the limit of the process.
pub fn check_memory(scene: &Scene, available: f64) -> Result<(), ModelError> {
    let own = scene.solver.memory.map_or(f64::INFINITY, |limit| limit as f64);
    let is_own = own < available;
    let available = available.min(own);
    let forecast = forecast(scene);
    let needed = forecast.memory();
    let needs = || {
        let needs = forecast.needs().into_iter();
        needs.max_by(|a, b| a.memory.total_cmp(&b.memory)).expect("a body needs it")
    };
    // NaN counts as too much, too.
    if needed.is_nan() || needed > available {
        let Need { name, size, remedy, .. } = needs();
        let body = name.to_owned();
        return Err(ModelError::Memory { needed, available, is_own, body, size, remedy });
    }
    address_space::expect(space(needed, 1)).map_err(|space| {
        let Need { name, size, remedy, .. } = needs();
        ModelError::Space { space, body: name.to_owned(), size, remedy }
    })
}

/// Address space to read and check a scene [B].
const READING: usize = 6 << 20;

/// Refuses to read a scene where not even that fits.
pub fn check_room_to_read() -> Result<(), ModelError> {
    Ok(address_space::expect(READING)?)
}

/// Address space to build a model with this amount of data, on this number of threads [B].
fn space(data: f64, threads: usize) -> usize {
    let arena = if data > WITHIN_ARENA { ARENA } else { 0 };
    data as usize + arena + STACK + PRODUCTS + SPARE + (threads - 1) * SPACE
}

/// Number of threads for which there is address space beyond the data of a scene.
pub(super) fn threads_that_fit(scene: &Scene) -> usize {
    let Some(left) = address_space::left() else { return usize::MAX };
    1 + left.saturating_sub(space(forecast(scene).memory(), 1)) / SPACE
}

impl Model {
    /// Refuses a step for which there is too little address space.
    pub(super) fn expect_room_to_step(&self, state: &State) -> Result<(), TooLittle> {
        let deep = self.bodies.iter().any(|body| body.steps_are_deep());
        let own = if deep { STACK + SPARE + self.memory_of_steps } else { 0 };
        address_space::expect(own + self.room(state))
    }

    /// Memory to read or copy a state [B].
    pub fn room(&self, state: &State) -> usize {
        let unknowns: usize = state.bodies.iter().map(Vec::len).sum();
        let room = WORK * (unknowns + state.inputs.len());
        // So little memory is always available.
        if room < LITTLE / 8 { room } else { room + LITTLE }
    }
}
