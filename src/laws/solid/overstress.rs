//! Flow over a step beyond the yield surface: how an excess of stress splits into flow and overstress.

/// Flow over a step as a function of the overstress, `γ = c sⁿ`, or `γ = c (s_b sinh(s/s_b))ⁿ` with a breakdown of the
/// power law (F. Garofalo 1963).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overstress {
    /// ln c, c in 1/Paⁿ; infinite for rate-independent flow.
    pub logarithm: f64,
    /// n
    pub exponent: f64,
    /// s_b [Pa]; infinite for a power law.
    pub breakdown: f64,
}

/// Split of the excess of a trial over the yield surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parted {
    /// γ [1].
    pub flow: f64,
    /// s [Pa].
    pub overstress: f64,
    /// `m dγ/de`.
    pub share: f64,
}

/// Upper limit of iterations, above the number that any root needs.
const MOST_ITERATIONS: usize = 100;
/// Argument from which on sinh is an exponential to rounding.
const LARGE: f64 = 20.0;
/// Argument up to which sinh is its argument to rounding.
const SMALL: f64 = 1e-8;

impl Overstress {
    /// Rate-independent flow, without overstress.
    pub const NONE: Self =
        Self { logarithm: f64::INFINITY, exponent: 1.0, breakdown: f64::INFINITY };

    /// Flow at a constant overstress [Pa].
    pub fn flow(&self, overstress: f64) -> f64 {
        if overstress > 0.0 { self.logarithm_of_flow(overstress).exp() } else { 0.0 }
    }

    /// Logarithm of the flow at a constant overstress [Pa]; minus infinity without flow.
    pub fn logarithm_of_flow(&self, overstress: f64) -> f64 {
        if overstress > 0.0 {
            self.logarithm + self.exponent * self.logarithm_of_effective(overstress)
        } else {
            f64::NEG_INFINITY
        }
    }

    /// `ln s`, or `ln (s_b sinh(s/s_b))`.
    fn logarithm_of_effective(&self, overstress: f64) -> f64 {
        if self.breakdown.is_infinite() {
            return overstress.ln();
        }
        let u = overstress / self.breakdown;
        if u > LARGE {
            self.breakdown.ln() + u - std::f64::consts::LN_2
        } else if u > SMALL {
            // Without the difference of two large logarithms.
            overstress.ln() + (u.sinh() / u).ln()
        } else {
            overstress.ln()
        }
    }

    /// Overstress [Pa] at which the logarithm of the flow has a value.
    pub fn of_flow(&self, logarithm: f64) -> f64 {
        let effective = (logarithm - self.logarithm) / self.exponent;
        if self.breakdown.is_infinite() {
            return effective.exp();
        }
        let ratio = effective - self.breakdown.ln();
        if ratio < SMALL.ln() {
            return effective.exp();
        }
        let u = if ratio > LARGE { ratio + std::f64::consts::LN_2 } else { ratio.exp().asinh() };
        self.breakdown * u
    }

    /// `d ln γ / d ln s` at an overstress [Pa].
    pub fn exponent_at(&self, overstress: f64) -> f64 {
        let u = overstress / self.breakdown;
        if u > SMALL { self.exponent * u / u.tanh() } else { self.exponent }
    }

    /// Splits an excess e > 0 [Pa] by `e = s + m γ(s)`, with a modulus m [Pa].
    pub fn part(&self, excess: f64, modulus: f64) -> Parted {
        if self.breakdown.is_infinite() {
            self.part_by_power(excess, modulus)
        } else {
            self.part_by_newton(excess, modulus)
        }
    }

    /// With `s = e x`, `x + β xⁿ = 1` where `β = m c eⁿ⁻¹`. The root is below both 1 and β^(−1/n). Scaled by the
    /// smaller of them it solves `a t + b tⁿ = 1`, where one coefficient is 1 and the other is less. The left side is
    /// convex and increasing, so Newton's method from t = 1 decreases to the root, whatever the numbers.
    fn part_by_power(&self, excess: f64, modulus: f64) -> Parted {
        let n = self.exponent;
        let beta = self.logarithm + modulus.ln() + (n - 1.0) * excess.ln();
        let [a, b] = if beta > 0.0 { [(-beta / n).exp(), 1.0] } else { [1.0, beta.exp()] };
        let mut t = 1.0_f64;
        for _ in 0..MOST_ITERATIONS {
            let power = t.powf(n - 1.0);
            let change = (a * t + b * power * t - 1.0) / (a + n * b * power);
            // Rounding may reverse its sign at the root.
            if change.is_nan() || change <= 0.5 * f64::EPSILON * t {
                break;
            }
            t -= change;
        }
        let (linear, power) = (a * t, b * t.powf(n));
        let share = if power > 0.0 { 1.0 / (1.0 + linear / (n * power)) } else { 0.0 };
        // Each is computed from its own small expression, not from a difference.
        Parted { flow: excess / modulus * power, overstress: excess * linear, share }
    }

