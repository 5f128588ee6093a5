//! Equilibrium of a lattice whose links soften, by Newton's method with exact tangents.

use super::LatticeError;
use super::frame::Combination;
use super::link::{Deformation, Link};
use super::settling::Masses;
use super::stiffness::Pattern;
use super::tangent::Tangent;
use crate::runtime::allowance::Allowance;

/// Links of a strip with their equations.
pub struct Equilibrium {
    pub links: Vec<Link>,
    pub pattern: Pattern,
    /// Share β of bending in the stretch that damages [1].
    pub bending: f64,
    /// True if broken links bear pressure.
    pub closes: bool,
    /// The combination of displacements that is controlled.
    pub control: Combination,
    pub masses: Masses,
    /// Largest force of a link [N]. A torn strip balances to a part of it.
    pub strength: f64,
}

/// Displacements of the unknowns and the load.
#[derive(Debug, Clone, PartialEq)]
pub struct Balanced {
    pub displacement: Vec<f64>,
    /// [N]
    pub force: f64,
}

/// Response of all links to displacements.
pub struct Trial {
    pub deformation: Vec<Deformation>,
    pub damage: Vec<f64>,
    /// Gradient of the damage over the deformation of links whose damage grows.
    pub growing: Vec<Option<Deformation>>,
    /// Sum of the forces on each unknown, and the size of the forces that balance [N].
    pub forces: Vec<f64>,
    pub size: f64,
}

/// An equilibrium with the response of all links in it.
pub struct Found {
    pub balanced: Balanced,
    pub trial: Trial,
    pub iterations: usize,
}

/// Unbalanced part of the forces that is accepted.
const TOLERANCE: f64 = 1e-9;
/// Part of what is prescribed that is rounding.
const ROUNDING: f64 = 1e-12;
/// Parts of both that a state may miss when it is restored.
const CHECKED: f64 = 1e-6;
/// Iterations after which a step is too long.
const MOST_ITERATIONS: usize = 14;
/// Iterations of the relaxation of a jump.
const MOST_RELAXATIONS: usize = 3000;
/// Relaxations after which Newton's method is tried again.
const RELAXATIONS: usize = 6;
/// Relaxations after which growth is lengthened, and its factor: what moves has inertia, which carries damage on.
const SLOW: usize = 300;
const LENGTHENED: f64 = 1.6;
/// Updates of an unknown in an iteration.
pub const WORK: usize = 1000;
const ITERATIONS: &str = "iterations of an equilibrium";

impl Equilibrium {
    /// Parts of axial and flexural stiffness that remain of a link.
    pub fn remaining(&self, q: &Deformation, damage: f64) -> [f64; 2] {
        [if self.is_closed(q) { 1.0 } else { 1.0 - damage }, 1.0 - damage]
    }

    /// Returns true if a link bears pressure whatever its damage.
    pub fn is_closed(&self, q: &Deformation) -> bool {
        self.closes && q[0] < 0.0
    }

    /// Forces of a link, conjugate to its deformation.
    pub fn conjugate(&self, link: &Link, q: &Deformation, damage: f64) -> Deformation {
        let [axial, flexural] = self.remaining(q, damage);
        let forces = link.elastic(q);
        [axial * forces[0], flexural * forces[1], flexural * forces[2]]
    }

    /// Response to displacements, with the damage reached before.
    pub fn trial(&self, displacement: &[f64], reached: &[f64]) -> Trial {
        let mut trial = Trial {
            deformation: Vec::with_capacity(self.links.len()),
            damage: reached.to_vec(),
            growing: vec![None; self.links.len()],
            forces: vec![0.0; displacement.len()],
            size: 0.0,
        };
        for (l, link) in self.links.iter().enumerate() {
            let q = self.pattern.deformation(l, displacement);
            if link.breaks && reached[l] < 1.0 {
                let (stretch, gradient) = link.stretch(&q, self.bending);
                let (damage, slope) = link.softening.damage(stretch);
                if damage > reached[l] {
                    trial.damage[l] = damage;
                    trial.growing[l] = Some(gradient.map(|part| slope * part));
                }
            }
            let conjugate = self.conjugate(link, &q, trial.damage[l]);
            self.pattern.add_forces(l, &conjugate, &mut trial.forces);
            let [n, a, b] = [conjugate[0], conjugate[1] / link.length, conjugate[2] / link.length];
            trial.size += n * n + a * a + b * b;
            trial.deformation.push(q);
        }
        trial.size = trial.size.sqrt();
        trial
    }

