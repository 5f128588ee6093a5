//! Flaws: cracks of assumed shape whose stress intensity follows from the stress of the body without them.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::grid::lateral_extents;
use super::types::{FaceName, IDENTIFIER, Scene, Shape, Solid};
use crate::laws::fracture::CrackGrowth;
use crate::limits::{any, length, plausible};

/// Tolerance of places on faces, relative to the body's thickness.
const SLACK: f64 = 1e-9;

/// A crack that is assumed, and changes nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flaw {
    /// First part of the outputs' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The body.
    #[serde(rename = "in")]
    #[schemars(extend("condition" = "a solid"))]
    pub body: String,
    /// Position of an edge crack's mouth, or of a penny's centre, `[x, y, z]` [m].
    #[schemars(transform = any("m").condition("on a face of the body, of a penny inside"))]
    pub at: [f64; 3],
    /// Normal of the crack plane `[x, y, z]`, of any length.
    #[schemars(extend("condition" = "along the face of an edge crack"))]
    pub normal: [f64; 3],
    /// Depth of an edge crack, or radius of a penny [m]; `worst` is the depth of highest stress intensity.
    #[schemars(transform = length("the depth of a flaw")
        .plausible(&plausible::FLAW)
        .condition("within the body, and within its layer"))]
    pub depth: FlawDepth,
    /// Shape of the crack.
    #[serde(default)]
    pub shape: FlawShape,
    /// Distance of equal edge cracks on both sides, which shield each other [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("the distance of cracks in a row")
        .condition("of edge cracks")
        .otherwise("alone"))]
    pub spacing: Option<f64>,
    /// Slow growth of an edge crack, with the depth after it as an output.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend(
        "condition" = "with a depth that is a number, and a `toughness` of the material",
        "otherwise" = "none"
    ))]
    pub growth: Option<CrackGrowth>,
    /// List of outputs.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub gives: Vec<FlawGives>,
}

/// Depth of a flaw.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number (m) or \"worst\"")]
#[schemars(inline)]
pub enum FlawDepth {
    Given(f64),
    Searched(Worst),
}

/// The depth of highest stress intensity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Worst {
    Worst,
}

/// Shape of a crack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FlawShape {
    /// A long crack that opens to a face, such as a scratch.
    #[default]
    Edge,
    /// A round crack inside.
    Penny,
}

/// Output of a flaw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FlawGives {
    /// Stress intensity K [Pa √m].
    StressIntensity,
    /// Energy release rate G [J/m²].
    EnergyReleaseRate,
    /// Toughness over stress intensity.
    Safety,
}

impl FlawDepth {
    /// The depth that the scene sets [m].
    pub fn given(self) -> Option<f64> {
        match self {
            Self::Given(depth) => Some(depth),
            Self::Searched(Worst::Worst) => None,
        }
    }
}

impl Flaw {
    /// Depth over the extent of the body behind it up to which the formula of a half plane holds: there a strip under
    /// uniform tension has 6 % more.
    pub const SHALLOW: f64 = 0.1;
    /// Distance from a face beside it over the depth of an edge crack, and over the radius of a penny, from which on the
    /// formulas hold: under uniform pressure on its faces an edge crack has 6 % more there, and a penny 4 %.
    const FREE: [f64; 2] = [5.0, 2.0];

    /// Unit normal of the crack plane; NaN if it has no direction.
    pub fn unit_normal(&self) -> [f64; 3] {
        let largest = self.normal.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        let scaled = self.normal.map(|part| part / largest);
        let length = scaled.iter().map(|part| part * part).sum::<f64>().sqrt();
        scaled.map(|part| part / length)
    }

    /// Point of a crack plane at a distance from the place of the flaw [m]; a turn is the whole circle.
    pub fn on_plane(&self, distance: f64, turn: f64) -> [f64; 3] {
        let [nx, ny, nz] = self.unit_normal();
        // The axis that is least along the normal yields a direction across it.
        let along = [nx, ny, nz].map(f64::abs);
        let least =
            (0..3).fold(0, |least, axis| if along[axis] < along[least] { axis } else { least });
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let across = cross([nx, ny, nz], axis);
        let length = across.iter().map(|part| part * part).sum::<f64>().sqrt();
        let first = across.map(|part| part / length);
        let second = cross([nx, ny, nz], first);
        let (sine, cosine) = (TAU * turn).sin_cos();
        std::array::from_fn(|i| self.at[i] + distance * (cosine * first[i] + sine * second[i]))
    }

    /// Face on which the mouth of an edge crack lies; top and bottom take precedence.
    pub fn face(&self, shape: &Shape) -> Option<FaceName> {
        let [x, y, z] = self.at;
        let thickness = shape.thickness();
        let near = |a: f64, b: f64| (a - b).abs() <= SLACK * thickness;
        let is_on = |face: &FaceName| match (*shape, *face) {
            (_, FaceName::Top) => near(z, 0.0),
            (_, FaceName::Bottom) => near(z, -thickness),
            (Shape::Box([lx, _, _]), FaceName::Left) => near(x, -lx / 2.0),
            (Shape::Box([lx, _, _]), FaceName::Right) => near(x, lx / 2.0),
            (Shape::Box([_, ly, _]), FaceName::Front) => near(y, -ly / 2.0),
            (Shape::Box([_, ly, _]), FaceName::Back) => near(y, ly / 2.0),
            (Shape::Disc(disc), FaceName::Sides) => near(x.hypot(y), disc.radius),
            _ => false,
        };
        let first = [FaceName::Top, FaceName::Bottom];
        first.iter().chain(shape.faces()).copied().find(is_on)
    }

