//! Steps of a strand: fluid is laid, then every segment spreads and exchanges heat.

use std::sync::Arc;

use super::cooling::{Heat, LAYERS, SHARES};
use super::exchange::{Below, Exchange, SegmentStep, Stacked, joined};
use super::footprint::{Footprint, Footprints};
use super::laying::Arrival;
use super::sections::CLEARANCE;
use super::spreading::PACKED;
use super::stacks::{TOP, shortest_part, stacked};
use super::{Failure, LinePlan, Segment, Strand};
use crate::inputs::{Motion, Trend};
use crate::port::{Domain, Surface};

/// A filament that is laid as a line of segments.
pub struct Line {
    pub(super) plan: LinePlan,
    pub(super) heat: Heat,
    areas: Vec<f64>,
    footprints: Footprints,
}

/// The surroundings of a strand over a step.
pub struct Around<'a> {
    pub surface: &'a Surface,
    /// Temperature of the air [K].
    pub air: Trend,
}

/// Sums over a strand.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LineTotals {
    /// Path of the strand [m].
    pub length: f64,
    /// Mean width over the length, and volume over covered area [m].
    pub width: f64,
    pub height: f64,
    /// Width and height of the last segment [m].
    pub last_width: f64,
    pub last_height: f64,
    /// Distance between the nozzle's outlet, projected on the plate, and the touchdown of the strand [m].
    pub lag: f64,
    /// Largest weight of what stands on a base over what the yield stress of its lowest layer bears.
    pub bearing: f64,
    /// Hottest and coldest segment [K].
    pub hottest: f64,
    pub coldest: f64,
    /// Frozen fraction of the volume.
    pub frozen: f64,
    /// Heat gained since it came, negative when cooled [J].
    pub heat_stored: f64,
    /// Volume of all segments [m³].
    pub volume: f64,
    /// Heat that appeared from nowhere: the rounding of the balance [J].
    pub missing: f64,
}

/// Part of the lower side of a segment beyond the edge of the plate that is worth a warning.
const BEYOND_EDGE: f64 = 1e-6;
/// Relative error of the heat balance of a state that runs never reach.
const BALANCE: f64 = 1e-6;

impl Line {
    pub fn new(plan: LinePlan) -> Self {
        let fluid = &plan.fluid;
        let heat = Heat {
            reference: plan.reference,
            capacity: fluid.density * fluid.specific_heat,
            conductivity: fluid.conductivity,
            phases: plan.phases(),
        };
        let areas = plan.cells.as_ref().map_or(Vec::new(), |cells| cells.areas(Domain::whole(3)));
        Self { plan, heat, areas, footprints: Footprints::default() }
    }

    pub fn plan(&self) -> &LinePlan {
        &self.plan
    }

    /// The state before time starts, with the place of the nozzle's outlet.
    pub fn start(&self, nozzle: [f64; 3]) -> Strand {
        Strand::new(self.areas.len(), nozzle)
    }

    /// Temperatures of the layers of a segment [K], from below.
    pub(super) fn temperatures(&self, segment: &Segment) -> [f64; LAYERS] {
        self.contents(segment).map(|content| self.heat.temperature(content))
    }

    /// Mean temperature of a segment [K].
    pub fn temperature(&self, segment: &Segment) -> f64 {
        mean(self.temperatures(segment))
    }

    /// Frozen fraction of a segment.
    pub fn frozen(&self, segment: &Segment) -> f64 {
        mean(self.contents(segment).map(|content| self.heat.frozen(content)))
    }

    pub(super) fn contents(&self, segment: &Segment) -> [f64; LAYERS] {
        self.heat.contents(&segment.heats, segment.volume)
    }

    /// Advances a strand through motions of the nozzle, one after the other; returns the number of parts in which its
    /// segments exchanged heat.
    pub fn advance(
        &self,
        strand: &mut Strand,
        motions: &[Motion],
        around: &Around,
    ) -> Result<usize, Failure> {
        let begin = strand.time;
        let mut arrivals = Vec::new();
        for motion in motions {
            arrivals.extend(self.lay(strand, motion)?);
        }
        let duration = strand.time - begin;
        strand.duration = duration;
        strand.cell_heat.fill(0.0);
        strand.cell_impulse.fill([0.0; 3]);
        let feet = self.footprints.of(strand, self.plan.cells.as_ref());
        let parts = self.exchange_heat(strand, (begin, duration), around, &feet);
        self.exchange_impulse(strand, &arrivals, (begin, duration), &feet);
        Ok(parts)
    }

