//! The coldest and the hottest place of a fluid.

use super::DropletSph;

/// A place of a fluid [m] and its temperature [K].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WarmPlace {
    pub temperature: f64,
    pub place: [f64; 3],
}

impl WarmPlace {
    /// Returns the coldest and the hottest of some places; `None` if there is none.
    pub fn extremes(places: impl Iterator<Item = Self> + Clone) -> Option<[Self; 2]> {
        let by = |a: &Self, b: &Self| a.temperature.total_cmp(&b.temperature);
        Some([places.clone().min_by(by)?, places.max_by(by)?])
    }
}

impl DropletSph {
    /// The coldest and the hottest particle; `None` before the first drop.
    pub fn extremes(&self, state: &[f64]) -> Option<[WarmPlace; 2]> {
        let cloud = self.cloud(state);
        let reference = self.reference_temperature();
        let particle = |i: usize| {
            let mut place = cloud.position[i];
            self.method.images.wrap(&mut place);
            WarmPlace {
                temperature: cloud.temperature[i] + reference,
                place: place.map(|x| x * self.method.units.length),
            }
        };
        WarmPlace::extremes((0..cloud.len()).map(particle))
    }
}
