//! Evaporation of a fluid into still air.

use std::f64::consts::{FRAC_2_PI, PI};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::laws::GAS_CONSTANT;
use crate::limits::{plausible, positive, within};

/// Constants of a fluid's vapour, from which the rate follows at which a drop would evaporate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evaporation {
    /// Heat that evaporation takes between 298 K and the boiling point, in the mean, L [J/kg].
    #[schemars(transform = positive("J/kg", "the heat of evaporation").plausible(&plausible::EVAPORATION_HEAT))]
    pub latent_heat: f64,
    /// Mass of a mole, M [kg/mol].
    #[schemars(transform = within(1e-3, 10.0, "kg/mol", "the molar mass").plausible(&plausible::MOLAR_MASS))]
    pub molar_mass: f64,
    /// Diffusivity of the vapour in air at 298 K, D [m²/s].
    #[schemars(transform = within(1e-8, 1e-2, "m²/s", "the diffusivity of the vapour")
        .plausible(&plausible::VAPOUR_DIFFUSIVITY))]
    pub diffusivity: f64,
}

/// Atmospheric pressure [Pa].
const ATMOSPHERE: f64 = 101_325.0;
/// Temperature to which diffusivities refer [K].
const ROOM: f64 = 298.15;

impl Evaporation {
    /// Density of the saturated vapour `p M/(R T)` at a temperature T [K], kg/m³, with the pressure that follows from
    /// the boiling point T_b [K], `p = p₀ exp(−(L M/R)(1/T − 1/T_b))` (Clausius and Clapeyron, L constant).
    pub fn saturated_density(&self, temperature: f64, boils_at: f64) -> f64 {
        let activation = self.latent_heat * self.molar_mass / GAS_CONSTANT;
        let pressure = ATMOSPHERE * (activation * (1.0 / boils_at - 1.0 / temperature)).exp();
        pressure * self.molar_mass / (GAS_CONSTANT * temperature)
    }

    /// Diffusivity of the vapour at a temperature T [K], m²/s, which grows with T^1.75 (E. N. Fuller, P. D. Schettler &
    /// J. C. Giddings 1966, doi 10.1021/ie50677a007).
    pub fn diffusivity_at(&self, temperature: f64) -> f64 {
        self.diffusivity * (temperature / ROOM).powf(1.75)
    }

    /// Rate at which a drop at rest evaporates into dry, still air, `2π R D c f(θ)` [kg/s], limited by diffusion: R [m]
    /// is the radius of the sphere of which the drop is a cap, c the saturated density at its temperature [K], θ its
    /// contact angle [rad] (R. G. Picknett & R. Bexon 1977, doi 10.1016/0021-9797(77)90396-4).
    pub fn rate(&self, cap: SphericalCap, temperature: f64, boils_at: f64) -> f64 {
        let density = self.saturated_density(temperature, boils_at);
        2.0 * PI * cap.radius * self.diffusivity_at(temperature) * density * cap.shape()
    }
}

/// A drop at rest on a plane, a cap of a sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphericalCap {
    /// Radius of the sphere, R [m].
    pub radius: f64,
    /// Contact angle, θ [rad].
    pub angle: f64,
}

impl SphericalCap {
    /// The cap of a volume [m³] and a contact angle [rad], `V = π R³ (1 − cos θ)² (2 + cos θ)/3`.
    pub fn of_volume(volume: f64, angle: f64) -> Self {
        let cosine = angle.cos();
        let unit = PI * (1.0 - cosine).powi(2) * (2.0 + cosine) / 3.0;
        Self { radius: (volume / unit).cbrt(), angle }
    }

    /// f(θ), 1 for half a sphere and 2 ln 2 for a sphere that touches the plane; accurate to 0.2 % (ibid.).
    fn shape(&self) -> f64 {
        let angle = self.angle;
        if angle < 0.175 {
            return angle * (FRAC_2_PI + angle * (0.09591 - 0.06144 * angle));
        }
        8.957e-5 + angle * (0.6333 + angle * (0.116 + angle * (-0.08878 + 0.01033 * angle)))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::LN_2;

    use super::*;

    const WATER: Evaporation =
        Evaporation { latent_heat: 2.35e6, molar_mass: 0.018015, diffusivity: 2.5e-5 };

    #[test]
    fn water_has_its_vapour_pressure() {
        // IAPWS-95: 3169.9 Pa at 298.15 K, 12 352 Pa at 323.15 K, 47 415 Pa at 353.15 K.
        for (temperature, pressure) in [(298.15, 3169.9), (323.15, 12_352.0), (353.15, 47_415.0)] {
            let density = WATER.saturated_density(temperature, 373.12);
            let found = density * GAS_CONSTANT * temperature / WATER.molar_mass;
            assert!((found / pressure - 1.0).abs() < 0.05, "{temperature} K: {found} Pa");
        }
    }

    #[test]
    fn caps_have_closed_forms() {
        // Half a sphere: 2π R D c; a sphere on a plane: 4π ln 2 R D c; a flat disc of radius a: 4 a D c.
        let shape = |angle| SphericalCap { radius: 1.0, angle }.shape();
        assert!((shape(PI / 2.0) - 1.0).abs() < 1e-3);
        assert!((shape(PI) - 2.0 * LN_2).abs() < 3e-3);
        let flat = 1e-3;
        assert!((shape(flat) / flat - 2.0 / PI).abs() < 1e-3);
        // Either branch holds where they meet.
        assert!((shape(0.175 - 1e-9) / shape(0.175) - 1.0).abs() < 2e-3);
        let half = SphericalCap::of_volume(2.0 * PI / 3.0, PI / 2.0);
        assert!((half.radius - 1.0).abs() < 1e-12);
    }
}
