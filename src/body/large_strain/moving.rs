//! A solid of large strain that moves freely above a plane or another body.

use super::faces::{Faces, loaded};
use super::probes::Probes;
use super::snapshot::{Seen, Snapshot, columns, copies};
use super::totals::Sums;
use super::{LargeStrainMemo, View, is_large, plan};
use crate::body::{
    Acts, Advice, Approach, Body, BodyError, Fields, Given, Giver, Link, Maxima, Memo, Reading,
    Received, Resources,
};
use crate::inputs::InputLayout;
use crate::method::large_strain::{Dynamics, Failure, Motion};
use crate::port::WallCells;
use crate::runtime::allowance::{Allowance, cost};
use crate::scene::{LargeStrain, Scene};
use crate::state::{Layout, expect_like, layout_like, load, store, stored};

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
        let named = |failure| BodyError::LargeStrain { body: name.to_owned(), failure };
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

    fn motion(&self, state: &[f64]) -> Motion {
        let mut motion = self.start.clone();
        load(&mut motion, state);
        motion
    }

    fn snapshot(&self, motion: &Motion) -> Result<Snapshot, BodyError> {
        let touch = self.dynamics.plane.touch(&self.dynamics.body, &motion.displacement);
        let seen = Seen { touch: Some(&touch), ..self.seen(motion) };
        let stresses = seen.stresses().map_err(|failure| self.error(failure))?;
        Ok(seen.snapshot(&stresses))
    }

    fn view(&self, motion: &Motion) -> Result<View, BodyError> {
        let touch = self.dynamics.plane.touch(&self.dynamics.body, &motion.displacement);
        let seen = Seen { touch: Some(&touch), ..self.seen(motion) };
        let stresses = seen.stresses().map_err(|failure| self.error(failure))?;
        let snapshot = seen.snapshot(&stresses);
        let sums = self.sums(motion, &snapshot);
        let probed = self.probes.read(&seen, &stresses, self.temperature);
        Ok(View { snapshot, sums, forces: Vec::new(), probed })
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

    fn error(&self, failure: Failure) -> BodyError {
        let name = self.name.clone();
        match failure {
            Failure::Halted(halt) => BodyError::Halted { body: name, halt },
            failure => BodyError::LargeStrain { body: name, failure },
        }
    }

    /// Refuses a motion that breaks a conservation law.
    fn check_motion(&self, motion: &Motion) -> Result<(), String> {
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
}

impl Body for MovingBody {
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
        self.check_motion(&self.motion(state)).map_err(|reason| format!("{name}: {reason}"))
    }

    fn check_inputs(&self, _: &[f64]) -> Result<(), BodyError> {
        Ok(())
    }

    fn memo(&self, _: &[f64], _: &[Received]) -> Memo {
        Box::new(LargeStrainMemo::default())
    }

    fn forget_state(&self, memo: &mut Memo) {
        *memo = Box::new(LargeStrainMemo::default());
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let mut motion = self.motion(state);
        let loads = |time: f64| self.faces.prescribed(&acts.path.at(0, time)).loads;
        let advanced = self.dynamics.advance(&mut motion, acts.duration, &loads, allowance);
        advanced.map_err(|failure| self.error(failure))?;
        store(&mut motion, state);
        Ok(self.given(state))
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let memo = LargeStrainMemo::of_mut(memo);
        let view = match memo.0.take() {
            Some(known) => known,
            None => self.view(&self.motion(state))?,
        };
        memo.0.insert(view).read(reading)
    }

    fn fields(&self, state: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        let motion = self.motion(state);
        Ok(Fields::Particles(self.seen(&motion).particles(self.temperature)))
    }
}

impl Giver for MovingBody {
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        // A transfer to another body refers to the last exchange, however long the step.
        if self.traction.is_some() {
            return;
        }
        let (before, mut motion) = (self.motion(before).ledger, self.motion(state));
        motion.ledger.duration += before.duration;
        motion.ledger.outside += before.outside;
        store(&mut motion, state);
    }

    fn given(&self, state: &[f64]) -> Option<Given> {
        let traction = self.traction?;
        let ledger = self.motion(state).ledger;
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
