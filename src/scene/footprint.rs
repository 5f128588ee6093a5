//! Properties of footprints, kind by kind.

use std::f64::consts::{PI, SQRT_2};

use super::types::{CellShape, Footprint, Shape};

/// Decomposition of a footprint with its values.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// A sum of uniform discs about its centre, the radius [m] and value of each; all radii grow in proportion.
    Discs(Vec<(f64, f64)>),
    /// The value at the centre, 1/e² of it at the radius.
    Gaussian(f64),
    /// Rectangles over a size [m], one value each.
    Tiles { count: [usize; 2], size: [f64; 2] },
}

impl Footprint {
    /// Smallest hole that an automatic mesh resolves, over the outer radius.
    pub const LEAST_HOLE: f64 = 0.05;

    /// Name in scenes.
    pub fn name(&self) -> &'static str {
        match self {
            Footprint::Disc { .. } => "disc",
            Footprint::Gaussian { .. } => "gaussian",
            Footprint::Ring { .. } => "ring",
            Footprint::Rings { .. } => "rings",
            Footprint::Tiles { .. } => "tiles",
        }
    }

    /// Key of its extent, below that name.
    pub fn key_of_extent(&self) -> &'static str {
        match self {
            Footprint::Disc { .. } | Footprint::Gaussian { .. } | Footprint::Rings { .. } => {
                "radius"
            }
            Footprint::Ring { .. } => "outer",
            Footprint::Tiles { .. } => "size",
        }
    }

    /// Decomposition, for an outer radius that may differ from its own [m].
    pub fn profile(&self, radius: f64, values: &[f64]) -> Profile {
        match *self {
            Footprint::Disc { .. } => Profile::Discs(vec![(radius, values[0])]),
            Footprint::Gaussian { .. } => Profile::Gaussian(values[0]),
            // Like an unfocused beam, the ring grows as a whole.
            Footprint::Ring { inner, outer } => {
                Profile::Discs(vec![(radius, values[0]), (radius * (inner / outer), -values[0])])
            }
            Footprint::Rings { count, .. } => Profile::Discs(discs_of_rings(count, radius, values)),
            Footprint::Tiles { count, size } => Profile::Tiles { count, size },
        }
    }

    /// Equivalent area [m²], for an outer radius that may differ from its own [m], and its derivative by that radius:
    /// the amount of the whole footprint over its largest value per area. A Gaussian counts as a whole, with its tails.
    pub fn area(&self, radius: f64) -> [f64; 2] {
        let share = match *self {
            Footprint::Disc { .. } | Footprint::Rings { .. } => 1.0,
            Footprint::Gaussian { .. } => 0.5,
            Footprint::Ring { inner, outer } => (1.0 - inner / outer) * (1.0 + inner / outer),
            Footprint::Tiles { size, .. } => return [size[0] * size[1], 0.0],
        };
        [share * PI * radius * radius, 2.0 * share * PI * radius]
    }

    /// Share of the whole amount that acts on a face, for an outer radius and a centre on it [m]: less than 1 for a
    /// Gaussian, whose tails leave the face.
    pub fn share_on(&self, shape: &Shape, radius: f64, centre: [f64; 2]) -> f64 {
        if !matches!(self, Footprint::Gaussian { .. }) {
            return 1.0;
        }
        match shape {
            Shape::Disc(disc) => -(-2.0 * (disc.radius / radius).powi(2)).exp_m1(),
            Shape::Box(extents) => {
                let within = |axis: usize| {
                    let to = |side: f64| {
                        libm::erf(SQRT_2 * (0.5 * extents[axis] + side * centre[axis]) / radius)
                    };
                    0.5 * (to(1.0) + to(-1.0))
                };
                within(0) * within(1)
            }
        }
    }

    /// Outer radius of round footprints [m].
    pub fn radius(&self) -> Option<f64> {
        match *self {
            Footprint::Disc { radius }
            | Footprint::Gaussian { radius }
            | Footprint::Rings { radius, .. } => Some(radius),
            Footprint::Ring { outer, .. } => Some(outer),
            Footprint::Tiles { .. } => None,
        }
    }

    /// Cell indices, the first along the first axis; `None` for a single value without index.
    pub fn cells(&self) -> Option<CellShape> {
        match *self {
            Footprint::Disc { .. } | Footprint::Gaussian { .. } | Footprint::Ring { .. } => None,
            Footprint::Rings { count, .. } => Some(CellShape::Rings(count)),
            Footprint::Tiles { count, .. } => Some(CellShape::Tiles(count)),
        }
    }

    /// Number of values.
    pub fn cell_count(&self) -> usize {
        match self.cells() {
            None => 1,
            Some(CellShape::Rings(count)) => count,
            Some(CellShape::Tiles([nx, ny])) => nx * ny,
        }
    }

    /// Returns true if shear on it is radial rather than along x and y.
    pub fn shears_outward(&self) -> bool {
        matches!(self, Footprint::Rings { .. })
    }

    /// Extents on both sides of its centre along x and y [m], for a radius that may differ from its own.
    pub fn half_extents(&self, radius: Option<f64>) -> [f64; 2] {
        match *self {
            Footprint::Tiles { size, .. } => size.map(|size| size / 2.0),
            Footprint::Disc { .. }
            | Footprint::Gaussian { .. }
            | Footprint::Ring { .. }
            | Footprint::Rings { .. } => [radius.or(self.radius()).unwrap_or_default(); 2],
        }
    }

    /// Extent, over its half extents, within which its load is significant.
    pub fn reach(&self) -> f64 {
        if let Footprint::Gaussian { .. } = self { 1.5 } else { 1.0 }
    }

    /// Half of the smallest covered width, or the radius of a hole if that is smaller [m].
    pub fn half_width(&self, radius: Option<f64>) -> f64 {
        let [x, y] = self.half_extents(radius);
        match *self {
            Footprint::Ring { inner, outer } => {
                x * (0.5 * (1.0 - inner / outer)).min(inner / outer)
            }
            Footprint::Disc { .. }
            | Footprint::Gaussian { .. }
            | Footprint::Rings { .. }
            | Footprint::Tiles { .. } => x.min(y),
        }
    }

    /// Distances from its centre at which its load jumps first and last along an axis, for a radius that may differ
    /// from its own [m].
    pub fn edges(&self, radius: Option<f64>) -> [Option<f64>; 2] {
        let [outer, other] = self.half_extents(radius);
        match *self {
            Footprint::Gaussian { .. } => [None; 2],
            Footprint::Ring { inner, outer: own } => [Some(outer), Some(outer * (inner / own))],
            // Where the extents of tiles differ, a position is an edge along one axis alone, which does not harm the
            // mesh.
            Footprint::Tiles { .. } => [Some(outer), Some(other)],
            Footprint::Disc { .. } | Footprint::Rings { .. } => [Some(outer), None],
        }
    }

    /// Smallest size of a cell [m].
    pub fn finest(&self, radius: Option<f64>) -> f64 {
        let [x, y] = self.half_extents(radius);
        match *self {
            Footprint::Disc { .. } | Footprint::Gaussian { .. } => x,
            Footprint::Ring { inner, outer } => x * (1.0 - inner / outer),
            Footprint::Rings { count, .. } => x / count as f64,
            Footprint::Tiles { count: [nx, ny], .. } => {
                (2.0 * x / nx as f64).min(2.0 * y / ny as f64)
            }
        }
    }

    /// Length that a mesh must resolve, for radii between the smallest and the largest [m].
    pub fn feature(&self, [least, largest]: [f64; 2]) -> f64 {
        let part = |count: usize| (5.0 / count as f64).min(1.0);
        match *self {
            Footprint::Disc { .. } | Footprint::Gaussian { .. } => least,
            Footprint::Ring { inner, outer } => {
                let hole = inner / outer;
                least * (2.0 * (1.0 - hole)).min(hole.max(Self::LEAST_HOLE))
            }
            Footprint::Rings { count, .. } => largest * part(count),
            Footprint::Tiles { count, size } => {
                (size[0] * part(count[0])).min(size[1] * part(count[1]))
            }
        }
    }

    /// Short description for a table; `metres` writes lengths.
    pub fn label(&self, metres: impl Fn(f64) -> String) -> String {
        match *self {
            Footprint::Disc { radius } => format!("disc, radius {}", metres(radius)),
            Footprint::Gaussian { radius } => format!("gaussian, 1/e² radius {}", metres(radius)),
            Footprint::Ring { inner, outer } => {
                format!("ring, radii {} and {}", metres(inner), metres(outer))
            }
            Footprint::Rings { count, radius } => {
                format!("{count} rings, radius {}", metres(radius))
            }
            Footprint::Tiles { count: [nx, ny], size } => {
                format!("{nx} × {ny} tiles, {}", size.map(metres).join(" × "))
            }
        }
    }

    /// Description for a sentence.
    pub fn words(&self, metres: impl Fn(f64) -> String) -> String {
        match *self {
            Footprint::Disc { radius } => format!("a disc of radius {}", metres(radius)),
            Footprint::Gaussian { radius } => {
                format!("a Gaussian spot that falls to 1/e² at {}", metres(radius))
            }
            Footprint::Ring { inner, outer } => {
                format!("a ring from {} to {}", metres(inner), metres(outer))
            }
            Footprint::Rings { count, radius } => {
                format!("{count} rings of equal width out to {}", metres(radius))
            }
            Footprint::Tiles { count: [nx, ny], size: [x, y] } => {
                format!("{nx} × {ny} tiles over {} × {}", metres(x), metres(y))
            }
        }
    }
}

/// The outer radius of each ring and the decrease of the value there.
fn discs_of_rings(count: usize, radius: f64, values: &[f64]) -> Vec<(f64, f64)> {
    let width = radius / count as f64;
    let disc = |i: usize| {
        let next = values.get(i + 1).copied().unwrap_or(0.0);
        let jump = values[i] - next;
        (jump != 0.0).then_some(((i + 1) as f64 * width, jump))
    };
    (0..count).filter_map(disc).collect()
}
