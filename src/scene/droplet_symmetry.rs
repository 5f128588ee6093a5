//! Modelled part of a droplet's drops, and its number of particles.

use std::f64::consts::PI;

use super::droplet::{Droplet, DropletMethod, DropletSymmetry, Placement};

impl Droplet {
    /// Returns true if particles are rings about the axis. In an axisymmetric model, inputs release drops only straight
    /// down the axis. Random placement excludes it, because it would not be random in rings.
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

    /// Number of particles of all computed drops, images at mirrors excluded; for replayed drops, that of one.
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

    /// Number of axes in which particles are arranged.
    pub fn axes(&self) -> usize {
        if self.is_axisymmetric() { 2 } else { self.dimension }
    }

    /// Symmetry of the drops' motion along x and y.
    pub fn even(&self) -> [bool; 2] {
        self.mirrors().map(|mirrored| mirrored || self.is_axisymmetric())
    }

    /// Axes x and y along which half of the model represents the whole.
    pub fn mirrors(&self) -> [bool; 2] {
        let is_even = match self.symmetry {
            DropletSymmetry::Auto if self.is_axisymmetric() => false,
            DropletSymmetry::Auto => {
                self.is_centred() && !self.is_on_demand() && self.placement == Placement::Lattice
            }
            symmetry => symmetry == DropletSymmetry::Quarter,
        };
        // A drop at an angle is symmetric about its plane of motion, if that is a coordinate plane.
        let [u, v, _] = self.velocity();
        [is_even && u == 0.0, is_even && v == 0.0 && self.dimension == 3]
    }
}