    /// Finds displacements and load for a value of the control, from a start; `None` if the iteration fails.
    pub fn solve(
        &self,
        start: &Balanced,
        reached: &[f64],
        wanted: f64,
        allowance: &Allowance,
    ) -> Result<Option<Found>, LatticeError> {
        let mut now = start.clone();
        let mut tangent: Option<Tangent> = None;
        let moved = product(&self.control, &start.displacement).abs();
        for iterations in 0..=MOST_ITERATIONS {
            allowance.spend(1.0, ITERATIONS, WORK * now.displacement.len())?;
            let trial = self.trial(&now.displacement, reached);
            let residual = self.residual(&trial, now.force);
            let missing = wanted - product(&self.control, &now.displacement);
            let is_there = missing.abs() <= ROUNDING * (wanted.abs() + moved);
            if is_there && norm(&residual) <= TOLERANCE * self.scale(&trial) {
                return Ok(Some(Found { balanced: now, trial, iterations }));
            }
            if iterations == MOST_ITERATIONS || !norm(&residual).is_finite() {
                return Ok(None);
            }
            let own = match &mut tangent {
                Some(own) => own,
                None => tangent.insert(Tangent::new(self, &trial)?),
            };
            let Some(step) = own.step(&trial, &residual, missing)? else { return Ok(None) };
            for (own, change) in now.displacement.iter_mut().zip(&step.displacement) {
                *own += change;
            }
            now.force += step.force;
        }
        Ok(None)
    }

    /// Deformation of each link.
    pub fn deformations(&self, displacement: &[f64]) -> Vec<Deformation> {
        let links = 0..self.links.len();
        links.map(|l| self.pattern.deformation(l, displacement)).collect()
    }

    /// Refuses displacements and a load that do not balance at given damage, or miss what is prescribed.
    pub fn check(&self, now: &Balanced, reached: &[f64], wanted: f64) -> Result<(), String> {
        let trial = self.trial(&now.displacement, reached);
        let residual = norm(&self.residual(&trial, now.force));
        if residual > CHECKED * self.scale(&trial) {
            return Err(format!("{residual:.1e} N of {:.1e} N do not balance", trial.size));
        }
        let value = product(&self.control, &now.displacement);
        if (value - wanted).abs() > CHECKED * (wanted.abs() + norm(&now.displacement)) {
            return Err(format!("{value:e} m where {wanted:e} m are prescribed"));
        }
        let grown = trial.damage.iter().zip(reached).any(|(new, old)| new - old > CHECKED);
        if grown { Err("less damage than the stretch of a link causes".to_owned()) } else { Ok(()) }
    }

    /// Forces that unbalanced ones are compared with [N].
    pub fn scale(&self, trial: &Trial) -> f64 {
        trial.size.max(self.strength)
    }

    /// Bound on the energy that forces leave which balance to a part of their size [J]: that part of the energy of all
    /// links at their strength.
    pub fn rounding_of_energy(&self) -> f64 {
        let of_link = |link: &Link| link.axial * (link.softening.onset * link.length).powi(2);
        TOLERANCE * 0.5 * self.links.iter().map(of_link).sum::<f64>()
    }

    pub fn residual(&self, trial: &Trial, force: f64) -> Vec<f64> {
        let mut residual = trial.forces.clone();
        for &(at, part) in &self.pattern.frame.load {
            residual[at] -= force * part;
        }
        residual
    }

