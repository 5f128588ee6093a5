//! Drops replayed from one known drop: recorded from particles, or computed by closed forms of a film.

mod forecast;
mod knowledge;
mod notes;
mod totals;

pub use forecast::{forecast, to_be_recorded};
pub use knowledge::{Kept, forget_unused_records, keep_record, records};
pub use notes::notes;
pub use totals::offered_totals;

use super::STRAY_SHARE;
use super::demand::DropInputs;
use super::watch::Watch;
use crate::advice::MEASURED_FILMS;
use crate::body::wall::{Below, wall_quantities};
use crate::body::{Acts, Body, BodyError, Fields, Given, Link, Memo, Reading, Received};
use crate::body::{Advice, Approach, Events, Giver, Maxima, Occasion, Resources};
use crate::inputs::{InputLayout, InputPath};
use crate::method::record::{Falling, Replay, ReplayPlan, ReplayTotals};
use crate::method::sph::{Failure, ParticleFields, WarmPlace};
use crate::port::{WallCells, WallExchange};
use crate::runtime::allowance::Allowance;
use crate::scene::{Arrival, Droplet, Scene, lateral_extents};
use crate::state::Layout;
use crate::warning::{self, Finding, Warning};

/// Drops and what lies below them.
pub struct ReplayBody {
    name: String,
    replay: Replay,
    below: Below,
    /// Set for drops on demand.
    demand: Option<DropInputs>,
    /// The scene's drops, by the time of their release [s].
    arrivals: Vec<(f64, Falling)>,
    /// Planes x = 0 and y = 0 about which all drops are symmetric.
    symmetric: [bool; 2],
    watch: Watch,
    /// Contact temperature above the wall, as a share of the temperature difference between drop and wall.
    contact_share: f64,
    notes: Vec<String>,
}

/// Largest distance of landing drops from the origin where nothing limits it [m].
const FARTHEST: f64 = 1e3;

impl ReplayBody {
    /// `on` holds the cells of a body below and the link with it.
    pub fn new(
        scene: &Scene,
        layout: &InputLayout,
        (name, droplet): (&str, &Droplet),
        on: Option<(WallCells, &Link)>,
        threads: usize,
    ) -> Result<Self, Failure> {
        let course = knowledge::course(scene, (name, droplet), threads)?;
        let (below, cells) = Below::of((scene, layout), name, on);
        // Scenes without anything below are refused earlier.
        let nothing = WallCells::Rings { count: 1, radius: FARTHEST };
        let mass = droplet.mass();
        let mut said = notes(scene, (name, droplet));
        said.push(notes::on_course(&course, droplet));
        let replay = Replay::new(ReplayPlan {
            course,
            cells: cells.unwrap_or(nothing),
            mass,
            heat_capacity: mass * droplet.fluid.specific_heat,
            most: droplet.drops(),
            reach: reach(scene, name),
            diffusivity: diffusivity(scene, name),
        });
        Ok(Self {
            name: name.to_owned(),
            replay,
            below,
            demand: DropInputs::of(scene, layout, (name, droplet), FARTHEST),
            arrivals: droplet.arrivals().iter().map(|a| (a.time, falling(droplet, a))).collect(),
            symmetric: droplet.mirrors(),
            watch: Watch::of(scene, (name, &droplet.fluid), false),
            contact_share: scene.contact_share(name),
            notes: said,
        })
    }

    /// Drops released in a step, and how many of them the inputs requested.
    fn released(
        &self,
        state: &[f64],
        path: &InputPath,
        duration: f64,
    ) -> Result<(Vec<Falling>, usize), BodyError> {
        let ([asked, released], start) = (self.replay.counts(state), self.replay.time(state));
        let Some(demand) = &self.demand else {
            let waiting = self.arrivals.iter().skip(released as usize);
            let due = waiting.take_while(|(time, _)| *time <= start + duration);
            return Ok((due.map(|(_, falling)| *falling).collect(), 0));
        };
        let further = demand.further(path, asked)?;
        Ok((vec![demand.falling(&path.at(0, 0.0), start); further], further))
    }

    fn totals(&self, state: &[f64]) -> ReplayTotals {
        self.replay.totals(state)
    }

    fn given_of(&self, exchange: WallExchange, falling: Vec<f64>) -> Option<Given> {
        let Below::Body { traction } = self.below else { return None };
        let WallExchange { duration, heat, impulse, .. } = exchange;
        let impulse = if traction { impulse } else { Vec::new() };
        Some(Given { duration, heat, falling, impulse, symmetric: self.symmetric })
    }
}

/// A drop of the scene.
fn falling(droplet: &Droplet, arrival: &Arrival) -> Falling {
    let (speed, fall) = droplet.contact(droplet.impact_velocity);
    Falling {
        contact: arrival.time + fall,
        place: [arrival.x, arrival.y],
        speed,
        temperature: droplet.initial_temperature,
    }
}

/// Largest distance of landing drops from the origin along x and y [m].
fn reach(scene: &Scene, name: &str) -> [f64; 2] {
    let below = scene.coupling_from(name).and_then(|coupling| scene.coupling[coupling].solid());
    let extents = below.and_then(|solid| Some(lateral_extents(&scene.solid(solid)?.shape)));
    extents.map_or([FARTHEST; 2], |extents| extents.map(|extent| 0.5 * extent))
}

