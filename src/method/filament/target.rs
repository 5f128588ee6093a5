//! Distance of a strand's centre line from a line that is wanted.

use super::segment::distance_from_line;
use super::{Segment, Strand};

/// A line of straight parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    places: Vec<[f64; 2]>,
}

/// How far a strand is from its target.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation {
    /// Mean distance of the centre line from the target, over its length, and the largest one [m].
    pub mean: f64,
    pub largest: f64,
    /// Length of the target that no segment covers [m].
    pub gap: f64,
}

/// Weights of Simpson's rule at the beginning, in the middle and at the end of a segment.
const SIMPSON: [(f64, f64); 3] = [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)];

impl Target {
    pub fn new(places: Vec<[f64; 2]>) -> Self {
        Self { places }
    }

    fn parts(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.places.windows(2).map(|ends| [ends[0], ends[1]])
    }

    pub fn length(&self) -> f64 {
        self.parts().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1])).sum()
    }

    /// Distance of a place from the line [m].
    pub fn distance(&self, place: [f64; 2]) -> f64 {
        self.parts().map(|part| distance_from_line(place, part)).fold(f64::INFINITY, f64::min)
    }

    /// Compares a strand with the line; the gap is measured at places no further apart than a distance [m].
    pub fn deviation(&self, strand: &Strand, apart: f64) -> Deviation {
        let (mut sum, mut length, mut largest) = (0.0, 0.0, 0.0_f64);
        for segment in strand.segments() {
            for (part, weight) in SIMPSON {
                let place = [0, 1].map(|axis| {
                    segment.start[axis] + part * (segment.end[axis] - segment.start[axis])
                });
                let distance = self.distance(place);
                // Heaps without a path count at their place.
                sum += weight * segment.length() * distance;
                largest = largest.max(distance);
            }
            length += segment.length();
        }
        let mean = if length > 0.0 { sum / length } else { 0.0 };
        Deviation { mean, largest, gap: self.gap(strand, apart) }
    }

    fn gap(&self, strand: &Strand, apart: f64) -> f64 {
        let segments: Vec<Segment> = strand.segments().collect();
        let covers = |place: [f64; 2]| {
            let is_under = |segment: &Segment| segment.distance(place) <= segment.half_width;
            segments.iter().any(is_under)
        };
        let of_part = |[a, b]: [[f64; 2]; 2]| {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let count = (length / apart).ceil().max(1.0);
            let place = |n: usize| {
                [0, 1].map(|axis| a[axis] + (n as f64 + 0.5) / count * (b[axis] - a[axis]))
            };
            let bare = (0..count as usize).filter(|&n| !covers(place(n))).count();
            bare as f64 / count * length
        };
        self.parts().map(of_part).sum()
    }
}
