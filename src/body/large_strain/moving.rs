//! A solid of large strain that moves freely above a plane or another body.

use super::faces::{Faces, loaded};
use super::probes::Probes;
use super::snapshot::{Seen, Snapshot, columns, copies};
use super::totals::Sums;
use super::{View, is_large, named, plan};
use crate::body::{
    Acts, Advice, Approach, BodyError, Given, Giver, Link, Maxima, Reading, Resources, Structured,
};
use crate::inputs::InputLayout;
use crate::method::large_strain::{Dynamics, Motion};
use crate::method::sph::ParticleFields;
use crate::port::WallCells;
use crate::runtime::allowance::{Allowance, cost};
use crate::scene::{LargeStrain, Scene};
use crate::state::store_all;

/// A body with inertia.
pub struct MovingBody {
    name: String,
    dynamics: Dynamics,
    start: Motion,
    faces: Faces,
    probes: Probes,
    mirrors: [bool; 2],
    columns: Vec<[usize; 2]>,
    temperature: f64,
    /// True if the impulse on what lies below is transferred; `None` above a rigid plane.
    traction: Option<bool>,
    notes: Vec<String>,
}

/// Share of the momentum or energy that a balance may miss.
const MOMENTUM: f64 = 1e-6;
const ENERGY: f64 = 0.1;

impl MovingBody {
    /// `on` holds the cells of a body below and the link with it.
    pub fn new(
        (scene, layout): (&Scene, &InputLayout),
        (name, solid): (&str, &LargeStrain),
        on: Option<(WallCells, &Link)>,
        threads: impl Fn(bool) -> usize,
    ) -> Result<Self, BodyError> {
        let named = |failure| named(name, failure);
        let mesh = plan::mesh(solid);
        let threads = threads(is_large(mesh.cells.len() * 8));
        let body = plan::deformable(solid, threads).map_err(named)?;
        let plane = plan::plane(solid, &body);
        let columns = columns(&body.space, solid.is_box());
        let traction = on.as_ref().map(|(_, link)| link.traction);
        let cells = on.map(|(cells, _)| cells);
        let faces = Faces::new(layout, (name, solid), &mesh, &body);
        let probes = Probes::new(scene, (name, solid), &mesh, &body);
        let probes = probes.map_err(|refused| named(refused.into()))?;
        let loaded = loaded(solid, &body);
        let own = (body, loaded);
        let dynamics = Dynamics::new(own, plane, solid.gravity, solid.mirrors(), cells);
        let start = dynamics.start(solid.start.velocity);
        Ok(Self {
            name: name.to_owned(),
            start,
            dynamics,
            faces,
            probes,
            mirrors: solid.mirrors(),
            columns,
            temperature: solid.initial_temperature,
            traction,
            notes: super::forecast::notes(solid),
        })
    }

    fn snapshot(&self, motion: &Motion) -> Result<Snapshot, BodyError> {
        let touch = self.dynamics.plane.touch(&self.dynamics.body, &motion.displacement);
        let seen = Seen { touch: Some(&touch), ..self.seen(motion) };
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        Ok(seen.snapshot(&stresses))
    }

    fn seen<'a>(&'a self, motion: &'a Motion) -> Seen<'a> {
        Seen {
            body: &self.dynamics.body,
            mirrors: self.mirrors,
            lifted: self.dynamics.plane.height,
            displacement: &motion.displacement,
            stretches: &[1.0],
            columns: &self.columns,
            velocity: Some(&motion.velocity),
            history: &motion.history,
            touch: None,
        }
    }

    /// Refuses a motion that breaks a conservation law.
    fn check_motion(&self, motion: &Motion) -> Result<(), String> {
        if !self.dynamics.body.is_sound(&motion.history) {
            return Err("plastic strain, damage and compaction are not negative".to_owned());
        }
        let fixed = &self.dynamics.body.fixed;
        for values in [&motion.displacement, &motion.velocity] {
            let moves = |(value, fixed): (&[f64; 3], &[bool; 3])| {
                (0..3).any(|a| fixed[a] && value[a] != 0.0)
            };
            if values.iter().zip(fixed).any(moves) {
                return Err("a node moves along an axis that holds it".to_owned());
            }
        }
        let ledger = &motion.ledger;
        if ledger.time < 0.0 || ledger.steps < 0.0 || ledger.duration < 0.0 {
            return Err("time, steps and their lengths are not negative".to_owned());
        }
        let of = |motion: &Motion| self.snapshot(motion).map_err(|error| error.to_string());
        let (now, start) = (of(motion)?, of(&self.start)?);
        let gravity = self.dynamics.gravity[2];
        let fallen = now.mass * gravity * ledger.time;
        let missing = now.momentum[2] - start.momentum[2] - fallen - ledger.impulse_to_plane;
        let scale = start.momentum[2].abs() + fallen.abs() + ledger.impulse_to_plane.abs();
        if self.faces.loaded() == 0 && missing.abs() > MOMENTUM * scale {
            return Err(format!("{missing:.1e} N s of momentum along z have no cause"));
        }
        let copies = copies(self.mirrors);
        let touch = self.dynamics.plane.touch(&self.dynamics.body, &motion.displacement);
        let internal = copies * (ledger.internal_work + touch.energy);
        let work = now.mass * gravity * (now.centre - start.centre) + copies * ledger.load_work;
        let missing = now.kinetic + internal - start.kinetic - work;
        let scale = start.kinetic + work.abs() + copies * ledger.internal_work.abs();
        if missing.abs() > ENERGY * scale {
            return Err(format!("{missing:.1e} J of energy have no cause"));
        }
        Ok(())
    }

