//! Routes that run along what was laid before without rising.

use std::collections::HashMap;

use crate::scene::{Leg, Route};

/// Distance of samples of a route, over the diameter of the nozzle.
const APART: f64 = 0.5;
/// Horizontal distance, and rise, below which the nozzle is where it was, over its diameter.
const ASIDE: f64 = 0.25;
const RISE: f64 = 0.1;
/// Length of route between two samples below which they belong to one bend, over the diameter of the nozzle.
const BEND: f64 = 4.0;
/// Cosine of the angle from which on two directions are one: lines that cross are usual in fillings.
const ALONG: f64 = 0.9;
/// Number of samples in a row that are a line and no dot.
const ROW: usize = 6;
/// Most samples of a route; what comes after them is not examined.
const MOST: usize = 100_000;

/// A place on a route.
struct Sample {
    /// Time [s], and length of the route up to it [m].
    time: f64,
    length: f64,
    place: [f64; 3],
    /// Unit vector of the motion in the plane of the plate.
    direction: [f64; 2],
}

/// Times of the first line that a nozzle of this diameter lays along an earlier one without rising, and of that one
/// [s].
pub fn retraced(route: &Route, diameter: f64) -> Option<[f64; 2]> {
    let samples = samples(route, APART * diameter);
    let side = |value: f64| (value / diameter).floor() as i64;
    let mut squares: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    let mut row = 0;
    for (n, sample) in samples.iter().enumerate() {
        let square = [side(sample.place[0]), side(sample.place[1])];
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [square[0] + i, square[1] + j]));
        let near = around.filter_map(|square| squares.get(&square)).flatten();
        let earlier =
            near.map(|&n| &samples[n]).find(|earlier| sample.runs_along(earlier, diameter));
        row = if earlier.is_some() { row + 1 } else { 0 };
        if let (Some(earlier), ROW) = (earlier, row) {
            return Some([sample.time, earlier.time]);
        }
        squares.entry(square).or_default().push(n);
    }
    None
}

impl Sample {
    /// Returns true if the nozzle moves where it was at an earlier time, as high and along the same line.
    fn runs_along(&self, earlier: &Self, diameter: f64) -> bool {
        let [x, y, rise] = [0, 1, 2].map(|axis| self.place[axis] - earlier.place[axis]);
        let [[a, b], [c, d]] = [self.direction, earlier.direction];
        x.hypot(y) < ASIDE * diameter
            && rise < RISE * diameter
            && self.length - earlier.length > BEND * diameter
            && (a * c + b * d).abs() > ALONG
    }
}

/// Samples of the legs on which fluid may come.
fn samples(route: &Route, apart: f64) -> Vec<Sample> {
    let mut samples = Vec::new();
    let mut length = 0.0;
    for leg in route.laid() {
        let [from, to] = [0.0, leg.duration].map(|s| leg.at(s));
        let chord = (to[0] - from[0]).hypot(to[1] - from[1]);
        let count = ((chord / apart).ceil() as usize).min(MOST - samples.len());
        samples.extend((0..count).map(|n| sample(leg, (n as f64 / count as f64, chord), length)));
        length += chord;
        if samples.len() == MOST {
            break;
        }
    }
    samples
}

/// The sample at a share of the duration of a leg that starts after some length of the route.
fn sample(leg: &Leg, (share, chord): (f64, f64), length: f64) -> Sample {
    let s = share * leg.duration;
    let [from, to] = [0.0, leg.duration].map(|s| leg.at(s));
    let place = leg.at(s);
    let done = (place[0] - from[0]).hypot(place[1] - from[1]);
    let direction = [0, 1].map(|axis| (to[axis] - from[axis]) / chord);
    Sample { time: leg.start + s, length: length + done, place, direction }
}
