//! A lattice in equilibrium with what its input prescribes.

use crate::body::{
    Acts, Advice, Approach, BodyError, Events, Given, Giver, Maxima, Occasion, Reading, Resources,
    Structured,
};
use crate::inputs::InputLayout;
use crate::method::lattice::{Lattice, LatticeState};
use crate::method::sph::ParticleFields;
use crate::quantity::percent;
use crate::runtime::allowance::Allowance;
use crate::scene;
use crate::warning::{self, Warning};

use super::totals::{self, Seen};
use super::{Drawn, forecast, named, plan};

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
        let lattice = Lattice::new(plan, threads).map_err(|error| named(name, error))?;
        let density = own.material.density;
        let area: f64 = lattice.particles().cells.iter().map(|cell| cell.area).sum();
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

    fn work(&self) -> usize {
        Lattice::WORK * self.lattice.unknowns()
    }
}

impl Structured for RestingLatticeBody {
    type State = LatticeState;
    type View = Seen;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &LatticeState {
        &self.start
    }

    fn check(&self, state: &LatticeState) -> Result<(), String> {
        self.lattice.check(state)
    }

    /// Moves to the value that is prescribed at the end of the step, through those at which its motion turns.
    fn advance(
        &self,
        state: &mut LatticeState,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let turns = acts.path.turns(acts.duration).into_iter();
        for time in turns.filter(|&time| time < acts.duration).chain([acts.duration]) {
            let target = acts.path.at(0, time)[self.input];
            let moved = self.lattice.advance(state, target, allowance);
            moved.map_err(|error| named(&self.name, error))?;
        }
        Ok(None)
    }

    fn view(&self, state: LatticeState, _: &[f64]) -> Result<Seen, BodyError> {
        Ok(Seen::at_rest(&state, self.lattice.totals(&state), self.mass))
    }

    fn read(&self, view: &Seen, reading: &Reading) -> Result<f64, BodyError> {
        totals::read(reading, view)
    }

    fn drawn(&self, state: LatticeState, _: &[f64]) -> Result<ParticleFields, BodyError> {
        let moved = self.lattice.displacements(&state).into_iter().map(|moved| [moved, [0.0; 2]]);
        let inside = self.lattice.at_particles(&state);
        Ok(self.drawn.particles(self.lattice.particles(), moved, inside))
    }
}

impl Giver for RestingLatticeBody {}

impl Events for RestingLatticeBody {
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

impl Maxima for RestingLatticeBody {}

impl Approach for RestingLatticeBody {
    fn shared_by_parts(&self, state: &[f64]) -> Vec<(usize, f64)> {
        vec![(self.input, self.structure(state).prescribed)]
    }
}

impl Advice for RestingLatticeBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }

    /// Warns of breaks that seem to take energy: the equilibrium after them is not one to which they lead.
    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        let LatticeState { dissipated, released, .. } = self.structure(state);
        let is_wrong = matches!(occasion, Occasion::Step) && released < -TAKEN * dissipated;
        let part = percent(-released / dissipated);
        let warning = || warning::breaks_take_energy(part).at(&self.name).whatever_its_numbers();
        is_wrong.then(warning).into_iter().collect()
    }
}

/// Part of the dissipated energy that breaks may seem to take, by errors of their steps.
const TAKEN: f64 = 0.02;

impl Resources for RestingLatticeBody {
    fn foresee(&self, _: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let foreseen = allowance.foresee_step(dt, ITERATIONS, WORDS, self.work());
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
