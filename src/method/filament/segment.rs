//! A segment of a strand.

use super::carriers::Carriers;
use super::cooling::LAYERS;

/// Numbers of places along a segment and across it, odd.
const PLACES: [usize; 2] = [9, 9];

/// A piece of the strand between two places of its centre line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Segment {
    /// Ends of its centre line [m].
    pub start: [f64; 2],
    pub end: [f64; 2],
    /// Height of the plane on which it lies [m].
    pub base: f64,
    /// [m³]
    pub volume: f64,
    /// Heat contents of its layers above the reference temperature, from below [J].
    pub heats: [f64; LAYERS],
    /// Half of its mean width [m].
    pub half_width: f64,
    /// Mean time at which its fluid came [s].
    pub born: f64,
    /// Length of its path [m].
    pub path: f64,
    /// Height of the outlet above the plate as its last fluid came [m].
    pub outlet: f64,
    /// Largest length of a heap, which the nozzle piles up while it hardly moves; 0 for a strand [m].
    pub longest: f64,
    /// The segments on which it lies; none on the plate.
    pub below: Carriers,
}

impl Segment {
    /// Heat content [J].
    pub fn heat(&self) -> f64 {
        self.heats.iter().sum()
    }

    pub fn width(&self) -> f64 {
        2.0 * self.half_width
    }

    /// Returns true for a heap.
    pub fn is_heap(&self) -> bool {
        self.longest > 0.0
    }

    /// Length along the strand: that of the path; a heap is as long as wide up to its largest length [m].
    pub fn length(&self) -> f64 {
        self.stretched(self.path, self.width())
    }

    /// A length of the centre line [m], or that of a heap of some width [m].
    pub fn stretched(&self, length: f64, width: f64) -> f64 {
        length.max(width.min(self.longest))
    }

    /// Section A: volume over length [m²].
    pub fn section(&self) -> f64 {
        self.volume / self.length()
    }

    /// Mean height: section over width [m].
    pub fn height(&self) -> f64 {
        self.section() / self.width()
    }

    /// Height of its upper side above the plate [m].
    pub fn top(&self) -> f64 {
        self.base + self.height()
    }

    /// Area of its lower side [m²].
    pub fn area(&self) -> f64 {
        self.length() * self.width()
    }

    pub fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| 0.5 * (self.start[axis] + self.end[axis]))
    }

    /// Unit vector from its start to its end; along x for a heap.
    pub fn direction(&self) -> [f64; 2] {
        let along = [0, 1].map(|axis| self.end[axis] - self.start[axis]);
        let length = along[0].hypot(along[1]);
        if length > 0.0 { along.map(|part| part / length) } else { [1.0, 0.0] }
    }

    /// Places spread evenly over its lower side, its middle among them.
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let chord = (self.end[0] - self.start[0]).hypot(self.end[1] - self.start[1]);
        let (middle, along, width) = (self.middle(), self.direction(), self.width());
        let length = self.stretched(chord, width);
        let part = |n: usize, count: usize| (n as f64 + 0.5) / count as f64 - 0.5;
        (0..PLACES[0] * PLACES[1]).map(move |n| {
            let s = length * part(n % PLACES[0], PLACES[0]);
            let t = width * part(n / PLACES[0], PLACES[1]);
            [middle[0] + s * along[0] - t * along[1], middle[1] + s * along[1] + t * along[0]]
        })
    }

    /// Distance of a place from its centre line [m].
    pub fn distance(&self, place: [f64; 2]) -> f64 {
        distance_from_line(place, [self.start, self.end])
    }
}

/// Distance of a place from a straight line between two ends [m].
pub fn distance_from_line(place: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let from = [place[0] - a[0], place[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let part = if square > 0.0 {
        ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from[0] - part * along[0]).hypot(from[1] - part * along[1])
}
