//! The heat of a solid by the method that its scene names.

use super::heat::{
    DepthModes, HeatLoads, HeatProblem, Homogeneous, Layered, ModalRow, ThermalFace,
};
use super::nonlinear::{NonlinearFailure, NonlinearHeat, heat_mesh};
use super::plan::Plan;
use crate::method::enthalpy::Failure;
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::{Geometry, Mesh};
use crate::method::particle_heat::{
    Condition, Cost, End, Face, LatticeAxis, Operator, ParticleHeat, Settings, Setup, Sources,
};
use crate::runtime::allowance::{Allowance, Halt};
use crate::scene::{SphOperator, SphSettings};
use crate::state::Layout;

/// The temperature of a solid and how it advances.
pub enum Conduction {
    /// Finite elements, exact in time by their modes.
    Modes(Box<HeatProblem<Homogeneous>>),
    /// The same through layers of several materials.
    Layers(Box<HeatProblem<Layered>>),
    /// Smoothed particles on the nodes.
    Particles(Box<ParticleHeat>),
    /// Enthalpies of nodes, by Newton's method.
    Nonlinear(Box<NonlinearHeat>),
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

const NO_MODES: &str = "only bodies whose heat modes give are asked for these";

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

impl Conduction {
    pub fn new(plan: &Plan, threads: usize) -> Self {
        if let Some(newton) = &plan.newton {
            return Self::Nonlinear(Box::new(NonlinearHeat::new(plan, newton)));
        }
        match particle_setup(plan) {
            Some(setup) => Self::Particles(Box::new(ParticleHeat::new(setup, threads))),
            None if plan.strata.len() > 1 => Self::Layers(Box::new(HeatProblem::layered(
                &heat_mesh(plan),
                &plan.constants_of_layers(),
                plan.thermal_faces.clone(),
                threads,
            ))),
            None => Self::Modes(Box::new(HeatProblem::homogeneous(
                &heat_mesh(plan),
                plan.constants.heat_capacity(),
                plan.constants.conductivity,
                plan.thermal_faces.clone(),
            ))),
        }
    }

    /// The state at time zero.
    pub fn initial_state(&self) -> Vec<f64> {
        match self {
            Self::Nonlinear(problem) => problem.initial_state(),
            _ => vec![0.0; self.state_len()],
        }
    }

    /// What temperatures may err by from step to step [K]; nothing where they are exact.
    pub fn tolerance(&self) -> f64 {
        match self {
            Self::Nonlinear(problem) => problem.tolerance(),
            _ => 0.0,
        }
    }

    /// Whether heat obeys a linear equation.
    pub fn is_linear(&self) -> bool {
        !matches!(self, Self::Nonlinear(_))
    }

    /// Volume that is liquid, of so many copies of the mesh [m³]; nothing where nothing melts.
    pub fn liquid_volume(&self, state: &[f64], copies: f64) -> f64 {
        match self {
            Self::Nonlinear(problem) => problem.liquid_volume(state, copies),
            _ => 0.0,
        }
    }

    /// By how much that scatters, about, as fronts go from node to node [m³].
    pub fn liquid_scatter(&self, state: &[f64], copies: f64) -> f64 {
        match self {
            Self::Nonlinear(problem) => problem.liquid_scatter(state, copies),
            _ => 0.0,
        }
    }

    /// Length of a state.
    pub fn state_len(&self) -> usize {
        self.layout().len()
    }

