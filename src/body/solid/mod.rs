//! Solids: linear heat conduction, exact in time, and thermo-elasticity at every moment.

mod acceptance;
mod advance;
mod crack;
mod cracking;
mod failure;
mod flaw_reading;
mod forecast;
mod front;
mod growing;
mod linear;
mod loads;
mod means;
mod memo;
mod notched;
mod peaks;
mod plan;
mod point;
mod port;
mod reader;
mod rows;
mod sampling;
mod savings;
mod shock;
mod totals;
mod warnings;
mod yielding;

pub use flaw_reading::flaw_quantities;
pub use forecast::{
    BodyForecast, PRODUCT_RATE, ParticleForecast, exchanged_heat_time, forecast_solid,
};
pub use front::may_melt;
pub(super) use loads::BodyLoads;
pub(super) use means::means_of;
pub use peaks::kept_peaks;
pub use plan::plan;
pub(super) use point::Measure;
pub use point::{PointQuantity, point_quantities};
pub(super) use sampling::{PARTS_OF_A_FOOTPRINT, Sampling};
pub use totals::offered_totals;

use std::sync::Arc;

use super::{
    Acts, Body, BodyError, Conductor, Direct, Events, Extreme, Fields, Given, Linear, Memo,
    Reading, Received,
};
use crate::body::{Advice, Approach, Giver, Maxima, Occasion, Resources};
use crate::coupling::FaceMeans;
use crate::inputs::InputLayout;
use crate::laws::{Constants, Material};
use crate::method::fem::{ElasticProblem, HeatFailure, Mesh, NodalSum, Plan, SolidFem, heat_mesh};
use crate::method::mesh::MeshFace;
use crate::runtime::allowance::Allowance;
use crate::scene::{FaceName, PeakOf, Scene, Shape, Solid};
use crate::state::Layout;
use crate::warning::{Finding, Warning};
use crack::Crack;
use cracking::Cracking;
use memo::SolidMemo;
use port::Port;
use reader::SolidReader;
use rows::{Choice, Rows};
use yielding::Yielding;

/// A solid, with the scene's data that concern it.
pub struct SolidBody {
    name: String,
    plan: Plan,
    solid: SolidFem,
    /// Mesh on which heat enters.
    heat_mesh: Mesh,
    /// Length of the thermal part of a state.
    heat_len: usize,
    /// History-dependent mechanics.
    yielding: Option<Yielding>,
    /// Mechanics with cracks.
    cracking: Option<Cracking>,
    loads: BodyLoads,
    ports: Vec<Port>,
    /// Means of fields, by their places among the scene's.
    means: Vec<(usize, FaceMeans)>,
    /// Readings by influence rows.
    rows: Rows,
    shape: Shape,
    /// Flaws, each with its place among the scene's.
    cracks: Vec<(usize, Crack)>,
    /// Stress intensities of these as sums over nodes, if many flaws share the stresses there.
    flaw_sums: Vec<Option<NodalSum>>,
    /// Quantities with running maxima.
    peaks: Vec<PeakOf>,
    /// Largest shear modulus of the layers at the start [Pa]; `None` if nothing mechanical is known.
    shear_modulus: Option<f64>,
    /// True if a face has a prescribed temperature, which may jump.
    prescribes_temperature: bool,
    /// Relative tolerance of outputs.
    tolerance: f64,
    threads: usize,
}

/// With fewer flaws, stress at their own points takes less than stress at all nodes.
const FLAWS_WORTH_NODES: usize = 64;
/// Solids with fewer nodes run faster on one thread.
const NODES_WORTH_THREADS: usize = 20_000;

/// Returns true if more than one thread is worthwhile.
pub fn is_large(plan: &Plan) -> bool {
    plan.mesh.nodes() >= NODES_WORTH_THREADS
}

