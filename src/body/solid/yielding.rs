//! Solids with history-dependent stress: their mechanics advances with their heat.

use super::SolidBody;
use super::cracking::Cracking;
use crate::body::{Acts, BodyError};
use crate::math::cholesky::SolverError;
use crate::method::fem::{Deformation, Plan, Remembered, SolidLoads, Temperatures};
use crate::method::inelastic::{
    Increment, InelasticError, InelasticProblem, Look, NodalValues, Progress, StateLayout,
};
use crate::runtime::allowance::Allowance;
use crate::state::{Field, Layout, Per};

/// The mechanics of a solid that yields or relaxes, or whose elastic constants depend on the temperature.
pub struct Yielding {
    problem: InelasticProblem,
    layout: StateLayout,
    /// For each level of the mesh along z, one of the levels of the list with doubled interfaces.
    levels: Vec<usize>,
    /// True if the stress is bounded.
    yields: bool,
    /// Relative tolerance of outputs.
    tolerance: f64,
}

/// Largest number of halvings of a step without equilibrium, or within which temperatures have an extremum.
const MOST_HALVES: u32 = 8;
/// Allowed error of a creep increment relative to the largest elastic strain, as a part of the tolerance of outputs.
const PART_OF_STRAIN: f64 = 0.1;
/// Sample times of temperatures within a step, as parts of it; the effect of a jump at its beginning is short.
const LOOKS: [f64; 5] = [0.0625, 0.25, 0.5, 0.75, 0.9];
/// Part of a temperature change that replaces the rise to yield if the latter is smaller.
const LEAST: f64 = 0.1;

/// Odd temperatures that rounding may leave, relative to the largest even one.
const ROUNDING: f64 = 1e-9;

/// Data for advancing a part of a step.
struct Advance<'a> {
    yielding: &'a Yielding,
    allowance: &'a Allowance,
    heat: &'a Heating<'a>,
}

/// Advances the thermal part of a state.
type Heating<'a> = dyn Fn(&mut [f64], &Acts) -> Result<(), BodyError> + 'a;

/// Lowest and highest temperature of a place [K].
#[derive(Clone, Copy)]
struct Range([f64; 2]);

impl Range {
    fn of(one: f64, other: f64) -> Self {
        Self([one.min(other), one.max(other)])
    }

    /// Distance of a value outside the range.
    fn beyond(self, value: f64) -> f64 {
        let Self([low, high]) = self;
        (low - value).max(value - high).max(0.0)
    }
}

impl Yielding {
    /// Returns `None` if stress follows linearly from deformation and temperature, or is not requested.
    pub fn of(plan: &Plan, tolerance: f64, threads: usize) -> Result<Option<Self>, SolverError> {
        let Some(laws) = &plan.inelastic else { return Ok(None) };
        let problem = InelasticProblem::new(&plan.mesh, laws.clone(), &plan.supports, threads);
        let problem = problem.map_err(|error| match error {
            InelasticError::Solver(error) => error,
            error => panic!("a checked scene has mechanics: {error}"),
        })?;
        let sided = plan.mesh.nodes_of_sided();
        let level = |node: usize| sided.iter().position(|&other| other == node);
        let levels = (0..plan.mesh.axes[2].len()).filter_map(level).collect();
        let yields = problem.yields();
        Ok(Some(Self { layout: problem.layout(), problem, levels, yields, tolerance }))
    }

    /// Returns the state at time zero: in equilibrium at one temperature [K], without forces. If there is no
    /// equilibrium, displacements are zero and the first step reports the error.
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
                    "plastic and back strain [1], accumulated strain [1], dissipation [J/m³]; where moduli relax \
                     also strain and elastic strain of the branches [1]",
                    Per::Point,
                ),
                history.len(),
            )
    }
}

