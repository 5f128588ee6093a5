//! Influence rows of linear readings of a deformed body: one row instead of a solution for each state.
//!
//! Displacements obey `K u = C T + f` with the stiffness K, which is symmetric, the thermal forces `C T` of nodal
//! temperatures and the nodal forces f on bottom and top. A reading is `q = gᵀu + hᵀT + tᵀf`. With `K λ = g`
//! it is `q = (h + Cᵀλ)ᵀ T + (t + λ)ᵀ f`, whatever T and f are: the adjoint method (e.g. M. B. Giles and
//! N. A. Pierce 2000, doi 10.1023/A:1011430410075). One solution serves all states.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{ElasticProblem, SOLUTION, Solver};
use crate::laws::Thermoelastic;
use crate::math::cholesky::SolverError;
use crate::math::conjugate_gradients::NotConverged;
use crate::method::fem::brick_solver::{self, BrickSolver};
use crate::method::fem::solver_choice::solver_memory;
use crate::method::mesh::Mesh;
use crate::runtime::address_space;
use crate::runtime::thread::aside;

/// A component of displacement or stress in the axes of the mesh: of displacement along x, y, z (in a section along r
/// and z), of stress xx, yy, zz, xy, yz, xz (rr, tt, zz, –, –, rz).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Component {
    Displacement(usize),
    Stress(usize),
}

/// A component at a place of the mesh or at an image of it, times a weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    pub component: Component,
    /// [m]
    pub place: [f64; 3],
    pub image: [bool; 2],
    pub weight: f64,
}

/// A linear reading: a sum of components at places.
#[derive(Debug, Clone, PartialEq)]
pub struct Functional {
    pub terms: Vec<Term>,
}

/// Derivatives of a reading of one symmetry class.
pub struct Gradient {
    /// By nodal displacements, components of a node together.
    pub displacement: Vec<f64>,
    /// By nodal temperatures at held displacements; nodes on interfaces are there twice.
    pub temperature: Vec<f64>,
    /// By nodal forces on the bottom and the top at held displacements, a list for each component.
    pub forces: FaceRows,
}

/// Derivatives by nodal forces on the bottom and the top [1/N times the reading], a list for each displacement
/// component.
pub type FaceRows = [Vec<Vec<f64>>; 2];

/// Derivatives of a reading of one symmetry class by all that acts on it.
#[derive(Debug, Clone)]
pub struct NodalRow {
    /// By nodal temperatures above that without stress [per K]; nodes on interfaces are there twice.
    pub temperature: Arc<Vec<f64>>,
    pub forces: Arc<FaceRows>,
}

/// Residual relative to an adjoint load in the energy norm. The error of a reading is `gᵀK⁻¹` times the residual of a
/// solution, or that of the row times `u`. By Cauchy's inequality both are within `√(gᵀK⁻¹g) √(uᵀKu)` times their
/// tolerances. A row serves all states, including those where the contributions to its readings cancel. It is therefore
/// solved to two digits more than solutions, which takes a tenth more iterations.
const TOLERANCE: f64 = 1e-14;

/// Memory that rows of one body may take if it exceeds that of the body's solver [B].
const SMALL: f64 = 2.56e8;

/// Largest memory of all rows of a body together [B].
pub fn most_memory_of_rows(mesh: &Mesh, laws: &[Thermoelastic]) -> f64 {
    SMALL.max(solver_memory(mesh, laws))
}

/// Memory of a row of one symmetry class, nodal and modal [B].
pub fn memory_of_row(mesh: &Mesh) -> f64 {
    let plane = mesh.axes[0].len() * mesh.axes[1].len();
    8.0 * (2.0 * mesh.sided_nodes() as f64 + (2 * mesh.geometry.degrees() * plane) as f64)
}

/// Rows solved so far; bodies that differ only in thermal data share them. The oldest are dropped first.
#[derive(Default)]
pub struct KeptRows {
    list: VecDeque<(Functional, usize, NodalRow)>,
    bytes: f64,
}

