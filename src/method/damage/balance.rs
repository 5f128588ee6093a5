//! Equilibrium of displacements at given damage, by Newton's method.
//!
//! Each linear system is solved by conjugate gradients, preconditioned by the factor of an earlier stiffness: from one
//! system to the next few elements break, and each costs few iterations. Where they become many, the iteration stops,
//! the stiffness is factored anew, and a new iteration finds the rest. Factors are in single precision, which needs
//! half of the memory. The stiffness is that of the intact domain, in which damaged elements are corrected.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::DamageError;
use super::damaged::Damaged;
use super::domain::{Kinematics, Point};
use super::elements::{Elements, Nodal, Released};
use super::patch::{Extent, Patch, System};
use crate::math::cholesky::{Elimination, LowerTriangle, RoundedCholesky, SolverError};
use crate::math::grid_matrix::{Grid, GridMatrix, Padded};
use crate::math::nested_dissection::nested_dissection;
use crate::math::separable::dot;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// Largest number of Newton steps, of halvings of one, and of conjugate-gradient iterations.
const MOST_STEPS: usize = 40;
const MOST_HALVINGS: usize = 8;
const MOST_ITERATIONS: usize = 400;
/// Conjugate-gradient iterations that cost as much as a new factor, at least, and columns' entries for each of them.
const WORTH_A_FACTOR: usize = 8;
const ENTRIES_PER_ITERATION: usize = 16;
/// Reduction of the residual by the conjugate gradients of a Newton step, and part of the wanted residual at which they
/// end, too.
const REDUCTION: f64 = 1e-2;
const ENOUGH: f64 = 0.3;
/// Part of the forces that may be left, while damage still changes, where Newton's method no longer reduces it.
const MOST_LEFT: f64 = 0.1;
/// Updates per unknown that a factorisation takes at least, and for each squared entry of a column of the factor, and
/// those that an iteration takes, for the allowance of a step.
const WORK_OF_FACTOR: f64 = 3000.0;
const WORK_OF_COLUMN: f64 = 0.02;
const WORK_OF_ITERATION: f64 = 100.0;

/// Places of the unknown displacements.
pub struct Unknowns<const D: usize> {
    grid: Grid<D>,
    /// True where a displacement is prescribed, all components of a node together.
    pub held: Vec<bool>,
    none_held: Vec<bool>,
    /// Number of each unknown; `usize::MAX` where it is held. Place of each among all components.
    number: Vec<usize>,
    places: Vec<usize>,
    /// Order of elimination, and the pattern of all factors, once known.
    order: Vec<usize>,
    elimination: OnceLock<Elimination>,
    /// Factor of the intact stiffness, from its first use to the first damage.
    intact: Mutex<Option<Arc<RoundedCholesky>>>,
}

impl<const D: usize> Unknowns<D> {
    pub fn new(grid: Grid<D>, held: Vec<bool>) -> Self {
        let mut number = vec![usize::MAX; held.len()];
        let places: Vec<usize> = (0..held.len()).filter(|&place| !held[place]).collect();
        places.iter().enumerate().for_each(|(n, &place)| number[place] = n);
        let mut elements = [0; 3];
        elements[..D].copy_from_slice(&grid.elements());
        let order = nested_dissection(elements, 1)
            .into_iter()
            .flat_map(|node| D * node..D * (node + 1))
            .filter(|&unknown| !held[unknown])
            .map(|unknown| number[unknown])
            .collect();
        let none_held = vec![false; held.len()];
        let (elimination, intact) = (OnceLock::new(), Mutex::new(None));
        Self { grid, held, none_held, number, places, order, elimination, intact }
    }

    /// Unknowns of some nodes: their places among all components, their numbers by place (`usize::MAX` for others),
    /// and their order of elimination.
    pub fn within(&self, inside: &[bool]) -> (Vec<usize>, Vec<usize>, Vec<usize>) {
        let mut number = vec![usize::MAX; self.number.len()];
        // Numbers of the unknowns by those among all.
        let mut own = vec![usize::MAX; self.places.len()];
        let mut places = Vec::new();
        let is_inside = |place: &usize| inside[place / D] && !self.held[*place];
        for place in (0..number.len()).filter(is_inside) {
            number[place] = places.len();
            own[self.number[place]] = places.len();
            places.push(place);
        }
        let order = self.order.iter().map(|&n| own[n]).filter(|&n| n != usize::MAX).collect();
        (places, number, order)
    }
}

