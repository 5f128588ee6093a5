//! State of a lattice that moves.

use std::slice::from_mut;

use super::LatticeTotals;
use crate::state::{Field, Fields, Per};

/// Everything that changes: displacements, velocities and damage, and sums over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LatticeMotion {
    /// u and w [m] and rotation [rad] of each particle.
    pub displacement: Vec<[f64; 3]>,
    /// Their rates.
    pub velocity: Vec<[f64; 3]>,
    /// ω of each link [1].
    pub damage: Vec<f64>,
    /// Displacement of the load [m] and its speed [m/s].
    pub prescribed: f64,
    pub speed: f64,
    /// Impulse of the load in the last communication step [N s] and the length of that [s].
    pub impulse: f64,
    pub duration: f64,
    /// Work of the load, energy that damage dissipated and energy that damping took [J].
    pub work: f64,
    pub dissipated: f64,
    pub damped: f64,
    /// Number of time steps.
    pub steps: f64,
}

/// Sums over a lattice that moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionTotals {
    pub sums: LatticeTotals,
    /// [J]
    pub kinetic_energy: f64,
    /// Number of parts that unbroken links connect.
    pub fragments: usize,
}

impl LatticeMotion {
    /// Mean load over the last communication step [N].
    pub fn force(&self) -> f64 {
        if self.duration > 0.0 { self.impulse / self.duration } else { 0.0 }
    }
}

impl Fields for LatticeMotion {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| of(name, words, Per::Body, 1);
        let motion = "displacements and rotations [m, rad]";
        let rates = "velocities and their rotations [m/s, rad/s]";
        vec![
            (of("displacement", motion, Per::Node, 3), self.displacement.as_flattened_mut()),
            (of("velocity", rates, Per::Node, 3), self.velocity.as_flattened_mut()),
            (of("damage", "damage [1]", Per::Link, 1), &mut self.damage),
            (body("prescribed", "displacement of the load [m]"), from_mut(&mut self.prescribed)),
            (body("speed", "speed of the load [m/s]"), from_mut(&mut self.speed)),
            (body("impulse", "impulse of the last step [N s]"), from_mut(&mut self.impulse)),
            (body("duration", "length of the last step [s]"), from_mut(&mut self.duration)),
            (body("work", "work of the load [J]"), from_mut(&mut self.work)),
            (
                body("dissipated", "energy that damage dissipated [J]"),
                from_mut(&mut self.dissipated),
            ),
            (body("damped", "energy that damping took [J]"), from_mut(&mut self.damped)),
            (body("steps", "time steps made"), from_mut(&mut self.steps)),
        ]
    }
}
