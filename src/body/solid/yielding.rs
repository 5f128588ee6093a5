//! Solids whose stress depends on what they went through: their mechanics advances with their heat.

use std::sync::Arc;

use super::SolidBody;
use crate::body::{Acts, BodyError, Extreme};
use crate::material::FlowLaw;
use crate::material::stress::{max_principal, von_mises};
use crate::math::allowance::Allowance;
use crate::math::cholesky::SolverError;
use crate::method::fem::{Deformation, Plan, SolidLoads, Temperatures};
use crate::method::inelastic::{Increment, InelasticError, InelasticProblem, StateLayout};
use crate::state::{Field, Layout, Per};

/// The mechanics of a solid that yields, or whose elastic constants depend on the temperature.
pub struct Yielding {
    problem: InelasticProblem,
    layout: StateLayout,
    /// Of those that stand twice on every interface, one level along z for each of the mesh.
    levels: Vec<usize>,
    /// Whether stress has a bound.
    yields: bool,
    /// What an inner step of creep may err by, over the largest elastic strain.
    tolerance: f64,
}

/// How often a step that finds no equilibrium is halved.
const MOST_HALVES: u32 = 6;

impl Yielding {
    /// Nothing where stress follows linearly from deformation and temperature, or is not asked for.
    pub fn of(plan: &Plan, tolerance: f64, threads: usize) -> Result<Option<Self>, SolverError> {
        let Some(laws) = &plan.inelastic else { return Ok(None) };
        let start = plan.initial_temperature;
        let is_bounded = |law: &Arc<dyn FlowLaw>| {
            law.over_step(start, 0.0).is_some_and(|constants| constants.yield_stress.is_finite())
        };
        let yields = laws.iter().any(is_bounded);
        let problem = InelasticProblem::new(&plan.mesh, laws.clone(), &plan.supports, threads);
        let problem = problem.map_err(|error| match error {
            InelasticError::Solver(error) => error,
            error => panic!("a checked scene has mechanics: {error}"),
        })?;
        let sided = plan.mesh.nodes_of_sided();
        let level = |node: usize| sided.iter().position(|&other| other == node);
        let levels = (0..plan.mesh.axes[2].len()).filter_map(level).collect();
        Ok(Some(Self { layout: problem.layout(), problem, levels, yields, tolerance }))
    }

    /// The state at time zero: in equilibrium at one temperature [K], without forces. Where there is none, as the first
    /// step says, nothing has moved.
    pub fn initial_state(&self, nodes: usize, temperature: f64) -> Vec<f64> {
        let mut state = self.problem.initial_state();
        let _ = self.problem.advance(&mut state, &vec![temperature; nodes], &[]);
        state
    }

    pub fn layout(&self) -> Layout {
        let field = |name, words, per| Field { name, words, per, width: 1 };
        let StateLayout { displacement, amplitudes, history, .. } = &self.layout;
        Layout::default()
            .with(field("displacement", "displacement [m]", Per::Node), displacement.len())
            .with(
                field("amplitude", "enhanced strain of an element [1]", Per::Cell),
                amplitudes.len(),
            )
            .with(
                field(
                    "history",
                    "plastic and back strain [1], accumulated strain [1], dissipation [J/m³]",
                    Per::Point,
                ),
                history.len(),
            )
    }
}

