//! Strips of quasi-brittle materials as lattices of particles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lookup::BodyInput;
use crate::laws::fracture::QuasiBrittle;
use crate::limits::{length, own_temperature, place, plausible, within};
use crate::quantity::Quantity;

/// A strip of concrete or another quasi-brittle material in plane stress: particles joined by links that soften and
/// break. It lies in the plane of x and z, from z = 0 at its lower face up, with x = 0 in the middle of its length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lattice {
    /// Extent along x [m].
    #[schemars(transform = length("the length of a strip").plausible(&plausible::STRIP))]
    pub length: f64,
    /// Extent along z [m].
    #[schemars(transform = length("the depth of a strip").plausible(&plausible::STRIP))]
    pub depth: f64,
    /// Extent across the plane [m].
    #[schemars(transform = length("the thickness of a strip").plausible(&plausible::STRIP))]
    pub thickness: f64,
    /// Distance of neighbouring particles [m], changed so that a whole number of them fills the depth.
    #[schemars(transform = length("the distance of particles")
        .condition("at least 4 over the depth, and at most a million particles"))]
    pub spacing: f64,
    /// Arrangement of the particles.
    #[serde(default)]
    pub arrangement: LatticeArrangement,
    /// Constants of the material.
    pub material: QuasiBrittle,
    /// A cut from the lower face.
    #[schemars(extend("otherwise" = "none"))]
    pub notch: Option<LatticeNotch>,
    /// Supports and load: `ends`, pulled between rigid platens, or three-point bending.
    #[schemars(extend("condition" = "or `{ three_point = { span = L } }`"))]
    pub support: LatticeSupport,
    /// Quantity that the input prescribes: the displacement of the load, or the opening of the notch at the lower face.
    /// The opening passes points at which the displacement would go back.
    #[serde(default)]
    #[schemars(extend("condition" = "`opening` with `notch`"))]
    pub control: LatticeControl,
    /// True if the strip has inertia: it moves by explicit time steps, and the load at constant speed from its
    /// displacement at the beginning of a communication step to that at the end. Otherwise it is in equilibrium at
    /// every time.
    #[serde(default)]
    #[schemars(extend("condition" = "not with `control = \"opening\"`"))]
    pub inertia: bool,
    /// Rate at which the speed of every particle fades, `dv/dt = −damping v` [1/s].
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e5, "1/s", "the damping of a lattice")
        .plausible(&plausible::FADING)
        .condition("with `inertia = true`"))]
    pub damping: f64,
    /// True if links that are damaged bear pressure like intact ones.
    #[serde(default = "crate::scene::defaults::yes")]
    pub contact: bool,
    /// Half the width of the range, over its middle, in which the strength is distributed evenly from link to link [1].
    /// Without scatter a symmetric beam stays symmetric, which is not what it does.
    #[serde(default = "usual_scatter")]
    #[schemars(transform = within(0.0, 0.9, "1", "").says("scatter is a part of the strength", "0 to 0.9"))]
    pub scatter: f64,
    /// Number of the sample of that distribution, and of random particles.
    #[serde(default)]
    pub seed: u32,
    /// Uniform temperature, of which nothing depends [K].
    #[serde(default = "room")]
    #[schemars(transform = own_temperature())]
    pub initial_temperature: f64,
}

fn usual_scatter() -> f64 {
    0.05
}

fn room() -> f64 {
    293.15
}

/// Arrangement of the particles of a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LatticeArrangement {
    /// Hexagons with links across the strip, along z.
    #[default]
    Across,
    /// Hexagons with links along the strip, along x.
    Along,
    /// Random particles, whose links cross the facets of their Voronoi cells: cracks prefer no direction.
    Random,
}

/// A cut from the lower face of a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeNotch {
    /// Depth of its tip [m].
    #[schemars(transform = length("the depth of a notch").condition("below that of the strip"))]
    pub depth: f64,
    /// Width [m]: zero is a cut between two columns of particles, of a wider notch those within it are left out. No
    /// link crosses the middle.
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e3, "m", "the width of a notch"))]
    pub width: f64,
    /// Place of its middle, x [m].
    #[serde(default)]
    #[schemars(transform = place().condition("within the strip"))]
    pub at: f64,
}

/// Supports and load of a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LatticeSupport {
    /// Three-point bending: on two supports at the lower face, loaded downwards in the middle of the upper face.
    ThreePoint(ThreePoint),
    /// Uniaxial tension: both ends in rigid platens, which do not turn; the right one moves along x.
    Ends,
}

/// Three-point bending.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThreePoint {
    /// Distance of the supports [m].
    #[schemars(transform = length("the span").condition("a spacing or more from both ends of the strip"))]
    pub span: f64,
}

/// Quantity that the input of a lattice prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LatticeControl {
    /// Displacement of the load.
    #[default]
    Displacement,
    /// Opening of the notch at the lower face.
    Opening,
}

impl Lattice {
    /// The input: what is prescribed.
    pub fn inputs(&self) -> Vec<BodyInput> {
        let (key, words) = match self.control {
            LatticeControl::Displacement => ("displacement", "prescribed displacement of the load"),
            LatticeControl::Opening => {
                ("opening", "prescribed opening of the notch at the lower face")
            }
        };
        let quantity = Quantity::Displacement;
        vec![BodyInput { key, words, quantity, start: 0.0, bounds: place().bounds() }]
    }

    /// Most particles of a lattice.
    pub const MOST_PARTICLES: f64 = 1e6;

    /// Number of particles of hexagons that fill the strip.
    pub fn particles(&self) -> f64 {
        self.length * self.depth / (0.75_f64.sqrt() * self.spacing * self.spacing)
    }

    /// Distance of particles at which as many as a lattice may have fill the strip [m].
    pub fn least_spacing(&self) -> f64 {
        (self.length * self.depth / (0.75_f64.sqrt() * Self::MOST_PARTICLES)).sqrt()
    }

    /// Distances of particles that a crack may run: from the tip of the notch to the upper face.
    pub fn ligament(&self) -> f64 {
        let below = self.notch.map_or(0.0, |notch| notch.depth);
        (self.depth - below) / self.spacing
    }

    /// Volume without the notch [m³].
    pub fn volume(&self) -> f64 {
        self.length * self.depth * self.thickness
    }
}