impl SolidBody {
    pub fn new(
        scene: &Scene,
        layout: &InputLayout,
        (name, solid): (&str, &Solid),
        linked: &[FaceName],
        threads: impl Fn(bool) -> usize,
    ) -> Result<Self, BodyError> {
        let plan = plan(scene, name, solid);
        let threads = threads(is_large(&plan));
        let fem = SolidFem::new(&plan, threads);
        let loads = BodyLoads::of(scene, layout, (name, solid.shape), &plan);
        let rings = |face| face == FaceName::Top && scene.meets_rings(name);
        let port = |&face: &FaceName| Port::new(face, &plan, &fem, rings(face));
        let ports = linked.iter().map(port).collect();
        let yielding = Yielding::of(&plan, scene.fidelity.tolerance, threads)?;
        let cracking = Cracking::of(&plan, threads);
        let heat_mesh = heat_mesh(&plan);
        let means = means_of(scene, (name, solid), [&heat_mesh, fem.mesh()]);
        let cracks = Crack::of_scene(scene, (name, solid), &plan);
        let choice = Choice::of(scene, (name, solid), &plan);
        let rows = Rows::new(choice, &fem, &means, &cracks);
        let by_nodes =
            cracks.len() >= FLAWS_WORTH_NODES && yielding.is_none() && cracking.is_none();
        let sums = cracks.iter().filter(|_| by_nodes).map(|(_, crack)| crack.nodal_sum(&fem));
        let flaw_sums = sums.collect();
        Ok(Self {
            name: name.into(),
            means,
            rows,
            heat_mesh,
            heat_len: fem.state_len(),
            plan,
            solid: fem,
            yielding,
            cracking,
            loads,
            ports,
            shape: solid.shape,
            cracks,
            flaw_sums,
            peaks: solid.peaks.clone(),
            shear_modulus: shear_modulus(solid),
            prescribes_temperature: solid.faces.values().any(|face| face.temperature.is_some()),
            tolerance: scene.fidelity.tolerance,
            threads,
        })
    }

    /// Prepares the body to be read in this number of states; if they are too few for rows, each reading uses a
    /// solution.
    pub fn read_in_states(self, count: usize) -> Self {
        match self.rows.pay_in(count) {
            true => self,
            false => Self { rows: Rows::default(), ..self },
        }
    }

    fn error(&self, failure: HeatFailure) -> BodyError {
        let body = self.name.clone();
        match failure {
            HeatFailure::Halted(halt) => BodyError::Halted { body, halt },
            HeatFailure::Nonlinear(failure) => BodyError::Heat { body, failure },
        }
    }

    /// Means of a field, by its place among the scene's.
    fn means(&self, field: usize) -> &FaceMeans {
        let found = self.means.iter().find(|(place, _)| *place == field);
        &found.expect("means are registered for fields of cells").1
    }

    fn own_layout(&self) -> Layout {
        let yielding = self.yielding.as_ref().map(Yielding::layout);
        let mechanics = yielding.or(self.cracking.as_ref().map(Cracking::layout));
        let layout = self.solid.layout().then(mechanics.unwrap_or_default());
        layout.then(self.layout_of_growth()).then(self.layout_of_flaws())
    }

    /// Meshes on which heat and forces act.
    fn meshes(&self) -> [&Mesh; 2] {
        [&self.heat_mesh, self.solid.mesh()]
    }

    /// Refuses unknowns that are not numbers, and temperatures that are not above absolute zero. By the maximum
    /// principle only a flux out of the body can cause such temperatures, so nothing is computed without one.
    fn check_end(&self, state: &[f64], start: &[f64], end: &[f64]) -> Result<(), BodyError> {
        if !state.iter().all(|value| value.is_finite()) {
            return Err(BodyError::Overflow { body: self.name.clone() });
        }
        if !self.loads.draws_heat(start) && !self.loads.draws_heat(end) {
            return Ok(());
        }
        let loads = self.loads.of_faces(end, self.solid.mesh());
        let temperatures = self.solid.temperatures(self.heat_of(state), &loads);
        let temperature = self.solid.min_temperature(&temperatures);
        match temperature <= 0.0 {
            true => Err(BodyError::BelowAbsoluteZero { body: self.name.clone(), temperature }),
            false => Ok(()),
        }
    }
}

