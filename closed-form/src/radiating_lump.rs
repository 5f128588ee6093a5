//! A body of one temperature that radiates to its surroundings: `C Ṫ = ε σ A (T∞⁴ − T⁴)`.
//!
//! Source: F. P. Incropera et al., *Fundamentals of Heat and Mass Transfer*, 7th ed., Wiley 2011, §5.3.

/// Stefan's and Boltzmann's constant σ [W/(m² K⁴)], CODATA 2018.
const STEFAN_BOLTZMANN: f64 = 5.670374419e-8;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadiatingLump {
    /// Heat capacity per surface area, C/A [J/(m² K)].
    pub capacity: f64,
    /// Emissivity ε [1].
    pub emissivity: f64,
    /// Temperature at time 0 [K].
    pub initial: f64,
    /// Temperature of the surroundings T∞ [K].
    pub ambient: f64,
}

impl RadiatingLump {
    /// Temperature [K] at a time [s]: `(T₀⁻³ + 3εσAt/C)^{−1/3}` for surroundings at 0 K, otherwise by bisection.
    pub fn temperature(&self, t: f64) -> f64 {
        if self.ambient == 0.0 {
            let rate = 3.0 * self.emissivity * STEFAN_BOLTZMANN / self.capacity;
            return (self.initial.powi(-3) + rate * t).powf(-1.0 / 3.0);
        }
        let (mut near, mut far) = (self.initial, self.ambient);
        for _ in 0..200 {
            let middle = 0.5 * (near + far);
            if self.time(middle) < t { near = middle } else { far = middle }
        }
        0.5 * (near + far)
    }

    /// Time [s] at which the body reaches a temperature between the initial one and that of its surroundings [K], above
    /// 0.
    ///
    /// `t = C/(4εσA T∞³) [F(T/T∞) − F(T₀/T∞)]`, `F(x) = ln|(1 + x)/(1 − x)| + 2 atan x`.
    pub fn time(&self, temperature: f64) -> f64 {
        let of = |t: f64| {
            let x = t / self.ambient;
            ((1.0 + x) / (1.0 - x)).abs().ln() + 2.0 * x.atan()
        };
        let cubed = self.ambient.powi(3);
        let scale = self.capacity / (4.0 * self.emissivity * STEFAN_BOLTZMANN * cubed);
        scale * (of(temperature) - of(self.initial))
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::*;

    #[test]
    fn heat_balances_at_every_time() {
        for (initial, ambient) in [(1500.0, 0.0), (1500.0, 300.0), (300.0, 900.0)] {
            let lump = RadiatingLump { capacity: 4e3, emissivity: 0.7, initial, ambient };
            assert_close(lump.temperature(0.0), initial, 1e-12);
            for t in [1.0, 30.0, 200.0] {
                let now = lump.temperature(t);
                let flux = 0.7 * STEFAN_BOLTZMANN * (ambient.powi(4) - now.powi(4));
                let rate = derivative(|t| lump.temperature(t), t, 0.02 * t);
                assert_close(4e3 * rate, flux, 1e-6);
            }
        }
    }
}
