//! Drops that repeat a recorded one.

mod extremes;

use std::sync::Arc;

use super::course::Course;
use super::footprint::{Footprint, Part, Ring};
use super::footprints::Footprints;
use super::lateral::Lateral;
use super::limit::{Limit, Parts, Side, Uneven};
use super::profile::Amounts;
use super::sharing::{reach, share};
use super::state::{Drop, Ledger, cells_in, drops_in, flatten, layout, unflatten};
use super::surface::SurfaceAt;
use crate::port::{Domain, Surface, WallCells, WallExchange};
use crate::state::Layout;

/// Inputs of a replay.
#[derive(Debug, Clone)]
pub struct ReplayPlan {
    pub course: std::sync::Arc<Course>,
    pub cells: WallCells,
    /// Mass [kg] and heat capacity [J/K] of a drop.
    pub mass: f64,
    pub heat_capacity: f64,
    /// Largest number of drops, and largest distance from the origin along x and y [m].
    pub most: usize,
    pub reach: [f64; 2],
    /// Largest diffusivity of the solid below [m²/s].
    pub diffusivity: f64,
}

/// Drops above a wall: everything known before time starts. The variables of state form a flat
/// vector.
pub struct Replay {
    plan: ReplayPlan,
    /// Areas of the cells [m²].
    areas: Vec<f64>,
    lateral: Lateral,
    footprints: Footprints,
}

/// A drop that has been released.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Falling {
    /// Contact time [s], position along x and y [m], speed [m/s] and temperature [K] of the drop.
    pub contact: f64,
    pub place: [f64; 2],
    pub speed: f64,
    pub temperature: f64,
}

/// Sums over all drops.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReplayTotals {
    /// Numbers of drops: requested, released, falling or active, and landed where another was still
    /// active.
    pub asked: f64,
    pub released: f64,
    pub active: f64,
    pub overlapping: f64,
    /// Mass of the released drops [kg].
    pub mass: f64,
    /// Heat [J] and impulse [N s] transferred to the wall since time zero.
    pub heat: f64,
    pub impulse: [f64; 3],
    /// Film diameter of the drop that landed last [m].
    pub spread: f64,
}

/// A heat flux of each cell that falls linearly over a step, see [`Surface::falling_parts`].
pub type Falls = Vec<f64>;

impl Replay {
    pub fn new(plan: ReplayPlan) -> Self {
        let areas = plan.cells.areas(Domain::whole(3));
        let lateral = Lateral::of(&plan.cells, &areas, plan.diffusivity);
        Self { plan, areas, lateral, footprints: Footprints::default() }
    }

    pub fn course(&self) -> &Course {
        &self.plan.course
    }

    pub fn initial_state(&self) -> Vec<f64> {
        flatten(&mut Ledger::default(), &mut [])
    }

    /// Fields of a state; `None` if its length fits no number of drops.
    pub fn layout(&self, state: &[f64]) -> Option<Layout> {
        let rings = self.plan.course.rings();
        Some(layout(drops_in(state, rings)?, rings, cells_in(state)?))
    }

    /// Numbers of drops requested so far, and released.
    pub fn counts(&self, state: &[f64]) -> [f64; 2] {
        let (ledger, _) = self.of(state);
        [ledger.asked, ledger.released]
    }

    /// Largest number of films on one place so far.
    pub fn most_films(&self, state: &[f64]) -> f64 {
        self.of(state).0.stacked
    }

    /// Time [s].
    pub fn time(&self, state: &[f64]) -> f64 {
        self.of(state).0.time
    }

    fn of(&self, state: &[f64]) -> (Ledger, Vec<Drop>) {
        unflatten(state, self.plan.course.rings())
    }

    /// Time at which a drop becomes inactive [s], if its heat is delayed no further.
    fn end(&self, drop: &Drop) -> f64 {
        drop.contact + self.plan.course.duration(drop.speed) + drop.longest_lag()
    }

