//! A lattice with inertia, whose load moves at constant speed over each step.

use super::totals::{self, Seen};
use super::{Drawn, LatticeMemo, forecast, plan};
use crate::body::{
    Acts, Advice, Approach, Body, BodyError, Fields, Given, Giver, Maxima, Memo, Reading, Received,
    Resources,
};
use crate::inputs::{InputLayout, InputPath};
use crate::method::lattice::{LatticeError, LatticeMotion, MovingLattice};
use crate::runtime::allowance::Allowance;
use crate::scene;
use crate::state::{Layout, expect_like, layout_like, load, store, stored};

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
        let named = |error| BodyError::Lattice { body: name.to_owned(), error };
        let lattice = lattice.map_err(named)?;
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

    fn motion(&self, state: &[f64]) -> LatticeMotion {
        let mut own = self.start.clone();
        load(&mut own, state);
        own
    }

    fn error(&self, error: LatticeError) -> BodyError {
        let body = self.name.clone();
        match error {
            LatticeError::Halted(halt) => BodyError::Halted { body, halt },
            error => BodyError::Lattice { body, error },
        }
    }
}

impl Body for MovingLatticeBody {
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
        self.lattice.check(&self.motion(state)).map_err(|reason| format!("{name}: {reason}"))
    }

    fn check_inputs(&self, _: &[f64]) -> Result<(), BodyError> {
        Ok(())
    }

    fn memo(&self, _: &[f64], _: &[Received]) -> Memo {
        Box::new(LatticeMemo::default())
    }

    fn forget_state(&self, memo: &mut Memo) {
        *memo = Box::new(LatticeMemo::default());
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let mut own = self.motion(state);
        let target = acts.path.at(0, acts.duration)[self.input];
        let moved = self.lattice.advance(&mut own, target, acts.duration, allowance);
        moved.map_err(|error| self.error(error))?;
        store(&mut own, state);
        if !state.iter().all(|value| value.is_finite()) {
            return Err(BodyError::Overflow { body: self.name.clone() });
        }
        Ok(None)
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let Reading::Total(place) = *reading else { return Err(BodyError::NoSuchReading) };
        let seen = LatticeMemo::of_mut(memo).0.get_or_insert_with(|| {
            let own = self.motion(state);
            Seen::in_motion(&own, self.lattice.totals(&own), self.lattice.mass())
        });
        Ok(totals::read(place, seen))
    }

    fn fields(&self, state: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        let own = self.motion(state);
        let all = own.displacement.iter().zip(&own.velocity);
        let motion = all.map(|(moved, velocity)| [moved, velocity].map(|[x, z, _]| [*x, *z]));
        let inside = self.lattice.at_particles(&own);
        Ok(Fields::Particles(self.drawn.particles(self.lattice.particles(), motion, inside)))
    }
}

impl Giver for MovingLatticeBody {
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        let (before, mut own) = (self.motion(before), self.motion(state));
        own.duration += before.duration;
        own.impulse += before.impulse;
        store(&mut own, state);
    }
}

impl Maxima for MovingLatticeBody {}

impl Approach for MovingLatticeBody {
    /// The load moves from where it is to its value at the end of a step.
    fn approached(
        &self,
        state: &mut Vec<f64>,
        path: &InputPath,
        duration: f64,
    ) -> Vec<(usize, [f64; 2])> {
        let from = self.motion(state).prescribed;
        let to = path.at(0, duration)[self.input];
        vec![(self.input, [from, (to - from) / duration])]
    }
}

impl Advice for MovingLatticeBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }
}

impl Resources for MovingLatticeBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        self.lattice.foresee(dt, allowance).map_err(|error| self.error(error))
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