impl SolidBody {
    /// Returns the thermal part of a state.
    pub(super) fn heat_of<'s>(&self, state: &'s [f64]) -> &'s [f64] {
        &state[..self.heat_len]
    }

    /// Returns the mechanical part of a state; empty without a history.
    pub(super) fn mechanics_of<'s>(&self, state: &'s [f64]) -> &'s [f64] {
        let yielding = self.yielding.as_ref().map(Yielding::layout);
        let layout = yielding.or(self.cracking.as_ref().map(Cracking::layout));
        let length = layout.map_or(0, |layout| layout.len());
        &state[self.heat_len..self.heat_len + length]
    }

    /// Advances heat and mechanics to the equilibrium at the end, in parts. A part is halved if temperatures have an
    /// extremum within it, so that plastic strain sees the warmest moment, if its end does not show flow within it, if
    /// moduli relax while temperatures do not change linearly, or if it finds no equilibrium.
    ///
    /// Received heat changes linearly over the whole step, so such a step is not cut.
    pub(super) fn advance_yielding(
        &self,
        yielding: &Yielding,
        state: &mut [f64],
        acts: &Acts,
        allowance: &Allowance,
        heat: impl Fn(&mut [f64], &Acts) -> Result<(), BodyError>,
    ) -> Result<(), BodyError> {
        let advance = Advance { yielding, allowance, heat: &heat };
        let halves = if acts.received.is_empty() { MOST_HALVES } else { 0 };
        self.advance_part(&advance, state, acts, halves)
    }

    /// Advances over one part of a step, with at most this many further halvings.
    fn advance_part(
        &self,
        advance: &Advance,
        state: &mut [f64],
        acts: &Acts,
        halves: u32,
    ) -> Result<(), BodyError> {
        let Advance { yielding, allowance, heat } = *advance;
        let start = state.to_vec();
        heat(&mut state[..self.heat_len], acts)?;
        let looks = match halves {
            0 => Some(Vec::new()),
            _ => self.straight(advance, [&start, state], acts)?,
        };
        if let Some(looks) = looks {
            match self.balance(yielding, (&start[..self.heat_len], state), acts, allowance) {
                // Increments of creep are already cut.
                Err(BodyError::Equilibrium { .. })
                    if halves > 0 && !yielding.problem.takes_time() => {}
                Err(error) => return Err(error),
                Ok(()) if !self.misses_flow(yielding, [&start, state], &looks)? => return Ok(()),
                Ok(()) => {}
            }
        }
        state.copy_from_slice(&start);
        acts.in_halves(|half| self.advance_part(advance, state, half, halves - 1))
    }

    /// Returns true if a step between two states misses flow that began and ended within it.
    fn misses_flow(
        &self,
        yielding: &Yielding,
        states: [&[f64]; 2],
        looks: &[Look],
    ) -> Result<bool, BodyError> {
        let mechanics = states.map(|state| self.mechanics_of(state));
        let missed = yielding.problem.misses_flow(mechanics, looks, yielding.tolerance);
        missed.map_err(|error| self.inelastic_error(error))
    }

    /// Returns temperatures at the beginning, within and at the end of a step; `None` if some of a body that yields
    /// exceed those at its ends. The margin is the tolerance times the rise that makes a held body yield, or a tenth of
    /// the temperatures' own change if that is larger. Monotonic changes of a place, at any pace, do not count. Where
    /// moduli relax, any change counts that is not linear, by its effect on the stress.
    fn straight(
        &self,
        advance: &Advance,
        [start, end]: [&[f64]; 2],
        acts: &Acts,
    ) -> Result<Option<Vec<Look>>, BodyError> {
        let yielding = advance.yielding;
        if !yielding.yields && !yielding.problem.relaxes() {
            return Ok(Some(Vec::new()));
        }
        let at = |time: f64, heat: &[f64]| {
            let loads = self.loads.assemble(&acts.path.at(0, time), self.meshes());
            self.nodal_temperatures(yielding, &self.solid.temperatures(heat, &loads))
        };
        let first = at(0.0, self.heat_of(start))?;
        let last = at(acts.duration, self.heat_of(end))?;
        let ends = first.iter().zip(&last);
        let change = ends.clone().map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
        let ranges: Vec<Range> = ends.map(|(&a, &b)| Range::of(a, b)).collect();
        let mut heat = self.heat_of(start).to_vec();
        let mut done = 0.0;
        let mut looks = vec![(0.0, first.clone())];
        for look in LOOKS {
            let (from, to) = (done * acts.duration, look * acts.duration);
            let path = acts.path.from(from);
            (advance.heat)(&mut heat, &Acts { path: &path, duration: to - from, ..*acts })?;
            done = look;
            let now = at(to, &heat)?;
            let most =
                now.iter().zip(&ranges).map(|(&own, range)| range.beyond(own)).fold(0.0, f64::max);
            let hottest = now.iter().copied().fold(0.0, f64::max);
            let counts = yielding.problem.rise_to_yield(hottest).max(LEAST * change.max(most));
            if yielding.yields && most > yielding.tolerance * counts {
                return Ok(None);
            }
            let ends = [&first[..], &last[..]];
            let uneven = yielding.problem.unevenness(ends, (look, &now), acts.duration);
            if uneven > yielding.tolerance {
                return Ok(None);
            }
            looks.push((look, now));
        }
        looks.push((1.0, last));
        Ok(Some(looks))
    }

    /// Solves for the equilibrium at the end of a step.
    fn balance(
        &self,
        yielding: &Yielding,
        (before, state): (&[f64], &mut [f64]),
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let mechanics_len = yielding.layout().len();
        let (heat, rest) = state.split_at_mut(self.heat_len);
        let mechanics = &mut rest[..mechanics_len];
        let at = |time: f64, heat: &[f64]| {
            let inputs = acts.path.at(0, time);
            let mut loads = self.loads.assemble(&inputs, self.meshes());
            for received in acts.received {
                self.port(received.face).add(&mut loads, received.given);
            }
            let temperatures = self.solid.temperatures(heat, &loads);
            let nodal = self.nodal_temperatures(yielding, &temperatures)?;
            Ok::<_, BodyError>((nodal, self.nodal_forces(&loads)?))
        };
        let end = at(acts.duration, heat)?;
        // Rate-independent flow depends on the end of the step alone.
        let start = yielding.problem.takes_time().then(|| at(0.0, before)).transpose()?;
        let start = start.as_ref().unwrap_or(&end);
        let increment = Increment {
            temperatures: [&start.0, &end.0],
            forces: [&start.1, &end.1],
            duration: acts.duration,
            tolerance: PART_OF_STRAIN * yielding.tolerance,
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

    /// Temperature of every node of the mesh [K]; an interface has one value, as layers are in perfect thermal contact.
    fn nodal_temperatures(
        &self,
        yielding: &Yielding,
        temperatures: &Temperatures,
    ) -> Result<Vec<f64>, BodyError> {
        self.require_even(temperatures)?;
        let mesh = self.solid.mesh();
        let plane = mesh.axes[0].len() * mesh.axes[1].len();
        let start = self.solid.initial_temperature();
        let rises = &temperatures[0];
        if rises.is_empty() {
            return Ok(vec![start; mesh.nodes()]);
        }
        let level = |&level: &usize| &rises[level * plane..(level + 1) * plane];
        Ok(yielding.levels.iter().flat_map(level).map(|rise| start + rise).collect())
    }

    /// Refuses temperatures that are not even about the planes of symmetry, but for rounding: mechanics with a history
    /// has the part of a body between them alone.
    pub(super) fn require_even(&self, temperatures: &Temperatures) -> Result<(), BodyError> {
        let largest = |class: &Vec<f64>| class.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
        let allowed = ROUNDING * largest(&temperatures[0]);
        if temperatures.iter().skip(1).any(|class| largest(class) > allowed) {
            return Err(BodyError::Uneven { body: self.name.clone() });
        }
        Ok(())
    }

    /// Forces on all nodes, with the components of a node together [N].
    pub(super) fn nodal_forces(&self, loads: &SolidLoads) -> Result<Vec<f64>, BodyError> {
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

    /// Returns displacements and stress from the state's history; `None` if stress follows from deformation alone.
    pub(super) fn remembered(
        &self,
        state: &[f64],
        temperatures: Option<&Temperatures>,
    ) -> Result<Option<Deformation>, BodyError> {
        if let Some(cracking) = &self.cracking {
            return Ok(Some(self.cracked(cracking, state)));
        }
        let (Some(yielding), Some(temperatures)) = (&self.yielding, temperatures) else {
            return Ok(None);
        };
        let nodal = self.nodal_temperatures(yielding, temperatures)?;
        self.deformation_of(yielding, self.mechanics_of(state), &nodal).map(Some)
    }

    /// Returns displacements and stress of a body with a history as loads act on a state at once; `None` without a
    /// history, if the state is in equilibrium with the loads already, and where there is no equilibrium.
    pub(super) fn deformation_at_once(
        &self,
        state: &[f64],
        temperatures: &Temperatures,
        loads: &SolidLoads,
    ) -> Result<Option<Deformation>, BodyError> {
        let Some(yielding) = &self.yielding else { return Ok(None) };
        let nodal = self.nodal_temperatures(yielding, temperatures)?;
        let mut mechanics = self.mechanics_of(state).to_vec();
        match yielding.problem.advance(&mut mechanics, &nodal, &self.nodal_forces(loads)?) {
            Ok(Progress { iterations: 0, .. }) => Ok(None),
            Ok(_) => self.deformation_of(yielding, &mechanics, &nodal).map(Some),
            Err(error) => match self.inelastic_error(error) {
                BodyError::Equilibrium { .. } => Ok(None),
                error => Err(error),
            },
        }
    }

    /// Displacements and stress of a mechanical state at nodal temperatures.
    fn deformation_of(
        &self,
        yielding: &Yielding,
        mechanics: &[f64],
        nodal: &[f64],
    ) -> Result<Deformation, BodyError> {
        let values = yielding.problem.nodal_values(mechanics, nodal);
        let NodalValues { stress, plastic_strain, back_strain } =
            values.map_err(|error| self.inelastic_error(error))?;
        let remembered = match yielding.yields {
            true => Remembered::flowing(stress, plastic_strain, back_strain),
            false => Remembered::elastic(stress),
        };
        let displacement = yielding.problem.displacement(mechanics).to_vec();
        Ok(Deformation::of_nodes(displacement, remembered))
    }

    /// Largest accumulated plastic strain of all points at which the law is evaluated [1], an upper bound of all
    /// readings. It is zero without yielding.
    pub(super) fn max_plastic_strain(&self, state: &[f64]) -> f64 {
        let largest =
            |yielding: &Yielding| yielding.problem.max_plastic_strain(self.mechanics_of(state));
        self.yielding.as_ref().map_or(0.0, largest)
    }

    /// Elastic energy and that of hardening [J].
    pub(super) fn stored_energy(
        &self,
        state: &[f64],
        temperatures: &Temperatures,
    ) -> Result<f64, BodyError> {
        let Some(yielding) = &self.yielding else { return Ok(0.0) };
        let nodal = self.nodal_temperatures(yielding, temperatures)?;
        let stored = yielding.problem.stored_energy(self.mechanics_of(state), &nodal);
        stored.map_err(|error| self.inelastic_error(error))
    }

    /// Energy dissipated by yielding [J].
    pub(super) fn plastic_work(&self, state: &[f64]) -> f64 {
        let work = |yielding: &Yielding| yielding.problem.plastic_work(self.mechanics_of(state));
        self.yielding.as_ref().map_or(0.0, work)
    }

    /// Energy dissipated by relaxation [J].
    pub(super) fn relaxation_loss(&self, state: &[f64]) -> f64 {
        let loss = |yielding: &Yielding| yielding.problem.relaxation_loss(self.mechanics_of(state));
        self.yielding.as_ref().map_or(0.0, loss)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monotonic_temperatures_do_not_turn() {
        for range in [Range::of(1.0, 3.0), Range::of(3.0, 1.0)] {
            assert_eq!([1.0, 2.0, 3.0].map(|value| range.beyond(value)), [0.0; 3]);
            assert_eq!([0.5, 3.25].map(|value| range.beyond(value)), [0.5, 0.25]);
        }
    }
}
