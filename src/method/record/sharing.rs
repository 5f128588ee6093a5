//! Films on the same place, which transfer less than each would alone.
//!
//! Equal drops on one place act like one drop of n volumes. Its film is `n^(1/3)` times as thick as
//! that of one drop and covers `n^(2/3)` times the area. So each drop transfers a given fraction of
//! its heat `n^(2/3)` times as late as it would alone: `H(t)` becomes `H(t/n^(2/3))`. This holds
//! early and late (for a film that cools, see `closed_form::cooling_film`, H depends on `at/δ²`
//! alone). So the heat of each ring has an age of its own, which lags behind that of the drop.
//!
//! n counts films by their remaining fraction of heat: a film that has transferred nearly all of it
//! delays no other. For a single drop n is 1 to the bit.

use std::array::from_fn;
use std::f64::consts::PI;

use super::course::Course;
use super::profile::Amounts;
use super::state::{Drop, Ledger};
use crate::math::segments::distance;

/// Remaining fraction of heat below which a film has cooled: to transfer that takes as long as all
/// before.
const SPENT: f64 = 0.05;
/// Number of angles, over half a turn, at which a ring about one place is evaluated from another.
const ANGLES: usize = 16;

/// Delays the heat of films that share places over the last step; `amounts` are those of their
/// rings before it.
pub fn share(course: &Course, ledger: &Ledger, drops: &mut [Drop], amounts: &[Vec<Amounts>]) {
    let places = Places::of(course, ledger, drops, amounts);
    for place in 0..places.all.len() {
        let around = places.around(place);
        let own = &places.all[place];
        for (drop, weights) in &own.films {
            let drop = &mut drops[*drop];
            let time = ledger.time - drop.contact.max(ledger.time - ledger.duration);
            for (ring, &weight) in weights.iter().enumerate() {
                // Without other films the lag is zero to the bit.
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

/// Films grouped by the position of their middle.
struct Places {
    all: Vec<Place>,
    /// Width of a ring [m].
    width: f64,
    /// Cosines of the angles at which rings are evaluated.
    cosines: [f64; ANGLES],
}

struct Place {
    at: [f64; 2],
    /// Each drop with the weights of its rings.
    films: Vec<(usize, Vec<f64>)>,
    /// Sums of the weights over all films.
    sums: Vec<f64>,
    /// Largest radius that films cover [m].
    reach: f64,
}

impl Places {
    fn of(course: &Course, ledger: &Ledger, drops: &[Drop], amounts: &[Vec<Amounts>]) -> Self {
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
            let weights =
                |n: usize| weights(course, ledger.time - drops[n].contact, &drops[n], &amounts[n]);
            let films = groups[n].iter().map(|&n| (n, weights(n)));
            Place::of((middles[n], reach(n)), films.collect())
        };
        let cosines = from_fn(|n| (PI * (n as f64 + 0.5) / ANGLES as f64).cos());
        Self {
            all: (0..groups.len()).filter(|&n| is_shared(n)).map(place).collect(),
            width,
            cosines,
        }
    }

    /// Weights of the films about other places, as means over the rings about one.
    fn around(&self, place: usize) -> Vec<f64> {
        let own = &self.all[place];
        let mut sums = vec![0.0; own.sums.len()];
        for (n, other) in self.all.iter().enumerate() {
            let distance = distance(own.at, other.at);
            if n != place && distance < own.reach + other.reach {
                for (ring, sum) in sums.iter_mut().enumerate() {
                    *sum += self.mean(other, (ring as f64 + 0.5) * self.width, distance);
                }
            }
        }
        sums
    }

    /// Mean weight of films over a circle, given its radius and its distance from the films' middle
    /// [m].
    fn mean(&self, films: &Place, radius: f64, distance: f64) -> f64 {
        let at = |cosine: &f64| {
            let square = radius * radius + distance * distance - 2.0 * radius * distance * cosine;
            films.sums.get((square.max(0.0).sqrt() / self.width) as usize).copied().unwrap_or(0.0)
        };
        self.cosines.iter().map(at).sum::<f64>() / ANGLES as f64
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
}

/// Largest radius that a drop covers [m].
pub fn reach(course: &Course, drop: &Drop) -> f64 {
    0.5 * course.largest_spread(drop.speed)
}

/// Weights of the rings of a drop, from their `amounts` before the last step: the remaining
/// fraction of the film's heat, zero where the wall is dry.
fn weights(course: &Course, age: f64, drop: &Drop, amounts: &[Amounts]) -> Vec<f64> {
    let weight = |(ring, amounts): (usize, &Amounts)| {
        let whole = course.whole(drop.speed, ring);
        let is_wet =
            || amounts.heat != 0.0 || course.heat(drop.speed, ring, age - drop.lag[ring]) != 0.0;
        let left = 1.0 - amounts.heat / whole;
        if whole > 0.0 && left > SPENT && is_wet() { left.min(1.0) } else { 0.0 }
    };
    amounts.iter().enumerate().map(weight).collect()
}
