//! Lattices: strips of concrete that soften and break, with the scene's data that concern them.

mod forecast;
mod plan;
mod totals;

pub use forecast::LatticeForecast;
pub use totals::offered_totals;

use crate::body::{
    Acts, Advice, Approach, Body, BodyError, Fields, Given, Giver, Maxima, Memo, Reading, Received,
    Resources,
};
use crate::inputs::InputLayout;
use crate::method::lattice::{Lattice, LatticeError, LatticeState, LatticeTotals};
use crate::method::sph::ParticleFields;
use crate::runtime::allowance::{Allowance, cost};
use crate::scene;
use crate::state::{Layout, expect_like, layout_like, load, store, stored};

use totals::Seen;

/// A lattice in equilibrium with what its input prescribes.
pub struct LatticeBody {
    name: String,
    lattice: Lattice,
    start: LatticeState,
    /// Place of its input.
    input: usize,
    density: f64,
    temperature: f64,
    /// [kg]
    mass: f64,
    notes: Vec<String>,
    threads: usize,
}

/// Lazily computed readings of a state.
#[derive(Default)]
struct LatticeMemo(Option<(LatticeState, LatticeTotals)>);

/// Number of unknowns from which threads pay off.
const LARGE: usize = 100_000;
/// Iterations of a usual communication step, and the words for them.
const ITERATIONS: f64 = 20.0;
const WORDS: &str = "iterations of an equilibrium";

impl LatticeBody {
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
            density,
            temperature: own.initial_temperature,
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

    fn seen<'m>(&self, state: &[f64], memo: &'m mut Memo) -> &'m (LatticeState, LatticeTotals) {
        let memo: &mut LatticeMemo = memo.downcast_mut().expect("a memo of the body that made it");
        memo.0.get_or_insert_with(|| {
            let own = self.state(state);
            let totals = self.lattice.totals(&own);
            (own, totals)
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

impl Body for LatticeBody {
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
        let (own, totals) = self.seen(state, memo);
        Ok(totals::read(place, &Seen { state: own, totals, mass: self.mass }))
    }

    fn fields(&self, state: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        let own = self.state(state);
        let particles = self.lattice.particles();
        let mass = self.mass / particles.places.len() as f64;
        let mut fields = ParticleFields::default();
        let moved = self.lattice.displacements(&own);
        let at_particles = self.lattice.at_particles(&own);
        for ((place, moved), (damage, pressure)) in
            particles.places.iter().zip(moved).zip(at_particles)
        {
            fields.position.push([place[0] + moved[0], 0.0, place[1] + moved[1]]);
            fields.velocity.push([0.0; 3]);
            fields.mass.push(mass);
            fields.density.push(self.density);
            fields.pressure.push(pressure);
            fields.temperature.push(self.temperature);
            fields.damage.push(damage);
        }
        Ok(Fields::Particles(fields))
    }
}

impl Giver for LatticeBody {}

impl Maxima for LatticeBody {}

impl Approach for LatticeBody {}

impl Advice for LatticeBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }
}

impl Resources for LatticeBody {
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
