//! A solid of large strain in equilibrium under the displacements of its faces and its temperature.

use std::ops::Range;
use std::slice::from_mut;

use super::snapshot::{Seen, Snapshot, columns, copies};
use super::totals::{self, Sums, moved_faces};
use super::{is_large, plan};
use crate::body::{
    Acts, Advice, Approach, Body, BodyError, Fields, Given, Giver, Maxima, Memo, Reading, Received,
    Resources,
};
use crate::inputs::InputLayout;
use crate::laws::solid::large_strain::Thermal;
use crate::method::large_strain::{
    Conditions, Course, Deformable, Equilibrium, Failure, Rest, STEPS, WORK,
};
use crate::runtime::allowance::{Allowance, Interrupt, cost};
use crate::scene::LargeStrain;
use crate::space::{Form, Mesh};
use crate::state::{
    Field, Fields as StateFields, Layout, Per, expect_like, layout_like, load, store, stored,
};

/// A body without inertia.
pub struct RestingBody {
    name: String,
    equilibrium: Equilibrium,
    start: Resting,
    /// Conditions on each node along x, y and z.
    holds: Vec<[Hold; 3]>,
    /// Weight of each node [N].
    weight: Vec<[f64; 3]>,
    /// Axes along which the displacements of faces are prescribed, face by face.
    moved: Vec<Vec<usize>>,
    mirrors: [bool; 2],
    columns: Vec<[usize; 2]>,
    /// Temperature at the start [K].
    temperature: f64,
    /// Effects of the temperature on each layer.
    thermal: Vec<Thermal>,
    /// Places of the displacements, and of the temperature if it acts, among the inputs.
    inputs: Range<usize>,
    notes: Vec<String>,
}

/// Displacements and temperature that the inputs prescribe at a time.
#[derive(Debug, Clone, PartialEq)]
struct Prescribed {
    /// Displacements of the moved faces [m].
    faces: Vec<[f64; 3]>,
    /// [K]
    temperature: f64,
}

impl Prescribed {
    fn middle(&self, other: &Self) -> Self {
        let half = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|n| 0.5 * (a[n] + b[n]));
        let faces = self.faces.iter().zip(&other.faces).map(half).collect();
        Self { faces, temperature: 0.5 * (self.temperature + other.temperature) }
    }
}

/// Memo of the body: what the inputs prescribe, and what is read of the equilibrium under it.
struct RestingMemo {
    to: Prescribed,
    seen: Option<(Snapshot, Sums, Vec<[f64; 3]>)>,
}

impl RestingMemo {
    fn of_mut(memo: &mut Memo) -> &mut Self {
        let memo: &mut (dyn std::any::Any + Send + Sync) = memo.as_mut();
        memo.downcast_mut().expect("a memo is that of the body that made it")
    }
}

/// Condition on a node along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hold {
    Free,
    Fixed,
    /// Moves with a face, by its number among those that are moved.
    With(usize),
}

/// State of the body.
#[derive(Debug, Clone, PartialEq, Default)]
struct Resting {
    time: f64,
    steps: f64,
    /// [K]
    temperature: f64,
    /// Work of the stresses and of expansion, and energy stored [J].
    work: f64,
    stored: f64,
    rest: Rest,
    /// Forces on the faces that are moved [N].
    forces: Vec<[f64; 3]>,
}

/// Halvings of a step in which no equilibrium is found.
const HALVINGS: u32 = 7;
/// Iterations of a usual step.
const ITERATIONS: f64 = 5.0;
/// Share of the energy that the balance of a state may miss.
const ENERGY: f64 = 1e-6;

impl StateFields for Resting {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| of(name, words, Per::Body, 1);
        let displacement = self.rest.displacement.as_flattened_mut();
        vec![
            (body("time", "time since the start [s]"), from_mut(&mut self.time)),
            (body("steps", "steps made"), from_mut(&mut self.steps)),
            (body("temperature", "temperature [K]"), from_mut(&mut self.temperature)),
            (body("work", "work of stresses and expansion [J]"), from_mut(&mut self.work)),
            (body("stored", "energy stored [J]"), from_mut(&mut self.stored)),
            (
                of("forces", "forces on moved faces [N]", Per::Face, 3),
                self.forces.as_flattened_mut(),
            ),
            (of("displacement", "displacement [m]", Per::Node, 3), displacement),
            (of("history", "history of the law", Per::Point, 1), &mut self.rest.history),
        ]
    }
}

