//! Checks that flaws lie in their bodies and layers, and that their planes are possible.

use super::{Checker, SLACK, number, probe};
use crate::scene::flaw::{Flaw, FlawGives, FlawShape};
use crate::scene::locate::Path;
use crate::scene::types::{FaceName, Shape, Solid};

/// Largest cosine between a crack plane's normal and that of its face.
const TANGENTIAL: f64 = 1e-6;
/// Number of points of a penny's rim that are checked.
const RIM: usize = 8;

pub fn check(checker: &mut Checker) {
    for (i, flaw) in checker.scene.flaw.iter().enumerate() {
        let path = Path::default().key("flaw").index(i);
        checker.distinct(&path.at("gives"), &flaw.gives);
        let Some(solid) = checker.body(&path.at("in"), &flaw.body) else { continue };
        let is_reduced = checker.scene.is_reduced(&flaw.body);
        let message = format!("`{}` is a reduced model, which has no flaws", flaw.body);
        checker.require(!is_reduced, &path.at("in"), message, "fidelity full, auto");
        let has_normal = flaw.unit_normal().iter().all(|part| part.is_finite());
        let message = "the normal has no direction";
        if !checker.require(has_normal, &path.at("normal"), message, "a vector other than zero") {
            continue;
        }
        match flaw.shape {
            FlawShape::Edge => edge(checker, &path, flaw, solid),
            FlawShape::Penny => penny(checker, &path, flaw, solid),
        }
        toughness(checker, &path, flaw, solid);
        growth(checker, &path, flaw, solid);
    }
}

/// Growth needs a depth to start from, a line along which K is known, and a toughness.
fn growth(checker: &mut Checker, path: &Path, flaw: &Flaw, solid: &Solid) {
    if flaw.growth.is_none() {
        return;
    }
    let own = path.at("growth");
    let message = "a worst flaw has no depth from which it grows";
    let is_given = flaw.depth.given().is_some();
    checker.require(is_given, &path.at("depth"), message, "a depth (m), or no `growth`");
    let message = "the stress around a penny is known at its radius only";
    let is_edge = flaw.shape == FlawShape::Edge;
    checker.require(is_edge, &path.at("shape"), message, "edge, or no `growth`");
    let message = "the material here has no `toughness`, to which the speed refers";
    let allowed = "a `toughness` (Pa √m) of the material, or no `growth`";
    checker.require(has_toughness(flaw, solid), &own, message, allowed);
}

fn has_toughness(flaw: &Flaw, solid: &Solid) -> bool {
    let layers = solid.materials_of_layers();
    let material = layers.get(flaw.layer(solid));
    material.is_some_and(|own| own.fracture.toughness.is_some())
}

fn edge(checker: &mut Checker, path: &Path, flaw: &Flaw, solid: &Solid) {
    let is_inside = probe::contains(&solid.shape, flaw.at);
    let Some(face) = flaw.face(&solid.shape).filter(|_| is_inside) else {
        let message = format!("the mouth of an edge crack lies on no face of `{}`", flaw.body);
        let allowed = format!("a point of a face: {}", probe::inside(&solid.shape));
        checker.refuse(&path.at("at"), message, allowed);
        return;
    };
    let inward = flaw.inward(face);
    let cosine: f64 = flaw.unit_normal().iter().zip(inward).map(|(a, b)| a * b).sum();
    let message = format!("the crack plane is not perpendicular to the {}", face.as_str());
    let is_tangential = cosine.abs() <= TANGENTIAL;
    checker.require(is_tangential, &path.at("normal"), message, "a vector along the face");
    let Some(depth) = flaw.depth.given() else { return };
    let reach = flaw.reach(solid, face);
    let what = match face {
        FaceName::Top | FaceName::Bottom if solid.layers.is_some() => "its layer",
        _ => "the body",
    };
    let message = format!("the crack is deeper than {what}");
    let allowed = format!("0 < depth < {}", number(reach));
    checker.require(depth < reach, &path.at("depth"), message, allowed);
}

fn penny(checker: &mut Checker, path: &Path, flaw: &Flaw, solid: &Solid) {
    let Some(radius) = flaw.depth.given() else {
        let message = "a penny has no worst radius: under uniform stress larger ones are worse";
        checker.refuse(&path.at("depth"), message, "a radius (m)");
        return;
    };
    let [bottom, top] = solid.strata()[flaw.layer(solid)].z;
    let slack = SLACK * solid.shape.thickness();
    let rim = (0..RIM).map(|i| flaw.on_plane(radius, i as f64 / RIM as f64));
    let is_inside = rim.into_iter().chain([flaw.at]).all(|point| {
        let [_, _, z] = point;
        probe::contains(&solid.shape, point) && z >= bottom - slack && z <= top + slack
    });
    let message = "equal pennies in a row are not modelled";
    checker.require(flaw.spacing.is_none(), &path.at("spacing"), message, "`shape = \"edge\"`");
    let out_of = match &solid.layers {
        None => format!("`{}`", flaw.body),
        Some(_) => {
            format!("its layer of `{}`, from z = {} to {}", flaw.body, number(bottom), number(top))
        }
    };
    let message = format!("the crack reaches out of {out_of}");
    let allowed = centres(flaw, radius, &solid.shape, [bottom, top]);
    checker.require(is_inside, &path.at("at"), message, allowed);
}

/// Places of the centre at which a penny of a radius [m] lies within its layer, or the radii of pennies for which there
/// are any.
fn centres(flaw: &Flaw, radius: f64, shape: &Shape, [bottom, top]: [f64; 2]) -> String {
    // Half the extents of a penny along the axes, over its radius.
    let [x, y, z] = flaw.unit_normal().map(|part| (1.0 - part * part).max(0.0).sqrt());
    let (rooms, lateral): ([f64; 2], _) = match *shape {
        Shape::Box([lx, ly, _]) => {
            let rooms = [0.5 * lx, 0.5 * ly];
            let [of_x, of_y] = [rooms[0] - radius * x, rooms[1] - radius * y].map(number);
            ([rooms[0] / x, rooms[1] / y], format!("|x| <= {of_x}, |y| <= {of_y}"))
        }
        Shape::Disc(disc) => {
            let most = number(disc.radius - radius);
            ([disc.radius; 2], format!("sqrt(x² + y²) <= {most}"))
        }
    };
    let most = rooms.into_iter().fold(0.5 * (top - bottom) / z, f64::min);
    if radius >= most {
        return format!("a `depth` below {} in the middle of its layer", number(most));
    }
    let [low, high] = [bottom + radius * z, top - radius * z].map(number);
    let is_between = flaw.at[2] > bottom && flaw.at[2] < top && probe::contains(shape, flaw.at);
    let smaller = if is_between { ", or a smaller `depth`" } else { "" };
    format!("its centre in {lateral}, {low} <= z <= {high}{smaller}")
}

/// Safety needs the toughness of the layer.
fn toughness(checker: &mut Checker, path: &Path, flaw: &Flaw, solid: &Solid) {
    let place = flaw.gives.iter().position(|gives| *gives == FlawGives::Safety);
    if let Some(place) = place.filter(|_| !has_toughness(flaw, solid)) {
        let message = "the material here has no `toughness`";
        let allowed = "stress_intensity, energy_release_rate, or a toughness (Pa √m)";
        checker.refuse(&path.at("gives").index(place), message, allowed);
    }
}
