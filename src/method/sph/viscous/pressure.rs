//! Pressure at the end of a step.
//!
//! With the rate of the density `d_i = Σ V_j F u_ij·x_ij` at the velocities u of the end, the pressure there is, over
//! ρ₀c₀²,
//!
//! `p = S (p(r) + dt d)`,
//!
//! and its forces per volume are `−Σ V_j F (p_i + p_j) x_ij`, as in [`Momentum`]: the negative transpose of d. The mean
//! `(S q)_i = n_i Σ V_j W_ij n_j q_j` with `n_i = (Σ V_j W_ij)^(−1/2)` is symmetric and positive. So the energy gains a
//! form `½ dt Σ V_i d_i (S d)_i ≥ 0`: sound that a step does not resolve is damped, and sets it no limit.
//!
//! Without the mean, pressure would resist what d shows of the disorder of particles, and lock the flow of thin films.

use super::super::cloud::Cloud;
use super::super::continuity::Continuity;
use super::super::images::Images;
use super::super::loops::{for_all, for_all_of};
use super::super::means::Means;
use super::super::method::Method;
use super::super::momentum::Momentum;
use super::super::neighbours::Block;
use super::super::units::pressure;
use super::system::Forces;
use super::weights::{KERNEL, SHAPE};
use crate::runtime::parallel::Team;

/// Pressure forces at the positions of a step.
pub struct PressureForces<'a> {
    method: &'a Method,
    cloud: &'a Cloud,
    blocks: &'a [Block],
    team: &'a Team,
    /// n of each particle.
    evenness: Vec<f64>,
    /// Forces of the pressure before the step.
    pub before: Vec<Forces>,
}

impl<'a> PressureForces<'a> {
    pub fn of(method: &'a Method, cloud: &'a Cloud, blocks: &'a [Block], team: &'a Team) -> Self {
        let (evenness, before) = (vec![1.0; cloud.len()], Vec::new());
        let mut forces = Self { method, cloud, blocks, team, evenness, before };
        let sums = forces.sums(&forces.evenness, &method.weightless);
        forces.evenness = sums.iter().map(|sum| sum.sqrt().recip()).collect();
        let pressures = team.map(cloud.len(), |i| pressure(cloud.density[i]));
        forces.before = forces.forces_in(&pressures, &method.images);
        forces
    }

    /// Rates of the densities over themselves.
    pub fn compressions(&self, velocity: &[f64]) -> Vec<f64> {
        let records = self.records(|i| [velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]]);
        let pass = Continuity::<false, false> {
            images: &self.method.weightless,
            records: &records,
            densities: &self.cloud.density,
            annexes: &[],
            normalisation: self.method.normalisation,
            diffusion: 0.0,
            tension_dimension: None,
            conduction: 0.0,
        };
        let rates = for_all(&pass, self.blocks, self.method.pairs(), self.team, Vec::new());
        self.team.map(rates.len(), |i| rates[i].density / (1.0 + self.cloud.density[i]))
    }

    /// Forces of a rise of the pressure.
    pub fn forces(&self, rises: &[f64]) -> Vec<Forces> {
        self.forces_in(rises, &self.method.weightless)
    }

    /// Forces of pressures before their mean is taken; those of images follow from their weight.
    fn forces_in(&self, pressures: &[f64], images: &Images) -> Vec<Forces> {
        let means = self.sums(pressures, images);
        let mut records = self.records(|_| [0.0; 3]);
        self.team.for_each(&mut records, |i, record| record[7] = self.evenness[i] * means[i]);
        let pass = Momentum::<false> {
            images,
            records: &records,
            densities: &self.cloud.density,
            normalisation: self.method.normalisation,
            viscosity: 0.0,
            annexes: &[],
        };
        let mut forces = for_all(&pass, self.blocks, self.method.pairs(), self.team, Vec::new());
        self.team.for_each(&mut forces, |i, forces| {
            forces.iter_mut().flatten().for_each(|force| *force *= 1.0 + self.cloud.density[i]);
        });
        forces
    }

    /// `Σ V_j W_ij n_j q_j` of some values q.
    fn sums(&self, values: &[f64], images: &Images) -> Vec<f64> {
        let records = self.records(|i| [values[i], self.evenness[i], 0.0]);
        let normalisation = KERNEL.scale(1.0, self.method.dimension);
        let pass = Means { images, records: &records, normalisation };
        for_all_of(SHAPE, &pass, self.blocks, self.method.pairs(), self.team, Vec::new())
    }

    /// Position, three numbers and volume of each particle.
    fn records(&self, numbers: impl Fn(usize) -> [f64; 3] + Sync) -> Vec<[f64; 8]> {
        self.team.map(self.cloud.len(), |i| {
            let ([x, y, z], [u, v, w]) = (self.cloud.position[i], numbers(i));
            [x, y, z, u, v, w, self.cloud.volume(i), 0.0]
        })
    }
}
