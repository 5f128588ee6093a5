//! A solid of large strain that moves freely above a plane, the cells of a wall, or another body.

use super::advised::Advised;
use super::faces::{Faces, loaded};
use super::probes::Probes;
use super::snapshot::{Seen, Snapshot, columns, copies};
use super::totals::Sums;
use super::warming::{Temperatures, Warming, heat_totals};
use super::{View, is_large, named, plan, warning_on_mirrors};
use crate::body::wall::{Below, wall_quantities};
use crate::body::{
    Acts, Advice, Approach, BodyError, Events, Given, Giver, Link, Maxima, Occasion, Reading,
    Resources, Structured,
};
use crate::inputs::InputLayout;
use crate::method::large_strain::{
    Acting, Contacts, Course, Courses, CoursesOver, Dynamics, Failure, Film, Motion, Place,
};
use crate::method::sph::ParticleFields;
use crate::port::{Surface, WallCells, WallExchange};
use crate::runtime::allowance::{Allowance, cost};
use crate::scene::{LargeStrain, Scene};
use crate::state::store_all;
use crate::warning::Warning;

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
    /// Heat of a body that conducts it, and conductance of its contact with what lies below [W/(m² K)].
    warming: Option<Warming>,
    conductance: Option<f64>,
    below: Below,
    advised: Advised,
}

/// Results of a state, with the heat and impulse of the cells below in the last step.
pub struct MovingView {
    own: View,
    exchange: WallExchange,
}

