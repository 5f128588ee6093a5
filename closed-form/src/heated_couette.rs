//! Couette flow between plates of different temperatures, of a fluid whose viscosity falls exponentially.
//!
//! The plates lie at y = 0, at rest, and y = H, moving at U; the temperature is linear between them, so that
//! `µ = µ₀ e^{−By/H}`. The shear stress is uniform: `u/U = (e^{By/H} − 1)/(e^B − 1)`, `τ = µ₀U/H · B/(e^B − 1)`.
//! Exact for steady flow with constant conductivity and negligible viscous heating (`µU² ≪ k ΔT`).
//!
//! Source: R. B. Bird, W. E. Stewart and E. N. Lightfoot, *Transport Phenomena*, 2nd ed., Wiley 2007, example 2.2-2,
//! has the same law of viscosity in a falling film; the flow follows from `µ du/dy = τ`.

/// The gap and its fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatedCouette {
    /// Gap H [m].
    pub gap: f64,
    /// Speed U of the upper plate [m/s].
    pub speed: f64,
    /// Viscosity µ₀ at the plate at rest [Pa s].
    pub viscosity: f64,
    /// Logarithm B of the viscosity at rest over that at the moving plate [1].
    pub contrast: f64,
}

impl HeatedCouette {
    /// Viscosity µ [Pa s] at the height y.
    pub fn viscosity(&self, y: f64) -> f64 {
        self.viscosity * (-self.contrast * y / self.gap).exp()
    }

    /// Velocity u [m/s] at the height y.
    pub fn velocity(&self, y: f64) -> f64 {
        let part = y / self.gap;
        if self.contrast == 0.0 {
            return self.speed * part;
        }
        self.speed * (self.contrast * part).exp_m1() / self.contrast.exp_m1()
    }

    /// Shear stress τ [Pa].
    pub fn shear(&self) -> f64 {
        let factor =
            if self.contrast == 0.0 { 1.0 } else { self.contrast / self.contrast.exp_m1() };
        self.viscosity * self.speed / self.gap * factor
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::super::quadrature::integrate;
    use super::*;

    const FLOW: HeatedCouette =
        HeatedCouette { gap: 1.0, speed: 1.0, viscosity: 1.0, contrast: 2.0 };

    #[test]
    fn digits_for_a_contrast_of_two() {
        assert_close(FLOW.velocity(0.5), 0.268941, 2e-6);
        assert_close(FLOW.shear(), 0.313035, 2e-6);
    }

    #[test]
    fn stress_is_uniform_and_speed_its_integral() {
        let flow = HeatedCouette { gap: 0.02, speed: 0.3, viscosity: 5.0, contrast: -1.3 };
        for y in [0.001, 0.01, 0.019] {
            let rate = derivative(|y| flow.velocity(y), y, 1e-4);
            assert_close(flow.viscosity(y) * rate, flow.shear(), 1e-9);
        }
        let speed = integrate(|y| flow.shear() / flow.viscosity(y), &[0.0, flow.gap]);
        assert_close(speed, flow.speed, 1e-11);
    }

    #[test]
    fn equal_temperatures_give_linear_flow() {
        let almost = HeatedCouette { contrast: 1e-9, ..FLOW };
        let equal = HeatedCouette { contrast: 0.0, ..FLOW };
        assert_eq!([equal.velocity(0.3), equal.shear()], [0.3, 1.0]);
        assert_close(almost.velocity(0.3), 0.3, 1e-8);
        assert_close(almost.shear(), 1.0, 1e-8);
    }
}