/// Largest diffusivity below a droplet [m²/s]; zero for a wall that does not respond to heat.
fn diffusivity(scene: &Scene, name: &str) -> f64 {
    let below = scene.coupling_from(name).and_then(|coupling| scene.coupling[coupling].solid());
    let strata = below.and_then(|solid| Some(scene.solid(solid)?.strata()));
    let layers = strata.into_iter().flatten();
    layers.map(|layer| layer.constants.diffusivity()).fold(0.0, f64::max)
}

/// Lazily computed readings of a state.
#[derive(Default)]
struct ReplayMemo {
    exchange: Option<WallExchange>,
}

impl Body for ReplayBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        self.replay.initial_state()
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        self.replay.layout(state)
    }

    fn check_state(&self, state: &[f64], _inputs: &[f64]) -> Result<(), String> {
        self.replay.check_state(state).map_err(|error| format!("{}: {error}", self.name))
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        if let Some(demand) = &self.demand {
            demand.check(inputs)?;
            demand.check_speed(inputs, self.replay.course())?;
        }
        self.below.check_inputs(inputs)
    }

    fn memo(&self, _: &[f64], _: &[Received]) -> Memo {
        Box::new(ReplayMemo::default())
    }

    fn forget_state(&self, memo: &mut Memo) {
        *memo = Box::new(ReplayMemo::default());
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        _: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let (released, asked) = self.released(state, acts.path, acts.duration)?;
        let held = self.below.wall().map(|wall| wall.surface(acts)).unwrap_or_default();
        let surface = acts.below.unwrap_or(&held);
        let released = (&released[..], asked);
        let (exchange, falls) = self.replay.advance(state, released, surface, acts.duration);
        Ok(self.given_of(exchange, falls))
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let memo: &mut ReplayMemo = memo.downcast_mut().expect("a memo of the body that made it");
        let exchange = || self.replay.exchange(state);
        Ok(match *reading {
            Reading::Total(place) => totals::read(place, &self.totals(state), || {
                memo.exchange.get_or_insert_with(exchange)
            }),
            Reading::Cell { quantity, cell } => {
                let wall = self.below.wall().ok_or(BodyError::NoSuchReading)?;
                let exchange = memo.exchange.get_or_insert_with(exchange);
                wall_quantities()[quantity].mean(exchange, cell, wall)?
            }
            Reading::Point { .. }
            | Reading::Mean { .. }
            | Reading::Peak { .. }
            | Reading::Flaw { .. }
            | Reading::Error => return Err(BodyError::NoSuchReading),
        })
    }

    /// There are no particles to show.
    fn fields(&self, _: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        Ok(Fields::Particles(ParticleFields::default()))
    }
}

impl Giver for ReplayBody {
    fn moments(&self, state: &[f64], path: &InputPath, duration: f64) -> Vec<f64> {
        // What cannot be released is refused by the step.
        let released = self.released(state, path, duration);
        released.map_or(Vec::new(), |(released, _)| self.replay.moments(state, &released, duration))
    }

    /// Transfers to another body refer to the last exchange, however long the step.
    fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        if !matches!(self.below, Below::Body { .. }) {
            self.replay.join_steps(before, state);
        }
    }

    fn given(&self, state: &[f64]) -> Option<Given> {
        matches!(self.below, Below::Body { .. })
            .then(|| self.given_of(self.replay.exchange(state), Vec::new()))
            .flatten()
    }
}

impl Events for ReplayBody {}

impl Maxima for ReplayBody {}

impl Approach for ReplayBody {}

impl Advice for ReplayBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }

    fn watch(&self) -> Option<&Watch> {
        Some(&self.watch)
    }

    fn warm_places(&self, state: &[f64]) -> Option<[WarmPlace; 2]> {
        self.replay.extremes(state, self.contact_share)
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        let found = match occasion {
            Occasion::Step => {
                let is_stacked = self.replay.most_films(state) > MEASURED_FILMS;
                let stacked = is_stacked.then(|| warning::films_stack(MEASURED_FILMS));
                let over_edge = self.replay.reaches_beyond(state).then(warning::fluid_beyond_edge);
                stacked.into_iter().chain(over_edge).collect()
            }
            Occasion::Response { .. } => Vec::new(),
            Occasion::End => self.findings_at_end(state),
        };
        found.into_iter().map(|finding| finding.at(&self.name)).collect()
    }
}

impl ReplayBody {
    /// Warns of drops that landed on others or were never asked for, and of fluid that detached while the drop was
    /// recorded.
    fn findings_at_end(&self, state: &[f64]) -> Vec<Finding> {
        let ReplayTotals { overlapping, released, .. } = self.totals(state);
        let on_others =
            (overlapping > 0.0).then(|| warning::drops_overlapped(overlapping, released));
        let part = self.replay.course().largest_stray();
        let strays = part > STRAY_SHARE && released > 0.0;
        let share = format!("{:.0}", 100.0 * part);
        let on_strays = strays.then(|| warning::fluid_came_off_in_record(share));
        let none = self.demand.is_some() && released == 0.0;
        let none = none.then(warning::no_drop_asked_for);
        on_others.into_iter().chain(on_strays).chain(none).collect()
    }
}

impl Resources for ReplayBody {}
