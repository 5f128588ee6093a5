//! The surface below a fluid: its temperature over a step, and its response to heat.

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
/// Smallest s√t for the longest time, and largest s√t for the shortest time, in that sum.
const REACH: [f64; 2] = [0.05, 30.0];

impl SurfaceResponse {
    /// Response of a half space of effusivity `e = √(kρc)` [W √s/(m² K)], for times [s] between two
    /// bounds.
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
        // Slow omitted terms hardly decay; fast ones end at once, with their sum of g/λ.
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

    /// Rise under a constant flux of 1 W/m², after a time [s] [K].
    pub fn of_held_flux(&self, time: f64) -> f64 {
        let weights = |rate: f64| exponential::weights(rate * time);
        self.terms().map(|(rate, gain)| gain * time * weights(rate)[1]).sum()
    }

    /// Rise after a time [s] under a flux that falls linearly from 1 to −1 W/m² [K]; it is
    /// negative.
    pub fn of_falling_flux(&self, time: f64) -> f64 {
        let weights = |rate: f64| exponential::weights(rate * time);
        let of = |w: [f64; exponential::COUNT]| w[1] - 2.0 * w[2];
        self.terms().map(|(rate, gain)| gain * time * of(weights(rate))).sum()
    }

    /// Rise after a time [s] under a flux that grows by 1 W/m² per second from zero [K].
    pub fn of_growing_flux(&self, time: f64) -> f64 {
        let weights = |rate: f64| exponential::weights(rate * time);
        self.terms().map(|(rate, gain)| gain * time * time * weights(rate)[2]).sum()
    }

    fn terms(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.rates.iter().copied().zip(self.gains.iter().copied())
    }
}

/// Residual heating of the surface of a solid below by past steps, if somebody else computes the
/// solid: amplitudes [K] of the exponentials of its response, cell by cell.
///
/// The solid receives only the mean flux of each step. A constant flux in place of one that falls
/// like 1/√t overestimates the surface's rise by up to 27 % after first contact. The difference
/// between both sets of amplitudes is the error of the temperature that the solid returns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceMemory {
    /// Amplitudes due to the heat as it varied in time.
    pub given: Vec<f64>,
    /// Amplitudes due to the reported mean fluxes, constant over each step.
    pub reported: Vec<f64>,
}

/// A cell of the wall that received heat during a step.
pub struct CellHeat<'a> {
    pub cell: usize,
    /// Total heat per area [J/m²].
    pub heat: f64,
    /// Contribution to the amplitudes of [`SurfaceMemory::given`] at the end [K].
    pub amplitudes: &'a [f64],
}

impl SurfaceMemory {
    /// Memory of cells that have received nothing yet.
    pub fn none(cells: usize, response: &SurfaceResponse) -> Self {
        let zeros = vec![0.0; cells * response.len()];
        Self { given: zeros.clone(), reported: zeros }
    }

    /// Advances the memory by a time [s], with the heat that cells received meanwhile.
    pub fn advance<'a>(
        &mut self,
        response: &SurfaceResponse,
        duration: f64,
        heated: impl Iterator<Item = CellHeat<'a>>,
    ) {
        let count = response.len();
        let weights: Vec<_> =
            response.rates.iter().map(|rate| exponential::weights(rate * duration)).collect();
        for list in [&mut self.given, &mut self.reported] {
            for amplitudes in list.chunks_exact_mut(count) {
                amplitudes.iter_mut().zip(&weights).for_each(|(a, [decay, ..])| *a *= decay);
            }
        }
        for CellHeat { cell, heat, amplitudes } in heated {
            let places = cell * count..(cell + 1) * count;
            self.given[places.clone()].copy_from_slice(amplitudes);
            let terms = self.reported[places].iter_mut().zip(&weights).zip(&response.gains);
            terms.for_each(|((amplitude, [_, mean, ..]), gain)| *amplitude += mean * gain * heat);
        }
    }
}

/// Temperature of the surface over a step of length Δt, without the fluid's heat during the step:
/// `b + Σ_m a_m e^{−λ_m t} + c t/Δt` in every cell of the wall.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Response to the heat of the fluid; empty for a surface of prescribed temperature.
    pub response: SurfaceResponse,
    /// b [K]
    pub base: Vec<f64>,
    /// a [K], cell by cell.
    pub amplitudes: Vec<f64>,
    /// c [K]
    pub drift: Vec<f64>,
}

impl Surface {
    /// Prescribed temperatures.
    pub fn held(temperature: &[f64]) -> Self {
        Self {
            response: SurfaceResponse::default(),
            base: temperature.to_vec(),
            amplitudes: Vec::new(),
            drift: vec![0.0; temperature.len()],
        }
    }