impl NodalRow {
    fn bytes(&self) -> f64 {
        let faces = self.forces.iter().flatten().map(Vec::len).sum::<usize>();
        8.0 * (self.temperature.len() + faces) as f64
    }
}

impl Gradient {
    pub fn zeros(mesh: &Mesh) -> Self {
        let degrees = mesh.geometry.degrees();
        let plane = mesh.axes[0].len() * mesh.axes[1].len();
        Self {
            displacement: vec![0.0; mesh.nodes() * degrees],
            temperature: vec![0.0; mesh.sided_nodes()],
            forces: [(); 2].map(|()| vec![vec![0.0; plane]; degrees]),
        }
    }
}

impl ElasticProblem {
    /// Returns the row of a reading of one symmetry class; `gradient` is called unless the row is known. It is solved
    /// for on another thread, because it needs more stack than a host's thread has to provide.
    pub fn row(
        &self,
        functional: &Functional,
        class: usize,
        gradient: impl FnOnce() -> Gradient + Send,
    ) -> Result<NodalRow, SolverError> {
        // Memory for the projection on modes is included.
        address_space::expect(SOLUTION * self.mesh.nodes())?;
        if let Some(known) = self.kept_row(functional, class) {
            return Ok(known);
        }
        let row = aside(|| self.solve_row(class, gradient()))?;
        // Rows that vanish by symmetry are found quickly, and their untouched memory takes no space.
        if row.temperature.iter().any(|&value| value != 0.0) {
            self.keep_row(functional, class, &row);
        }
        Ok(row)
    }

    /// Rows are kept unless another thread holds the list. A thread that finds it taken solves anew, which gives the
    /// same bits.
    fn kept_row(&self, functional: &Functional, class: usize) -> Option<NodalRow> {
        let rows = self.rows.try_lock()?;
        let found = rows.list.iter().find(|(known, of, _)| *of == class && known == functional);
        found.map(|(.., row)| row.clone())
    }

    fn keep_row(&self, functional: &Functional, class: usize, row: &NodalRow) {
        let Some(mut rows) = self.rows.try_lock() else { return };
        let rows = &mut *rows;
        rows.bytes += row.bytes();
        rows.list.push_back((functional.clone(), class, row.clone()));
        let most = most_memory_of_rows(&self.mesh, &self.laws);
        while rows.bytes > most
            && let Some((.., oldest)) = rows.list.pop_front()
        {
            rows.bytes -= oldest.bytes();
        }
    }

    /// Number of stored entries of the rows kept so far.
    pub fn row_entries(&self) -> usize {
        self.rows.try_lock().map_or(0, |rows| (rows.bytes / 8.0) as usize)
    }

    fn solve_row(&self, class: usize, gradient: Gradient) -> Result<NodalRow, SolverError> {
        let Gradient { displacement: mut load, mut temperature, mut forces } = gradient;
        if load.iter().any(|&value| value != 0.0) {
            match self.solver(class)? {
                Solver::Factor(factor) => factor.solve_in_place(&mut load),
                Solver::Bricks(solver) => solve_row_of_bricks(solver, &mut load)?,
            }
            self.add_thermal_row(&load, &mut temperature);
            let (degrees, plane) = (self.degrees(), forces[0][0].len());
            let firsts = [0, self.mesh.nodes() - plane];
            for (lists, first) in forces.iter_mut().zip(firsts) {
                for (component, list) in lists.iter_mut().enumerate() {
                    for (node, row) in list.iter_mut().enumerate() {
                        *row += load[(first + node) * degrees + component];
                    }
                }
            }
        }
        Ok(NodalRow { temperature: Arc::new(temperature), forces: Arc::new(forces) })
    }
}

/// A row that needs too many iterations is solved for with the tolerance of a state.
fn solve_row_of_bricks(solver: &BrickSolver, load: &mut [f64]) -> Result<(), NotConverged> {
    let gradient = load.to_vec();
    if solver.solve_in_place(load, &[], TOLERANCE).is_err() {
        load.copy_from_slice(&gradient);
        solver.solve_in_place(load, &[], brick_solver::TOLERANCE)?;
    }
    Ok(())
}
