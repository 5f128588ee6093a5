//! Checks that bodies with mechanical outputs are supported against rigid motion.

use super::Checker;
use crate::scene::locate::Path;
use crate::scene::types::{FaceName, Shape, Solid};

pub fn check(checker: &mut Checker) {
    for (name, solid) in checker.scene.solids() {
        if checker.scene.asks_mechanics(name) {
            let free = free_motions(solid);
            let scene = checker.scene;
            let (why, spare) = if scene.gives_mechanics(name) {
                ("stress or displacement is an output", "")
            } else if scene.needs_mechanics(name) {
                ("a load carries traction", "")
            } else {
                (
                    "drops or strands push the body",
                    "; or `traction = false` in the `[[coupling]]`, for heat alone",
                )
            };
            let against = free.join(", ");
            let message = format!("{why}, but nothing supports the body against {against}");
            let path = Path::default().key("body").key(name);
            checker.require(free.is_empty(), &path, message, format!("{}{spare}", remedy(solid)));
        }
    }
}

fn free_motions(solid: &Solid) -> Vec<&'static str> {
    let faces = solid.shape.faces().iter().map(|&name| (name, solid.face(name)));
    if faces.clone().any(|(_, face)| face.clamped) {
        return Vec::new();
    }
    let rollers: Vec<_> = faces.filter(|(_, face)| face.roller).map(|(name, _)| name).collect();
    match solid.shape {
        Shape::Box(_) => {
            let all = free_motions_of_box(&rollers).into_iter();
            all.filter(|motion| solid.section.is_none() || IN_SECTION.contains(motion)).collect()
        }
        Shape::Disc(_) => free_motions_of_disc(&rollers),
    }
}

/// Motions in a plane section.
const IN_SECTION: [&str; 3] = ["translation along x", "translation along z", "rotation about y"];

/// Rigid motions that rollers leave free. A roller blocks the translation along its normal and the rotations about the
/// axes in its face.
fn free_motions_of_box(rollers: &[FaceName]) -> Vec<&'static str> {
    let normals: Vec<_> = rollers.iter().filter_map(|face| face.normal()).collect();
    let translations = ["translation along x", "translation along y", "translation along z"];
    let rotations = ["rotation about x", "rotation about y", "rotation about z"];
    let moves = (0..3).filter(|axis| !normals.contains(axis)).map(|axis| translations[axis]);
    let turns = (0..3)
        .filter(|axis| !normals.iter().any(|normal| normal != axis))
        .map(|axis| rotations[axis]);
    moves.chain(turns).collect()
}

/// Rigid motions of a disc that rollers leave free. Axisymmetry leaves only the one along its axis; the lateral face
/// slides in it.
fn free_motions_of_disc(rollers: &[FaceName]) -> Vec<&'static str> {
    let held = rollers.iter().any(|face| face.normal() == Some(2));
    if held { Vec::new() } else { vec!["translation along z"] }
}

fn remedy(solid: &Solid) -> &'static str {
    match solid.shape {
        Shape::Box(_) if solid.section.is_some() => {
            "a face with `clamped = true`, or `roller = true` on `left` or `right` and on `top` or `bottom`"
        }
        Shape::Box(_) => {
            "a face with `clamped = true`, or faces of all three normals with `roller = true`"
        }
        Shape::Disc(_) => "a face with `clamped = true`, or `roller = true` on `top` or `bottom`",
    }
}
