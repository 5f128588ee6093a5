//! Equilibrium of displacements at given damage, by Newton's method.
//!
//! Each linear system is solved by conjugate gradients, preconditioned by the factor of an earlier stiffness: from one
//! system to the next few elements break, and each costs few iterations. Where they become many, the iteration stops,
//! the stiffness is factored anew, and a new iteration finds the rest. Factors are in single precision, which needs
//! half of the memory. The stiffness is that of the intact section, in which damaged elements are corrected.

use std::sync::OnceLock;

use super::DamageError;
use super::elements::{Elements, Nodal, Released};
use crate::math::cholesky::{Elimination, RoundedCholesky};
use crate::math::nested_dissection::nested_dissection;
use crate::math::nine_point::{Grid, NinePoint, Padded};
use crate::math::separable::dot;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// Largest number of Newton steps, of halvings of one, and of conjugate-gradient iterations.
const MOST_STEPS: usize = 40;
const MOST_HALVINGS: usize = 8;
const MOST_ITERATIONS: usize = 400;
/// Conjugate-gradient iterations that cost as much as a new factor.
const WORTH_A_FACTOR: usize = 8;
/// Reduction of the residual by the conjugate gradients of a Newton step.
const REDUCTION: f64 = 1e-2;
/// Part of the forces that may be left where Newton's method no longer reduces it.
const MOST_LEFT: f64 = 0.1;
/// Updates per unknown that a factorisation and an iteration take, for the allowance of a step.
const WORK_OF_FACTOR: f64 = 3000.0;
const WORK_OF_ITERATION: f64 = 100.0;

/// Places of the unknown displacements.
pub struct Unknowns {
    grid: Grid,
    /// True where a displacement is prescribed, both components of a node together.
    pub held: Vec<bool>,
    /// Number of each unknown; `usize::MAX` where it is held.
    number: Vec<usize>,
    /// Order of elimination, and the pattern of all factors, once known.
    order: Vec<usize>,
    elimination: OnceLock<Elimination>,
    count: usize,
}

impl Unknowns {
    pub fn new(grid: Grid, held: Vec<bool>) -> Self {
        let mut count = 0;
        let mut number = vec![usize::MAX; held.len()];
        for (number, _) in number.iter_mut().zip(&held).filter(|(_, held)| !**held) {
            *number = count;
            count += 1;
        }
        let [x, z] = grid.elements();
        let order = nested_dissection([x, 0, z], 1)
            .into_iter()
            .flat_map(|node| [2 * node, 2 * node + 1])
            .filter(|&unknown| !held[unknown])
            .map(|unknown| number[unknown])
            .collect();
        Self { grid, held, number, order, elimination: OnceLock::new(), count }
    }
}

/// Solver of the displacements of a step: its stiffness and the factor of an earlier one.
pub struct Balance<'a> {
    pub elements: &'a Elements,
    pub unknowns: &'a Unknowns,
    pub team: &'a Team,
    pub allowance: &'a Allowance,
    stiffness: NinePoint<2>,
    /// Stiffness without damage.
    intact: NinePoint<2>,
    factor: Option<RoundedCholesky>,
    /// Size of loads and of prevented thermal expansion [N], once known, and that of reactions.
    acting: Option<f64>,
    reactions: f64,
    pub factorings: usize,
    pub iterations: usize,
}

impl<'a> Balance<'a> {
    pub fn new(
        elements: &'a Elements,
        unknowns: &'a Unknowns,
        team: &'a Team,
        allowance: &'a Allowance,
    ) -> Self {
        let stiffness = NinePoint::zeros(unknowns.grid);
        Self {
            elements,
            unknowns,
            team,
            allowance,
            stiffness,
            intact: elements.intact_stiffness(team),
            factor: None,
            acting: None,
            reactions: 0.0,
            factorings: 0,
            iterations: 0,
        }
    }

    /// Moves displacements to the equilibrium with a load [N], until its residual is below a part of the forces;
    /// displacements that are held stay. Returns the energy that cracks release.
    pub fn settle(
        &mut self,
        displacement: &mut [f64],
        (damage, rise): (&[f64], &[f64]),
        load: &[f64],
        tolerance: f64,
    ) -> Result<Released, DamageError> {
        let mut residual = vec![0.0; displacement.len()];
        let mut released = self.evaluate(displacement, (damage, rise), load, &mut residual, true);
        for step in 0..MOST_STEPS {
            let size = dot(&residual, &residual).sqrt();
            if size <= tolerance * self.scale(rise, load) {
                return Ok(released);
            }
            if step > 0 {
                self.evaluate(displacement, (damage, rise), load, &mut residual, true);
            }
            let change = self.change(&residual)?;
            let slope = dot(&residual, &change);
            let before = displacement.to_vec();
            let mut part = 1.0;
            for _ in 0..MOST_HALVINGS {
                for ((u, before), change) in displacement.iter_mut().zip(&before).zip(&change) {
                    *u = before + part * change;
                }
                released = self.evaluate(displacement, (damage, rise), load, &mut residual, false);
                // The energy is convex: a step is too long where it has passed the minimum by far.
                if dot(&residual, &change) >= -0.5 * slope {
                    break;
                }
                part *= 0.5;
            }
        }
        let left = dot(&residual, &residual).sqrt() / self.scale(rise, load);
        match left <= MOST_LEFT {
            true => Ok(released),
            false => Err(DamageError::NoEquilibrium { residual: left, tolerance: MOST_LEFT }),
        }
    }

