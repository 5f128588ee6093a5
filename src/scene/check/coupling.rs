//! Checks that couplings join compatible partners: a droplet with the top of a solid that can receive its heat and
//! momentum, or the top of a solid with the bottom of another.

use super::{Checker, fits, number};
use crate::scene::coupling::Coupling;
use crate::scene::droplet::Droplet;
use crate::scene::filament::Filament;
use crate::scene::grid::lateral_extents;
use crate::scene::large_strain::LargeStrain;
use crate::scene::locate::Path;
use crate::scene::lookup::split_place;
use crate::scene::types::{FaceName, Shape, Solid};

pub fn check(checker: &mut Checker) {
    for (i, coupling) in checker.scene.coupling.iter().enumerate() {
        let path = Path::default().key("coupling").index(i);
        match coupling.lower().is_some() {
            true => check_contact(checker, &path, i, coupling),
            false => check_droplet(checker, &path, i, coupling),
        }
    }
}

fn check_droplet(checker: &mut Checker, path: &Path, i: usize, coupling: &Coupling) {
    if checker.scene.solid(&coupling.from).is_some() && coupling.conductance.is_some() {
        let message = format!("`{}` is a solid, of which a face touches", coupling.from);
        checker.refuse(&path.at("from"), message, format!("{}.top", coupling.from));
        return;
    }
    if let Some(solid) = checker.scene.large_strain(&coupling.from) {
        check_large_strain(checker, path, i, (coupling, solid));
        return;
    }
    if let Some(filament) = checker.scene.filament(&coupling.from) {
        check_filament(checker, path, i, (coupling, filament));
        return;
    }
    let droplet = checker.droplet(&path.at("from"), &coupling.from);
    let face = checker.face(&path.at("to"), &coupling.to, |_| vec![FaceName::Top]);
    alone(checker, path, i, coupling);
    if let Some((_, solid)) = face {
        free_face(checker, &path.at("to"), coupling, solid);
        if is_in_contact(checker, i, &coupling.to) {
            let message = format!("`{}` touches another solid", coupling.to);
            checker.refuse(&path.at("to"), message, "a face without another coupling");
        }
    }
    if let Some(droplet) = droplet.filter(|_| coupling.conductance.is_some()) {
        resists(checker, &path.at("conductance"), droplet);
    }
    if let (Some(droplet), Some((_, solid))) = (droplet, face) {
        fit(checker, &path.at("from"), droplet, &solid.shape);
    }
}

/// Checks a solid of large strain that falls on the top of a solid.
fn check_large_strain(
    checker: &mut Checker,
    path: &Path,
    i: usize,
    (coupling, solid): (&Coupling, &LargeStrain),
) {
    let from = path.at("from");
    let face = checker.face(&path.at("to"), &coupling.to, |_| vec![FaceName::Top]);
    alone(checker, path, i, coupling);
    if solid.dimension == 2 {
        let message = "a plane body does not fit a solid of three dimensions";
        checker.refuse(&from, message, "a body of `dimension = 3`");
    }
    let kind = match solid.part() {
        _ if solid.is_quadrilateral() => Some("a quadrilateral"),
        _ if solid.strand().is_some() => Some("a strand along a path"),
        part => part.map(|_| "a part of a file"),
    };
    if let Some(kind) = kind {
        let message = format!("{kind} moves above the plane z = 0 and no other body");
        checker.refuse(&from, message, "a box, a disc or a ball");
    }
    let Some((_, below)) = face else { return };
    free_face(checker, &path.at("to"), coupling, below);
    if matches!(below.shape, Shape::Disc(_)) && !solid.is_axisymmetric() {
        let message = "a disc is modelled axisymmetric, and so must be what falls on it";
        checker.refuse(&from, message, "a disc or a ball straight down, or a box below");
    }
    let [x, y] = lateral_extents(&below.shape);
    let [width, depth, _] = solid.extents();
    let fine = fits(width, x) && fits(depth, y);
    let (x, y) = (number(x), number(y));
    let message = "the body is wider than the face below";
    checker.require(fine, &from, message, format!("extents up to {x} and {y} m"));
}

