//! The document of a report: everything that its page shows, as one JSON object. `impinge run` writes it from a run,
//! the Python package from its results; the page draws it.

use serde::{Deserialize, Serialize};

use super::packed::Array;
use crate::messages::Message;

/// Version of the document; a page draws documents of its own version alone.
pub const FORMAT: u32 = 1;

/// Contents of a report.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Document {
    pub format: u32,
    pub title: String,
    pub description: String,
    /// Program and version that made it.
    pub made_by: String,
    /// Origin of the results: files, settings, versions.
    pub source: Vec<Fact>,
    /// Scenes whose sketch and model are to be added, as texts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scenes: Vec<NamedScene>,
    /// Numbers at the top of the page.
    pub figures: Vec<Figure>,
    pub warnings: Vec<Message>,
    pub notes: Vec<String>,
    pub sketches: Vec<Sketch>,
    /// Parts of the description of the model.
    pub model: Vec<Part>,
    pub clips: Vec<Clip>,
    pub maps: Vec<Map>,
    pub histories: Option<Histories>,
    pub tables: Vec<Table>,
    pub balances: Vec<Balance>,
    pub errors: Option<Errors>,
    pub timings: Vec<Timing>,
    pub study: Option<Study>,
}

/// A label and a text.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fact {
    pub label: String,
    pub text: String,
}

impl Fact {
    pub fn new(label: impl Into<String>, text: impl Into<String>) -> Self {
        Self { label: label.into(), text: text.into() }
    }
}

/// The text of a scene; the name is empty if it is the only one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedScene {
    pub name: String,
    pub text: String,
}

/// A number with a label.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Figure {
    pub label: String,
    pub value: Option<f64>,
    pub unit: String,
    pub note: String,
}

/// A scene seen from two sides.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sketch {
    pub title: String,
    pub views: Vec<View>,
}

/// A view of a scene, to scale.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct View {
    pub title: String,
    /// Least and largest coordinates: x0, y0, x1, y1 [m].
    pub bounds: [f64; 4],
    /// The part where something acts, if that is small.
    pub focus: Option<[f64; 4]>,
    pub shapes: Vec<Shape>,
}

/// A part of a view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// `box` (x0, y0, x1, y1), `disc` (x, y, radius), `point` (x, y), `arrow` (x, y of the tip, direction) or `line`
    /// (x0, y0, x1, y1).
    pub shape: String,
    /// Meaning of the shape, which decides on its look.
    pub role: String,
    /// Coordinates [m].
    pub at: Vec<f64>,
    /// Outward normal of a supported edge.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub out: Option<[f64; 2]>,
    /// Full text, and the text that is drawn.
    #[serde(skip_serializing_if = "String::is_empty", default)]
    pub label: String,
    #[serde(skip_serializing_if = "String::is_empty", default)]
    pub short: String,
}

/// A part of the description of the model.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Part {
    pub title: String,
    pub facts: Vec<Fact>,
    /// Choices and simplifications with their reasons, a sentence each.
    pub lines: Vec<String>,
    pub tables: Vec<Table>,
}

/// A table of texts and numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    pub title: String,
    pub head: Vec<Column>,
    pub rows: Vec<Vec<Cell>>,
}

/// Heading of a column, and the unit of its numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Column {
    pub name: String,
    #[serde(default)]
    pub unit: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Cell {
    Number(f64),
    /// A number with a unit of its own.
    Quantity {
        value: f64,
        unit: String,
    },
    Text(String),
    /// A number that is not finite, or nothing.
    Nothing(()),
}

impl Cell {
    pub fn quantity(value: f64, unit: &str) -> Self {
        match value.is_finite() {
            true => Self::Quantity { value, unit: unit.to_owned() },
            false => Self::Nothing(()),
        }
    }
}

/// A droplet over time: its particles in a plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clip {
    pub title: String,
    /// Part of the droplet that is shown.
    pub about: String,
    pub axes: [String; 2],
    /// x0, y0, x1, y1 [m].
    pub bounds: [f64; 4],
    /// Diameter of a particle [m].
    pub size: f64,
    /// True if the other side of the axis looks alike and is drawn, too.
    pub is_mirrored: bool,
    /// [s]
    pub times: Vec<f64>,
    /// Number of particles at each time.
    pub counts: Vec<usize>,
    pub x: Array,
    pub y: Array,
    pub fields: Vec<Values>,
}

/// Values of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Values {
    pub name: String,
    pub unit: String,
    pub values: Array,
}

/// Layout of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Values over two axes.
    Grid,
    /// A meridian section: values over radius and height, drawn on both sides of the axis.
    Section,
    /// Values over the radius, drawn all around the axis.
    Round,
    /// Values over time and radius.
    Profile,
}

/// Values over a face or a section, over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    pub title: String,
    pub layout: Layout,
    /// True if a value belongs to a whole cell, false if values belong to nodes with linear ones between them.
    #[serde(default)]
    pub is_cells: bool,
    pub axes: [Axis; 2],
    /// [s]; of a profile none.
    pub times: Vec<f64>,
    /// The part in which most happens: ends along both axes.
    #[serde(default)]
    pub focus: Option<[f64; 4]>,
    /// Probes in the plane of the map.
    #[serde(default)]
    pub marks: Vec<Mark>,
    /// Values of all times, of each the second axis outermost.
    pub fields: Vec<Values>,
}

/// Nodes or middles of cells along an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    pub name: String,
    pub unit: String,
    pub values: Array,
    /// Outermost edges of cells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends: Option<[f64; 2]>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    pub name: String,
    pub at: [f64; 2],
}

/// Variables over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Histories {
    pub axis: Axis,
    /// Note on rows and variables that are left out.
    #[serde(default)]
    pub note: String,
    pub series: Vec<Series>,
}

/// A variable over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Series {
    pub name: String,
    pub unit: String,
    /// Title of the chart that shows it with others of its unit.
    pub group: String,
    pub about: String,
    pub values: Array,
}

/// A balance: amounts, and what is missing of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Balance {
    pub title: String,
    pub unit: String,
    pub terms: Vec<Term>,
    /// Share of the largest amount that is missing; none of amounts that need not add up.
    pub residual: Option<f64>,
    /// Largest share that is expected.
    pub expected: Option<f64>,
    #[serde(default)]
    pub about: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    pub label: String,
    pub value: f64,
}

/// Estimated errors of outputs, and what the scene allows.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Errors {
    pub tolerance: f64,
    pub bodies: Vec<BodyErrors>,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyErrors {
    pub body: String,
    pub outputs: Vec<ErrorOf>,
    pub notes: Vec<String>,
}

/// Error of an output, relative to its range, due to elements along the surface and through the thickness.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorOf {
    pub name: String,
    pub along: f64,
    pub through: f64,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    pub label: String,
    pub seconds: f64,
}

/// Rows of a study.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    pub columns: Vec<StudyColumn>,
    #[serde(default)]
    pub sensitivities: Vec<Sensitivity>,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyColumn {
    pub name: String,
    #[serde(default)]
    pub unit: String,
    #[serde(default)]
    pub about: String,
    /// `parameter`, `output`, `status` or `message`.
    pub role: String,
    pub values: Vec<Cell>,
}

/// Sobol's indices of an output.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensitivity {
    pub output: String,
    pub entries: Vec<SensitivityTo>,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensitivityTo {
    pub parameter: String,
    pub first: Option<f64>,
    pub first_confidence: Option<f64>,
    pub total: Option<f64>,
    pub total_confidence: Option<f64>,
}
