//! From scene to [`Model`] (what is known before time starts) and [`State`] (all that changes).

mod cache;
mod contact;
mod droplet_forecast;
mod droplets;
mod exchange;
mod forecast;
mod interpolation;
mod loads;
mod memory;
mod parts;
mod reader;
mod reality;
mod sharing;
mod start_rates;
mod states;
mod tangent;
mod timeline;

pub use cache::Cache;
use contact::Contact;
pub use droplet_forecast::DropletForecast;
use droplets::DropletModel;
pub use droplets::notes_on_walls;
use forecast::droplet_forecasts;
pub use forecast::{BodyForecast, Forecast, ParticleForecast, forecast};
pub use interpolation::HIGHEST_INPUT_DERIVATIVE;
use interpolation::InputPath;
use loads::BodyLoads;
pub use memory::check_memory;
use memory::threads_that_fit;
pub use reader::Reader;
use reality::finite;
pub use start_rates::start_rates;
pub use tangent::Tangent;
pub use timeline::Timeline;

use crate::material::stress::{max_principal, von_mises};
use crate::math::address_space::TooLittle;
use crate::math::allowance::{Allowance, Halt, Interrupt};
use crate::math::cholesky::SolverError;
use crate::math::thread::aside;
pub use crate::method::fem::NodalFields;
use crate::method::fem::{Geometry, Mechanics, Plan, Refinement, SolidFem};
pub use crate::method::sph::ParticleFields;
use crate::method::sph::{DropletSph, Failure};
use crate::scene::{Carries, Droplet, FaceName, Footprint, Grid, Load, Scene, SceneError, Solid};
use crate::variables::{BodyTotal, Component, InputLayout, Output, Registry, Slot};

/// Everything known before time starts: meshes, modes, factorisations, places of outputs.
pub struct Model {
    scene: Scene,
    layout: InputLayout,
    /// The solids, in the order of their names.
    bodies: Vec<BodyModel>,
    /// In the order of their names.
    droplets: Vec<DropletModel>,
    grids: Vec<Grid>,
    threads: usize,
    /// What a step of the droplets takes, at most [B].
    memory_of_droplets: usize,
}

/// One body and what of the scene concerns it.
struct BodyModel {
    name: String,
    plan: Plan,
    solid: SolidFem,
    loads: BodyLoads,
}

