//! The heat of a solid, whatever the method that gives it.

mod modal;
mod nonlinear;
mod particles;

use faer::Mat;

use super::heat::{HeatLoads, HeatProblem, ModalRow};
use super::nonlinear::{NonlinearFailure, NonlinearHeat, heat_mesh};
use super::plan::Plan;
use crate::math::separable::transform_depth;
use crate::method::enthalpy::Failure;
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::Mesh;
use crate::method::particle_heat::ParticleHeat;
use crate::runtime::allowance::{Allowance, Halt};
use crate::state::Layout;
pub use particles::particle_cost;

/// The temperature of a solid and how it advances. Whatever changes is a flat vector, its state; temperatures count from
/// the initial one, class by class of the planes of symmetry.
pub trait Heat: Send + Sync {
    /// The fields of a state.
    fn layout(&self) -> Layout;

    /// The state at time zero.
    fn initial_state(&self) -> Vec<f64> {
        vec![0.0; self.layout().len()]
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one
    /// entry of `loads` for their values at the beginning and one for each derivative. What a halt leaves in
    /// `state` is of no use.
    fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure>;

    /// Temperature above the initial one at all nodes, those on interfaces between layers twice, class by class
    /// [K]; empty for a class that is zero. `faces` holds the present face values of each class.
    fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>>;

    /// The same after a matrix was applied along z, of which each row weights the nodes there: as many planes of nodes
    /// as the matrix has rows. Much less work than all nodes where these are few.
    fn along_depth(&self, state: &[f64], faces: &[Vec<f64>], rows: &Mat<f64>) -> Vec<Vec<f64>> {
        let nodal = self.nodal(state, faces);
        let of_class = |part: &Vec<f64>| match part.is_empty() {
            true => Vec::new(),
            false => transform_depth(part, rows),
        };
        nodal.iter().map(of_class).collect()
    }

    /// Heat stored since time zero [J].
    fn stored(&self, state: &[f64]) -> f64;

    fn totals(&self, state: &[f64]) -> HeatTotals;

    /// Time derivative of a state, laid out like the state, where heat obeys a linear equation; `loads` acts now and
    /// `rates` is its time derivative.
    fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Option<Vec<f64>>;

    /// Whether heat obeys a linear equation.
    fn is_linear(&self) -> bool {
        true
    }

    /// Its modes, where it has any.
    fn modal(&self) -> Option<&dyn ModalHeat> {
        None
    }

    /// What temperatures may err by from step to step [K]; nothing where they are exact.
    fn tolerance(&self) -> f64 {
        0.0
    }

    /// Volume that is liquid, of so many copies of the mesh [m³]; nothing where nothing melts.
    fn liquid_volume(&self, _state: &[f64], _copies: f64) -> f64 {
        0.0
    }

    /// By how much that scatters, about, as fronts go from node to node [m³].
    fn liquid_scatter(&self, _state: &[f64], _copies: f64) -> f64 {
        0.0
    }

    /// Number of particles without a corrected operator of their own; `None` for finite elements.
    fn fallback(&self) -> Option<usize> {
        None
    }
}

/// Heat as a sum of modes, each of which decays at a rate of its own.
pub trait ModalHeat {
    /// Temperature above the initial one at a point of the mesh and its `image` [K] without that of all nodes;
    /// `faces` holds the present face values of each class.
    fn at(
        &self,
        mesh: &Mesh,
        state: &[f64],
        faces: &[Vec<f64>],
        place: ([f64; 3], [bool; 2]),
    ) -> f64;

    /// Of each class the part of a state that is modal.
    fn contents<'s>(&'s self, state: &'s [f64]) -> Vec<&'s [f64]>;

    /// From derivatives of a reading by nodal temperatures of a class those by its modal part of a state and by face
    /// values.
    fn row(&self, class: usize, nodal: &[f64]) -> [Vec<f64>; 2];

    /// Which classes loads drive.
    fn driven(&self, loads: &HeatLoads) -> Vec<bool>;

    /// Rates of decay of the modes of the classes that take part [1/s].
    fn decay_rates(&self, take: &[bool]) -> Vec<f64>;

    /// Rate of change of the content of these modes under loads.
    fn sources(&self, take: &[bool], loads: &HeatLoads) -> Vec<f64>;

    /// Heat that loads bring in [W].
    fn brought_in_by(&self, loads: &HeatLoads) -> f64;

    /// A value as a sum over modes and face values.
    fn value_row(&self, mesh: &Mesh, take: &[bool], of: &HeatValue) -> ModalRow;
}

/// What is linear in the temperatures.
#[derive(Debug, Clone, PartialEq)]
pub enum HeatValue {
    /// Temperature above the initial one at a point of the mesh and its image [K].
    Point { place: [f64; 3], image: [bool; 2] },
    /// Sum over nodes of the bottom or, if `high`, the top, with weights for each class; empty for none.
    Face { weights: Vec<Vec<f64>>, high: bool },
    /// Heat stored [J].
    Stored,
}

/// Why heat did not advance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HeatFailure {
    #[error(transparent)]
    Halted(#[from] Halt),
    #[error(transparent)]
    Nonlinear(NonlinearFailure),
}

impl From<NonlinearFailure> for HeatFailure {
    fn from(failure: NonlinearFailure) -> Self {
        match failure {
            NonlinearFailure::Heat(Failure::Halted(halt)) => Self::Halted(halt),
            failure => Self::Nonlinear(failure),
        }
    }
}

/// The heat of a plan by the method that it names.
pub fn heat_of(plan: &Plan, threads: usize) -> Box<dyn Heat> {
    if let Some(newton) = &plan.newton {
        return Box::new(NonlinearHeat::new(plan, newton));
    }
    match particles::setup(plan) {
        Some(setup) => Box::new(ParticleHeat::new(setup, threads)),
        None if plan.strata.len() > 1 => Box::new(HeatProblem::layered(
            &heat_mesh(plan),
            &plan.constants_of_layers(),
            plan.thermal_faces.clone(),
            threads,
        )),
        None => Box::new(HeatProblem::homogeneous(
            &heat_mesh(plan),
            plan.constants.heat_capacity(),
            plan.constants.conductivity,
            plan.thermal_faces.clone(),
        )),
    }
}
