//! Flaws that grow slowly under tension, as water does it in glass and oxide ceramics.
//!
//! A crack grows at the rate `ȧ = A K^n` (S. M. Wiederhorn 1967, doi 10.1111/j.1151-2916.1967.tb15145.x; A. G. Evans
//! 1974, doi 10.1007/BF00701063). A flaw that an inert environment lets bear a stress S has then broken by the time t
//! if at some moment τ before
//!
//! `S^(n−2) ≤ σ(τ)^(n−2) + 1/B ∫₀^τ σ^n dt`, `B = 2/((n − 2) A Y² K_Ic^(n−2))`, `K = Yσ√a`.
//!
//! So Weibull's statistics of the inert strength hold for the root of the right side. Its stresses are relative to the
//! Weibull strength, so that no power overflows.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{plausible, positive, within};

/// Slow growth of cracks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ exponent = n, constant = B }`")]
pub struct SlowGrowth {
    /// Exponent n of the rate of growth over the stress intensity [1].
    #[schemars(transform = within(Self::LEAST_EXPONENT, Self::MOST_EXPONENT, "1", "the exponent of slow growth")
        .plausible(&plausible::GROWTH_EXPONENT))]
    pub exponent: f64,
    /// Constant B: a constant stress σ is borne for the time B S^(n−2)/σ^n by what has the inert strength S [Pa² s].
    #[schemars(transform = positive("Pa² s", "the constant of slow growth").plausible(&plausible::GROWTH_CONSTANT))]
    pub constant: f64,
}

/// Relative difference of two stresses below which the mean takes the place of the integral between them.
const EVEN: f64 = 1e-6;

impl SlowGrowth {
    pub const LEAST_EXPONENT: f64 = 3.0;
    pub const MOST_EXPONENT: f64 = 100.0;

    /// `∫ (s/σ₀)^n dt` [s] over a time [s] in which the stress changes linearly; compression does not count.
    pub fn grown(&self, [first, last]: [f64; 2], strength: f64, duration: f64) -> f64 {
        let [first, last] = [first, last].map(|stress| stress / strength);
        let change = last - first;
        if change.abs() <= EVEN * first.max(last) {
            return (0.5 * (first + last)).powf(self.exponent) * duration;
        }
        let power = |ratio: f64| ratio.max(0.0).powf(self.exponent + 1.0);
        let part = power(last) - power(first);
        if part == 0.0 { 0.0 } else { part / ((self.exponent + 1.0) * change) * duration }
    }

    /// Inert strength of the weakest flaw that a stress [Pa] does not break after [`Self::grown`] [s]. Where nothing
    /// has grown that is the stress itself, negative where nothing is in tension.
    pub fn inert(&self, stress: f64, strength: f64, grown: f64) -> f64 {
        if grown == 0.0 {
            return stress;
        }
        let power = self.exponent - 2.0;
        let root = |value: f64| value.powf(1.0 / power);
        let past = root(grown) * root(strength / self.constant * strength);
        let now = (stress / strength).max(0.0);
        // Relative to the larger, whose power is one.
        let [less, more] = if now < past { [now, past] } else { [past, now] };
        strength * more * root(1.0 + (less / more).powf(power))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Soda-lime glass in water: n of 16, and a crack that grows at 6 mm/s at K_Ic = 0.75 MPa√m, with Y = 1.12 √π.
    fn glass() -> SlowGrowth {
        let (n, toughness, speed) = (16.0, 0.75e6, 6e-3);
        let shape = 1.12 * std::f64::consts::PI.sqrt();
        let constant = 2.0 * toughness * toughness / ((n - 2.0) * shape * shape * speed);
        SlowGrowth { exponent: n, constant }
    }

    #[test]
    fn a_crack_in_time_agrees() {
        // da/dt = v (K/K_Ic)^n from a depth that bears 60 MPa at once, under 20 MPa, by small steps in ln a.
        let (law, toughness, shape) = (glass(), 0.75e6, 1.12 * std::f64::consts::PI.sqrt());
        let depth = (toughness / (shape * 60e6_f64)).powi(2);
        let end = (toughness / (shape * 20e6_f64)).powi(2);
        let steps = 200_000;
        let ratio = (end / depth).ln() / f64::from(steps);
        let mut time = 0.0;
        for step in 0..steps {
            let a = depth * (ratio * (f64::from(step) + 0.5)).exp();
            let k = shape * 20e6 * a.sqrt() / toughness;
            time += a * ratio / (6e-3 * k.powf(16.0));
        }
        let grown = law.grown([20e6, 20e6], 50e6, time);
        let found = law.inert(20e6, 50e6, grown);
        assert!((found / 60e6 - 1.0).abs() < 1e-6, "{found}");
    }

    #[test]
    fn growth_under_changing_stress_is_the_integral() {
        let law = glass();
        let many = 20_000;
        let mean = |[first, last]: [f64; 2]| {
            let at = |i: i32| first + (last - first) * (f64::from(i) + 0.5) / f64::from(many);
            (0..many).map(|i| (at(i).max(0.0) / 50e6).powf(16.0)).sum::<f64>() / f64::from(many)
        };
        // Between equal ones, from nothing, and through compression, in which a part of the time is no tension.
        for ends in [[30e6, 30e6], [0.0, 40e6], [40e6, 25e6]] {
            let found = law.grown(ends, 50e6, 3.0);
            assert!((found / (3.0 * mean(ends)) - 1.0).abs() < 1e-5, "{ends:?} {found}");
        }
        let [all, tension] = [[-10e6, 40e6], [0.0, 40e6]].map(|ends| law.grown(ends, 50e6, 1.0));
        assert!((all / tension - 0.8).abs() < 1e-12);
        assert_eq!(law.grown([-10e6, -20e6], 50e6, 1.0), 0.0);
    }

    #[test]
    fn large_powers_stay_finite_and_nothing_grown_is_the_stress() {
        let law = SlowGrowth { exponent: 100.0, constant: 1e12 };
        assert_eq!(law.inert(-3.0, 50e6, 0.0), -3.0);
        let found = law.inert(45e6, 50e6, law.grown([45e6, 45e6], 50e6, 1e9));
        assert!(found.is_finite() && found > 45e6);
        assert!((law.inert(20e6, 50e6, 1e-300) / 20e6 - 1.0).abs() < 1e-12);
    }
}
