//! The flow curve of a fluid at one temperature.

use super::{FluidLaw, Newtonian, Shear, ShearLaw};

/// Shear stress τ [Pa] over the shear rate γ̇ [1/s] at one temperature: `τ = τ_y + f τ_v(γ̇)`, with the yield stress
/// τ_y and the viscous stress τ_v of a law and the factor f of the temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowCurve {
    law: FluidLaw,
    factor: f64,
}

/// Change of the logarithm of the rate below which another step of Newton's method would change no digit: the error
/// after this step is its square times some tens.
const CLOSE: f64 = 1e-9;
/// Largest number of iterations; bisection alone needs 64.
const MOST_ITERATIONS: usize = 200;

impl FlowCurve {
    /// The flow curve of a law whose viscous stress is multiplied by a factor.
    pub const fn new(law: FluidLaw, factor: f64) -> Self {
        Self { law, factor }
    }

    /// The flow curve of a Newtonian fluid of a viscosity [Pa s].
    pub const fn newtonian(value: f64) -> Self {
        Self::new(FluidLaw::Newtonian(Newtonian { value }), 1.0)
    }

    #[inline]
    fn viscous(&self, rate: f64) -> Shear {
        let Shear { secant, tangent } = self.law.viscous(rate);
        Shear { secant: self.factor * secant, tangent: self.factor * tangent }
    }

    /// Yield stress τ_y [Pa].
    #[inline]
    pub fn yield_stress(&self) -> f64 {
        self.law.yield_stress()
    }

    /// Stress τ at a shear rate [1/s]; at rest the yield stress, which the stress of resting fluid does not exceed
    /// [Pa].
    #[inline]
    pub fn stress(&self, rate: f64) -> f64 {
        let viscous = if rate > 0.0 { self.viscous(rate).secant * rate } else { 0.0 };
        self.yield_stress() + viscous
    }

    /// Secant viscosity `τ/γ̇` [Pa s], finite at positive rates; at rest its limit, which is infinite beyond a yield
    /// stress and for fluids that thin without a plateau.
    #[inline]
    pub fn viscosity(&self, rate: f64) -> f64 {
        let yielding = self.yield_stress();
        let plastic = if yielding > 0.0 { yielding / rate } else { 0.0 };
        plastic + self.viscous(rate).secant
    }

    /// Slope `dτ/dγ̇` [Pa s] at a shear rate; at rest its limit.
    #[inline]
    pub fn tangent(&self, rate: f64) -> f64 {
        self.viscous(rate).tangent
    }

    /// Rate [1/s] at which the secant viscosity has a minimum, if it is not monotone.
    pub fn thinnest_rate(&self) -> Option<f64> {
        self.law.thinnest_rate(self.factor)
    }

    /// Shear rate γ̇ [1/s] at which `τ(γ̇) + p γ̇` equals a load [Pa], with a penalty p ≥ 0 [Pa s]; 0 if the load is no
    /// larger than the yield stress. It grows with the load.
    pub fn rate_beyond(&self, load: f64, penalty: f64) -> f64 {
        let beyond = load - self.yield_stress();
        if beyond <= 0.0 { 0.0 } else { self.rate_under(beyond, penalty) }
    }

    /// The rate under a load beyond the yield stress [Pa], accurate to 1e-12.
    ///
    /// It is the root of an increasing function. Newton's method takes it in logarithms, where the slope lies between 1
    /// and the exponent of the law; bisection takes over where its steps leave the bracket or shrink too slowly.
    fn rate_under(&self, beyond: f64, penalty: f64) -> f64 {
        let [mut low, mut high] = [f64::MIN_POSITIVE, f64::MAX];
        let mut rate = (beyond / (self.viscous(1.0).secant + penalty)).clamp(low, high);
        let mut previous = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let Shear { secant, tangent } = self.viscous(rate);
            let resistance = secant + penalty;
            let excess = (resistance * (rate / beyond)).ln();
            let step = -excess / ((tangent + penalty) / resistance);
            let next = rate * step.exp();
            // At the ends of the range of numbers the slope may overflow before the stress does.
            if (step.abs() <= CLOSE && tangent.is_finite()) || beyond.is_nan() {
                return next;
            }
            let is_above = excess > 0.0;
            (low, high) = if is_above { (low, rate) } else { (rate, high) };
            let is_slow = step.abs() > 0.5 * previous;
            (rate, previous) = if low < next && next < high && !is_slow {
                (next, step.abs())
            } else {
                // The middle of the logarithms.
                (low.sqrt() * high.sqrt(), f64::INFINITY)
            };
        }
        rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::fluid::viscosity::{Bingham, CarreauYasuda, HerschelBulkley, Power};