/// Checks a filament that is laid on the top of a solid.
fn check_filament(
    checker: &mut Checker,
    path: &Path,
    i: usize,
    (coupling, filament): (&Coupling, &Filament),
) {
    let face = checker.face(&path.at("to"), &coupling.to, |_| vec![FaceName::Top]);
    alone(checker, path, i, coupling);
    let message = "the fluid conducts no heat that the contact could resist";
    let allowed = "no `conductance`, or a `conductivity` of the fluid above 0";
    let fine = coupling.conductance.is_none() || filament.fluid.conductivity > 0.0;
    checker.require(fine, &path.at("conductance"), message, allowed);
    let Some((_, below)) = face else { return };
    free_face(checker, &path.at("to"), coupling, below);
    let is_box = matches!(below.shape, Shape::Box(_));
    let message = "a disc is modelled axisymmetric, and a strand is not";
    checker.require(is_box, &path.at("from"), message, "a box below");
    if let Some(route) = checker.scene.route(filament).filter(|_| checker.is_fine(&path.at("from")))
    {
        let half = lateral_extents(&below.shape).map(|extent| 0.5 * extent);
        let beyond = (0..2).any(|axis| {
            let [low, high] = route.ranges()[axis];
            low <= high && (!fits(high, half[axis]) || !fits(-low, half[axis]))
        });
        let message = "the path of the nozzle leaves the face";
        let [x, y] = half.map(number);
        checker.require(!beyond, &path.at("from"), message, format!("|x| <= {x}, |y| <= {y}"));
    }
}

/// Checks a contact of two solids, or of a solid and a reservoir.
fn check_contact(checker: &mut Checker, path: &Path, i: usize, coupling: &Coupling) {
    let below = on_reservoir(checker, &path.at("from"), &coupling.from, FaceName::Top);
    let above = on_reservoir(checker, &path.at("to"), &coupling.to, FaceName::Bottom);
    if below && above {
        let message = "two reservoirs have no area in common";
        checker.refuse(&path.at("to"), message, "the bottom of a solid");
        return;
    }
    let from = path.at("from");
    let is_upside_down = |place: &str, face| split_place(place).is_some_and(|(_, own)| own == face);
    if is_upside_down(&coupling.from, FaceName::Bottom)
        && is_upside_down(&coupling.to, FaceName::Top)
    {
        let message = "`from` is the body below, and `to` the one that stands on it";
        let allowed = format!("from = \"{}\", to = \"{}\"", coupling.to, coupling.from);
        checker.refuse(path, message, allowed);
        return;
    }
    let lower =
        if below { None } else { checker.face(&from, &coupling.from, |_| vec![FaceName::Top]) };
    let to = path.at("to");
    let upper =
        if above { None } else { checker.face(&to, &coupling.to, |_| vec![FaceName::Bottom]) };
    if coupling.conductance.is_none() {
        let message = "a contact of two solids needs its `conductance`";
        checker.refuse(path, message, "conductance = 5e3, in W/(m2 K), say");
    }
    if coupling.radius.is_some() {
        let message = "a contact of two solids has no fine mesh of its own";
        checker.refuse(&path.at("radius"), message, "no `radius` between solids; `mesh.spacing`");
    }
    for (key, place, found) in [("from", &coupling.from, lower), ("to", &coupling.to, upper)] {
        let Some((face, solid)) = found else { continue };
        if !solid.face(face).thermal().is_empty() || solid.face(face).radiation.is_some() {
            let message = "the face has a thermal condition in addition to the contact";
            checker.refuse(
                &path.at(key),
                message,
                "a face without `temperature`, `flux`, `convection` or `radiation`",
            );
        }
        if is_in_contact(checker, i, place)
            || checker.scene.coupling[..i].iter().any(|c| c.to == *place)
        {
            let message = format!("`{place}` is coupled already");
            checker.refuse(&path.at(key), message, "one contact a face");
        }
    }
    if let (Some((_, below)), Some((_, above))) = (lower, upper) {
        let is_round = |solid: &Solid| matches!(solid.shape, Shape::Disc(_));
        if is_round(below) != is_round(above) {
            let message = "a box and a disc do not share symmetries";
            checker.refuse(&path.at("to"), message, "two boxes, or two discs");
        }
        if std::ptr::eq(below, above) {
            let message = format!("`{}` and `{}` belong to one body", coupling.from, coupling.to);
            checker.refuse(&path.at("to"), message, "another solid");
        } else if let (Some((below, _)), Some((above, _))) =
            (split_place(&coupling.from), split_place(&coupling.to))
            && stands_on(checker, i, below, above)
        {
            let message = format!("`{below}` stands on `{above}` already");
            checker.refuse(&path.at("to"), message, "solids in a stack, none above itself");
        }
    }
}

