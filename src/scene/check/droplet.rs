//! Checks size, fluid, particles and arrivals of each droplet.

mod room;

use room::meets;

use super::{Checker, fits, freezing, number, replayed, viscosity};
use crate::scene::droplet::{
    Droplet, DropletMethod, DropletSymmetry, LEAST_SOUND_OVER_FLOW, Placement,
};
use crate::scene::locate::Path;
use crate::scene::types::{Footprint, Shape};

/// Smallest number of particles across a drop.
const FEWEST_ACROSS: f64 = 6.0;
/// Number of particles that exceeds the memory of any current machine.
const MOST_PARTICLES: f64 = 2e7;

pub fn check(checker: &mut Checker) {
    for (name, droplet) in checker.scene.droplets() {
        let path = Path::default().key("body").key(name);
        if is_sound(checker, &path) {
            replayed::check(checker, &path, (name, droplet));
            viscosity::check(checker, &path, droplet);
            freezing::check(checker, &path, droplet);
        }
        if is_sound(checker, &path) && droplet.has_particles() {
            resolution(checker, &path.at("spacing"), droplet);
        }
        // The governing speed depends on the distance of particles.
        if is_sound(checker, &path) {
            if droplet.has_particles() {
                sound(checker, &path.at("fluid.sound_speed"), droplet);
            }
            phases(checker, &path.at("fluid.boils_at"), droplet);
            evaporation(checker, &path.at("fluid.evaporation"), droplet);
            release(checker, &path, droplet);
            direction(checker, &path.at("impact_direction"), droplet);
            arrivals(checker, &path.at("arrivals"), name, droplet);
            symmetry(checker, &path.at("symmetry"), name, droplet);
        }
    }
}

/// Returns true if all numbers are valid on which further checks depend.
fn is_sound(checker: &Checker, path: &Path) -> bool {
    let arrivals = path.key("arrivals");
    checker.refused_in(path).all(|refused| refused.is_within(&arrivals))
}

fn resolution(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let across = droplet.diameter / droplet.spacing;
    let coarsest = droplet.diameter / FEWEST_ACROSS;
    let particles = droplet.particles();
    if !fits(droplet.spacing, coarsest) {
        let message = format!("only {across:.1} particles lie across the drop");
        checker.refuse(path, message, format!("0 < spacing <= {}", number(coarsest)));
    } else if particles > MOST_PARTICLES {
        let scale = (particles / MOST_PARTICLES).powf(1.0 / droplet.axes() as f64);
        let message = format!("this makes {} particles", number(particles.round()));
        let allowed =
            format!("{} or more, for at most 2e7 particles", number(droplet.spacing * scale));
        checker.refuse(path, message, allowed);
    }
}

fn sound(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let (flow, surface) = (droplet.fastest_flow(), droplet.fluid.laplace_speed(droplet.spacing));
    match droplet.fluid.sound_speed {
        None => {
            let message = "neither impact, gravity nor surface tension gives the flow a speed to \
                           take ten times";
            checker.require(flow > 0.0, path, message, "> 0");
        }
        Some(speed) => {
            let (what, message) = if surface > flow {
                let message = format!(
                    "a surface whose tension moves particles at up to {} m/s would come loose",
                    number(surface)
                );
                ("speed, √(2σ/(ρΔx)); ten times keep all particles", message)
            } else {
                let message = format!(
                    "the flow of up to {} m/s would compress the fluid by more than 4 %",
                    number(flow)
                );
                ("flow; ten times keeps density within 1 %", message)
            };
            let least = LEAST_SOUND_OVER_FLOW * flow.max(surface);
            let allowed = format!(">= {} (five times that {what})", number(least));
            checker.require(fits(least, speed), path, message, allowed);
        }
    }
}

/// Checks that the fluid is liquid over some range of temperatures.
fn phases(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let Some((freezes, boils)) = droplet.fluid.freezes_at.zip(droplet.fluid.boils_at) else {
        return;
    };
    let message =
        format!("the fluid would boil at or below the {} K of `freezes_at`", number(freezes));
    checker.require(freezes < boils, path, message, format!("> {}", number(freezes)));
}

/// Checks that the pressure of the vapour is known, which follows from the boiling point.
fn evaporation(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let is_known = droplet.fluid.evaporation.is_none() || droplet.fluid.boils_at.is_some();
    let message = "a fluid that evaporates has no boiling point";
    checker.require(is_known, path, message, "with `boils_at` of the fluid");
}