    /// Lets damage grow at a held value of the control until forces balance: a sudden break. Returns the energy that
    /// damage dissipates [J]. Damage grows in each iteration and is bounded, so the iteration ends.
    pub fn relax(
        &self,
        start: &Balanced,
        reached: &mut [f64],
        wanted: f64,
        allowance: &Allowance,
    ) -> Result<(Balanced, f64), LatticeError> {
        let mut now = start.clone();
        let mut dissipated = 0.0;
        let mut has_moved = false;
        for relaxation in 0..MOST_RELAXATIONS {
            allowance.spend(1.0, ITERATIONS, WORK * now.displacement.len())?;
            if relaxation % RELAXATIONS == RELAXATIONS - 1
                && let Some(found) = self.solve(&now, reached, wanted, allowance)?
            {
                let Found { balanced, trial, .. } = found;
                dissipated += self.broken(&trial.deformation, [reached, &trial.damage]);
                reached.copy_from_slice(&trial.damage);
                return Ok((balanced, dissipated));
            }
            let trial = self.trial(&now.displacement, reached);
            let residual = self.residual(&trial, now.force);
            let is_balanced = norm(&residual) <= TOLERANCE * self.scale(&trial) && has_moved;
            let lengthened = if relaxation < SLOW { 1.0 } else { LENGTHENED };
            let old = reached.to_vec();
            for (own, new) in reached.iter_mut().zip(&trial.damage) {
                *own = (*own + lengthened * (new - *own)).min(1.0);
            }
            dissipated += self.broken(&trial.deformation, [&old, reached]);
            if is_balanced {
                return Ok((now, dissipated));
            }
            now = self.unbroken(&now.displacement, reached, wanted)?;
            has_moved = true;
        }
        Err(LatticeError::NoEquilibrium { relaxations: MOST_RELAXATIONS })
    }

    /// The equilibrium at a value of the control with the damage that there is. Links that are closed at a displacement
    /// [m] stay closed, and others open.
    pub fn unbroken(
        &self,
        displacement: &[f64],
        damage: &[f64],
        wanted: f64,
    ) -> Result<Balanced, LatticeError> {
        let deformation = self.deformations(displacement);
        let remaining = |l: usize| self.remaining(&deformation[l], damage[l]);
        let factor = self.pattern.factor(&self.links, remaining)?;
        let mut unit = vec![0.0; displacement.len()];
        for &(at, part) in &self.pattern.frame.load {
            unit[at] += part;
        }
        factor.solve_in_place(&mut unit);
        let force = wanted / product(&self.control, &unit);
        Ok(Balanced { force, displacement: unit.iter().map(|part| force * part).collect() })
    }

    /// Energy that growing damage dissipates between two states [J], `½ Δω q₀·D q₁` of each link: with it the elastic
    /// energies and the work of the mean load balance exactly.
    pub fn dissipation(&self, q: [&[Deformation]; 2], damage: [&[f64]; 2]) -> f64 {
        let of_link = |(l, link): (usize, &Link)| {
            let growth = damage[1][l] - damage[0][l];
            if growth == 0.0 {
                return 0.0;
            }
            let mut forces = link.elastic(&q[0][l]);
            if self.closes && q[1][l][0] < 0.0 {
                forces[0] = 0.0;
            }
            0.5 * growth * forces.iter().zip(&q[1][l]).map(|(a, b)| a * b).sum::<f64>()
        };
        self.links.iter().enumerate().map(of_link).sum()
    }

    /// Energy that damage dissipates in a sudden break [J]: that of the law of each link between two values of its
    /// damage, however far the link has opened, in the proportion of stretch and bending that it has now.
    pub fn broken(&self, q: &[Deformation], [before, after]: [&[f64]; 2]) -> f64 {
        let of_link = |(l, link): (usize, &Link)| {
            let (stretch, _) = link.stretch(&q[l], self.bending);
            if after[l] <= before[l] || stretch <= 0.0 {
                return 0.0;
            }
            let mut forces = link.elastic(&q[l]);
            if self.closes && q[l][0] < 0.0 {
                forces[0] = 0.0;
            }
            let twice: f64 = forces.iter().zip(&q[l]).map(|(a, b)| a * b).sum();
            link.softening.dissipation([before[l], after[l]]) * twice / (stretch * stretch)
        };
        self.links.iter().enumerate().map(of_link).sum()
    }

    /// Elastic energy [J].
    pub fn elastic_energy(&self, q: &[Deformation], damage: &[f64]) -> f64 {
        let of_link = |((link, q), damage): ((&Link, &Deformation), &f64)| {
            let forces = self.conjugate(link, q, *damage);
            0.5 * forces.iter().zip(q).map(|(a, b)| a * b).sum::<f64>()
        };
        self.links.iter().zip(q).zip(damage).map(of_link).sum()
    }
}

/// Value of a combination.
pub fn product(combination: &Combination, of: &[f64]) -> f64 {
    combination.iter().map(|&(at, part)| part * of[at]).sum()
}

/// Euclidean norm.
pub fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