    /// Advances by `duration` [s] with newly released drops, `asked` of them on request, above a
    /// surface as it would be without all drops of this step. Returns the exchange of the cells,
    /// and its fall over the step.
    pub fn advance(
        &self,
        state: &mut Vec<f64>,
        (released, asked): (&[Falling], usize),
        surface: &Surface,
        duration: f64,
    ) -> (WallExchange, Falls) {
        let (mut ledger, mut drops) = self.of(state);
        let time = ledger.time;
        for ended in drops.extract_if(.., |drop| self.end(drop) <= time) {
            ledger.note_ended(&ended);
        }
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
        self.record_landings(&mut ledger, &mut drops, surface, start);
        drops.iter_mut().for_each(|drop| drop.lag_before.clone_from(&drop.lag));
        let (exchange, falls) = self.give(&mut ledger, &mut drops, surface);
        ledger.heat += exchange.heat.iter().sum::<f64>() + exchange.heat_outside;
        for axis in 0..3 {
            let given: f64 = exchange.impulse.iter().map(|impulse| impulse[axis]).sum();
            ledger.impulse[axis] += self.cartesian(given + exchange.impulse_outside[axis], axis);
        }
        *state = flatten(&mut ledger, &mut drops);
        (exchange, falls)
    }

    /// The impulses of rings are radial and have no direction.
    fn cartesian(&self, given: f64, axis: usize) -> f64 {
        if axis < 2 && self.plan.cells.are_radial() { 0.0 } else { given }
    }

    /// Records the wall temperature where drops land, and which of them meet others.
    fn record_landings(
        &self,
        ledger: &mut Ledger,
        drops: &mut [Drop],
        surface: &Surface,
        start: f64,
    ) {
        for n in 0..drops.len() {
            if drops[n].is_down() || drops[n].contact >= ledger.time {
                continue;
            }
            let part = ((drops[n].contact - start) / ledger.duration).max(0.0);
            let at = SurfaceAt::new(surface, part, ledger.duration);
            let footprint = self.footprint(&drops[n]);
            let means = footprint.rings.iter().map(|ring| ring.mean(|cell| at.temperature(cell)));
            drops[n].wall = means.collect();
            let apart = |other: &Drop| {
                let [x, y] = [0, 1].map(|axis| drops[n].place[axis] - other.place[axis]);
                x.hypot(y)
            };
            let of_others = drops.iter().enumerate().filter(|(m, other)| {
                *m != n && other.is_down() && self.end(other) > drops[n].contact
            });
            let reach = |drop: &Drop| reach(&self.plan.course, drop);
            let own = reach(&drops[n]);
            let (mut meets, mut films) = (false, 1.0);
            for (_, other) in of_others {
                let (distance, others) = (apart(other), reach(other));
                meets |= distance < own + others;
                films += f64::from(distance < others);
            }
            ledger.overlapping += f64::from(meets);
            ledger.stacked = ledger.stacked.max(films);
        }
    }

    /// Instants within a step of this length [s] at which the wall temperature should be updated:
    /// as drops land, and as they cool. An instant due to cooling may be shifted to another one
    /// nearby.
    pub fn moments(&self, state: &[f64], released: &[Falling], duration: f64) -> Vec<f64> {
        let (ledger, drops) = self.of(state);
        let known = drops.iter().map(|drop| (drop.contact, drop.speed));
        let further = released.iter().map(|falling| (falling.contact, falling.speed));
        let touches = known.chain(further).map(|(contact, speed)| (contact - ledger.time, speed));
        let is_within = |moment: f64| (0.0..duration).contains(&moment);
        let turns_of = |&(touched, speed): &(f64, f64)| {
            self.plan.course.turns(speed).map(move |age| (age, touched + age))
        };
        let mut turns: Vec<(f64, f64)> =
            touches.clone().collect::<Vec<_>>().iter().flat_map(turns_of).collect();
        turns.retain(|&(_, moment)| is_within(moment));
        turns.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut moments: Vec<f64> =
            touches.map(|(touched, _)| touched).filter(|&m| is_within(m)).collect();
        for (age, moment) in turns {
            let is_near = |other: f64| (moment - other).abs() < NEAR * age;
            if ![0.0, duration].into_iter().chain(moments.iter().copied()).any(is_near) {
                moments.push(moment);
            }
        }
        moments
    }

    fn footprint(&self, drop: &Drop) -> Arc<Footprint> {
        let course = &self.plan.course;
        self.footprints.at(drop.place, || {
            Footprint::of(&self.plan.cells, drop.place, course.rings(), course.radius())
        })
    }

