//! A solid of large strain that moves by implicit steps, with faces that are held, moved or loaded.

use std::slice::from_mut;

use super::advised::Advised;
use super::bends::BendTest;
use super::faces::{Faces, Prescribed, loaded};
use super::probes::Probes;
use super::snapshot::{Seen, Snapshot, columns, copies};
use super::totals::Sums;
use super::warming::Temperatures;
use super::{View, is_large, named, plan, warning_on_mirrors};
use crate::body::{
    Acts, Advice, Approach, BodyError, Events, Given, Giver, Maxima, Occasion, Reading, Resources,
    Structured,
};
use crate::inputs::InputLayout;
use crate::method::large_strain::{
    Course, Courses, Deformable, Drive, Failure, IMPLICIT_STEPS, IMPLICIT_WORK, ImplicitDynamics,
    Motion,
};
use crate::method::sph::ParticleFields;
use crate::runtime::allowance::Allowance;
use crate::scene::{LargeStrain, Scene};
use crate::state::{Field, Fields, Per, store_all};
use crate::warning::{self, Warning};

/// A body with inertia whose time steps are those of communication.
pub struct SwingingBody {
    name: String,
    dynamics: ImplicitDynamics,
    start: Swinging,
    /// Time in which a wave crosses the body [s].
    crossing: f64,
    faces: Faces,
    probes: Probes,
    mirrors: [bool; 2],
    columns: Vec<[usize; 2]>,
    temperature: f64,
    /// No stretch over no time.
    still: Courses,
    advised: Advised,
    bend_test: BendTest,
}

/// State of the body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Swinging {
    motion: Motion,
    /// Forces on the faces that are held or moved, means over the last step, whose length the ledger has [N].
    forces: Vec<[f64; 3]>,
    /// Shortest part into which a step was cut as a face changed its speed [s]; zero if none was.
    cut: f64,
    /// Time until which waves that a face sends out cross the body some times [s].
    waves_until: f64,
}

impl Fields for Swinging {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| of(name, words, Per::Body, 1);
        let Motion { ledger, displacement, velocity, history, .. } = &mut self.motion;
        vec![
            (body("time", "time since the start [s]"), from_mut(&mut ledger.time)),
            (body("steps", "time steps made"), from_mut(&mut ledger.steps)),
            (body("duration", "length of the last step [s]"), from_mut(&mut ledger.duration)),
            (
                body("internal_work", "work of the stresses [J]"),
                from_mut(&mut ledger.internal_work),
            ),
            (body("load_work", "work of loads on faces [J]"), from_mut(&mut ledger.load_work)),
            (body("face_work", "work of held faces [J]"), from_mut(&mut ledger.face_work)),
            (body("turnover", "sum of the sizes of all works [J]"), from_mut(&mut ledger.turnover)),
            (body("cut", "shortest part of a step with a jolt [s]"), from_mut(&mut self.cut)),
            (
                body("waves_until", "time until which waves of a jolt cross the body [s]"),
                from_mut(&mut self.waves_until),
            ),
            (
                of("forces", "forces on held faces in the last step [N]", Per::Face, 3),
                self.forces.as_flattened_mut(),
            ),
            (of("displacement", "displacement [m]", Per::Node, 3), displacement.as_flattened_mut()),
            (of("velocity", "velocity [m/s]", Per::Node, 3), velocity.as_flattened_mut()),
            (of("history", "history of the law", Per::Point, 1), history),
        ]
    }
}

impl Swinging {
    /// Extends the last step by the one before.
    fn join(&mut self, before: &Self) {
        let [own, earlier] = [&self.motion, &before.motion].map(|motion| motion.ledger.duration);
        let whole = earlier + own;
        for (force, before) in self.forces.iter_mut().zip(&before.forces) {
            *force = [0, 1, 2].map(|a| (earlier * before[a] + own * force[a]) / whole);
        }
        self.motion.ledger.duration = whole;
    }
}

/// Halvings of a step that Newton's method does not solve.
const HALVINGS: u32 = 10;
/// Energy of the whole body at the change of speed of a face, over that of the body, from which on it is a jolt;
/// halvings of such a step, and the change of the work of faces, over that energy, at which it is resolved.
const JOLT: f64 = 0.02;
const FINEST: u32 = 5;
const RESOLVED: f64 = 0.02;
/// Crossings of the body by waves after a jolt in which steps are examined like that of the jolt.
const CROSSINGS: f64 = 5.0;
/// Iterations of a usual step.
const ITERATIONS: f64 = 5.0;
/// Part of the work of the stresses from which on loads, not moved faces, have bent a body.
const BY_LOADS: f64 = 0.5;
/// Share of the energy that a balance may miss, and that of all works, as forces balance to a part of their size.
const ENERGY: f64 = 1e-5;
const UNBALANCED: f64 = 1e-9;