/// All that changes, as plain data: a saved state is a clone of this.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// [s]
    pub time: f64,
    /// Values of the inputs, in the order of the [`InputLayout`].
    pub inputs: Vec<f64>,
    /// Time derivatives of the inputs at this time: the first of all inputs [1/s], then the second
    /// [1/s²], as far as there are any. Without any, inputs are held.
    pub derivatives: Vec<Vec<f64>>,
    /// Unknowns of each body: solids, then droplets, each in the order of their names. Those of a
    /// droplet grow in number when a drop is released.
    pub bodies: Vec<Vec<f64>>,
}

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// An input is out of place; `index` is its place among the state's inputs.
    #[error("{message}")]
    Input { index: usize, message: String },
    /// An input goes out of place in the course of a step, `after` seconds.
    #[error("{message}, {after:e} s into the step")]
    Underway { index: usize, message: String, after: f64 },
    /// The results of a step are too large for numbers.
    #[error("the solution of {body} grows beyond what numbers can hold")]
    Overflow { body: String },
    /// A step would cool a body below absolute zero.
    #[error(
        "{body} would cool to {temperature:.6} K, below absolute zero: a negative heat flux takes more \
         heat from it than it holds"
    )]
    BelowAbsoluteZero { body: String, temperature: f64 },
    /// An output is too large for numbers.
    #[error(
        "the value is {0}, beyond what numbers can hold: an input or constant is far too large"
    )]
    NotFinite(f64),
    /// A state does not fit the model.
    #[error("{0}")]
    State(String),
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Solver(#[from] SolverError),
    /// A step of a droplet has no physical meaning.
    #[error("{name}: {failure}")]
    Droplet { name: String, failure: Failure },
    /// A scene is too large for the machine.
    #[error(
        "this needs about {:.3e} MB of memory, most of it for `{body}` with its {size}; this process can \
         have {:.3e} MB (allowed: a scene that fits, such as with {remedy})",
        needed / 1e6,
        available / 1e6
    )]
    Memory { needed: f64, available: f64, body: String, size: String, remedy: &'static str },
    /// A scene is too large for what the process may take of address space.
    #[error(
        "{space}, most of it for `{body}` with its {size} (allowed: a scene that fits, such as with {remedy}, or \
         more address space)"
    )]
    Space { space: TooLittle, body: String, size: String, remedy: &'static str },
    /// What is asked for takes more address space than the process may have.
    #[error(transparent)]
    NoRoom(#[from] TooLittle),
    /// A step was ended before it was done.
    #[error("{body}: {halt}")]
    Halted { body: String, halt: Halt },
    /// What a droplet gives has no derivative in time.
    #[error("what a droplet gives is known step by step: it has no derivative in time")]
    NoRate,
}

/// Models with fewer nodes or particles than these are quicker on one thread.
const NODES_WORTH_THREADS: usize = 20_000;
const PARTICLES_WORTH_THREADS: usize = 2_000;

impl Model {
    /// Builds meshes, modes and factorisations; `threads` = 0 lets the program choose.
    pub fn build(scene: &Scene, threads: usize) -> Result<Self, ModelError> {
        aside(|| Self::build_here(scene, threads))
    }

    fn build_here(scene: &Scene, threads: usize) -> Result<Self, ModelError> {
        let layout = InputLayout::of(scene);
        let most = threads_that_fit(scene);
        let resolve_threads = |wanted, is_large| resolve_threads(wanted, is_large).min(most);
        let mut bodies = Vec::new();
        let mut most_threads = 1;
        for (name, body) in scene.solids() {
            let plan = plan(scene, name, body);
            let threads = resolve_threads(threads, plan.mesh.nodes() >= NODES_WORTH_THREADS);
            most_threads = most_threads.max(threads);
            let solid = SolidFem::new(&plan, threads)?;
            let loads = BodyLoads::of(scene, &layout, (name, body.shape), &plan);
            bodies.push(BodyModel { name: name.into(), plan, solid, loads });
        }
        let mut droplets = Vec::new();
        for (name, droplet) in scene.droplets() {
            let (particles, time_step) =
                DropletSph::forecast(&droplets::plan_of(droplet, None, None));
            let threads = resolve_threads(threads, particles >= PARTICLES_WORTH_THREADS);
            most_threads = most_threads.max(threads);
            let contact = contact_of(scene, (name, droplet), &bodies, time_step);
            droplets.push(DropletModel::new(scene, &layout, name, contact, threads));
        }
        let grids = scene.field.iter().map(|field| {
            let (body, _) = field.body_and_place();
            Grid::of(field, scene.solid(body).expect("a checked field lies in a solid"))
        });
        let grids = grids.collect();
        let memory_of_droplets =
            droplet_forecasts(scene).map(|droplet| droplet.memory).sum::<f64>();
        Ok(Self {
            scene: scene.clone(),
            layout,
            bodies,
            droplets,
            grids,
            threads: most_threads,
            memory_of_droplets: memory_of_droplets as usize,
        })
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub fn layout(&self) -> &InputLayout {
        &self.layout
    }

    /// Time zero, inputs at their start values.
    pub fn initial_state(&self) -> State {
        let solids = self.bodies.iter().map(|body| vec![0.0; body.solid.state_len()]);
        let droplets = self.droplets.iter().map(|body| aside(|| body.droplet.initial_state()));
        State {
            time: 0.0,
            inputs: initial_inputs(&self.scene),
            derivatives: Vec::new(),
            bodies: solids.chain(droplets).collect(),
        }
    }

    /// Whether all inputs make sense: finite, temperatures above absolute zero, footprints on their
    /// faces and within their ranges.
    pub fn check_inputs(&self, inputs: &[f64]) -> Result<(), ModelError> {
        // Without a way out of the loop, many values are looked at in one go.
        let all_finite = inputs.iter().fold(true, |fine, value| fine & value.is_finite());
        if !all_finite && let Some(index) = inputs.iter().position(|value| !value.is_finite()) {
            let message = format!("{} is not a finite number", inputs[index]);
            return Err(ModelError::Input { index, message });
        }
        for body in &self.bodies {
            body.loads.check(&self.scene, inputs)?;
        }
        self.droplets.iter().try_for_each(|body| body.check(inputs))
    }

    /// Advances by `dt` [s]. Inputs follow their derivatives over the step and are held without; at
    /// its end the state has their values and derivatives there. A refusal changes nothing.
    pub fn step(&self, state: &mut State, cache: &mut Cache, dt: f64) -> Result<(), ModelError> {
        self.step_unless(&Interrupt::default(), state, cache, dt)
    }

    /// The same, unless it is interrupted meanwhile, which changes nothing either.
    pub fn step_unless(
        &self,
        interrupt: &Interrupt,
        state: &mut State,
        cache: &mut Cache,
        dt: f64,
    ) -> Result<(), ModelError> {
        self.step_within(&Allowance::of_step(interrupt), state, cache, dt)
    }

    /// The same, as far as an allowance goes.
    pub fn step_within(
        &self,
        allowance: &Allowance,
        state: &mut State,
        cache: &mut Cache,
        dt: f64,
    ) -> Result<(), ModelError> {
        self.expect_room_to_step(state)?;
        self.check_inputs(&state.inputs)?;
        let path = InputPath::of(state);
        let mut bodies = state.bodies.clone();
        if path.is_held() {
            cache.meet(self, state);
            for (index, body) in self.bodies.iter().enumerate() {
                let loads = std::slice::from_ref(cache.loads(index));
                let advanced = body.solid.advance(&mut bodies[index], loads, dt, allowance);
                advanced.map_err(|halt| ModelError::Halted { body: body.name.clone(), halt })?;
            }
        } else {
            self.advance_along(&path, &mut bodies, dt, allowance)?;
        }
        self.advance_droplets(&path, state, &mut bodies, dt, allowance)?;
        for (body, unknowns) in self.bodies.iter().zip(&bodies) {
            if !unknowns.iter().all(|value| value.is_finite()) {
                return Err(ModelError::Overflow { body: body.name.clone() });
            }
        }
        self.check_temperatures((&path, &state.inputs), &bodies, dt)?;
        state.bodies = bodies;
        state.time += dt;
        if path.is_held() {
            state.derivatives.clear();
        } else {
            (state.inputs, state.derivatives) = path.end(dt);
        }
        cache.clear();
        Ok(())
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

    /// Reads outputs of a state one after another; looks at the inputs once for all of them.
    pub fn reader<'a>(
        &'a self,
        state: &'a State,
        cache: &'a mut Cache,
    ) -> Result<Reader<'a>, ModelError> {
        self.check_inputs(&state.inputs)?;
        cache.meet(self, state);
        Ok(Reader { model: self, state, cache })
    }

    /// The value of an output where the cache has met the state; an error where it is no finite number.
    fn value(&self, state: &State, cache: &mut Cache, output: &Output) -> Result<f64, ModelError> {
        finite(self.computed(state, cache, output)?)
    }

    fn computed(
        &self,
        state: &State,
        cache: &mut Cache,
        output: &Output,
    ) -> Result<f64, ModelError> {
        match output {
            Output::Droplet { body, total } => {
                let index = self.droplet_place(body);
                let unknowns = &state.bodies[self.bodies.len() + index];
                Ok(self.droplets[index].total(unknowns, cache.droplet(index), *total))
            }
            Output::Wall { wall, output } => {
                let index = self.droplet_place(&self.scene.wall[*wall].under);
                let unknowns = &state.bodies[self.bodies.len() + index];
                Ok(self.droplets[index].wall_output(unknowns, cache.droplet(index), *output))
            }
            Output::Body { body, total } => self.body_total(state, cache, self.place(body), *total),
            Output::Probe { probe, component } => {
                let probe = &self.scene.probe[*probe];
                let index = self.place(&probe.body);
                if *component == Component::Temperature {
                    // A single temperature is cheaper from the modes than from the whole field.
                    let (unknowns, loads) = (&state.bodies[index], cache.loads(index));
                    let solid = &self.bodies[index].solid;
                    let rise = solid.rise_at(unknowns, loads, self.scene.point_of(probe));
                    return Ok(solid.initial_temperature() + rise);
                }
                let point = self.scene.point_of(probe);
                self.component(&state.bodies, cache, index, *component, point)
            }
            Output::Field { field, component, cell } => {
                let (body, _) = self.scene.field[*field].body_and_place();
                let point = self.grids[*field].point(cell[0], cell[1]);
                self.component(&state.bodies, cache, self.place(body), *component, point)
            }
        }
    }

    /// All particles of a droplet, images at mirrors included.
    pub fn particle_fields(&self, state: &State, body: &str) -> ParticleFields {
        let index = self.droplet_place(body);
        self.droplets[index].particles(&state.bodies[self.bodies.len() + index])
    }

    /// Values at all nodes of a solid.
    pub fn nodal_fields(
        &self,
        state: &State,
        cache: &mut Cache,
        body: &str,
    ) -> Result<NodalFields, ModelError> {
        self.check_inputs(&state.inputs)?;
        cache.meet(self, state);
        let index = self.place(body);
        cache.solve(self, &state.bodies, index)?;
        let solid = &self.bodies[index].solid;
        let fields = solid.fields(cache.temperatures(index), cache.deformation(index));
        fields.values().try_for_each(|value| finite(value).map(drop))?;
        Ok(fields)
    }

    /// Whether a solid is a meridian section.
    pub fn is_axisymmetric(&self, body: &str) -> bool {
        self.bodies[self.place(body)].plan.mesh.geometry == Geometry::Axisymmetric
    }

    /// Most threads that any body may use.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Stored entries of all factorisations made so far.
    pub fn factor_entries(&self) -> usize {
        self.bodies.iter().map(|body| body.solid.factor_entries()).sum()
    }

    /// What was chosen or left out, and why: a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let solids = self.bodies.iter().flat_map(BodyModel::notes);
        let droplets = self.droplets.iter();
        let droplets = droplets
            .flat_map(|body| body.notes.iter().map(move |note| format!("{}: {note}", body.name)));
        solids.chain(droplets).collect()
    }

    fn place(&self, body: &str) -> usize {
        let known = self.bodies.iter().position(|b| b.name == body);
        known.expect("outputs are registered for bodies of the scene")
    }

    fn droplet_place(&self, body: &str) -> usize {
        let known = self.droplets.iter().position(|b| b.name == body);
        known.expect("outputs are registered for bodies of the scene")
    }

    fn component(
        &self,
        unknowns: &[Vec<f64>],
        cache: &mut Cache,
        index: usize,
        component: Component,
        point: [f64; 3],
    ) -> Result<f64, ModelError> {
        let solid = &self.bodies[index].solid;
        if component == Component::Temperature {
            cache.heat(self, unknowns, index);
            let rise = solid.rise_from(cache.temperatures(index), point);
            return Ok(solid.initial_temperature() + rise);
        }
        cache.solve(self, unknowns, index)?;
        if let Component::Displacement(i) = component {
            return Ok(solid.displacement_at(cache.deformation(index), point)[i]);
        }
        let stress = cache.stress_at(solid, index, point);
        Ok(match component {
            Component::Stress(i) => stress[i],
            Component::MaxPrincipal => max_principal(stress),
            _ => von_mises(stress),
        })
    }

    fn body_total(
        &self,
        state: &State,
        cache: &mut Cache,
        index: usize,
        total: BodyTotal,
    ) -> Result<f64, ModelError> {
        let solid = &self.bodies[index].solid;
        let unknowns = &state.bodies[index];
        Ok(match total {
            BodyTotal::HeatIn => solid.heat_totals(unknowns).brought_in,
            BodyTotal::HeatLost => solid.heat_totals(unknowns).lost,
            BodyTotal::HeatStored => solid.heat_stored(unknowns),
            BodyTotal::HeatDrift => solid.heat_drift(unknowns),
            BodyTotal::FallbackParticles => solid.fallback_particles().unwrap_or(0) as f64,
            BodyTotal::MaxTemperature => {
                cache.heat(self, &state.bodies, index);
                cache.max_temperature(solid, index)
            }
            BodyTotal::MaxVonMises | BodyTotal::MaxPrincipal => {
                cache.solve(self, &state.bodies, index)?;
                let [von_mises, principal] = cache.max_stress(solid, index);
                if total == BodyTotal::MaxVonMises { von_mises } else { principal }
            }
        })
    }
}

