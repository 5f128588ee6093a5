//! A lattice with inertia, whose load moves at constant speed over each step.

use super::totals::{self, Seen};
use super::{Drawn, forecast, named, plan};
use crate::body::{
    Acts, Advice, Approach, BodyError, Events, Given, Giver, Maxima, Reading, Resources, Structured,
};
use crate::inputs::{InputLayout, InputPath};
use crate::method::lattice::{LatticeMotion, MovingLattice};
use crate::method::sph::ParticleFields;
use crate::runtime::allowance::Allowance;
use crate::scene;
use crate::state::store_all;

/// A lattice that moves by explicit steps.
pub struct MovingLatticeBody {
    name: String,
    lattice: MovingLattice,
    start: LatticeMotion,
    /// Place of its input.
    input: usize,
    drawn: Drawn,
    notes: Vec<String>,
    threads: usize,
}

/// Number of particles from which threads pay off.
const LARGE: usize = 20_000;

impl MovingLatticeBody {
    pub fn new(
        layout: &InputLayout,
        (name, own): (&str, &scene::Lattice),
        threads: impl Fn(bool) -> usize,
    ) -> Result<Self, BodyError> {
        let plan = plan::plan_of(own);
        let threads = threads(plan.strip.count() > LARGE);
        let lattice = MovingLattice::new(plan, plan::inertia_of(own), threads);
        let lattice = lattice.map_err(|error| named(name, error))?;
        Ok(Self {
            name: name.to_owned(),
            start: lattice.initial_state(),
            input: layout.of_body(name).start,
            drawn: Drawn {
                density: own.material.density,
                thickness: own.thickness,
                temperature: own.initial_temperature,
            },
            notes: forecast::notes(own),
            lattice,
            threads,
        })
    }
}

impl Structured for MovingLatticeBody {
    type State = LatticeMotion;
    type View = Seen;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &LatticeMotion {
        &self.start
    }

    fn check(&self, state: &LatticeMotion) -> Result<(), String> {
        self.lattice.check(state)
    }

    fn advance(
        &self,
        state: &mut LatticeMotion,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let target = acts.path.at(0, acts.duration)[self.input];
        let moved = self.lattice.advance(state, target, acts.duration, allowance);
        moved.map_err(|error| named(&self.name, error))?;
        Ok(None)
    }

    fn view(&self, state: LatticeMotion, _: &[f64]) -> Result<Seen, BodyError> {
        Ok(Seen::in_motion(&state, self.lattice.totals(&state), self.lattice.mass()))
    }

    fn read(&self, view: &Seen, reading: &Reading) -> Result<f64, BodyError> {
        totals::read(reading, view)
    }

    fn drawn(&self, state: LatticeMotion, _: &[f64]) -> Result<ParticleFields, BodyError> {
        let all = state.displacement.iter().zip(&state.velocity);
        let motion = all.map(|(moved, velocity)| [moved, velocity].map(|[x, z, _]| [*x, *z]));
        let inside = self.lattice.at_particles(&state);
        Ok(self.drawn.particles(self.lattice.particles(), motion, inside))
    }
}

impl Giver for MovingLatticeBody {
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        let (before, mut own) = (self.structure(before), self.structure(state));
        own.duration += before.duration;
        own.impulse += before.impulse;
        store_all(&mut own, state);
    }
}

impl Events for MovingLatticeBody {
    fn has_events(&self) -> bool {
        true
    }

    /// An event is the separation of a part.
    fn event_between(&self, before: &[f64], after: &[f64]) -> bool {
        let [before, after] =
            [before, after].map(|own| self.lattice.fragments(&self.structure(own)));
        after > before
    }
}

impl Maxima for MovingLatticeBody {}

impl Approach for MovingLatticeBody {
    /// The load moves from where it is to its value at the end of a step.
    fn approached(
        &self,
        state: &mut Vec<f64>,
        path: &InputPath,
        (_, ahead): (f64, f64),
    ) -> Vec<(usize, [f64; 2])> {
        let from = self.structure(state).prescribed;
        let to = path.at(0, ahead)[self.input];
        vec![(self.input, [from, (to - from) / ahead])]
    }
}

impl Advice for MovingLatticeBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }
}

impl Resources for MovingLatticeBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        self.lattice.foresee(dt, allowance).map_err(|error| named(&self.name, error))
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