impl RestingBody {
    pub fn new(
        layout: &InputLayout,
        (name, solid): (&str, &LargeStrain),
        threads: impl Fn(bool) -> usize,
    ) -> Result<Self, BodyError> {
        let mesh = plan::mesh(solid);
        let named = |failure| BodyError::LargeStrain { body: name.to_owned(), failure };
        let threads = threads(is_large(mesh.cells.len() * 8));
        let body = plan::deformable(solid, threads).map_err(named)?;
        let weight = body.mass.iter().map(|m| [0.0, 0.0, -m * solid.gravity]).collect();
        let holds = holds(solid, &mesh, &body);
        let held: Vec<[bool; 3]> =
            holds.iter().map(|holds| holds.map(|hold| hold != Hold::Free)).collect();
        let equilibrium = Equilibrium::new(body, &held).map_err(named)?;
        let moved: Vec<Vec<usize>> =
            moved_faces(solid).into_iter().map(|face| solid.moved_axes(face)).collect();
        let forces = vec![[0.0; 3]; moved.len()];
        let columns = columns(&equilibrium.body.space, solid.is_box());
        let temperature = solid.initial_temperature;
        let rest = equilibrium.rest();
        let start = Resting { temperature, rest, forces, ..Resting::default() };
        let own = Self {
            name: name.to_owned(),
            equilibrium,
            start,
            holds,
            weight,
            moved,
            mirrors: solid.mirrors(),
            columns,
            temperature,
            thermal: solid.thermal(),
            inputs: layout.of_body(name),
            notes: super::forecast::notes(solid),
        };
        Ok(own)
    }

    /// Returns the displacements and the temperature that all inputs prescribe.
    fn prescribed(&self, inputs: &[f64]) -> Prescribed {
        let mut own = inputs[self.inputs.clone()].iter();
        let of_face = |axes: &Vec<usize>| {
            let mut displacement = [0.0; 3];
            axes.iter().zip(&mut own).for_each(|(&axis, &value)| displacement[axis] = value);
            displacement
        };
        let faces = self.moved.iter().map(of_face).collect();
        Prescribed { faces, temperature: own.next().copied().unwrap_or(self.temperature) }
    }

    /// The step of each layer over a time [s] in which the temperature changes linearly [K].
    fn course(&self, temperatures: [f64; 2], dt: f64) -> Result<Vec<Course>, Failure> {
        let of_layer = |thermal: &Thermal| {
            let (temperature, stretch) = (temperatures[1], thermal.stretch(temperatures[1]));
            if !(stretch > 0.0 && stretch.is_finite()) {
                return Err(Failure::Shrunk { temperature, stretch });
            }
            Ok(Course { time: thermal.reduced_time(temperatures, dt), stretch })
        };
        self.thermal.iter().map(of_layer).collect()
    }

    /// Thermal stretch of each layer at a temperature [K].
    fn stretches(&self, temperature: f64) -> Vec<f64> {
        self.thermal.iter().map(|thermal| thermal.stretch(temperature)).collect()
    }

    /// Returns true if part of the body remembers what happened to it.
    fn remembers(&self) -> bool {
        self.equilibrium.body.history() > 0
    }

    /// Finds the equilibrium after a time [s] under what is prescribed there; halves the step where none is found.
    fn settle(
        &self,
        state: &mut Resting,
        to: &Prescribed,
        dt: f64,
        halvings: u32,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let conditions = self.conditions(&to.faces);
        let course = self.course([state.temperature, to.temperature], dt)?;
        let expansion = self.work_of_expansion(state, to.temperature)?;
        match self.equilibrium.step(&mut state.rest, &conditions, &course, allowance) {
            Ok(found) => {
                let before = state.stored;
                state.work += match self.remembers() {
                    // Elastic work is what is stored.
                    false => found.stored - before,
                    true => found.work + expansion,
                };
                state.stored = found.stored;
                state.time += dt;
                state.temperature = to.temperature;
                state.steps += 1.0;
                state.forces = self.forces(&found.reactions);
                Ok(())
            }
            Err(failure @ Failure::Halted(_)) => Err(failure),
            Err(failure) if halvings == 0 => Err(failure),
            Err(_) => {
                let middle = self.held(state).middle(to);
                self.settle(state, &middle, 0.5 * dt, halvings - 1, allowance)?;
                self.settle(state, to, 0.5 * dt, halvings - 1, allowance)
            }
        }
    }