impl SwingingBody {
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
        let columns = columns(&body.space, solid.is_box());
        let faces = Faces::new(layout, (name, solid), &mesh, &body);
        let probes = Probes::new(scene, (name, solid), &mesh, &body);
        let probes = probes.map_err(|refused| named(refused.into()))?;
        let loaded = loaded(solid, &body);
        let dynamics = ImplicitDynamics::new(body, &faces.held(), loaded, solid.gravity);
        let dynamics = dynamics.map_err(named)?;
        let crossing = crossing(&dynamics.body);
        let still = dynamics.body.in_all(Course::NONE);
        let motion = dynamics.start(solid.start.velocity);
        let start = Swinging { motion, forces: faces.no_forces(), ..Swinging::default() };
        Ok(Self {
            name: name.to_owned(),
            dynamics,
            start,
            crossing,
            faces,
            probes,
            mirrors: solid.mirrors(),
            columns,
            temperature: solid.initial_temperature,
            still,
            advised,
            bend_test: BendTest::of((name, solid)),
        })
    }

    /// Swings over a communication step. A step in which a face changes its speed abruptly is cut into equal parts,
    /// until halves of them hardly change the work of the faces; so are those in which its waves cross the body a few
    /// times.
    fn swing_through(
        &self,
        state: &mut Swinging,
        ends: (&Prescribed, &Prescribed),
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let jolt = self.jolt(&state.motion, ends.1, dt);
        let mut swung = state.clone();
        self.swing(&mut swung, ends, dt, HALVINGS, allowance)?;
        let is_abrupt = jolt > JOLT * self.energy(&swung.motion);
        if is_abrupt {
            state.waves_until = swung.motion.ledger.time + CROSSINGS * self.crossing;
        }
        let is_examined = state.motion.ledger.time < state.waves_until;
        let finest = if is_examined { FINEST } else { 0 };
        for halvings in 1..=finest {
            let mut finer = state.clone();
            match self.swing_in_parts(&mut finer, ends, dt, halvings, allowance) {
                Ok(()) => {}
                Err(failure @ Failure::Halted(_)) => return Err(failure),
                Err(_) => break,
            }
            let change = finer.motion.ledger.face_work - swung.motion.ledger.face_work;
            let is_resolved = change.abs() <= RESOLVED * self.energy(&finer.motion);
            swung = finer;
            // The half of it has shown whether this part would do.
            let part = dt * 0.5_f64.powi(halvings as i32 - i32::from(is_resolved));
            if part < dt {
                swung.cut = if state.cut > 0.0 { state.cut.min(part) } else { part };
            }
            if is_resolved {
                break;
            }
        }
        *state = swung;
        Ok(())
    }

    fn swing_in_parts(
        &self,
        state: &mut Swinging,
        (from, to): (&Prescribed, &Prescribed),
        dt: f64,
        halvings: u32,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        if halvings == 0 {
            return self.swing(state, (from, to), dt, HALVINGS, allowance);
        }
        let middle = from.middle(to);
        self.swing_in_parts(state, (from, &middle), 0.5 * dt, halvings - 1, allowance)?;
        self.swing_in_parts(state, (&middle, to), 0.5 * dt, halvings - 1, allowance)
    }

    /// Kinetic energy of the whole body at the largest change of the speed of a moved face in a step [J].
    fn jolt(&self, motion: &Motion, to: &Prescribed, dt: f64) -> f64 {
        let [before, at] =
            [&motion.velocity, &motion.displacement].map(|own| self.faces.places(own));
        let changes = to.places.iter().zip(&at).zip(&before).map(|((to, at), before)| {
            (0..3).map(|a| ((to[a] - at[a]) / dt - before[a]).powi(2)).sum::<f64>()
        });
        0.5 * self.dynamics.body.mass.iter().sum::<f64>() * changes.fold(0.0, f64::max)
    }

    /// Scale of the energy of a motion [J].
    fn energy(&self, motion: &Motion) -> f64 {
        let squares = motion.velocity.iter().map(|v| v.iter().map(|v| v * v).sum::<f64>());
        let kinetic = self.dynamics.body.mass.iter().zip(squares).map(|(m, v)| 0.5 * m * v);
        kinetic.sum::<f64>() + motion.ledger.internal_work.abs()
    }

    /// Moves to the places of the faces after a time [s] under the loads of its middle; halves the step where Newton's
    /// method fails. Faces move evenly.
    fn swing(
        &self,
        state: &mut Swinging,
        (from, to): (&Prescribed, &Prescribed),
        dt: f64,
        halvings: u32,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let middle = from.middle(to);
        let displacements = self.faces.displacements(&to.places);
        let drive = Drive { displacements, loads: middle.loads.clone() };
        match self.dynamics.step(&mut state.motion, &drive, dt, allowance) {
            Ok(stepped) => {
                let forces = self.faces.forces(&stepped.reactions);
                for (sum, force) in state.forces.iter_mut().zip(&forces) {
                    (0..3).for_each(|a| sum[a] += dt * force[a]);
                }
                Ok(())
            }
            Err(failure @ Failure::Halted(_)) => Err(failure),
            Err(failure) if halvings == 0 => Err(failure),
            Err(_) => {
                self.swing(state, (from, &middle), 0.5 * dt, halvings - 1, allowance)?;
                self.swing(state, (&middle, to), 0.5 * dt, halvings - 1, allowance)
            }
        }
    }

    fn snapshot(&self, motion: &Motion) -> Result<Snapshot, BodyError> {
        let seen = self.seen(motion);
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        Ok(seen.snapshot(&stresses))
    }

    fn temperatures(&self) -> Temperatures<'_> {
        Temperatures { base: self.temperature, rise: &[] }
    }

    fn seen<'a>(&'a self, motion: &'a Motion) -> Seen<'a> {
        Seen {
            body: &self.dynamics.body,
            mirrors: self.mirrors,
            lifted: 0.0,
            displacement: &motion.displacement,
            over: &self.still,
            columns: &self.columns,
            velocity: Some(&motion.velocity),
            history: &motion.history,
            touch: None,
        }
    }

    /// Refuses a motion whose energy does not balance.
    fn check_motion(&self, motion: &Motion) -> Result<(), String> {
        if !self.dynamics.body.is_sound(&motion.history) {
            return Err("plastic strain, damage and compaction are not negative".to_owned());
        }
        self.faces.check(&motion.displacement)?;
        self.faces.check(&motion.velocity)?;
        let ledger = &motion.ledger;
        if ledger.time < 0.0 || ledger.steps < 0.0 {
            return Err("time and steps are not negative".to_owned());
        }
        if !(0.0..f64::INFINITY).contains(&ledger.turnover) {
            return Err("the sum of the sizes of works is finite and not negative".to_owned());
        }
        let of = |motion: &Motion| self.snapshot(motion).map_err(|error| error.to_string());
        let (now, start) = (of(motion)?, of(&self.start.motion)?);
        let copies = copies(self.mirrors);
        let fallen = now.mass * self.dynamics.gravity[2] * (now.centre - start.centre);
        let inside = copies * ledger.internal_work;
        let works = [fallen, copies * ledger.load_work, copies * ledger.face_work, -inside];
        let missing = now.kinetic - start.kinetic - works.iter().sum::<f64>();
        let scale = start.kinetic + works.iter().map(|work| work.abs()).sum::<f64>();
        let unbalanced = UNBALANCED * ledger.turnover + self.dynamics.rounding_of_energy;
        if missing.is_nan() || missing.abs() > ENERGY * scale + copies * unbalanced {
            return Err(format!("{missing:.1e} J of energy have no cause"));
        }
        Ok(())
    }

    fn sums(&self, motion: &Motion, snapshot: &Snapshot) -> Sums {
        let (ledger, copies) = (&motion.ledger, copies(self.mirrors));
        Sums {
            dissipated: copies * ledger.internal_work - snapshot.stored,
            load_work: copies * ledger.load_work,
            steps: ledger.steps,
            ..Sums::default()
        }
    }
}

