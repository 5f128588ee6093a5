//! Whether couplings join a droplet with the top of a solid that can take what it gives.

use super::{Checker, LENGTHS, TIMES, fits, number};
use crate::scene::droplet::{Coupling, Droplet};
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::types::{FaceName, Shape, Solid};

pub fn check(checker: &mut Checker) {
    for (i, coupling) in checker.scene.coupling.iter().enumerate() {
        let path = Path::default().key("coupling").index(i);
        for (key, value, range, what) in [
            ("interval", coupling.interval, TIMES, "the time between exchanges"),
            ("radius", coupling.radius, LENGTHS, "the radius of the fine mesh"),
        ] {
            if let Some(value) = value {
                checker.positive_within(&path.at(key), value, range, what);
            }
        }
        let droplet = checker.droplet(&path.at("from"), &coupling.from);
        let face = checker.face(&path.at("to"), &coupling.to, |_| vec![FaceName::Top]);
        alone(checker, &path, i, coupling);
        if let Some((_, solid)) = face {
            free_face(checker, &path.at("to"), coupling, solid);
        }
        if let (Some(droplet), Some((_, solid))) = (droplet, face) {
            fit(checker, &path.at("from"), droplet, &solid.shape);
        }
    }
}

/// A droplet has one thing below it, and droplets of different bodies would not see each other.
fn alone(checker: &mut Checker, path: &Path, i: usize, coupling: &Coupling) {
    let scene = checker.scene;
    let from = path.at("from");
    if let Some(wall) = scene.wall_under(&coupling.from) {
        let message = format!("`{}` has wall[{wall}] below it already", coupling.from);
        checker.refuse(&from, message, "a wall or a coupling a droplet");
    }
    if let Some(first) = scene.coupling_from(&coupling.from).filter(|&first| first != i) {
        let message = format!("`{}` is coupled by coupling[{first}] already", coupling.from);
        checker.refuse(&from, message, "one coupling a droplet");
        return;
    }
    let others = scene.coupling[..i].iter();
    if let Some(other) = others.clone().position(|other| other.to == coupling.to) {
        let message = format!(
            "coupling[{other}] acts on `{}` already, and droplets of two bodies do not meet",
            coupling.to
        );
        checker.refuse(&path.at("to"), message, "one coupling a solid; `arrivals` for more drops");
    }
}

fn free_face(checker: &mut Checker, path: &Path, coupling: &Coupling, solid: &Solid) {
    let top = solid.face(FaceName::Top);
    let held = [
        (top.temperature.is_some(), "has a prescribed temperature: the heat would leave at once"),
        (coupling.traction && top.clamped, "is clamped: the traction would move nothing"),
        (coupling.traction && top.roller, "is on rollers: the pressure would move nothing"),
    ];
    for (is_held, why) in held {
        checker.require(
            !is_held,
            path,
            format!("the face {why}"),
            "a `top` without that condition",
        );
    }
}

fn fit(checker: &mut Checker, path: &Path, droplet: &Droplet, shape: &Shape) {
    if droplet.dimension == 2 {
        let message = "a plane droplet does not fit a solid of three dimensions";
        checker.refuse(path, message, "a droplet of `dimension = 3`, or `[[wall]]`");
    }
    if matches!(shape, Shape::Disc(_)) {
        let message = "a disc is modelled axisymmetric: all drops must arrive at x = 0, y = 0";
        checker.require(droplet.is_centred(), path, message, "a box, or arrivals at the centre");
    }
    let radius = 0.5 * droplet.diameter;
    let half = lateral_extents(shape).map(|extent| 0.5 * extent);
    let beyond = droplet.arrivals.iter().position(|arrival| {
        let [x, y] = [arrival.x, arrival.y].map(f64::abs);
        !fits(x + radius, half[0]) || !fits(y + radius, half[1])
    });
    if let Some(beyond) = beyond {
        let message = format!("the drop of arrivals[{beyond}] comes down beside the face");
        let [x, y] = half.map(number);
        checker.refuse(path, message, format!("|x| + radius <= {x}, |y| + radius <= {y}"));
    }
}
