//! Size, fluid, particles and arrivals of each droplet.

use std::f64::consts::PI;

use super::{Checker, fits, number};
use crate::scene::droplet::{Arrival, Droplet, DropletSymmetry, Fluid};
use crate::scene::locate::Path;

/// Fewest particles across a drop that make it one.
const FEWEST_ACROSS: f64 = 6.0;
/// More particles than this fit no machine of today.
const MOST_PARTICLES: f64 = 2e7;
/// Least speed of sound over that of the flow or its surface: below, the fluid would be compressed by 4 % and
/// more, or its surface come loose.
const LEAST_SOUND_OVER_FLOW: f64 = 5.0;

/// Bounds of what a drop and its fluid have, wide about all that drops are made of: from liquid helium to
/// molten glass, from fog to a pond, at rest and in a shock tube. Numbers beyond them make time steps
/// that never end.
mod bounds {
    /// [m]
    pub const DIAMETER: [f64; 2] = [1e-9, 1e2];
    pub const SPACING: [f64; 2] = [1e-10, 1e1];
    pub const HEIGHT: [f64; 2] = [0.0, 1e3];
    /// [m/s]
    pub const VELOCITY: [f64; 2] = [0.0, 1e5];
    pub const SOUND_SPEED: [f64; 2] = [1e-6, 1e6];
    /// [m/s²]
    pub const GRAVITY: [f64; 2] = [0.0, 1e7];
    /// [kg/m³]
    pub const DENSITY: [f64; 2] = [1e-3, 1e6];
    /// [Pa s]
    pub const VISCOSITY: [f64; 2] = [1e-9, 1e6];
    /// [J/(kg K)]
    pub const SPECIFIC_HEAT: [f64; 2] = [1e-1, 1e7];
    /// [W/(m K)]
    pub const CONDUCTIVITY: [f64; 2] = [0.0, 1e6];
    /// [N/m]
    pub const SURFACE_TENSION: [f64; 2] = [0.0, 1e5];
    /// [s]
    pub const ARRIVAL: [f64; 2] = [0.0, 1e12];
    /// [m]
    pub const PLACE: [f64; 2] = [-1e3, 1e3];
}

pub fn check(checker: &mut Checker) {
    for (name, droplet) in checker.scene.droplets() {
        let path = Path::default().key("body").key(name);
        let before = checker.problems.len();
        sizes(checker, &path, droplet);
        fluid(checker, &path.at("fluid"), &droplet.fluid);
        method(checker, &path, droplet);
        if checker.problems.len() == before {
            resolution(checker, &path.at("spacing"), droplet);
        }
        // What moves the surface depends on the distance of particles.
        if checker.problems.len() == before {
            sound(checker, &path.at("fluid.sound_speed"), droplet);
            arrivals(checker, &path.at("arrivals"), name, droplet);
            symmetry(checker, &path.at("symmetry"), droplet);
        }
    }
}

fn sizes(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    for (key, value, range, what) in [
        ("diameter", droplet.diameter, bounds::DIAMETER, "the diameter of a drop"),
        ("spacing", droplet.spacing, bounds::SPACING, "the distance of particles"),
    ] {
        checker.positive_within(&path.at(key), value, range, what);
    }
    checker.temperature(&path.at("initial_temperature"), droplet.initial_temperature);
    for (key, value, range, what) in [
        (
            "impact_velocity",
            droplet.impact_velocity,
            bounds::VELOCITY,
            "the speed towards the wall",
        ),
        ("height", droplet.gap(), bounds::HEIGHT, "the gap between drop and wall"),
        ("gravity", droplet.gravity, bounds::GRAVITY, "gravity, which acts towards the wall,"),
    ] {
        not_negative(checker, &path.at(key), value, range, what);
    }
}

fn not_negative(checker: &mut Checker, path: &Path, value: f64, range: [f64; 2], what: &str) {
    let message = format!("{what} is not negative");
    if checker.require(value >= 0.0, path, message, ">= 0") {
        checker.within(path, value, range, what);
    }
}

