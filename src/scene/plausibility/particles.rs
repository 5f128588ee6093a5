//! Particles too few, or of a kernel too wide, for what a scene asks of them.

use super::Reviewer;
use crate::kernel::Kernel;
use crate::scene::check::number;
use crate::scene::droplet::Droplet;
use crate::scene::locate::Path;

/// Distances of particles over the thickness of a film below which its heat is too low by more than a fifth.
const THINNEST: f64 = 1.5;
/// What is proposed instead: a tenth too low.
const THICK: f64 = 2.0;
/// Fewest particles across a drop that tell its heat, and some that do.
const FEWEST: f64 = 7.9;
const SOME: f64 = 12.0;
/// δ below which pressures ring, and the usual one.
const LEAST_DIFFUSION: f64 = 0.01;
const USUAL_DIFFUSION: f64 = 0.1;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, droplet) in scene.droplets().filter(|(_, droplet)| droplet.has_particles()) {
        let path = Path::default().key("body").key(name);
        pairs(reviewer, &path, droplet);
        ringing(reviewer, &path, droplet);
        streams(reviewer, &path, droplet);
        if scene.wall_under(name).is_some() || scene.coupling_from(name).is_some() {
            coarse(reviewer, &path.key("spacing"), droplet);
            film(reviewer, &path.key("spacing"), droplet);
        }
    }
}

/// Widest support of a spline, in distances of particles, at which no pairs form under pressure: that of 55 neighbours
/// and of 180 (W. Dehnen & H. Aly 2012, Mon. Not. R. Astron. Soc. 425, 1068–1082, doi
/// 10.1111/j.1365-2966.2012.21439.x). Under Wendland's kernels none form.
fn widest_support(kernel: Kernel) -> Option<(&'static str, f64)> {
    match kernel {
        Kernel::CubicSpline => Some(("cubic", 2.35)),
        Kernel::QuinticSpline => Some(("quintic", 3.5)),
        Kernel::WendlandC2 | Kernel::WendlandC4 => None,
    }
}

/// Warns of a kernel under which particles form pairs.
fn pairs(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let Some((spline, widest)) = widest_support(droplet.kernel) else { return };
    if droplet.support <= widest {
        return;
    }
    let message = format!(
        "under pressure, particles of the {spline} spline form pairs beyond a support of {widest} distances ({} here), \
         and tell as little as half as many; did you mean `kernel = \"wendland_c2\"`, or `support = {widest}`?",
        number(droplet.support)
    );
    reviewer.warn(&path.key("kernel"), message);
}

/// Warns of density diffusion too weak to damp waves of pressure.
fn ringing(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    if droplet.density_diffusion >= LEAST_DIFFUSION {
        return;
    }
    let message = format!(
        "with so little density diffusion pressures ring: heat and heights of films are off by 10 % to 30 %; did you \
         mean {USUAL_DIFFUSION}?"
    );
    reviewer.warn(&path.key("density_diffusion"), message);
}

/// Warns of particles that line up along streams, as nothing moves them apart.
fn streams(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let free = Droplet { shifting: None, ..droplet.clone() };
    if droplet.shifts() || !free.shifts() {
        return;
    }
    let message = "where inertia rules, particles that are not shifted line up along streams: velocities are off by 5 % \
                   to 20 % at any `spacing`; did you mean to leave `shifting` out?";
    reviewer.warn(&path.key("shifting"), message.to_owned());
}

/// Warns of a drop of next to no particles.
fn coarse(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let across = droplet.diameter / droplet.spacing;
    if across >= FEWEST {
        return;
    }
    let message = format!(
        "{across:.1} particles across a drop tell its heat to a third or a half; did you mean a `spacing` of {} m or less?",
        number(rounded(droplet.diameter / SOME))
    );
    reviewer.warn(path, message);
}

/// Warns of a film that gets too thin for its particles by the stop time.
fn film(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    if droplet.dimension == 2 || droplet.fluid.conductivity == 0.0 || droplet.is_replayed() {
        return;
    }
    let begin = droplet.arrivals().first().map_or(0.0, |arrival| arrival.time);
    let speed = droplet.normal_speed();
    let time = reviewer.scene.stop_time - begin - droplet.fall_time(speed);
    if time <= 0.0 {
        return;
    }
    // It grows as `√(3Ut/D)` at first.
    let area = (3.0 * speed * time / droplet.diameter)
        .min((droplet.spread_diameter() / droplet.diameter).powi(2));
    let thickness = 2.0 / 3.0 * droplet.diameter / area.max(1.0);
    if thickness >= THINNEST * droplet.spacing {
        return;
    }
    let message = format!(
        "the film is expected to get {} distances of particles thin by the stop time: below {THINNEST} its heat is \
         too low by a fifth to a half, and height and spread err alike; did you mean a `spacing` of {} m or less?",
        below(thickness / droplet.spacing, THINNEST),
        number(rounded(thickness / THICK))
    );
    reviewer.warn(path, message);
}

/// A number below a bound, with as many digits as tell it from that, up to three.
fn below(value: f64, bound: f64) -> String {
    let digits = (1..3).find(|&digits| format!("{value:.digits$}") != format!("{bound:.digits$}"));
    format!("{value:.0$}", digits.unwrap_or(3))
}

/// To two digits, downward.
fn rounded(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    let text = format!("{:.1e}", (value / unit).floor() * unit);
    text.parse().expect("it was written as a number")
}
