//! A solid of large strain in equilibrium under the displacements of its faces, its loads and its temperature.

use std::slice::from_mut;

use super::advised::Advised;
use super::bends::BendTest;
use super::faces::{Faces, Prescribed, loaded};
use super::probes::Probes;
use super::snapshot::{Seen, columns, copies};
use super::totals::Sums;
use super::warming::{Temperatures, Warming, heat_totals};
use super::{View, is_large, named, plan};
use crate::body::{
    Acts, Advice, Approach, BodyError, Events, Given, Giver, Maxima, Memo, Occasion, Reading,
    Resources, Structured,
};
use crate::inputs::InputLayout;
use crate::laws::solid::large_strain::Thermal;
use crate::method::large_strain::{
    Conditions, Course, Courses, Equilibrium, FaceLoad, Failure, Rest, STEPS, WORK, Warmth,
};
use crate::method::sph::ParticleFields;
use crate::runtime::allowance::{Allowance, Interrupt};
use crate::scene::{LargeStrain, Scene};
use crate::state::{Field, Fields, Per};
use crate::warning::{self, Warning};

/// A body without inertia.
pub struct RestingBody {
    name: String,
    pub(super) equilibrium: Equilibrium,
    start: Resting,
    faces: Faces,
    probes: Probes,
    /// Weight of each node [N].
    weight: Vec<[f64; 3]>,
    mirrors: [bool; 2],
    columns: Vec<[usize; 2]>,
    /// Temperature at the start [K].
    temperature: f64,
    /// Effects of the temperature on each layer.
    thermal: Vec<Thermal>,
    /// Heat of a body that conducts it.
    warming: Option<Warming>,
    advised: Advised,
    bend_test: BendTest,
    /// Halvings of a step.
    pub(super) halvings: u32,
    /// Part of the largest strain by which that of a step of relaxation may err.
    pub(super) tolerance: f64,
}

/// State of the body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Resting {
    time: f64,
    steps: f64,
    /// Steps whose equilibrium is not stable, and the end of the first of them [s].
    unstable: f64,
    unstable_from: f64,
    /// [K]
    pub(super) temperature: f64,
    /// Work of the stresses and of expansion, and energy stored [J].
    work: f64,
    stored: f64,
    /// Work of the loads on faces [J], and these loads.
    load_work: f64,
    loads: Vec<[f64; 4]>,
    pub(super) rest: Rest,
    warmth: Warmth,
    /// Forces on the faces that are held or moved [N].
    forces: Vec<[f64; 3]>,
}

/// Halvings of a step in which no equilibrium is found.
const HALVINGS: u32 = 7;
/// Halvings of a step of concrete: a step to failure has some thousand parts where damage begins.
const HALVINGS_OF_CONCRETE: u32 = 14;
/// Change of the damage function η of a point in a part of a step. A longer part may jump over the peak, to a second
/// equilibrium whose damage is in one place: at most half of this below the peak the bound excludes it.
const PASSED: f64 = 0.05;
/// Error that a step of relaxation may have, over the scene's tolerance, and the least that is kept. Forces of an
/// equilibrium balance to 1e-10, so that shorter steps would compare rounding.
const OF_TOLERANCE: f64 = 0.1;
const LEAST_TOLERANCE: f64 = 1e-8;
/// Iterations of a usual step.
const ITERATIONS: f64 = 5.0;
/// Part of the distance between two faces by which sides may bulge beyond them without a warning.
const BULGED: f64 = 0.01;
/// Part of the dissipated work from which on loads, not moved faces, have bent a body.
const BY_LOADS: f64 = 0.5;
/// Share of the energy that the balance of a state may miss.
const ENERGY: f64 = 1e-6;

impl Fields for Resting {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| of(name, words, Per::Body, 1);
        let displacement = self.rest.displacement.as_flattened_mut();
        let mut fields = vec![
            (body("time", "time since the start [s]"), from_mut(&mut self.time)),
            (body("steps", "steps made"), from_mut(&mut self.steps)),
            (
                body("unstable", "steps whose equilibrium is not stable"),
                from_mut(&mut self.unstable),
            ),
            (
                body("unstable_from", "time of the first of them [s]"),
                from_mut(&mut self.unstable_from),
            ),
            (body("temperature", "temperature [K]"), from_mut(&mut self.temperature)),
            (body("work", "work of stresses and expansion [J]"), from_mut(&mut self.work)),
            (body("stored", "energy stored [J]"), from_mut(&mut self.stored)),
            (body("load_work", "work of loads on faces [J]"), from_mut(&mut self.load_work)),
            (
                of("loads", "pressure and traction on loaded faces [Pa]", Per::Face, 4),
                self.loads.as_flattened_mut(),
            ),
            (
                of("forces", "forces on held faces [N]", Per::Face, 3),
                self.forces.as_flattened_mut(),
            ),
            (of("displacement", "displacement [m]", Per::Node, 3), displacement),
            (of("history", "history of the law", Per::Point, 1), &mut self.rest.history[..]),
        ];
        fields.extend(self.warmth.fields());
        fields
    }
}

