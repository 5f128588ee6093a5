//! What part of its drops a droplet models, and how many particles these are.

use std::f64::consts::PI;

use super::droplet::{Droplet, DropletMethod, DropletSymmetry, Placement};

impl Droplet {
    /// Whether particles are rings about the axis. What is round lets inputs, too, release drops nowhere but straight
    /// down the axis. Drops at random places would not be what they are asked to be.
    pub fn is_axisymmetric(&self) -> bool {
        let has_axis = self.dimension == 3 && self.is_centred() && self.is_straight();
        match self.symmetry {
            DropletSymmetry::Axisymmetric => true,
            DropletSymmetry::Auto => {
                let is_computed = self.method == DropletMethod::Sph;
                self.is_on_round && is_computed && has_axis && self.placement == Placement::Lattice
            }
            DropletSymmetry::None | DropletSymmetry::Quarter => false,
        }
    }

    /// Number of particles of all drops that are computed, images at mirrors left out: of drops that are replayed, one.
    pub fn particles(&self) -> f64 {
        let across = self.diameter / self.spacing;
        let copies: f64 =
            self.mirrors().map(|mirrored| if mirrored { 2.0 } else { 1.0 }).iter().product();
        let whole = match (self.is_axisymmetric(), self.dimension) {
            (true, _) => PI / 8.0 * across.powi(2),
            (_, 2) => PI / 4.0 * across.powi(2),
            _ => PI / 6.0 * across.powi(3),
        };
        let drops = if self.is_replayed() { 1.0 } else { self.drops() as f64 };
        whole * drops / copies
    }

    /// Axes in which particles stand.
    pub fn axes(&self) -> usize {
        if self.is_axisymmetric() { 2 } else { self.dimension }
    }

    /// Along which of x and y what the drops do is symmetric.
    pub fn even(&self) -> [bool; 2] {
        self.mirrors().map(|mirrored| mirrored || self.is_axisymmetric())
    }

    /// Along which of x and y the half of the model stands for the whole.
    pub fn mirrors(&self) -> [bool; 2] {
        let is_even = match self.symmetry {
            DropletSymmetry::Auto if self.is_axisymmetric() => false,
            DropletSymmetry::Auto => {
                self.is_centred() && !self.is_on_demand() && self.placement == Placement::Lattice
            }
            symmetry => symmetry == DropletSymmetry::Quarter,
        };
        // A drop that comes at an angle mirrors itself in the plane that it moves in, if in any.
        let [u, v, _] = self.velocity();
        [is_even && u == 0.0, is_even && v == 0.0 && self.dimension == 3]
    }
}