/// Share of the momentum or energy that a balance may miss.
const MOMENTUM: f64 = 1e-6;
const ENERGY: f64 = 0.1;
/// Rounding of the forces of many steps over those of the body's stiffness.
const ROUNDING: f64 = 1e-12;

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
        let threads = threads(is_large(plan::cells(&mesh) * 8));
        let body = plan::deformable(solid, threads).map_err(named)?;
        let advised = Advised::of((name, solid), &body);
        let plane = plan::plane(solid, &body);
        let columns = columns(&body.space, solid.is_box());
        let (below, cells) = Below::of((scene, layout), name, on);
        let faces = Faces::new(layout, (name, solid), &mesh, &body);
        let probes = Probes::new(scene, (name, solid), &mesh, &body);
        let probes = probes.map_err(|refused| named(refused.into()))?;
        let loaded = loaded(solid, &body);
        let warming = Warming::new(layout, (name, solid), &mesh, &body).map_err(named)?;
        let count = cells.as_ref().map_or(0, WallCells::len);
        let warmth = warming.as_ref().map(|own| own.start(count, true)).unwrap_or_default();
        let own = (body, loaded);
        let dynamics = Dynamics::new(own, plane, solid.gravity, solid.mirrors(), cells);
        let start = Motion { warmth, ..dynamics.start(solid.start.velocity) };
        Ok(Self {
            name: name.to_owned(),
            start,
            dynamics,
            faces,
            probes,
            mirrors: solid.mirrors(),
            columns,
            temperature: solid.initial_temperature,
            warming,
            conductance: solid.conductance_below,
            below,
            advised,
        })
    }

    fn snapshot(&self, motion: &Motion) -> Result<Snapshot, BodyError> {
        let touch = self.dynamics.contact(motion);
        let over = self.over(motion).map_err(|failure| named(&self.name, failure))?;
        let seen = Seen { touch: Some(&touch), ..self.seen(motion, &over) };
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        Ok(seen.snapshot(&stresses))
    }

    /// Thermal stretches that the stress has followed, over no time.
    fn over(&self, motion: &Motion) -> Result<Courses, Failure> {
        let body = &self.dynamics.body;
        match &self.warming {
            Some(warming) if warming.acts() => warming.stretched(body, &motion.warmth.felt),
            _ => Ok(body.in_all(Course::NONE)),
        }
    }

    fn temperatures<'a>(&self, motion: &'a Motion) -> Temperatures<'a> {
        Temperatures { base: self.temperature, rise: &motion.warmth.rise }
    }

    fn seen<'a>(&'a self, motion: &'a Motion, over: &'a Courses) -> Seen<'a> {
        Seen {
            body: &self.dynamics.body,
            mirrors: self.mirrors,
            lifted: self.dynamics.plane.height,
            displacement: &motion.displacement,
            over,
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
        if let Some(warming) = &self.warming {
            warming.check(&motion.warmth)?;
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
        let own = [&now, &start].map(|of| (2.0 * of.mass * of.kinetic).sqrt());
        let moving = own[0] + own[1] + self.rounding_of_momentum() / MOMENTUM;
        let scale = moving + fallen.abs() + ledger.impulse_to_plane.abs();
        if self.faces.loaded() == 0 && missing.abs() > MOMENTUM * scale {
            return Err(format!("{missing:.1e} N s of momentum along z have no cause"));
        }
        for axis in (0..2).filter(|&axis| !self.dynamics.symmetric()[axis]) {
            let dragged = motion.friction.impulse[axis];
            let missing = now.momentum[axis] - start.momentum[axis] + dragged;
            let scale = scale + dragged.abs();
            if self.faces.loaded() == 0 && missing.abs() > MOMENTUM * scale {
                return Err(format!("{missing:.1e} N s of momentum along the plane have no cause"));
            }
        }
        let copies = copies(self.mirrors);
        let contact = |motion: &Motion| self.dynamics.contact(motion).energy;
        let touch = contact(motion) - contact(&self.start);
        let internal = copies * (ledger.internal_work + touch + motion.friction.heat);
        let work = now.mass * gravity * (now.centre - start.centre) + copies * ledger.load_work;
        let missing = now.kinetic + internal - start.kinetic - work;
        let works = work.abs() + copies * ledger.internal_work.abs();
        let known = start.kinetic + now.stored.abs() + works;
        let scale = known + copies * self.rounding();
        if missing.abs() > ENERGY * scale {
            return Err(format!("{missing:.1e} J of energy have no cause"));
        }
        Ok(())
    }

    /// Energy of the model that is rounding [J]: faces that rest on the plane touch it by rounding.
    fn rounding(&self) -> f64 {
        let body = &self.dynamics.body;
        f64::EPSILON * body.wave_modulus() * body.space.volume.weights.iter().sum::<f64>()
    }

    /// Momentum of the body that is rounding [N s]: a part of its mass at the speed of its waves.
    fn rounding_of_momentum(&self) -> f64 {
        let body = &self.dynamics.body;
        let mass = body.mass.iter().sum::<f64>();
        let stiffness = body.wave_modulus() * body.space.volume.weights.iter().sum::<f64>();
        ROUNDING * copies(self.mirrors) * (mass * stiffness).sqrt()
    }

    fn sums(&self, motion: &Motion, snapshot: &Snapshot) -> Sums {
        let ledger = &motion.ledger;
        let inside: f64 = ledger.exchange.iter().sum();
        let rate = |amount: f64| if ledger.duration > 0.0 { amount / ledger.duration } else { 0.0 };
        let touch = self.dynamics.contact(motion);
        let stored = snapshot.stored - copies(self.mirrors) * touch.energy;
        let worked = ledger.internal_work + motion.warmth.swelling;
        let own = (&self.dynamics.body, &motion.warmth);
        Sums {
            dissipated: copies(self.mirrors) * worked - stored,
            load_work: copies(self.mirrors) * ledger.load_work,
            contact_force: rate(inside + ledger.outside),
            impulse: ledger.impulse_to_plane,
            shear: motion.friction.impulse,
            friction_heat: copies(self.mirrors) * motion.friction.heat,
            lift_off: ledger.lift_off,
            steps: ledger.steps,
            force_outside: rate(ledger.outside),
            heat: heat_totals(self.warming.as_ref(), own, copies(self.mirrors)),
        }
    }

    /// Advances motion and heat in turn: heat that also passes to a body below follows the motion that makes the
    /// contact, and stress then feels its temperatures in the next step.
    fn advance_warm(
        &self,
        warming: &Warming,
        motion: &mut Motion,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        warming.hold(&mut motion.warmth, &acts.path.at(0, 0.0));
        let wall = self.below.wall().map(|wall| wall.surface(acts));
        let below = self.conductance.zip(acts.below.or(wall.as_ref()));
        if below.is_none() {
            self.conduct(warming, motion, acts, Vec::new(), allowance)?;
        }
        let to = motion.warmth.rise.clone();
        let mut contacts = Contacts::default();
        let noted = below.is_some().then_some(&mut contacts);
        self.swell(motion, acts, Some((warming, &to)), noted, allowance)?;
        if warming.acts() {
            motion.warmth.felt = to;
        }
        match below {
            Some(below) => self.warm_below(warming, motion, acts, (below, &contacts), allowance),
            None => Ok(()),
        }
    }

    /// Conducts heat, also through contacts with a surface below of this conductance [W/(m² K)].
    fn warm_below(
        &self,
        warming: &Warming,
        motion: &mut Motion,
        acts: &Acts,
        ((conductance, surface), contacts): ((f64, &Surface), &Contacts),
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let copies = copies(self.mirrors);
        let films = contacts.films(surface, conductance, acts.duration, copies);
        let heats = self.conduct(warming, motion, acts, films, allowance)?;
        let warmth = &mut motion.warmth;
        warmth.exchange.fill(0.0);
        warmth.outside = 0.0;
        for (place, heat) in contacts.places().zip(heats) {
            match place {
                Place::Cell(cell) => warmth.exchange[cell] += copies * heat,
                Place::BeyondCell(_) => warmth.outside += copies * heat,
            }
        }
        Ok(())
    }

    fn conduct(
        &self,
        warming: &Warming,
        Motion { displacement, warmth, .. }: &mut Motion,
        acts: &Acts,
        films: Vec<Film>,
        allowance: &Allowance,
    ) -> Result<Vec<f64>, BodyError> {
        let own = (&self.name[..], &self.dynamics.body, &displacement[..]);
        warming.advance(own, warmth, (acts.path, acts.duration), films, allowance)
    }

    /// Moves the body, while its stress follows the temperature to a rise of each node [K].
    fn swell(
        &self,
        motion: &mut Motion,
        acts: &Acts,
        to: Option<(&Warming, &[f64])>,
        contacts: Option<&mut Contacts>,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let (body, duration) = (&self.dynamics.body, acts.duration);
        let loads = |time: f64| self.faces.prescribed(&acts.path.at(0, time)).loads;
        let felt = motion.warmth.felt.clone();
        let felt_course = to.filter(|(warming, _)| warming.acts()).map(|(warming, to)| {
            let ends = [&felt[..], to].map(|rise| warming.of_groups(body, rise));
            move |[time, dt]: [f64; 2]| warming.swelling(body, &ends, [time, dt], duration)
        });
        let courses = felt_course.as_ref().map(|courses| courses as &CoursesOver);
        let acting = Acting { loads: &loads, courses };
        let advanced = self.dynamics.advance(motion, duration, &acting, contacts, allowance);
        advanced.map_err(|failure| named(&self.name, failure))
    }

    /// Returns the heat and impulse of the cells below in the last step, and beyond them.
    fn exchange(&self, Motion { ledger, warmth, friction, .. }: &Motion) -> WallExchange {
        let heat = match warmth.exchange.is_empty() {
            true => vec![0.0; ledger.exchange.len()],
            false => warmth.exchange.clone(),
        };
        let along = |cell: usize| friction.exchange.get(cell).copied().unwrap_or_default();
        let impulse = ledger.exchange.iter().enumerate().map(|(cell, &impulse)| {
            let [x, y] = along(cell);
            [x, y, -impulse]
        });
        WallExchange {
            duration: ledger.duration,
            heat,
            impulse: impulse.collect(),
            heat_outside: warmth.outside,
            impulse_outside: [0.0, 0.0, -ledger.outside],
        }
    }

    fn given_of(&self, motion: &Motion) -> Option<Given> {
        let Below::Body { traction } = self.below else { return None };
        let WallExchange { duration, heat, impulse, .. } = self.exchange(motion);
        Some(Given {
            duration,
            heat,
            falling: Vec::new(),
            impulse: if traction { impulse } else { Vec::new() },
            symmetric: self.dynamics.symmetric(),
        })
    }
}

