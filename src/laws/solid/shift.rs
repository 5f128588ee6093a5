//! Time–temperature shift: relaxation times over the temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::laws::GAS_CONSTANT;
use crate::limits::{knot, plausible, positive, tag, within};

/// Law by which all relaxation times change with the temperature: they are multiplied by `a(T)`, which is 1 at the
/// reference temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "snake_case", deny_unknown_fields)]
#[schemars(transform = tag("law", "Law of the shift"))]
pub enum Shift {
    /// `ln a = E/R (1/T − 1/T_r)` (S. Arrhenius, Z. phys. Chem. 4 (1889) 226, doi 10.1515/zpch-1889-0416).
    Arrhenius {
        /// Activation energy E [J/mol].
        #[schemars(transform = within(0.0, 1e7, "J/mol", "the activation energy of relaxation")
            .plausible(&plausible::ACTIVATION_ENERGY))]
        activation_energy: f64,
        /// Temperature T_r at which the times hold [K].
        #[schemars(transform = knot())]
        reference_temperature: f64,
    },
    /// `log₁₀ a = −c₁ (T − T_r)/(c₂ + T − T_r)`; at and below `T_r − c₂` nothing relaxes (M. L. Williams, R. F. Landel
    /// and J. D. Ferry 1955, doi 10.1021/ja01619a008).
    Wlf {
        /// c₁ [1].
        #[schemars(transform = within(0.0, 1e3, "1", "c₁ of the shift"))]
        c1: f64,
        /// c₂ [K].
        #[schemars(transform = positive("K", "c₂ of the shift"))]
        c2: f64,
        /// Temperature T_r at which the times hold [K].
        #[schemars(transform = knot())]
        reference_temperature: f64,
    },
}

/// Largest magnitude of `ln a`: beyond it nothing relaxes, or everything does.
const MOST: f64 = 600.0;
/// Change of `ln a` over a part of an integral, and the largest number of parts.
const CHANGE_OF_PART: f64 = 2.0;
const MOST_PARTS: f64 = 64.0;
/// Places and weights of Gauss's rule of five points on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

impl Shift {
    /// `ln a` at a temperature [K].
    pub fn logarithm(&self, temperature: f64) -> f64 {
        let logarithm = match *self {
            Self::Arrhenius { activation_energy, reference_temperature } => {
                activation_energy / GAS_CONSTANT * (1.0 / temperature - 1.0 / reference_temperature)
            }
            Self::Wlf { c1, c2, reference_temperature } => {
                let above = temperature - reference_temperature;
                let from_arrest = c2 + above;
                if from_arrest > 0.0 {
                    -c1 * std::f64::consts::LN_10 * above / from_arrest
                } else {
                    MOST
                }
            }
        };
        logarithm.clamp(-MOST, MOST)
    }

    /// Reduced time `ξ = ∫ dt/a(T)` [s] over a duration [s] in which the temperature changes linearly [K] (L. W.
    /// Morland and E. H. Lee 1960, doi 10.1122/1.548856), by Gauss's rule over parts in which `ln a` changes little.
    pub fn reduced_time(&self, [start, end]: [f64; 2], duration: f64) -> f64 {
        let rate = |part: f64| (-self.logarithm(start + (end - start) * part)).exp();
        if start == end {
            return duration * rate(1.0);
        }
        let change = (self.logarithm(end) - self.logarithm(start)).abs();
        let parts = (change / CHANGE_OF_PART).ceil().clamp(1.0, MOST_PARTS);
        let of_part = |k: usize| -> f64 {
            let at = |x: f64| rate((k as f64 + 0.5 * (1.0 + x)) / parts);
            GAUSS.iter().map(|(x, weight)| 0.5 * weight * at(*x)).sum()
        };
        duration / parts * (0..parts as usize).map(of_part).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WLF: Shift = Shift::Wlf { c1: 17.44, c2: 51.6, reference_temperature: 373.0 };

    #[test]
    fn times_change_by_decades_as_williams_landel_and_ferry_found() {
        // log₁₀ a(T_r + 50 K) = −17.44 · 50/101.6
        let decades = WLF.logarithm(423.0) / std::f64::consts::LN_10;
        assert!((decades + 8.582_677_165_354_33).abs() < 1e-12, "{decades}");
        assert_eq!(WLF.logarithm(373.0), 0.0);
        // Frozen at T_r − c₂ and below.
        assert_eq!(WLF.reduced_time([300.0, 300.0], 1e12), 1e12 * (-MOST).exp());
    }

    #[test]
    fn reduced_time_under_an_arrhenius_shift_is_its_integral() {
        let law = Shift::Arrhenius { activation_energy: 60e3, reference_temperature: 350.0 };
        // Simpson's rule on 2000 intervals.
        let n = 2000;
        let weight = |k: usize| match k {
            0 => 1.0,
            k if k == n => 1.0,
            k if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        for end in [340.0, 368.0] {
            let found = law.reduced_time([350.0, end], 10.0);
            let rate =
                |k: usize| (-law.logarithm(350.0 + (end - 350.0) * k as f64 / n as f64)).exp();
            let exact = 10.0 / (3.0 * n as f64) * (0..=n).map(|k| weight(k) * rate(k)).sum::<f64>();
            assert!((found / exact - 1.0).abs() < 1e-9, "{end}: {found} {exact}");
        }
        assert_eq!(law.reduced_time([350.0, 350.0], 3.0), 3.0);
    }
}