impl SolidBody {
    /// The part of a state that is heat.
    pub(super) fn heat_of<'s>(&self, state: &'s [f64]) -> &'s [f64] {
        &state[..self.heat_len]
    }

    /// Advances heat, and then mechanics to the equilibrium at the end. A step that finds none is halved.
    pub(super) fn advance_yielding(
        &self,
        yielding: &Yielding,
        state: &mut [f64],
        acts: &Acts,
        allowance: &Allowance,
        mut heat: impl FnMut(&mut [f64], &Acts) -> Result<(), BodyError>,
    ) -> Result<(), BodyError> {
        let start = state.to_vec();
        let mut halves = 0;
        'parts: loop {
            let parts = 1 << halves;
            let length = acts.duration / f64::from(parts);
            for part in 0..parts {
                let path = acts.path.from(f64::from(part) * length);
                let acts = Acts { path: &path, duration: length, ..*acts };
                let before = state[..self.heat_len].to_vec();
                heat(&mut state[..self.heat_len], &acts)?;
                match self.balance(yielding, (&before, state), &acts, allowance) {
                    Ok(()) => {}
                    // What is received changes over the whole step, so that step is not cut; what creeps has been.
                    Err(BodyError::Equilibrium { .. })
                        if halves < MOST_HALVES
                            && acts.received.is_empty()
                            && !yielding.problem.creeps() =>
                    {
                        halves += 1;
                        state.copy_from_slice(&start);
                        continue 'parts;
                    }
                    Err(error) => return Err(error),
                }
            }
            return Ok(());
        }
    }

    /// Equilibrium at the end of what acts.
    fn balance(
        &self,
        yielding: &Yielding,
        (before, state): (&[f64], &mut [f64]),
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let (heat, mechanics) = state.split_at_mut(self.heat_len);
        let at = |time: f64, heat: &[f64]| {
            let inputs = acts.path.at(0, time);
            let mut loads = self.loads.assemble(&inputs, self.meshes());
            for received in acts.received {
                self.port(received.face).add(&mut loads, received.given);
            }
            let temperatures = self.solid.temperatures(heat, &loads);
            let nodal = self.nodal_temperatures(yielding, &temperatures);
            Ok::<_, BodyError>((nodal, self.nodal_forces(&loads)?))
        };
        let end = at(acts.duration, heat)?;
        // What flows at once knows no time but the end.
        let start = yielding.problem.creeps().then(|| at(0.0, before)).transpose()?;
        let start = start.as_ref().unwrap_or(&end);
        let increment = Increment {
            temperatures: [&start.0, &end.0],
            forces: [&start.1, &end.1],
            duration: acts.duration,
            tolerance: yielding.tolerance,
            allowance,
        };
        let advanced = yielding.problem.advance_increment(mechanics, &increment);
        advanced.map_err(|error| self.inelastic_error(error))
    }

    fn inelastic_error(&self, error: InelasticError) -> BodyError {
        match error {
            InelasticError::Solver(error) => error.into(),
            InelasticError::Halted(halt) => BodyError::Halted { body: self.name.clone(), halt },
            error => BodyError::Equilibrium { body: self.name.clone(), error },
        }
    }

    /// Temperature of every node of the mesh [K]; interfaces have one, as layers touch without resistance.
    fn nodal_temperatures(&self, yielding: &Yielding, temperatures: &Temperatures) -> Vec<f64> {
        let mesh = self.solid.mesh();
        let plane = mesh.axes[0].len() * mesh.axes[1].len();
        let start = self.solid.initial_temperature();
        let rises = &temperatures[0];
        if rises.is_empty() {
            return vec![start; mesh.nodes()];
        }
        let level = |&level: &usize| &rises[level * plane..(level + 1) * plane];
        yielding.levels.iter().flat_map(level).map(|rise| start + rise).collect()
    }

    /// Forces on all nodes, their components together [N].
    fn nodal_forces(&self, loads: &SolidLoads) -> Result<Vec<f64>, BodyError> {
        let mesh = self.solid.mesh();
        let (degrees, nodes) = (mesh.geometry.degrees(), mesh.nodes());
        let plane = mesh.axes[0].len() * mesh.axes[1].len();
        let is_zero = |list: &Vec<f64>| list.iter().all(|&force| force == 0.0);
        if !loads.force.iter().skip(1).flatten().flatten().all(is_zero) {
            return Err(BodyError::Uneven { body: self.name.clone() });
        }
        let mut forces = vec![0.0; nodes * degrees];
        for (lists, first) in loads.force[0].iter().zip([0, nodes - plane]) {
            for (component, list) in lists.iter().enumerate() {
                for (node, force) in list.iter().enumerate() {
                    forces[(first + node) * degrees + component] += force;
                }
            }
        }
        Ok(forces)
    }

    /// Displacements and stress as the state remembers them; nothing where stress follows from deformation alone.
    pub(super) fn remembered(
        &self,
        state: &[f64],
        temperatures: Option<&Temperatures>,
    ) -> Result<Option<Deformation>, BodyError> {
        let (Some(yielding), Some(temperatures)) = (&self.yielding, temperatures) else {
            return Ok(None);
        };
        let mechanics = &state[self.heat_len..];
        let nodal = self.nodal_temperatures(yielding, temperatures);
        let stress = yielding.problem.nodal_stress(mechanics, &nodal);
        let stress = stress.map_err(|error| self.inelastic_error(error))?;
        let displacement = yielding.problem.displacement(mechanics).to_vec();
        let plastic_strain = match yielding.yields {
            true => yielding.problem.nodal_plastic_strain(mechanics),
            false => Vec::new(),
        };
        Ok(Some(Deformation::of_nodes(displacement, stress, plastic_strain)))
    }

    /// Highest von Mises and largest principal stress of a body that yields [Pa], at the points where its law holds:
    /// extrapolated to nodes, stress goes beyond what the body bears. Nothing of other bodies.
    pub(super) fn most_borne(
        &self,
        state: &[f64],
        temperatures: &Temperatures,
    ) -> Result<Option<[Extreme; 2]>, BodyError> {
        let Some(yielding) = self.yielding.as_ref().filter(|yielding| yielding.yields) else {
            return Ok(None);
        };
        let nodal = self.nodal_temperatures(yielding, temperatures);
        let points = yielding.problem.points(&state[self.heat_len..], &nodal);
        let points = points.map_err(|error| self.inelastic_error(error))?;
        let highest = |measure: fn([f64; 6]) -> f64| {
            let values: Vec<f64> = points.iter().map(|point| measure(point.stress)).collect();
            Extreme::of(&values, |point| yielding.problem.place_of_point(point))
        };
        Ok(Some([highest(von_mises), highest(max_principal)]))
    }

    /// Largest accumulated plastic strain [1], as the highest stress at the points where the law holds: at nodes of
    /// edges where strain is singular, what is extrapolated goes on without end. Zero where nothing yields.
    pub(super) fn max_plastic_strain(&self, state: &[f64]) -> f64 {
        let largest =
            |yielding: &Yielding| yielding.problem.max_plastic_strain(&state[self.heat_len..]);
        self.yielding.as_ref().map_or(0.0, largest)
    }

    /// Energy that yielding has dissipated [J].
    pub(super) fn plastic_work(&self, state: &[f64]) -> f64 {
        let work =
            |yielding: &Yielding| yielding.problem.dissipated_energy(&state[self.heat_len..]);
        self.yielding.as_ref().map_or(0.0, work)
    }
}
