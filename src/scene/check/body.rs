//! Checks shape, material, faces, symmetry and mesh of each solid.

use super::{Checker, MOST_ELEMENTS, fits, is_sound, layers, material, nonlinear, number};
use crate::laws::solid::Elasticity;
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::types::{
    Face, FaceName, HeatMethod, Mesh, Role, Shape, Solid, SphOperator, Symmetry,
};

pub fn check(checker: &mut Checker) {
    material::named(checker);
    for (name, solid) in checker.scene.solids() {
        let path = Path::default().key("body").key(name);
        layers::check(checker, &path, solid);
        if checker.scene.needs_mechanics(name) {
            for (place, own) in solid.materials(&path) {
                // Laws that need them anyway were checked where they stand.
                if own.law.deformation().needs().is_empty() {
                    let why = "outputs or loads require stress, displacement or traction";
                    material::needs(checker, &place, own, Elasticity::needs(why));
                }
            }
        }
        nonlinear::check(checker, &path, solid);
        for (&name, face) in &solid.faces {
            let path = path.at("faces").key(name.as_str());
            place_of_face(checker, &path, solid, name);
            conditions(checker, &path, face);
            overlap_with_sides(checker, &path, solid, name);
        }
        symmetry(checker, &path.at("symmetry"), solid);
        if !solid.peaks.is_empty() {
            checker.distinct(&path.at("peaks"), &solid.peaks);
        }
        if is_sound(&solid.shape) {
            spacing(checker, &path.at("mesh"), &solid.mesh, &solid.shape);
        }
        sph(checker, &path, solid);
    }
}

fn place_of_face(checker: &mut Checker, path: &Path, solid: &Solid, name: FaceName) {
    let known = solid.shape.faces();
    let fine = known.contains(&name) || name == FaceName::Sides;
    let allowed = known.iter().map(|face| face.as_str()).collect::<Vec<_>>().join(", ");
    checker.require(fine, path, format!("a disc has no face `{}`", name.as_str()), allowed);
}

fn conditions(checker: &mut Checker, path: &Path, face: &Face) {
    for (kind, keys) in [("thermal", face.thermal()), ("mechanical", face.mechanical())] {
        let message = format!("a face takes one {kind} condition, not {}", keys.join(" and "));
        checker.require(keys.len() <= 1, path, message, format!("one of {}", keys.join(", ")));
    }
    let message = "a face of prescribed temperature has no other thermal condition";
    let fine = face.radiation.is_none() || face.temperature.is_none();
    checker.require(fine, &path.at("radiation"), message, "`temperature` or `radiation`");
    let has_value = face.temperature.is_some() || face.flux.is_some() || face.convection.is_some();
    let fine = has_value || face.role == Role::Input;
    let message = "this face has no value that could be a parameter";
    checker.require(fine, &path.at("role"), message, "with `temperature`, `flux` or `convection`");
}

/// Refuses conditions of the same kind on `sides` and on one of the four lateral faces; different kinds may be
/// combined.
fn overlap_with_sides(checker: &mut Checker, path: &Path, solid: &Solid, name: FaceName) {
    let Some(sides) = solid.faces.get(&FaceName::Sides) else { return };
    if !name.is_one_of_four_sides() {
        return;
    }
    let own = &solid.faces[&name];
    for (kind, own, sides) in [
        ("thermal", own.thermal(), sides.thermal()),
        ("mechanical", own.mechanical(), sides.mechanical()),
    ] {
        let fine = own.is_empty() || sides.is_empty();
        let message = format!("`sides` gives this face a {kind} condition already");
        let allowed = format!("a {kind} condition on `sides` or on its single faces");
        checker.require(fine, path, message, allowed);
    }
    let radiates = [own, sides].map(|face| face.radiation.is_some());
    let is_held = [own, sides].map(|face| face.temperature.is_some());
    let fine = !(radiates[0] && is_held[1] || radiates[1] && is_held[0]);
    let message = "a face of prescribed temperature has no other thermal condition, and `sides` is this face, too";
    checker.require(fine, path, message, "`temperature` or `radiation`");
}

