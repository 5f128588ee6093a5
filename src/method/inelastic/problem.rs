//! The inelastic problem of a body: constant data, and steps from one state to the next.

use std::sync::Arc;

use super::grid::{Grid, Iterate};
use super::newton::{Progress, Step};
use super::tangent::TangentSolver;
use crate::laws::{FlowLaw, PlasticHistory, PointConstants, PointTangent, Relaxation};
use crate::math::cholesky::SolverError;
use crate::method::fem::elastic::Support;
use crate::method::fem::free_faces::FreeFaces;
use crate::method::fem::{Mesh, MeshFace, expected_entries};
use crate::runtime::address_space;
use crate::runtime::allowance::{Allowance, Halt};
use crate::runtime::parallel::Team;
use crate::runtime::thread::aside;

/// Reasons why a step failed; the state is then unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InelasticError {
    #[error("{what} has {given} entries, {wanted} are wanted")]
    Length { what: &'static str, given: usize, wanted: usize },
    #[error(
        "layer {layer} of elements has no law at {temperature} K: moduli and −1 < ν < ½ must be positive, \
         hardening and yield stress not negative"
    )]
    Constants { layer: usize, temperature: f64 },
    #[error(
        "{iterations} iterations found no equilibrium: {residual:e} of the forces are left, where {tolerance:e} \
         is wanted; the loads may be more than the body bears when it yields (allowed: smaller loads, hardening \
         above 0, or shorter communication steps)"
    )]
    NoEquilibrium { iterations: usize, residual: f64, tolerance: f64 },
    #[error(
        "{steps} inner steps of creep came no further than {done:e} s (allowed: shorter communication steps, or slower \
         creep: its coefficient is in 1/(s Paⁿ))"
    )]
    TooFast { steps: usize, done: f64 },
    #[error(
        "{steps} inner steps came no further than {done:e} s: moduli relax too quickly for them (allowed: shorter \
         communication steps, or longer relaxation times)"
    )]
    TooQuick { steps: usize, done: f64 },
    #[error(transparent)]
    Halted(#[from] Halt),
    #[error(transparent)]
    Solver(#[from] SolverError),
}

/// Ranges in a state, a flat vector: displacements, then amplitudes, then histories.
#[derive(Debug, Clone, PartialEq)]
pub struct StateLayout {
    /// Displacements of each node [m], its components together (x, y, z or r, z), the x index of nodes fastest.
    pub displacement: std::ops::Range<usize>,
    /// Amplitudes of enhanced strains of each element [1]: 15 of linear bricks, 7 of linear rings, 0 of quadratic
    /// elements.
    pub amplitudes: std::ops::Range<usize>,
    /// Histories of each element's points, both x fastest: [`PlasticHistory::LEN`] numbers each, in the order of
    /// [`PlasticHistory::read`], then those of [`Relaxation`] and zeros where another layer needs more.
    pub history: std::ops::Range<usize>,
    /// Length of the history of a point.
    pub of_point: usize,
    /// Points of an element: (p + 1)³ of a brick of order p, (p + 2)² of a ring.
    pub points: usize,
}

/// Time that passes in a step [s]: for points that creep, and for all others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lapse {
    pub of_creep: f64,
    pub of_others: f64,
}

impl Lapse {
    pub fn of(duration: f64) -> Self {
        Self { of_creep: duration, of_others: duration }
    }
}

/// A quadrature point with its state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// Volume that it represents, without mirror images [m³].
    pub volume: f64,
    /// Stress xx, yy, zz, xy, yz, xz, of a ring rr, tt, zz, 0, 0, rz [Pa].
    pub stress: [f64; 6],
    /// Thermal strain in each direction [1], and the stress on which it does work [Pa]. That is the sum of normal
    /// stresses. In elements that project their volume change it includes the part that the projection omits.
    pub thermal_strain: f64,
    pub tension: f64,
    /// Elastic and hardening energy per volume [J/m³].
    pub stored: f64,
    pub history: PlasticHistory,
}

/// Equilibrium of a body with elastic–plastic layers.
///
/// If an axis of the mesh is mirrored, the loads must be even about that plane.
pub struct InelasticProblem {
    pub(super) mesh: Mesh,
    laws: Vec<Arc<dyn FlowLaw>>,
    pub(super) grid: Grid,
    pub(super) free_faces: FreeFaces,
    solver: TangentSolver,
    pub(super) threads: usize,
}

