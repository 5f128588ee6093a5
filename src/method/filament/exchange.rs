//! The exchange of heat of one segment with what lies below it and with the air, in a step.

use super::Segment;
use super::carriers::MOST_CARRIERS;
use super::cooling::{Column, Surroundings};
use super::line::Line;
use super::spreading::Spreading;
use super::stacks::TOP;
use crate::inputs::Trend;
use crate::port::Surface;

/// Part of its heat that a segment releases in an inner step, at most.
const COOLING: f64 = 0.05;
/// Growth of the width in an inner step, at most.
const GROWTH: f64 = 0.05;
const MOST_STEPS: f64 = 64.0;
/// Number of inner steps of the first step of a segment, at least.
const FIRST_STEPS: f64 = 12.0;
/// Difference of a segment's temperatures from those around it that is worth an inner step [K].
const LEAST_APART: f64 = 0.1;
/// The same below which it exchanges no heat [K].
const ASLEEP: f64 = 1e-2;
/// Conductance of fluids that do not conduct, so that temperatures below still have a mean [W/K].
const LEAST_CONDUCTANCE: f64 = 1e-200;

/// The body below a segment.
pub enum Below<'a> {
    Nothing,
    Plate {
        surface: &'a Surface,
        /// Mean temperature of the cells without the strand's heat when contact begins in this step, and at its end
        /// [K].
        ends: [f64; 2],
        /// Flux into the cells over the heat flow of the segment, as others share them with it [1/m²].
        flux: f64,
        /// Part of the segment above the plate.
        inside: f64,
    },
    /// Segments that carry it, with their shares of its lower side and the heat that they have received from it in
    /// advance [J].
    Segments(Vec<(Segment, f64, f64)>),
}

/// Place of a segment between others in a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Stacked {
    /// Part of its upper side on which others lie.
    pub covered: f64,
    /// Heat expected from these [J].
    pub received: f64,
    /// Heat that each of its carriers expects from it [J].
    pub expected: [f64; MOST_CARRIERS],
}

/// The exchange of heat of a segment in a step.
pub struct Exchange<'a> {
    /// The plate below it, or nothing.
    pub below: Below<'a>,
    /// The time at which it begins [s], and that to which it has come.
    pub from: f64,
    pub now: f64,
    /// Its duration [s].
    pub whole: f64,
    /// Heat that has passed down [J].
    pub given: f64,
}

/// A step of one segment.
pub struct SegmentStep<'a> {
    line: &'a Line,
    below: &'a Below<'a>,
    born: f64,
    /// Ages of the segment at its beginning and end [s].
    ages: [f64; 2],
    /// Age at which the exchange began of which this is a part, and its duration [s].
    began: f64,
    whole: f64,
    /// Heat that has passed down since then [J].
    before: f64,
    /// Heat that segments above transfer to its highest layer [J].
    received: f64,
    /// Part of its upper side on which other segments lie.
    covered: f64,
    /// Temperature of the air over the age of the segment [K].
    air: Trend,
}

impl<'a> SegmentStep<'a> {
    /// A step of a segment between two times of an exchange [s], without segments or air above it.
    pub fn over(
        line: &'a Line,
        exchange: &'a Exchange<'a>,
        segment: &Segment,
        times: [f64; 2],
    ) -> Self {
        Self {
            line,
            below: &exchange.below,
            born: segment.born,
            ages: times.map(|time| time - segment.born),
            began: exchange.from - segment.born,
            whole: exchange.whole,
            before: exchange.given,
            received: 0.0,
            covered: 0.0,
            air: Trend::held(line.plan.reference),
        }
    }

    /// The same step as it lies on others and below others, in air of a temperature [K].
    pub fn between(self, below: &'a Below<'a>, stacked: &Stacked, air: Trend) -> Self {
        let (covered, air) = (stacked.covered.min(1.0), air.since(self.born));
        Self { below, covered, received: stacked.received, air, ..self }
    }