impl RestingBody {
    pub fn new(
        (scene, layout): (&Scene, &InputLayout),
        (name, solid): (&str, &LargeStrain),
        threads: impl Fn(bool) -> usize,
    ) -> Result<Self, BodyError> {
        let mesh = plan::mesh(solid);
        let named = |failure| named(name, failure);
        let threads = threads(is_large(plan::cells(&mesh) * 8));
        let body = plan::deformable(solid, threads).map_err(named)?;
        let advised = Advised::of((name, solid), &body);
        let weight = body.mass.iter().map(|m| [0.0, 0.0, -m * solid.gravity]).collect();
        let faces = Faces::new(layout, (name, solid), &mesh, &body);
        let probes = Probes::new(scene, (name, solid), &mesh, &body);
        let probes = probes.map_err(|refused| named(refused.into()))?;
        let loaded = loaded(solid, &body);
        let warming = Warming::new(layout, (name, solid), &mesh, &body).map_err(named)?;
        let warmth = warming.as_ref().map(|own| own.start(0, false)).unwrap_or_default();
        let equilibrium = Equilibrium::new(body, &faces.held(), loaded).map_err(named)?;
        let forces = faces.no_forces();
        let loads = vec![[0.0; 4]; faces.loaded()];
        let columns = columns(&equilibrium.body.space, solid.is_box());
        let temperature = solid.initial_temperature;
        let rest = equilibrium.rest();
        let start = Resting { temperature, loads, rest, forces, warmth, ..Resting::default() };
        let is_concrete = equilibrium.body.has_concrete();
        let own = Self {
            name: name.to_owned(),
            halvings: if is_concrete { HALVINGS_OF_CONCRETE } else { HALVINGS },
            equilibrium,
            start,
            faces,
            probes,
            weight,
            mirrors: solid.mirrors(),
            columns,
            temperature,
            thermal: solid.thermal(),
            warming,
            advised,
            bend_test: BendTest::of((name, solid)),
            tolerance: (OF_TOLERANCE * scene.fidelity.tolerance).max(LEAST_TOLERANCE),
        };
        Ok(own)
    }

    /// The steps of all points over a time [s] in which the temperature changes linearly.
    pub(super) fn course(
        &self,
        [from, to]: [Temperatures; 2],
        dt: f64,
    ) -> Result<Courses, Failure> {
        if let Some(warming) = &self.warming {
            let body = &self.equilibrium.body;
            let [before, after] = [from, to].map(|own| warming.of_groups(body, own.rise));
            return warming.courses(body, [&before, &after], dt);
        }
        let temperatures = [from.base, to.base];
        let of_layer = |thermal: &Thermal| {
            let (temperature, stretch) = (temperatures[1], thermal.stretch(temperatures[1]));
            if !(stretch > 0.0 && stretch.is_finite()) {
                return Err(Failure::Shrunk { temperature, stretch });
            }
            Ok(Course { time: thermal.reduced_time(temperatures, dt), stretch, growth: 0.0 })
        };
        let of_layers = self.thermal.iter().map(of_layer).collect::<Result<_, _>>()?;
        Ok(Courses::OfLayers(of_layers))
    }

    /// Thermal stretches of all points of a state, over no time.
    fn over(&self, state: &Resting) -> Result<Courses, Failure> {
        self.course([temperatures(state); 2], 0.0)
    }

    /// Returns true if part of the body remembers what happened to it.
    fn remembers(&self) -> bool {
        self.equilibrium.body.history() > 0
    }