    /// Exchanges heat over a step; returns the number of parts in which stacked segments do, 1 without any.
    fn exchange_heat(
        &self,
        strand: &mut Strand,
        (begin, duration): (f64, f64),
        around: &Around,
        feet: &[Arc<Footprint>],
    ) -> usize {
        let free = match self.areas.is_empty() || duration == 0.0 {
            true => [Vec::new(), Vec::new()],
            false => [0.0, 1.0].map(|part| around.surface.free(part, duration)),
        };
        let covered = self.covered_cells(strand, feet);
        let of_segment = |(n, segment): (usize, Segment)| {
            let from = segment.born.max(begin);
            let below = match segment.below.is_empty() && from < strand.time {
                true => {
                    let parts = [(from - begin) / duration, 1.0];
                    let foot = (&*feet[n], segment.area());
                    self.below_on_plate((around.surface, &free), foot, &covered, parts)
                }
                false => Below::Nothing,
            };
            let whole = (strand.time - segment.born) - (from - segment.born);
            Exchange { below, from, now: from, whole, given: 0.0 }
        };
        let mut exchanges: Vec<Exchange> = strand.segments().enumerate().map(of_segment).collect();
        let stacked = stacked(strand);
        let is_stacked = |n: usize| stacked.get(n).is_some_and(|&own| own);
        for (n, exchange) in exchanges.iter_mut().enumerate().filter(|(n, _)| !is_stacked(*n)) {
            let (end, alone) = (strand.time, Stacked::default());
            self.exchange_of((&mut *strand, n), exchange, end, (alone, around.air));
        }
        let parts = match stacked.is_empty() {
            true => 1,
            false => self.exchange_in_stacks(strand, (begin, &stacked), &mut exchanges, around.air),
        };
        for (n, exchange) in exchanges.iter().enumerate() {
            let segment = strand.segment(n);
            let time = strand.time - exchange.from;
            if !segment.below.is_empty() || time <= 0.0 {
                continue;
            }
            strand.given += exchange.given;
            let inside = feet[n].inside();
            let [_, free] = &free;
            let mean = feet[n].mean(|cell| free[cell]).unwrap_or(0.0);
            let step = SegmentStep::over(self, exchange, &segment, [exchange.from, strand.time]);
            let conductance = step.conductance(&segment, time);
            for &(cell, weight) in &feet[n].cells {
                // Warm cells take less than cold ones below the same segment.
                let more = conductance * time * (mean - free[cell]);
                strand.cell_heat[cell] += (exchange.given + more) * weight / inside;
            }
        }
        parts
    }

    /// Exchanges heat of the segments that lie on others or carry them, part by part, those below first; returns the
    /// number of parts.
    fn exchange_in_stacks(
        &self,
        strand: &mut Strand,
        (begin, stacked): (f64, &[bool]),
        exchanges: &mut [Exchange],
        air: Trend,
    ) -> usize {
        let (mut now, end, mut parts) = (begin, strand.time, 0);
        while now < end {
            let part = self.heat.next_part(strand, (stacked, now, end), shortest_part(end - begin));
            let mut all = vec![Stacked::default(); strand.len()];
            let times = exchanges.iter().map(|exchange| part.end - exchange.now);
            let times: Vec<f64> = times.map(|time| time.max(0.0)).collect();
            cover(strand, &mut all, |n| (times[n] / (part.end - now)).min(1.0));
            for n in (0..strand.len()).filter(|&n| part.steps[n] && times[n] > 0.0) {
                let segment = strand.segment(n);
                all[n].expected = self.heat.expected(strand, (&segment, times[n]), &part.steps);
                for ((lower, _), heat) in segment.below.iter().zip(all[n].expected) {
                    all[lower].received += heat;
                }
            }
            for n in (0..strand.len()).filter(|&n| part.steps[n]) {
                self.exchange_of((&mut *strand, n), &mut exchanges[n], part.end, (all[n], air));
            }
            (now, parts) = (part.end, parts + 1);
        }
        parts.max(1)
    }

