//! Sudden breaks under a held load, as motion that comes to rest.

use super::LatticeError;
use super::equilibrium::{Balanced, Equilibrium, Found, norm};
use crate::runtime::allowance::Allowance;

/// Mass of each unknown for a density of one, the time step that the highest frequency allows, and the part of a speed
/// that damping leaves in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Masses {
    pub of_unknowns: Vec<f64>,
    pub time_step: f64,
    pub fading: f64,
}

/// Time steps after which motion is given up.
const MOST_STEPS: usize = 50_000;
const STEPS: &str = "time steps of a sudden break";
/// Updates of an unknown in a time step.
const WORK: usize = 10;
/// Unbalanced part of the forces from which Newton's method finishes, and time steps after which that is tried.
const NEAR: f64 = 2e-3;
const TRIED: usize = 50;

impl Equilibrium {
    /// Lets links break suddenly while the load is held: the strip moves, damped, until it is nearly at rest. Returns
    /// the equilibrium and the energy that damage dissipates [J].
    pub fn settle(
        &self,
        start: &Balanced,
        reached: &mut [f64],
        wanted: f64,
        allowance: &Allowance,
    ) -> Result<(Balanced, f64), LatticeError> {
        let Masses { of_unknowns: mass, time_step, fading } = &self.masses;
        // The load moves while no link breaks, so that no wave starts from it.
        let mut now = self.unbroken(&start.displacement, reached, wanted)?;
        let mut velocity = vec![0.0; mass.len()];
        let load = &self.pattern.frame.load;
        let compliance: f64 = load.iter().map(|&(at, part)| part * part / mass[at]).sum();
        let mut dissipated = 0.0;
        for step in 0..MOST_STEPS {
            allowance.spend(1.0, STEPS, WORK * mass.len())?;
            let trial = self.trial(&now.displacement, reached);
            dissipated += self.broken(&trial.deformation, [reached, &trial.damage]);
            reached.copy_from_slice(&trial.damage);
            let driven: f64 =
                load.iter().map(|&(at, part)| part * trial.forces[at] / mass[at]).sum();
            now.force = driven / compliance;
            let residual = self.residual(&trial, now.force);
            let is_near = norm(&residual) <= NEAR * self.scale(&trial);
            if step % TRIED == TRIED - 1
                && is_near
                && let Some(found) = self.solve(&now, reached, wanted, allowance)?
            {
                let Found { balanced, trial: end, .. } = found;
                dissipated += self.broken(&end.deformation, [reached, &end.damage]);
                reached.copy_from_slice(&end.damage);
                return Ok((balanced, dissipated));
            }
            let kick = if step == 0 { 0.5 } else { 1.0 } * time_step;
            for ((velocity, residual), mass) in velocity.iter_mut().zip(&residual).zip(mass) {
                *velocity = fading * *velocity - kick * residual / mass;
            }
            for (own, velocity) in now.displacement.iter_mut().zip(&velocity) {
                *own += time_step * velocity;
            }
        }
        Err(LatticeError::NotSettled { steps: MOST_STEPS })
    }
}
