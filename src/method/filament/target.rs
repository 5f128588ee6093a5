//! Distance of a strand's centre line from a line that is wanted.

use super::Segment;
use super::segment::distance_from_line;

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

    /// Distance of a place from the line [m].
    pub fn distance(&self, place: [f64; 2]) -> f64 {
        self.parts().map(|part| distance_from_line(place, part)).fold(f64::INFINITY, f64::min)
    }

    /// Compares the segments of a strand with the line.
    pub fn deviation(&self, segments: &[Segment]) -> Deviation {
        let (mut sum, mut all, mut largest) = (0.0, 0.0, 0.0_f64);
        for segment in segments {
            for (part, weight) in SIMPSON {
                let place = [0, 1].map(|axis| {
                    segment.start[axis] + part * (segment.end[axis] - segment.start[axis])
                });
                let distance = self.distance(place);
                // Heaps without a path count at their place.
                sum += weight * segment.length() * distance;
                largest = largest.max(distance);
            }
            all += segment.length();
        }
        let mean = if all > 0.0 { sum / all } else { 0.0 };
        Deviation { mean, largest, gap: self.gap(segments) }
    }

    fn gap(&self, segments: &[Segment]) -> f64 {
        let of_part = |part: [[f64; 2]; 2]| {
            let covered = segments.iter().filter_map(|segment| covered_by(segment, part));
            let mut covered: Vec<_> = covered.collect();
            covered.sort_by(|one, other| one[0].total_cmp(&other[0]));
            let (mut bare, mut end) = (0.0, 0.0_f64);
            for [from, to] in covered {
                bare += (from - end).max(0.0);
                end = end.max(to);
            }
            bare + (length(part) - end).max(0.0)
        };
        self.parts().map(of_part).sum()
    }
}

fn length([a, b]: [[f64; 2]; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Interval of a straight line that lies within the half-width of a segment's centre line, in distances from its
/// beginning [m]: a rectangle with round ends is convex.
fn covered_by(segment: &Segment, part: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let ([start, end], whole) = (part, length(part));
    let along = [0, 1].map(|axis| (end[axis] - start[axis]) / whole);
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let from = |place: [f64; 2]| [0, 1].map(|axis| start[axis] - place[axis]);
    let reach = segment.half_width;
    let of_end = |place: [f64; 2]| {
        let apart = from(place);
        let nearest = -dot(apart, along);
        let square = reach * reach - dot(apart, apart) + nearest * nearest;
        (square >= 0.0).then(|| [nearest - square.sqrt(), nearest + square.sqrt()])
    };
    let axis = segment.direction();
    let apart = from(segment.start);
    let core = length([segment.start, segment.end]);
    let sides = [(axis, [0.0, core]), ([-axis[1], axis[0]], [-reach, reach])];
    let of_core = sides.into_iter().try_fold([0.0, whole], |[low, high], (axis, bounds)| {
        let (place, rate) = (dot(apart, axis), dot(along, axis));
        if rate == 0.0 {
            return (bounds[0] <= place && place <= bounds[1]).then_some([low, high]);
        }
        let [first, last] = bounds.map(|bound| (bound - place) / rate);
        let cut = [low.max(first.min(last)), high.min(first.max(last))];
        (cut[0] <= cut[1]).then_some(cut)
    });
    let all = [of_end(segment.start), of_end(segment.end), of_core];
    let all = all.into_iter().flatten();
    let union = all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    let [low, high] = [union[0].max(0.0), union[1].min(whole)];
    (low < high).then_some([low, high])
}