impl SwingingBody {
    /// Warns of faces that change their speed faster than steps resolve.
    fn warning_on_jolts(&self, state: &[f64]) -> Option<Warning> {
        let Swinging { cut, .. } = self.structure(state);
        (cut > 0.0).then(|| {
            let finding = warning::steps_miss_jolts(format!("{cut:.1e}"));
            finding.at(&self.name).whatever_its_numbers()
        })
    }

    /// Warns of bends beyond yield that the mesh resolves poorly.
    fn warning_on_bends(&self, state: &[f64]) -> Option<Warning> {
        let Motion { ledger, history, .. } = self.structure(state).motion;
        let is_loaded = ledger.load_work > BY_LOADS * ledger.internal_work;
        self.bend_test.warning(&self.dynamics.body, &history, is_loaded)
    }
}

/// Time in which a wave crosses the longest side of the box about a body [s].
fn crossing(body: &Deformable) -> f64 {
    let nodes = &body.space.nodes;
    let along = |a: usize| {
        let (low, high) =
            nodes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
                (low.min(at[a]), high.max(at[a]))
            });
        high - low
    };
    let length = (0..3).map(along).fold(0.0, f64::max);
    let volume: f64 = body.space.volume.weights.iter().sum();
    let density = body.mass.iter().sum::<f64>() / volume;
    length * (density / body.wave_modulus()).sqrt()
}

