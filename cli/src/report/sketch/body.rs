//! Solids: their outlines, layers, faces and planes of symmetry.

use impinge::model::BodyForecast;
use impinge::scene::{Face, FaceName, Shape, Solid};

use super::view::{Views, Words};
use crate::check::bodies::{material, shape};
use crate::check::conditions::{mechanical, thermal};
use crate::check::words::{key, metres};

/// A quarter is meshed if the whole has more nodes than this many times its own.
const QUARTER: f64 = 2.0;

/// Half the width along x and y [m].
pub fn half_widths(solid: &Solid) -> [f64; 2] {
    match solid.shape {
        Shape::Box([x, y, _]) => [0.5 * x, 0.5 * y],
        Shape::Disc(disc) => [disc.radius; 2],
    }
}

/// Draws the outline, layers and faces of a solid.
pub fn draw(name: &str, solid: &Solid, views: &mut Views) {
    let ([half_x, half_y], thickness) = (half_widths(solid), solid.shape.thickness());
    let label = format!("{name}: {}", shape(&solid.shape));
    let outline = |label: &str| Words { label: label.to_owned(), short: name };
    views.side.rectangle("solid", [-half_x, -thickness, half_x, 0.0], outline(&label));
    let mut top = 0.0;
    for layer in solid.layers.iter().flatten() {
        let bottom: f64 = top - layer.thickness;
        let words = format!("{} of {}", metres(layer.thickness), material(&layer.material));
        let corners = [-half_x, bottom, half_x, top];
        views.side.rectangle("layer", corners, Words { label: words, short: "" });
        top = bottom;
    }
    match solid.shape {
        Shape::Box(_) => {
            views.top.rectangle("solid", [-half_x, -half_y, half_x, half_y], outline(&label));
        }
        Shape::Disc(disc) => {
            views.top.disc("solid", [0.0; 2], disc.radius, outline(&label));
            let axis = [[0.0, -thickness], [0.0, 0.15 * thickness]];
            let label = "axis of symmetry: a meridian section is modelled".to_owned();
            views.side.line("axis", axis, Words { label, short: "" });
        }
    }
    for face in solid.shape.faces() {
        draw_face(*face, &solid.face(*face), solid, views);
    }
}

/// Draws the support and the thermal condition of a face.
fn draw_face(name: FaceName, face: &Face, solid: &Solid, views: &mut Views) {
    let ([x, y], z) = (half_widths(solid), -solid.shape.thickness());
    let words = thermal(face);
    let support = match (face.clamped, face.roller) {
        (false, false) => None,
        (true, _) => Some("clamped"),
        (false, true) => Some("roller"),
    };
    let has_heat = face.temperature.is_some()
        || face.flux.is_some()
        || face.convection.is_some()
        || face.radiation.is_some();
    let (left, right) = ([[-x, z], [-x, 0.0]], [[x, z], [x, 0.0]]);
    let side: &[([[f64; 2]; 2], [f64; 2])] = match name {
        FaceName::Top => &[([[-x, 0.0], [x, 0.0]], [0.0, 1.0])],
        FaceName::Bottom => &[([[-x, z], [x, z]], [0.0, -1.0])],
        FaceName::Sides => &[(left, [-1.0, 0.0]), (right, [1.0, 0.0])],
        FaceName::Left => &[(left, [-1.0, 0.0])],
        FaceName::Right => &[(right, [1.0, 0.0])],
        FaceName::Front | FaceName::Back => &[],
    };
    let top: &[([[f64; 2]; 2], [f64; 2])] = match (name, solid.shape) {
        (FaceName::Front, _) => &[([[-x, -y], [x, -y]], [0.0, -1.0])],
        (FaceName::Back, _) => &[([[-x, y], [x, y]], [0.0, 1.0])],
        (FaceName::Left, _) => &[([[-x, -y], [-x, y]], [-1.0, 0.0])],
        (FaceName::Right, _) => &[([[x, -y], [x, y]], [1.0, 0.0])],
        _ => &[],
    };
    let label = format!("{}: {words}, {}", key(&name), mechanical(face));
    for (edges, drawing) in [(side, &mut views.side), (top, &mut views.top)] {
        for (i, (ends, out)) in edges.iter().enumerate() {
            if has_heat {
                let is_first = i == 0 && !matches!(name, FaceName::Right | FaceName::Back);
                let short = if is_first { words.as_str() } else { "" };
                drawing.edge("face", *ends, *out, Words { label: label.clone(), short });
            }
            if let Some(role) = support {
                drawing.edge(role, *ends, *out, Words { label: label.clone(), short: "" });
            }
        }
    }
}

/// Returns true if a quarter of a box is meshed.
pub fn is_quarter(body: &BodyForecast) -> bool {
    let meshed: usize = body.nodes.iter().product();
    body.nodes[1] > 1 && body.drawn as f64 > QUARTER * meshed as f64
}

/// Draws the two planes about which a box is mirrored.
pub fn draw_symmetry(solid: &Solid, views: &mut Views) {
    let ([x, y], z) = (half_widths(solid), -solid.shape.thickness());
    let words = || Words {
        label: "plane of symmetry: a quarter is modelled, loads are split into classes".to_owned(),
        short: "",
    };
    views.side.line("symmetry", [[0.0, z], [0.0, 0.0]], words());
    views.top.line("symmetry", [[0.0, -y], [0.0, y]], words());
    views.top.line("symmetry", [[-x, 0.0], [x, 0.0]], words());
}
