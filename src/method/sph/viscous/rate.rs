//! Strain rates and deviatoric stresses of particles, in coordinates y of their fits.

use super::tensor::Products;

/// Divides y into the part of the volume and the rest. With n axes, `y·y = 2 D:D + (tr D)²` is the sum of `γ̇² = 2
/// D′:D′` of the deviator and `(1 + 2/n)(tr D)²`.
#[derive(Debug, Clone, Copy)]
pub struct Axes {
    /// Unit vector of the volume.
    direction: Products,
}

impl Axes {
    /// Coordinates of a model in the plane, or in space.
    pub fn of(dimension: usize) -> Self {
        let unit = 1.0 / (dimension as f64).sqrt();
        let across = if dimension == 3 { unit } else { 0.0 };
        Self { direction: [unit, across, unit, 0.0, 0.0, 0.0] }
    }

    /// Amplitude of the volume's part.
    pub fn volume(&self, y: &Products) -> f64 {
        (0..3).map(|n| self.direction[n] * y[n]).sum()
    }

    /// y without the volume's part.
    pub fn deviator(&self, y: &Products) -> Products {
        let volume = self.volume(y);
        std::array::from_fn(|n| y[n] - volume * self.direction[n])
    }

    /// `a` times the deviator, plus `b` times the part of the volume.
    pub fn scaled(&self, y: &Products, a: f64, b: f64) -> Products {
        let volume = (b - a) * self.volume(y);
        std::array::from_fn(|n| a * y[n] + volume * self.direction[n])
    }
}

/// Length of y: γ̇ of a deviatoric strain rate, τ of a deviatoric stress.
pub fn length(y: &Products) -> f64 {
    y.iter().map(|y| y * y).sum::<f64>().sqrt()
}
