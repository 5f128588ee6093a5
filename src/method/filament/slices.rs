//! A strand of particles as segments.
//!
//! Layers that came one after the other make a slice, as long as a segment of a line is. The centre line of the strand
//! goes through the centroids of slices; ends of segments lie midway between them. Each particle belongs to the nearest
//! of the segments around its own slice. A segment has the volume of its particles, and is as wide as these reach
//! across it, with half of their distance on either side. Where the flow stopped and the nozzle went on, layers that came
//! one after the other lie far apart: there one centre line ends and another begins.
//!
//! Fluid is laid where it moves at less than half the speed at which it comes. The newest layer that is laid touches
//! down, with a place between layers by their speeds.

use std::ops::Range;

use super::segment::distance_from_line;
use super::{LineTotals, Segment};
use crate::math::segments::distance;
use crate::method::sph::Laid;

/// Lengths of a strand of particles [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slicing {
    /// Length of a segment where the strand is as thick as the nozzle.
    pub segment: f64,
    /// Thickness of a layer in the nozzle, the distance of particles.
    pub layer: f64,
}

/// The segments of a strand, and the place at which it touches down [m].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sliced {
    pub segments: Vec<Segment>,
    pub touch: [f64; 2],
}

/// Part of the speed at which fluid comes below which it is laid.
const LAID: f64 = 0.5;
/// Distance between layers that came one after the other, over the length of a segment, from which on they belong to
/// strands of their own.
const APART: f64 = 2.0;
/// Number of segments before and after that of its slice among which a particle has its nearest.
const AROUND: usize = 4;

/// Particles that came together, or one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Part {
    volume: f64,
    /// Means over the volume: place along the plate [m], speed [m/s].
    middle: [f64; 2],
    speed: f64,
    /// Distance of the farthest particle of a layer from its middle [m].
    reach: f64,
}

/// The segment of a layer, and all segments of its strand. Layers that the nozzle has torn belong to both strands beside
/// them.
struct Home {
    own: usize,
    strand: Range<usize>,
}

impl Sliced {
    pub fn of(laid: &Laid, slicing: Slicing) -> Self {
        let nozzle = [laid.fed.nozzle[0], laid.fed.nozzle[1]];
        let layers = layers(laid);
        let apart = APART * slicing.segment;
        let (count, touch) = match laid.fed.flowing == 1.0 {
            true => touchdown(&layers, laid, nozzle, apart),
            false => (layers.len(), nozzle),
        };
        let per_slice = (slicing.segment / slicing.layer).round().max(1.0) as usize;
        let (mut segments, mut homes) = (Vec::new(), Vec::new());
        for strand in layers[..count].chunk_by(|a, b| distance(a.middle, b.middle) <= apart) {
            let first = segments.len();
            if strand.len() < count && strand.iter().all(|layer| layer.reach > apart) {
                homes.extend(strand.iter().map(|_| Home { own: first, strand: 0..usize::MAX }));
                continue;
            }
            let slices: Vec<Part> = strand.chunks(per_slice).map(joined).collect();
            segments.extend(centre_line(&slices));
            let home =
                |n: usize| Home { own: first + n / per_slice, strand: first..segments.len() };
            homes.extend((0..strand.len()).map(home));
        }
        measure(&mut segments, laid, &homes, slicing.layer);
        Self { segments, touch }
    }

    /// Sums over the segments; heat and temperatures are those of a strand without any.
    pub fn totals(&self, nozzle: [f64; 3]) -> LineTotals {
        let sum = |of: fn(&Segment) -> f64| self.segments.iter().map(of).sum::<f64>();
        let (length, area, volume) =
            (sum(|own| own.path), sum(|own| own.area()), sum(|own| own.volume));
        let part = |whole: f64, of: f64| if of > 0.0 { whole / of } else { 0.0 };
        let last = self.segments.last();
        LineTotals {
            length,
            width: part(area, length),
            height: part(volume, area),
            last_width: last.map_or(0.0, Segment::width),
            last_height: last.map_or(0.0, |own| part(own.volume, own.area())),
            lag: distance([nozzle[0], nozzle[1]], self.touch),
            volume,
            ..LineTotals::default()
        }
    }
}

