//! Drops that give what is known of one.

mod extremes;

use super::course::Course;
use super::footprint::{Footprint, Part};
use super::profile::Amounts;
use super::state::{Drop, Ledger, drops_in, flatten, layout, unflatten};
use crate::method::sph::{Surface, WallCells, WallExchange};
use crate::state::Layout;

/// What drops are replayed from.
#[derive(Debug, Clone)]
pub struct ReplayPlan {
    pub course: std::sync::Arc<Course>,
    pub cells: WallCells,
    /// Of a drop [kg] and [J/K].
    pub mass: f64,
    pub heat_capacity: f64,
    /// Drops that there may be, and how far from the origin along x and y [m].
    pub most: usize,
    pub reach: [f64; 2],
}

/// Drops above a wall: everything known before time starts. What changes is a flat vector.
pub struct Replay {
    plan: ReplayPlan,
}

/// A drop that has been released.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Falling {
    /// When it touches the wall [s], where along x and y [m], how fast [m/s] and how warm [K].
    pub contact: f64,
    pub place: [f64; 2],
    pub speed: f64,
    pub temperature: f64,
}

/// Sums over all drops.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReplayTotals {
    /// Drops asked for, released, in the air or giving, and come down where another was still giving.
    pub asked: f64,
    pub released: f64,
    pub active: f64,
    pub overlapping: f64,
    /// Of the drops released [kg].
    pub mass: f64,
    /// Given to the wall since time zero [J], [N s].
    pub heat: f64,
    pub impulse: [f64; 3],
    /// Diameter of the film of the drop that came down last [m].
    pub spread: f64,
}

/// A flow of heat of each cell that falls evenly over a step, see [`Surface::falling_parts`].
pub type Falls = Vec<f64>;

impl Replay {
    pub fn new(plan: ReplayPlan) -> Self {
        Self { plan }
    }

    pub fn course(&self) -> &Course {
        &self.plan.course
    }

    pub fn initial_state(&self) -> Vec<f64> {
        flatten(&mut Ledger::default(), &mut [])
    }

    /// The fields of a state; nothing of a length that fits no number of drops.
    pub fn layout(&self, state: &[f64]) -> Option<Layout> {
        let rings = self.plan.course.rings();
        drops_in(state, rings).map(|drops| layout(drops, rings))
    }

    /// Drops asked for so far, and released.
    pub fn counts(&self, state: &[f64]) -> [f64; 2] {
        let (ledger, _) = self.of(state);
        [ledger.asked, ledger.released]
    }

    /// [s]
    pub fn time(&self, state: &[f64]) -> f64 {
        self.of(state).0.time
    }

    fn of(&self, state: &[f64]) -> (Ledger, Vec<Drop>) {
        unflatten(state, self.plan.course.rings())
    }

    /// When a drop gives nothing more [s].
    fn end(&self, drop: &Drop) -> f64 {
        drop.contact + self.plan.course.duration(drop.speed)
    }

    /// Advances by `duration` [s] with drops that are released meanwhile, of which some have been `asked` for, above
    /// a surface as it would be without all drops of this step. What the cells got, and how it fell over the step.
    pub fn advance(
        &self,
        state: &mut Vec<f64>,
        (released, asked): (&[Falling], usize),
        surface: &Surface,
        duration: f64,
    ) -> (WallExchange, Falls) {
        let (mut ledger, mut drops) = self.of(state);
        drops.retain(|drop| self.end(drop) > ledger.time);
        ledger.asked += asked as f64;
        for falling in released {
            let Falling { contact, place, speed, temperature } = *falling;
            let none = Drop::none(self.plan.course.rings());
            drops.push(Drop { contact, place, speed, temperature, ..none });
            ledger.released += 1.0;
        }
        let start = ledger.time;
        ledger.duration = duration;
        ledger.time += duration;
        self.touch_down(&mut ledger, &mut drops, surface, start);
        let (exchange, falls) = self.exchanged(&ledger, &drops);
        ledger.heat += exchange.heat.iter().sum::<f64>() + exchange.heat_outside;
        for axis in 0..3 {
            let given: f64 = exchange.impulse.iter().map(|impulse| impulse[axis]).sum();
            ledger.impulse[axis] += self.as_vector(given, axis) + exchange.impulse_outside[axis];
        }
        *state = flatten(&mut ledger, &mut drops);
        (exchange, falls)
    }

    /// Rings push along their radius, which is no direction.
    fn as_vector(&self, given: f64, axis: usize) -> f64 {
        if axis < 2 && self.plan.cells.are_radial() { 0.0 } else { given }
    }