fn symmetry(checker: &mut Checker, path: &Path, solid: &Solid) {
    match (solid.symmetry, &solid.shape) {
        (Symmetry::Axisymmetric, Shape::Box(_)) => {
            checker.refuse(path, "a box is not axisymmetric", "auto, none, quarter");
        }
        (Symmetry::Quarter | Symmetry::None, Shape::Disc(_)) => {
            checker.refuse(path, "a disc is modelled axisymmetric", "auto, axisymmetric");
        }
        (Symmetry::Quarter, Shape::Box(_)) => quarter(checker, path, solid),
        _ => {}
    }
}

fn quarter(checker: &mut Checker, path: &Path, solid: &Solid) {
    for (one, other) in [(FaceName::Left, FaceName::Right), (FaceName::Front, FaceName::Back)] {
        let conditions = |name| Face { role: Role::Input, ..solid.face(name) };
        let fine = conditions(one) == conditions(other);
        let (one, other) = (one.as_str(), other.as_str());
        let message = format!("a quarter needs equal conditions, but `{one}` and `{other}` differ");
        let allowed = format!("auto, none, or equal conditions on `{one}` and `{other}`");
        checker.require(fine, path, message, allowed);
    }
}

/// Checks the settings of particles and what they require of a body.
fn sph(checker: &mut Checker, path: &Path, solid: &Solid) {
    if solid.heat != HeatMethod::Sph {
        let message = "settings of particles, but finite elements conduct the heat";
        let allowed = "nothing here, or heat = \"sph\"";
        checker.require(solid.sph.is_none(), &path.at("sph"), message, allowed);
        return;
    }
    let order = solid.mesh.order.unwrap_or(1);
    let message =
        "particles require linear elements, whose nodes have volumes like those of particles";
    checker.require(order == 1, &path.at("mesh.order"), message, "1");
    if solid.sph.unwrap_or_default().operator == SphOperator::Plain {
        plain_operator(checker, path, solid);
    }
}

/// Refuses the plain operator on unequal distances, where its error remains finite.
fn plain_operator(checker: &mut Checker, path: &Path, solid: &Solid) {
    let mesh = &solid.mesh;
    let at = path.at("sph.operator");
    let message = "the plain operator needs particles at equal distances";
    let equal = mesh.spacing.is_some() && mesh.growth == Some(1.0) && mesh.depth_spacing.is_none();
    let allowed =
        "corrected, or a mesh with `spacing`, without `depth_spacing`, with `growth = 1.0`";
    checker.require(equal, &at, message, allowed);
    let message = "the plain operator knows no radius";
    let is_box = matches!(solid.shape, Shape::Box(_));
    checker.require(is_box, &at, message, "corrected, or a box");
}

fn spacing(checker: &mut Checker, path: &Path, mesh: &Mesh, shape: &Shape) {
    let [x, y] = lateral_extents(shape);
    let thickness = shape.thickness();
    if let Some(spacing) = mesh.spacing {
        let path = path.at("spacing");
        let fine = at_most(checker, &path, spacing, x.min(y) / 2.0, "half of the body's width");
        if fine && mesh.depth_spacing.is_none() {
            let what = "the body's thickness, to which it applies unless `depth_spacing` is given";
            at_most(checker, &path, spacing, thickness, what);
        }
        not_too_fine(checker, &path, spacing, x.max(y));
    }
    if let Some(spacing) = mesh.depth_spacing {
        let path = path.at("depth_spacing");
        at_most(checker, &path, spacing, thickness, "the body's thickness");
        not_too_fine(checker, &path, spacing, thickness);
    }
}

/// Refuses node distances whose number of nodes would be too large to count.
fn not_too_fine(checker: &mut Checker, path: &Path, spacing: f64, extent: f64) {
    let least = extent / MOST_ELEMENTS;
    let message = "the body would have more elements than a mesh can have";
    let fine = spacing <= 0.0 || spacing >= least;
    checker.require(fine, path, message, format!("{} >= {}", path.last_key(), number(least)));
}

fn at_most(checker: &mut Checker, path: &Path, spacing: f64, limit: f64, what: &str) -> bool {
    let message = if spacing <= 0.0 {
        "the distance of nodes must be positive".to_owned()
    } else if !fits(spacing, limit) {
        format!("the distance of nodes exceeds {what}")
    } else {
        return true;
    };
    checker.refuse(path, message, format!("0 < {} <= {}", path.last_key(), number(limit)));
    false
}
