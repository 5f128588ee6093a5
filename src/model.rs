//! From scene to [`Model`] (what is known before time starts) and [`State`] (all that changes).

mod cache;
mod error;
mod events;
mod joints;
mod memory;
mod parts;
mod peaks;
mod reader;
mod schedule;
mod sharing;
mod start_rates;
mod states;
mod step_length;
mod tangent;
mod timeline;
pub mod tolerance;
mod warnings;

pub use cache::Cache;
pub use error::ModelError;
pub use memory::{check_memory, check_room_to_read};
pub use peaks::Peak;
use peaks::When;
pub use reader::Reader;
pub use start_rates::start_rates;
pub use step_length::check_step_length;
pub use tangent::Tangent;
pub use timeline::Timeline;

use std::sync::Arc;

use crate::body::{Assembly, Body, Fields, Joint, Link, Readings};
pub use crate::body::{
    BodyError, BodyForecast, DropletForecast, Forecast, Kept, KeptReduction, ParticleForecast,
    forecast, keep_record, keep_reduction, notes_on_walls, records, to_be_recorded,
};
pub use crate::inputs::HIGHEST_INPUT_DERIVATIVE;
use crate::inputs::{InputLayout, InputPath};
use crate::method::fem::ElasticProblem;
pub use crate::method::fem::NodalFields;
pub use crate::method::sph::ParticleFields;
use crate::runtime::allowance::{Allowance, Interrupt};
use crate::runtime::made_once::MadeOnce;
use crate::runtime::thread::aside;
use crate::scene::{self, Scene};
use crate::variables::{Output, Registry, Slot};
use memory::threads_that_fit;
use schedule::Group;
use tolerance::Resolved;
use tolerance::choice::Choice;

/// Everything known before time starts: the bodies and the schedule of their exchanges.
pub struct Model {
    scene: Scene,
    layout: InputLayout,
    /// In the order of their names.
    bodies: Vec<Box<dyn Body>>,
    links: Vec<Link>,
    joints: Vec<Joint>,
    schedule: Vec<Group>,
    /// For each running maximum, the place of its body and its number within the body.
    peaks: Vec<(usize, usize)>,
    /// Largest memory of a step that is made on a thread of its own [B].
    memory_of_steps: usize,
    /// Chosen meshes, kept for models that need the same.
    #[expect(dead_code, reason = "held for others")]
    choices: Vec<Arc<Choice>>,
    /// Relative errors of the outputs of each body, estimated when first read.
    errors: Vec<MadeOnce<f64>>,
}

/// All that changes, as plain data: a saved state is a clone of this.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// [s]
    pub time: f64,
    /// Values of the inputs, in the order of the [`InputLayout`].
    pub inputs: Vec<f64>,
    /// Time derivatives of the inputs at this time: the first of all inputs [1/s], then the second [1/s²], if set.
    /// Without any, inputs are constant.
    pub derivatives: Vec<Vec<f64>>,
    /// Unknowns of each body, in the order of their names. Their number grows in a droplet when a drop is released.
    pub bodies: Vec<Vec<f64>>,
    /// Running maxima, body by body in the order of their lists; none before the first is noted, then a mark for each that
    /// is not noted yet.
    pub peaks: Vec<Peak>,
}

/// Elastic problems of several bodies.
pub type Stiffness = Vec<Arc<ElasticProblem>>;

impl Model {
    /// Builds meshes and modes; `threads` = 0 lets the program choose.
    pub fn build(scene: &Scene, threads: usize) -> Result<Self, ModelError> {
        let Resolved { scene, choices } = tolerance::resolve(scene);
        Ok(Self { choices, ..aside(|| Self::build_here(&scene, threads, Readings::Usual))? })
    }

    /// Builds the model on the mesh that follows from the scene's keys alone.
    fn build_as_it_is(scene: &Scene, threads: usize) -> Result<Self, ModelError> {
        aside(|| Self::build_here(scene, threads, Readings::Usual))
    }

    /// Builds the model to be read in this number of states.
    fn build_for_states(scene: &Scene, threads: usize, count: usize) -> Result<Self, ModelError> {
        aside(|| Self::build_here(scene, threads, Readings::OfStates(count)))
    }