/// Solver of the displacements of a step: its stiffness and the factor of an earlier one.
pub struct Balance<'a, const D: usize, const C: usize, const V: usize> {
    pub elements: &'a Elements<D, C, V>,
    pub unknowns: &'a Unknowns<D>,
    pub team: &'a Team,
    pub allowance: &'a Allowance,
    stiffness: GridMatrix<D, D>,
    /// Stiffness without damage, and the forces of temperatures there [N], once known.
    intact: &'a GridMatrix<D, D>,
    thermal: Option<Vec<f64>>,
    /// Elements whose stiffness differs from the intact one.
    damaged: Damaged<D>,
    factor: Option<Arc<RoundedCholesky>>,
    /// Diagonal of the stiffness of that factor, and where the present stiffness differs from it.
    factored: Vec<[f64; D]>,
    patch: Option<Patch<D>>,
    /// Size of loads and of prevented thermal expansion [N], once known, and that of reactions.
    acting: Option<f64>,
    reactions: f64,
    pub factorings: usize,
    pub iterations: usize,
}

/// Displacements in equilibrium release this energy and leave these forces.
pub struct Settled<const C: usize> {
    /// Energy that cracks release.
    pub released: Released<C>,
    /// Part of the forces that is left, at most.
    pub left: f64,
}