impl Structured for MovingBody {
    type State = Motion;
    type View = MovingView;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &Motion {
        &self.start
    }

    fn check(&self, state: &Motion) -> Result<(), String> {
        self.check_motion(state)
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.below.check_inputs(inputs)?;
        self.warming.as_ref().map_or(Ok(()), |warming| warming.check_inputs(inputs))
    }

    fn advance(
        &self,
        state: &mut Motion,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        match &self.warming {
            Some(warming) => self.advance_warm(warming, state, acts, allowance)?,
            None => self.swell(state, acts, None, None, allowance)?,
        }
        Ok(self.given_of(state))
    }

    fn view(&self, state: Motion, _: &[f64]) -> Result<MovingView, BodyError> {
        let touch = self.dynamics.contact(&state);
        let over = self.over(&state).map_err(|failure| named(&self.name, failure))?;
        let seen = Seen { touch: Some(&touch), ..self.seen(&state, &over) };
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        let snapshot = seen.snapshot(&stresses);
        let sums = self.sums(&state, &snapshot);
        let probed = self.probes.read(&seen, &stresses, self.temperatures(&state));
        let own = View { snapshot, sums, forces: Vec::new(), probed };
        Ok(MovingView { own, exchange: self.exchange(&state) })
    }

    fn read(&self, view: &MovingView, reading: &Reading) -> Result<f64, BodyError> {
        let Reading::Cell { quantity, cell } = *reading else { return view.own.read(reading) };
        let wall = self.below.wall().ok_or(BodyError::NoSuchReading)?;
        wall_quantities()[quantity].mean(&view.exchange, cell, wall)
    }

