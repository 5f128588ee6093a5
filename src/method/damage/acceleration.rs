//! Acceleration of the alternation of displacement and damage.
//!
//! The alternation converges like a linear fixed-point iteration where changes are small, slowly if a crack is about to
//! run. There Anderson's method finds the next damage from the last few alternations. It only goes downhill: a
//! stationary point that is no minimum, in front of a crack that runs, is left as the plain alternation leaves it:
//! changes are lengthened by a factor (P. E. Farrell & C. Maurini 2017, doi 10.1002/nme.5300), which grows as long as
//! they keep their direction and their size. A crack that is about to run then does so after a few alternations instead
//! of tens.

use crate::math::anderson::Anderson;
use crate::math::separable::dot;

/// Factor by which a change of damage is lengthened, and its growth from one such change to the next.
const RELAXATION: f64 = 1.6;
const GAIN: f64 = 1.6;
/// Cosine of the angle between successive changes, and ratio of their sizes, above which the factor grows.
const ALIGNED: f64 = 0.9;
const LASTING: f64 = 0.7;
/// Number of alternations that an accelerated one is made of.
const DEPTH: usize = 5;
/// Largest change of damage in an alternation after which the next is accelerated, and in an accelerated or lengthened
/// one.
const SMALL: f64 = 0.05;
const LONGEST: f64 = 0.6;
/// Growth of the change, over its least since the last restart, at which acceleration restarts.
const GROWTH: f64 = 2.0;

/// History of the alternation.
pub struct Acceleration {
    anderson: Anderson,
    /// Least change of damage since the last restart.
    least: f64,
    lengthened: Option<Lengthened>,
}

/// The last change, if it was lengthened.
struct Lengthened {
    factor: f64,
    /// The change before it was lengthened, and its largest value.
    step: Vec<f64>,
    change: f64,
}

/// An alternation: damage before it and after it, and the gradient of the energy before it.
pub struct Alternated<'a> {
    pub before: &'a [f64],
    pub after: &'a [f64],
    pub gradient: &'a [f64],
    /// Largest change of damage.
    pub change: f64,
}

impl Acceleration {
    pub fn new() -> Self {
        Self { anderson: Anderson::of_depth(DEPTH), least: f64::INFINITY, lengthened: None }
    }

    /// Returns the damage with which to continue, between `low` and 1.
    pub fn next(&mut self, alternated: &Alternated, low: &[f64]) -> Vec<f64> {
        let Alternated { before, change, .. } = *alternated;
        let step = alternated.step();
        if let Some(factor) = self.lengthened.take().and_then(|last| last.continued(&step, change))
        {
            return self.lengthen(alternated, step, factor, low);
        }
        let is_regular = change <= SMALL && change <= GROWTH * self.least;
        self.least = self.least.min(change);
        if is_regular {
            let next = bounded(self.anderson.next(before, &step), low);
            if alternated.is_downhill(&next) {
                return next;
            }
        }
        self.lengthen(alternated, step, RELAXATION, low)
    }

    /// Lengthens a change, and forgets all before.
    fn lengthen(
        &mut self,
        alternated: &Alternated,
        step: Vec<f64>,
        factor: f64,
        low: &[f64],
    ) -> Vec<f64> {
        let next = alternated.before.iter().zip(&step).map(|(d, step)| d + factor * step);
        let next = bounded(next.collect(), low);
        let change = alternated.change;
        let lengthened = Some(Lengthened { factor, step, change });
        *self = Self { least: change, lengthened, ..Self::new() };
        next
    }
}

impl Lengthened {
    /// Factor of the next change if it continues this one.
    fn continued(&self, step: &[f64], change: f64) -> Option<f64> {
        let lasts = change > LASTING * self.change && cosine(step, &self.step) > ALIGNED;
        lasts.then(|| (GAIN * self.factor).min(LONGEST / change).max(RELAXATION))
    }
}

/// Cosine of the angle between two changes, which are not zero.
fn cosine(a: &[f64], b: &[f64]) -> f64 {
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}

impl Alternated<'_> {
    fn step(&self) -> Vec<f64> {
        self.after.iter().zip(self.before).map(|(after, before)| after - before).collect()
    }

    /// Returns true if the energy falls towards a damage, which is not far away.
    fn is_downhill(&self, next: &[f64]) -> bool {
        let (mut slope, mut largest) = (0.0, 0.0_f64);
        for ((next, before), gradient) in next.iter().zip(self.before).zip(self.gradient) {
            slope += gradient * (next - before);
            largest = largest.max((next - before).abs());
        }
        slope < 0.0 && largest <= LONGEST
    }
}

fn bounded(mut damage: Vec<f64>, low: &[f64]) -> Vec<f64> {
    damage.iter_mut().zip(low).for_each(|(damage, &low)| *damage = damage.clamp(low, 1.0));
    damage
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Alternates from a damage until it changes by less than 1e-8; `correction` is that of a plain alternation.
    fn alternate(
        mut damage: Vec<f64>,
        gradient: impl Fn(&[f64]) -> Vec<f64>,
        correction: impl Fn(&[f64]) -> Vec<f64>,
    ) -> (Vec<f64>, usize) {
        let low = vec![0.0; damage.len()];
        let mut acceleration = Acceleration::new();
        for count in 1..1000 {
            let after = damage.iter().zip(correction(&damage)).map(|(d, step)| d + step);
            let after = bounded(after.collect(), &low);
            let steps = after.iter().zip(&damage).map(|(after, before)| (after - before).abs());
            let change = steps.fold(0.0, f64::max);
            if change < 1e-8 {
                return (damage, count);
            }
            let gradient = gradient(&damage);
            let before = &damage[..];
            let alternated = Alternated { before, after: &after, gradient: &gradient, change };
            damage = acceleration.next(&alternated, &low);
        }
        panic!("no convergence at {damage:?}");
    }

    #[test]
    fn slow_modes_converge_in_few_alternations() {
        // Alternations alone would reduce the slowest mode by 1 % each.
        let rates = [0.01, 0.05, 0.3, 1.0];
        let minimum = [0.4, 0.7, 0.2, 0.9];
        let gradient = |d: &[f64]| (0..4).map(|k| rates[k] * (d[k] - minimum[k])).collect();
        let correction = |d: &[f64]| (0..4).map(|k| rates[k] * (minimum[k] - d[k])).collect();
        let (found, count) = alternate(vec![0.3; 4], gradient, correction);
        assert!(count < 40, "{count}");
        for (found, wanted) in found.iter().zip(&minimum) {
            assert!((found - wanted).abs() < 1e-5, "{found} {wanted}");
        }
    }

    #[test]
    fn unstable_equilibrium_is_left_in_few_alternations() {
        // Plain alternations grow the distance from the maximum by 2 % each: from 1e-3 to 0.7 in 330.
        let gradient = |d: &[f64]| vec![0.3 - d[0]];
        let correction = |d: &[f64]| vec![0.02 * (d[0] - 0.3)];
        let (found, count) = alternate(vec![0.301], gradient, correction);
        assert_eq!(found, [1.0]);
        assert!(count < 30, "{count}");
    }

    #[test]
    fn maximum_of_the_energy_is_left() {
        // The energy −½(d − 0.3)² has its minima at the bounds, and a stationary point that alternations leave slowly.
        for (start, end) in [(0.301, 1.0), (0.299, 0.0)] {
            let gradient = |d: &[f64]| vec![0.3 - d[0]];
            let correction = |d: &[f64]| vec![0.1 * (d[0] - 0.3)];
            let (found, _) = alternate(vec![start], gradient, correction);
            assert_eq!(found, [end]);
        }
    }
}
