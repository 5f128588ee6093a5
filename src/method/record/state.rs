//! Variables of state of replayed drops, and their layout in a flat vector.

use std::slice::from_mut;

use crate::state::{Field, Fields, Layout, Per, load, store};

/// Integrals over time and counters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// Time [s].
    pub time: f64,
    /// Length of the last step [s].
    pub duration: f64,
    /// Numbers of drops: requested, released, and landed where another still transferred heat or
    /// momentum.
    pub asked: f64,
    pub released: f64,
    pub overlapping: f64,
    /// Largest number of films on one place so far.
    pub stacked: f64,
    /// Heat [J] and impulse [N s] transferred to the wall since time zero.
    pub heat: f64,
    pub impulse: [f64; 3],
    /// Contact time [s] and speed [m/s] of the drop that landed last of those that have ended; no speed before any has.
    pub landed: [f64; 2],
    /// Number of cells whose heat in the last step was not that of an even distribution of each
    /// ring's: none or all, and the difference [J].
    pub cells: f64,
    pub uneven: Vec<f64>,
}

/// A drop that falls or is active, or was so in the last step.
#[derive(Debug, Clone, PartialEq)]
pub struct Drop {
    /// Contact time [s], position along x and y [m], speed [m/s] and temperature [K] of the drop.
    pub contact: f64,
    pub place: [f64; 2],
    pub speed: f64,
    pub temperature: f64,
    /// Wall temperature of each ring at contact [K]; zeros before.
    pub wall: Vec<f64>,
    /// Lag of each ring's heat behind the age of the drop [s], now and at the beginning of the last
    /// step: zero for a drop that shared its place with no other.
    pub lag: Vec<f64>,
    pub lag_before: Vec<f64>,
}

impl Drop {
    /// Returns true if it has touched the wall.
    pub fn is_down(&self) -> bool {
        self.wall.first().is_some_and(|temperature| *temperature > 0.0)
    }

    /// Longest lag of a ring [s].
    pub fn longest_lag(&self) -> f64 {
        self.lag.iter().copied().fold(0.0, f64::max)
    }
}

fn body(name: &'static str, words: &'static str, width: usize) -> Field {
    Field { name, words, per: Per::Body, width }
}

fn of_drop(name: &'static str, words: &'static str, width: usize) -> Field {
    Field { name, words, per: Per::Drop, width }
}

impl Ledger {
    /// Notes a drop that has ended, if it landed after all others that have.
    pub fn note_ended(&mut self, drop: &Drop) {
        if drop.is_down() && (self.landed[1] == 0.0 || drop.contact >= self.landed[0]) {
            self.landed = [drop.contact, drop.speed];
        }
    }
}

impl Fields for Ledger {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        vec![
            (body("time", "time since the start [s]", 1), from_mut(&mut self.time)),
            (body("duration", "length of the last step [s]", 1), from_mut(&mut self.duration)),
            (body("asked", "drops asked for so far", 1), from_mut(&mut self.asked)),
            (body("released", "drops released so far", 1), from_mut(&mut self.released)),
            (
                body("overlapping", "drops that came down on others", 1),
                from_mut(&mut self.overlapping),
            ),
            (body("stacked", "most films on one place so far", 1), from_mut(&mut self.stacked)),
            (body("heat", "heat given to the wall [J]", 1), from_mut(&mut self.heat)),
            (body("impulse", "impulse given to the wall [N s]", 3), &mut self.impulse),
            (
                body("landed", "contact [s] and speed [m/s] of the last drop that has ended", 2),
                &mut self.landed,
            ),
            (body("cells", "cells that absorbed heat unevenly", 1), from_mut(&mut self.cells)),
            (
                Field {
                    name: "uneven",
                    words: "heat of the cell beyond its even share [J]",
                    per: Per::Cell,
                    width: 1,
                },
                &mut self.uneven,
            ),
        ]
    }
}

/// Number of values of a drop besides those of its rings, and number of values of a ring.
const OF_DROP: usize = 5;
const OF_RING: usize = 3;

/// Number of values of a drop.
const fn width(rings: usize) -> usize {
    OF_DROP + OF_RING * rings
}