    /// Energy that a change of temperature alone gives to a body with a history [J].
    fn work_of_expansion(&self, state: &Resting, temperature: f64) -> Result<f64, Failure> {
        let body = &self.equilibrium.body;
        if !self.remembers() || temperature == state.temperature {
            return Ok(0.0);
        }
        let (u, mut history) = (&state.rest.displacement, state.rest.history.clone());
        let over = self.course([temperature; 2], 0.0)?;
        Ok(body.respond(u, &over, &mut history, &body.team())?.energy - state.stored)
    }

    /// The equilibrium under the present inputs, which may have changed since the last step.
    fn present(&self, state: &[f64], to: &Prescribed) -> Result<Resting, BodyError> {
        let mut present = self.resting(state);
        if present.steps == 0.0 || self.held(&present) != *to {
            let (time, steps) = (present.time, present.steps);
            let interrupt = Interrupt::default();
            let allowance = Allowance::of_updates(&interrupt, f64::INFINITY);
            let settled = self.settle(&mut present, to, 0.0, HALVINGS, &allowance);
            settled.map_err(|failure| self.error(failure))?;
            (present.time, present.steps) = (time, steps);
        }
        Ok(present)
    }

    fn conditions(&self, to: &[[f64; 3]]) -> Conditions {
        let of_node = |holds: &[Hold; 3]| {
            [0, 1, 2].map(|a| match holds[a] {
                Hold::Free | Hold::Fixed => 0.0,
                Hold::With(face) => to[face][a],
            })
        };
        let displacements = self.holds.iter().map(of_node).collect();
        Conditions { forces: self.weight.clone(), displacements }
    }

    /// Returns the displacements and the temperature under which a state is in equilibrium.
    fn held(&self, state: &Resting) -> Prescribed {
        let mut places = vec![[0.0; 3]; self.moved.len()];
        for (holds, u) in self.holds.iter().zip(&state.rest.displacement) {
            for a in 0..3 {
                if let Hold::With(face) = holds[a] {
                    places[face][a] = u[a];
                }
            }
        }
        Prescribed { faces: places, temperature: state.temperature }
    }

    /// Forces on the moved faces, images included; those of images along mirrored axes cancel.
    fn forces(&self, reactions: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; self.moved.len()];
        for (holds, reaction) in self.holds.iter().zip(reactions) {
            for a in 0..3 {
                if let Hold::With(face) = holds[a] {
                    let mirrored = a < 2 && (self.mirrors[a] || self.is_round());
                    let copies = if mirrored { 0.0 } else { copies(self.mirrors) };
                    forces[face][a] += copies * reaction[a];
                }
            }
        }
        forces
    }

    fn is_round(&self) -> bool {
        self.equilibrium.body.space.form == Form::Axisymmetric
    }

    fn resting(&self, state: &[f64]) -> Resting {
        let mut resting = self.start.clone();
        load(&mut resting, state);
        resting
    }

    fn snapshot(&self, state: &Resting) -> Result<Snapshot, BodyError> {
        let stretches = self.stretches(state.temperature);
        self.seen(state, &stretches).snapshot().map_err(|failure| self.error(failure))
    }

    fn seen<'a>(&'a self, state: &'a Resting, stretches: &'a [f64]) -> Seen<'a> {
        Seen {
            body: &self.equilibrium.body,
            mirrors: self.mirrors,
            lifted: 0.0,
            displacement: &state.rest.displacement,
            stretches,
            columns: &self.columns,
            velocity: None,
            history: &state.rest.history,
            touch: None,
        }
    }

    fn error(&self, failure: Failure) -> BodyError {
        let body = self.name.clone();
        match failure {
            Failure::Halted(halt) => BodyError::Halted { body, halt },
            failure => BodyError::LargeStrain { body, failure },
        }
    }

    fn check_resting(&self, state: &Resting) -> Result<(), String> {
        if state.time < 0.0 || state.steps < 0.0 {
            return Err("time and steps are not negative".to_owned());
        }
        let temperature = state.temperature;
        let moves = temperature != self.temperature;
        if temperature.is_nan()
            || temperature <= 0.0
            || moves && !self.thermal.iter().any(Thermal::acts)
        {
            return Err(format!("a temperature of {temperature} K"));
        }
        for (holds, u) in self.holds.iter().zip(&state.rest.displacement) {
            if (0..3).any(|a| holds[a] == Hold::Fixed && u[a] != 0.0) {
                return Err("a node moves along an axis that holds it".to_owned());
            }
        }
        let snapshot = self.snapshot(state).map_err(|error| error.to_string())?;
        let missing = snapshot.stored - copies(self.mirrors) * state.stored;
        if missing.abs() > ENERGY * snapshot.stored.abs() {
            return Err(format!("{missing:.1e} J of the stored energy have no cause"));
        }
        Ok(())
    }
}