    fn build_here(scene: &Scene, threads: usize, readings: Readings) -> Result<Self, ModelError> {
        let layout = InputLayout::of(scene);
        let start = initial_inputs(scene);
        let Assembly { bodies, links, joints } = crate::body::build(
            scene,
            (&layout, &start),
            [threads, threads_that_fit(scene)],
            readings,
        )?;
        let pairs: Vec<_> =
            joints.iter().map(|joint| joint.sides.each_ref().map(|side| side.body)).collect();
        let schedule = Group::all(bodies.len(), &links, &pairs);
        let places = bodies.iter().enumerate();
        let peaks = places.flat_map(|(place, body)| (0..body.peaks()).map(move |n| (place, n)));
        let peaks = peaks.collect();
        Ok(Self {
            scene: scene.clone(),
            layout,
            bodies,
            links,
            joints,
            schedule,
            peaks,
            memory_of_steps: forecast(scene).memory_of_steps() as usize,
            choices: Vec::new(),
            errors: scene.body.keys().map(|_| MadeOnce::new()).collect(),
        })
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub fn layout(&self) -> &InputLayout {
        &self.layout
    }

    /// Returns the state at time zero, with inputs at their start values.
    pub fn initial_state(&self) -> State {
        let bodies = aside(|| self.bodies.iter().map(|body| body.initial_state()).collect());
        let inputs = initial_inputs(&self.scene);
        State { time: 0.0, inputs, derivatives: Vec::new(), bodies, peaks: Vec::new() }
    }

    /// Checks all inputs: they must be finite, temperatures above absolute zero, footprints on their faces and within
    /// their ranges.
    pub fn check_inputs(&self, inputs: &[f64]) -> Result<(), ModelError> {
        // Without an early exit the loop is vectorised.
        let all_finite = inputs.iter().fold(true, |fine, value| fine & value.is_finite());
        if !all_finite && let Some(index) = inputs.iter().position(|value| !value.is_finite()) {
            let message = format!("{} is not a finite number", inputs[index]);
            return Err(BodyError::Input { index, message }.into());
        }
        Ok(self.bodies.iter().try_for_each(|body| body.check_inputs(inputs))?)
    }

    /// Advances by `dt` [s]. Inputs follow their derivatives over the step, or are constant without any; the state ends
    /// with their values and derivatives at that time. An error changes nothing.
    pub fn step(&self, state: &mut State, cache: &mut Cache, dt: f64) -> Result<(), ModelError> {
        self.step_unless(&Interrupt::default(), state, cache, dt)
    }

    /// Advances like [`Self::step`], unless it is interrupted, which changes nothing either.
    pub fn step_unless(
        &self,
        interrupt: &Interrupt,
        state: &mut State,
        cache: &mut Cache,
        dt: f64,
    ) -> Result<(), ModelError> {
        self.step_within(&Allowance::of_step(interrupt), state, cache, (dt, dt))
    }

    /// Advances within an allowance of work.
    pub fn step_within(
        &self,
        allowance: &Allowance,
        state: &mut State,
        cache: &mut Cache,
        (dt, ahead): (f64, f64),
    ) -> Result<(), ModelError> {
        check_step_length(dt)?;
        self.expect_room_to_step(state)?;
        self.check_inputs(&state.inputs)?;
        let path = InputPath::new(&state.inputs, &state.derivatives);
        for s in path.turns(dt).into_iter().chain((!path.is_held()).then_some(dt)) {
            self.check_underway(&path.at(0, s), s)?;
        }
        self.with_stack(|| self.step_here(allowance, state, cache, (&path, dt, ahead)))
    }

    fn step_here(
        &self,
        allowance: &Allowance,
        state: &mut State,
        cache: &mut Cache,
        (path, dt, ahead): (&InputPath, f64, f64),
    ) -> Result<(), ModelError> {
        let mut next = state.clone();
        // Jumps of inputs act before any heat has moved.
        self.note_peaks_here(&mut next, cache, When::Beginning).map_err(|(_, error)| error)?;
        cache.update(self, state);
        let bodies = self.bodies.iter().zip(&mut next.bodies);
        let approached: Vec<_> = bodies
            .flat_map(|(body, unknowns)| body.approached(unknowns, path, (dt, ahead)))
            .collect();
        let changed = (!approached.is_empty()).then(|| path.with(&approached));
        let taken = changed.as_ref().unwrap_or(path);
        self.advance(&mut next.bodies, cache, (taken, dt), allowance)?;
        next.time += dt;
        if path.is_held() {
            next.derivatives.clear();
        } else {
            let rest = path.from(dt);
            let (inputs, derivatives) =
                rest.derivatives().split_first().expect("inputs stand first");
            (next.inputs, next.derivatives) = (inputs.clone(), derivatives.to_vec());
        }
        cache.forget_states(self);
        if let Err((place, error)) =
            self.note_peaks_here(&mut next, cache, When::End { duration: dt })
        {
            // The cache follows from a state that is discarded.
            cache.clear();
            let body = self.bodies[place].name().to_owned();
            let is_too_large = matches!(error, BodyError::NotFinite(_));
            return Err(if is_too_large { BodyError::Overflow { body } } else { error }.into());
        }
        *state = next;
        Ok(())
    }

    /// Runs `work` on a thread of our own if steps need more stack than a host's thread has to provide.
    fn with_stack<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self.bodies.iter().any(|body| body.steps_are_deep()) {
            true => aside(work),
            false => work(),
        }
    }

    fn check_underway(&self, inputs: &[f64], after: f64) -> Result<(), ModelError> {
        self.check_inputs(inputs).map_err(|error| match error {
            ModelError::Body(error) => error.underway(after).into(),
            other => other,
        })
    }