    /// Notes how warm the wall is where drops touch it, and which of them meet others.
    fn touch_down(&self, ledger: &mut Ledger, drops: &mut [Drop], surface: &Surface, start: f64) {
        for n in 0..drops.len() {
            if drops[n].is_down() || drops[n].contact >= ledger.time {
                continue;
            }
            let part = ((drops[n].contact - start) / ledger.duration).max(0.0);
            let at = SurfaceAt::new(surface, part, ledger.duration);
            let footprint = self.footprint(&drops[n]);
            let means = footprint.rings.iter().map(|ring| ring.mean(|cell| at.temperature(cell)));
            drops[n].wall = means.collect();
            let meets = |other: &Drop| {
                let reach = [&drops[n], other].map(|drop| self.reach(drop));
                let apart = [0, 1].map(|axis| drops[n].place[axis] - other.place[axis]);
                other.is_down()
                    && self.end(other) > drops[n].contact
                    && apart[0].hypot(apart[1]) < reach[0] + reach[1]
            };
            let others = drops.iter().enumerate().filter(|(m, _)| *m != n);
            if others.into_iter().any(|(_, other)| meets(other)) {
                ledger.overlapping += 1.0;
            }
        }
    }

    /// Moments within a step of this length [s] at which the wall should be asked anew: as drops touch down, and as they
    /// cool.
    pub fn moments(&self, state: &[f64], released: &[Falling], duration: f64) -> Vec<f64> {
        let (ledger, drops) = self.of(state);
        let known = drops.iter().map(|drop| (drop.contact, drop.speed));
        let further = released.iter().map(|falling| (falling.contact, falling.speed));
        let of_drop = |(contact, speed): (f64, f64)| {
            let touched = contact - ledger.time;
            let turns = self.plan.course.turns(speed).map(move |age| touched + age);
            std::iter::once(touched).chain(turns)
        };
        let moments = known.chain(further).flat_map(of_drop);
        moments.filter(|moment| (0.0..duration).contains(moment)).collect()
    }

    /// Radius that a drop comes to cover [m].
    fn reach(&self, drop: &Drop) -> f64 {
        0.5 * self.plan.course.largest_spread(drop.speed)
    }

    fn footprint(&self, drop: &Drop) -> Footprint {
        let course = &self.plan.course;
        Footprint::of(&self.plan.cells, drop.place, course.rings(), course.radius())
    }

    /// What the cells got during the last step.
    pub fn exchange(&self, state: &[f64]) -> WallExchange {
        let (ledger, drops) = self.of(state);
        self.exchanged(&ledger, &drops).0
    }

    fn exchanged(&self, ledger: &Ledger, drops: &[Drop]) -> (WallExchange, Falls) {
        let mut exchange = WallExchange::none(self.plan.cells.len());
        exchange.duration = ledger.duration;
        let mut falls = vec![0.0; exchange.heat.len()];
        if ledger.duration > 0.0 {
            let giving = drops.iter().filter(|drop| drop.is_down());
            giving.for_each(|drop| self.give(ledger, drop, &mut exchange, &mut falls));
        }
        (exchange, falls)
    }

    /// Adds what a drop gave during the last step.
    fn give(&self, ledger: &Ledger, drop: &Drop, to: &mut WallExchange, falls: &mut [f64]) {
        let start = ledger.time - ledger.duration;
        let times = [start, start + 0.5 * ledger.duration, ledger.time];
        let [before, between, after] =
            times.map(|time| self.plan.course.amounts(drop.speed, time - drop.contact));
        if before == after {
            return;
        }
        let footprint = self.footprint(drop);
        for (n, ring) in footprint.rings.iter().enumerate() {
            let difference = drop.temperature - drop.wall[n];
            let [a, b, c] =
                [before[n], between[n], after[n]].map(|amounts| difference * amounts.heat);
            let fall = 2.0 * (2.0 * b - a - c) / ledger.duration;
            let given = Given { heat: c - a, fall, push: minus(&after[n], &before[n]) };
            ring.parts.iter().for_each(|part| given.to_cell(part, to, falls));
            // What lies beside a body keeps its heat.
            let keeps = self.plan.cells.end_with_the_body();
            ring.outside.iter().for_each(|part| given.beyond(part, to, keeps));
        }
    }