fn fluid(checker: &mut Checker, path: &Path, fluid: &Fluid) {
    for (key, value, range, what) in [
        ("density", fluid.density, bounds::DENSITY, "the density"),
        ("viscosity", fluid.viscosity, bounds::VISCOSITY, "the viscosity"),
        ("specific_heat", fluid.specific_heat, bounds::SPECIFIC_HEAT, "the specific heat capacity"),
    ] {
        checker.positive_within(&path.at(key), value, range, what);
    }
    for (key, value, range, what) in [
        ("conductivity", fluid.conductivity, bounds::CONDUCTIVITY, "the thermal conductivity"),
        ("surface_tension", fluid.surface_tension, bounds::SURFACE_TENSION, "the surface tension"),
    ] {
        not_negative(checker, &path.at(key), value, range, what);
    }
    let fine = (0.0..=PI).contains(&fluid.contact_angle);
    let message = "the angle of contact is out of bounds";
    checker.require(fine, &path.at("contact_angle"), message, "0 to 3.14159 (rad)");
    if let Some(speed) = fluid.sound_speed {
        let path = path.at("sound_speed");
        checker.positive_within(&path, speed, bounds::SOUND_SPEED, "the speed of sound");
    }
}

fn method(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let fine = droplet.dimension == 2 || droplet.dimension == 3;
    let allowed = "3, 2 (plane)";
    checker.require(fine, &path.at("dimension"), "no model of this dimension", allowed);
    let fine = (0.0..=1.0).contains(&droplet.density_diffusion);
    let message = "the density diffusion is out of bounds";
    checker.require(fine, &path.at("density_diffusion"), message, "0 to 1");
    let fine = (2.0..=6.0).contains(&droplet.support);
    let message = "the support radius of the kernel is out of bounds";
    checker.require(
        fine,
        &path.at("support"),
        message,
        "2 <= support <= 6 (distances of particles)",
    );
}

fn resolution(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let across = droplet.diameter / droplet.spacing;
    let coarsest = droplet.diameter / FEWEST_ACROSS;
    let volume = if droplet.dimension == 3 { PI / 6.0 } else { PI / 4.0 };
    let drops = droplet.arrivals.len() as f64;
    let copies: f64 = droplet.mirrors().map(|m| if m { 2.0 } else { 1.0 }).iter().product();
    let particles = volume * across.powi(droplet.dimension as i32) * drops / copies;
    if !fits(droplet.spacing, coarsest) {
        let message = format!("only {across:.1} particles lie across the drop");
        checker.refuse(path, message, format!("0 < spacing <= {}", number(coarsest)));
    } else if particles > MOST_PARTICLES {
        let scale = (particles / MOST_PARTICLES).powf(1.0 / droplet.dimension as f64);
        let message = format!("this makes {} particles", number(particles.round()));
        let allowed =
            format!("{} or more, for at most 2e7 particles", number(droplet.spacing * scale));
        checker.refuse(path, message, allowed);
    }
}

fn sound(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let (flow, surface) = (droplet.fastest_flow(), droplet.surface_speed());
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

fn arrivals(checker: &mut Checker, path: &Path, name: &str, droplet: &Droplet) {
    let list = &droplet.arrivals;
    checker.require(!list.is_empty(), path, "there is no arrival", "at least one arrival");
    for (i, arrival) in list.iter().enumerate() {
        let path = path.index(i);
        let what = "the time of an arrival";
        not_negative(checker, &path.at("time"), arrival.time, bounds::ARRIVAL, what);
        for (key, place) in [("x", arrival.x), ("y", arrival.y)] {
            checker.within(&path.at(key), place, bounds::PLACE, "the place of an arrival");
        }
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
        let free =
            checker.scene.wall_under(name).is_none() && checker.scene.coupling_from(name).is_none();
        if let Some(other) = list[..i].iter().position(|other| meets(droplet, other, arrival, free))
        {
            let message = format!("the drop is released into that of arrivals[{other}]");
            let allowed = "a place or time apart, or a larger `height`";
            checker.refuse(&path, message, allowed);
        }
    }
}

/// Whether a drop is released where an earlier one still is: it falls freely, its centre to the
/// wall at most.
fn meets(droplet: &Droplet, earlier: &Arrival, later: &Arrival, free: bool) -> bool {
    let time = (later.time - earlier.time).max(0.0);
    let fall = droplet.impact_velocity * time + 0.5 * droplet.gravity * time * time;
    let deepest = droplet.gap() + 0.5 * droplet.diameter;
    let fall = if free { fall } else { fall.min(deepest) };
    let apart = (later.x - earlier.x).hypot(later.y - earlier.y);
    !fits(droplet.diameter, apart.hypot(fall))
}

fn symmetry(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let fine = droplet.symmetry != DropletSymmetry::Quarter || droplet.is_centred();
    let message = "a quarter needs all drops to arrive at x = 0, y = 0";
    checker.require(fine, path, message, "auto, none");
}