/// Layers of the fluid that has left the nozzle, in the order of their coming.
fn layers(laid: &Laid) -> Vec<Part> {
    let count = laid.layer.iter().max().map_or(0, |last| last + 1);
    let mut layers = vec![Part::default(); count];
    for (i, &layer) in laid.layer.iter().enumerate() {
        let (part, volume) = (&mut layers[layer], laid.volume[i]);
        let speed = laid.velocity[i].iter().map(|v| v * v).sum::<f64>().sqrt();
        part.volume += volume;
        (0..2).for_each(|a| part.middle[a] += volume * laid.position[i][a]);
        part.speed += volume * speed;
    }
    for part in &mut layers {
        part.middle = part.middle.map(|x| x / part.volume);
        part.speed /= part.volume;
    }
    for (i, &layer) in laid.layer.iter().enumerate() {
        let [x, y, _] = laid.position[i];
        let part = &mut layers[layer];
        part.reach = part.reach.max(distance(part.middle, [x, y]));
    }
    layers
}

fn joined(parts: &[Part]) -> Part {
    let volume: f64 = parts.iter().map(|part| part.volume).sum();
    let mean = |of: &dyn Fn(&Part) -> f64| {
        parts.iter().map(|part| part.volume * of(part)).sum::<f64>() / volume
    };
    Part {
        volume,
        middle: [mean(&|part| part.middle[0]), mean(&|part| part.middle[1])],
        speed: mean(&|part| part.speed),
        reach: 0.0,
    }
}

/// Number of laid layers, and the place of touchdown [m]; that of a strand which has just begun, `apart` from the last
/// one, is below the nozzle.
fn touchdown(layers: &[Part], laid: &Laid, nozzle: [f64; 2], apart: f64) -> (usize, [f64; 2]) {
    let limit = LAID * laid.drive.iter().map(|v| v * v).sum::<f64>().sqrt();
    let Some(last) = layers.iter().rposition(|part| part.speed < limit) else {
        return (0, nozzle);
    };
    let Some(next) = layers.get(last + 1) else { return (last + 1, layers[last].middle) };
    if distance(next.middle, layers[last].middle) > apart {
        return (last + 1, nozzle);
    }
    let share = (limit - layers[last].speed) / (next.speed - layers[last].speed);
    let place =
        |a: usize| layers[last].middle[a] + share * (next.middle[a] - layers[last].middle[a]);
    (last + 1, [place(0), place(1)])
}