    /// Curves of every law, also at the ends of their exponents.
    fn curves() -> Vec<FlowCurve> {
        let power = |exponent| FluidLaw::Power(Power { consistency: 20.0, exponent });
        let paste = |exponent| {
            let (yield_stress, consistency) = (50.0, 20.0);
            FluidLaw::HerschelBulkley(HerschelBulkley { yield_stress, consistency, exponent })
        };
        let melt = |zero_shear, exponent, transition| {
            let (infinite_shear, time) = (1e-3, 0.5);
            FluidLaw::CarreauYasuda(CarreauYasuda {
                zero_shear,
                infinite_shear,
                time,
                exponent,
                transition,
            })
        };
        let laws = [
            FluidLaw::Newtonian(Newtonian { value: 1e-3 }),
            FluidLaw::Bingham(Bingham { yield_stress: 50.0, plastic_viscosity: 1.0 }),
            power(0.05),
            power(0.6),
            power(1.0),
            power(3.0),
            paste(0.05),
            paste(0.6),
            paste(3.0),
            melt(10.0, 0.4, 2.0),
            melt(1e6, 0.02, 0.3),
            melt(1e6, 0.02, 60.0),
            melt(1e-5, 0.3, 2.0),
        ];
        let factors = [1e-3, 1.0, 1e3];
        laws.iter().flat_map(|&law| factors.map(|factor| FlowCurve::new(law, factor))).collect()
    }

    fn decades(from: i32, to: i32) -> impl Iterator<Item = f64> {
        (4 * from..=4 * to).map(|n| 10_f64.powf(0.25 * f64::from(n)))
    }

    #[test]
    fn tangents_are_the_slopes_of_the_stress() {
        for curve in curves() {
            for rate in decades(-6, 6) {
                let d = 1e-5 * rate;
                // Without the yield stress, whose digits would hide those of the slope.
                let viscous = |rate: f64| curve.viscous(rate).secant * rate;
                let slope = (viscous(rate + d) - viscous(rate - d)) / (2.0 * d);
                let tangent = curve.tangent(rate);
                assert!(
                    (slope / tangent - 1.0).abs() < 1e-6,
                    "{curve:?} {rate}: {slope} {tangent}"
                );
            }
        }
    }

    #[test]
    fn viscosity_is_the_stress_over_the_rate() {
        for curve in curves() {
            for rate in decades(-9, 9) {
                let ratio = curve.viscosity(rate) * rate / curve.stress(rate);
                assert!((ratio - 1.0).abs() < 1e-13 && curve.viscosity(rate).is_finite());
            }
            assert_eq!(curve.stress(0.0), curve.yield_stress());
        }
        let newtonian = FlowCurve::newtonian(1.7e-3);
        assert_eq!([0.0, 1e-300, 3.0].map(|rate| newtonian.viscosity(rate)), [1.7e-3; 3]);
    }

    /// `k γ̇^(n−1) + τ_y/γ̇` of the paste with τ_y = k = n = 0.5 at 1e-3 /s.
    #[test]
    fn stiff_paste_near_rest() {
        let law = HerschelBulkley { yield_stress: 0.5, consistency: 0.5, exponent: 0.5 };
        let found = FlowCurve::new(FluidLaw::HerschelBulkley(law), 1.0).viscosity(1e-3);
        assert!((found - 515.811_388_300_8).abs() < 1e-9, "{found}");
    }

    #[test]
    fn rates_beyond_yield_are_the_inverse_over_twelve_decades() {
        for curve in curves() {
            for penalty in [0.0, 1e-6, 1.0, 1e6] {
                for rate in decades(-6, 6) {
                    let resistance = curve.viscous(rate).secant + penalty;
                    let found = curve.rate_under(resistance * rate, penalty);
                    let slope = (curve.tangent(rate) + penalty) / resistance;
                    let (error, allowed) = ((found / rate).ln(), 1e-13 + 3e-15 / slope);
                    assert!(error.abs() < allowed, "{curve:?} {penalty} {rate}: {found} {error:e}");
                }
            }
        }
    }

    #[test]
    fn loads_beyond_yield_are_taken_from_it() {
        for curve in curves() {
            let load = 1.5 * curve.yield_stress() + 3.0;
            let rate = curve.rate_beyond(load, 2.0);
            assert!(((curve.stress(rate) + 2.0 * rate) / load - 1.0).abs() < 1e-12, "{curve:?}");
        }
    }

    #[test]
    fn loads_up_to_yield_leave_fluid_at_rest() {
        for curve in curves() {
            let yielding = curve.yield_stress();
            for load in [-1.0, 0.0, 0.5 * yielding, yielding] {
                assert_eq!(curve.rate_beyond(load, 1.0), 0.0);
            }
        }
    }

    #[test]
    fn rates_grow_with_the_load_at_any_magnitude() {
        for curve in curves() {
            for penalty in [0.0, 1.0] {
                let mut last = 0.0;
                for load in decades(-250, 250) {
                    let rate = curve.rate_beyond(load, penalty);
                    assert!(rate >= last && rate.is_finite(), "{curve:?} {penalty} {load}: {rate}");
                    last = rate;
                }
            }
            assert!(curve.rate_beyond(f64::NAN, 1.0).is_nan());
        }
    }
}