    /// Computes residual forces [N], and assembles the stiffness on request.
    fn evaluate(
        &mut self,
        displacement: &[f64],
        (damage, rise): (&[f64], &[f64]),
        load: &[f64],
        residual: &mut [f64],
        with_stiffness: bool,
    ) -> Released {
        let nodal = Nodal { displacement, damage, rise };
        let stiffness = with_stiffness.then(|| {
            self.stiffness.copy_from(&self.intact);
            &mut self.stiffness
        });
        let (forces, released) = self.elements.forces(&nodal, stiffness, self.team);
        let mut reactions = 0.0;
        for (n, residual) in residual.iter_mut().enumerate() {
            *residual = match self.unknowns.held[n] {
                true => {
                    reactions += forces[n] * forces[n];
                    0.0
                }
                false => load[n] - forces[n],
            };
        }
        // Before a solution, prescribed displacements strain the next elements alone.
        if self.iterations > 0 {
            self.reactions = self.reactions.max(reactions.sqrt());
        }
        released
    }

    /// Size of the forces that balance [N]: of loads, prevented thermal expansion, and the largest reactions since the
    /// first solution.
    fn scale(&mut self, rise: &[f64], load: &[f64]) -> f64 {
        let own = *self.acting.get_or_insert_with(|| {
            let (zero, intact) = (vec![0.0; load.len()], vec![0.0; rise.len()]);
            let nodal = Nodal { displacement: &zero, damage: &intact, rise };
            let (thermal, _) = self.elements.forces(&nodal, None, self.team);
            (dot(load, load) + dot(&thermal, &thermal)).sqrt()
        });
        (own * own + self.reactions * self.reactions).sqrt().max(f64::MIN_POSITIVE)
    }

    /// Change of displacements under a change of force.
    fn change(&mut self, force: &[f64]) -> Result<Vec<f64>, DamageError> {
        if self.factor.is_none() {
            self.refactor()?;
        }
        let (mut change, left) = self.iterate(force, WORTH_A_FACTOR)?;
        if let Some(left) = left {
            self.refactor()?;
            let (rest, _) = self.iterate(&left, MOST_ITERATIONS)?;
            change.iter_mut().zip(&rest).for_each(|(change, rest)| *change += rest);
        }
        Ok(change)
    }

    fn refactor(&mut self) -> Result<(), DamageError> {
        self.factorings += 1;
        self.allowance.spend(WORK_OF_FACTOR, "factorisations", self.unknowns.count)?;
        let lower = self.stiffness.lower_triangle(&self.unknowns.number);
        let threads = self.team.threads();
        // The old factor goes before the new one comes.
        self.factor = None;
        let known = &self.unknowns.elimination;
        let elimination = match known.get() {
            Some(elimination) => elimination,
            None => {
                let new = Elimination::new(&lower, &self.unknowns.order)?;
                known.get_or_init(|| new)
            }
        };
        self.factor = Some(elimination.factor(&lower, threads)?.rounded());
        Ok(())
    }

    /// Preconditioned conjugate gradients from zero. Returns the residual, too, if it is too large after the most
    /// iterations.
    fn iterate(
        &mut self,
        force: &[f64],
        most: usize,
    ) -> Result<(Vec<f64>, Option<Vec<f64>>), DamageError> {
        let unknowns = self.unknowns;
        let mut residual = force.to_vec();
        let mut solution = vec![0.0; force.len()];
        let mut improved = self.precondition(&residual);
        let mut direction = Padded::<2>::zeros(unknowns.grid);
        direction.inner_mut().copy_from_slice(&improved);
        let mut energy = dot(&residual, &improved);
        let wanted = REDUCTION * REDUCTION * energy;
        let mut product = vec![0.0; force.len()];
        for _ in 0..most {
            if energy <= wanted || energy <= 0.0 {
                return Ok((solution, None));
            }
            self.iterations += 1;
            self.allowance.spend(WORK_OF_ITERATION, "iterations of equilibrium", unknowns.count)?;
            self.stiffness.product(&direction, &unknowns.held, &mut product, self.team);
            let length = energy / dot(direction.inner(), &product);
            for (k, along) in direction.inner().iter().enumerate() {
                solution[k] += length * along;
                residual[k] -= length * product[k];
            }
            improved = self.precondition(&residual);
            let next = dot(&residual, &improved);
            let part = next / energy;
            direction.inner_mut().iter_mut().zip(&improved).for_each(|(d, z)| *d = z + part * *d);
            energy = next;
        }
        let is_large = energy > wanted;
        Ok((solution, is_large.then_some(residual)))
    }

    fn precondition(&self, residual: &[f64]) -> Vec<f64> {
        let factor = self.factor.as_ref().expect("it is made before the iteration");
        let free = || self.unknowns.number.iter().enumerate().filter(|(_, n)| **n != usize::MAX);
        let mut values: Vec<f64> = free().map(|(unknown, _)| residual[unknown]).collect();
        factor.solve_in_place(&mut values);
        let mut out = vec![0.0; residual.len()];
        free().zip(values).for_each(|((unknown, _), value)| out[unknown] = value);
        out
    }
}