impl Body for SolidBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        let (nodes, start) = (self.solid.mesh().nodes(), self.solid.initial_temperature());
        let mechanics = self.yielding.as_ref().map(|yielding| yielding.initial_state(nodes, start));
        let rise = -self.plan.stress_free_rise;
        let cracks = self.cracking.as_ref().map(|cracking| cracking.initial_state(rise));
        let mechanics = mechanics.or(cracks).into_iter().flatten();
        let heat = self.solid.initial_state().into_iter();
        let noted = self.start_of_growth().into_iter().chain(self.nothing_noted());
        heat.chain(mechanics).chain(noted).collect()
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        Some(self.own_layout()).filter(|layout| layout.len() == state.len())
    }

    fn check_state(&self, state: &[f64], inputs: &[f64]) -> Result<(), String> {
        match self.own_layout().len() {
            wanted if wanted == state.len() => {
                self.check_heat(state, inputs)?;
                let cracks = self.cracking.as_ref();
                cracks.map_or(Ok(()), |cracks| cracks.check(self.mechanics_of(state)))?;
                self.check_growth(state)?;
                self.check_flaws(state)
            }
            wanted => {
                Err(format!("{} unknowns of {}; this body has {wanted}", state.len(), self.name))
            }
        }
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.loads.check(inputs)
    }

    fn memo(&self, inputs: &[f64], received: &[Received]) -> Memo {
        let outside = self.loads.assemble(inputs, self.meshes());
        let mut memo = SolidMemo::new(outside);
        for Received { face, given } in received {
            self.port(*face).add(memo.received(), given);
        }
        Box::new(memo)
    }

    fn carry_over(&self, from: Memo, to: &mut Memo) {
        SolidMemo::of_mut(to).carry_over(SolidMemo::taken(from));
    }

    fn forget_state(&self, memo: &mut Memo) {
        SolidMemo::of_mut(memo).forget_state();
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        memo: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let memo = SolidMemo::of(memo);
        let before = self.heat_balance(state);
        let heat = |heat: &mut [f64], acts: &Acts| self.advance_here(heat, memo, acts, allowance);
        match (&self.yielding, &self.cracking) {
            (Some(yielding), _) => self.advance_yielding(yielding, state, acts, allowance, heat)?,
            (None, Some(cracking)) => {
                self.advance_cracking(cracking, state, acts, allowance, heat)?;
            }
            (None, None) => heat(&mut state[..self.heat_len], acts)?,
        }
        let (start, end) = (acts.path.start(), acts.path.at(0, acts.duration));
        self.check_end(state, start, &end)?;
        self.check_step(before, state)?;
        Ok(None)
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let mut reader = SolidReader { body: self, state, memo: SolidMemo::of_mut(memo) };
        match *reading {
            Reading::Point { quantity, at, alone } => {
                point_quantities()[quantity].read(&mut reader, at, alone)
            }
            Reading::Mean { quantity, field, cell } => {
                point_quantities()[quantity].mean(&mut reader, (field, cell))
            }
            Reading::Total(place) => totals::read(&mut reader, place),
            Reading::Flaw { flaw, quantity } => flaw_reading::read(&mut reader, flaw, quantity),
            Reading::Peak { .. } | Reading::Cell { .. } | Reading::Error => {
                Err(BodyError::NoSuchReading)
            }
        }
    }

    fn follows_at_once(&self, reading: &Reading) -> bool {
        let direct = match *reading {
            Reading::Point { quantity, .. } | Reading::Mean { quantity, .. } => {
                point_quantities()[quantity].descriptor.direct
            }
            // Before risks are noted, they are the present ones.
            Reading::Total(place) if totals::is_risk(place) => return true,
            Reading::Total(place) => totals::direct(place),
            Reading::Flaw { .. } => Direct::TemperaturesAndTractions,
            // Before a maximum is noted, it equals the present value.
            Reading::Peak { .. } => return true,
            Reading::Cell { .. } | Reading::Error => Direct::Nothing,
        };
        direct != Direct::Nothing
    }

    fn fields(&self, state: &[f64], memo: &mut Memo) -> Result<Fields, BodyError> {
        Ok(Fields::Nodes(SolidMemo::of_mut(memo).fields(self, state)?))
    }

    fn linear(&self) -> Option<&dyn Linear> {
        let has_history = self.yielding.is_some() || self.cracking.is_some();
        if !self.solid.conducts_linearly() || has_history {
            return None;
        }
        Some(self)
    }

    fn conductor(&self) -> Option<&dyn Conductor> {
        Some(self)
    }
}

impl Giver for SolidBody {}