impl BodyModel {
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
}

/// Start values of all inputs, in the order of the layout.
pub fn initial_inputs(scene: &Scene) -> Vec<f64> {
    let mut inputs = vec![0.0; InputLayout::of(scene).len];
    for variable in &Registry::of(scene).variables {
        if let (Slot::Input(at), Some(value)) = (&variable.slot, variable.real_start()) {
            inputs[*at] = value;
        }
    }
    inputs
}

/// The contact of a droplet with the solid that the scene couples it to.
fn contact_of(
    scene: &Scene,
    (name, droplet): (&str, &Droplet),
    bodies: &[BodyModel],
    time_step: f64,
) -> Option<Contact> {
    let coupling = &scene.coupling[scene.coupling_from(name)?];
    let solid = bodies.iter().position(|body| Some(body.name.as_str()) == coupling.solid())?;
    let body = &bodies[solid];
    let modes = body.solid.top_modes();
    Some(Contact::of(coupling, droplet, (solid, &body.plan), modes, time_step))
}

fn plan(scene: &Scene, name: &str, solid: &Solid) -> Plan {
    let on_body = scene.load.iter().filter(|load| load.body_and_face().0 == name);
    let mut refinements: Vec<Refinement> = on_body.map(refinement).collect();
    if let Some(coupling) = scene.coupling_to(name)
        && let Some(droplet) = scene.droplet(&coupling.from)
    {
        refinements.extend(contact::refinements(coupling, droplet, scene.stop_time));
    }
    let shortest = scene.step.min(scene.stop_time);
    let mechanics = match (scene.asks_mechanics(name), scene.gives_mechanics(name)) {
        (false, _) => Mechanics::Absent,
        (true, false) => Mechanics::Offered,
        (true, true) => Mechanics::Wanted,
    };
    Plan::new(solid, mechanics, &refinements, shortest)
}