    /// The value of an output in a state.
    pub fn output(
        &self,
        state: &State,
        cache: &mut Cache,
        output: &Output,
    ) -> Result<f64, ModelError> {
        self.reader(state, cache)?.value(output)
    }

    /// Updates the cache to a state whose inputs are valid.
    pub fn refresh(&self, state: &State, cache: &mut Cache) {
        cache.update(self, state);
    }

    /// Reads several outputs of a state; checks the inputs once for all of them.
    pub fn reader<'a>(
        &'a self,
        state: &'a State,
        cache: &'a mut Cache,
    ) -> Result<Reader<'a>, ModelError> {
        self.check_inputs(&state.inputs)?;
        cache.update(self, state);
        Ok(Reader { model: self, state, cache })
    }

    /// Values at all nodes or particles of a body.
    pub fn fields(
        &self,
        state: &State,
        cache: &mut Cache,
        body: &str,
    ) -> Result<Fields, ModelError> {
        self.check_inputs(&state.inputs)?;
        cache.update(self, state);
        let place = self.place(body);
        let fields = self.bodies[place].fields(&state.bodies[place], cache.memo(place))?;
        if let Fields::Nodes(fields) = &fields {
            fields.values().try_for_each(|value| BodyError::unless_finite(value).map(drop))?;
        }
        Ok(fields)
    }

    /// Values of all particles of a droplet, including mirror images.
    ///
    /// # Panics
    /// If the body has no particles.
    pub fn particle_fields(&self, state: &State, body: &str) -> ParticleFields {
        let place = self.place(body);
        let mut memo = self.bodies[place].memo(&state.inputs, &[]);
        match self.bodies[place].fields(&state.bodies[place], &mut memo) {
            Ok(Fields::Particles(fields)) => fields,
            _ => panic!("{body} has no particles"),
        }
    }

    /// Values at all nodes of a solid.
    ///
    /// # Panics
    /// If the body has no nodes.
    pub fn nodal_fields(
        &self,
        state: &State,
        cache: &mut Cache,
        body: &str,
    ) -> Result<NodalFields, ModelError> {
        match self.fields(state, cache, body)? {
            Fields::Nodes(fields) => Ok(fields),
            Fields::Particles(_) => panic!("{body} has no nodes"),
        }
    }

    /// Returns true if a body's nodes are those of a meridian section.
    pub fn is_axisymmetric(&self, body: &str) -> bool {
        self.scene.body.get(body).is_some_and(scene::Body::is_round)
    }

    /// Largest number of threads that any body may use.
    pub fn threads(&self) -> usize {
        self.bodies.iter().map(|body| body.threads()).max().unwrap_or(1)
    }

    /// Returns the elastic problems of its bodies; models that differ only in thermal data share them while they are
    /// held.
    pub fn stiffness(&self) -> Stiffness {
        self.bodies.iter().filter_map(|body| body.stiffness()).collect()
    }

    /// Stored entries of all factorisations made so far.
    pub fn factor_entries(&self) -> usize {
        self.bodies.iter().map(|body| body.factor_entries()).sum()
    }

    /// Estimate of the largest relative error of a body's outputs over the default experiment, caused by its mesh [1];
    /// −1 without an estimate.
    pub fn estimated_error(&self, place: usize) -> f64 {
        let Some(name) = self.scene.body.keys().nth(place) else { return NO_ESTIMATE };
        let known = self.scene.refinement.get(name).and_then(|factors| factors.estimated_error);
        *self.errors[place].get_or_make(|| {
            known
                .or_else(|| tolerance::estimate_of(&self.scene, name).worst())
                .unwrap_or(NO_ESTIMATE)
        })
    }

    /// Returns the name and the reduction of each reduced body. Other models that need the same reduction find it while
    /// this is held.
    pub fn reductions(&self) -> Vec<(String, KeptReduction)> {
        let bodies = self.bodies.iter();
        bodies.filter_map(|body| Some((body.name().to_owned(), body.reduction()?))).collect()
    }

    /// Returns notes on choices and simplifications, with reasons: one sentence each.
    pub fn notes(&self) -> Vec<String> {
        self.bodies.iter().flat_map(|body| body.notes()).collect()
    }

    fn place(&self, body: &str) -> usize {
        let known = self.bodies.iter().position(|b| b.name() == body);
        known.expect("asked for by the name of a body of the scene")
    }
}

/// Value of an error that is not estimated.
const NO_ESTIMATE: f64 = -1.0;

/// Start values of all inputs, in the order of the layout.
pub fn initial_inputs(scene: &Scene) -> Vec<f64> {
    let mut inputs = vec![0.0; InputLayout::of(scene).len];
    for variable in Registry::inputs(scene) {
        if let (Slot::Input(at), Some(value)) = (&variable.slot, variable.real_start()) {
            inputs[*at] = value;
        }
    }
    inputs
}
