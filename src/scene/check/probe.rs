//! Checks that probes lie in their bodies and have outputs.

use super::{Checker, fits, is_in_depth, number};
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::types::{Disc, Gives, Probe, Shape, Solid};
use crate::scene::{LargeStrain, PartBody, SolidShape};
use crate::space::{Form, contains as contains_place};

pub fn check(checker: &mut Checker) {
    for (i, probe) in checker.scene.probe.iter().enumerate() {
        let path = Path::default().key("probe").index(i);
        checker.distinct(&path.at("gives"), &probe.gives);
        if let Some(solid) = checker.scene.large_strain(&probe.body) {
            large_strain(checker, &path, probe, solid);
            continue;
        }
        if let Some(solid) = checker.body(&path.at("in"), &probe.body) {
            place(checker, &path.at("at"), probe, &solid.shape);
            side(checker, &path.at("side"), probe, solid);
            gives_of_solid(checker, &path, &probe.gives, (&probe.body, solid));
            surface_density(checker, &path, probe, &solid.shape);
        }
    }
}

/// Checks a probe in a solid of large strain.
fn large_strain(checker: &mut Checker, path: &Path, probe: &Probe, solid: &LargeStrain) {
    if solid.extents().iter().all(|extent| *extent > 0.0) {
        let message = format!("the point lies outside of `{}`", probe.body);
        let at = path.at("at");
        match (solid.plate(), &solid.shape) {
            (Some(shape), _) => {
                checker.require(contains(&shape, probe.at), &at, message, inside(&shape));
            }
            (None, SolidShape::Ball(ball)) => {
                let [x, y, z] = probe.at;
                let fine = fits(x.hypot(y).hypot(z), ball.radius);
                let allowed = format!("sqrt(x² + y² + z²) <= {}", number(ball.radius));
                checker.require(fine, &at, message, allowed);
            }
            (None, SolidShape::Quadrilateral(own)) => {
                let [x, y, z] = probe.at;
                let deep = own.depth.is_none_or(|depth| fits(y.abs(), 0.5 * depth));
                let fine = !own.is_convex() || own.contains([x, z]) && deep;
                checker.require(fine, &at, message, "x and z between the corners, |y| <= depth/2");
            }
            (None, SolidShape::Strand(own)) => {
                let shape = Path::default().key("body").key(&probe.body).at("shape");
                let fine = !checker.is_fine(&shape) || own.sweep(solid.form()).contains(probe.at);
                let allowed = format!("a place up to {} m from the path", number(own.radius));
                checker.require(fine, &at, message, allowed);
            }
            (None, SolidShape::Part(part)) => {
                let [x, y, z] = probe.at;
                let place = match solid.form() {
                    Form::Solid => probe.at,
                    Form::Plane => [x, 0.0, z],
                    Form::Axisymmetric => [x.hypot(y), 0.0, z],
                };
                let fine = match part.body() {
                    Some(PartBody::Cells(mesh)) => contains_place(mesh, place),
                    Some(PartBody::Points(cloud)) => cloud.contains(place),
                    None => true,
                };
                checker.require(fine, &at, message, "a place in a cell or about a point");
            }
            (None, _) => {}
        }
    }
    let message = "at an interface a solid of large strain is read above it";
    checker.require(probe.side.is_none(), &path.at("side"), message, "no `side`");
    gives_of_large_strain(checker, path, &probe.gives, (&probe.body, solid));
}

/// Refuses quantities that a solid of large strain does not have.
pub fn gives_of_large_strain(
    checker: &mut Checker,
    path: &Path,
    gives: &[Gives],
    (name, solid): (&str, &LargeStrain),
) {
    let yields = solid.yields();
    for (n, gives) in gives.iter().enumerate() {
        let (fine, what) = match gives {
            Gives::PlasticStrain => (yields, "yields or cracks"),
            Gives::Damage => (false, "yields or cracks"),
            Gives::FailureDensity | Gives::SurfaceFailureDensity => (false, "has `weibull` flaws"),
            _ => continue,
        };
        let message = format!("no part of `{name}` {what}");
        let allowed = "what an elastic body gives";
        checker.require(fine, &path.at("gives").index(n), message, allowed);
    }
}

