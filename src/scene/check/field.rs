//! Checks that fields lie on a face or section of their bodies and have outputs.

use super::{Checker, field_cells, fits, is_in_depth, is_sound, number, probe};
use crate::scene::LargeStrain;
use crate::scene::grid::{Grid, lateral_extents, section_size};
use crate::scene::locate::Path;
use crate::scene::lookup::{Place, split_place};
use crate::scene::types::{Disc, FaceName, Field, Gives, Plane, Shape, Solid};

pub fn check(checker: &mut Checker) {
    for (i, field) in checker.scene.field.iter().enumerate() {
        let path = Path::default().key("field").index(i);
        checker.distinct(&path.at("gives"), &field.gives);
        let is_fine = checker.is_fine(&path.at("grid")) && checker.is_fine(&path.at("size"));
        let name = field.body().unwrap_or_default();
        if let Some(solid) = checker.scene.large_strain(name) {
            of_large_strain(checker, &path, field, (name, solid), is_fine);
            continue;
        }
        if let Some(footprint) = &field.footprint {
            field_cells::check(checker, &path, field, footprint);
            if let Some(solid) = field.body().and_then(|body| checker.scene.solid(body)) {
                let body = field.body().unwrap_or_default();
                probe::gives_of_solid(checker, &path, &field.gives, (body, solid));
            }
            continue;
        }
        points(checker, &path, field);
        let place = place(checker, &path, field);
        if let Some((_, solid)) = place {
            let body = field.body().unwrap_or_default();
            probe::gives_of_solid(checker, &path, &field.gives, (body, solid));
            surface_density(checker, &path, field);
        }
        if let Some((place, solid)) = place.filter(|_| is_fine) {
            extent(checker, &path.at("size"), &Grid::at(place, field, &solid.shape), &solid.shape);
        }
    }
}

/// Refuses a density over the faces in a section.
fn surface_density(checker: &mut Checker, path: &Path, field: &Field) {
    let place = field.gives.iter().position(|gives| *gives == Gives::SurfaceFailureDensity);
    if let Some(place) = place.filter(|_| field.on.is_none()) {
        let message = "a section lies within the body, whose flaws are on its faces";
        let path = path.at("gives").index(place);
        checker.refuse(&path, message, "`on = \"BODY.FACE\"`, or quantities of the interior");
    }
}

/// Checks a field without footprint: it has a grid, and no position of a footprint.
fn points(checker: &mut Checker, path: &Path, field: &Field) {
    let message = "a field gives values at the points of a `grid` or means over a `footprint`";
    let allowed = "`grid = [NX, NY]` or `footprint = { … }`";
    checker.require(field.grid.is_some(), path, message, allowed);
    let message = "`at` places a footprint; a grid is centred on its face or section";
    checker.require(field.at.is_none(), &path.at("at"), message, "`at` with `footprint`");
}

/// Checks a field in a solid of large strain: points on a plane face or in a section of a box or a disc.
fn of_large_strain(
    checker: &mut Checker,
    path: &Path,
    field: &Field,
    (name, solid): (&str, &LargeStrain),
    is_fine: bool,
) {
    let message = "a field in a solid of large strain has values at points";
    let fine = field.footprint.is_none();
    if !checker.require(fine, &path.at("footprint"), message, "`grid = [NX, NY]`") {
        return;
    }
    points(checker, path, field);
    probe::gives_of_large_strain(checker, path, &field.gives, (name, solid));
    let at = path.at(if field.on.is_some() { "on" } else { "in" });
    let Some(shape) = solid.plate() else {
        let message = "this shape has neither faces nor sections with a grid for a field";
        checker.refuse(&at, message, "a box or a disc; or probes");
        return;
    };
    if !is_sound(&shape) {
        return;
    }
    let place = match (&field.on, &field.body, field.plane) {
        (Some(on), None, None) => {
            let faces = plane_faces(&shape);
            let own = split_place(on).map(|(_, face)| face).filter(|face| faces.contains(face));
            if own.is_none() {
                let names: Vec<String> =
                    faces.iter().map(|face| format!("{name}.{}", face.as_str())).collect();
                let message = format!("`{on}` is no face for this");
                checker.refuse(&at, message, names.join(", "));
            }
            own.map(Place::Face)
        }
        (None, Some(_), Some(plane)) => {
            let fine = plane_is_inside(checker, &path.at("plane"), plane, &shape);
            fine.then_some(Place::Section(plane))
        }
        _ => {
            let message = "a field lies either on a face or in a plane of a body";
            checker.refuse(path, message, "`on`, or `in` together with `plane`");
            None
        }
    };
    if let Some(place) = place.filter(|_| is_fine) {
        extent(checker, &path.at("size"), &Grid::at(place, field, &shape), &shape);
    }
}

