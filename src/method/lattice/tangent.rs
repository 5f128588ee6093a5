//! Linear systems of Newton's method: one factored stiffness, and the links that changed since.

use nalgebra::{DMatrix, DVector};

use super::equilibrium::{Balanced, Equilibrium, Trial, product};
use super::link::Deformation;
use super::stiffness::REMAINDER;
use crate::math::cholesky::{SolverError, SparseCholesky};

/// Largest number of links that may differ from the factored stiffness.
const MOST_CHANGED: usize = 100;

/// The stiffness at the beginning of a step, factored, with its responses to forces on the links that change.
///
/// The tangent differs from it by a matrix of three rows and columns for each link whose damage grows, whatever its
/// symmetry (M. A. Woodbury 1950), so only symmetric positive definite matrices are factored, and few of them.
pub struct Tangent<'a> {
    of: &'a Equilibrium,
    factor: SparseCholesky,
    /// Parts of the stiffness of each link that are factored.
    factored: Vec<[f64; 2]>,
    /// Response to the unit load.
    by_load: Vec<f64>,
    changed: Vec<usize>,
    /// Responses to unit forces on the changed links, three a link.
    responses: Vec<f64>,
}

impl<'a> Tangent<'a> {
    /// Factors the stiffness of a response.
    pub fn new(of: &'a Equilibrium, trial: &Trial) -> Result<Self, SolverError> {
        let factored: Vec<_> = (0..of.links.len()).map(|l| parts(of, trial, l)).collect();
        let factor = of.pattern.factor(&of.links, |l| factored[l])?;
        let mut by_load = vec![0.0; trial.forces.len()];
        for &(at, part) in &of.pattern.frame.load {
            by_load[at] += part;
        }
        factor.solve_in_place(&mut by_load);
        Ok(Self { of, factor, factored, by_load, changed: Vec::new(), responses: Vec::new() })
    }

    /// The step that removes a residual and what is missing of the control; `None` if too much changes.
    pub fn step(
        &mut self,
        trial: &Trial,
        residual: &[f64],
        missing: f64,
    ) -> Result<Option<Balanced>, SolverError> {
        if !self.note_changes(trial) {
            *self = Self::new(self.of, trial)?;
            if !self.note_changes(trial) {
                return Ok(None);
            }
        }
        let mut by_rest = residual.to_vec();
        self.factor.solve_in_place(&mut by_rest);
        let mut by_load = self.by_load.clone();
        if !self.correct(trial, [&mut by_load, &mut by_rest]) {
            return Ok(None);
        }
        let control = &self.of.control;
        let force = (missing + product(control, &by_rest)) / product(control, &by_load);
        let displacement = by_load.iter().zip(&by_rest).map(|(load, rest)| force * load - rest);
        Ok(Some(Balanced { displacement: displacement.collect(), force }))
    }

    /// Solves for the links that have changed since the stiffness was factored; false if there are too many.
    fn note_changes(&mut self, trial: &Trial) -> bool {
        let has_changed = |&l: &usize| {
            let is_new = !self.changed.contains(&l);
            is_new && (trial.growing[l].is_some() || parts(self.of, trial, l) != self.factored[l])
        };
        let new: Vec<usize> = (0..self.of.links.len()).filter(has_changed).collect();
        if self.changed.len() + new.len() > MOST_CHANGED {
            return false;
        }
        let unknowns = self.by_load.len();
        let mut columns = vec![0.0; 3 * new.len() * unknowns];
        for (k, column) in columns.chunks_exact_mut(unknowns).enumerate() {
            let mut unit = [0.0; 3];
            unit[k % 3] = 1.0;
            self.of.pattern.add_forces(new[k / 3], &unit, column);
        }
        if !columns.is_empty() {
            self.factor.solve_in_place(&mut columns);
        }
        self.responses.extend(columns);
        self.changed.extend(new);
        true
    }

    /// Turns solutions of the factored stiffness into those of the tangent; false if that is singular.
    fn correct(&self, trial: &Trial, solutions: [&mut Vec<f64>; 2]) -> bool {
        let count = 3 * self.changed.len();
        if count == 0 {
            return true;
        }
        let unknowns = self.by_load.len();
        let change: Vec<[Deformation; 3]> =
            self.changed.iter().map(|&l| self.change(trial, l)).collect();
        // The deformations of all changed links by forces on each of them.
        let deformations = |of: &[f64]| {
            let links = self.changed.iter();
            links.flat_map(|&l| self.of.pattern.deformation(l, of)).collect::<Vec<f64>>()
        };
        let released = |q: &[f64]| {
            let of_link = |(change, q): (&[Deformation; 3], &[f64])| {
                change.map(|row| row.iter().zip(q).map(|(a, b)| a * b).sum::<f64>())
            };
            change.iter().zip(q.chunks_exact(3)).flat_map(of_link).collect::<Vec<f64>>()
        };
        let mut system = DMatrix::identity(count, count);
        for (j, response) in self.responses.chunks_exact(unknowns).enumerate() {
            for (i, value) in released(&deformations(response)).into_iter().enumerate() {
                system[(i, j)] += value;
            }
        }
        let system = system.lu();
        for solution in solutions {
            let right = DVector::from_vec(released(&deformations(solution)));
            let Some(forces) = system.solve(&right) else { return false };
            for (response, force) in self.responses.chunks_exact(unknowns).zip(&forces) {
                solution.iter_mut().zip(response).for_each(|(own, part)| *own -= force * part);
            }
        }
        true
    }

    /// Difference of a link's tangent from its factored stiffness.
    fn change(&self, trial: &Trial, l: usize) -> [Deformation; 3] {
        let link = &self.of.links[l];
        let now = parts(self.of, trial, l);
        let [axial, flexural] = [0, 1].map(|k| now[k] - self.factored[l][k]);
        let columns = [0, 1, 2].map(|k| {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            let forces = link.elastic(&unit);
            [axial * forces[0], flexural * forces[1], flexural * forces[2]]
        });
        let mut change = [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row]));
        if let Some(gradient) = &trial.growing[l] {
            let q = &trial.deformation[l];
            let mut lost = link.elastic(q);
            if self.of.is_closed(q) {
                lost[0] = 0.0;
            }
            for (row, lost) in change.iter_mut().zip(lost) {
                row.iter_mut().zip(gradient).for_each(|(entry, part)| *entry -= lost * part);
            }
        }
        change
    }
}

/// Parts of a link's stiffness that remain in systems that are solved.
fn parts(of: &Equilibrium, trial: &Trial, l: usize) -> [f64; 2] {
    of.remaining(&trial.deformation[l], trial.damage[l]).map(|part| part.max(REMAINDER))
}