impl InelasticProblem {
    /// `laws` holds a law for each layer of elements along z, from the bottom, or one law for all.
    pub fn new(
        mesh: &Mesh,
        laws: Vec<impl Into<Arc<dyn FlowLaw>>>,
        supports: &[(MeshFace, Support)],
        threads: usize,
    ) -> Result<Self, InelasticError> {
        let laws: Vec<Arc<dyn FlowLaw>> = laws.into_iter().map(Into::into).collect();
        let layers = mesh.element_counts()[2];
        if laws.len() != 1 && laws.len() != layers {
            let what = "the list of laws";
            return Err(InelasticError::Length { what, given: laws.len(), wanted: layers });
        }
        let further = laws.iter().filter_map(|law| law.relaxation()).map(Relaxation::history_len);
        let of_point = PlasticHistory::LEN + further.max().unwrap_or(0);
        let grid = Grid::new(mesh, of_point);
        let reference = reference(&laws)?;
        let relaxed = after_all_time(&laws);
        let constants = (&reference, relaxed.as_deref());
        let solver = aside(|| TangentSolver::new(mesh, constants, supports, &Team::new(threads)));
        let free_faces = FreeFaces::of(mesh, supports);
        Ok(Self { mesh: mesh.clone(), laws, grid, free_faces, solver, threads })
    }

    /// Returns true if a part of the body creeps.
    pub fn creeps(&self) -> bool {
        self.laws.iter().any(|law| law.creeps())
    }

    /// Returns true if a part of the body may yield.
    pub fn yields(&self) -> bool {
        let is_bounded = |law: &Arc<dyn FlowLaw>| {
            let own = law.over_step(law.stress_free_temperature(), 0.0);
            own.is_some_and(|own| own.yield_stress.is_finite())
        };
        self.laws.iter().any(is_bounded)
    }

    /// Returns true if moduli of a part of the body relax.
    pub fn relaxes(&self) -> bool {
        self.laws.iter().any(|law| law.relaxation().is_some())
    }

    /// Returns true if strain or stress changes at rest.
    pub fn takes_time(&self) -> bool {
        self.creeps() || self.relaxes()
    }

    /// Relaxation of each layer of elements.
    pub(super) fn relaxation(&self) -> Vec<Option<&Relaxation>> {
        (0..self.grid.layers()).map(|layer| self.law(layer).relaxation()).collect()
    }

    pub fn layout(&self) -> StateLayout {
        let displacement = self.grid.unknowns();
        let amplitudes = displacement + self.grid.elements() * self.grid.kit.treatment.modes();
        let of_point = self.grid.kit.history;
        let history = amplitudes + self.grid.points() * of_point;
        StateLayout {
            displacement: 0..displacement,
            amplitudes: displacement..amplitudes,
            history: amplitudes..history,
            of_point,
            points: self.grid.kit.shapes.points,
        }
    }

    /// Returns the undeformed state, without yielding.
    pub fn initial_state(&self) -> Vec<f64> {
        vec![0.0; self.layout().history.end]
    }

    /// Largest memory of a step beyond the state [B].
    pub fn memory(&self) -> f64 {
        // Constants, tangents twice, histories new and old; in linear bricks also the triangle of a matrix.
        let of_point = 8.0 * (9.0 + 2.0 * 9.0 + 2.0 * self.grid.kit.history as f64);
        // Vectors of Newton's method and of conjugate gradients.
        const VECTORS: f64 = 24.0;
        let unknowns = self.grid.unknowns() as f64;
        let own = self.grid.kit.unknowns() as f64;
        let triangles =
            if self.grid.kit.treatment.modes() > 0 { 0.5 * own * (own + 1.0) } else { 0.0 };
        let factor = self.solver.factors() as f64
            * (1.2 * expected_entries(self.mesh.geometry, self.grid.unknowns()) + 60.0 * unknowns);
        of_point * self.grid.points() as f64
            + 8.0 * (VECTORS * unknowns + triangles * self.grid.elements() as f64 + factor)
    }

