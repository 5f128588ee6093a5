//! Heat conduction of a solid behind one interface for all methods.

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

/// Temperature of a solid and its advance in time. The state is a flat vector. Temperatures are relative to the initial
/// one, class by class of the planes of symmetry.
pub trait Heat: Send + Sync {
    /// The fields of a state.
    fn layout(&self) -> Layout;

    /// The state at time zero.
    fn initial_state(&self) -> Vec<f64> {
        vec![0.0; self.layout().len()]
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one entry of `loads`
    /// for their values at the beginning and one for each derivative. After a halt `state` is unusable.
    fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure>;

    /// Returns the temperature above the initial one at all nodes, class by class [K]; empty for a class that is zero.
    /// Nodes on interfaces between layers are listed twice. `faces` holds the present face values of each class.
    fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>>;

    /// Returns nodal temperatures multiplied by a matrix along z, each of whose rows weights the nodes there. The
    /// result has one plane of nodes per row; with few rows it is much cheaper than all nodes.
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

    /// Returns the time derivative of a state, laid out like the state, if heat obeys a linear equation. `loads` acts
    /// now, and `rates` is its time derivative.
    fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Option<Vec<f64>>;

    /// Returns true if heat obeys a linear equation.
    fn is_linear(&self) -> bool {
        true
    }

    /// Returns the modes, if there are any.
    fn modal(&self) -> Option<&dyn ModalHeat> {
        None
    }

    /// Error of temperatures from step to step [K]; zero where they are exact.
    fn tolerance(&self) -> f64 {
        0.0
    }

    /// Liquid volume of all copies of the mesh [m³]; zero if nothing melts.
    fn liquid_volume(&self, _state: &[f64], _copies: f64) -> f64 {
        0.0
    }

    /// Approximate scatter of that volume as fronts move from node to node [m³].
    fn liquid_scatter(&self, _state: &[f64], _copies: f64) -> f64 {
        0.0
    }

    /// Number of particles without a corrected operator of their own; `None` for finite elements.
    fn fallback(&self) -> Option<usize> {
        None
    }
}

/// Heat as a sum of modes, each with a decay rate of its own.
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

    /// Returns the modal part of a state for each class.
    fn contents<'s>(&'s self, state: &'s [f64]) -> Vec<&'s [f64]>;

    /// Converts derivatives of a reading by nodal temperatures of a class to those by its modal part of a state and by
    /// face values.
    fn row(&self, class: usize, nodal: &[f64]) -> [Vec<f64>; 2];

    /// Returns for each class whether loads drive it.
    fn driven(&self, loads: &HeatLoads) -> Vec<bool>;

    /// Decay rates of the modes of the classes in `take` [1/s].
    fn decay_rates(&self, take: &[bool]) -> Vec<f64>;

    /// Rate of change of the content of these modes under loads.
    fn sources(&self, take: &[bool], loads: &HeatLoads) -> Vec<f64>;

    /// Heat flow supplied by loads [W].
    fn brought_in_by(&self, loads: &HeatLoads) -> f64;

    /// A value as a sum over modes and face values.
    fn value_row(&self, mesh: &Mesh, take: &[bool], of: &HeatValue) -> ModalRow;
}

/// A value that is linear in the temperatures.
#[derive(Debug, Clone, PartialEq)]
pub enum HeatValue {
    /// Temperature above the initial one at a point of the mesh and its image [K].
    Point { place: [f64; 3], image: [bool; 2] },
    /// Sum over nodes of the bottom or, if `high`, the top, with weights for each class; empty for none.
    Face { weights: Vec<Vec<f64>>, high: bool },
    /// Heat stored [J].
    Stored,
}

/// Reasons why heat did not advance.
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

/// Creates the heat problem of a plan with the plan's method.
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