impl Events for SolidBody {
    fn has_events(&self) -> bool {
        self.cracking.is_some()
    }

    /// An event is a crack that is not part of an earlier one.
    fn event_between(&self, before: &[f64], after: &[f64]) -> bool {
        self.has_new_crack(before, after)
    }
}

impl Maxima for SolidBody {
    fn peaks(&self) -> usize {
        self.peaks.len()
    }

    fn observe(&self, state: &[f64], memo: &mut Memo, which: usize) -> Result<Extreme, BodyError> {
        let memo = SolidMemo::of_mut(memo);
        self.highest(&mut SolidReader { body: self, state, memo }, which)
    }

    fn observe_at_beginning(
        &self,
        (state, inputs): (&[f64], &[f64]),
        memo: &mut Memo,
        which: usize,
        so_far: Option<Extreme>,
    ) -> Result<Extreme, BodyError> {
        if !self.holds_at_beginning(which) {
            let memo = SolidMemo::of_mut(memo).before_jump();
            return self.highest(&mut SolidReader { body: self, state, memo }, which);
        }
        if self.yielding.is_some() && self.is_stress_peak(which) {
            let memo = SolidMemo::of_mut(memo);
            memo.deform_at_once(self, state)?;
            return self
                .highest(&mut SolidReader { body: self, state, memo: memo.at_once() }, which);
        }
        let now = self.observe(state, memo, which)?;
        let jumps = self.prescribes_temperature;
        Ok(if jumps { self.possible_after_jump(now, (state, inputs), memo, so_far) } else { now })
    }

    fn holds_at_beginning(&self, which: usize) -> bool {
        !(self.prescribes_temperature && self.is_stress_peak(which))
    }

    fn keeps_field(&self) -> bool {
        self.solid.flaws().is_some() || self.has_growing_flaws()
    }

    fn field_holds_at_beginning(&self, state: &[f64]) -> bool {
        !self.prescribes_temperature || self.is_before_first_note(state)
    }

    fn is_of_field(&self, state: &[f64], at: usize) -> bool {
        let length = self.layout_of_growth().len() + self.layout_of_flaws().len();
        at + length >= state.len()
    }

    fn observe_field(
        &self,
        state: &[f64],
        memo: &mut Memo,
        duration: Option<f64>,
    ) -> Result<(), BodyError> {
        if self.yielding.is_some() && duration.is_none() && !self.prescribes_temperature {
            SolidMemo::of_mut(memo).deform_at_once(self, state)?;
        }
        let memo = self.memo_to_note(memo, duration);
        self.observe_growth(state, memo)?;
        self.observe_flaws(state, memo)
    }

    fn note_field(&self, state: &mut [f64], memo: &mut Memo, duration: Option<f64>) {
        SolidMemo::of_mut(memo).forget_risk();
        let memo = self.memo_to_note(memo, duration);
        let lasts = duration.is_some() || !self.prescribes_temperature;
        let duration = lasts.then_some(duration.unwrap_or(0.0));
        self.note_growth_of_flaws(state, memo, duration);
        self.note_flaws(state, memo, duration);
    }

    fn check_peak(&self, which: usize, peak: &Extreme) -> Result<(), String> {
        self.check_highest(which, peak)
    }
}

impl Approach for SolidBody {}

impl SolidBody {
    /// The memo whose stress is noted. As a step begins, prescribed temperatures have not acted yet.
    fn memo_to_note<'m>(&self, memo: &'m mut Memo, duration: Option<f64>) -> &'m mut SolidMemo {
        let memo = SolidMemo::of_mut(memo);
        match duration {
            Some(_) => memo,
            None if self.prescribes_temperature => memo.before_jump(),
            None => memo.at_once(),
        }
    }

    /// Returns true if nothing has been noted of a field.
    fn is_before_first_note(&self, state: &[f64]) -> bool {
        match self.solid.flaws() {
            Some(_) => !self.has_noted_flaws(state),
            None => !self.has_noted_growth(state),
        }
    }
}

/// Largest shear modulus of the layers of a solid at the start [Pa].
fn shear_modulus(solid: &Solid) -> Option<f64> {
    let materials = solid.materials_of_layers().into_iter();
    let modulus = |own: &Material| {
        let Constants { young, poisson, .. } = own.at(solid.initial_temperature);
        Some(0.5 * young? / (1.0 + poisson?))
    };
    materials.filter_map(modulus).reduce(f64::max)
}

