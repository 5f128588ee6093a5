//! Thermal radiation of a grey surface.

/// Stefan's and Boltzmann's constant σ [W/(m² K⁴)], CODATA 2018.
const STEFAN_BOLTZMANN: f64 = 5.670374419e-8;

/// Radiative flux `ε σ (T∞⁴ − T⁴)` [W/m²] into a grey surface at T from surroundings at T∞ [K].
///
/// The fourth power keeps the sign of its base, so that the flux decreases with T even if an iterate is below 0 K.
pub fn radiative_flux(emissivity: f64, temperature: f64, ambient: f64) -> f64 {
    let fourth = |t: f64| t * t.abs().powi(3);
    emissivity * STEFAN_BOLTZMANN * (fourth(ambient) - fourth(temperature))
}

/// Radiative coefficient `q/(T∞ − T)` [W/(m² K)], also for equal temperatures.
pub fn radiative_coefficient(emissivity: f64, temperature: f64, ambient: f64) -> f64 {
    let squares = temperature.powi(2) + ambient.powi(2);
    emissivity * STEFAN_BOLTZMANN * (temperature + ambient) * squares
}

/// Slope `−∂q/∂T` of the radiative flux [W/(m² K)].
pub fn radiative_slope(emissivity: f64, temperature: f64) -> f64 {
    4.0 * emissivity * STEFAN_BOLTZMANN * temperature.abs().powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_surface_at_1000_k_loses_57_kw_to_empty_space() {
        assert!((radiative_flux(1.0, 1000.0, 0.0) + 56703.74419).abs() < 1e-9);
        assert_eq!(radiative_flux(0.7, 450.0, 450.0), 0.0);
    }

    #[test]
    fn radiative_coefficient_is_consistent_with_flux_and_slope() {
        for [t, ambient] in [[900.0, 300.0], [300.0, 2000.0], [4.0, 300.0]] {
            let flux = radiative_coefficient(0.9, t, ambient) * (ambient - t);
            assert!((flux / radiative_flux(0.9, t, ambient) - 1.0).abs() < 1e-12);
        }
        let same = radiative_coefficient(0.9, 700.0, 700.0) / radiative_slope(0.9, 700.0);
        assert!((same - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_slope_is_that_of_differences() {
        for t in [-50.0, 20.0, 300.0, 2500.0] {
            let difference =
                radiative_flux(0.4, t - 0.01, 300.0) - radiative_flux(0.4, t + 0.01, 300.0);
            assert!((difference / 0.02 / radiative_slope(0.4, t) - 1.0).abs() < 1e-6, "{t}");
        }
    }
}
