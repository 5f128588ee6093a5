//! A lattice in equilibrium with what its input prescribes.

use crate::body::{
    Acts, Advice, Approach, Body, BodyError, Fields, Given, Giver, Maxima, Memo, Reading, Received,
    Resources,
};
use crate::inputs::InputLayout;
use crate::method::lattice::{Lattice, LatticeError, LatticeState};
use crate::runtime::allowance::{Allowance, cost};
use crate::scene;
use crate::state::{Layout, expect_like, layout_like, load, store, stored};

use super::totals::{self, Seen};
use super::{Drawn, LatticeMemo, forecast, plan};

/// A lattice in equilibrium with what its input prescribes.
pub struct RestingLatticeBody {
    name: String,
    lattice: Lattice,
    start: LatticeState,
    /// Place of its input.
    input: usize,
    drawn: Drawn,
    /// [kg]
    mass: f64,
    notes: Vec<String>,
    threads: usize,
}

/// Number of unknowns from which threads pay off.
const LARGE: usize = 100_000;
/// Iterations of a usual communication step, and the words for them.
const ITERATIONS: f64 = 20.0;
const WORDS: &str = "iterations of an equilibrium";

impl RestingLatticeBody {
    pub fn new(
        layout: &InputLayout,
        (name, own): (&str, &scene::Lattice),
        threads: impl Fn(bool) -> usize,
    ) -> Result<Self, BodyError> {
        let plan = plan::plan_of(own);
        let threads = threads(3 * plan.strip.count() > LARGE);
        let named = |error| BodyError::Lattice { body: name.to_owned(), error };
        let lattice = Lattice::new(plan, threads).map_err(named)?;
        let density = own.material.density;
        let area = lattice.particles().area * lattice.particles().places.len() as f64;
        Ok(Self {
            name: name.to_owned(),
            start: lattice.initial_state(),
            input: layout.of_body(name).start,
            drawn: Drawn {
                density,
                thickness: own.thickness,
                temperature: own.initial_temperature,
            },
            mass: density * own.thickness * area,
            notes: forecast::notes(own),
            lattice,
            threads,
        })
    }

    fn state(&self, state: &[f64]) -> LatticeState {
        let mut own = self.start.clone();
        load(&mut own, state);
        own
    }

    fn seen(&self, state: &[f64], memo: &mut Memo) -> Seen {
        *LatticeMemo::of_mut(memo).0.get_or_insert_with(|| {
            let own = self.state(state);
            Seen::at_rest(&own, self.lattice.totals(&own), self.mass)
        })
    }

    fn work(&self) -> usize {
        Lattice::WORK * self.lattice.unknowns()
    }

    fn error(&self, error: LatticeError) -> BodyError {
        let body = self.name.clone();
        match error {
            LatticeError::Halted(halt) => BodyError::Halted { body, halt },
            error => BodyError::Lattice { body, error },
        }
    }
}

impl Body for RestingLatticeBody {
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
        self.lattice.check(&self.state(state)).map_err(|reason| format!("{name}: {reason}"))
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

    /// Moves to the value that is prescribed at the end of the step, through those at which its motion turns.
    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let mut own = self.state(state);
        let turns = acts.path.turns(acts.duration).into_iter();
        for time in turns.filter(|&time| time < acts.duration).chain([acts.duration]) {
            let target = acts.path.at(0, time)[self.input];
            let moved = self.lattice.advance(&mut own, target, allowance);
            moved.map_err(|error| self.error(error))?;
        }
        store(&mut own, state);
        if !state.iter().all(|value| value.is_finite()) {
            return Err(BodyError::Overflow { body: self.name.clone() });
        }
        Ok(None)
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let Reading::Total(place) = *reading else { return Err(BodyError::NoSuchReading) };
        Ok(totals::read(place, &self.seen(state, memo)))
    }

    fn fields(&self, state: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        let own = self.state(state);
        let moved = self.lattice.displacements(&own).into_iter().map(|moved| [moved, [0.0; 2]]);
        let inside = self.lattice.at_particles(&own);
        let fields = self.drawn.particles(self.lattice.particles(), moved, inside);
        Ok(Fields::Particles(fields))
    }
}

impl Giver for RestingLatticeBody {}

impl Maxima for RestingLatticeBody {}

impl Approach for RestingLatticeBody {}

impl Advice for RestingLatticeBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }
}

impl Resources for RestingLatticeBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let foreseen = allowance.foresee_step(dt, ITERATIONS, WORDS, self.work());
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn updates(&self, _: f64) -> f64 {
        cost(ITERATIONS, self.work())
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