impl Structured for SwingingBody {
    type State = Swinging;
    type View = View;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &Swinging {
        &self.start
    }

    fn check(
        &self,
        Swinging { motion, forces, cut, waves_until }: &Swinging,
    ) -> Result<(), String> {
        let last = motion.ledger.time + CROSSINGS * self.crossing;
        if ![cut, waves_until].iter().all(|own| (0.0..=last).contains(own)) {
            return Err("waves of a jolt do not last longer than the run".to_owned());
        }
        if !(0.0..=last).contains(&motion.ledger.duration) {
            return Err("a step does not last longer than the run".to_owned());
        }
        if !forces.as_flattened().iter().all(|force| force.is_finite()) {
            return Err("a force is not finite".to_owned());
        }
        self.check_motion(motion)
    }

    fn advance(
        &self,
        state: &mut Swinging,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        state.forces.fill([0.0; 3]);
        let mut from = self.faces.prescribed(&acts.path.at(0, 0.0));
        // Faces move from where they are, even if their inputs have jumped.
        from.places = self.faces.places(&state.motion.displacement);
        let to = self.faces.prescribed(&acts.path.at(0, acts.duration));
        let swung = self.swing_through(state, (&from, &to), acts.duration, allowance);
        swung.map_err(|failure| named(&self.name, failure))?;
        state.forces.iter_mut().flatten().for_each(|force| *force /= acts.duration);
        state.motion.ledger.duration = acts.duration;
        Ok(None)
    }

    fn view(
        &self,
        Swinging { motion, forces, .. }: Swinging,
        _: &[f64],
    ) -> Result<View, BodyError> {
        let seen = self.seen(&motion);
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        let snapshot = seen.snapshot(&stresses);
        let sums = self.sums(&motion, &snapshot);
        let probed = self.probes.read(&seen, &stresses, self.temperatures());
        Ok(View { snapshot, sums, forces, probed })
    }

    fn read(&self, view: &View, reading: &Reading) -> Result<f64, BodyError> {
        view.read(reading)
    }

    fn drawn(
        &self,
        Swinging { motion, .. }: Swinging,
        _: &[f64],
    ) -> Result<ParticleFields, BodyError> {
        let seen = self.seen(&motion);
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        Ok(seen.particles(&stresses, self.temperatures()))
    }
}

impl Giver for SwingingBody {
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        let (before, mut own) = (self.structure(before), self.structure(state));
        own.join(&before);
        store_all(&mut own, state);
    }
}

impl Events for SwingingBody {}

impl Maxima for SwingingBody {}

impl Approach for SwingingBody {
    fn shared_by_parts(&self, state: &[f64]) -> Vec<(usize, f64)> {
        self.faces.displacing(&self.structure(state).motion.displacement)
    }
}

impl Advice for SwingingBody {
    fn notes(&self) -> Vec<String> {
        self.advised.notes()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        match occasion {
            Occasion::Step => {
                let displacement = self.structure(state).motion.displacement;
                let own = (&self.name[..], &self.dynamics.body);
                let all = [warning_on_mirrors(own, &displacement), self.warning_on_jolts(state)];
                all.into_iter().flatten().collect()
            }
            Occasion::Response { .. } => Vec::new(),
            Occasion::End => self.warning_on_bends(state).into_iter().collect(),
        }
    }

    fn warning_on_value(&self, reading: &Reading, value: f64) -> Option<Warning> {
        self.advised.on_value(reading, value)
    }
}

impl Resources for SwingingBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let work = IMPLICIT_WORK * self.dynamics.body.space.volume.len();
        let foreseen = allowance.foresee_step(dt, ITERATIONS, IMPLICIT_STEPS, work);
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn threads(&self) -> usize {
        self.dynamics.body.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
