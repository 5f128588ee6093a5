//! Droplets of smoothed particles, free or above a wall or another body.

mod demand;
mod forecast;
mod memo;
mod notes;
mod plan;
mod reader;
mod replay;
mod totals;
mod warnings;
mod watch;

pub use forecast::{DropletForecast, PARTICLE_MEMORY, exchange_time};
pub use notes::{notes, notes_on_walls};
pub use plan::{fine_radius, plan_of, refinements};
pub use replay::{Kept, ReplayBody, forget_unused_records, keep_record, records, to_be_recorded};
pub use warnings::warnings_on_landing;
pub use watch::Watch;

use super::wall::{Below, wall_quantities};
use super::{
    Acts, Body, BodyError, Descriptor, Fields, Given, Link, Memo, Reading, Received, link,
};
use crate::body::{Events, Giver, Maxima, Resources};
use crate::inputs::{InputLayout, InputPath};
use crate::method::sph::{DropletSph, Failure, ParticleFields, UNKNOWNS};
use crate::port::{Surface, WallCells, WallExchange};
use crate::runtime::allowance::{Allowance, cost};
use crate::scene::{Droplet, Scene};
use crate::state::Layout;
use demand::DropInputs;
use memo::DropletMemo;
use reader::DropletReader;
use warnings::STRAY_SHARE;

/// Drops of a fluid and what lies below them.
pub struct DropletBody {
    name: String,
    droplet: DropletSph,
    below: Below,
    /// Set for drops on demand.
    demand: Option<DropInputs>,
    /// Number of mirror images of each particle.
    copies: f64,
    rest: Rest,
    watch: Watch,
    notes: Vec<String>,
    threads: usize,
}

/// Initial state of the fluid.
struct Rest {
    /// [kg/m³]
    density: f64,
    /// [K]
    temperature: f64,
    /// √(kρc) [W √s/(m² K)]
    effusivity: f64,
}

/// The totals that a scene's droplet offers, each with its place in the table of its kind.
pub fn offered_totals(scene: &Scene, name: &str) -> Vec<(usize, Descriptor)> {
    match scene.droplet(name).is_some_and(Droplet::is_replayed) {
        true => replay::offered_totals(scene, name),
        false => totals::offered_totals(scene, name),
    }
}

/// Droplets with fewer particles run faster on one thread.
const PARTICLES_WORTH_THREADS: usize = 2_000;

/// Returns true if more than one thread is worthwhile.
pub fn is_large(particles: usize) -> bool {
    particles >= PARTICLES_WORTH_THREADS
}

impl DropletBody {
    /// `on` holds the cells of a body below and the link with it.
    pub fn new(
        scene: &Scene,
        layout: &InputLayout,
        (name, droplet): (&str, &Droplet),
        on: Option<(WallCells, &Link)>,
        threads: impl Fn(bool) -> usize,
    ) -> Self {
        let mut notes = notes(scene, name, droplet);
        notes.extend(on.as_ref().map(|(_, link)| link::note(link.interval)));
        let (below, cells) = Below::of((scene, layout), name, on);
        let wall = scene.wall_under(name).filter(|_| below.wall().is_some());
        let effusivity = wall.and_then(|wall| scene.wall[wall].effusivity);
        let mut plan = plan_of(droplet, cells, effusivity);
        plan.fluid.freezing = scene.freezing_of(name);
        if let Some(wall) = &mut plan.wall {
            wall.conductance = scene.conductance_below(name);
        }
        let threads = threads(is_large(plan.particles()));
        let sph = DropletSph::new(plan, threads);
        Self {
            name: name.to_owned(),
            demand: DropInputs::of(scene, layout, (name, droplet), sph.farthest_start()),
            droplet: sph,
            below,
            copies: droplet.mirrors().iter().map(|&m| if m { 2.0 } else { 1.0 }).product(),
            rest: Rest {
                density: droplet.fluid.density,
                temperature: droplet.initial_temperature,
                effusivity: droplet.fluid.effusivity(),
            },
            watch: Watch::of(scene, (name, &droplet.fluid), scene.freezing_of(name).is_some()),
            notes,
            threads,
        }
    }

