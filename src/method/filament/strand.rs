//! The state of a filament.

use std::slice::from_mut;

use super::Segment;
use super::carriers::{Carriers, MOST_CARRIERS};
use super::cooling::LAYERS;
use crate::state::{Field, Fields, Layout, Per};

/// A strand, with the sums over the run and the exchange of the last step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strand {
    /// [s]
    pub time: f64,
    /// Volume that has come [m³].
    pub volume: f64,
    /// Heat content of all fluid as it came [J].
    pub supplied: f64,
    /// Heat that has passed to the plate and to the air [J].
    pub given: f64,
    pub lost: f64,
    /// Impulse that has passed to the plate and, beyond its edge, to what would be there [N s].
    pub impulse: [f64; 3],
    /// Place of the nozzle's outlet, and that at which the strand touches down [m].
    pub nozzle: [f64; 3],
    pub touch: [f64; 2],
    /// Largest jump of the nozzle while fluid came [m].
    pub jump: f64,
    /// 1 while fluid comes, 0 otherwise.
    pub flowing: f64,
    /// 1 if the last segment is still growing, 0 otherwise.
    pub open: f64,
    /// 1 if the nozzle has approached a place that an input set without derivatives, 0 otherwise.
    pub late: f64,
    /// Exchange with the cells of the plate in the last step: its duration [s], heat [J] and impulse [N s].
    pub duration: f64,
    pub cell_heat: Vec<f64>,
    pub cell_impulse: Vec<[f64; 3]>,
    start: Vec<[f64; 2]>,
    end: Vec<[f64; 2]>,
    base: Vec<f64>,
    volumes: Vec<f64>,
    heats: Vec<[f64; LAYERS]>,
    half_width: Vec<f64>,
    born: Vec<f64>,
    path: Vec<f64>,
    outlet: Vec<f64>,
    /// Largest length of heaps; 0 for strands [m].
    longest: Vec<f64>,
    /// Numbers of the segments below, from 1, and their shares; 0 where there is none.
    below: Vec<[f64; MOST_CARRIERS]>,
    share: Vec<[f64; MOST_CARRIERS]>,
}

impl Strand {
    /// A strand before time starts, above a number of cells.
    pub fn new(cells: usize, nozzle: [f64; 3]) -> Self {
        Self {
            nozzle,
            touch: [nozzle[0], nozzle[1]],
            cell_heat: vec![0.0; cells],
            cell_impulse: vec![[0.0; 3]; cells],
            ..Self::default()
        }
    }

    /// Numbers of a segment in the state.
    pub const PER_SEGMENT: usize = 2 + 2 + 1 + 1 + LAYERS + 5 + 2 * MOST_CARRIERS;

    /// An empty strand with room for the segments of a state of this length; `None` if no strand above the same cells
    /// has it.
    pub fn of_length(&self, numbers: usize) -> Option<Self> {
        let own = Self { duration: 0.0, ..Self::new(self.cell_heat.len(), self.nozzle) };
        let fixed = Layout::of(&mut own.clone()).len();
        let rest = numbers.checked_sub(fixed)?;
        let count = rest / Self::PER_SEGMENT;
        (rest % Self::PER_SEGMENT == 0).then(|| own.with_room(count))
    }

    fn with_room(self, count: usize) -> Self {
        let numbers = vec![0.0; count];
        Self {
            start: vec![[0.0; 2]; count],
            end: vec![[0.0; 2]; count],
            base: numbers.clone(),
            volumes: numbers.clone(),
            heats: vec![[0.0; LAYERS]; count],
            half_width: numbers.clone(),
            born: numbers.clone(),
            path: numbers.clone(),
            outlet: numbers.clone(),
            longest: numbers,
            below: vec![[0.0; MOST_CARRIERS]; count],
            share: vec![[0.0; MOST_CARRIERS]; count],
            ..self
        }
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.volumes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.volumes.is_empty()
    }

    pub fn segment(&self, n: usize) -> Segment {
        let segments = self.below[n].map(|number| (number as usize).saturating_sub(1));
        Segment {
            start: self.start[n],
            end: self.end[n],
            base: self.base[n],
            volume: self.volumes[n],
            heats: self.heats[n],
            half_width: self.half_width[n],
            born: self.born[n],
            path: self.path[n],
            outlet: self.outlet[n],
            longest: self.longest[n],
            below: Carriers { segments, shares: self.share[n] },
        }
    }

    /// Height of the outlet above the plate as the last fluid of a segment came [m].
    pub fn outlet_of(&self, n: usize) -> f64 {
        self.outlet[n]
    }

    /// Adds a segment at the end.
    pub fn push(&mut self, segment: &Segment) {
        self.start.push(segment.start);
        self.end.push(segment.end);
        self.heats.push(segment.heats);
        self.below.push([0.0; MOST_CARRIERS]);
        self.share.push([0.0; MOST_CARRIERS]);
        let numbers = [
            &mut self.base,
            &mut self.volumes,
            &mut self.half_width,
            &mut self.born,
            &mut self.path,
            &mut self.outlet,
            &mut self.longest,
        ];
        numbers.into_iter().for_each(|list| list.push(0.0));
        self.set(self.len() - 1, segment);
    }

    pub fn set(&mut self, n: usize, segment: &Segment) {
        self.start[n] = segment.start;
        self.end[n] = segment.end;
        self.base[n] = segment.base;
        self.volumes[n] = segment.volume;
        self.heats[n] = segment.heats;
        self.half_width[n] = segment.half_width;
        self.born[n] = segment.born;
        self.path[n] = segment.path;
        self.outlet[n] = segment.outlet;
        self.longest[n] = segment.longest;
        let Carriers { segments, shares } = segment.below;
        self.below[n] =
            std::array::from_fn(|k| if shares[k] > 0.0 { (segments[k] + 1) as f64 } else { 0.0 });
        self.share[n] = shares;
    }