    /// Advances the segment; returns the heat that passed down and to the air [J].
    pub fn advance(&self, segment: &mut Segment) -> [f64; 2] {
        let [first, last] = self.ages;
        let apart = self.apart(segment);
        let conducts = self.line.heat.conductivity > 0.0 && apart > ASLEEP;
        let count = self.steps(segment, apart);
        // Equal steps of the root of the age, as heat passes at first.
        let [low, high] = [first.sqrt(), last.sqrt()];
        let age = |n: usize| match n == count {
            true => last,
            false => (low + (high - low) * n as f64 / count as f64).powi(2).max(first),
        };
        let mut sums = [0.0; 2];
        for n in 0..count {
            let ages = [age(n), age(n + 1)];
            if ages[1] <= ages[0] {
                continue;
            }
            if self.received != 0.0 {
                let part = (ages[1] - ages[0]) / (self.ages[1] - self.ages[0]);
                segment.heats[TOP] += part * self.received;
            }
            if conducts {
                let column = Column { volume: segment.volume, height: segment.height() };
                let around = self.surroundings(segment, ages, sums[0]);
                let heat = &self.line.heat;
                let passed = heat.advance(&mut segment.heats, column, ages[1] - ages[0], &around);
                (0..2).for_each(|n| sums[n] += passed[n]);
            }
            segment.half_width =
                self.spreading(segment).advance(segment.half_width, ages[1] - ages[0]);
        }
        sums
    }