    /// Finds the equilibrium after a time [s] under what is prescribed there; halves the step where none is found, and
    /// where concrete changes by more than [`PASSED`].
    pub(super) fn settle(
        &self,
        state: &mut Resting,
        to: &Prescribed,
        dt: f64,
        halvings: u32,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let conditions = self.conditions(to);
        let end = Temperatures { base: to.temperature, rise: &to.rise };
        let course = self.course([temperatures(state), end], dt)?;
        let expansion = self.work_of_expansion(state, end)?;
        let from = self.loads_at(&state.rest, &self.held(state).loads);
        let before = state.rest.clone();
        let found = match self.equilibrium.step(&mut state.rest, &conditions, &course, allowance) {
            Ok(found) => found,
            Err(failure @ Failure::Halted(_)) => return Err(failure),
            Err(Failure::NoEquilibrium { residual }) if halvings == 0 => {
                let change = self.faces.change(&self.held(state), to);
                return Err(Failure::NoEquilibriumThere { change, residual });
            }
            Err(failure) if halvings == 0 => return Err(failure),
            Err(_) => return self.settle_in_halves(state, to, dt, halvings - 1, allowance),
        };
        if found.passed > PASSED && halvings > 0 {
            let mut finer = Resting { rest: before.clone(), ..state.clone() };
            match self.settle_in_halves(&mut finer, to, dt, halvings - 1, allowance) {
                Ok(()) => {
                    *state = finer;
                    return Ok(());
                }
                Err(failure @ Failure::Halted(_)) => return Err(failure),
                // Where loads fall faster than held faces move, only a jump has an end.
                Err(_) => {}
            }
        }
        let forces = self.loads_at(&state.rest, &to.loads);
        let of_node = |node: usize| -> f64 {
            let force = |a: usize| 0.5 * (from[node][a] + forces[node][a]);
            let way = |a: usize| state.rest.displacement[node][a] - before.displacement[node][a];
            (0..3).map(|a| force(a) * way(a)).sum()
        };
        state.load_work += (0..forces.len()).map(of_node).sum::<f64>();
        state.loads = to.loads.iter().map(FaceLoad::numbers).collect();
        state.work += match self.remembers() {
            // Elastic work is what is stored.
            false => found.stored - state.stored,
            true => found.work + expansion,
        };
        state.stored = found.stored;
        state.time += dt;
        state.temperature = to.temperature;
        state.warmth.rise.clone_from(&to.rise);
        state.steps += 1.0;
        if found.is_unstable {
            if state.unstable == 0.0 {
                state.unstable_from = state.time;
            }
            state.unstable += 1.0;
        }
        state.forces = self.faces.forces(&found.reactions);
        Ok(())
    }

    fn settle_in_halves(
        &self,
        state: &mut Resting,
        to: &Prescribed,
        dt: f64,
        halvings: u32,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let middle = self.held(state).middle(to);
        self.settle(state, &middle, 0.5 * dt, halvings, allowance)?;
        self.settle(state, to, 0.5 * dt, halvings, allowance)
    }

    /// Energy that a change of temperature alone gives to a body with a history [J].
    fn work_of_expansion(&self, state: &Resting, to: Temperatures) -> Result<f64, Failure> {
        let body = &self.equilibrium.body;
        if !self.remembers() || to.base == state.temperature && to.rise == state.warmth.rise {
            return Ok(0.0);
        }
        let (u, mut history) = (&state.rest.displacement, state.rest.history.clone());
        let over = self.course([to; 2], 0.0)?;
        Ok(body.respond(u, &over, &mut history, &body.team())?.energy - state.stored)
    }

    /// The equilibrium under the present inputs, which may have changed since the last step.
    fn present(&self, mut present: Resting, inputs: &[f64]) -> Result<Resting, BodyError> {
        let mut to = self.faces.prescribed(inputs);
        let warmth = self.held_warmth(&present, inputs);
        to.rise.clone_from(&warmth.rise);
        if present.steps == 0.0 || self.held(&present) != to {
            let Resting { time, steps, unstable, unstable_from, .. } = present;
            let interrupt = Interrupt::default();
            let allowance = Allowance::of_updates(&interrupt, f64::INFINITY);
            let settled = self.settle(&mut present, &to, 0.0, self.halvings, &allowance);
            settled.map_err(|failure| named(&self.name, failure))?;
            (present.time, present.steps) = (time, steps);
            (present.unstable, present.unstable_from) = (unstable, unstable_from);
            present.warmth = warmth;
        }
        Ok(present)
    }

    /// The heat of a state with the temperatures that inputs prescribe.
    fn held_warmth(&self, state: &Resting, inputs: &[f64]) -> Warmth {
        let mut warmth = state.warmth.clone();
        if let Some(warming) = &self.warming {
            warming.hold(&mut warmth, inputs);
        }
        warmth
    }