    /// Exchange of the cells during the last step.
    pub fn exchange(&self, state: &[f64]) -> WallExchange {
        let (ledger, drops) = self.of(state);
        self.collect_exchange(&ledger, &drops, &self.before(&ledger, &drops), |_, _, _| ()).0
    }

    /// Applies the drops' contributions of the last step, above a surface as it would be without
    /// them.
    fn give(
        &self,
        ledger: &mut Ledger,
        drops: &mut [Drop],
        surface: &Surface,
    ) -> (WallExchange, Falls) {
        ledger.uneven.clear();
        let mut limit = Limit::new(surface, &self.areas, ledger.duration);
        let before = self.before(ledger, drops);
        if ledger.duration > 0.0 {
            share(&self.plan.course, ledger, drops, &before);
        }
        let (exchange, falls) =
            self.collect_exchange(ledger, drops, &before, |n, footprint, rings| {
                limit.add(footprint, drops[n].temperature, rings);
            });
        let Some(parts) = limit.parts(&self.lateral) else { return (exchange, falls) };
        let mut delay = drops.to_vec();
        let mut falls_of_rings = vec![Vec::new(); drops.len()];
        let mut last = None;
        self.collect_exchange(ledger, drops, &before, |n, footprint, rings| {
            // Drops released at once are alike.
            let alike = last.filter(|&last: &usize| drops[last] == drops[n]);
            let (lag, falls) = match alike {
                Some(last) => (delay[last].lag.clone(), falls_of_rings[last].clone()),
                None => self.delay(ledger, &drops[n], (footprint, &parts), rings),
            };
            (delay[n].lag, falls_of_rings[n]) = (lag, falls);
            last = Some(n);
        });
        drops.clone_from_slice(&delay);
        let mut uneven = Uneven::none(self.areas.len());
        let (mut exchange, mut falls) =
            self.collect_exchange(ledger, drops, &before, |n, footprint, rings| {
                let falls = rings.iter_mut().zip(&falls_of_rings[n]);
                for ((given, &fall), ring) in falls.zip(&footprint.rings) {
                    given.fall = fall;
                    uneven.add(&parts, ring, given);
                }
            });
        add(&mut exchange.heat, &uneven.heat);
        add(&mut falls, &uneven.fall);
        if uneven.heat.iter().any(|heat| *heat != 0.0) {
            ledger.uneven = uneven.heat;
        }
        (exchange, falls)
    }

    /// Lag of the rings' heat where the wall cannot absorb all of it [s], and its fall then [W].
    fn delay(
        &self,
        ledger: &Ledger,
        drop: &Drop,
        (footprint, parts): (&Footprint, &Parts),
        rings: &[Contribution],
    ) -> (Vec<f64>, Vec<f64>) {
        let of_ring = |(n, (ring, given)): (usize, (&Ring, &Contribution))| {
            let part = Limit::part_of(parts, ring, given);
            let lag = if part < 1.0 { self.lag_for(ledger, drop, n, part) } else { drop.lag[n] };
            (lag, part * given.fall)
        };
        footprint.rings.iter().zip(rings).enumerate().map(of_ring).unzip()
    }