    /// Advances a state instantaneously to equilibrium at nodal temperatures [K] under nodal forces [N], see
    /// [`Self::advance_over`].
    pub fn advance(
        &self,
        state: &mut [f64],
        temperatures: &[f64],
        forces: &[f64],
    ) -> Result<Progress, InelasticError> {
        self.advance_over(state, temperatures, forces, 0.0)
    }

    /// Advances a state by a duration [s] to equilibrium at nodal temperatures [K] under nodal forces [N], laid out
    /// like displacements; an empty list of forces means none.
    ///
    /// Strain varies linearly between the last state and this one at every point. If there is no equilibrium, as under
    /// forces beyond the capacity of a body, the state is unchanged.
    pub fn advance_over(
        &self,
        state: &mut [f64],
        temperatures: &[f64],
        forces: &[f64],
        duration: f64,
    ) -> Result<Progress, InelasticError> {
        let change = [temperatures; 2];
        let lapse = Lapse::of(duration);
        self.advance_within(state, change, forces, lapse, &Allowance::default())
    }

    /// Advances like [`Self::advance_over`] from nodal temperatures to others [K], within an allowance of work.
    pub(super) fn advance_within(
        &self,
        state: &mut [f64],
        temperatures: [&[f64]; 2],
        forces: &[f64],
        lapse: Lapse,
        allowance: &Allowance,
    ) -> Result<Progress, InelasticError> {
        self.check(state, temperatures[0])?;
        self.check(state, temperatures[1])?;
        let unknowns = self.grid.unknowns();
        if !forces.is_empty() && forces.len() != unknowns {
            let what = "the list of nodal forces";
            return Err(InelasticError::Length { what, given: forces.len(), wanted: unknowns });
        }
        address_space::expect(self.memory() as usize).map_err(SolverError::from)?;
        aside(|| self.advance_here(state, temperatures, forces, lapse, allowance))
    }

    fn advance_here(
        &self,
        state: &mut [f64],
        temperatures: [&[f64]; 2],
        forces: &[f64],
        lapse: Lapse,
        allowance: &Allowance,
    ) -> Result<Progress, InelasticError> {
        let team = Team::new(self.threads);
        let constants = self.constants_over(temperatures, lapse, &team)?;
        let relaxation = self.relaxation();
        let layout = self.layout();
        let mut iterate = self.iterate(state);
        let load = match forces.is_empty() {
            true => vec![0.0; self.grid.unknowns()],
            false => self.apart(forces),
        };
        let progress = {
            let step = Step {
                grid: &self.grid,
                solver: &self.solver,
                team: &team,
                constants: &constants,
                relaxation: &relaxation,
                old: &state[layout.history.clone()],
                load: &load,
                allowance,
            };
            step.balance(&mut iterate)?
        };
        let degrees = self.grid.kit.shapes.degrees;
        for (c, component) in iterate.displacement.chunks_exact(self.grid.nodes).enumerate() {
            let own = state[layout.displacement.clone()].iter_mut().skip(c).step_by(degrees);
            own.zip(component).for_each(|(to, from)| *to = *from);
        }
        state[layout.amplitudes].copy_from_slice(&iterate.amplitudes);
        state[layout.history].copy_from_slice(&iterate.new);
        Ok(progress)
    }

    pub(super) fn check(&self, state: &[f64], temperatures: &[f64]) -> Result<(), InelasticError> {
        let lengths = [
            ("the state", state.len(), self.layout().history.end),
            ("the list of nodal temperatures", temperatures.len(), self.grid.nodes),
        ];
        match lengths.into_iter().find(|(_, given, wanted)| given != wanted) {
            Some((what, given, wanted)) => Err(InelasticError::Length { what, given, wanted }),
            None => Ok(()),
        }
    }

    /// Reorders nodal values by components.
    fn apart(&self, nodal: &[f64]) -> Vec<f64> {
        let degrees = self.grid.kit.shapes.degrees;
        (0..degrees).flat_map(|c| nodal.iter().skip(c).step_by(degrees)).copied().collect()
    }