impl Advice for SolidBody {
    fn warning_on_value(&self, reading: &Reading, value: f64) -> Option<Warning> {
        warnings::of_large_strain(self, reading, value)
            .or_else(|| warnings::of_worst_depth(self, reading, value))
    }

    fn resolved_from(&self) -> f64 {
        self.plan.resolved_from
    }

    fn notes(&self) -> Vec<String> {
        let fallback = self.solid.fallback_particles().filter(|&count| count > 0).map(|count| {
            format!(
                "{count} of {} particles conduct by the plain operator: their corrected one is near \
                 singular",
                self.plan.mesh.nodes()
            )
        });
        let notes = self.plan.notes.iter().cloned().chain(fallback);
        notes.map(|note| format!("{}: {note}", self.name)).collect()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        let warning = |finding: Finding| finding.at(&self.name).whatever_its_numbers();
        match occasion {
            Occasion::Step => {
                let particles = warnings::of_particles(self, state);
                let torn = warnings::of_torn_parts(self, state);
                let rim = warnings::of_rim(self);
                let own = particles.into_iter().chain(torn).chain(rim).map(warning);
                own.chain(warnings::of_flaws(self, state)).collect()
            }
            Occasion::Response { .. } => Vec::new(),
            Occasion::End => {
                let even = warnings::of_even_damage(self, state);
                warnings::of_fronts(self, state).into_iter().chain(even).map(warning).collect()
            }
        }
    }

    fn temperature_range(&self, state: &[f64], inputs: &[f64]) -> Option<[f64; 2]> {
        let loads = self.loads.of_faces(inputs, self.solid.mesh());
        let is_lateral = |(face, _): &(MeshFace, _)| face.axis < 2;
        if self.solid.conducts_linearly() && !self.plan.thermal_faces.iter().any(is_lateral) {
            // Heat that passes top and bottom alone leaves no place warmer or colder than these and the start.
            let start = self.plan.initial_temperature;
            let [lowest, highest] = self.solid.range_of_ends(self.heat_of(state), &loads);
            return Some([lowest.min(start), highest.max(start)]);
        }
        let temperatures = self.solid.temperatures(self.heat_of(state), &loads);
        let highest = self.solid.hottest(&temperatures).value;
        Some([self.solid.min_temperature(&temperatures), highest])
    }
}

impl Resources for SolidBody {
    fn is_deep(&self, memo: Option<&Memo>, reading: &Reading) -> bool {
        let memo = memo.map(SolidMemo::of);
        let solved = memo.is_some_and(SolidMemo::is_solved);
        match *reading {
            // Rows are solved for on another stack.
            Reading::Point { quantity, at, .. } => {
                let quantity = &point_quantities()[quantity];
                !solved && quantity.is_mechanical() && !self.rows.give(quantity, at)
            }
            Reading::Mean { quantity, field, cell } => {
                let quantity = &point_quantities()[quantity];
                !solved && quantity.is_mechanical() && !self.rows.give_mean(quantity, (field, cell))
            }
            Reading::Flaw { flaw, .. } => !solved && !self.rows.give_flaw(flaw),
            Reading::Total(place) if totals::is_risk(place) => {
                memo.is_none_or(|memo| memo.observed().is_empty())
            }
            Reading::Total(place) => {
                totals::is_mechanical(place) && !memo.is_some_and(SolidMemo::has_max_stress)
            }
            Reading::Peak { which, .. } => {
                self.is_stress_peak(which) && !memo.is_some_and(SolidMemo::has_max_stress)
            }
            Reading::Cell { .. } | Reading::Error => false,
        }
    }

    fn stiffness(&self) -> Option<Arc<ElasticProblem>> {
        self.solid.stiffness()
    }

    fn factor_entries(&self) -> usize {
        self.solid.factor_entries()
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        let notes_stress = self.peaks.iter().any(PeakOf::is_mechanical) || self.keeps_field();
        let has_history = self.yielding.is_some() || self.cracking.is_some();
        has_history || !self.solid.conducts_linearly() || notes_stress
    }
}
