//! Filaments that a moving nozzle lays on plates, and the lines that they are meant to follow.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_4;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::droplet::or_substance;
use super::gcode::{self, BadLine};
use super::lookup::BodyInput;
use super::route::Route;
use super::types::Convection;
use crate::laws::Fluid;
use crate::limits::{Limits, any, length, own_temperature, plausible, temperature, within};
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
    /// Motion of the outlet: `input`, a table of places over the time, or a file of G-code.
    #[schemars(extend("condition" = "`input`, `{ time, x, y }` with `z` and `flow` if they change, or `{ file }`"))]
    pub path: NozzlePath,
    /// Largest volume that may come in a run [m³].
    #[schemars(transform = within(1e-24, 1e6, "m³", "the largest volume")
        .condition("at most a million segments, or two million particles"))]
    pub most: f64,
    /// Length of a segment where the strand is as thick as the nozzle; with `method = "particles"` their distance [m].
    #[schemars(transform = length("the length of a segment")
        .condition("up to ten times the diameter of the nozzle; of particles up to a quarter of it")
        .otherwise("half the diameter of the nozzle; of particles an eighth"))]
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
    /// Smoothed particles.
    Particles,
}

/// A round nozzle that points downwards.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nozzle {
    /// Inner diameter of its outlet [m].
    #[schemars(transform = within(1e-9, 1e2, "m", "the diameter of a nozzle").plausible(&plausible::NOZZLE))]
    pub diameter: f64,
    /// Height of the outlet above the plate, where `path` does not set it; of an input its start value [m].
    #[schemars(transform = length("the height of the nozzle"))]
    pub height: f64,
    /// Temperature of the fluid that comes; the start value of an input [K].
    #[schemars(transform = own_temperature().condition("above the liquidus of a fluid that freezes"))]
    pub temperature: f64,
    /// Volume flow; the start value of an input [m³/s].
    #[serde(default)]
    #[schemars(transform = flow().condition("times the stop time at most `most`; 0 where `path` sets the flow"))]
    pub flow: f64,
}

/// Motion of a nozzle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "\"input\" or a table of `time`, `x` and `y`, or of `file`")]
#[schemars(inline)]
pub enum NozzlePath {
    Input(ByInput),
    Table(PathTable),
    File(PathFile),
}

/// Motion by inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(inline)]
pub enum ByInput {
    /// The unit has inputs for the place of the outlet.
    Input,
}

/// Places of a nozzle's outlet over the time; it moves evenly between them. Before the first and after the last it
/// rests, and no fluid comes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathTable {
    /// Ascending times [s].
    #[schemars(length(min = 2), transform = within(0.0, 1e12, "s", "the time of a place"))]
    pub time: Vec<f64>,
    /// x at each of them [m].
    #[schemars(length(min = 2), transform = outlet_place())]
    pub x: Vec<f64>,
    /// y [m].
    #[schemars(length(min = 2), transform = outlet_place())]
    pub y: Vec<f64>,
    /// Height above the plate [m].
    #[schemars(length(min = 2), transform = height().otherwise("`nozzle.height`"))]
    pub z: Option<Vec<f64>>,
    /// Volume flow from each time to the next; the last one is not used [m³/s].
    #[schemars(length(min = 2), transform = flow().otherwise("the input `flow`, from the first time to the last"))]
    pub flow: Option<Vec<f64>>,
}

/// Motion and flow by G-code in a file. Nothing moves and no fluid comes after its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathFile {
    /// Name of the file, beside the scene or in a folder below it; packing copies it into the unit.
    #[schemars(extend("condition" = "G0 to G4, G20, G21, G90 to G92, M82, M83; see above"))]
    pub file: String,
    /// Acceleration of the nozzle along its path [m/s²].
    #[schemars(transform = within(1e-6, 1e6, "m/s²", "the acceleration of a nozzle")
        .plausible(&plausible::NOZZLE_ACCELERATION)
        .otherwise("none: speeds jump"))]
    pub acceleration: Option<f64>,
    /// Speed at which a right angle is passed, where `acceleration` is set [m/s].
    #[serde(default = "corner_speed")]
    #[schemars(transform = within(0.0, 1e3, "m/s", "the speed at corners"))]
    pub corner_speed: f64,
    /// Diameter of the filament whose length E counts [m].
    #[serde(default = "filament_diameter")]
    #[schemars(transform = within(1e-6, 1.0, "m", "the diameter of the filament"))]
    pub filament_diameter: f64,
    /// Place on the plate of X0 Y0 [m].
    #[serde(default)]
    #[schemars(transform = outlet_place().otherwise("`[0.0, 0.0]`"))]
    pub origin: [f64; 2],
    #[serde(skip)]
    pub(super) memo: gcode::Memo,
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