impl Fields for Drop {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let rings = self.wall.len();
        vec![
            (
                of_drop("contact", "time at which it touches the wall [s]", 1),
                from_mut(&mut self.contact),
            ),
            (of_drop("place", "where it comes down [m]", 2), &mut self.place),
            (of_drop("speed", "speed towards the wall [m/s]", 1), from_mut(&mut self.speed)),
            (of_drop("temperature", "temperature [K]", 1), from_mut(&mut self.temperature)),
            (of_drop("wall", "what the rings had as they were touched [K]", rings), &mut self.wall),
            (of_drop("lag", "lag of the rings' heat [s]", rings), &mut self.lag),
            (
                of_drop("lag_before", "lag of the rings' heat before the last step [s]", rings),
                &mut self.lag_before,
            ),
        ]
    }
}

impl Drop {
    pub fn none(rings: usize) -> Self {
        let zeros = vec![0.0; rings];
        Self {
            contact: 0.0,
            place: [0.0; 2],
            speed: 0.0,
            temperature: 0.0,
            wall: zeros.clone(),
            lag: zeros.clone(),
            lag_before: zeros,
        }
    }
}

/// Number of cells in a state whose heat was uneven; `None` if the state has no such number.
pub fn cells_in(state: &[f64]) -> Option<usize> {
    let head = Layout::of(&mut Ledger::default()).len();
    let cells = *state.get(head - 1)?;
    let is_count = cells.fract() == 0.0 && cells >= 0.0 && cells <= state.len() as f64;
    is_count.then_some(cells as usize)
}

/// Number of drops in a state; `None` if its length fits no number.
pub fn drops_in(state: &[f64], rings: usize) -> Option<usize> {
    let head = Layout::of(&mut Ledger::default()).len() + cells_in(state)?;
    let rest = state.len().checked_sub(head)?;
    rest.is_multiple_of(width(rings)).then(|| rest / width(rings))
}

/// Fields of a state with a number of drops, grouped by drop.
pub fn layout(drops: usize, rings: usize, cells: usize) -> Layout {
    let of_one = Layout::of(&mut Drop::none(rings));
    let uneven = vec![0.0; cells];
    let head = Layout::of(&mut Ledger { uneven, ..Ledger::default() });
    (0..drops).fold(head, |all, _| all.then(of_one.clone()))
}

/// Restores a state from its flat vector.
pub fn unflatten(state: &[f64], rings: usize) -> (Ledger, Vec<Drop>) {
    let uneven = vec![0.0; cells_in(state).unwrap_or(0)];
    let mut ledger = Ledger { uneven, ..Ledger::default() };
    load(&mut ledger, state);
    let head = state.len() - drops_in(state, rings).unwrap_or(0) * width(rings);
    let drop = |numbers: &[f64]| {
        let mut drop = Drop::none(rings);
        load(&mut drop, numbers);
        drop
    };
    (ledger, state[head..].chunks_exact(width(rings)).map(drop).collect())
}

/// Writes a state to a flat vector.
pub fn flatten(ledger: &mut Ledger, drops: &mut [Drop]) -> Vec<f64> {
    ledger.cells = ledger.uneven.len() as f64;
    let head = Layout::of(ledger).len();
    let rings = drops.first().map_or(0, |drop| drop.wall.len());
    let mut state = vec![0.0; head + drops.len() * width(rings)];
    store(ledger, &mut state);
    for (drop, to) in drops.iter_mut().zip(state[head..].chunks_exact_mut(width(rings))) {
        store(drop, to);
    }
    state
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn state_round_trip() {
        let mut ledger = Ledger {
            time: 2.0,
            released: 2.0,
            impulse: [1.0, 2.0, 3.0],
            uneven: vec![0.5, -0.5],
            ..Ledger::default()
        };
        let drop = |at: f64| Drop {
            contact: at,
            wall: vec![at, 2.0 * at, 300.0],
            lag: vec![0.5; 3],
            ..Drop::none(3)
        };
        let mut drops = vec![drop(1.0), drop(4.0)];
        let state = flatten(&mut ledger, &mut drops);
        assert_eq!(layout(2, 3, 2).len(), state.len());
        assert_eq!(drops_in(&state, 3), Some(2));
        assert_eq!(drops_in(&state[1..], 3), None);
        assert_eq!(unflatten(&state, 3), (ledger, drops));
    }
}
