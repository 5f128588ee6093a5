//! Lays segments along the path of the nozzle.
//!
//! Where the outlet is higher above the plate than the strand is thick, the fluid between them trails behind. It leaves
//! the outlet with the nozzle's velocity and rests on the plate; with a velocity linear in the height in between, the
//! place of touchdown p follows that of the nozzle, x, by `dp/dt = (x − p)/t_r` with `t_r = (H − h)/(2 u)`, the free
//! height H − h and the mean speed u in the nozzle. Under a nozzle of steady velocity v the strand touches down at the
//! distance `v t_r` behind it. Threads that swing, coil or buckle are not modelled. A nozzle that moves on while next to
//! no fluid comes, less than a thousandth of the section of the nozzle, draws a thread that breaks: this fluid stays with
//! the strand where it ended, and the next strand begins below the nozzle.

use super::beneath::Beneath;
use super::carriers::Carriers;
use super::cooling::{LAYERS, SHARES};
use super::line::Line;
use super::sections::{CLEARANCE, EDGE, SLACK, SLOW, floor};
use super::{Failure, Segment, Strand};
use crate::inputs::Motion;

/// Number of pieces of a segment, each of which touches down at a place of its own.
const PIECES: f64 = 4.0;
/// Part of the section of a thick segment below which a strand leaves it behind.
const LEAVES: f64 = 0.5;
/// Exponent of the section in the volume of a thick segment, which is as long over its width as one at the limit.
const THICKER: f64 = 1.5;
/// Low gap over the diameter of the nozzle, for the width within which carriers of a new segment are looked for.
const LOW: f64 = 0.3;
/// Difference in height of the segments on which one lies, over their own height.
const LEVEL: f64 = 0.5;
/// Part of the section of the nozzle below which a strand is drawn until it breaks.
const THREAD: f64 = 1e-3;
/// Part of a segment's volume below which fluid belongs to the segment before: the rounding of a path's end.
const SLIVER: f64 = 1e-6;

/// An amount of fluid that reached a segment.
pub struct Arrival {
    pub segment: usize,
    /// [m³]
    pub volume: f64,
    /// Mean time of the arrival [s].
    pub time: f64,
    /// Impulse that it brought [N s].
    pub impulse: [f64; 3],
}

/// A piece of a motion: its beginning and end [s], and the volume that comes [m³].
struct Piece {
    from: f64,
    to: f64,
    volume: f64,
    /// True if it ends at a whole number of pieces of segments.
    is_full: bool,
}

/// Refuses a flow that goes back, and a volume above the largest, after some volume has come [m³].
pub fn guard(motion: &Motion, came: f64, most: f64) -> Result<(), Failure> {
    let flow = motion.least_flow();
    let unseen = SLACK * most / motion.duration;
    if flow < -motion.rounding() - unseen {
        return Err(Failure::NegativeFlow { flow });
    }
    let volume = came + motion.volume(motion.duration);
    match volume > most * (1.0 + SLACK) {
        true => Err(Failure::BeyondMost { volume, most }),
        false => Ok(()),
    }
}

impl Line {
    /// Lays the fluid of a motion; the strand's time is that of its beginning.
    pub(super) fn lay(
        &self,
        strand: &mut Strand,
        motion: &Motion,
    ) -> Result<Vec<Arrival>, Failure> {
        guard(motion, strand.volume, self.plan.most)?;
        let begin = motion.outlet(0.0);
        let comes = motion.volume(motion.duration) > 0.0;
        if !comes || strand.flowing == 0.0 {
            strand.open = 0.0;
            strand.touch = [begin[0], begin[1]];
        } else {
            let jump = [0, 1, 2].map(|axis| begin[axis] - strand.nozzle[axis]);
            let jump = jump.iter().map(|part| part * part).sum::<f64>().sqrt();
            strand.jump = strand.jump.max(jump);
        }
        strand.flowing = if comes { 1.0 } else { 0.0 };
        let mut arrivals = Vec::new();
        if comes {
            let complete = strand.len() - usize::from(strand.open == 1.0);
            let mut beneath = Beneath::of(strand, complete);
            for piece in self.pieces(strand.volume, motion) {
                let way = [piece.from, piece.to].map(|s| motion.outlet(s));
                let temperature = motion.temperature_at(0.5 * (piece.from + piece.to));
                self.check_piece(strand, way[0][2].min(way[1][2]), temperature)?;
                let laid = (&piece, way, temperature);
                arrivals.push(match self.breaks(&piece, way) {
                    true => self.lay_thread((strand, &mut beneath), laid),
                    false => self.lay_piece((strand, &mut beneath), laid),
                });
            }
        }
        strand.nozzle = motion.outlet(motion.duration);
        if !comes {
            strand.touch = [strand.nozzle[0], strand.nozzle[1]];
        }
        strand.time += motion.duration;
        Ok(arrivals)
    }