/// Place of an outlet along x or y [m].
const fn outlet_place() -> Limits {
    within(-1e6, 1e6, "m", "the place of the nozzle")
}

/// Height of an outlet [m].
const fn height() -> Limits {
    within(0.0, 1e3, "m", "the height of the nozzle")
}

/// Volume flow of a nozzle [m³/s].
const fn flow() -> Limits {
    within(0.0, 1e3, "m³/s", "the flow of the nozzle")
}

/// Speed at a right angle of common firmware [m/s].
fn corner_speed() -> f64 {
    5e-3
}

/// Diameter of common filament [m].
fn filament_diameter() -> f64 {
    1.75e-3
}

/// Acceleration of free fall [m/s²].
fn free_fall() -> f64 {
    9.81
}

/// Least height of the outlet over its diameter.
const LEAST_HEIGHT: f64 = 0.01;

impl Filament {
    /// Returns true if the fluid comes to rest for good: it yields or freezes.
    pub fn comes_to_rest(&self) -> bool {
        self.fluid.viscosity.yield_stress() > 0.0 || self.fluid.melting.is_some()
    }

    /// Section of the outlet [m²].
    pub fn outlet(&self) -> f64 {
        FRAC_PI_4 * self.nozzle.diameter.powi(2)
    }

    /// Length of a segment where the strand is as thick as the nozzle [m].
    pub fn segment_length(&self) -> f64 {
        self.spacing.unwrap_or(0.5 * self.nozzle.diameter)
    }

    /// Least height of the outlet above the plate while fluid comes [m].
    pub fn least_height(&self) -> f64 {
        match self.method {
            FilamentMethod::Line => LEAST_HEIGHT * self.nozzle.diameter,
            FilamentMethod::Particles => self.particle_distance(),
        }
    }

    /// Distance of particles [m].
    pub fn particle_distance(&self) -> f64 {
        self.spacing.unwrap_or(0.125 * self.nozzle.diameter)
    }

    /// Number of particles of the largest volume.
    pub fn particles(&self) -> f64 {
        self.most / self.particle_distance().powi(3)
    }

    /// Returns true if inputs move the nozzle.
    pub fn moves_by_inputs(&self) -> bool {
        matches!(self.path, NozzlePath::Input(_))
    }

    /// Returns true if the path sets the flow, too.
    pub fn path_sets_flow(&self) -> bool {
        match &self.path {
            NozzlePath::Input(_) => false,
            NozzlePath::Table(table) => table.flow.is_some(),
            NozzlePath::File(_) => true,
        }
    }

    /// The route that its path describes, with the texts of the scene's files; `None` if inputs move the nozzle.
    ///
    /// # Errors
    /// If a line of its file is not understood.
    pub fn route(&self, files: &BTreeMap<String, String>) -> Result<Option<Route>, BadLine> {
        let height = self.nozzle.height;
        Ok(match &self.path {
            NozzlePath::Input(_) => None,
            NozzlePath::Table(table) => Some(Route::of_table(table, height)),
            NozzlePath::File(own) => {
                let text = files.get(&own.file).map_or("", String::as_str);
                Some(gcode::route(text, own, height)?)
            }
        })
    }

    /// The file that its path names.
    pub fn file(&self) -> Option<&PathFile> {
        match &self.path {
            NozzlePath::File(file) => Some(file),
            _ => None,
        }
    }

    /// The table of its path.
    pub fn table(&self) -> Option<&PathTable> {
        match &self.path {
            NozzlePath::Table(table) => Some(table),
            _ => None,
        }
    }

    /// Inputs: the place of the outlet if inputs move it, the flow if the path does not set it, the temperature of the
    /// fluid and that of the air.
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
            at("nozzle_x", "x of the outlet of the nozzle", 0.0, outlet_place()),
            at("nozzle_y", "y of the outlet of the nozzle", 0.0, outlet_place()),
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
        let places = places.into_iter().filter(|_| self.moves_by_inputs());
        let flow = (!self.path_sets_flow()).then_some(flow);
        places.chain(flow).chain([hot]).chain(air).collect()
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
}