    fn conditions(&self, to: &Prescribed) -> Conditions {
        let displacements = self.faces.displacements(&to.places);
        Conditions { forces: self.weight.clone(), displacements, loads: to.loads.clone() }
    }

    /// Forces of loads on the nodes of a body [N].
    fn loads_at(&self, rest: &Rest, loads: &[FaceLoad]) -> Vec<[f64; 3]> {
        let Equilibrium { body, loaded, .. } = &self.equilibrium;
        let mut forces = vec![[0.0; 3]; body.nodes()];
        loaded.add_forces(body, &rest.displacement, loads, &mut forces);
        forces
    }

    /// Returns what is prescribed where a state is in equilibrium.
    pub(super) fn held(&self, state: &Resting) -> Prescribed {
        Prescribed {
            places: self.faces.places(&state.rest.displacement),
            loads: state.loads.iter().copied().map(FaceLoad::of).collect(),
            temperature: state.temperature,
            rise: state.warmth.rise.clone(),
        }
    }

    fn seen<'a>(&'a self, state: &'a Resting, over: &'a Courses) -> Seen<'a> {
        Seen {
            body: &self.equilibrium.body,
            mirrors: self.mirrors,
            lifted: 0.0,
            displacement: &state.rest.displacement,
            over,
            columns: &self.columns,
            velocity: None,
            history: &state.rest.history,
            touch: None,
        }
    }

    fn check_resting(&self, state: &Resting) -> Result<(), String> {
        if !self.equilibrium.body.is_sound(&state.rest.history) {
            return Err("plastic strain, damage and compaction are not negative".to_owned());
        }
        if state.time < 0.0 || !(0.0..=state.steps).contains(&state.unstable) {
            return Err("time and steps are not negative".to_owned());
        }
        if !(0.0..=state.time).contains(&state.unstable_from) {
            return Err("stability is lost within the run".to_owned());
        }
        let temperature = state.temperature;
        let moves = temperature != self.temperature;
        if temperature.is_nan()
            || temperature <= 0.0
            || moves && !self.thermal.iter().any(Thermal::acts)
        {
            return Err(format!("a temperature of {temperature} K"));
        }
        self.faces.check(&state.rest.displacement)?;
        if !state.loads.as_flattened().iter().all(|load| load.is_finite()) {
            return Err("a load is not finite".to_owned());
        }
        let words = |failure: Failure| failure.to_string();
        if let Some(warming) = &self.warming {
            warming.check(&state.warmth)?;
        }
        let over = self.over(state).map_err(words)?;
        let found = self.seen(state, &over).stresses().map_err(words)?;
        let missing = found.energy - state.stored;
        // Functions of elements may sum up to no deformation but for rounding.
        let rounding = self.equilibrium.rounding_of_energy;
        if missing.abs() > ENERGY * found.energy.abs() + rounding {
            return Err(format!("{missing:.1e} J of the stored energy have no cause"));
        }
        Ok(())
    }
}

pub(super) fn temperatures(state: &Resting) -> Temperatures<'_> {
    Temperatures { base: state.temperature, rise: &state.warmth.rise }
}

impl Structured for RestingBody {
    type State = Resting;
    type View = View;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &Resting {
        &self.start
    }

    fn check(&self, state: &Resting) -> Result<(), String> {
        self.check_resting(state)
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.warming.as_ref().map_or(Ok(()), |warming| warming.check_inputs(inputs))
    }

    fn advance(
        &self,
        state: &mut Resting,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        // Inputs that have jumped act at once, before stress relaxes and heat flows.
        let inputs = acts.path.at(0, 0.0);
        let mut from = self.faces.prescribed(&inputs);
        let mut warmth = self.held_warmth(state, &inputs);
        from.rise.clone_from(&warmth.rise);
        let jumps = state.steps == 0.0 || self.held(state) != from;
        if jumps && (self.remembers() || self.warming.is_some()) {
            let settled = self.settle(state, &from, 0.0, self.halvings, allowance);
            settled.map_err(|failure| named(&self.name, failure))?;
        }
        let mut to = self.faces.prescribed(&acts.path.at(0, acts.duration));
        if let Some(warming) = &self.warming {
            let own = (&self.name[..], &self.equilibrium.body, &state.rest.displacement[..]);
            let over = (acts.path, acts.duration);
            warming.advance(own, &mut warmth, over, Vec::new(), allowance)?;
            to.rise.clone_from(&warmth.rise);
        }
        let settled = match self.equilibrium.body.relaxes() {
            true => self.relax(state, &to, acts.duration, allowance),
            false => self.settle(state, &to, acts.duration, self.halvings, allowance),
        };
        settled.map_err(|failure| named(&self.name, failure))?;
        state.warmth = warmth;
        Ok(None)
    }