    /// Cuts a motion where whole pieces of segments have come since time zero.
    fn pieces(&self, before: f64, motion: &Motion) -> Vec<Piece> {
        let size = self.plan.segment_volume() / PIECES;
        let all = motion.volume(motion.duration);
        let (mut pieces, mut from) = (Vec::new(), 0.0);
        let mut number = ((before / size + SLACK).floor() + 1.0).max(1.0);
        while number * size - before < all * (1.0 - SLACK) {
            let to = motion.time_of(number * size - before, from);
            let volume = motion.volume(to) - motion.volume(from);
            pieces.push(Piece { from, to, volume, is_full: true });
            (from, number) = (to, number + 1.0);
        }
        let is_full = (number * size - before - all).abs() <= SLACK * all;
        let volume = all - motion.volume(from);
        pieces.push(Piece { from, to: motion.duration, volume, is_full });
        pieces.retain(|piece| piece.volume > 0.0 && piece.to > piece.from);
        pieces
    }

    /// Returns true if a piece would be drawn to a thread that breaks.
    fn breaks(&self, piece: &Piece, [begin, end]: [[f64; 3]; 2]) -> bool {
        let way = (end[0] - begin[0]).hypot(end[1] - begin[1]);
        piece.volume < THREAD * self.plan.outlet() * way
    }

    /// Leaves the fluid of a broken thread where the strand ended, as if the outlet stood there. The next strand begins
    /// below the outlet.
    fn lay_thread(
        &self,
        (strand, beneath): (&mut Strand, &mut Beneath),
        (piece, way, temperature): (&Piece, [[f64; 3]; 2], f64),
    ) -> Arrival {
        let mut place = way[0];
        let last = strand.segments().next_back();
        if let Some(last) = last {
            place = [last.end[0], last.end[1], last.outlet];
            (strand.touch, strand.open) = (last.end, 1.0);
        }
        let arrival = self.lay_piece((&mut *strand, beneath), (piece, [place; 2], temperature));
        (strand.touch, strand.open) = ([way[1][0], way[1][1]], 0.0);
        Arrival { impulse: self.impulse(piece, way), ..arrival }
    }

    /// Impulse of the fluid of a piece, which leaves a moving outlet [N s].
    fn impulse(&self, piece: &Piece, [begin, end]: [[f64; 3]; 2]) -> [f64; 3] {
        let mass = self.plan.fluid.density * piece.volume;
        let duration = piece.to - piece.from;
        let speed = piece.volume / (duration * self.plan.outlet());
        let velocity = [0, 1, 2].map(|axis| (end[axis] - begin[axis]) / duration);
        [velocity[0], velocity[1], velocity[2] - speed].map(|part| mass * part)
    }