    /// The root lies below both e and the overstress at which flow alone takes up e; from the smaller of them Newton's
    /// method decreases to it, as the sum is convex and increasing.
    fn part_by_newton(&self, excess: f64, modulus: f64) -> Parted {
        let mut s = self.of_flow(excess.ln() - modulus.ln()).min(excess);
        if s == 0.0 {
            return Parted { flow: excess / modulus, overstress: 0.0, share: 1.0 };
        }
        let taken = |s: f64| (self.logarithm_of_flow(s) + modulus.ln()).exp();
        for _ in 0..MOST_ITERATIONS {
            let by_flow = taken(s);
            let change = (s + by_flow - excess) / (1.0 + self.exponent_at(s) * by_flow / s);
            // Rounding may reverse its sign at the root.
            if change.is_nan() || change <= 0.5 * f64::EPSILON * s {
                break;
            }
            s -= change;
        }
        let by_flow = taken(s);
        let slope = self.exponent_at(s) * by_flow;
        let share = if by_flow > 0.0 { slope / (s + slope) } else { 0.0 };
        Parted { flow: by_flow / modulus, overstress: s, share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excess_is_split_for_all_magnitudes() {
        for exponent in [1.0, 1.5, 3.0, 5.0, 12.0, 50.0] {
            for beta in [-700.0, -300.0, -30.0, -3.0, -1e-9, 0.0, 1e-9, 2.0, 40.0, 300.0, 3e3, 1e5]
            {
                for (excess, modulus) in [(1e8, 2e11), (1e-3, 1e3), (1e40, 1e50)] {
                    let (e, m): (f64, f64) = (excess, modulus);
                    let logarithm = beta - m.ln() - (exponent - 1.0) * e.ln();
                    let law = Overstress { logarithm, exponent, breakdown: f64::INFINITY };
                    let Parted { flow, overstress, share } = law.part(e, m);
                    let sum = overstress + m * flow;
                    assert!((sum / e - 1.0).abs() < 1e-13, "{exponent} {beta}: {sum} {e}");
                    assert!(flow >= 0.0 && overstress >= 0.0 && (0.0..=1.0).contains(&share));
                    // ln γ = ln c + n ln s
                    if flow > 0.0 && overstress > 0.0 {
                        let off = flow.ln() - logarithm - exponent * overstress.ln();
                        assert!(
                            off.abs() < 1e-11 * (1.0 + logarithm.abs()),
                            "{exponent} {beta}: {off}"
                        );
                    }
                    // The share is the slope of the flow.
                    let h = 1e-5 * e;
                    let slope = m * (law.part(e + h, m).flow - law.part(e - h, m).flow) / (2.0 * h);
                    assert!((slope - share).abs() < 1e-6, "{exponent} {beta}: {slope} {share}");
                }
            }
        }
        let at_once = Overstress::NONE.part(3.0, 2.0);
        assert_eq!(at_once, Parted { flow: 1.5, overstress: 0.0, share: 1.0 });
        let stiff = Overstress { logarithm: f64::NEG_INFINITY, ..Overstress::NONE };
        let never = stiff.part(3.0, 2.0);
        assert_eq!(never, Parted { flow: 0.0, overstress: 3.0, share: 0.0 });
    }

    #[test]
    fn breakdown_is_split_for_all_magnitudes() {
        for exponent in [1.0, 3.0, 7.0, 50.0] {
            for logarithm in [-800.0, -100.0, -30.0, 0.0, 30.0, 300.0, 1e5] {
                for (e, m) in [(1e8, 2e11), (1e-3, 1e3), (1e40, 1e50)] {
                    for part in [1e-4, 1e-2, 1.0, 1e2, 1e6, 1e200] {
                        let breakdown = part * e;
                        let law = Overstress { logarithm, exponent, breakdown };
                        let Parted { flow, overstress, share } = law.part(e, m);
                        let case = format!("{exponent} {logarithm} {e} {breakdown}");
                        let sum = overstress + m * flow;
                        let logarithms = logarithm.abs()
                            + exponent * overstress.max(f64::MIN_POSITIVE).ln().abs();
                        let rounding = 1e-15 * (1.0 + law.exponent_at(overstress) + logarithms);
                        assert!((sum / e - 1.0).abs() < 1e-13 + rounding, "{case}: {sum}");
                        assert!(
                            flow >= 0.0 && overstress >= 0.0 && (0.0..=1.0).contains(&share),
                            "{case}"
                        );
                        let h = 1e-5 * e;
                        let slope =
                            m * (law.part(e + h, m).flow - law.part(e - h, m).flow) / (2.0 * h);
                        assert!((slope - share).abs() < 1e-5, "{case}: {slope} {share}");
                        if overstress == 0.0 {
                            continue;
                        }
                        let found = law.of_flow(law.logarithm_of_flow(overstress));
                        assert!(
                            (found / overstress - 1.0).abs() < 1e-9,
                            "{case}: {found} {overstress}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn breakdown_far_above_the_stress_is_a_power_law() {
        let power = Overstress { logarithm: -80.0, exponent: 5.0, breakdown: f64::INFINITY };
        let far = Overstress { breakdown: 1e14, ..power };
        let [power, far] = [power, far].map(|law| law.part(1e8, 2e11));
        assert!((far.flow / power.flow - 1.0).abs() < 1e-10);
        assert!((far.share / power.share - 1.0).abs() < 1e-10);
    }
}