    fn view(&self, state: Resting, inputs: &[f64]) -> Result<View, BodyError> {
        let state = self.present(state, inputs)?;
        let over = self.over(&state).map_err(|failure| named(&self.name, failure))?;
        let seen = self.seen(&state, &over);
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        let copies = copies(self.mirrors);
        let sums = Sums {
            dissipated: copies * (state.work - state.stored),
            load_work: copies * state.load_work,
            steps: state.steps,
            heat: heat_totals(self.warming.as_ref(), (seen.body, &state.warmth), copies),
            ..Sums::default()
        };
        let snapshot = seen.snapshot(&stresses);
        let probed = self.probes.read(&seen, &stresses, temperatures(&state));
        Ok(View { snapshot, sums, probed, forces: state.forces })
    }

    fn read(&self, view: &View, reading: &Reading) -> Result<f64, BodyError> {
        view.read(reading)
    }

    fn follows_at_once(&self, reading: &Reading) -> bool {
        matches!(reading, Reading::Total(_) | Reading::Point { .. })
    }

    fn drawn(&self, state: Resting, inputs: &[f64]) -> Result<ParticleFields, BodyError> {
        let present = self.present(state, inputs)?;
        let over = self.over(&present).map_err(|failure| named(&self.name, failure))?;
        let seen = self.seen(&present, &over);
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        Ok(seen.particles(&stresses, temperatures(&present)))
    }
}

impl Giver for RestingBody {}

impl Events for RestingBody {}

impl Maxima for RestingBody {}

impl RestingBody {
    /// Warns of free sides that have bulged through the planes of the faces which press the body.
    fn warning_on_sides(&self, state: &[f64]) -> Option<Warning> {
        let body = &self.equilibrium.body;
        let displacements = body.displacements(&self.structure(state).rest.displacement);
        let [passed, distance] = self.faces.passed(&body.space.nodes, &displacements)?;
        let is_through = passed > BULGED * distance;
        is_through.then(|| {
            let finding = warning::sides_pass_faces(format!("{passed:.1e}"));
            finding.at(&self.name).whatever_its_numbers()
        })
    }

    /// Warns of a body that may leave its equilibrium for another one.
    fn warning_on_stability(&self, state: &[f64]) -> Option<Warning> {
        let Resting { unstable, unstable_from, .. } = self.structure(state);
        (unstable > 0.0).then(|| {
            let finding = warning::equilibrium_not_stable(format!("{unstable_from:.3e}"));
            finding.at(&self.name).whatever_its_numbers()
        })
    }

    /// Warns of bends beyond yield that the mesh resolves poorly.
    fn warning_on_bends(&self, state: &[f64]) -> Option<Warning> {
        let Resting { rest, work, stored, load_work, .. } = self.structure(state);
        let is_loaded = load_work > BY_LOADS * (work - stored);
        self.bend_test.warning(&self.equilibrium.body, &rest.history, is_loaded)
    }
}

impl Approach for RestingBody {}

impl Advice for RestingBody {
    fn notes(&self) -> Vec<String> {
        self.advised.notes()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        match occasion {
            Occasion::Step => {
                let all = [self.warning_on_sides(state), self.warning_on_stability(state)];
                all.into_iter().flatten().collect()
            }
            Occasion::Response { .. } => Vec::new(),
            Occasion::End => self.warning_on_bends(state).into_iter().collect(),
        }
    }

    fn warning_on_value(&self, reading: &Reading, value: f64) -> Option<Warning> {
        self.advised.on_value(reading, value)
    }

    fn temperature_range(&self, state: &[f64], _: &[f64]) -> Option<[f64; 2]> {
        let state = self.structure(state);
        Some(match &self.warming {
            Some(warming) => warming.range(&state.warmth),
            None => [state.temperature; 2],
        })
    }
}

impl Resources for RestingBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let work = WORK * self.equilibrium.body.space.volume.len();
        let foreseen = allowance.foresee_step(dt, ITERATIONS, STEPS, work);
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    /// A reading finds the equilibrium under inputs that have changed.
    fn is_deep(&self, _: Option<&Memo>, _: &Reading) -> bool {
        true
    }

    fn threads(&self) -> usize {
        self.equilibrium.body.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