    /// Counts the step before the last as part of that.
    pub fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        let (earlier, mut drops) = self.of(before);
        let (mut ledger, later) = self.of(state);
        drops.retain(|drop| self.end(drop) <= earlier.time);
        drops.extend(later);
        ledger.duration += earlier.duration;
        *state = flatten(&mut ledger, &mut drops);
    }

    pub fn totals(&self, state: &[f64]) -> ReplayTotals {
        let (ledger, drops) = self.of(state);
        let Ledger { time, asked, released, overlapping, heat, impulse, .. } = ledger;
        let down = drops.iter().filter(|drop| drop.is_down());
        let last = down.max_by(|a, b| a.contact.total_cmp(&b.contact));
        let spread = |drop: &Drop| self.plan.course.spread(drop.speed, time - drop.contact);
        ReplayTotals {
            asked,
            released,
            active: drops.iter().filter(|drop| self.end(drop) > time).count() as f64,
            overlapping,
            mass: released * self.plan.mass,
            heat,
            impulse,
            spread: last.map_or(0.0, spread),
        }
    }

    /// Refuses a vector that no run of these drops leads to, with what is wrong with it.
    pub fn check_state(&self, state: &[f64]) -> Result<(), String> {
        let rings = self.plan.course.rings();
        if drops_in(state, rings).is_none() {
            return Err(format!("{} numbers are those of no number of drops", state.len()));
        }
        if let Some(place) = state.iter().position(|number| !number.is_finite()) {
            return Err(format!("number {place} is not finite"));
        }
        let (ledger, drops) = self.of(state);
        let Ledger { time, duration, asked, released, overlapping, .. } = ledger;
        let most = self.plan.most as f64;
        let is_count = |count: f64| count.fract() == 0.0 && count >= 0.0;
        if !is_count(asked) || asked > most {
            return Err(format!("{asked} drops asked for, of at most {most}"));
        }
        if !is_count(released) || released > most || (asked > 0.0 && released != asked) {
            return Err(format!("{released} drops released of {most}"));
        }
        if !is_count(overlapping) || overlapping > released || drops.len() as f64 > released {
            let count = drops.len();
            return Err(format!("{count} drops, {overlapping} on others, of {released} released"));
        }
        if time < 0.0 || duration < 0.0 || duration > time * (1.0 + ROUNDING) {
            return Err(format!("a last step of {duration} s before {time} s"));
        }
        drops.iter().try_for_each(|drop| self.check_drop(&ledger, drop))
    }

    fn check_drop(&self, ledger: &Ledger, drop: &Drop) -> Result<(), String> {
        let Drop { contact, place, speed, temperature, wall } = drop;
        let [x, y] = place;
        let refuse = |what: &str| Err(format!("a drop at {x}, {y} m {what}"));
        if (0..2).any(|axis| place[axis].abs() > self.plan.reach[axis] * (1.0 + ROUNDING)) {
            return refuse("lies beyond what drops reach");
        }
        if !self.plan.course.knows(*speed) || *temperature <= 0.0 || *contact < 0.0 {
            return refuse(&format!("of {speed} m/s and {temperature} K"));
        }
        let touched = wall.iter().filter(|temperature| **temperature > 0.0).count();
        if (touched != 0 && touched != wall.len()) || wall.iter().any(|t| *t < 0.0) {
            return refuse("knows how warm some of its rings were");
        }
        if drop.is_down() != (*contact < ledger.time) {
            return refuse(&format!("touches the wall at {contact} s"));
        }
        if self.end(drop) < (ledger.time - ledger.duration) * (1.0 - ROUNDING) {
            return refuse("has nothing more to give");
        }
        Ok(())
    }
}

/// Relative rounding of times and places.
const ROUNDING: f64 = 1e-9;

fn minus(after: &Amounts, before: &Amounts) -> [f64; 2] {
    [after.push - before.push, after.outward - before.outward]
}

/// What a ring gave during a step: heat [J], how it fell [W], momentum into the wall and outward [N s].
struct Given {
    heat: f64,
    fall: f64,
    push: [f64; 2],
}

impl Given {
    fn to_cell(&self, part: &Part, to: &mut WallExchange, falls: &mut [f64]) {
        to.heat[part.cell] += part.weight * self.heat;
        falls[part.cell] += part.weight * self.fall;
        let [push, outward] = self.push;
        let impulse = &mut to.impulse[part.cell];
        impulse[0] += part.outward[0] * outward;
        impulse[1] += part.outward[1] * outward;
        impulse[2] -= part.weight * push;
    }

    fn beyond(&self, part: &Part, to: &mut WallExchange, keeps_heat: bool) {
        if !keeps_heat {
            to.heat_outside += part.weight * self.heat;
        }
        let [push, outward] = self.push;
        to.impulse_outside[0] += part.outward[0] * outward;
        to.impulse_outside[1] += part.outward[1] * outward;
        to.impulse_outside[2] -= part.weight * push;
    }
}

/// A surface at a time of a step, of which few cells are asked for.
struct SurfaceAt<'a> {
    surface: &'a Surface,
    decays: Vec<f64>,
    part: f64,
}

impl<'a> SurfaceAt<'a> {
    fn new(surface: &'a Surface, part: f64, duration: f64) -> Self {
        let decay = |rate: &f64| (-rate * part * duration).exp();
        Self { surface, decays: surface.response.rates.iter().map(decay).collect(), part }
    }

    fn temperature(&self, cell: usize) -> f64 {
        let Surface { base, amplitudes, drift, .. } = self.surface;
        let count = self.decays.len();
        let amplitudes = &amplitudes[cell * count..][..count];
        let modes: f64 = amplitudes.iter().zip(&self.decays).map(|(a, decay)| a * decay).sum();
        base[cell] + modes + self.part * drift[cell]
    }
}
