//! Segments that lie on others, and the parts into which their exchange of heat is cut.
//!
//! A segment takes heat from those above it while these step, which lets it pass nothing on before its own next step. So
//! segments in a stack exchange heat in parts of a step, and at the beginning of a part each receives the heat that
//! follows from the temperatures then. What really passes follows from the step of the segment above, and corrects it.
//! A flow that does not change needs no correction, however long the part is.

use super::carriers::MOST_CARRIERS;
use super::cooling::{Heat, LAYERS, SHARES};
use super::{Segment, Strand};

/// Longest part over the time `l²/a` that heat takes through the highest layer of a carrier of the thickness l.
const PART: f64 = 0.25;
/// Largest expected heat over what the highest layer holds between its temperature and that of the layer above.
const EXPECTED: f64 = 0.5;
/// Change of temperature of a highest layer over the rest of a step that is worth a part [K].
const WORTH: f64 = 0.1;
/// Largest number of parts of a step.
const MOST_PARTS: f64 = 1024.0;
/// The highest layer of a carrier.
pub const TOP: usize = LAYERS - 1;

/// Returns for each segment whether it lies on others or carries some; empty where none does.
pub fn stacked(strand: &Strand) -> Vec<bool> {
    let mut stacked = Vec::new();
    for (n, segment) in strand.segments().enumerate() {
        for (lower, _) in segment.below.iter() {
            stacked.resize(strand.len(), false);
            (stacked[n], stacked[lower]) = (true, true);
        }
    }
    stacked
}

/// A part of a step.
pub struct Part {
    /// End of the part [s].
    pub end: f64,
    /// True for segments that step to this end.
    pub steps: Vec<bool>,
}

impl Heat {
    /// The smallest heat capacity of the highest layer of a segment, molten or frozen [J/K].
    pub fn top_capacity(&self, segment: &Segment) -> f64 {
        let least = self.phases.map_or(1.0, |phases| phases.heat.min(1.0));
        least * SHARES[TOP] * self.capacity(segment.volume)
    }

    /// Smallest time `l²/a` that heat takes through the highest layer of a segment [s].
    fn top_time(&self, segment: &Segment) -> f64 {
        let most = self.phases.map_or(1.0, |phases| phases.conduction.max(1.0));
        let height = SHARES[TOP] * segment.height();
        height * self.top_capacity(segment) / (segment.area() * most * self.conductivity)
    }

    /// A link between the lowest layer of a segment and the highest one of a carrier with a share of its lower side.
    fn link(&self, upper: &Segment, (lower, share): (&Segment, f64)) -> Link {
        let below = self.contents(&lower.heats, lower.volume)[TOP];
        let above = self.contents(&upper.heats, upper.volume)[0];
        Link {
            area: share * upper.area(),
            resistance: self.half_resistance(TOP, lower.height(), below)
                + self.half_resistance(0, upper.height(), above),
            capacity: self.top_capacity(lower) / lower.area(),
            difference: self.temperature(above) - self.temperature(below),
        }
    }

    /// The next part of a step that has come to a time and goes on to an end [s]. Segments that hardly exchange heat
    /// with others until then step at the end.
    pub fn next_part(
        &self,
        strand: &Strand,
        (stacked, now, end): (&[bool], f64, f64),
        shortest: f64,
    ) -> Part {
        let left = end - now;
        let mut steps = vec![false; strand.len()];
        let [mut weight, mut weighted] = [0.0; 2];
        for (n, upper) in strand.segments().enumerate().filter(|(n, _)| stacked[*n]) {
            for (number, share) in upper.below.iter() {
                let lower = strand.segment(number);
                let link = self.link(&upper, (&lower, share));
                if link.difference.abs() * left > WORTH * link.resistance * link.capacity {
                    (steps[n], steps[number]) = (true, true);
                    let own = link.area * link.difference.abs();
                    (weight, weighted) = (weight + own, weighted + own * self.top_time(&lower));
                }
            }
        }
        let longest = if weight > 0.0 { PART * weighted / weight } else { f64::INFINITY };
        let next = now + left / (left / longest.max(shortest)).ceil().max(1.0);
        match now < next && next < end {
            true => Part { end: next, steps },
            false => Part { end, steps: stacked.to_vec() },
        }
    }

    /// Heat that a segment is expected to transfer in some time [s] to each of its carriers that `step` [J].
    pub fn expected(
        &self,
        strand: &Strand,
        (upper, time): (&Segment, f64),
        steps: &[bool],
    ) -> [f64; MOST_CARRIERS] {
        let mut expected = [0.0; MOST_CARRIERS];
        let carriers = expected.iter_mut().zip(upper.below.iter());
        for (heat, (number, share)) in carriers.filter(|(_, (number, _))| steps[*number]) {
            let link = self.link(upper, (&strand.segment(number), share));
            let most = EXPECTED * link.capacity;
            *heat = link.area * link.difference * (time / link.resistance).min(most);
        }
        expected
    }
}

/// A link between two segments.
struct Link {
    /// [m²]
    area: f64,
    /// Resistance [m² K/W] and heat capacity of the layer below [J/(m² K)] per area.
    resistance: f64,
    capacity: f64,
    /// Temperature of the layer above less that of the layer below [K].
    difference: f64,
}

/// Shortest part of a step of a duration [s].
pub fn shortest_part(duration: f64) -> f64 {
    duration / MOST_PARTS
}
