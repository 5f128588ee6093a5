//! State of a body of large strain that moves.

use std::slice::from_mut;

use super::{Friction, Warmth};
use crate::state::{Field, Fields, Per};

/// Displacements and velocities of the nodes, history of the points, and integrals over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Motion {
    pub ledger: Ledger,
    /// u [m].
    pub displacement: Vec<[f64; 3]>,
    /// [m/s]
    pub velocity: Vec<[f64; 3]>,
    /// History of the law, point by point.
    pub history: Vec<f64>,
    /// Heat of a body that conducts it.
    pub warmth: Warmth,
    /// Friction on the plane below.
    pub friction: Friction,
}

/// Integrals over time and events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// [s]
    pub time: f64,
    /// Number of time steps.
    pub steps: f64,
    /// Work of the stresses [J].
    pub internal_work: f64,
    /// Work of the loads on faces, and of the faces that are held or moved [J].
    pub load_work: f64,
    pub face_work: f64,
    /// Sum of the sizes of these works in all implicit steps [J].
    pub turnover: f64,
    /// Impulse of the body on the plane [N s].
    pub impulse_to_plane: f64,
    /// Time at which the body last left the plane [s]; 0 before.
    pub lift_off: f64,
    /// Impulse of the last step on each cell of the plane along z [N s], and beyond them.
    pub exchange: Vec<f64>,
    pub outside: f64,
    /// Length of the last step [s].
    pub duration: f64,
}

impl Motion {
    /// Adds what passed to what lies below in an earlier part of the last step.
    pub fn add_exchange(&mut self, earlier: &Self) {
        let (ledger, before) = (&mut self.ledger, &earlier.ledger);
        ledger.duration += before.duration;
        ledger.outside += before.outside;
        add(&mut ledger.exchange, &before.exchange);
        let along = self.friction.exchange.as_flattened_mut();
        add(along, earlier.friction.exchange.as_flattened());
        add(&mut self.warmth.exchange, &earlier.warmth.exchange);
        self.warmth.outside += earlier.warmth.outside;
    }
}

fn add(sums: &mut [f64], parts: &[f64]) {
    sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
}

impl Ledger {
    /// Work of the stresses, of loads, and of faces that are held or moved [J].
    pub fn works(&self) -> [f64; 3] {
        [self.internal_work, self.load_work, self.face_work]
    }
}

impl Fields for Motion {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| of(name, words, Per::Body, 1);
        let ledger = &mut self.ledger;
        let mut fields = vec![
            (body("time", "time since the start [s]"), from_mut(&mut ledger.time)),
            (body("steps", "time steps made"), from_mut(&mut ledger.steps)),
            (
                body("internal_work", "work of the stresses [J]"),
                from_mut(&mut ledger.internal_work),
            ),
            (body("load_work", "work of loads on faces [J]"), from_mut(&mut ledger.load_work)),
            (body("face_work", "work of held faces [J]"), from_mut(&mut ledger.face_work)),
            (
                body("impulse_to_plane", "impulse on the plane below [N s]"),
                from_mut(&mut ledger.impulse_to_plane),
            ),
            (body("lift_off", "time of the last lift-off [s]"), from_mut(&mut ledger.lift_off)),
            (body("duration", "length of the last step [s]"), from_mut(&mut ledger.duration)),
            (
                body("outside", "impulse beyond the cells in the last step [N s]"),
                from_mut(&mut ledger.outside),
            ),
            (
                of("exchange", "impulse given in the last step [N s]", Per::Cell, 1),
                &mut ledger.exchange,
            ),
            (
                of("displacement", "displacement [m]", Per::Node, 3),
                self.displacement.as_flattened_mut(),
            ),
            (of("velocity", "velocity [m/s]", Per::Node, 3), self.velocity.as_flattened_mut()),
            (of("history", "history of the law", Per::Point, 1), &mut self.history[..]),
        ];
        fields.extend(self.warmth.fields());
        fields.extend(self.friction.fields());
        fields
    }
}
