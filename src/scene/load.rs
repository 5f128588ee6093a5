//! Loads on faces: their position, their amounts and their range.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::types::{IDENTIFIER, Role, Shape};
use crate::channel::{Channel, Direction};
use crate::limits::{count, footprint_radius, heat_flux, length, place, power, traction};

/// Heat and traction on part of a face.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// First part of the inputs' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The face, `BODY.FACE`.
    #[schemars(extend("condition" = "`top` or `bottom` of a solid"))]
    pub on: String,
    /// Footprint of the load.
    #[schemars(extend("condition" = "on its face"))]
    pub footprint: Footprint,
    /// Amounts that the load carries.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub carries: Vec<Carries>,
    /// Start values of the inputs.
    #[serde(default)]
    #[schemars(extend("otherwise" = "zero, at the centre"))]
    pub start: LoadStart,
    /// Bounds of the inputs that move the footprint; the mesh is fine throughout these bounds.
    #[serde(default)]
    #[schemars(extend("otherwise" = "where it starts"))]
    pub range: LoadRange,
    /// Role of position and radius: inputs or tunable parameters.
    #[serde(default)]
    pub role: Role,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Footprint {
    /// `{ radius = R }`: uniform inside.
    #[schemars(extend("unit" = "m", "condition" = "of loads"))]
    Disc {
        #[schemars(transform = footprint_radius())]
        radius: f64,
    },
    /// `{ radius = R }`: the peak at the centre, 1/e² of it at R.
    #[schemars(extend("unit" = "m", "condition" = "of loads"))]
    Gaussian {
        #[schemars(transform = footprint_radius())]
        radius: f64,
    },
    /// `{ inner = R1, outer = R2 }`: uniform between both. The input `NAME.radius` is the outer radius; the inner one
    /// grows in proportion.
    #[schemars(extend("unit" = "m", "condition" = "of loads; R1 up to 0.999 R2"))]
    Ring {
        #[schemars(transform = length("the inner radius of a ring"))]
        inner: f64,
        #[schemars(transform = footprint_radius())]
        outer: f64,
    },
    /// `{ count = N, radius = R }`: concentric, of equal width, one value each.
    #[schemars(extend("unit" = "m", "condition" = "count 1 to 1000"))]
    Rings {
        #[schemars(transform = count())]
        count: usize,
        #[schemars(transform = footprint_radius())]
        radius: f64,
    },
    /// `{ count = [NX, NY], size = [LX, LY] }`: rectangles, one value each.
    #[schemars(extend("unit" = "m", "condition" = "counts 1 to 1000; not on a disc; NY = 1 for a plane drop"))]
    Tiles {
        #[schemars(transform = count())]
        count: [usize; 2],
        #[schemars(transform = length("the extent of a footprint"))]
        size: [f64; 2],
    },
}

/// Index ranges of a footprint of many values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellShape {
    Rings(usize),
    Tiles([usize; 2]),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Carries {
    /// Heat flux into the body [W/m²].
    HeatFlux,
    /// Heating power of the whole footprint [W].
    Power,
    /// Pressure that acts into the body [Pa].
    Pressure,
    /// Shear traction [Pa]: along x and y; radial on rings; not on plane sections.
    Shear,
}

/// Start values of a load's inputs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadStart {
    /// Heat flux into the body [W/m²].
    #[schemars(transform = heat_flux().otherwise("0").condition(CARRIED))]
    pub heat_flux: Option<CellValues>,
    /// Heating power of the whole footprint, into the body [W].
    #[schemars(transform = power().otherwise("0").condition("on `disc`, `gaussian`, `ring`"))]
    pub power: Option<f64>,
    /// Pressure into the body [Pa].
    #[schemars(transform = traction().otherwise("0").condition(CARRIED))]
    pub pressure: Option<CellValues>,
    /// Shear along x [Pa].
    #[schemars(transform = traction().otherwise("0").condition("not on rings"))]
    pub shear_x: Option<CellValues>,
    /// Shear along y [Pa].
    #[schemars(transform = traction().otherwise("0").condition("not on rings"))]
    pub shear_y: Option<CellValues>,
    /// Shear outward [Pa].
    #[schemars(transform = traction().otherwise("0").condition("on rings"))]
    pub shear_r: Option<CellValues>,
    /// x of the centre [m].
    #[schemars(transform = place().otherwise("0").condition(ON_THE_FACE))]
    pub x: Option<f64>,
    /// y of the centre [m].
    #[schemars(transform = place().otherwise("0").condition(ON_THE_FACE))]
    pub y: Option<f64>,
    /// Radius of a round footprint [m].
    #[schemars(transform = footprint_radius()
        .otherwise("that of the footprint")
        .condition("on the face"))]
    pub radius: Option<f64>,
}