    /// Unit direction from the mouth of an edge crack into the body.
    pub fn inward(&self, face: FaceName) -> [f64; 3] {
        let [x, y, _] = self.at;
        match face {
            FaceName::Top => [0.0, 0.0, -1.0],
            FaceName::Bottom => [0.0, 0.0, 1.0],
            FaceName::Left => [1.0, 0.0, 0.0],
            FaceName::Right => [-1.0, 0.0, 0.0],
            FaceName::Front => [0.0, 1.0, 0.0],
            FaceName::Back => [0.0, -1.0, 0.0],
            FaceName::Sides => {
                let r = x.hypot(y);
                [-x / r, -y / r, 0.0]
            }
        }
    }

    /// The nearest face beside the crack, its distance and the one from which on the formulas hold [m]: for an edge crack
    /// along its normal, for a penny all around. A crack in a plane of symmetry is not beside it.
    pub fn beside(&self, solid: &Solid) -> Option<(FaceName, [f64; 2])> {
        let depth = self.depth.given()?;
        // Equal cracks in a row shield each other: what is farther away than the next one is hardly met.
        let size = self.spacing.map_or(depth, |spacing| depth.min(spacing));
        let [of_edge, of_penny] = Self::FREE;
        let (free, mouth) = match self.shape {
            FlawShape::Edge => (of_edge * size, Some(self.face(&solid.shape)?)),
            FlawShape::Penny => (of_penny * size, None),
        };
        let normal = self.unit_normal();
        let distance = |face: FaceName| {
            let (away, along) = self.away(&solid.shape, face);
            let cosine: f64 = normal.iter().zip(along).map(|(n, a)| n * a).sum::<f64>().abs();
            let is_in_plane =
                solid.face(face).roller && away <= SLACK * size && (cosine - 1.0).abs() < SLACK;
            let distance = if mouth.is_some() { away / cosine } else { away };
            (!is_in_plane).then_some(distance.max(0.0))
        };
        let faces = solid.shape.faces().iter().copied();
        let others = faces.filter(|face| mouth.is_none_or(|mouth| mouth != *face));
        let near = others.filter_map(|face| Some((face, [distance(face)?, free])));
        near.filter(|(_, [distance, free])| distance < free)
            .min_by(|(_, [a, _]), (_, [b, _])| a.total_cmp(b))
    }

    /// Distance of the flaw from a face [m], and the unit direction there.
    fn away(&self, shape: &Shape, face: FaceName) -> (f64, [f64; 3]) {
        let [x, y, z] = self.at;
        let [width, depth] = lateral_extents(shape);
        match face {
            FaceName::Top => (-z, [0.0, 0.0, 1.0]),
            FaceName::Bottom => (z + shape.thickness(), [0.0, 0.0, 1.0]),
            FaceName::Left => (0.5 * width + x, [1.0, 0.0, 0.0]),
            FaceName::Right => (0.5 * width - x, [1.0, 0.0, 0.0]),
            FaceName::Front => (0.5 * depth + y, [0.0, 1.0, 0.0]),
            FaceName::Back => (0.5 * depth - y, [0.0, 1.0, 0.0]),
            FaceName::Sides => {
                let r = x.hypot(y);
                let along = if r > 0.0 { [x / r, y / r, 0.0] } else { self.unit_normal() };
                (0.5 * width - r, along)
            }
        }
    }

    /// Layer of a body, from the top, in which the flaw begins: on an interface the layer above it, whatever the
    /// rounding of the thicknesses that add up to its depth.
    pub fn layer(&self, solid: &Solid) -> usize {
        let strata = solid.strata();
        let z = self.at[2] + SLACK * solid.shape.thickness();
        strata.iter().position(|layer| z >= layer.z[0]).unwrap_or(strata.len() - 1)
    }

    /// The flaw with its place inside of its layer, if it misses that by rounding.
    pub fn settled(&self, solid: &Solid) -> Self {
        let [bottom, top] = solid.strata()[self.layer(solid)].z;
        let [x, y, z] = self.at;
        Self { at: [x, y, z.clamp(bottom, top)], ..self.clone() }
    }

    /// Largest depth of an edge crack: from the face to the end of its layer or of the body [m].
    pub fn reach(&self, solid: &Solid, face: FaceName) -> f64 {
        let [bottom, top] = solid.strata()[self.layer(solid)].z;
        match (solid.shape, face) {
            (_, FaceName::Top | FaceName::Bottom) => top - bottom,
            (Shape::Box([lx, _, _]), FaceName::Left | FaceName::Right) => lx,
            (Shape::Box([_, ly, _]), _) => ly,
            (Shape::Disc(disc), _) => 2.0 * disc.radius,
        }
    }
}

impl Scene {
    /// The flaws in a body.
    pub fn flaws_in(&self, body: &str) -> impl Iterator<Item = &Flaw> {
        self.flaw.iter().filter(move |flaw| flaw.body == body)
    }

    /// Returns true if a flaw in a body grows.
    pub fn has_growing_flaws(&self, body: &str) -> bool {
        self.flaws_in(body).any(|flaw| flaw.growth.is_some())
    }
}