/// Returns true if earlier contacts stack a body on another, with any number between them.
fn stands_on(checker: &Checker, i: usize, body: &str, other: &str) -> bool {
    let below = |coupling: &&Coupling| {
        split_place(&coupling.to)
            .is_some_and(|(above, face)| above == body && face == FaceName::Bottom)
    };
    let mut bodies = checker.scene.coupling[..i].iter().filter(below).filter_map(|coupling| {
        let (lower, _) = split_place(&coupling.from)?;
        checker.scene.solid(lower).is_some().then_some(lower)
    });
    bodies.any(|lower| lower == other || stands_on(checker, i, lower, other))
}

/// Returns true if an end of a contact is on a reservoir: on its top if the reservoir is below, on its bottom if it is
/// above. Any number of solids may touch it there.
fn on_reservoir(checker: &mut Checker, path: &Path, place: &str, face: FaceName) -> bool {
    let Some((body, found)) = split_place(place) else { return false };
    if checker.scene.reservoir(body).is_none() {
        return false;
    }
    let allowed = format!("{body}.{}", face.as_str());
    let message = "a contact joins the top of the lower body with the bottom of the upper one";
    checker.require(found == face, path, message, allowed);
    true
}

/// Returns true if an earlier contact of solids uses this face.
fn is_in_contact(checker: &Checker, i: usize, place: &str) -> bool {
    let contacts = checker.scene.coupling[..i].iter().filter(|other| other.lower().is_some());
    contacts.into_iter().any(|other| other.from == *place || other.to == *place)
}

/// Checks that the heat of a droplet can pass a resistance.
pub fn resists(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let message = "recorded drops and films touch what lies below without resistance";
    let allowed = "no `conductance`, or method = \"sph\"";
    checker.require(!droplet.is_replayed(), path, message, allowed);
    let message = "the fluid conducts no heat that the contact could resist";
    let allowed = "no `conductance`, or a `conductivity` of the fluid above 0";
    checker.require(droplet.fluid.conductivity > 0.0, path, message, allowed);
}

/// Refuses a second partner below a droplet.
fn alone(checker: &mut Checker, path: &Path, i: usize, coupling: &Coupling) {
    let scene = checker.scene;
    let from = path.at("from");
    if let Some(wall) = scene.wall_under(&coupling.from) {
        let message = format!("`{}` has wall[{wall}] below it already", coupling.from);
        checker.refuse(&from, message, "a wall or a coupling a body");
    }
    if let Some(first) = scene.coupling_from(&coupling.from).filter(|&first| first != i) {
        let message = format!("`{}` is coupled by coupling[{first}] already", coupling.from);
        checker.refuse(&from, message, "one coupling a droplet");
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
        let message = "a disc is modelled axisymmetric: all drops must come straight down";
        checker.require(droplet.is_straight(), path, message, "a box, or impact_angle = 0.0");
    }
    let radius = 0.5 * droplet.diameter;
    let half = lateral_extents(shape).map(|extent| 0.5 * extent);
    let beyond = droplet.landings().position(|place| {
        let [x, y] = place.map(f64::abs);
        !fits(x + radius, half[0]) || !fits(y + radius, half[1])
    });
    if let Some(beyond) = beyond {
        let message = format!("the drop of arrivals[{beyond}] lands outside the face");
        let [x, y] = half.map(number);
        checker.refuse(path, message, format!("|x| + radius <= {x}, |y| + radius <= {y}"));
    }
}