    fn lay_piece(
        &self,
        (strand, beneath): (&mut Strand, &mut Beneath),
        (piece, way, temperature): (&Piece, [[f64; 3]; 2], f64),
    ) -> Arrival {
        let [begin, end] = way;
        let duration = piece.to - piece.from;
        let speed = piece.volume / (duration * self.plan.outlet());
        let swift = (end[0] - begin[0]).hypot(end[1] - begin[1]) / duration;
        let whole = self.plan.segment_volume() * (1.0 - SLACK);
        let before = strand.segments().next_back();
        let is_sliver = |last: &Segment| last.end == strand.touch && piece.volume < SLIVER * whole;
        let last = before.filter(|last| strand.open == 1.0 || is_sliver(last));
        let open = match last {
            Some(last) => last,
            None => self.begun((strand, beneath), way, piece.volume),
        };
        let thickness = self.thickness(strand, swift, speed);
        let free = (end[2] - open.base - thickness).max(0.0);
        let touch = touchdown(strand.touch, way, (duration, 0.5 * free / speed));
        let path = (touch[0] - open.end[0]).hypot(touch[1] - open.end[1]);
        let is_new = last.is_none_or(|last| {
            let leaves = || self.thick().max(LEAVES * self.laid(strand, &last).section());
            self.is_thick(&last) && last.volume >= whole && piece.volume <= leaves() * path
        });
        let mut segment = open;
        if let (true, Some(last)) = (is_new, last) {
            let index = strand.len() - 1;
            let left = self.settled((strand, beneath), [last; 2], (index, last.outlet));
            strand.set(index, &left);
            segment = self.begun((strand, beneath), way, piece.volume);
        }
        let gap = end[2] - floor(strand, &segment);
        let laid_before = self.laid_width(&segment, gap);
        segment.path += path;
        (segment.end, segment.outlet) = (touch, end[2]);
        let middle = strand.time + 0.5 * (piece.from + piece.to);
        let part = piece.volume / (segment.volume + piece.volume);
        segment.born += part * (middle - segment.born);
        let heat = self.heat.content_at(temperature) * self.heat.capacity(piece.volume);
        segment.volume += piece.volume;
        let index = strand.len() - usize::from(!is_new);
        segment.longest = self.longest((strand, index), &segment, gap);
        (0..LAYERS).for_each(|n| segment.heats[n] += SHARES[n] * heat);
        strand.supplied += heat;
        strand.volume += piece.volume;
        strand.touch = touch;
        // What has spread so far stays beyond the width as laid, whichever pieces the fluid came in.
        let laid = self.laid_width(&segment, gap);
        let spread = segment.half_width + 0.5 * (laid - laid_before);
        segment.half_width = spread.max(0.5 * laid);
        let thicker = (segment.volume / (self.thick() * segment.path)).max(1.0).powf(THICKER);
        let is_full = piece.is_full && segment.volume >= whole * thicker;
        let is_complete = is_full && !segment.is_heap();
        strand.open = if is_complete { 0.0 } else { 1.0 };
        if is_new {
            strand.push(&segment);
        }
        if is_complete {
            segment = self.settled((strand, beneath), [segment; 2], (index, end[2]));
        }
        strand.set(index, &segment);
        let impulse = self.impulse(piece, way);
        Arrival { segment: index, volume: piece.volume, time: middle, impulse }
    }

    /// A segment that begins where the strand touches down, as the outlet moves from one place to another and some
    /// fluid comes [m³].
    fn begun(
        &self,
        (strand, beneath): (&Strand, &mut Beneath),
        [from, to]: [[f64; 3]; 2],
        volume: f64,
    ) -> Segment {
        let start = Segment { start: strand.touch, end: strand.touch, ..Segment::default() };
        let way = [0, 1].map(|axis| to[axis] - from[axis]);
        let path = way[0].hypot(way[1]).max(volume / self.thick());
        let over = Segment {
            end: [0, 1].map(|axis| strand.touch[axis] + way[axis]),
            half_width: 0.5 * self.strand_width((volume, path), LOW * self.plan.diameter),
            volume,
            path,
            ..start
        };
        self.settled((strand, beneath), [start, over], (strand.len(), from[2]))
    }

    /// Height at which fluid touches down [m], at the speeds of the nozzle and of the fluid in it: that of a strand as
    /// wide as high; of the segment below a slow nozzle, if that is not so high.
    fn thickness(&self, strand: &Strand, swift: f64, speed: f64) -> f64 {
        let at_limit = (self.plan.outlet() * speed / swift.max(SLOW * speed)).sqrt();
        match strand.segments().next_back() {
            Some(last) if swift < SLOW * speed => {
                let own = (self.plan.outlet() * speed / swift).sqrt();
                own.min(at_limit.max(self.laid(strand, &last).height()))
            }
            _ => at_limit,
        }
    }

    fn check_piece(&self, strand: &Strand, height: f64, temperature: f64) -> Result<(), Failure> {
        let least = self.plan.least_height;
        if height < least {
            return Err(Failure::NozzleInPlate { height, least, when: "while fluid comes" });
        }
        if temperature <= 0.0 {
            return Err(Failure::BelowAbsoluteZero { temperature });
        }
        match strand.open == 0.0 && strand.len() >= self.plan.capacity() {
            true => Err(Failure::Full { segments: strand.len() }),
            false => Ok(()),
        }
    }