    /// Exchanges heat of a segment up to a time [s], as it lies in a stack and in air of a temperature [K].
    fn exchange_of(
        &self,
        (strand, n): (&mut Strand, usize),
        exchange: &mut Exchange,
        to: f64,
        (stacked, air): (Stacked, Trend),
    ) {
        let mut segment = strand.segment(n);
        let time = to - exchange.now;
        if time <= 0.0 {
            segment.heats[TOP] += stacked.received;
            strand.set(n, &segment);
            return;
        }
        let carriers = segment.below.iter().zip(stacked.expected);
        let carriers =
            carriers.map(|((lower, share), expected)| (strand.segment(lower), share, expected));
        let on_segments = Below::Segments(carriers.collect());
        let step = SegmentStep::over(self, exchange, &segment, [exchange.now, to]);
        let step = match segment.below.is_empty() {
            true => step.between(&exchange.below, &stacked, air),
            false => step.between(&on_segments, &stacked, air),
        };
        let [given, lost] = step.advance(&mut segment);
        strand.set(n, &segment);
        strand.lost += lost;
        let links = step.links(segment.area(), (time, 1.0));
        let (mean, all) = joined(&links);
        for (((lower, _), link), expected) in segment.below.iter().zip(&links).zip(stacked.expected)
        {
            // As much as parallel links take from one temperature above them.
            let part = link.conductance / all;
            let more = link.conductance * time * (mean - link.below);
            let mut carrier = strand.segment(lower);
            carrier.heats[TOP] += given * part + more - expected;
            strand.set(lower, &carrier);
        }
        (exchange.given, exchange.now) = (exchange.given + given, to);
    }

    /// Covered part of each cell of the plate.
    fn covered_cells(&self, strand: &Strand, feet: &[Arc<Footprint>]) -> Vec<f64> {
        let mut covered = vec![0.0; self.areas.len()];
        for (segment, foot) in strand.segments().zip(feet).filter(|(own, _)| own.below.is_empty()) {
            for &(cell, weight) in &foot.cells {
                covered[cell] += weight * segment.area() / self.areas[cell];
            }
        }
        covered
    }

