//! Films that stand on one place, which do not give what each would alone.
//!
//! Like drops on one place make up one drop of n volumes. Its film is `n^(1/3)` times as thick as that of one drop and
//! covers `n^(2/3)` times the area, so each drop gives a part of its heat `n^(2/3)` times as late as it would alone: `H(t)`
//! becomes `H(t/n^(2/3))`, early and late (of a film that cools, see `closed_form::cooling_film`, H depends on `at/δ²`
//! alone). So the heat of each ring has an age of its own, which lags behind that of the drop.
//!
//! n counts films by the part of its heat that each still has: a film that has given all of it holds up no other one.
//! Of one drop that is alone, n is 1 to the bit.

use std::f64::consts::PI;

use super::course::Course;
use super::state::{Drop, Ledger};

/// Angles at which a ring about one place is looked at from another, over half a turn.
const ANGLES: usize = 16;

/// Lets the heat of films that share places lag behind over the last step.
pub fn share(course: &Course, ledger: &Ledger, drops: &mut [Drop]) {
    let places = Places::of(course, ledger, drops);
    for place in 0..places.all.len() {
        let around = places.around(place);
        let own = &places.all[place];
        for (drop, weights) in &own.films {
            let drop = &mut drops[*drop];
            let time = ledger.time - drop.contact.max(ledger.time - ledger.duration);
            for (ring, &weight) in weights.iter().enumerate() {
                // Without others it is nothing to the bit.
                let beside = if own.films.len() > 1 { own.sums[ring] - weight } else { 0.0 };
                let others = around[ring] + beside;
                if weight > 0.0 && others > 0.0 {
                    // (1/n^(1/3))²
                    let pace = (weight / (weight + others)).cbrt().powi(2);
                    drop.lag[ring] += (1.0 - pace) * time;
                }
            }
        }
    }
}

/// Films by the place of their middle.
struct Places {
    all: Vec<Place>,
    /// Of a ring [m].
    width: f64,
}

struct Place {
    at: [f64; 2],
    /// Each drop with the weights of its rings.
    films: Vec<(usize, Vec<f64>)>,
    /// Sums of the weights over all films.
    sums: Vec<f64>,
    /// Radius that films cover at most [m].
    reach: f64,
}

impl Places {
    fn of(course: &Course, ledger: &Ledger, drops: &[Drop]) -> Self {
        let width = course.radius() / course.rings() as f64;
        let mut down: Vec<usize> = (0..drops.len()).filter(|&n| drops[n].is_down()).collect();
        let key = |n: &usize| drops[*n].place.map(f64::to_bits);
        down.sort_by_key(key);
        let groups: Vec<&[usize]> = down.chunk_by(|a, b| key(a) == key(b)).collect();
        let middles: Vec<[f64; 2]> = groups.iter().map(|group| drops[group[0]].place).collect();
        let reach = |n: usize| reach(course, &drops[groups[n][0]]);
        let is_near =
            |n: usize, m: usize| n != m && distance(middles[n], middles[m]) < reach(n) + reach(m);
        let is_shared = |n: usize| groups[n].len() > 1 || (0..groups.len()).any(|m| is_near(n, m));
        let place = |n: usize| {
            let films = groups[n].iter().map(|&n| (n, weights(course, ledger, &drops[n])));
            Place::of((middles[n], reach(n)), films.collect())
        };
        Self { all: (0..groups.len()).filter(|&n| is_shared(n)).map(place).collect(), width }
    }

    /// Weights of what stands about other places, as means over the rings about one.
    fn around(&self, place: usize) -> Vec<f64> {
        let own = &self.all[place];
        let mut sums = vec![0.0; own.sums.len()];
        for (n, other) in self.all.iter().enumerate() {
            let distance = distance(own.at, other.at);
            if n != place && distance < own.reach + other.reach {
                for (ring, sum) in sums.iter_mut().enumerate() {
                    *sum += other.mean((ring as f64 + 0.5) * self.width, distance, self.width);
                }
            }
        }
        sums
    }
}

impl Place {
    fn of((at, reach): ([f64; 2], f64), films: Vec<(usize, Vec<f64>)>) -> Self {
        let mut sums = vec![0.0; films[0].1.len()];
        for (_, weights) in &films {
            sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight);
        }
        Self { at, films, sums, reach }
    }

    /// Mean weight over a circle of a radius about what is a distance away [m].
    fn mean(&self, radius: f64, distance: f64, width: f64) -> f64 {
        let at = |n: usize| {
            let cosine = (PI * (n as f64 + 0.5) / ANGLES as f64).cos();
            let square = radius * radius + distance * distance - 2.0 * radius * distance * cosine;
            self.sums.get((square.max(0.0).sqrt() / width) as usize).copied().unwrap_or(0.0)
        };
        (0..ANGLES).map(at).sum::<f64>() / ANGLES as f64
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Radius that a drop comes to cover [m].
pub fn reach(course: &Course, drop: &Drop) -> f64 {
    0.5 * course.largest_spread(drop.speed)
}

/// Weights of the rings of a drop: the part of its heat that a film still has, nothing where the wall is dry.
fn weights(course: &Course, ledger: &Ledger, drop: &Drop) -> Vec<f64> {
    let Drop { contact, speed, lag, .. } = drop;
    let start = ledger.time - ledger.duration;
    let [before, after] =
        [start, ledger.time].map(|time| course.amounts(*speed, time - contact, lag));
    let weight = |(ring, whole): (usize, f64)| {
        let is_wet = after[ring].heat != 0.0 && whole > 0.0;
        if is_wet { (1.0 - before[ring].heat / whole).clamp(0.0, 1.0) } else { 0.0 }
    };
    let whole = course.amounts(*speed, course.duration(*speed), &vec![0.0; before.len()]);
    whole.into_iter().map(|ring| ring.heat).enumerate().map(weight).collect()
}