    /// Lag at which a ring has transferred a fraction `part` of its heat in the last step [s].
    fn lag_for(&self, ledger: &Ledger, drop: &Drop, ring: usize, part: f64) -> f64 {
        let age = ledger.time - drop.contact;
        let heat = |age: f64| self.plan.course.heat(drop.speed, ring, age);
        let from = (age - ledger.duration).max(0.0) - drop.lag_before[ring];
        let (mut low, mut high) = (from.max(0.0), age - drop.lag[ring]);
        let (start, end) = (heat(low), heat(high));
        let wanted = start + part * (end - start);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let is_beyond = (heat(middle) - wanted) * (end - start) > 0.0;
            *(if is_beyond { &mut high } else { &mut low }) = middle;
        }
        age - low
    }

    /// Exchange of the cells during the last step, and its fall. `look` is called for each active
    /// drop.
    fn collect_exchange(
        &self,
        ledger: &Ledger,
        drops: &[Drop],
        before: &[Vec<Amounts>],
        mut look: impl FnMut(usize, &Footprint, &mut [Contribution]),
    ) -> (WallExchange, Falls) {
        let mut exchange = WallExchange::none(self.plan.cells.len());
        exchange.duration = ledger.duration;
        let mut falls = vec![0.0; exchange.heat.len()];
        let down = |(_, drop): &(usize, &Drop)| drop.is_down() && ledger.duration > 0.0;
        for (n, drop) in drops.iter().enumerate().filter(down) {
            let Some(mut rings) = self.given(ledger, drop, &before[n]) else { continue };
            let footprint = self.footprint(drop);
            look(n, &footprint, &mut rings);
            // What lies beyond a body keeps its heat.
            let keeps = self.plan.cells.end_with_the_body();
            for (ring, given) in footprint.rings.iter().zip(&rings) {
                ring.parts.iter().for_each(|part| given.to_cell(part, &mut exchange, &mut falls));
                ring.outside.iter().for_each(|part| given.beyond(part, &mut exchange, keeps));
            }
        }
        add(&mut exchange.heat, &ledger.uneven);
        (exchange, falls)
    }

    /// Amounts that the rings of each landed drop had transferred before the last step.
    fn before(&self, ledger: &Ledger, drops: &[Drop]) -> Vec<Vec<Amounts>> {
        let start = ledger.time - ledger.duration;
        let of_drop = |drop: &Drop| match drop.is_down() {
            true => self.plan.course.amounts(drop.speed, start - drop.contact, &drop.lag_before),
            false => Vec::new(),
        };
        drops.iter().map(of_drop).collect()
    }

    /// Contributions of a drop's rings during the last step, if it was active.
    fn given(&self, ledger: &Ledger, drop: &Drop, before: &[Amounts]) -> Option<Vec<Contribution>> {
        let Drop { contact, speed, lag_before, lag, .. } = drop;
        let start = ledger.time - ledger.duration;
        let amounts = |time: f64, lags| self.plan.course.amounts(*speed, time - contact, lags);
        let after = amounts(ledger.time, lag);
        if before == after {
            return None;
        }
        let lags: Vec<f64> = lag_before.iter().zip(lag).map(|(a, b)| 0.5 * (a + b)).collect();
        let between = amounts(start + 0.5 * ledger.duration, &lags);
        let of_ring = |n: usize| {
            let difference = drop.temperature - drop.wall[n];
            let [a, b, c] =
                [before[n], between[n], after[n]].map(|amounts| difference * amounts.heat);
            let fall = 2.0 * (2.0 * b - a - c) / ledger.duration;
            let side = Side::of(difference, c - a);
            Contribution { heat: c - a, fall, side, push: minus(&after[n], &before[n]) }
        };
        Some((0..before.len()).map(of_ring).collect())
    }

    /// Adds the step before the last to the last.
    pub fn join_steps(&self, before: &[f64], state: &mut Vec<f64>) {
        let (earlier, mut drops) = self.of(before);
        let (mut ledger, mut later) = self.of(state);
        let gave: Vec<Drop> = drops.extract_if(.., |drop| self.end(drop) > earlier.time).collect();
        later.iter_mut().zip(gave).for_each(|(drop, earlier)| drop.lag_before = earlier.lag_before);
        drops.extend(later);
        ledger.duration += earlier.duration;
        match ledger.uneven.is_empty() {
            true => ledger.uneven = earlier.uneven,
            false => add(&mut ledger.uneven, &earlier.uneven),
        }
        *state = flatten(&mut ledger, &mut drops);
    }

    pub fn totals(&self, state: &[f64]) -> ReplayTotals {
        let (ledger, drops) = self.of(state);
        let Ledger { time, asked, released, overlapping, heat, impulse, landed, .. } = ledger;
        let down = drops.iter().filter(|drop| drop.is_down());
        let landings = down.map(|drop| [drop.contact, drop.speed]);
        let ended = (landed[1] > 0.0).then_some(landed);
        let last = landings.chain(ended).max_by(|a, b| a[0].total_cmp(&b[0]));
        let spread = |[contact, speed]: [f64; 2]| self.plan.course.spread(speed, time - contact);
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

    /// Returns true if the film of a drop reaches beyond the body on which drops land.
    pub fn reaches_beyond(&self, state: &[f64]) -> bool {
        let (ledger, drops) = self.of(state);
        let radius =
            |drop: &Drop| 0.5 * self.plan.course.spread(drop.speed, ledger.time - drop.contact);
        let is_beyond = |drop: &Drop| {
            (0..2).any(|axis| drop.place[axis].abs() + radius(drop) > self.plan.reach[axis])
        };
        drops.iter().any(|drop| drop.is_down() && is_beyond(drop))
    }

    /// Refuses a vector that no run of these drops leads to, with the reason.
    pub fn check_state(&self, state: &[f64]) -> Result<(), String> {
        let rings = self.plan.course.rings();
        if drops_in(state, rings).is_none() {
            return Err(format!("{} numbers are those of no number of drops", state.len()));
        }
        if let Some(place) = state.iter().position(|number| !number.is_finite()) {
            return Err(format!("number {place} is not finite"));
        }
        let (ledger, drops) = self.of(state);
        let Ledger { time, duration, asked, released, overlapping, stacked, landed, .. } = ledger;
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
        if !is_count(stacked) || stacked > released {
            return Err(format!("{stacked} films on one place, of {released} released"));
        }
        let [contact, speed] = landed;
        let has_landed = self.plan.course.knows(speed) && (0.0..=time).contains(&contact);
        if landed != [0.0; 2] && !has_landed {
            return Err(format!("a last drop of {speed} m/s at {contact} s"));
        }
        if time < 0.0 || duration < 0.0 || duration > time * (1.0 + ROUNDING) {
            return Err(format!("a last step of {duration} s before {time} s"));
        }
        self.check_uneven(&ledger.uneven, &drops)?;
        drops.iter().try_for_each(|drop| self.check_drop(&ledger, drop))
    }

    fn check_uneven(&self, uneven: &[f64], drops: &[Drop]) -> Result<(), String> {
        let cells = self.areas.len();
        if !uneven.is_empty() && uneven.len() != cells {
            return Err(format!("heat of {} cells, of {cells}", uneven.len()));
        }
        let [sum, size] = [uneven.iter().sum::<f64>(), uneven.iter().map(|heat| heat.abs()).sum()];
        let warmth: f64 = drops.iter().map(|drop| self.plan.heat_capacity * drop.temperature).sum();
        if sum.abs() > ROUNDING * (size + warmth) {
            return Err(format!("cells that got {sum} J more than drops gave"));
        }
        Ok(())
    }

    fn check_drop(&self, ledger: &Ledger, drop: &Drop) -> Result<(), String> {
        let Drop { contact, place, speed, temperature, wall, lag, lag_before } = drop;
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
        let age = (ledger.time - contact).max(0.0) * (1.0 + ROUNDING);
        let step = ledger.duration * (1.0 + ROUNDING);
        let lags = || lag_before.iter().zip(lag);
        if lags()
            .any(|(before, now)| *before < 0.0 || now < before || *now > age.min(before + step))
        {
            return refuse("has heat that lags behind as none does");
        }
        if self.end(drop) < (ledger.time - ledger.duration) * (1.0 - ROUNDING) {
            return refuse("has nothing more to give");
        }
        Ok(())
    }
}

/// Fraction of its age by which an instant due to cooling may be shifted.
pub const NEAR: f64 = 0.08;
/// Relative rounding of times and places.
const ROUNDING: f64 = 1e-9;

/// Adds numbers of cells, if there are any.
fn add(to: &mut [f64], more: &[f64]) {
    to.iter_mut().zip(more).for_each(|(to, more)| *to += more);
}

fn minus(after: &Amounts, before: &Amounts) -> [f64; 2] {
    [after.push - before.push, after.outward - before.outward]
}

/// Number of bisections when a lag is searched for.
const HALVINGS: usize = 60;

/// Contribution of a ring during a step: heat [J], its fall [W], its effect on the wall,
/// and impulse into the wall and outward [N s].
pub struct Contribution {
    pub heat: f64,
    pub fall: f64,
    pub side: Option<Side>,
    push: [f64; 2],
}

impl Contribution {
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
