//! Weibull's statistics of flaws (W. Weibull 1939, Ing. Vetensk. Akad. Handl. 151; J. Appl. Mech. 18 (1951) 293).
//!
//! `P = 1 − e^{−B}`, `B = ∫ h(σ) dV/V₀` over flaws in the volume or `∫ h(σ) dA/A₀` over those of the surface. For
//! uniaxial tension `h = (σ/σ₀)^m`. Principal stresses count each on their own (`independent`), or the normal stress of
//! every direction does (`normal`). Compression opens no flaw.
//!
//! A state is the equivalent stress `s = σ₀ h^{1/m}`, which neither overflows nor underflows at any modulus.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::normal_average::NormalAverage;
use super::slow_growth::SlowGrowth;
use crate::laws::stress::principals;
use crate::laws::stress_rate::principal_rates;
use crate::limits::{plausible, positive, within};

/// Distribution of flaws as a scene sets it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ modulus = m, strength = σ₀, volume = V₀ }`")]
pub struct Weibull {
    /// Modulus m [1].
    #[schemars(transform = within(Self::LEAST_MODULUS, Self::MOST_MODULUS, "1", "the Weibull modulus")
        .plausible(&plausible::WEIBULL_MODULUS))]
    pub modulus: f64,
    /// Strength σ₀: the uniaxial tension under which a fraction 1 − 1/e of specimens of the reference volume, or area,
    /// fails [Pa].
    #[schemars(transform = positive("Pa", "the Weibull strength").plausible(&plausible::STRENGTH))]
    pub strength: f64,
    /// Reference volume V₀ [m³]: flaws are in the volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("m³", "the reference volume").otherwise("`area`"))]
    pub volume: Option<f64>,
    /// Reference area A₀ [m²]: flaws are on the faces of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("m²", "the reference area").otherwise("`volume`"))]
    pub area: Option<f64>,
    /// Orientation of flaws.
    #[serde(default)]
    pub directions: Directions,
    /// Slow growth of flaws under tension.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "flaws break at once or never"))]
    pub slow_growth: Option<SlowGrowth>,
}

/// Orientation of flaws under a stress of several axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Directions {
    /// Each principal stress acts on its own.
    #[default]
    Independent,
    /// The normal stress is averaged over all directions.
    Normal,
}

/// Place of flaws, with the reference volume [m³] or area [m²].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    Volume(f64),
    Area(f64),
}

/// Distribution of flaws, prepared for stresses.
#[derive(Debug, Clone, PartialEq)]
pub struct FlawStatistics {
    pub modulus: f64,
    /// [Pa]
    pub strength: f64,
    pub extent: Extent,
    pub slow_growth: Option<SlowGrowth>,
    /// Average over directions; `None` if principal stresses are independent.
    average: Option<NormalAverage>,
}

/// Ratio of equivalent tension to equivalent compression below which a state counts as compressed along all axes. The
/// stress across a free face is zero up to rounding and solvers' tolerances.
const NO_TENSION: f64 = 1e-6;

impl Weibull {
    pub const LEAST_MODULUS: f64 = 1.0;
    pub const MOST_MODULUS: f64 = 100.0;

    /// Returns the distribution, ready for use; flaws are in the volume unless an area is given.
    pub fn statistics(&self) -> FlawStatistics {
        let Self { modulus, strength, volume, area, directions, slow_growth } = *self;
        let extent = match (volume, area) {
            (_, Some(area)) => Extent::Area(area),
            (volume, None) => Extent::Volume(volume.unwrap_or(1.0)),
        };
        let is_normal = directions == Directions::Normal;
        let average = is_normal.then(|| NormalAverage::of(modulus));
        FlawStatistics { modulus, strength, extent, slow_growth, average }
    }
}

impl Extent {
    /// The reference volume [m³] or area [m²].
    pub fn size(self) -> f64 {
        match self {
            Self::Volume(size) | Self::Area(size) => size,
        }
    }
}

impl FlawStatistics {
    /// Equivalent stress `σ₀ h^{1/m}` [Pa] of a stress xx, yy, zz, xy, yz, xz [Pa].
    #[cfg(test)]
    fn equivalent(&self, stress: [f64; 6]) -> f64 {
        self.of_principals(principals(stress)).max(0.0)
    }

    /// Equivalent stress, continued to negative values where nothing is in tension: there it is minus the equivalent
    /// stress of the reversed state. A stress that passes through zero as a whole, as in bending, so has no kink, and
    /// may be interpolated.
    pub fn continued(&self, stress: [f64; 6]) -> f64 {
        let [first, second, third] = principals(stress);
        let tension = self.of_principals([first, second, third]);
        if third >= 0.0 || first > -third {
            return tension;
        }
        let compression = self.of_principals([-third, -second, -first]);
        if tension <= NO_TENSION * compression { -compression } else { tension }
    }

    fn of_principals(&self, [first, second, third]: [f64; 3]) -> f64 {
        // NaN passes on.
        if first <= 0.0 {
            return 0.0;
        }
        let [second, third] = [second / first, third / first];
        let sum = match &self.average {
            Some(average) => average.risk(second.min(1.0), third.min(1.0)),
            None => 1.0 + self.power(second) + self.power(third),
        };
        if sum == 1.0 { first } else { first * sum.powf(1.0 / self.modulus) }
    }