/// Refuses quantities that a solid does not have: plastic strain of bodies that do not yield, damage of bodies that do
/// not crack, and densities of failure of bodies without such flaws.
pub fn gives_of_solid(
    checker: &mut Checker,
    path: &Path,
    gives: &[Gives],
    (name, solid): (&str, &Solid),
) {
    for (n, gives) in gives.iter().enumerate() {
        let (fine, what, allowed) = match gives {
            Gives::PlasticStrain => {
                (solid.yields(), "yields", "what a body without a yield stress gives")
            }
            Gives::Damage => (solid.cracks(), "cracks", "what a body without `fracture` gives"),
            Gives::FailureDensity => (
                solid.has_flaws_of(|own| own.area.is_none()),
                "has `weibull` flaws in its volume",
                "`surface_failure_density` with `weibull = { area = … }`, or what a body without flaws gives",
            ),
            Gives::SurfaceFailureDensity => (
                solid.has_flaws_of(|own| own.area.is_some()),
                "has `weibull` flaws on its faces",
                "`failure_density` with `weibull = { volume = … }`, or what a body without flaws gives",
            ),
            _ => continue,
        };
        let message = format!("no part of `{name}` {what}");
        checker.require(fine, &path.at("gives").index(n), message, allowed);
    }
}

/// Refuses densities over the faces at points within a body.
fn surface_density(checker: &mut Checker, path: &Path, probe: &Probe, shape: &Shape) {
    let place = probe.gives.iter().position(|gives| *gives == Gives::SurfaceFailureDensity);
    if let Some(place) = place.filter(|_| !is_on_face(shape, probe.at)) {
        let message =
            format!("the point lies within `{}`, whose flaws are on its faces", probe.body);
        let path = path.at("gives").index(place);
        checker.refuse(&path, message, "`at` on a face, or quantities of the interior");
    }
}

/// Returns true if a point of a body is on one of its faces.
fn is_on_face(shape: &Shape, [x, y, z]: [f64; 3]) -> bool {
    let at = |value: f64, end: f64| fits(value, end) && fits(end, value);
    let lateral = match shape {
        Shape::Box([length, width, _]) => at(x.abs(), length / 2.0) || at(y.abs(), width / 2.0),
        Shape::Disc(disc) => at(x.hypot(y), disc.radius),
    };
    lateral || z == 0.0 || at(-z, shape.thickness())
}

fn place(checker: &mut Checker, path: &Path, probe: &Probe, shape: &Shape) {
    let message = format!("the point lies outside of `{}`", probe.body);
    checker.require(contains(shape, probe.at), path, message, inside(shape));
}

/// Refuses a `side` away from interfaces.
fn side(checker: &mut Checker, path: &Path, probe: &Probe, solid: &Solid) {
    if probe.side.is_some() && solid.interface_at(probe.at[2]).is_none() {
        let list: Vec<String> = solid.interfaces().into_iter().map(number).collect();
        let message =
            format!("the point is not on an interface between layers of `{}`", probe.body);
        let allowed = match list.is_empty() {
            true => "a point of a body with layers".to_owned(),
            false => format!("a point with z = {}", list.join(" or ")),
        };
        checker.refuse(path, message, allowed);
    }
}

pub fn contains(shape: &Shape, [x, y, z]: [f64; 3]) -> bool {
    let within = match *shape {
        Shape::Box([lx, ly, _]) => fits(x.abs(), lx / 2.0) && fits(y.abs(), ly / 2.0),
        Shape::Disc(Disc { radius, .. }) => fits(x.hypot(y), radius),
    };
    within && is_in_depth(z, shape.thickness())
}

pub fn inside(shape: &Shape) -> String {
    let [x, y] = lateral_extents(shape).map(|extent| number(extent / 2.0));
    let depth = number(-shape.thickness());
    match shape {
        Shape::Box(_) => format!("|x| <= {x}, |y| <= {y}, {depth} <= z <= 0"),
        Shape::Disc(_) => format!("sqrt(x² + y²) <= {x}, {depth} <= z <= 0"),
    }
}