impl<'a, const D: usize, const C: usize, const V: usize> Balance<'a, D, C, V>
where
    Point<D, C>: Kinematics<D, C, V>,
{
    pub fn new(
        (elements, intact, unknowns): (
            &'a Elements<D, C, V>,
            &'a GridMatrix<D, D>,
            &'a Unknowns<D>,
        ),
        team: &'a Team,
        allowance: &'a Allowance,
    ) -> Self {
        let mut stiffness = GridMatrix::zeros(unknowns.grid);
        stiffness.copy_from(intact);
        Self {
            elements,
            unknowns,
            team,
            allowance,
            stiffness,
            intact,
            thermal: None,
            damaged: Damaged::none(),
            factor: None,
            factored: Vec::new(),
            patch: None,
            acting: None,
            reactions: 0.0,
            factorings: 0,
            iterations: 0,
        }
    }

    /// Moves displacements to the equilibrium with a load [N], until its residual is below a part of the forces;
    /// displacements that are held stay.
    pub fn settle(
        &mut self,
        displacement: &mut [f64],
        (damage, rise): (&[f64], &[f64]),
        load: &[f64],
        tolerance: f64,
    ) -> Result<Settled<C>, DamageError> {
        self.damaged.restore(self.elements, &mut self.stiffness, self.intact);
        self.damaged = Damaged::of(self.elements, damage);
        let released = |elements: &Elements<D, C, V>, displacement: &[f64], team: &Team| {
            elements.released(&Nodal { displacement, damage, rise }, team)
        };
        let mut residual = vec![0.0; displacement.len()];
        self.evaluate(displacement, (damage, rise), load, &mut residual);
        for _ in 0..MOST_STEPS {
            let size = dot(&residual, &residual).sqrt();
            if size <= tolerance * self.scale(rise, load) {
                let released = released(self.elements, displacement, self.team);
                return Ok(Settled { released, left: tolerance });
            }
            self.assemble(&Nodal { displacement, damage, rise });
            let goal = (REDUCTION * size).max(ENOUGH * tolerance * self.scale(rise, load));
            let change = self.change(&residual, goal)?;
            let slope = dot(&residual, &change);
            let before = displacement.to_vec();
            let mut part = 1.0;
            for _ in 0..MOST_HALVINGS {
                for ((u, before), change) in displacement.iter_mut().zip(&before).zip(&change) {
                    *u = before + part * change;
                }
                self.evaluate(displacement, (damage, rise), load, &mut residual);
                // The energy is convex: a step is too long where it has passed the minimum by far.
                if dot(&residual, &change) >= -0.5 * slope {
                    break;
                }
                part *= 0.5;
            }
        }
        let left = dot(&residual, &residual).sqrt() / self.scale(rise, load);
        match left <= MOST_LEFT {
            true => {
                Ok(Settled { released: released(self.elements, displacement, self.team), left })
            }
            false => Err(DamageError::NoEquilibrium { residual: left, tolerance: MOST_LEFT }),
        }
    }

    /// Assembles the stiffness.
    fn assemble(&mut self, nodal: &Nodal) {
        self.damaged.restore(self.elements, &mut self.stiffness, self.intact);
        self.damaged.correct_stiffness(self.elements, nodal, &mut self.stiffness, self.team);
    }

    /// Computes residual forces [N].
    fn evaluate(
        &mut self,
        displacement: &[f64],
        (damage, rise): (&[f64], &[f64]),
        load: &[f64],
        residual: &mut [f64],
    ) {
        let nodal = Nodal { displacement, damage, rise };
        let forces = self.forces(&nodal);
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
    }

    /// Forces of the stresses on all nodes [N].
    fn forces(&mut self, nodal: &Nodal) -> Vec<f64> {
        let mut displacement = Padded::<D>::zeros(self.unknowns.grid);
        displacement.inner_mut().copy_from_slice(nodal.displacement);
        let mut forces = vec![0.0; nodal.displacement.len()];
        self.intact.product(&displacement, &self.unknowns.none_held, &mut forces, self.team);
        let thermal = self.thermal(nodal.rise);
        forces.iter_mut().zip(thermal).for_each(|(force, thermal)| *force += thermal);
        self.damaged.correct_forces(self.elements, nodal, &mut forces, self.team);
        forces
    }

    /// Forces that the temperatures of the step cause in the intact domain at rest [N].
    fn thermal(&mut self, rise: &[f64]) -> &[f64] {
        let (elements, team) = (self.elements, self.team);
        self.thermal.get_or_insert_with(|| {
            let (zero, intact) = (vec![0.0; D * rise.len()], vec![0.0; rise.len()]);
            elements.forces(&Nodal { displacement: &zero, damage: &intact, rise }, team)
        })
    }

    /// Size of the forces that balance [N]: of loads, prevented thermal expansion, and the largest reactions since the
    /// first solution.
    fn scale(&mut self, rise: &[f64], load: &[f64]) -> f64 {
        let own = match self.acting {
            Some(own) => own,
            None => {
                let thermal = self.thermal(rise);
                (dot(load, load) + dot(thermal, thermal)).sqrt()
            }
        };
        self.acting = Some(own);
        (own * own + self.reactions * self.reactions).sqrt().max(f64::MIN_POSITIVE)
    }

    /// Change of displacements under a change of force, of which at most `goal` is left.
    fn change(&mut self, force: &[f64], goal: f64) -> Result<Vec<f64>, DamageError> {
        match self.factor.is_some() {
            true => self.correct()?,
            false => self.refactor()?,
        }
        let worth = WORTH_A_FACTOR.max(self.entries_of_column()? / ENTRIES_PER_ITERATION);
        let (mut change, left) = self.iterate(force, goal, worth)?;
        if let Some(left) = left {
            self.refactor()?;
            let (rest, _) = self.iterate(&left, goal, MOST_ITERATIONS)?;
            change.iter_mut().zip(&rest).for_each(|(change, rest)| *change += rest);
        }
        Ok(change)
    }

    /// Corrects the factor where the stiffness has changed since.
    fn correct(&mut self) -> Result<(), DamageError> {
        let last = self.patch.take();
        let threads = self.team.threads();
        match Patch::between(&self.stiffness, &self.factored, self.unknowns, threads, last)? {
            Extent::Nothing => (),
            Extent::Patch(patch) => self.patch = Some(patch),
            Extent::TooMuch => self.refactor()?,
        }
        Ok(())
    }

    fn refactor(&mut self) -> Result<(), DamageError> {
        self.factorings += 1;
        // The work of a step must not depend on what steps before have left.
        let unknowns = self.unknowns.places.len();
        let elimination = self.elimination()?;
        let column = self.entries_of_column()? as f64;
        let work = WORK_OF_FACTOR.max(WORK_OF_COLUMN * column * column);
        self.allowance.spend(work, "factorisations", unknowns)?;
        // The old factor goes before the new one comes.
        (self.factor, self.patch) = (None, None);
        let nodes = 0..self.unknowns.grid.nodes();
        self.factored = nodes.map(|node| self.stiffness.diagonal(node)).collect();
        let is_intact = self.damaged.is_empty();
        let known = self.known_factor().take().filter(|_| is_intact);
        let factor = match known {
            Some(known) => known,
            None => {
                Arc::new(elimination.factor(&self.lower(), self.team.threads())?.rounded(self.team))
            }
        };
        if is_intact {
            *self.known_factor() = Some(Arc::clone(&factor));
        }
        self.factor = Some(factor);
        Ok(())
    }

    fn known_factor(&self) -> MutexGuard<'_, Option<Arc<RoundedCholesky>>> {
        self.unknowns.intact.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lower triangle of the stiffness of the unknowns.
    fn lower(&self) -> LowerTriangle {
        self.stiffness.lower_triangle(&self.unknowns.number)
    }

    /// Mean number of entries of a column of a factor.
    fn entries_of_column(&self) -> Result<usize, SolverError> {
        Ok(self.elimination()?.entries() / self.unknowns.places.len().max(1))
    }

    /// The pattern of all factors.
    fn elimination(&self) -> Result<&'a Elimination, SolverError> {
        let known = &self.unknowns.elimination;
        match known.get() {
            Some(elimination) => Ok(elimination),
            None => {
                let new = Elimination::new(&self.lower(), &self.unknowns.order)?;
                Ok(known.get_or_init(|| new))
            }
        }
    }

    /// Preconditioned conjugate gradients from zero, until the residual is at most `goal`. Returns the residual, too,
    /// if it is larger after the most iterations.
    fn iterate(
        &mut self,
        force: &[f64],
        goal: f64,
        most: usize,
    ) -> Result<(Vec<f64>, Option<Vec<f64>>), DamageError> {
        let unknowns = self.unknowns;
        let mut residual = force.to_vec();
        let mut solution = vec![0.0; force.len()];
        let mut improved = self.improve(&residual);
        let mut direction = Padded::<D>::zeros(unknowns.grid);
        direction.inner_mut().copy_from_slice(&improved);
        let mut energy = dot(&residual, &improved);
        let mut product = vec![0.0; force.len()];
        for _ in 0..most {
            if energy <= 0.0 {
                return Ok((solution, None));
            }
            self.iterations += 1;
            self.allowance.spend(
                WORK_OF_ITERATION,
                "iterations of equilibrium",
                unknowns.places.len(),
            )?;
            self.stiffness.product(&direction, &unknowns.held, &mut product, self.team);
            let length = energy / dot(direction.inner(), &product);
            for (k, along) in direction.inner().iter().enumerate() {
                solution[k] += length * along;
                residual[k] -= length * product[k];
            }
            if dot(&residual, &residual) <= goal * goal {
                return Ok((solution, None));
            }
            improved = self.improve(&residual);
            let next = dot(&residual, &improved);
            let part = next / energy;
            direction.inner_mut().iter_mut().zip(&improved).for_each(|(d, z)| *d = z + part * *d);
            energy = next;
        }
        Ok((solution, Some(residual)))
    }

    /// Displacements that a force brings about, nearly.
    fn improve(&self, force: &[f64]) -> Vec<f64> {
        let Some(patch) = &self.patch else { return self.precondition(force) };
        let system =
            System { stiffness: &self.stiffness, held: &self.unknowns.held, team: self.team };
        let mut displacement = Padded::zeros(self.unknowns.grid);
        patch.solve(force, &mut displacement);
        let mut left = force.to_vec();
        patch.balance_around(&mut left, &displacement, &system);
        let rest = self.precondition(&left);
        displacement.inner_mut().iter_mut().zip(&rest).for_each(|(own, rest)| *own += rest);
        let mut left = force.to_vec();
        patch.balance_inside(&mut left, &displacement, &system);
        patch.solve(&left, &mut displacement);
        displacement.inner().to_vec()
    }

    fn precondition(&self, residual: &[f64]) -> Vec<f64> {
        let factor = self.factor.as_ref().expect("it is made before the iteration");
        let places = &self.unknowns.places;
        let mut values: Vec<f64> = places.iter().map(|&place| residual[place]).collect();
        factor.solve_in_place(&mut values, self.team);
        let mut out = vec![0.0; residual.len()];
        places.iter().zip(values).for_each(|(&place, value)| out[place] = value);
        out
    }
}