    /// Finds on what a segment lies: at the height of the highest of the `older` ones under its middle that the outlet
    /// clears, on all of about this height below it, or on the plate. Neighbours along the strand, closer than its
    /// width, are not below it unless the outlet has risen since. Where none is under the middle, but some are on both
    /// sides, below places of the second of the segments, it lies on these.
    fn settled(
        &self,
        (strand, beneath): (&Strand, &mut Beneath),
        [segment, over]: [Segment; 2],
        (older, outlet): (usize, f64),
    ) -> Segment {
        beneath.extend(strand, older);
        let clearance = CLEARANCE * self.plan.diameter;
        let may_carry = |n: usize| {
            let older = strand.segment(n);
            let is_apart = beneath.apart(n, (strand, segment.start)) > older.width();
            let has_risen = outlet - older.outlet > clearance;
            // A nozzle in the fluid that has risen around it laid that from its own height.
            let clears = outlet - older.top().min(older.outlet) > clearance;
            ((is_apart || has_risen) && clears).then_some((n, older))
        };
        let near = beneath.near(segment.places().chain(over.places())).into_iter();
        let carriers: Vec<(usize, Segment)> = near.filter_map(may_carry).collect();
        let carriers_at = |place: [f64; 2]| {
            let reach = |older: &Segment| older.half_width * (1.0 + EDGE);
            carriers.iter().filter(move |(_, older)| older.distance(place) <= reach(older))
        };
        let top =
            |place: [f64; 2]| carriers_at(place).map(|(_, older)| older.top()).fold(0.0, f64::max);
        let is_level =
            |older: &Segment, base: f64| (older.top() - base).abs() <= LEVEL * older.height();
        let (mut base, mut lower) = (top(segment.middle()), segment);
        if base == 0.0 && !carriers.is_empty() {
            lower = over;
            if segment.volume == 0.0 {
                // As wide as it will be on the highest of them.
                let tops = carriers.iter().map(|(_, older)| older.top().min(older.outlet));
                let gap = outlet - tops.fold(0.0, f64::max);
                lower.half_width = 0.5 * self.strand_width((over.volume, over.path), gap);
            }
            base = level(&lower.places().map(top).collect::<Vec<_>>());
            let under = lower.places().flat_map(carriers_at).map(|(_, older)| older);
            let at_level = under.filter(|older| base > 0.0 && is_level(older, base));
            base = at_level.map(Segment::top).fold(base, f64::max);
        }
        if base == 0.0 {
            return Segment { base, below: Carriers::default(), ..segment };
        }
        // Of several at one place, the one whose centre line is nearest.
        let carrier = |place: [f64; 2]| {
            let away = |older: &Segment| older.distance(place);
            carriers_at(place)
                .filter(|(_, older)| is_level(older, base))
                .min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)))
                .map(|(n, _)| *n)
        };
        Segment { base, below: Carriers::of(lower.places().filter_map(carrier)), ..segment }
    }
}

/// Height on which a lower side rests by the tops under its places [m], which lie opposite each other in the order from
/// both ends: the greatest that is reached on both sides of the middle; 0 if fewer than half of the pairs are carried.
fn level(tops: &[f64]) -> f64 {
    let pairs = tops.len() / 2;
    let opposite = (0..pairs).map(|n| tops[n].min(tops[tops.len() - 1 - n]));
    let carried: Vec<f64> = opposite.filter(|&top| top > 0.0).collect();
    match 2 * carried.len() >= pairs {
        true => carried.into_iter().fold(0.0, f64::max),
        false => 0.0,
    }
}

/// Place of touchdown after a duration in which the outlet moves evenly, with the relaxation time t_r [s].
fn touchdown(
    from: [f64; 2],
    [begin, end]: [[f64; 3]; 2],
    (duration, relaxation): (f64, f64),
) -> [f64; 2] {
    let times = duration / relaxation;
    let decay = (-times).exp();
    // The distance behind the outlet over its way, without the difference of large numbers in slow fluid.
    let behind = if times > 0.0 { (-times).exp_m1() / times } else { -1.0 };
    [0, 1].map(|axis| {
        end[axis] + (from[axis] - begin[axis]) * decay + (end[axis] - begin[axis]) * behind
    })
}
