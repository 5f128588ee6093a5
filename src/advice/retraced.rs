//! Routes that run along what was laid before without rising.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;

use crate::scene::{Leg, Route};

/// Distance of samples of a route, over the diameter of the nozzle.
const APART: f64 = 0.5;
/// Distance of centre lines, over the width of the strand, below which most of one lies in the other.
const ASIDE: f64 = 0.5;
/// Rise, over the diameter of the nozzle, below which the nozzle is as high as before.
const RISE: f64 = 0.1;
/// Length of route between two samples below which they belong to one bend, over the diameter of the nozzle; at least
/// the width of the strand.
const BEND: f64 = 4.0;
/// Cosine of the angle from which on two directions are one: lines that cross are usual in fillings.
const ALONG: f64 = 0.9;
/// Height of the outlet over its diameter that no route is below.
const LOWEST: f64 = 0.01;
/// Section that a nozzle presses at most, over that of its outlet.
const PRESSED: f64 = 4.0;
/// Number of samples in a row that are a line and no dot, and length of route over the width of the strand that is one.
const ROW: usize = 6;
const LINE: f64 = 1.0;
/// Most samples of a route; what comes after them is not examined.
const MOST: usize = 100_000;

/// A nozzle and what comes from it.
#[derive(Debug, Clone, Copy)]
pub struct Laying {
    /// Diameter of the nozzle [m].
    pub diameter: f64,
    /// Flow where the route sets none [m³/s].
    pub flow: f64,
}

/// A place on a route.
struct Sample {
    /// Time [s], and length of the route up to it [m].
    time: f64,
    length: f64,
    place: [f64; 3],
    /// Unit vector of the motion in the plane of the plate.
    direction: [f64; 2],
    /// Width with which the strand is laid on the plate or on a layer as high as the first [m].
    width: f64,
}

/// Times of the first line that a nozzle lays along an earlier one without rising, mostly inside that, and of that one
/// [s].
pub fn retraced(route: &Route, laying: Laying) -> Option<[f64; 2]> {
    let diameter = laying.diameter;
    let samples = samples(route, laying);
    // Squares are as wide as samples may lie apart.
    let widest = samples.iter().map(|sample| sample.width).fold(0.0, f64::max);
    let size = diameter.max(ASIDE * widest + APART * diameter);
    let side = |value: f64| (value / size).floor() as i64;
    let mut squares: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    let (mut row, mut from) = (0, 0.0);
    for (n, sample) in samples.iter().enumerate() {
        let square = [side(sample.place[0]), side(sample.place[1])];
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [square[0] + i, square[1] + j]));
        let near = around.filter_map(|square| squares.get(&square)).flatten();
        let earlier =
            near.map(|&n| &samples[n]).find(|earlier| sample.runs_along(earlier, diameter));
        if row == 0 {
            from = sample.length;
        }
        row = if earlier.is_some() { row + 1 } else { 0 };
        let is_line = row >= ROW && sample.length - from >= LINE * sample.width;
        if let (Some(earlier), true) = (earlier, is_line) {
            return Some([sample.time, earlier.time]);
        }
        squares.entry(square).or_default().push(n);
    }
    None
}

impl Sample {
    /// Returns true if the nozzle moves beside a line of an earlier time, as high as then and so near that most of the
    /// narrower strand lies inside the other.
    fn runs_along(&self, earlier: &Self, diameter: f64) -> bool {
        let [x, y, rise] = [0, 1, 2].map(|axis| self.place[axis] - earlier.place[axis]);
        let [[a, b], [c, d]] = [self.direction, earlier.direction];
        let width = self.width.min(earlier.width);
        let [along, aside] = [(x * c + y * d).abs(), (x * d - y * c).abs()];
        aside < ASIDE * width
            && along <= APART * diameter
            && rise < RISE * diameter
            && self.length - earlier.length > (BEND * diameter).max(width)
            && (a * c + b * d).abs() > ALONG
    }
}

/// Samples of the legs on which fluid may come.
fn samples(route: &Route, laying: Laying) -> Vec<Sample> {
    let apart = APART * laying.diameter;
    let lowest = route.laid().map(|leg| leg.place[0][2]).fold(f64::INFINITY, f64::min);
    let height = lowest.max(LOWEST * laying.diameter);
    let mut samples = Vec::new();
    let mut length = 0.0;
    for leg in route.laid() {
        let [from, to] = [0.0, leg.duration].map(|s| leg.at(s));
        let chord = (to[0] - from[0]).hypot(to[1] - from[1]);
        let count = ((chord / apart).ceil() as usize).min(MOST - samples.len());
        let width = width(leg, chord, laying, height);
        samples.extend((0..count).map(|n| {
            let share = n as f64 / count as f64;
            Sample { width, ..sample(leg, (share, chord), length) }
        }));
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
    Sample { time: leg.start + s, length: length + done, place, direction, width: 0.0 }
}

/// Mean width of the strand of a leg [m]: section over the lowest height of the route, or as wide as high; that of the
/// nozzle where no flow is known. A strand of which more comes than the nozzle presses is no wider for that.
fn width(leg: &Leg, chord: f64, Laying { diameter, flow }: Laying, height: f64) -> f64 {
    let mean = leg.flow.map_or(flow, |[value, slope]| value + 0.5 * slope * leg.duration);
    let section = mean * leg.duration / chord;
    let outlet = FRAC_PI_4 * diameter * diameter;
    match section > 0.0 && section.is_finite() {
        true => section.sqrt().max(section.min(PRESSED * outlet) / height),
        false => diameter,
    }
}
