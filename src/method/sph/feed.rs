//! Fluid that comes from a nozzle.
//!
//! Above the outlet stands a column of layers, as wide as the outlet and one particle thick, which moves with the
//! nozzle and down with the mean speed of the flow: the nozzle holds its particles, and takes up all forces on them. A
//! layer holds the volume A Δx of the section A. The centre of layer k is `((k + ½) A Δx − V)/A` above the outlet once
//! the volume V has come. When it passes the outlet its particles are free, and another layer joins on top. So the
//! volume of what is free is V to half a layer, and pressure at the outlet is that of the fluid which the column
//! pushes.
//!
//! The column reaches farther than the kernel, so particles at the outlet do not see its upper end.

use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::slice::from_mut;

use super::plan::{DropletPlan, Feed};
use super::units::Units;
use crate::state::{Field, Per};

/// Holds on a particle, as numbers of its state: none, that of the nozzle, that of sleep.
pub const FREE: f64 = 0.0;
pub const BY_NOZZLE: f64 = 1.0;
pub const ASLEEP: f64 = 2.0;

/// Part of a layer that counts as rounding of the volume.
const SLACK: f64 = 1e-9;
/// Angle by which each ring of a layer is turned against the one inside [rad]: the golden angle, so that no ray has all
/// their particles.
const TURN: f64 = PI * (3.0 - 2.236_067_977_499_79);

/// The column of a nozzle.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Places about the axis over H, and masses over ρ₀H³, of the particles of a layer.
    pub places: Vec<([f64; 2], f64)>,
    /// Number of layers.
    pub layers: usize,
    /// Section of the outlet [m²], and thickness of a layer [m].
    pub section: f64,
    pub thickness: f64,
}

impl Column {
    pub fn of(plan: &DropletPlan, feed: &Feed, units: &Units) -> Self {
        let section = FRAC_PI_4 * feed.diameter.powi(2);
        let layer = plan.spacing * section * units.density / units.mass();
        let places = rings(feed.diameter, plan.spacing);
        let places = places
            .into_iter()
            .map(|(place, share)| (place.map(|x| x / units.length), layer * share));
        Self {
            places: places.collect(),
            layers: plan.support.ceil() as usize + 1,
            section,
            thickness: plan.spacing,
        }
    }

    /// Volume of a layer [m³].
    pub fn layer_volume(&self) -> f64 {
        self.section * self.thickness
    }

    /// Mass of a layer over ρ₀H³.
    pub fn layer_mass(&self) -> f64 {
        self.places.iter().map(|place| place.1).sum()
    }

    /// Height of the centre of a layer above the outlet once a volume has come [m].
    pub fn height(&self, layer: usize, volume: f64) -> f64 {
        (layer as f64 + 0.5) * self.thickness - volume / self.section
    }

    /// Number of layers that have passed the outlet once a volume has come [m³].
    pub fn passed(&self, volume: f64) -> usize {
        (volume / self.layer_volume() + 0.5 + SLACK).floor() as usize
    }

    /// Volume at which a layer passes the outlet [m³].
    pub fn passage(&self, layer: usize) -> f64 {
        (layer as f64 + 0.5) * self.layer_volume()
    }
}

/// Places in a circle of a diameter about the origin, each on about the square of the spacing, and their shares of its
/// area: rings of equal width, each with as many places as its length has.
fn rings(diameter: f64, spacing: f64) -> Vec<([f64; 2], f64)> {
    let count = (0.5 * diameter / spacing).round().max(1.0);
    let width = 0.5 * diameter / count;
    let of_ring = |n: usize| {
        let middle = n as f64 + 0.5;
        let places = (TAU * middle).round();
        let share = 2.0 * middle / (count * count) / places;
        (0..places as usize).map(move |k| {
            let angle = TAU * k as f64 / places + TURN * n as f64;
            ([width * middle * angle.cos(), width * middle * angle.sin()], share)
        })
    };
    (0..count as usize).flat_map(of_ring).collect()
}

/// Part of a state that concerns a nozzle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fed {
    /// Volume that has come [m³].
    pub volume: f64,
    /// Place of the outlet [m].
    pub nozzle: [f64; 3],
    /// Impulse that the nozzle gave to the fluid [N s].
    pub impulse: [f64; 3],
    /// Largest jump of the nozzle while fluid came [m].
    pub jump: f64,
    /// 1 while fluid comes, 0 otherwise.
    pub flowing: f64,
    /// 1 if the nozzle has approached a place that an input set without derivatives, 0 otherwise.
    pub late: f64,
}

impl Fed {
    pub fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let body = |name, words, width| Field { name, words, per: Per::Body, width };
        vec![
            (body("volume", "volume that has come [m³]", 1), from_mut(&mut self.volume)),
            (body("nozzle", "place of the outlet [m]", 3), &mut self.nozzle),
            (body("impulse_of_nozzle", "impulse of the nozzle [N s]", 3), &mut self.impulse),
            (body("jump", "largest jump of the nozzle [m]", 1), from_mut(&mut self.jump)),
            (body("flowing", "1 while fluid comes", 1), from_mut(&mut self.flowing)),
            (body("late", "1 if an input moved the nozzle evenly", 1), from_mut(&mut self.late)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rings fill the section: shares are those of equal areas to 6 %, and their sum is 1. Their second moment is that
    /// of a disc, less what the width Δ of rings about their middle has, `Δ²/4`.
    #[test]
    fn rings_fill_the_outlet() {
        for across in [4.0, 6.0, 9.0, 12.0, 20.0] {
            let places = rings(1.0, 1.0 / across);
            let sum: f64 = places.iter().map(|place| place.1).sum();
            assert!((sum - 1.0).abs() < 1e-12);
            let mean = 1.0 / places.len() as f64;
            assert!(places.iter().all(|place| (place.1 / mean - 1.0).abs() < 0.06), "{across}");
            let moment: f64 = places.iter().map(|([x, y], share)| share * (x * x + y * y)).sum();
            let width = 0.5 / (0.5 * across).round();
            assert!((moment - 0.125 + 0.25 * width * width).abs() < 1e-12, "{across}: {moment}");
            let nearest = places.iter().enumerate().flat_map(|(n, (a, _))| {
                places[..n].iter().map(move |(b, _)| (a[0] - b[0]).hypot(a[1] - b[1]))
            });
            assert!(nearest.fold(f64::INFINITY, f64::min) * across > 0.6, "{across}");
        }
    }
}
