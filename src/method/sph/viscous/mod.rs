//! Viscosity without error by direction, solved at the end of a time step.
//!
//! The dissipation of particles at velocities u is the quadratic form
//!
//! `E = Σ V_i [µ_i (D_i : D_i + ½ (tr D_i)²) + β µ_i/(2c) Σ V_j w_ij (e_ij − x·D_i x)²]`,
//!
//! with the rate of elongation `e_ij = u_ij·x` of a pair, `x = x_i − x_j`, weights `w = −F` of the
//! kernel's slope, and the strain rate D_i fitted to all pairs of a particle (see [`fit`]). The first
//! part is exact for linear velocities in any arrangement and at free surfaces, which therefore bear
//! no stress. The second is what the fit leaves over. It keeps particles from moving between each
//! other without resistance, and with `β = 4/3` it cancels the leading error of the first: in a
//! shear wave of wave number k, fits lose `k² R/3` of the dissipation and pairs `k² R/12`, with the
//! same R.
//!
//! All forces are derivatives of E along the lines of pairs. They conserve momentum and angular
//! momentum, and vanish in rigid motion. The backward Euler step
//! `m (u − u*)/dt = −∂E/∂u` is a symmetric positive definite system, solved by conjugate gradients.
//! Preconditioned by masses alone, each of their iterates conserves what the solution conserves.
//!
//! Frozen fluid is rigid: the step minimises among the velocities in which each of its pieces moves as a rigid body, or
//! is at rest on the wall. Conjugate gradients remain in this space, as loads and products are reduced to the
//! impulses that move it.
//!
//! The fluid sticks to planes across z: its images there move against it, and E counts the fluid
//! alone.
//!
//! Sources: the stress form of implicit viscosity is that of Takahashi, Dobashi, Fujishiro,
//! Nishita & Lin (2015), Comput. Graph. Forum 34, 493–502, doi 10.1111/cgf.12578; that of pairs of
//! Weiler, Koschier, Brand & Bender (2018), Comput. Graph. Forum 37, 145–155, doi
//! 10.1111/cgf.13349.

mod curves;
mod fit;
mod flow;
mod moments;
mod pressure;
mod rate;
mod strain;
mod stress;
mod system;
mod tensor;
mod weights;

use super::cloud::Cloud;
use super::frozen::Pieces;
use super::method::Method;
use super::neighbours::Block;
use crate::math::conjugate_gradients::{NotConverged, solve};
use crate::runtime::parallel::Team;
pub use curves::FlowCurves;
pub use flow::AT_YIELD;
use system::{Moduli, Reactions, System};
use tensor::Products;
use weights::Weights;

/// Residual of a linear step over the change of velocities by viscosity.
const TOLERANCE: f64 = 1e-4;
/// Residual of a step with pressure over the impulses that drive it.
const DRIVEN: f64 = 3e-3;
/// The same over momenta: what moves on without a change needs no better solution.
const CARRIED: f64 = 3e-5;

/// Radius over H beyond which no pairs count in viscosity.
pub fn reach(method: &Method) -> f64 {
    Weights::of(method.dimension, method.spacing).reach()
}

/// Viscous changes of all particles over a step.
pub struct ViscousStep {
    /// Velocity differences over c₀.
    pub changes: Vec<[f64; 3]>,
    /// Accelerations by the wall.
    pub by_wall: Vec<[f64; 3]>,
    /// Force of a nozzle on the particles in it, over ρ₀c₀²H².
    pub by_nozzle: [f64; 3],
    /// Stresses beyond the linear law, see [`flow`]; empty for Newtonian fluids.
    pub stresses: Vec<Products>,
    /// Largest shear rate of fluid that does not yield, over c₀/H.
    pub creep: f64,
    /// Products with matrices of the step.
    pub iterations: usize,
}