    /// Rate of [`Self::continued`] when the stress changes. It is that of the side on which the stress is.
    pub fn continued_rate(&self, stress: [f64; 6], rate: [f64; 6]) -> f64 {
        let [first, second, third] = principals(stress);
        let rates = principal_rates(stress, rate);
        let along =
            |slopes: [f64; 3]| slopes.iter().zip(rates).map(|(slope, own)| slope * own).sum();
        match self.continued(stress) {
            negative if negative < 0.0 => {
                let [third, second, first] = self.slopes([-third, -second, -first]);
                along([first, second, third])
            }
            _ => along(self.slopes([first, second, third])),
        }
    }

    /// Derivatives of [`Self::of_principals`] with respect to these.
    fn slopes(&self, [first, second, third]: [f64; 3]) -> [f64; 3] {
        if first <= 0.0 {
            return [0.0; 3];
        }
        let [second, third] = [second / first, third / first];
        let (sum, [of_second, of_third]) = match &self.average {
            Some(average) => average.with_slopes(second.min(1.0), third.min(1.0)),
            None => {
                let [of_second, of_third] = [second, third].map(|own| self.power(own));
                let slope = |power: f64, ratio: f64| {
                    if power > 0.0 { self.modulus * power / ratio } else { 0.0 }
                };
                let slopes = [slope(of_second, second), slope(of_third, third)];
                (1.0 + of_second + of_third, slopes)
            }
        };
        // Of first · sum^(1/m).
        let root = sum.powf(1.0 / self.modulus);
        let [of_second, of_third] =
            [of_second, of_third].map(|own| root * own / (self.modulus * sum));
        [root - second * of_second - third * of_third, of_second, of_third]
    }

    /// `⟨x⟩^m`, by multiplication where the modulus is a whole number.
    pub fn power(&self, ratio: f64) -> f64 {
        let whole = self.modulus as i32;
        match ratio > 0.0 {
            false => 0.0,
            true if f64::from(whole) == self.modulus => ratio.powi(whole),
            true => ratio.powf(self.modulus),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flaws(modulus: f64, directions: Directions) -> FlawStatistics {
        let weibull = Weibull {
            modulus,
            strength: 300e6,
            volume: Some(1e-9),
            area: None,
            directions,
            slow_growth: None,
        };
        weibull.statistics()
    }

    #[test]
    fn uniaxial_tension_is_its_own_equivalent_in_any_direction() {
        for directions in [Directions::Independent, Directions::Normal] {
            for modulus in [1.0, 5.0, 20.0, 100.0] {
                let flaws = flaws(modulus, directions);
                let (c, s) = (0.6, 0.8);
                let turned = [c * c * 2e8, s * s * 2e8, 0.0, c * s * 2e8, 0.0, 0.0];
                for stress in [[2e8, 0.0, 0.0, 0.0, 0.0, 0.0], turned] {
                    let found = flaws.equivalent(stress);
                    assert!((found / 2e8 - 1.0).abs() < 1e-7, "m {modulus}: {found}");
                }
            }
        }
    }

    #[test]
    fn equibiaxial_tension_doubles_independent_risk() {
        let flaws = flaws(10.0, Directions::Independent);
        let risk = flaws.power(flaws.equivalent([2e8, 2e8, 0.0, 0.0, 0.0, 0.0]) / 300e6);
        assert!((risk / (2.0 * (2.0 / 3.0_f64).powi(10)) - 1.0).abs() < 1e-7);
    }

    #[test]
    fn compression_has_no_risk_and_a_continued_stress() {
        for directions in [Directions::Independent, Directions::Normal] {
            let flaws = flaws(10.0, directions);
            let stress = [-2e8, -2e8, 1e-3, 0.0, 0.0, 0.0];
            assert!(flaws.equivalent(stress) < 1e-2);
            let reversed = flaws.equivalent(stress.map(|s| -s));
            let continued = flaws.continued(stress);
            assert!((continued / reversed + 1.0).abs() < 1e-7);
            // Shear has tension.
            let shear = [0.0, 0.0, 0.0, 1e8, 0.0, 0.0];
            assert_eq!(flaws.continued(shear), flaws.equivalent(shear));
            assert!(flaws.continued([f64::NAN; 6]).is_nan());
        }
    }

    #[test]
    fn rates_are_those_of_small_changes() {
        let change = [0.3, -0.7, 0.2, 0.5, -0.4, 0.1].map(|own| own * 1e8);
        for directions in [Directions::Independent, Directions::Normal] {
            for modulus in [3.0, 10.0, 17.5] {
                let flaws = flaws(modulus, directions);
                for stress in [
                    [2e8, 1e8, -5e7, 3e7, -2e7, 4e7],
                    // Equal principal stresses, and compression along all axes.
                    [2e8, 2e8, 0.0, 0.0, 0.0, 0.0],
                    [-2e8, -1e8, -3e8, 3e7, -2e7, 4e7],
                ] {
                    let at = |by: f64| {
                        flaws.continued(std::array::from_fn(|i| stress[i] + by * change[i]))
                    };
                    let wanted = (at(1e-5) - at(-1e-5)) / 2e-5;
                    let found = flaws.continued_rate(stress, change);
                    assert!((found - wanted).abs() < 2e-6 * 2e8, "m {modulus}: {found} {wanted}");
                }
            }
        }
    }
}
