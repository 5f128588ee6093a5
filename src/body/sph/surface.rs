//! The surface of what lies below a fluid: its temperature over a step, and how that answers to heat.

use std::f64::consts::FRAC_2_PI;

use crate::math::exponential;

/// Rise of a surface after an impulse of heat per area, uniform along it: `Σ g_m e^{−λ_m t}` [K m²/J].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceResponse {
    /// λ [1/s]
    pub rates: Vec<f64>,
    /// g [K m²/J]
    pub gains: Vec<f64>,
}

/// Distance of the logarithms of two neighbouring s in the sum for a half space.
const INTERVAL: f64 = 0.5;
/// Least s√t and largest s√t of that sum, for the longest and the shortest time.
const REACH: [f64; 2] = [0.05, 30.0];

impl SurfaceResponse {
    /// Of a half space of effusivity `e = √(kρc)` [W √s/(m² K)], for times [s] between two bounds.
    ///
    /// `1/(e √(πt)) = 2/(πe) ∫ e^{−s²t} ds`, summed at equal distances of ln s; the ends of the sum, which are
    /// geometric series, go to the outermost terms.
    pub fn of_half_space(effusivity: f64, [shortest, longest]: [f64; 2]) -> Self {
        let first = (REACH[0] / longest.sqrt()).ln();
        let last = (REACH[1] / shortest.sqrt()).ln();
        let count = ((last - first) / INTERVAL).ceil() as usize + 1;
        let place = |n: usize| (first + INTERVAL * n as f64).exp();
        let weight = |n: usize| FRAC_2_PI / effusivity * INTERVAL * place(n);
        let mut response = Self {
            rates: (0..count).map(|n| place(n).powi(2)).collect(),
            gains: (0..count).map(weight).collect(),
        };
        // Slow terms left out hardly decay; fast ones are over at once, with their sum of g/λ.
        let rest = 1.0 / (INTERVAL.exp() - 1.0);
        response.gains[0] *= 1.0 + rest;
        response.gains[count - 1] *= 1.0 + rest;
        response
    }

    /// Number of exponentials.
    pub fn len(&self) -> usize {
        self.rates.len()
    }

    pub fn is_empty(&self) -> bool {
        self.rates.is_empty()
    }

    /// Rise after a time [s] under a flux of 1 W/m² [K].
    pub fn of_held_flux(&self, time: f64) -> f64 {
        let weights = |rate: f64| exponential::weights(rate * time);
        self.terms().map(|(rate, gain)| gain * time * weights(rate)[1]).sum()
    }

    /// Rise after a time [s] under a flux that falls evenly from 1 to −1 W/m² [K], and so is negative.
    pub fn of_falling_flux(&self, time: f64) -> f64 {
        let weights = |rate: f64| exponential::weights(rate * time);
        let of = |w: [f64; exponential::COUNT]| w[1] - 2.0 * w[2];
        self.terms().map(|(rate, gain)| gain * time * of(weights(rate))).sum()
    }

    fn terms(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.rates.iter().copied().zip(self.gains.iter().copied())
    }
}

/// Temperature of the surface in the course of a step, without what the fluid gives during it:
/// `b + Σ_m a_m e^{−λ_m t} + c t/Δt` in every cell of the wall, Δt long.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// What the heat of the fluid adds; nothing for a surface whose temperature is held.
    pub response: SurfaceResponse,
    /// b [K]
    pub base: Vec<f64>,
    /// a [K], those of each cell together.
    pub amplitudes: Vec<f64>,
    /// c [K]
    pub drift: Vec<f64>,
}

impl Surface {
    /// Temperatures that nothing changes.
    pub fn held(temperature: &[f64]) -> Self {
        Self {
            response: SurfaceResponse::default(),
            base: temperature.to_vec(),
            amplitudes: Vec::new(),
            drift: vec![0.0; temperature.len()],
        }
    }

    /// Temperatures that stay if the fluxes [W/m²] of the step before go on, and change with fluxes beside these.
    pub fn answering(temperature: &[f64], response: SurfaceResponse, fluxes: &[f64]) -> Self {
        let whole: Vec<f64> = response.terms().map(|(rate, gain)| gain / rate).collect();
        let amplitudes = fluxes.iter().flat_map(|flux| whole.iter().map(move |whole| flux * whole));
        let sum: f64 = whole.iter().sum();
        Self {
            base: temperature.iter().zip(fluxes).map(|(t, flux)| t - flux * sum).collect(),
            amplitudes: amplitudes.collect(),
            drift: vec![0.0; temperature.len()],
            response,
        }
    }