    /// The fields of a state.
    pub fn layout(&self) -> Layout {
        match self {
            Self::Modes(problem) => problem.layout(),
            Self::Layers(problem) => problem.layout(),
            Self::Particles(problem) => problem.layout(),
            Self::Nonlinear(problem) => problem.layout(),
        }
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one
    /// entry of `loads` for their values at the beginning and one for each derivative. What a halt leaves in
    /// `state` is of no use.
    pub fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure> {
        match self {
            // One step of any length.
            Self::Modes(problem) => {
                allowance.spend(1.0, "steps", state.len())?;
                problem.advance(state, loads, dt);
                Ok(())
            }
            Self::Layers(problem) => {
                allowance.spend(1.0, "steps", state.len())?;
                problem.advance(state, loads, dt);
                Ok(())
            }
            Self::Particles(problem) => {
                let sources: Vec<Sources> = loads.iter().map(sources).collect();
                Ok(problem.advance(state, &sources, dt, allowance)?)
            }
            Self::Nonlinear(problem) => Ok(problem.advance(state, loads, dt, allowance)?),
        }
    }

    /// Time derivative of a state, laid out like the state; `loads` acts now and `rates` is its time
    /// derivative.
    pub fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Vec<f64> {
        match self {
            Self::Modes(problem) => problem.rates(state, loads, rates),
            Self::Layers(problem) => problem.rates(state, loads, rates),
            Self::Particles(problem) => problem.rates(state, &sources(loads), &sources(rates)),
            Self::Nonlinear(_) => unreachable!("rates are asked of linear bodies alone"),
        }
    }

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        match self {
            Self::Modes(problem) => problem.stored(state),
            Self::Layers(problem) => problem.stored(state),
            Self::Particles(problem) => problem.stored(state),
            Self::Nonlinear(problem) => problem.stored(state),
        }
    }

    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        match self {
            Self::Modes(problem) => problem.totals(state),
            Self::Layers(problem) => problem.totals(state),
            Self::Particles(problem) => problem.totals(state),
            Self::Nonlinear(problem) => problem.totals(state),
        }
    }

    /// Temperature above the initial one at a point of the mesh and its `image` [K] without that of all nodes,
    /// where modes give it; `faces` holds the present face values of each class.
    pub fn at(
        &self,
        mesh: &Mesh,
        state: &[f64],
        faces: &[Vec<f64>],
        (point, image): ([f64; 3], [bool; 2]),
    ) -> Option<f64> {
        match self {
            Self::Modes(problem) => Some(problem.temperature_at(mesh, state, faces, point, image)),
            Self::Layers(problem) => Some(problem.temperature_at(mesh, state, faces, point, image)),
            Self::Particles(_) | Self::Nonlinear(_) => None,
        }
    }

