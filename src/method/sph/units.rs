//! Units of the computation of droplets: support radius, speed of sound, density at rest.

use super::plan::DropletPlan;

/// Exponent γ of Tait's equation of state.
const STIFFNESS: i32 = 7;

/// Units of length [m], speed [m/s], density [kg/m³]; temperatures stay in kelvin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    pub length: f64,
    pub speed: f64,
    pub density: f64,
    dimension: usize,
}

impl Units {
    pub fn of(plan: &DropletPlan) -> Self {
        Self {
            length: plan.support * plan.spacing,
            speed: plan.fluid.sound_speed,
            density: plan.fluid.density,
            dimension: plan.dimension,
        }
    }

    /// Unit of time [s].
    pub fn time(&self) -> f64 {
        self.length / self.speed
    }

    /// Unit of mass [kg]; in a plane model [kg/m].
    pub fn mass(&self) -> f64 {
        self.density * self.length.powi(self.dimension as i32)
    }

    /// Unit of energy [J]; in a plane model [J/m].
    pub fn energy(&self) -> f64 {
        self.mass() * self.speed * self.speed
    }

    /// Unit of pressure [Pa].
    pub fn pressure(&self) -> f64 {
        self.density * self.speed * self.speed
    }
}

/// Tait's equation of state p = ((1 + r)^γ − 1)/γ for r = ρ/ρ₀ − 1, over ρ₀c₀².
pub fn pressure(r: f64) -> f64 {
    ((1.0 + r).powi(STIFFNESS) - 1.0) / f64::from(STIFFNESS)
}

/// r at a pressure over ρ₀c₀².
pub fn density(pressure: f64) -> f64 {
    let gamma = f64::from(STIFFNESS);
    (1.0 + gamma * pressure).powf(1.0 / gamma) - 1.0
}

/// Elastic energy per mass at r, over c₀²: ∫ p/ρ² dρ.
pub fn compression_energy(r: f64) -> f64 {
    let gamma = f64::from(STIFFNESS);
    let rho = 1.0 + r;
    ((rho.powi(STIFFNESS - 1) - 1.0) / (gamma - 1.0) + 1.0 / rho - 1.0) / gamma
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_is_the_derivative_of_the_energy() {
        for r in [-0.1, -0.01, 0.0, 0.02, 0.2] {
            let step = 1e-6;
            let slope =
                (compression_energy(r + step) - compression_energy(r - step)) / (2.0 * step);
            assert!((slope * (1.0 + r) * (1.0 + r) - pressure(r)).abs() < 1e-9, "{r}");
        }
    }

    #[test]
    fn speed_of_sound_is_one() {
        let step = 1e-6;
        assert!(((pressure(step) - pressure(-step)) / (2.0 * step) - 1.0).abs() < 1e-10);
    }
}