/// Conditions on the nodes of a mesh by the faces of a solid; where faces meet, fixed prevails over moved.
fn holds(solid: &LargeStrain, mesh: &Mesh, body: &Deformable) -> Vec<[Hold; 3]> {
    let fixed = |fixed: &[bool; 3]| fixed.map(|fixed| if fixed { Hold::Fixed } else { Hold::Free });
    let mut holds: Vec<[Hold; 3]> = body.fixed.iter().map(fixed).collect();
    let moved = moved_faces(solid);
    for (&face, held) in &solid.faces {
        let number = moved.iter().position(|&other| other == face);
        for (side, corners) in mesh.faces.iter().filter(|(side, _)| plan::is_on(solid, face, *side))
        {
            for &node in corners {
                for (axis, hold) in holds[node as usize].iter_mut().enumerate() {
                    let is_free = held.roller && plan::normal(*side) != axis;
                    if *hold != Hold::Fixed && !is_free {
                        *hold = number.map_or(Hold::Fixed, Hold::With);
                    }
                }
            }
        }
    }
    holds
}

impl Body for RestingBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        stored(&self.start)
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        layout_like(&self.start, state)
    }

    fn check_state(&self, state: &[f64], _: &[f64]) -> Result<(), String> {
        let name = &self.name;
        expect_like(&self.start, state, name)?;
        self.check_resting(&self.resting(state)).map_err(|reason| format!("{name}: {reason}"))
    }

    fn check_inputs(&self, _: &[f64]) -> Result<(), BodyError> {
        Ok(())
    }

    fn memo(&self, inputs: &[f64], _: &[Received]) -> Memo {
        Box::new(RestingMemo { to: self.prescribed(inputs), seen: None })
    }

    fn forget_state(&self, memo: &mut Memo) {
        RestingMemo::of_mut(memo).seen = None;
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let mut resting = self.resting(state);
        // Inputs that have jumped act at once, before stress relaxes.
        let from = self.prescribed(&acts.path.at(0, 0.0));
        let jumps = resting.steps == 0.0 || self.held(&resting) != from;
        if jumps && self.remembers() {
            let settled = self.settle(&mut resting, &from, 0.0, HALVINGS, allowance);
            settled.map_err(|failure| self.error(failure))?;
        }
        let to = self.prescribed(&acts.path.at(0, acts.duration));
        let settled = self.settle(&mut resting, &to, acts.duration, HALVINGS, allowance);
        settled.map_err(|failure| self.error(failure))?;
        store(&mut resting, state);
        Ok(None)
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let Reading::Total(place) = *reading else { return Err(BodyError::NoSuchReading) };
        let memo = RestingMemo::of_mut(memo);
        if memo.seen.is_none() {
            let present = self.present(state, &memo.to)?;
            let dissipated = copies(self.mirrors) * (present.work - present.stored);
            let sums = Sums { dissipated, steps: present.steps, ..Sums::default() };
            memo.seen = Some((self.snapshot(&present)?, sums, present.forces));
        }
        let (snapshot, sums, forces) = memo.seen.as_ref().expect("made above");
        Ok(match totals::force(place) {
            Some((face, axis)) => forces[face][axis],
            None => totals::read(snapshot, sums, place),
        })
    }

    fn follows_at_once(&self, reading: &Reading) -> bool {
        matches!(reading, Reading::Total(_))
    }

    fn fields(&self, state: &[f64], memo: &mut Memo) -> Result<Fields, BodyError> {
        let present = self.present(state, &RestingMemo::of_mut(memo).to)?;
        let stretches = self.stretches(present.temperature);
        Ok(Fields::Particles(self.seen(&present, &stretches).particles(present.temperature)))
    }
}

impl Giver for RestingBody {}

impl Maxima for RestingBody {}

impl Approach for RestingBody {}

impl Advice for RestingBody {
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    fn temperature_set(&self, state: &[f64]) -> Option<f64> {
        Some(self.resting(state).temperature)
    }
}

impl Resources for RestingBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let work = WORK * self.equilibrium.body.space.volume.len();
        let foreseen = allowance.foresee_step(dt, ITERATIONS, STEPS, work);
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn updates(&self, _: f64) -> f64 {
        cost(ITERATIONS, WORK * self.equilibrium.body.space.volume.len())
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