    fn sums(&self, motion: &Motion, snapshot: &Snapshot) -> Sums {
        let ledger = &motion.ledger;
        let inside: f64 = ledger.exchange.iter().sum();
        let rate = |amount: f64| if ledger.duration > 0.0 { amount / ledger.duration } else { 0.0 };
        let touch = self.dynamics.plane.touch(&self.dynamics.body, &motion.displacement);
        let stored = snapshot.stored - copies(self.mirrors) * touch.energy;
        Sums {
            dissipated: copies(self.mirrors) * ledger.internal_work - stored,
            load_work: copies(self.mirrors) * ledger.load_work,
            contact_force: rate(inside + ledger.outside),
            impulse: ledger.impulse_to_plane,
            lift_off: ledger.lift_off,
            steps: ledger.steps,
            force_outside: rate(ledger.outside),
        }
    }

    fn given_of(&self, Motion { ledger, .. }: &Motion) -> Option<Given> {
        let traction = self.traction?;
        let impulse = ledger.exchange.iter().map(|&impulse| [0.0, 0.0, -impulse]);
        Some(Given {
            duration: ledger.duration,
            heat: vec![0.0; ledger.exchange.len()],
            falling: Vec::new(),
            impulse: if traction { impulse.collect() } else { Vec::new() },
            symmetric: self.dynamics.symmetric(),
        })
    }
}

impl Structured for MovingBody {
    type State = Motion;
    type View = View;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &Motion {
        &self.start
    }

    fn check(&self, state: &Motion) -> Result<(), String> {
        self.check_motion(state)
    }

    fn advance(
        &self,
        state: &mut Motion,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let loads = |time: f64| self.faces.prescribed(&acts.path.at(0, time)).loads;
        let advanced = self.dynamics.advance(state, acts.duration, &loads, allowance);
        advanced.map_err(|failure| named(&self.name, failure))?;
        Ok(self.given_of(state))
    }

    fn view(&self, state: Motion, _: &[f64]) -> Result<View, BodyError> {
        let touch = self.dynamics.plane.touch(&self.dynamics.body, &state.displacement);
        let seen = Seen { touch: Some(&touch), ..self.seen(&state) };
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        let snapshot = seen.snapshot(&stresses);
        let sums = self.sums(&state, &snapshot);
        let probed = self.probes.read(&seen, &stresses, self.temperature);
        Ok(View { snapshot, sums, forces: Vec::new(), probed })
    }

    fn read(&self, view: &View, reading: &Reading) -> Result<f64, BodyError> {
        view.read(reading)
    }

    fn drawn(&self, state: Motion, _: &[f64]) -> Result<ParticleFields, BodyError> {
        Ok(self.seen(&state).particles(self.temperature))
    }
}

impl Giver for MovingBody {
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        // A transfer to another body refers to the last exchange, however long the step.
        if self.traction.is_some() {
            return;
        }
        let (before, mut motion) = (self.structure(before).ledger, self.structure(state));
        motion.ledger.duration += before.duration;
        motion.ledger.outside += before.outside;
        store_all(&mut motion, state);
    }

    fn given(&self, state: &[f64]) -> Option<Given> {
        self.traction?;
        self.given_of(&self.structure(state))
    }
}

impl Maxima for MovingBody {}

impl Approach for MovingBody {}

impl Advice for MovingBody {
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }
}

impl Resources for MovingBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let steps = dt / self.dynamics.usual_step();
        let what = "time steps of a solid of large strain";
        let foreseen = allowance.foresee_step(dt, steps, what, self.dynamics.work());
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn updates(&self, dt: f64) -> f64 {
        cost(dt / self.dynamics.usual_step(), self.dynamics.work())
    }

    fn threads(&self) -> usize {
        self.dynamics.body.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
