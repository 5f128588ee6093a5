//! Whether probes lie in their bodies and give something.

use super::{Checker, fits, is_in_depth, number};
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::types::{Disc, Probe, Shape};

pub fn check(checker: &mut Checker) {
    for (i, probe) in checker.scene.probe.iter().enumerate() {
        let path = Path::default().key("probe").index(i);
        checker.distinct(&path.at("gives"), &probe.gives);
        if let Some(solid) = checker.body(&path.at("in"), &probe.body) {
            place(checker, &path.at("at"), probe, &solid.shape);
        }
    }
}

fn place(checker: &mut Checker, path: &Path, probe: &Probe, shape: &Shape) {
    let message = format!("the point lies outside of `{}`", probe.body);
    checker.require(contains(shape, probe.at), path, message, inside(shape));
}

fn contains(shape: &Shape, [x, y, z]: [f64; 3]) -> bool {
    let within = match *shape {
        Shape::Box([lx, ly, _]) => fits(x.abs(), lx / 2.0) && fits(y.abs(), ly / 2.0),
        Shape::Disc(Disc { radius, .. }) => fits(x.hypot(y), radius),
    };
    within && is_in_depth(z, shape.thickness())
}

fn inside(shape: &Shape) -> String {
    let [x, y] = lateral_extents(shape).map(|extent| number(extent / 2.0));
    let depth = number(-shape.thickness());
    match shape {
        Shape::Box(_) => format!("|x| <= {x}, |y| <= {y}, {depth} <= z <= 0"),
        Shape::Disc(_) => format!("sqrt(x² + y²) <= {x}, {depth} <= z <= 0"),
    }
}