    fn iterate(&self, state: &[f64]) -> Iterate {
        let layout = self.layout();
        let mut iterate = self.grid.iterate();
        iterate.displacement = self.apart(&state[layout.displacement]);
        iterate.amplitudes.copy_from_slice(&state[layout.amplitudes]);
        iterate
    }

    pub(super) fn law(&self, layer: usize) -> &dyn FlowLaw {
        if self.laws.len() == 1 { &*self.laws[0] } else { &*self.laws[layer] }
    }

    /// Constants of all points over a step [s] at constant temperatures.
    pub(super) fn constants(
        &self,
        temperatures: &[f64],
        duration: f64,
        team: &Team,
    ) -> Result<Vec<PointConstants>, InelasticError> {
        self.constants_over([temperatures; 2], Lapse::of(duration), team)
    }

    /// Constants of all points over a step in which temperatures change.
    fn constants_over(
        &self,
        temperatures: [&[f64]; 2],
        lapse: Lapse,
        team: &Team,
    ) -> Result<Vec<PointConstants>, InelasticError> {
        let shapes = &self.grid.kit.shapes;
        let layers = team.map(self.grid.layers(), |layer| {
            let law = self.law(layer);
            let duration = if law.creeps() { lapse.of_creep } else { lapse.of_others };
            let mut out = Vec::with_capacity(self.grid.per_layer() * shapes.points);
            let mut at = [vec![0.0; shapes.points], vec![0.0; shapes.points]];
            for e in 0..self.grid.per_layer() {
                let place = self.grid.place(layer, e);
                for (at, temperatures) in at.iter_mut().zip(temperatures) {
                    let nodes = self.grid.nodes_of(place);
                    let nodal: Vec<f64> = nodes.map(|node| temperatures[node]).collect();
                    shapes.interpolate(&nodal, at);
                }
                for (&start, &temperature) in at[0].iter().zip(&at[1]) {
                    let constants = law.over_change([start, temperature], duration);
                    out.push(constants.ok_or(InelasticError::Constants { layer, temperature })?);
                }
            }
            Ok::<_, InelasticError>(out)
        });
        let mut all = Vec::with_capacity(self.grid.points());
        for layer in layers {
            all.extend(layer?);
        }
        Ok(all)
    }

    /// Smallest temperature rise that makes a layer yield at a temperature [K] if it is held along two directions,
    /// `σ_y (1 − ν)/(E α)` [K].
    pub fn rise_to_yield(&self, temperature: f64) -> f64 {
        let rise = |law: &Arc<dyn FlowLaw>| {
            let at = |temperature| law.over_step(temperature, 0.0);
            let (own, warmer) = (at(temperature)?, at(temperature + 1.0)?);
            let expansion = (warmer.thermal_strain - own.thermal_strain).abs();
            Some(own.yield_stress / (own.biaxial_modulus() * expansion))
        };
        self.laws.iter().filter_map(rise).fold(f64::INFINITY, f64::min)
    }

    /// Returns the effect of temperatures that do not change linearly over a duration [s], relative to the stress,
    /// where moduli relax: `now` are nodal temperatures at a part of it, between those at its ends [K].
    pub fn unevenness(
        &self,
        [first, last]: [&[f64]; 2],
        (part, now): (f64, &[f64]),
        duration: f64,
    ) -> f64 {
        let mut laws: Vec<&Relaxation> = Vec::new();
        for own in self.laws.iter().filter_map(|law| law.relaxation()) {
            if !laws.contains(&own) {
                laws.push(own);
            }
        }
        let ends = || first.iter().zip(last);
        let change = ends().zip(now).map(|((a, b), now)| (b - a).abs().max((now - a).abs()));
        let change = change.fold(f64::MIN_POSITIVE, f64::max);
        let nodes = ends().zip(now);
        let of_node = |((a, b), now): ((&f64, &f64), &f64)| {
            let even = a + part * (b - a);
            let of_law = |law: &&Relaxation| law.unevenness([even, *now], duration, change);
            if *now == even { 0.0 } else { laws.iter().map(of_law).fold(0.0, f64::max) }
        };
        nodes.map(of_node).fold(0.0, f64::max)
    }

