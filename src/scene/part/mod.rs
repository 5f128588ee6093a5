//! Bodies of solids of large strain from files: cells between nodes in VTK's XML, or points with volumes as text.
//!
//! A part of which something is guessed is no part: what is not understood is refused with its line.

mod csv;
mod vtu;

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::length;
use crate::scene::face::FaceName;
use crate::scene::files::with_line_feeds;
use crate::scene::locate::shortened;
use crate::space::{Cloud, Form, Mesh, Side};

/// A body whose cells or points are in a file; its coordinates are those of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Name of the file, beside the scene or in a folder below it; packing copies it into the unit.
    #[schemars(extend("condition" = "`.vtu` with cells, `.csv` with points; see above"))]
    pub file: String,
    /// Length of a unit of the file's coordinates [m].
    #[serde(default = "metre")]
    #[schemars(transform = length("the unit of coordinates"))]
    pub unit: f64,
    /// Coordinates of the file that are x and z of a section.
    #[serde(default)]
    #[schemars(extend("condition" = "with `dimension = 2` or `symmetry = \"axisymmetric\"`"))]
    pub axes: SectionAxes,
    /// Content of the file, which is read with the scene.
    #[serde(skip)]
    pub content: Option<Arc<Result<PartBody, BadPart>>>,
}

/// Coordinates of a file that are x and z of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SectionAxes {
    /// x and z.
    #[default]
    Xz,
    /// x and y.
    Xy,
}

/// The cells or points of a part.
#[derive(Debug, Clone, PartialEq)]
pub enum PartBody {
    Cells(Mesh),
    Points(Cloud),
}

/// Reason why a file describes no part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadPart {
    /// Counted from 1; `None` for the whole file.
    pub line: Option<usize>,
    /// Text of the line or value; empty for the whole file.
    pub text: String,
    pub message: String,
    pub allowed: String,
}

const fn metre() -> f64 {
    1.0
}

/// Names of faces in files, in the order of their numbers, which begin with 1.
const FACES: [(FaceName, Side); 7] = [
    (FaceName::Left, Side::Left),
    (FaceName::Right, Side::Right),
    (FaceName::Front, Side::Front),
    (FaceName::Back, Side::Back),
    (FaceName::Bottom, Side::Bottom),
    (FaceName::Top, Side::Top),
    (FaceName::Sides, Side::Round),
];

/// Largest coordinate [m].
const FARTHEST: f64 = 1e6;

impl BadPart {
    fn whole(message: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { line: None, text: String::new(), message: message.into(), allowed: allowed.into() }
    }

    fn at(
        (line, text): (usize, &str),
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        let text = shortened(text.trim());
        Self { line: Some(line), text, message: message.into(), allowed: allowed.into() }
    }
}

impl Part {
    /// Reads the text of the file for a model.
    pub(super) fn read(&mut self, text: &str, form: Form) {
        let read = if self.is_of_points() { csv::read } else { vtu::read };
        // Spreadsheets begin a text with a byte order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        self.content = Some(Arc::new(read(&with_line_feeds(text), self, form)));
    }

    /// Returns true if the name of the file is that of one with points.
    pub fn is_of_points(&self) -> bool {
        self.file.to_lowercase().ends_with(".csv")
    }

    /// Returns true if the name of the file is that of one with points or cells.
    pub fn is_known(&self) -> bool {
        self.is_of_points() || self.file.to_lowercase().ends_with(".vtu")
    }

    /// The body, if the file describes one.
    pub fn body(&self) -> Option<&PartBody> {
        self.content.as_ref().and_then(|content| content.as_ref().as_ref().ok())
    }

    /// Reason why the file describes no part, if it has been read and describes none.
    pub fn bad(&self) -> Option<&BadPart> {
        self.content.as_ref().and_then(|content| content.as_ref().as_ref().err())
    }

    /// Places of the nodes or points [m]; none if the file describes no body.
    pub fn nodes(&self) -> &[[f64; 3]] {
        match self.body() {
            Some(PartBody::Cells(mesh)) => &mesh.nodes,
            Some(PartBody::Points(cloud)) => &cloud.nodes,
            None => &[],
        }
    }

    /// Lowest and highest coordinates [m]; zeros if the file describes no body.
    pub fn ranges(&self) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|axis| {
            let along = self.nodes().iter().map(|at| at[axis]);
            let range = along.fold(None, |range: Option<[f64; 2]>, x| {
                Some(range.map_or([x; 2], |[low, high]| [low.min(x), high.max(x)]))
            });
            range.unwrap_or_default()
        })
    }

    /// Mean distance of nodes or points [m]; zero if the file describes no body.
    pub fn spacing(&self) -> f64 {
        match self.body() {
            Some(PartBody::Cells(mesh)) => mean_spacing(mesh),
            Some(PartBody::Points(cloud)) => cloud.spacing(),
            None => 0.0,
        }
    }

    /// Faces that the file names, or that its shape has.
    pub fn faces(&self) -> Vec<FaceName> {
        let has = |side: Side| match self.body() {
            Some(PartBody::Cells(mesh)) => mesh.faces.iter().any(|(own, _)| *own == side),
            Some(PartBody::Points(cloud)) => cloud.patches.iter().any(|own| own.side == side),
            None => false,
        };
        FACES.into_iter().filter(|(_, side)| has(*side)).map(|(face, _)| face).collect()
    }

    /// Axis of the plane on which a face lies; `None` if it is not on one that bounds the body, or is one of points.
    pub fn axis_of(&self, face: FaceName) -> Option<usize> {
        let (_, side) = FACES.into_iter().find(|(own, _)| *own == face)?;
        match self.body()? {
            PartBody::Cells(mesh) => mesh.plane_of(side).map(|(axis, _)| axis),
            PartBody::Points(_) => None,
        }
    }
}

/// Mean edge of the cells.
fn mean_spacing(mesh: &Mesh) -> f64 {
    let edges = mesh.edges();
    let length = |[a, b]: &[u32; 2]| {
        let [a, b] = [a, b].map(|&node| mesh.nodes[node as usize]);
        (0..3).map(|n| (a[n] - b[n]).powi(2)).sum::<f64>().sqrt()
    };
    edges.iter().map(length).sum::<f64>() / edges.len() as f64
}

/// Place in the model of coordinates in the file; a section has no y.
fn place(part: &Part, form: Form, own: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = own.map(|x| x * part.unit);
    match (form, part.axes) {
        (Form::Solid, _) => [x, y, z],
        (_, SectionAxes::Xz) => [x, 0.0, z],
        (_, SectionAxes::Xy) => [x, 0.0, y],
    }
}

/// Names of the coordinates that a model has in the file.
fn names(part: &Part, form: Form) -> &'static [&'static str] {
    match (form, part.axes) {
        (Form::Solid, _) => &["x", "y", "z"],
        (_, SectionAxes::Xz) => &["x", "z"],
        (_, SectionAxes::Xy) => &["x", "y"],
    }
}

#[cfg(test)]
mod tests;
