//! Filaments that a moving nozzle lays on plates, and the lines that they are meant to follow.

use std::f64::consts::FRAC_PI_4;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::droplet::or_substance;
use super::lookup::BodyInput;
use super::types::Convection;
use crate::laws::Fluid;
use crate::limits::{Limits, any, length, own_temperature, place, plausible, temperature, within};
use crate::quantity::Quantity;

/// A fluid that comes from a moving nozzle and is laid as a strand on the plane z = 0, the top of a solid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Filament {
    /// Method that computes the strand.
    #[serde(default)]
    pub method: FilamentMethod,
    /// Fluid of the strand: a table, or the name of a substance of the library.
    #[schemars(transform = or_substance)]
    pub fluid: Fluid,
    /// The nozzle.
    pub nozzle: Nozzle,
    /// Motion of the outlet: `input`, or a table of places over the time.
    #[schemars(extend("condition" = "`input`, or `{ time, x, y }` with `z` if the height changes"))]
    pub path: NozzlePath,
    /// Largest volume that may come in a run, which fixes the size of the state [m³].
    #[schemars(transform = within(1e-24, 1e6, "m³", "the largest volume")
        .condition("at most a million segments"))]
    pub most: f64,
    /// Length of a segment where the strand is as thick as the nozzle [m].
    #[schemars(transform = length("the length of a segment")
        .condition("up to ten times the diameter of the nozzle")
        .otherwise("half the diameter of the nozzle"))]
    pub spacing: Option<f64>,
    /// Body force per mass towards −z [m/s²].
    #[serde(default = "free_fall")]
    #[schemars(transform = within(0.0, 1e7, "m/s²", "gravity, which acts towards the plate,")
        .plausible(&plausible::GRAVITY))]
    pub gravity: f64,
    /// Heat that passes to the air.
    #[schemars(extend("otherwise" = "none"))]
    pub convection: Option<Convection>,
}

/// Method that computes a strand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FilamentMethod {
    /// Segments of one width and one temperature along the centre line.
    #[default]
    Line,
}

/// A round nozzle that points downwards.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nozzle {
    /// Inner diameter of its outlet [m].
    #[schemars(transform = within(1e-9, 1e2, "m", "the diameter of a nozzle").plausible(&plausible::DIAMETER))]
    pub diameter: f64,
    /// Height of the outlet above the plate, where `path` does not set it; of an input its start value [m].
    #[schemars(transform = length("the height of the nozzle"))]
    pub height: f64,
    /// Temperature of the fluid that comes; the start value of an input [K].
    #[schemars(transform = own_temperature().condition("above the liquidus of a fluid that freezes"))]
    pub temperature: f64,
    /// Volume flow; the start value of an input [m³/s].
    #[serde(default)]
    #[schemars(transform = flow().condition("times the stop time at most `most`"))]
    pub flow: f64,
}

/// Motion of a nozzle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "\"input\" or a table of `time`, `x` and `y`")]
#[schemars(inline)]
pub enum NozzlePath {
    Input(ByInput),
    Table(PathTable),
}

/// Motion by inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(inline)]
pub enum ByInput {
    /// The unit has inputs for the place of the outlet.
    Input,
}

/// Places of a nozzle's outlet over the time; it moves evenly between them, and rests before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathTable {
    /// Ascending times [s].
    #[schemars(length(min = 2), transform = within(0.0, 1e12, "s", "the time of a place"))]
    pub time: Vec<f64>,
    /// x at each of them [m].
    #[schemars(length(min = 2), transform = place())]
    pub x: Vec<f64>,
    /// y [m].
    #[schemars(length(min = 2), transform = place())]
    pub y: Vec<f64>,
    /// Height above the plate [m].
    #[schemars(length(min = 2), transform = height().otherwise("`nozzle.height`"))]
    pub z: Option<Vec<f64>>,
}

/// A line that a strand is meant to follow, for outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// The filament.
    #[schemars(extend("condition" = "a filament without another target"))]
    pub of: String,
    /// Places `[x, y]` of the line, which is straight between them [m].
    #[schemars(length(min = 2), transform = any("m").condition("each apart from the one before"))]
    pub line: Vec<[f64; 2]>,
}

/// Height of an outlet [m].
const fn height() -> Limits {
    within(0.0, 1e3, "m", "the height of the nozzle")
}

/// Volume flow of a nozzle [m³/s].
const fn flow() -> Limits {
    within(0.0, 1e3, "m³/s", "the flow of the nozzle")
}

/// Acceleration of free fall [m/s²].
fn free_fall() -> f64 {
    9.81
}

impl Filament {
    /// Section of the outlet [m²].
    pub fn outlet(&self) -> f64 {
        FRAC_PI_4 * self.nozzle.diameter.powi(2)
    }

    /// Length of a segment where the strand is as thick as the nozzle [m].
    pub fn segment_length(&self) -> f64 {
        self.spacing.unwrap_or(0.5 * self.nozzle.diameter)
    }

    /// The table of its path, unless inputs move the nozzle.
    pub fn table(&self) -> Option<&PathTable> {
        match &self.path {
            NozzlePath::Input(_) => None,
            NozzlePath::Table(table) => Some(table),
        }
    }

    /// Inputs: the place of the outlet if inputs move it, flow and temperature, and the temperature of the air.
    pub fn inputs(&self) -> Vec<BodyInput> {
        let Nozzle { height: z, temperature: hot, flow: start, .. } = self.nozzle;
        let at = |key, words, start, limits: Limits| BodyInput {
            key,
            words,
            quantity: Quantity::Length,
            start,
            bounds: limits.bounds(),
        };
        let places = [
            at("nozzle_x", "x of the outlet of the nozzle", 0.0, place()),
            at("nozzle_y", "y of the outlet of the nozzle", 0.0, place()),
            at("nozzle_z", "height of the outlet of the nozzle above the plate", z, height()),
        ];
        let flow = BodyInput {
            key: "flow",
            words: "volume flow of the nozzle",
            quantity: Quantity::VolumeFlow,
            start,
            bounds: flow().bounds(),
        };
        let warm = |key, words, start| BodyInput {
            key,
            words,
            quantity: Quantity::Temperature,
            start,
            bounds: temperature().bounds(),
        };
        let hot = warm("nozzle_temperature", "temperature of the fluid that comes", hot);
        let air = self.convection.map(|convection| {
            warm("ambient", "temperature of the air around the strand", convection.ambient)
        });
        let places = places.into_iter().filter(|_| self.table().is_none());
        places.chain([flow, hot]).chain(air).collect()
    }
}

impl PathTable {
    /// Number of places.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Place of a knot [m]; `height` is that of a path without `z`.
    pub fn knot(&self, n: usize, height: f64) -> [f64; 3] {
        [self.x[n], self.y[n], self.z.as_ref().map_or(height, |z| z[n])]
    }

    /// Ranges of x and y [m].
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        [&self.x, &self.y].map(|places| {
            let low = places.iter().copied().fold(f64::INFINITY, f64::min);
            [low, places.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
        })
    }
}