    fn below_on_plate<'a>(
        &self,
        (surface, free): (&'a Surface, &[Vec<f64>; 2]),
        (foot, area): (&Footprint, f64),
        covered: &[f64],
        parts: [f64; 2],
    ) -> Below<'a> {
        let ends = free.each_ref().map(|free| foot.mean(|cell| free[cell]));
        let [Some(first), Some(last)] = ends else { return Below::Nothing };
        let at = |part: f64| first + part * (last - first);
        let cover = foot.mean(|cell| covered[cell]).unwrap_or(0.0);
        let inside = foot.inside();
        Below::Plate { surface, ends: parts.map(at), flux: cover / (area * inside), inside }
    }

    /// Passes the weight of the strand and the momentum of arriving fluid to the plate, through the segments below.
    fn exchange_impulse(
        &self,
        strand: &mut Strand,
        arrivals: &[Arrival],
        (begin, duration): (f64, f64),
        feet: &[Arc<Footprint>],
    ) {
        let weight = -self.plan.fluid.density * self.plan.gravity;
        let resting = weight * duration;
        let mut loads: Vec<[f64; 3]> =
            strand.segments().map(|segment| [0.0, 0.0, resting * segment.volume]).collect();
        for Arrival { segment, volume, time, impulse } in arrivals {
            let before = weight * volume * (time - begin);
            add(&mut loads[*segment], [impulse[0], impulse[1], impulse[2] - before], 1.0);
        }
        for n in (0..strand.len()).rev() {
            let load = loads[n];
            let below = strand.segment(n).below;
            below.iter().for_each(|(lower, share)| add(&mut loads[lower], load, share));
            if below.is_empty() {
                add(&mut strand.impulse, load, 1.0);
                for &(cell, part) in &feet[n].cells {
                    add(&mut strand.cell_impulse[cell], load, part);
                }
            }
        }
    }

    pub fn totals(&self, strand: &Strand) -> LineTotals {
        let mut totals =
            LineTotals { hottest: f64::MIN, coldest: f64::MAX, ..LineTotals::default() };
        let (mut length, mut area, mut volume, mut frozen, mut heat) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for segment in strand.segments() {
            totals.length += segment.path;
            length += segment.length();
            area += segment.area();
            volume += segment.volume;
            heat += segment.heat();
            frozen += segment.volume * self.frozen(&segment);
            for temperature in self.temperatures(&segment) {
                totals.hottest = totals.hottest.max(temperature);
                totals.coldest = totals.coldest.min(temperature);
            }
            (totals.last_width, totals.last_height) = (segment.width(), segment.height());
        }
        if volume > 0.0 {
            (totals.width, totals.height) = (area / length, volume / area);
            totals.frozen = frozen / volume;
        } else {
            (totals.hottest, totals.coldest) = (self.plan.reference, self.plan.reference);
        }
        totals.bearing = self.bearing(strand);
        let [x, y, _] = strand.nozzle;
        totals.lag = (x - strand.touch[0]).hypot(y - strand.touch[1]);
        totals.volume = volume;
        totals.heat_stored = heat - strand.supplied;
        totals.missing = totals.heat_stored + strand.given + strand.lost;
        totals
    }

    /// Largest `ρ g H/(√3 τ_y)` of a segment, with the height H of itself and all that is stacked on it: a layer yields
    /// from 1 on (N. Roussel 2018, doi 10.1016/j.cemconres.2018.04.005). 0 without a yield stress; frozen segments bear
    /// all.
    fn bearing(&self, strand: &Strand) -> f64 {
        self.bearing_of(strand, |_| true)
    }

    /// The same of segments on which others are stacked: one alone that is wide and flat may be beyond 1, at rest.
    pub fn bearing_of_stacks(&self, strand: &Strand) -> f64 {
        self.bearing_of(strand, |above| above > 0.0)
    }

    /// The largest ratio of the segments that are chosen by the height above their own tops [m].
    fn bearing_of(&self, strand: &Strand, is_chosen: impl Fn(f64) -> bool) -> f64 {
        let fluid = &self.plan.fluid;
        if fluid.viscosity.yield_stress() == 0.0 {
            return 0.0;
        }
        let mut tops: Vec<f64> = strand.segments().map(|segment| segment.top()).collect();
        let mut largest = 0.0_f64;
        for n in (0..strand.len()).rev() {
            let segment = strand.segment(n);
            for (lower, _) in segment.below.iter() {
                tops[lower] = tops[lower].max(tops[n]);
            }
            if self.frozen(&segment) < PACKED && is_chosen(tops[n] - segment.top()) {
                let curve = fluid.viscosity.at(self.temperature(&segment));
                let weight = fluid.density * self.plan.gravity * (tops[n] - segment.base);
                largest = largest.max(weight / (3.0_f64.sqrt() * curve.yield_stress()));
            }
        }
        if largest.is_finite() { largest } else { 0.0 }
    }

    /// Largest height of slowly laid fluid above the outlet that laid it [m], if that is worth a warning.
    pub fn rise_above_outlet(&self, strand: &Strand) -> Option<f64> {
        let slow = strand.segments().filter(|segment| self.is_thick(segment));
        let rise = slow.map(|segment| segment.top() - segment.outlet).fold(0.0, f64::max);
        (rise > CLEARANCE * self.plan.diameter).then_some(rise)
    }

    /// Returns true if part of a segment lies beyond the edge of the plate.
    pub fn reaches_beyond(&self, strand: &Strand) -> bool {
        let feet = self.footprints.of(strand, self.plan.cells.as_ref());
        feet.iter().any(|foot| foot.outside > BEYOND_EDGE)
    }

    /// Refuses a state that no run produces, with the reason.
    pub fn check(&self, strand: &Strand) -> Result<(), String> {
        strand.check()?;
        let totals = self.totals(strand);
        let mut scale = strand.supplied.abs() + strand.given.abs();
        for (n, segment) in strand.segments().enumerate() {
            scale +=
                segment.heat().abs() + self.heat.capacity(segment.volume) * self.plan.reference;
            if self.temperatures(&segment).iter().any(|&temperature| temperature <= 0.0) {
                return Err(format!("segment {n} is below absolute zero"));
            }
        }
        let (volume, missing) = (totals.volume, totals.missing);
        if (volume - strand.volume).abs() > BALANCE * strand.volume {
            return Err(format!("{} m³ came, and {volume} m³ are in segments", strand.volume));
        }
        match missing.abs() <= BALANCE * scale {
            true => Ok(()),
            false => Err(format!("{missing:e} J of heat have no cause")),
        }
    }
}

/// Covers the upper sides of segments by those above, each by the part of a step in which it is in contact.
fn cover(strand: &Strand, all: &mut [Stacked], part: impl Fn(usize) -> f64) {
    for (n, segment) in strand.segments().enumerate() {
        for (lower, share) in segment.below.iter() {
            let area = part(n) * share * segment.area();
            all[lower].covered += area / strand.segment(lower).area();
        }
    }
}

/// Mean over the volume of a segment.
fn mean(values: [f64; LAYERS]) -> f64 {
    values.iter().zip(SHARES).map(|(value, share)| share * value).sum()
}

fn add(sum: &mut [f64; 3], vector: [f64; 3], weight: f64) {
    sum.iter_mut().zip(vector).for_each(|(sum, part)| *sum += weight * part);
}