    /// Returns all quadrature points with the histories of a state.
    pub fn points(
        &self,
        state: &[f64],
        temperatures: &[f64],
    ) -> Result<Vec<PointState>, InelasticError> {
        self.check(state, temperatures)?;
        let team = Team::new(self.threads);
        let constants = self.constants(temperatures, 0.0, &team)?;
        let iterate = self.iterate(state);
        let history = &state[self.layout().history];
        let relaxation = self.relaxation();
        Ok(self.grid.read(&team, (&constants, &relaxation), history, &iterate))
    }

    /// Returns the displacements, with the components of a node together [m].
    pub fn displacement<'a>(&self, state: &'a [f64]) -> &'a [f64] {
        &state[self.layout().displacement]
    }

    /// Largest accumulated plastic strain of all quadrature points [1].
    pub fn max_plastic_strain(&self, state: &[f64]) -> f64 {
        let layout = self.layout();
        let histories = state[layout.history].chunks_exact(layout.of_point);
        histories.map(|history| PlasticHistory::read(history).accumulated).fold(0.0, f64::max)
    }

    /// Returns the energy dissipated by plastic flow, including mirror images [J].
    pub fn plastic_work(&self, state: &[f64]) -> f64 {
        self.dissipated(state, |relaxation| relaxation.is_none())
    }

    /// Returns the energy dissipated by relaxation, including mirror images [J].
    pub fn relaxation_loss(&self, state: &[f64]) -> f64 {
        self.dissipated(state, |relaxation| relaxation.is_some())
    }

    /// Returns the energy dissipated by some layers.
    fn dissipated(&self, state: &[f64], counts: fn(Option<&Relaxation>) -> bool) -> f64 {
        let shapes = &self.grid.kit.shapes;
        let layout = self.layout();
        let mut histories = state[layout.history].chunks_exact(layout.of_point);
        let mut sum = 0.0;
        for layer in 0..self.grid.layers() {
            for e in 0..self.grid.per_layer() {
                for (volume, history) in
                    shapes.volumes(self.grid.place(layer, e)).into_iter().zip(&mut histories)
                {
                    if counts(self.law(layer).relaxation()) {
                        sum += volume * PlasticHistory::read(history).dissipated;
                    }
                }
            }
        }
        sum * self.mesh.copies()
    }

    /// Returns the elastic energy of the body, with that of hardening, including mirror images [J].
    pub fn stored_energy(
        &self,
        state: &[f64],
        temperatures: &[f64],
    ) -> Result<f64, InelasticError> {
        let points = self.points(state, temperatures)?;
        let sum: f64 = points.iter().map(|point| point.volume * point.stored).sum();
        Ok(sum * self.mesh.copies())
    }
}

/// Tangents of the laws after everything has relaxed; `None` if nothing does.
fn after_all_time(laws: &[Arc<dyn FlowLaw>]) -> Option<Vec<PointTangent>> {
    laws.iter().find(|law| law.relaxation().is_some())?;
    let tangent = |law: &Arc<dyn FlowLaw>| {
        let own = law.over_step(law.stress_free_temperature(), 0.0)?;
        let own = PointConstants { reduced_time: f64::INFINITY, ..own };
        let tangent = |relaxation: &Relaxation| relaxation.tangent(&own);
        Some(law.relaxation().map_or_else(|| own.elastic_tangent(), tangent))
    };
    laws.iter().map(tangent).collect()
}

/// Constants that represent all layers: their means at the stress-free temperatures.
fn reference(laws: &[Arc<dyn FlowLaw>]) -> Result<PointConstants, InelasticError> {
    let mut sum: Option<PointConstants> = None;
    for (layer, law) in laws.iter().enumerate() {
        let temperature = law.stress_free_temperature();
        let own = law
            .over_step(temperature, 0.0)
            .ok_or(InelasticError::Constants { layer, temperature })?;
        let (bulk, shear) = sum.map_or((0.0, 0.0), |sum| (sum.bulk, sum.shear));
        sum = Some(PointConstants { bulk: bulk + own.bulk, shear: shear + own.shear, ..own });
    }
    let count = laws.len() as f64;
    let what = "the list of laws";
    let sum = sum.ok_or(InelasticError::Length { what, given: 0, wanted: 1 })?;
    Ok(PointConstants { bulk: sum.bulk / count, shear: sum.shear / count, ..sum })
}