/// Where a load may act, wherever its inputs may move it.
fn refinement(load: &Load) -> Refinement {
    let start = [load.start.x.unwrap_or(0.0), load.start.y.unwrap_or(0.0)];
    let range = [load.range.x, load.range.y];
    let own = load.footprint.radius().unwrap_or(0.0);
    let [_, radius] = load.range.radius.unwrap_or([0.0, load.start.radius.unwrap_or(own).max(own)]);
    let half = match load.footprint {
        Footprint::Disc { .. } | Footprint::Rings { .. } => [radius; 2],
        Footprint::Gaussian { .. } => [1.5 * radius; 2],
        Footprint::Tiles { size, .. } => size.map(|s| s / 2.0),
    };
    let feature = match load.footprint {
        Footprint::Disc { .. } | Footprint::Gaussian { .. } => {
            load.range.radius.map_or(own, |[lowest, _]| lowest)
        }
        Footprint::Rings { count, .. } => radius * (5.0 / count as f64).min(1.0),
        Footprint::Tiles { count, size } => {
            (0..2).map(|a| size[a] * (5.0 / count[a] as f64).min(1.0)).fold(f64::INFINITY, f64::min)
        }
    };
    let stretch = |a: usize| {
        let [low, high] = range[a].unwrap_or([start[a]; 2]);
        [low - half[a], high + half[a]]
    };
    let top = load.body_and_face().1 == FaceName::Top;
    let heats = load.carries.contains(&Carries::HeatFlux);
    Refinement { x: stretch(0), y: stretch(1), top, feature, heats }
}

/// Number of threads to use; 0 are wanted for as many as are worth it.
fn resolve_threads(wanted: usize, is_large: bool) -> usize {
    match wanted {
        0 if !is_large => 1,
        0 => std::thread::available_parallelism().map_or(1, Into::into),
        threads => threads,
    }
}