/// The face or section and the body that it belongs to.
fn place<'a>(checker: &mut Checker<'a>, path: &Path, field: &Field) -> Option<(Place, &'a Solid)> {
    match (&field.on, &field.body, field.plane) {
        (Some(on), None, None) => {
            let (face, solid) = checker.face(&path.at("on"), on, plane_faces)?;
            Some((Place::Face(face), solid))
        }
        (None, Some(body), Some(plane)) => {
            let solid = checker.body(&path.at("in"), body)?;
            let fine = plane_is_inside(checker, &path.at("plane"), plane, &solid.shape);
            fine.then_some((Place::Section(plane), solid))
        }
        _ => {
            let message = "a field lies either on a face or in a plane of a body";
            checker.refuse(path, message, "`on`, or `in` together with `plane`");
            None
        }
    }
}

/// The faces on which a field may lie: those described by two coordinates.
fn plane_faces(shape: &Shape) -> Vec<FaceName> {
    shape.faces().iter().copied().filter(|face| face.normal().is_some()).collect()
}

fn plane_is_inside(checker: &mut Checker, path: &Path, plane: Plane, shape: &Shape) -> bool {
    let offset = plane.offset();
    let half = lateral_extents(shape).map(|extent| extent / 2.0);
    let (axis, fine, allowed) = match (plane, shape) {
        (Plane::Z(_), _) => {
            let thickness = shape.thickness();
            let allowed = format!("{} <= z <= 0", number(-thickness));
            ("z", is_in_depth(offset, thickness), allowed)
        }
        (Plane::X(_), Shape::Box(_)) => box_plane("x", offset, half[0]),
        (Plane::Y(_), Shape::Box(_)) => box_plane("y", offset, half[1]),
        (Plane::X(_), Shape::Disc(_)) => disc_plane("x", offset, half[0]),
        (Plane::Y(_), Shape::Disc(_)) => disc_plane("y", offset, half[1]),
    };
    checker.require(fine, &path.at(axis), "the plane does not cut the body", allowed)
}

fn box_plane(axis: &'static str, offset: f64, half: f64) -> (&'static str, bool, String) {
    (axis, fits(offset.abs(), half), format!("|{axis}| <= {}", number(half)))
}

/// At the radius itself the section has no width.
fn disc_plane(axis: &'static str, offset: f64, radius: f64) -> (&'static str, bool, String) {
    (axis, offset.abs() < radius, format!("|{axis}| < {}", number(radius)))
}

fn extent(checker: &mut Checker, path: &Path, grid: &Grid, shape: &Shape) {
    let limits = section_size(shape, grid.normal, grid.offset);
    let mut all_fine = true;
    for (i, limit) in limits.into_iter().enumerate() {
        let message = "the grid is larger than the face or section";
        let allowed = format!("0 < size <= {}", number(limit));
        all_fine &= checker.require(fits(grid.size[i], limit), &path.index(i), message, allowed);
    }
    if let (Shape::Disc(Disc { radius, .. }), 2, true) = (shape, grid.normal, all_fine) {
        let [x, y, _] = grid.point(0, 0);
        let message = "points of the grid lie outside of the disc";
        let allowed = format!("points at most {} from the axis", number(*radius));
        checker.require(fits(x.hypot(y), *radius), path, message, allowed);
    }
}