/// Applicability of start values, for the reference.
const CARRIED: &str = "amounts in `carries`";
/// Applicability of positions, for the reference.
const ON_THE_FACE: &str = "on the face; not on a disc";
/// Default of ranges, for the reference.
const UNBOUNDED: &str = "unbounded, mesh fine at the start";

/// One value for all cells, or one for each cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "a finite number, a list of them (rings) or a list of lists of them (tiles)"
)]
#[schemars(inline)]
pub enum CellValues {
    Uniform(f64),
    Rings(Vec<f64>),
    /// One row per index i, with the values of the tiles `[i, 1]`, `[i, 2]` …
    Tiles(Vec<Vec<f64>>),
}

impl LoadStart {
    /// Start values of an amount.
    pub fn amounts(&self, channel: Channel) -> Option<Cow<'_, CellValues>> {
        let values = match channel {
            Channel::HeatFlux => &self.heat_flux,
            Channel::Power => {
                return self.power.map(|power| Cow::Owned(CellValues::Uniform(power)));
            }
            Channel::Pressure => &self.pressure,
            Channel::ShearX => &self.shear_x,
            Channel::ShearY => &self.shear_y,
            Channel::ShearR => &self.shear_r,
        };
        values.as_ref().map(Cow::Borrowed)
    }
}

impl Load {
    /// The amounts of the load: shear is radial on rings, and along x and y elsewhere.
    pub fn channels(&self) -> impl Iterator<Item = Channel> {
        let is_radial = self.footprint.shears_outward();
        let fits = move |channel: &Channel| match channel.direction() {
            Direction::Along(_) => !is_radial,
            Direction::Outward => is_radial,
            Direction::Heat | Direction::Inward => true,
        };
        let carried = |channel: &Channel| self.carries.contains(&Carries::of(*channel));
        Channel::ALL.into_iter().filter(carried).filter(fits)
    }

    /// Returns true if the load carries heat.
    pub fn heats(&self) -> bool {
        self.channels().any(Channel::is_heat)
    }

    /// Outer radius at the start [m]; `None` for tiles.
    pub fn start_radius(&self) -> Option<f64> {
        self.start.radius.or(self.footprint.radius())
    }

    /// Largest value per area that a unit of an amount makes on the footprint with an outer radius [m], and its
    /// derivative by that radius.
    pub fn density(&self, channel: Channel, radius: f64) -> [f64; 2] {
        let [area, growth] = self.footprint.area(radius);
        let [density, by_area] = channel.density(area);
        [density, by_area * growth]
    }

    /// Smallest share of a power that acts on the face of a body of this shape, at the start and within the range of
    /// position and radius; the tails of a Gaussian may leave the face.
    pub fn least_share_on(&self, shape: &Shape) -> f64 {
        let farthest = |start: Option<f64>, range: Option<[f64; 2]>| {
            let range = range.into_iter().flatten().map(f64::abs);
            range.fold(start.unwrap_or_default().abs(), f64::max)
        };
        let centre = [farthest(self.start.x, self.range.x), farthest(self.start.y, self.range.y)];
        self.footprint.share_on(shape, farthest(self.start_radius(), self.range.radius), centre)
    }

    /// The amount of heat that the load carries, and the heat fluxes that its start values make [W/m²]; `None` without
    /// start values.
    pub fn start_fluxes(&self) -> Option<(Channel, Vec<f64>)> {
        let channel = self.channels().find(|channel| channel.is_heat())?;
        let values = self.start.amounts(channel)?;
        let [density, _] = self.density(channel, self.start_radius().unwrap_or_default());
        Some((channel, values.numbers().map(|value| value * density).collect()))
    }
}

impl Carries {
    /// The kind of load that carries an amount.
    pub fn of(channel: Channel) -> Self {
        match channel {
            Channel::HeatFlux => Self::HeatFlux,
            Channel::Power => Self::Power,
            Channel::Pressure => Self::Pressure,
            Channel::ShearX | Channel::ShearY | Channel::ShearR => Self::Shear,
        }
    }
}

impl CellValues {
    /// All numbers, in the order of the cells.
    pub fn numbers(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Uniform(value) => Box::new(std::iter::once(*value)),
            Self::Rings(list) => Box::new(list.iter().copied()),
            Self::Tiles(rows) => Box::new(rows.iter().flatten().copied()),
        }
    }
}

/// Bounds `[lowest, highest]` of the inputs that move a footprint [m].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadRange {
    /// `[lowest, highest]` x of the centre [m].
    #[schemars(transform = place().otherwise(UNBOUNDED).condition(ON_THE_FACE))]
    pub x: Option<[f64; 2]>,
    /// `[lowest, highest]` y of the centre [m].
    #[schemars(transform = place().otherwise(UNBOUNDED).condition(ON_THE_FACE))]
    pub y: Option<[f64; 2]>,
    /// `[lowest, highest]` radius [m].
    #[schemars(transform = footprint_radius().otherwise(UNBOUNDED).condition("on the face"))]
    pub radius: Option<[f64; 2]>,
}