    /// The same with temperatures above another zero [K].
    pub fn above(&self, zero: f64) -> Self {
        Self { base: self.base.iter().map(|base| base - zero).collect(), ..self.clone() }
    }

    /// Whether the temperatures change in the course of a step.
    pub fn changes(&self) -> bool {
        self.amplitudes.iter().chain(&self.drift).any(|&change| change != 0.0)
    }

    /// Temperature of each cell after a part of a step of this length [s], if the fluid gives nothing.
    pub fn free(&self, part: f64, length: f64) -> Vec<f64> {
        let count = self.response.len();
        let decay = |rate: &f64| (-rate * part * length).exp();
        let decays: Vec<f64> = self.response.rates.iter().map(decay).collect();
        let of_cell = |cell: usize| {
            let amplitudes = &self.amplitudes[cell * count..][..count];
            let sum: f64 = amplitudes.iter().zip(&decays).map(|(a, decay)| a * decay).sum();
            self.base[cell] + sum + part * self.drift[cell]
        };
        (0..self.base.len()).map(of_cell).collect()
    }

    /// Fluxes through each cell [W]: a mean, and a change about it that falls evenly from its whole value to
    /// its opposite, such that after a time [s] the surface has the rises [K m²] that the fluid found.
    ///
    /// A flux that is only right in its mean leaves the surface up to 27 % too warm after first contact.
    pub fn falling_parts(&self, heat: &[f64], rises: &[f64], duration: f64) -> Vec<f64> {
        let held = self.response.of_held_flux(duration);
        let falling = self.response.of_falling_flux(duration);
        if falling == 0.0 {
            // A surface whose temperature is prescribed.
            return vec![0.0; heat.len()];
        }
        let part = |(heat, rise): (&f64, &f64)| (rise - heat / duration * held) / falling;
        heat.iter().zip(rises).map(part).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Rise of a half space of effusivity `e` under a flux of 1 W/m² that is held [K]: `2 √(t/π)/e` (H. S. Carslaw
    /// and J. C. Jaeger, *Conduction of Heat in Solids*, Oxford 1959, §2.9 (7)).
    fn half_space_rise(effusivity: f64, time: f64) -> f64 {
        2.0 * (time / PI).sqrt() / effusivity
    }

    #[test]
    fn exponentials_sum_to_a_half_space() {
        for [shortest, longest] in [[1e-9, 1e-9], [1e-9, 1e-6], [1e-3, 10.0]] {
            let response = SurfaceResponse::of_half_space(6e3, [shortest, longest]);
            let mut time = shortest;
            while time <= longest {
                let exact = half_space_rise(6e3, time);
                let found = response.of_held_flux(time);
                assert!((found / exact - 1.0).abs() < 0.01, "{time}: {found} {exact}");
                // ∫ (1 − 2s/t)/√(t − s) ds = −(2/3) √t.
                let falling = response.of_falling_flux(time) / exact;
                assert!((falling + 1.0 / 3.0).abs() < 0.01, "{time}: {falling}");
                time *= 3.0;
            }
            assert!(response.len() < 60);
        }
    }

    #[test]
    fn fluxes_that_go_on_keep_the_temperature() {
        let response = SurfaceResponse::of_half_space(1e3, [1e-6, 1e-3]);
        let surface = Surface::answering(&[300.0, 350.0], response.clone(), &[2e5, -1e5]);
        let rise = response.of_held_flux(1e-3);
        let end = surface.free(1.0, 1e-3);
        for ((end, start), flux) in end.iter().zip([300.0, 350.0]).zip([2e5, -1e5]) {
            assert!((end + flux * rise - start).abs() < 1e-9 * flux.abs() * rise);
        }
    }

    #[test]
    fn parts_that_fall_give_the_rise_asked_for() {
        let response = SurfaceResponse::of_half_space(1e3, [1e-6, 1e-3]);
        let surface = Surface { response, base: vec![0.0], ..Surface::default() };
        // A flux A/√t from a time 0 on keeps the rise A √π/e.
        let (heat, rise) = (2.0 * 1e-3f64.sqrt(), PI.sqrt() / 1e3);
        let [part] = surface.falling_parts(&[heat], &[rise], 1e-3)[..] else { unreachable!() };
        let mean = heat / 1e-3;
        let share = part / mean;
        assert!((share - 3.0 * (1.0 - 0.25 * PI)).abs() < 0.03, "{share}");
    }
}
