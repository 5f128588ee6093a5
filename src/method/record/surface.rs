//! The surface of the wall at a time within a step.

use crate::port::Surface;

/// A surface at a time within a step, evaluated for a few cells only.
pub struct SurfaceAt<'a> {
    surface: &'a Surface,
    decays: Vec<f64>,
    part: f64,
}

impl<'a> SurfaceAt<'a> {
    pub fn new(surface: &'a Surface, part: f64, duration: f64) -> Self {
        let decay = |rate: &f64| (-rate * part * duration).exp();
        Self { surface, decays: surface.response.rates.iter().map(decay).collect(), part }
    }

    /// Temperature of a cell, without the contributions of the step [K].
    pub fn temperature(&self, cell: usize) -> f64 {
        let Surface { base, amplitudes, drift, .. } = self.surface;
        let count = self.decays.len();
        let amplitudes = &amplitudes[cell * count..][..count];
        let modes: f64 = amplitudes.iter().zip(&self.decays).map(|(a, decay)| a * decay).sum();
        base[cell] + modes + self.part * drift[cell]
    }
}