    fn drawn(&self, state: Motion, _: &[f64]) -> Result<ParticleFields, BodyError> {
        let over = self.over(&state).map_err(|failure| named(&self.name, failure))?;
        let seen = self.seen(&state, &over);
        let stresses = seen.stresses().map_err(|failure| named(&self.name, failure))?;
        Ok(seen.particles(&stresses, self.temperatures(&state)))
    }
}

impl Giver for MovingBody {
    /// Transfers to another body refer to the last exchange, however long the step.
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        if matches!(self.below, Below::Body { .. }) {
            return;
        }
        let mut motion = self.structure(state);
        motion.add_exchange(&self.structure(before));
        store_all(&mut motion, state);
    }

    fn given(&self, state: &[f64]) -> Option<Given> {
        self.given_of(&self.structure(state))
    }
}

impl Events for MovingBody {}

impl Maxima for MovingBody {}

impl Approach for MovingBody {}

impl Advice for MovingBody {
    fn notes(&self) -> Vec<String> {
        self.advised.notes()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        let displacement = match occasion {
            Occasion::Step => self.structure(state).displacement,
            Occasion::Response { .. } | Occasion::End => return Vec::new(),
        };
        let own = (&self.name[..], &self.dynamics.body);
        warning_on_mirrors(own, &displacement).into_iter().collect()
    }

    fn warning_on_value(&self, reading: &Reading, value: f64) -> Option<Warning> {
        self.advised.on_value(reading, value)
    }

    fn temperature_range(&self, state: &[f64], _: &[f64]) -> Option<[f64; 2]> {
        let warming = self.warming.as_ref()?;
        Some(warming.range(&self.structure(state).warmth))
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