/// Computes the changes of velocity by viscosity over a time step, over H/c₀. With pressure, the velocities before the
/// step are a first guess of those after it.
pub fn advance(
    method: &Method,
    cloud: &Cloud,
    frozen: &Pieces,
    blocks: &[Block],
    (dt, before): (f64, &[[f64; 3]]),
    team: &Team,
) -> Result<ViscousStep, NotConverged> {
    if !method.flow.is_newtonian() {
        return flow::advance(method, cloud, frozen, blocks, (dt, before), team);
    }
    let moduli = team.map(cloud.len(), |i| {
        let viscosity = method.flow.newtonian(cloud.temperature[i]);
        // Time steps rely on the damping of sound by the reference.
        Moduli { volume: viscosity.max(method.viscosity), ..Moduli::newtonian(viscosity) }
    });
    let system = System::of(method, cloud, frozen, blocks, dt, moduli, team);
    if method.solves_pressure {
        return with_pressure(&system, before.as_flattened(), team);
    }
    let velocity = cloud.velocity.as_flattened();
    let pairs = system.elongations(velocity);
    let forces = system.forces(&pairs, &system.forms(&pairs));
    let mut load = system.load(&forces);
    system.reduce(&mut load);
    let (changes, iterations) = solve(&system, &load, TOLERANCE, team)?;
    let after: Vec<f64> = velocity.iter().zip(&changes).map(|(v, change)| v + change).collect();
    let pairs = system.elongations(&after);
    let Reactions { by_wall, by_nozzle } =
        system.reactions(&system.forces(&pairs, &system.forms(&pairs)), &changes);
    let changes = changes.as_chunks().0.to_vec();
    Ok(ViscousStep { changes, by_wall, by_nozzle, stresses: Vec::new(), creep: 0.0, iterations })
}

/// Computes the changes of velocity by viscosity and pressure from a guess of the velocities at the end, which at rest
/// is the solution.
fn with_pressure(system: &System, guess: &[f64], team: &Team) -> Result<ViscousStep, NotConverged> {
    let mass = &system.cloud.mass;
    let driven = system.cloud.velocity.as_flattened();
    let pairs = system.elongations(guess);
    let load = residual(system, guess, &system.forces(&pairs, &system.forms(&pairs)));
    let size = norm(&load, mass);
    let impulses = (0..driven.len()).map(|n| mass[n / 3] * (driven[n] - guess[n]));
    let driving = norm(&impulses.collect::<Vec<_>>(), mass);
    let momenta = driven.iter().enumerate().map(|(n, v)| mass[n / 3] * v);
    let carried = norm(&momenta.collect::<Vec<_>>(), mass);
    let wanted = (DRIVEN * size.max(driving)).max(CARRIED * carried);
    let (mut after, mut iterations) = (guess.to_vec(), 0);
    if size > wanted {
        let (changes, spent) = solve(system, &load, wanted / size, team)?;
        iterations = spent;
        after.iter_mut().zip(&changes).for_each(|(v, change)| *v += change);
    }
    let pairs = system.elongations(&after);
    let changes: Vec<f64> = after.iter().zip(driven).map(|(v, driven)| v - driven).collect();
    let Reactions { by_wall, by_nozzle } =
        system.reactions(&system.forces(&pairs, &system.forms(&pairs)), &changes);
    let changes = changes.as_chunks().0.to_vec();
    Ok(ViscousStep { changes, by_wall, by_nozzle, stresses: Vec::new(), creep: 0.0, iterations })
}

/// Residual of the step's equation of motion: `m (u* − u)` plus the impulses of forces, of those on frozen pieces what
/// moves them.
fn residual(system: &System, velocity: &[f64], forces: &[system::Forces]) -> Vec<f64> {
    let before = system.cloud.velocity.as_flattened();
    let mut load = system.load(forces);
    for (n, load) in load.iter_mut().enumerate() {
        *load += system.cloud.mass[n / 3] * (before[n] - velocity[n]);
    }
    system.reduce(&mut load);
    load
}

/// `√(Σ r²/m)`.
fn norm(load: &[f64], mass: &[f64]) -> f64 {
    load.iter().enumerate().map(|(n, load)| load * load / mass[n / 3]).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests;