    /// Prescribed temperatures that go from some values to others over a step.
    pub fn following([begin, end]: [&[f64]; 2]) -> Self {
        let drift = begin.iter().zip(end).map(|(begin, end)| end - begin).collect();
        Self { drift, ..Self::held(begin) }
    }

    /// Temperatures that somebody else computed for a solid which received the mean fluxes of all
    /// past steps; they continue as the heat spreads in it.
    pub fn remembered(
        temperature: &[f64],
        response: SurfaceResponse,
        memory: &SurfaceMemory,
    ) -> Self {
        let count = response.len();
        let base = |(cell, temperature): (usize, &f64)| {
            temperature - memory.reported[cell * count..][..count].iter().sum::<f64>()
        };
        Self {
            base: temperature.iter().enumerate().map(base).collect(),
            amplitudes: memory.given.clone(),
            drift: vec![0.0; temperature.len()],
            response,
        }
    }

    /// The same temperatures above another zero [K].
    pub fn above(&self, zero: f64) -> Self {
        Self { base: self.base.iter().map(|base| base - zero).collect(), ..self.clone() }
    }

    /// Returns true if the temperatures change during a step.
    pub fn changes(&self) -> bool {
        self.amplitudes.iter().chain(&self.drift).any(|&change| change != 0.0)
    }

    /// Temperature of each cell after a fraction of a step of this length [s], without heat from
    /// the fluid.
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

    /// Fluxes through each cell [W]: a mean, and a change that falls linearly from its full value
    /// to its opposite. Together they produce, after a time [s], the rises of the surface [K m²]
    /// that the fluid found.
    ///
    /// A flux correct only in its mean overestimates the surface's rise by up to 27 % after first
    /// contact.
    pub fn falling_parts(&self, heat: &[f64], rises: &[f64], duration: f64) -> Vec<f64> {
        let held = self.response.of_held_flux(duration);
        let falling = self.response.of_falling_flux(duration);
        if falling == 0.0 {
            // A surface of prescribed temperature.
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

    /// Rise of a half space of effusivity `e` under a constant flux of 1 W/m² [K]: `2 √(t/π)/e` (H.
    /// S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, Oxford 1959, §2.9 (7)).
    fn half_space_rise(effusivity: f64, time: f64) -> f64 {
        2.0 * (time / PI).sqrt() / effusivity
    }

    #[test]
    fn exponentials_approximate_a_half_space() {
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
    fn memory_corrects_mean_fluxes() {
        // A/√t from time 0 keeps the rise constant at A √π/e; its mean, as a constant flux, ends at
        // 4/π times that.
        let response = SurfaceResponse::of_half_space(1e3, [1e-6, 1e-3]);
        let (step, rise) = (1e-3, 10.0);
        let flux = 2.0 * rise * 1e3 / (PI * step).sqrt();
        let mut memory = SurfaceMemory::none(2, &response);
        let mut given = vec![0.0; response.len()];
        // Both consist of pieces short enough for a uniform flux in each.
        let share = |n: f64| (n / 1e4).sqrt();
        for n in 0..10_000 {
            let part = flux * (share(f64::from(n + 1)) - share(f64::from(n)));
            for (amplitude, (rate, gain)) in given.iter_mut().zip(response.terms()) {
                let [decay, mean, ..] = exponential::weights(rate * 1e-4 * step);
                *amplitude = decay * *amplitude + mean * gain * step * part;
            }
        }
        let heated = CellHeat { cell: 1, heat: flux * step, amplitudes: &given };
        memory.advance(&response, step, [heated].into_iter());
        let found = [300.0, 300.0 + rise * 4.0 / PI];
        let surface = Surface::remembered(&found, response, &memory);
        let [dry, wet] = surface.free(0.0, step)[..] else { unreachable!() };
        assert!((dry - 300.0).abs() < 1e-9, "{dry}");
        assert!((wet - 300.0 - rise).abs() < 0.02 * rise, "{wet}");
        // Then it cools like a surface of prescribed temperature.
        let later = surface.free(3.0, step)[1] - 300.0;
        let exact = rise * 2.0 / PI * (0.5f64).asin();
        assert!((later - exact).abs() < 0.02 * rise, "{later} {exact}");
    }

    #[test]
    fn falling_fluxes_produce_the_prescribed_rise() {
        let response = SurfaceResponse::of_half_space(1e3, [1e-6, 1e-3]);
        let surface = Surface { response, base: vec![0.0], ..Surface::default() };
        // A flux A/√t from time 0 keeps the rise constant at A √π/e.
        let (heat, rise) = (2.0 * 1e-3f64.sqrt(), PI.sqrt() / 1e3);
        let [part] = surface.falling_parts(&[heat], &[rise], 1e-3)[..] else { unreachable!() };
        let mean = heat / 1e-3;
        let share = part / mean;
        assert!((share - 3.0 * (1.0 - 0.25 * PI)).abs() < 0.03, "{share}");
    }
}