    /// Temperature above the initial one at all nodes, those on interfaces between layers twice, class by class
    /// [K]; empty for a class that is zero.
    pub fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        match self {
            Self::Modes(problem) => problem.nodal(state, faces),
            Self::Layers(problem) => problem.nodal(state, faces),
            Self::Particles(problem) => problem.temperatures(state, faces),
            Self::Nonlinear(problem) => problem.nodal(state),
        }
    }

    /// Of each class the part of a state that is modal; `None` where heat has no modes.
    pub fn contents<'s>(&'s self, state: &'s [f64]) -> Option<Vec<&'s [f64]>> {
        match self {
            Self::Modes(problem) => Some(problem.class_contents(state)),
            Self::Layers(problem) => Some(problem.class_contents(state)),
            Self::Particles(_) | Self::Nonlinear(_) => None,
        }
    }

    /// From derivatives of a reading by nodal temperatures of a class those by its modal part of a state and by face
    /// values; `None` where heat has no modes.
    pub fn row(&self, class: usize, nodal: &[f64]) -> Option<[Vec<f64>; 2]> {
        match self {
            Self::Modes(problem) => Some(problem.row(class, nodal)),
            Self::Layers(problem) => Some(problem.row(class, nodal)),
            Self::Particles(_) | Self::Nonlinear(_) => None,
        }
    }

    /// Which classes loads drive, where modes give the heat.
    pub fn driven(&self, loads: &HeatLoads) -> Option<Vec<bool>> {
        match self {
            Self::Modes(problem) => Some(problem.driven(loads)),
            Self::Layers(problem) => Some(problem.driven(loads)),
            Self::Particles(_) | Self::Nonlinear(_) => None,
        }
    }

    /// Rates of decay of the modes of the classes that take part [1/s].
    ///
    /// # Panics
    /// This and the others that speak of modes, if these do not give the heat.
    pub fn modal_rates(&self, take: &[bool]) -> Vec<f64> {
        match self {
            Self::Modes(problem) => problem.modal_rates(take),
            Self::Layers(problem) => problem.modal_rates(take),
            Self::Particles(_) | Self::Nonlinear(_) => panic!("{NO_MODES}"),
        }
    }

    /// Rate of change of the content of these modes under loads.
    pub fn modal_sources(&self, take: &[bool], loads: &HeatLoads) -> Vec<f64> {
        match self {
            Self::Modes(problem) => problem.modal_sources(take, loads),
            Self::Layers(problem) => problem.modal_sources(take, loads),
            Self::Particles(_) | Self::Nonlinear(_) => panic!("{NO_MODES}"),
        }
    }

    /// Heat that loads bring in [W].
    pub fn brought_in_by(&self, loads: &HeatLoads) -> f64 {
        match self {
            Self::Modes(problem) => problem.brought_in_by(loads),
            Self::Layers(problem) => problem.brought_in_by(loads),
            Self::Particles(_) | Self::Nonlinear(_) => panic!("{NO_MODES}"),
        }
    }

    /// A value as a sum over modes and face values.
    pub fn heat_row(&self, mesh: &Mesh, take: &[bool], of: &HeatValue) -> ModalRow {
        fn row<D: DepthModes>(
            problem: &HeatProblem<D>,
            mesh: &Mesh,
            take: &[bool],
            of: &HeatValue,
        ) -> ModalRow {
            match of {
                HeatValue::Point { place, image } => {
                    problem.point_row(mesh, take, (*place, *image))
                }
                HeatValue::Face { weights, high } => problem.face_row(take, weights, *high),
                HeatValue::Stored => problem.stored_row(take),
            }
        }
        match self {
            Self::Modes(problem) => row(problem, mesh, take, of),
            Self::Layers(problem) => row(problem, mesh, take, of),
            Self::Particles(_) | Self::Nonlinear(_) => panic!("{NO_MODES}"),
        }
    }

    /// Number of particles without a corrected operator of their own; `None` for finite elements.
    pub fn fallback(&self) -> Option<usize> {
        match self {
            Self::Modes(_) | Self::Layers(_) | Self::Nonlinear(_) => None,
            Self::Particles(problem) => Some(problem.fallback()),
        }
    }
}

fn sources<'a>(loads: &HeatLoads<'a>) -> Sources<'a> {
    Sources { surface: loads.surface, faces: loads.faces }
}

/// What the particles of a plan will cost; `None` where finite elements conduct the heat.
pub fn particle_cost(plan: &Plan) -> Option<Cost> {
    particle_setup(plan).map(|setup| ParticleHeat::cost(&setup))
}

/// The particles of a plan.
fn particle_setup(plan: &Plan) -> Option<Setup> {
    let SphSettings { operator, kernel, support } = plan.sph?;
    let operator = match operator {
        SphOperator::Corrected => Operator::Corrected,
        SphOperator::Plain => Operator::Plain,
    };
    let condition = |condition: ThermalFace| match condition {
        ThermalFace::Flux => Condition::Flux,
        ThermalFace::Prescribed => Condition::Held,
        ThermalFace::Convective(coefficient) => Condition::Convective(coefficient),
    };
    let faces = plan.thermal_faces.iter().map(|&(face, kind)| Face {
        axis: face.axis,
        high: face.high,
        condition: condition(kind),
    });
    Some(Setup {
        axes: [0, 1, 2].map(|a| lattice_axis(&plan.mesh, a)),
        settings: Settings { operator, kernel, support },
        capacity: plan.constants.heat_capacity(),
        conductivity: plan.constants.conductivity,
        faces: faces.collect(),
        classes: plan.mesh.parities().into_iter().map(|parity| parity.odd).collect(),
        copies: plan.mesh.copies(),
    })
}

fn lattice_axis(mesh: &Mesh, axis: usize) -> LatticeAxis {
    LatticeAxis {
        nodes: mesh.axes[axis].nodes.clone(),
        measures: mesh.axes[axis].integrals(),
        ends: [End::Mirror; 2],
        radial: axis == 0 && mesh.geometry == Geometry::Axisymmetric,
    }
}