    fn spreading(&self, segment: &Segment) -> Spreading<'_> {
        Spreading {
            fluid: &self.line.plan.fluid,
            gravity: self.line.plan.gravity,
            section: segment.section(),
            temperature: self.line.temperature(segment),
            frozen: self.line.frozen(segment),
        }
    }

    /// Largest difference between the temperatures of the layers and those around the segment [K].
    fn apart(&self, segment: &Segment) -> f64 {
        let around = self.surroundings(segment, self.ages, 0.0);
        let variation = self.air.variation(self.ages);
        let apart = self.line.temperatures(segment).map(|temperature| {
            let to_air = match self.line.plan.air > 0.0 {
                true => (temperature - around.air).abs() + variation,
                false => 0.0,
            };
            (temperature - around.below).abs().max(to_air)
        });
        apart.into_iter().fold(0.0, f64::max)
    }

    /// Number of inner steps, by what a step changes; `apart` is the difference of temperatures [K].
    fn steps(&self, segment: &Segment, apart: f64) -> usize {
        let duration = self.ages[1] - self.ages[0];
        // A segment that is as warm as its surroundings has nothing to resolve.
        let cooling = match apart > ASLEEP {
            true => {
                let released = self.line.heat.cooling(segment.height(), self.ages);
                released.min(apart / LEAST_APART) + self.air_ratio(segment, duration)
            }
            false => 0.0,
        };
        let growth = self.spreading(segment).speed(segment.half_width) * duration;
        let growth = (growth / segment.half_width).min(1.0);
        let least = if self.ages[0] == 0.0 && apart > LEAST_APART { FIRST_STEPS } else { 1.0 };
        (cooling / COOLING).max(growth / GROWTH).ceil().clamp(least, MOST_STEPS) as usize
    }

    /// Areas of the upper side and of the others that face the air [m²].
    fn exposed(&self, segment: &Segment) -> [f64; 2] {
        let above = (1.0 - self.covered) * segment.area();
        [above, 2.0 * segment.height() * segment.length()]
    }

    /// Heat per difference of temperature that passes to the air in a time, over the heat capacity of the molten
    /// segment.
    fn air_ratio(&self, segment: &Segment, duration: f64) -> f64 {
        let exposed: f64 = self.exposed(segment).iter().sum();
        duration * self.line.plan.air * exposed / self.line.heat.capacity(segment.volume)
    }

    /// Returns the bodies with which the segment exchanges heat between two ages, after some heat has passed down in
    /// this step [J].
    fn surroundings(&self, segment: &Segment, ages: [f64; 2], before: f64) -> Surroundings {
        let (below, resistance) = self.below(segment, ages, before);
        let [above, aside] = self.exposed(segment).map(|area| self.line.plan.air * area);
        let contact = self.contact(segment);
        Surroundings { below, resistance, contact, air: self.air.mean(ages), above, aside }
    }

    /// Area through which the segment touches what lies below it [m²].
    fn contact(&self, segment: &Segment) -> f64 {
        match self.below {
            Below::Nothing => 0.0,
            Below::Plate { inside, .. } => segment.area() * inside,
            Below::Segments(_) => segment.area(),
        }
    }

    /// Heat flow from the lowest layer into the plate over their difference of temperature [W/K], at the end of a time
    /// [s] in which it warms the plate; 0 without one.
    pub fn conductance(&self, segment: &Segment, time: f64) -> f64 {
        let Below::Plate { surface, flux, .. } = self.below else { return 0.0 };
        let area = self.contact(segment);
        let contact = self.line.plan.conductance.map_or(0.0, |value| 1.0 / (value * area));
        let content = self.line.contents(segment)[0];
        let own = self.line.heat.half_resistance(0, segment.height(), content) / area;
        1.0 / (flux * surface.response.of_held_flux(time) + contact + own)
    }

    /// Temperature below [K], and the resistance to it, with the rise that the heat of this inner step causes [K/W].
    fn below(&self, segment: &Segment, ages: [f64; 2], before: f64) -> (f64, f64) {
        let duration = ages[1] - ages[0];
        match self.below {
            Below::Nothing => (self.air.mean(ages), f64::INFINITY),
            Below::Plate { surface, ends, flux, .. } => {
                let elapsed = ages[1] - self.began;
                let free = ends[0] + elapsed / self.whole * (ends[1] - ends[0]);
                let rise = flux * surface.response.of_held_flux(elapsed) / elapsed;
                let area = self.contact(segment);
                let contact = self.line.plan.conductance.map_or(0.0, |value| 1.0 / (value * area));
                (free + rise * (self.before + before), contact + rise * duration)
            }
            Below::Segments(_) => {
                let part = (ages[1] - self.ages[0]) / (self.ages[1] - self.ages[0]);
                let mut links = self.links(segment.area(), (duration, part));
                let (_, all) = joined(&links);
                for link in &mut links {
                    link.below += before * link.conductance / all / link.capacity;
                }
                let (below, conductance) = joined(&links);
                (below, 1.0 / conductance)
            }
        }
    }

    /// Links to the highest layers of the segments that carry an area of this one [m²], whose temperatures follow the
    /// heat of an inner step of a duration [s], as if they had received none in advance for a part of this step.
    pub fn links(&self, area: f64, (duration, part): (f64, f64)) -> Vec<Link> {
        let Below::Segments(carriers) = self.below else { return Vec::new() };
        let heat = &self.line.heat;
        let link = |(lower, share, expected): &(Segment, f64, f64)| {
            let content = self.line.contents(lower)[TOP];
            let capacity = heat.top_capacity(lower);
            let own = heat.half_resistance(TOP, lower.height(), content) / (share * area);
            let conductance = (1.0 / (own + duration / capacity)).max(LEAST_CONDUCTANCE);
            let below = heat.temperature(content) - part * expected / capacity;
            Link { below, capacity, conductance }
        };
        carriers.iter().map(link).collect()
    }
}

/// A link from the lower side of a segment to a layer below.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// Temperature of that layer [K], and its heat capacity [J/K].
    pub below: f64,
    pub capacity: f64,
    /// [W/K]
    pub conductance: f64,
}

/// The temperature [K] and the conductance [W/K] of one link that takes as much heat as some parallel ones.
pub fn joined(links: &[Link]) -> (f64, f64) {
    let conductance = links.iter().map(|link| link.conductance).sum::<f64>();
    let weighted = links.iter().map(|link| link.conductance * link.below);
    (weighted.sum::<f64>() / conductance, conductance)
}