/// Checks releases: either at times or by inputs; with inputs the number of drops is not known in advance.
fn release(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let (message, allowed) = match (droplet.is_on_demand(), droplet.most, &droplet.arrivals) {
        (true, None, _) => {
            ("inputs release the drops, of which there is no largest number", "a whole number")
        }
        (true, _, Some(_)) => {
            let message = "inputs release the drops, which have no times of arrival";
            checker.refuse(&path.at("arrivals"), message, "no such key, or release = \"arrivals\"");
            return;
        }
        (false, Some(_), _) => (
            "`arrivals` release the drops, and say how many there are",
            "no such key, or release = \"input\"",
        ),
        _ => return,
    };
    checker.refuse(&path.at("most"), message, allowed);
}

fn arrivals(checker: &mut Checker, path: &Path, name: &str, droplet: &Droplet) {
    let list = droplet.arrivals();
    if droplet.is_on_demand() {
        return;
    }
    checker.require(!list.is_empty(), path, "there is no arrival", "at least one arrival");
    for (i, arrival) in list.iter().enumerate() {
        let path = path.index(i);
        if droplet.dimension == 2 {
            let message = "a plane model lies in y = 0";
            checker.require(arrival.y == 0.0, &path.at("y"), message, "0");
        }
        let earlier = list[i.saturating_sub(1)].time;
        let message = "arrivals stand in the order of their times";
        let allowed = format!(">= {}", number(earlier));
        if !checker.require(earlier <= arrival.time, &path.at("time"), message, allowed) {
            continue;
        }
        if droplet.is_replayed() {
            continue;
        }
        let free = !checker.scene.has_surface_below(name);
        if let Some(other) = list[..i].iter().position(|other| meets(droplet, other, arrival, free))
        {
            let message = format!("the drop is released into that of arrivals[{other}]");
            checker.refuse(&path, message, room::ways(droplet, &list[..=i], free));
        }
    }
}

fn direction(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let fine = droplet.dimension == 3 || droplet.impact_direction == 0.0;
    let message = "drops of a plane model move along x, against it at a negative angle";
    checker.require(fine, path, message, "0");
}

fn symmetry(checker: &mut Checker, path: &Path, name: &str, droplet: &Droplet) {
    let part = match droplet.symmetry {
        DropletSymmetry::Auto | DropletSymmetry::None => return,
        DropletSymmetry::Quarter => "a quarter",
        DropletSymmetry::Axisymmetric => "an axisymmetric model",
    };
    let message = format!("{part} needs all drops to arrive at x = 0, y = 0");
    checker.require(droplet.is_centred(), path, message, "auto, none");
    let message = format!("{part} needs all drops to come straight down");
    checker.require(droplet.is_straight(), path, message, "auto, none, or impact_angle = 0.0");
    if droplet.symmetry == DropletSymmetry::Axisymmetric {
        round(checker, path, name, droplet);
    }
    if droplet.symmetry == DropletSymmetry::Quarter {
        let message = "particles that are placed at random do not mirror themselves";
        let fine = droplet.placement == Placement::Lattice;
        checker.require(fine, path, message, "auto, none, or placement = \"lattice\"");
    }
}

/// Checks axisymmetric droplets: they need three dimensions, and below them a round surface or a box whose cells are
/// rings.
fn round(checker: &mut Checker, path: &Path, name: &str, droplet: &Droplet) {
    let message = "a plane model has no axis";
    checker.require(droplet.dimension == 3, path, message, "auto, none, or dimension = 3");
    let scene = checker.scene;
    if let Some(wall) = scene.wall_under(name) {
        let is_round = matches!(scene.wall[wall].footprint, Footprint::Rings { .. });
        let message = format!("the cells of wall[{wall}] are not round");
        checker.require(is_round, path, message, "auto, none, quarter, or a wall of `rings`");
    }
    let below = scene.coupling_from(name).and_then(|coupling| scene.coupling[coupling].solid());
    let below = below.and_then(|body| Some((body, scene.solid(body)?)));
    if let Some((body, _)) = below.filter(|(_, solid)| matches!(solid.shape, Shape::Box(_))) {
        on_box(checker, path, body, droplet);
    }
}

/// Requires that all drops above a box use the same rings.
fn on_box(checker: &mut Checker, path: &Path, body: &str, droplet: &Droplet) {
    let message = format!("drops that are repeated give nothing to rings of `{body}`, a box");
    let is_computed = droplet.method == DropletMethod::Sph;
    checker.require(is_computed, path, message, "auto, or method = \"sph\"");
    let scene = checker.scene;
    let is_other = |name: &&str| scene.droplet(name).is_some_and(|other| !other.is_axisymmetric());
    let names = scene.couplings_to(body).map(|coupling| coupling.from.as_str());
    if let Some(other) = names.into_iter().find(is_other) {
        let message = format!(
            "`{other}` falls on `{body}`, a box, too, which meets all drops on rings or none"
        );
        checker.refuse(path, message, "auto, none, quarter, or all drops there axisymmetric");
    }
}