    pub fn segments(&self) -> impl DoubleEndedIterator<Item = Segment> + ExactSizeIterator + '_ {
        (0..self.len()).map(|n| self.segment(n))
    }

    /// Refuses numbers that no run produces, with the reason.
    pub fn check(&self) -> Result<(), String> {
        let is_flag = |value: f64| value == 0.0 || value == 1.0;
        if ![self.flowing, self.open, self.late].into_iter().all(is_flag) {
            return Err("a flag of the strand is neither 0 nor 1".to_owned());
        }
        if self.open == 1.0 && self.is_empty() {
            return Err("a segment grows, but there is none".to_owned());
        }
        let sums = [self.time, self.volume, self.duration, self.jump];
        if sums.iter().any(|&sum| sum < 0.0 || !sum.is_finite()) {
            return Err("time, volume, duration and jump are not negative".to_owned());
        }
        (0..self.len()).try_for_each(|n| self.check_segment(n))
    }

    fn check_segment(&self, n: usize) -> Result<(), String> {
        let segment = self.segment(n);
        let carriers = self.below[n].into_iter().zip(self.share[n]);
        for (number, share) in carriers {
            let is_older = (0.0..=n as f64).contains(&number) && number.fract() == 0.0;
            let is_carrier = (0.0..=1.0).contains(&share) && (number > 0.0) == (share > 0.0);
            if !(is_older && is_carrier) {
                return Err(format!("segment {n} lies on number {number} by a share of {share}"));
            }
        }
        let all: f64 = self.share[n].iter().sum();
        if all != 0.0 && (all - 1.0).abs() > 1e-9 {
            return Err(format!("segment {n} lies on others by {all} of its lower side"));
        }
        if !(segment.volume > 0.0 && segment.half_width > 0.0) {
            return Err(format!("segment {n} has no volume or no width"));
        }
        if segment.longest < 0.0 || segment.path == 0.0 && !segment.is_heap() {
            return Err(format!("segment {n} has no length"));
        }
        let born = 0.0 <= segment.born && segment.born <= self.time;
        if !(born && segment.path >= 0.0 && segment.base >= 0.0 && segment.outlet >= 0.0) {
            return Err(format!("segment {n} has a time, a length or a height out of bounds"));
        }
        Ok(())
    }
}

impl Fields for Strand {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per, width| Field { name, words, per, width };
        let body = |name, words| of(name, words, Per::Body, 1);
        let cell = |name, words, width| of(name, words, Per::Cell, width);
        let segment = |name, words, width| of(name, words, Per::Segment, width);
        vec![
            (body("time", "time since the start [s]"), from_mut(&mut self.time)),
            (body("volume", "volume that has come [m³]"), from_mut(&mut self.volume)),
            (
                body("supplied", "heat content of the fluid as it came [J]"),
                from_mut(&mut self.supplied),
            ),
            (body("given", "heat passed to the plate [J]"), from_mut(&mut self.given)),
            (body("lost", "heat passed to the air [J]"), from_mut(&mut self.lost)),
            (of("impulse", "impulse passed to the plate [N s]", Per::Body, 3), &mut self.impulse),
            (of("nozzle", "place of the outlet [m]", Per::Body, 3), &mut self.nozzle),
            (of("touch", "place of touchdown [m]", Per::Body, 2), &mut self.touch),
            (body("jump", "largest jump of the nozzle [m]"), from_mut(&mut self.jump)),
            (body("flowing", "1 while fluid comes"), from_mut(&mut self.flowing)),
            (body("open", "1 if the last segment grows"), from_mut(&mut self.open)),
            (body("late", "1 if an input moved the nozzle evenly"), from_mut(&mut self.late)),
            (body("duration", "duration of the last exchange [s]"), from_mut(&mut self.duration)),
            (cell("cell_heat", "heat to cells of the plate [J]", 1), &mut self.cell_heat),
            (
                cell("cell_impulse", "impulse to cells of the plate [N s]", 3),
                self.cell_impulse.as_flattened_mut(),
            ),
            (segment("start", "start of the centre line [m]", 2), self.start.as_flattened_mut()),
            (segment("end", "end of the centre line [m]", 2), self.end.as_flattened_mut()),
            (segment("base", "height of the plane below [m]", 1), &mut self.base),
            (segment("segment_volume", "volume [m³]", 1), &mut self.volumes),
            (
                segment("heat", "heat contents of the layers [J]", LAYERS),
                self.heats.as_flattened_mut(),
            ),
            (segment("half_width", "half of the width [m]", 1), &mut self.half_width),
            (segment("born", "mean time at which its fluid came [s]", 1), &mut self.born),
            (segment("path", "length of the path [m]", 1), &mut self.path),
            (
                segment("outlet", "height of the outlet as its last fluid came [m]", 1),
                &mut self.outlet,
            ),
            (
                segment("longest", "largest length of heaps; 0 for strands [m]", 1),
                &mut self.longest,
            ),
            (
                segment("below", "numbers of the segments below, from 1; 0: none", MOST_CARRIERS),
                self.below.as_flattened_mut(),
            ),
            (
                segment("share", "shares of the lower side on these [1]", MOST_CARRIERS),
                self.share.as_flattened_mut(),
            ),
        ]
    }
}