/// Segments about the centroids of slices.
fn centre_line(slices: &[Part]) -> Vec<Segment> {
    let places: Vec<[f64; 2]> = slices.iter().map(|part| part.middle).collect();
    let between = |a: [f64; 2], b: [f64; 2], share: f64| {
        [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
    };
    let segment = |n: usize| {
        let own = places[n];
        let ends = match (n.checked_sub(1), places.get(n + 1)) {
            (Some(before), Some(&after)) => {
                [between(places[before], own, 0.5), between(own, after, 0.5)]
            }
            (None, Some(&after)) => [between(own, after, -0.5), between(own, after, 0.5)],
            (Some(before), None) => {
                [between(places[before], own, 0.5), between(places[before], own, 1.5)]
            }
            (None, None) => [own, own],
        };
        let path = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
        Segment { start: ends[0], end: ends[1], path, ..Segment::default() }
    };
    (0..places.len()).map(segment).collect()
}

/// Gives segments the volume and the width of their particles, which are at a `distance` from each other [m].
fn measure(segments: &mut [Segment], laid: &Laid, homes: &[Home], distance: f64) {
    let mut reach = vec![[f64::INFINITY, f64::NEG_INFINITY]; segments.len()];
    for i in (0..laid.layer.len()).filter(|&i| laid.layer[i] < homes.len()) {
        let [x, y, _] = laid.position[i];
        let Home { own, strand } = &homes[laid.layer[i]];
        let first = own.saturating_sub(AROUND).max(strand.start);
        let around = first..(own + AROUND + 1).min(strand.end).min(segments.len());
        let away = |n: &usize| distance_from_line([x, y], [segments[*n].start, segments[*n].end]);
        let nearest = around.min_by(|a, b| away(a).total_cmp(&away(b)));
        let Some(n) = nearest else { continue };
        let [along_x, along_y] = segments[n].direction();
        let [from_x, from_y] = [x - segments[n].start[0], y - segments[n].start[1]];
        let across = along_x * from_y - along_y * from_x;
        reach[n] = [reach[n][0].min(across), reach[n][1].max(across)];
        segments[n].volume += laid.volume[i];
    }
    for (segment, [low, high]) in segments.iter_mut().zip(reach) {
        segment.half_width = 0.5 * ((high - low).max(0.0) + distance);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar of particles along a line at an angle: length, width and section are its own to half a distance of
    /// particles.
    #[test]
    fn bars_have_their_width_and_section() {
        let (distance, per_layer) = (0.1, 8);
        let along = [0.8, 0.6];
        let mut laid = Laid::default();
        for layer in 0..60 {
            for k in 0..per_layer {
                let (s, t) = (distance * f64::from(layer), distance * (f64::from(k) - 3.5));
                laid.position.push([
                    along[0] * s - along[1] * t,
                    along[1] * s + along[0] * t,
                    0.05,
                ]);
                laid.velocity.push([0.0; 3]);
                laid.volume.push(distance.powi(3));
                laid.layer.push(layer as usize);
            }
        }
        let sliced = Sliced::of(&laid, Slicing { segment: 0.5, layer: distance });
        let totals = sliced.totals([4.8, 3.6, 1.0]);
        assert!((totals.length - 6.0).abs() < 1e-9, "{totals:?}");
        assert!((totals.width - 0.8).abs() < 1e-9 && (totals.height - 0.1).abs() < 1e-9);
        assert!((totals.volume - 0.48).abs() < 1e-12 && sliced.segments.len() == 12);
    }

    /// Two bars that came one after the other, far apart, are two strands: nothing lies between them, and one that has
    /// just begun touches down below the nozzle.
    #[test]
    fn strands_end_where_the_nozzle_went_on_without_flow() {
        let bar = |laid: &mut Laid, from: f64, first: usize, speed: f64| {
            for layer in 0..20 {
                for k in 0..4 {
                    laid.position.push([from + 0.1 * layer as f64, 0.1 * f64::from(k), 0.05]);
                    laid.velocity.push([speed, 0.0, 0.0]);
                    laid.volume.push(1e-3);
                    laid.layer.push(first + layer);
                }
            }
        };
        let mut laid = Laid { drive: [0.0, 0.0, -1.0], ..Laid::default() };
        bar(&mut laid, 0.0, 0, 0.0);
        for (at, layer) in [(1.95, 20), (10.0, 20)] {
            laid.position.push([at, 0.0, 0.05]);
            laid.velocity.push([0.0; 3]);
            laid.volume.push(1e-3);
            laid.layer.push(layer);
        }
        bar(&mut laid, 10.0, 21, 0.0);
        let slicing = Slicing { segment: 0.5, layer: 0.1 };
        let sliced = Sliced::of(&laid, slicing);
        let totals = sliced.totals([12.0, 0.0, 1.0]);
        assert!(
            (totals.length - 4.0).abs() < 1e-9 && (totals.width - 0.4).abs() < 1e-9,
            "{totals:?}"
        );
        assert!(sliced.segments.iter().all(|own| own.end[0] < 2.0 || own.start[0] > 9.9));
        laid.velocity[82..].fill([0.9, 0.0, 0.0]);
        (laid.fed.flowing, laid.fed.nozzle) = (1.0, [12.0, 0.0, 1.0]);
        let begun = Sliced::of(&laid, slicing);
        assert!(begun.touch == [12.0, 0.0] && begun.segments.len() == 4, "{begun:?}");
    }

    /// The strand touches down where half of its speed is left, and only what lies behind is laid.
    #[test]
    fn fluid_that_moves_is_not_laid() {
        let mut laid = Laid { drive: [0.0, 0.0, -1.0], ..Laid::default() };
        laid.fed.flowing = 1.0;
        for (layer, speed) in [0.0, 0.0, 0.0, 0.4, 0.8, 1.0].into_iter().enumerate() {
            laid.position.push([layer as f64, 0.0, 0.0]);
            laid.velocity.push([0.0, speed, 0.0]);
            laid.volume.push(1.0);
            laid.layer.push(layer);
        }
        let sliced = Sliced::of(&laid, Slicing { segment: 1.0, layer: 1.0 });
        assert!(sliced.segments.len() == 4 && (sliced.touch[0] - 3.25).abs() < 1e-12, "{sliced:?}");
    }
}