    /// Advances above a surface or in free space; returns the temperature rises of its cells from the transferred heat
    /// [K m²].
    fn advance_here(
        &self,
        state: &mut Vec<f64>,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<f64>, Failure> {
        let (droplet, dt) = (&self.droplet, acts.duration);
        if let Some(surface) = acts.below {
            return droplet.advance_above(state, surface, dt, allowance);
        }
        let temperatures = self.below.wall().map(|wall| wall.over(acts)).unwrap_or_default();
        let surface = droplet.surface(state, temperatures.each_ref().map(Vec::as_slice));
        droplet.advance_above(state, &surface, dt, allowance).map(|_| Vec::new())
    }

    /// Releases the drops that the inputs request.
    fn ask(
        &self,
        state: &mut Vec<f64>,
        demand: &DropInputs,
        path: &InputPath,
    ) -> Result<(), BodyError> {
        let further = demand.further(path, self.droplet.asked(state))?;
        let asked = self.droplet.ask(state, further, &demand.release(&path.at(0, 0.0)));
        asked.map_err(|failure| self.error(failure))
    }

    fn error(&self, failure: Failure) -> BodyError {
        match failure {
            Failure::Halted(halt) => BodyError::Halted { body: self.name.clone(), halt },
            failure => BodyError::Droplet { name: self.name.clone(), failure },
        }
    }

    /// Smallest number of time steps in `dt` [s], and number of particles at the end.
    fn expected_steps(&self, dt: f64) -> (f64, usize) {
        let (particles, time_step) = self.droplet.expected();
        // Fluid at rest allows longer steps than an arriving drop.
        (0.5 * dt / time_step, particles)
    }

    /// All particles including mirror images; rings have their radius as x.
    fn particles(&self, state: &[f64]) -> ParticleFields {
        let mut fields = self.droplet.particles(state);
        let mirrors = self.droplet.plan().mirrors;
        for axis in (0..2).filter(|&axis| mirrors[axis]) {
            for i in 0..fields.mass.len() {
                let image = |mut vector: [f64; 3]| {
                    vector[axis] = -vector[axis];
                    vector
                };
                fields.position.push(image(fields.position[i]));
                fields.velocity.push(image(fields.velocity[i]));
                for values in [
                    &mut fields.mass,
                    &mut fields.density,
                    &mut fields.pressure,
                    &mut fields.temperature,
                    &mut fields.solid_fraction,
                ] {
                    values.extend(values.get(i).copied());
                }
            }
        }
        fields
    }

    /// Returns true if fluid touched the region beyond the edge of the body below in the last exchange.
    fn overflows(&self, state: &[f64]) -> bool {
        let WallExchange { heat_outside, impulse_outside, .. } = self.droplet.exchange(state);
        matches!(self.below, Below::Body { .. })
            && (heat_outside != 0.0 || impulse_outside[2] != 0.0)
    }
}

impl Body for DropletBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        self.droplet.initial_state()
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        self.droplet.layout(state)
    }

    fn check_state(&self, state: &[f64], _inputs: &[f64]) -> Result<(), String> {
        let checked = self.droplet.check_state(state);
        checked.map_err(|error| format!("{}: {error}", self.name))
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        if let Some(demand) = &self.demand {
            demand.check(inputs)?;
        }
        self.below.check_inputs(inputs)
    }

    fn memo(&self, _: &[f64], _: &[Received]) -> Memo {
        Box::new(DropletMemo::default())
    }

    fn forget_state(&self, memo: &mut Memo) {
        *memo = Box::new(DropletMemo::default());
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        if let Some(demand) = &self.demand {
            self.ask(state, demand, acts.path)?;
        }
        let rises =
            self.advance_here(state, acts, allowance).map_err(|failure| self.error(failure))?;
        let surface = |surface: &Surface| {
            let mut given = self.given(state)?;
            given.falling = surface.falling_parts(&given.heat, &rises, acts.duration);
            Some(given)
        };
        Ok(acts.below.and_then(surface))
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let mut reader = DropletReader { body: self, state, memo: DropletMemo::of_mut(memo) };
        Ok(match *reading {
            Reading::Total(place) => totals::read(&mut reader, place),
            Reading::Cell { quantity, cell } => {
                let wall = self.below.wall().ok_or(BodyError::NoSuchReading)?;
                let quantity = &wall_quantities()[quantity];
                match quantity.is_mean() {
                    true => quantity.mean(reader.exchange(), cell, wall)?,
                    false => reader.frozen_on_wall()[cell],
                }
            }
            Reading::Point { .. }
            | Reading::Mean { .. }
            | Reading::Peak { .. }
            | Reading::Flaw { .. }
            | Reading::Error => return Err(BodyError::NoSuchReading),
        })
    }

    fn follows_at_once(&self, _: &Reading) -> bool {
        false
    }

    fn fields(&self, state: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        Ok(Fields::Particles(self.particles(state)))
    }
}

impl Giver for DropletBody {
    /// Transfers to another body refer to the last exchange, however long the step.
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        if !matches!(self.below, Below::Body { .. }) {
            self.droplet.add_exchange(state, &self.droplet.exchange(before));
        }
    }

    fn given(&self, state: &[f64]) -> Option<Given> {
        let Below::Body { traction } = self.below else { return None };
        let WallExchange { duration, heat, impulse, .. } = self.droplet.exchange(state);
        Some(Given {
            duration,
            heat,
            falling: Vec::new(),
            impulse: if traction { impulse } else { Vec::new() },
            symmetric: self.droplet.plan().even(),
        })
    }
}

impl Events for DropletBody {}

impl Maxima for DropletBody {}

impl Resources for DropletBody {
    fn foresee(&self, state: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let particles = self.droplet.particles_in(state);
        let steps = if particles > 0 { self.expected_steps(dt).0 } else { 0.0 };
        let size = particles * UNKNOWNS;
        let foreseen = allowance.foresee_step(dt, steps, "time steps of a droplet", size);
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn updates(&self, dt: f64) -> f64 {
        let (steps, particles) = self.expected_steps(dt);
        cost(steps, particles * UNKNOWNS)
    }

    fn is_deep(&self, _: Option<&Memo>, _: &Reading) -> bool {
        false
    }

    fn factor_entries(&self) -> usize {
        0
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}
