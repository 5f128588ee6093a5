//! Checks that fields of means lie on faces that have such cells.

use super::load::{check_ring, loaded_faces};
use super::{Checker, fits, number};
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::types::{Field, Footprint, Shape};

/// Checks a field on a footprint.
pub fn check(checker: &mut Checker, path: &Path, field: &Field, footprint: &Footprint) {
    check_ring(checker, &path.at("footprint.ring"), footprint);
    for (key, given) in [
        ("in", field.body.is_some()),
        ("plane", field.plane.is_some()),
        ("grid", field.grid.is_some()),
        ("size", field.size.is_some()),
    ] {
        let message = "a field on a `footprint` gives means over its cells, on a face";
        checker.require(!given, &path.at(key), message, "`on`, `footprint`, `at`");
    }
    let Some(on) = &field.on else {
        let message = "a field on a `footprint` needs a face";
        checker.refuse(path, message, "`on = \"BODY.top\"` or `\"BODY.bottom\"`");
        return;
    };
    let Some((_, solid)) = checker.face(&path.at("on"), on, loaded_faces) else { return };
    if let Shape::Disc(_) = solid.shape {
        axisymmetry(checker, path, field, footprint);
    }
    if checker.is_fine(&path.at("footprint")) && checker.is_fine(&path.at("at")) {
        stays_on_face(checker, path, field, footprint, &solid.shape);
    }
}

/// Checks a field on a disc, which is modelled in its meridian section.
fn axisymmetry(checker: &mut Checker, path: &Path, field: &Field, footprint: &Footprint) {
    if let Footprint::Tiles { .. } = footprint {
        let message = "a disc is modelled axisymmetric, which tiles are not";
        checker.refuse(&path.at("footprint.tiles"), message, "disc, gaussian, ring, rings");
    }
    let message = "a disc is modelled axisymmetric: means on it are centred";
    checker.require(field.at.is_none(), &path.at("at"), message, "no `at` on a disc");
}

fn stays_on_face(
    checker: &mut Checker,
    path: &Path,
    field: &Field,
    footprint: &Footprint,
    shape: &Shape,
) {
    let halves = footprint.half_extents(None);
    let centre = field.at.unwrap_or_default();
    for (axis, limit) in lateral_extents(shape).map(|extent| extent / 2.0).into_iter().enumerate() {
        let fine = fits(centre[axis].abs() + halves[axis], limit);
        let key = match field.at {
            Some(_) if fits(halves[axis], limit) => path.at("at").index(axis),
            _ => path.at(&format!("footprint.{}.{}", footprint.name(), footprint.key_of_extent())),
        };
        let extent = footprint.radius().map_or("half of the size", |_| "radius");
        let allowed = format!("|{}| + {extent} <= {}", ["x", "y"][axis], number(limit));
        let message = "the footprint does not stay on the face";
        if !checker.require(fine, &key, message, allowed) {
            return;
        }
    }
}
