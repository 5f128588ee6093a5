//! Particles too few, or of a kernel too wide, for what a scene asks of them.

use super::Reviewer;
use super::resolution::{HeatError, Resolution};
use crate::kernel::Kernel;
use crate::limits::number;
use crate::scene::Droplet;
use crate::scene::locate::Path;

/// Distances of particles over the thickness of a film below which it breaks up too soon, and what is proposed instead.
const THINNEST: f64 = 1.5;
const THICK: f64 = 2.0;
/// Least expected error of heat that is warned of, half as much again as what that is known to.
const LEAST_TOLD: f64 = 0.08;
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
            resolved(reviewer, &path.key("spacing"), (name, droplet));
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

/// Warns of a film that gets too thin for its particles by the stop time, or of particles too wide for the layers of
/// shear and heat in it.
fn resolved(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let Some(resolution) = Resolution::of(reviewer.scene, (name, droplet)) else { return };
    let heat = resolution.heat().filter(|_| droplet.fluid.conductivity > 0.0);
    if let Some(message) = thin(&resolution, droplet, heat.as_ref()) {
        reviewer.warn(path, message);
        return;
    }
    if let Some(across) = resolution.across_for_middle()
        && reviewer.scene.coupling_from(name).is_some()
    {
        reviewer.warn(path, too_hot(droplet, across));
    }
    if let Some(message) = wetted(&resolution, droplet) {
        reviewer.warn(path, message);
    }
    let tolerated = reviewer.scene.fidelity.tolerance.max(LEAST_TOLD);
    let Some(heat) = heat else { return };
    let size = if heat.outside.is_some() { heat.half } else { heat.expected.abs() };
    if size <= tolerated {
        return;
    }
    let spacing = match resolution.across_for_heat(tolerated) {
        Some(across) => format!(
            "did you mean a `spacing` of {} m or less?",
            number(rounded(droplet.diameter / across))
        ),
        None => "no `spacing` is known to keep it".to_owned(),
    };
    reviewer.warn(path, off(&resolution, &heat, tolerated) + &spacing);
}

/// Describes the expected error of heat and its cause, or the interval that covers it outside of the fitted ranges.
fn off(resolution: &Resolution, heat: &HeatError, tolerated: f64) -> String {
    if let Some(outside) = &heat.outside {
        return format!(
            "heat may be off by up to {} either way: the law of its error was not fitted on this drop, {outside}; ",
            percent(heat.half)
        );
    }
    let [film, sheared] = resolution.layers();
    format!(
        "heat is expected to be off by {}, more than {}: {} particles lie across the film at last, {} across its layer of \
         shear √(νD/U) and {} across that of heat √(aD/U); ",
        percents(heat),
        percent(tolerated),
        digits(film),
        digits(sheared),
        digits(resolution.thermal_layers().unwrap_or(0.0))
    )
}

/// What to say of a film on a poor conductor whose wetted area so few particles do not tell.
fn wetted(resolution: &Resolution, droplet: &Droplet) -> Option<String> {
    if droplet.fluid.conductivity == 0.0 {
        return None;
    }
    let (error, cause, across) = match (resolution.across_for_film(), resolution.across_for_area())
    {
        (Some(whole), told) => (
            "is expected to be too low by a twentieth to a half",
            "the film breaks up",
            told.unwrap_or(whole),
        ),
        (None, Some(told)) => (
            "may be off by a tenth to a third, either way",
            "so few particles do not tell it",
            told,
        ),
        (None, None) => return None,
    };
    Some(format!(
        "heat {error}, as on what conducts less than the fluid it follows the wetted area, and {cause}: {} \
         particles lie across its layer of shear √(νD/U); did you mean a `spacing` of {} m or less?",
        digits(resolution.layers()[1]),
        number(rounded(droplet.diameter / across))
    ))
}

/// What to say of particles that are wider than the layer through which a drop warms the middle of what it hits.
fn too_hot(droplet: &Droplet, across: f64) -> String {
    format!(
        "the temperature under the middle of the drop rises too high, by a tenth to a third with 20 particles across, as its \
         thermal layer √(aD/U) is thinner than three quarters of a particle; did you mean a `spacing` of {} m or less?",
        number(rounded(droplet.diameter / across))
    )
}

/// What to say of a film that gets too thin for its particles.
fn thin(resolution: &Resolution, droplet: &Droplet, heat: Option<&HeatError>) -> Option<String> {
    let [film, _] = resolution.layers();
    if film >= THINNEST {
        return None;
    }
    let of_heat = heat.map_or(String::new(), |heat| format!("heat by {}, ", percents(heat)));
    Some(format!(
        "the film is expected to get {} distances of particles thin by the stop time: below {THINNEST} its spread is \
         off by a tenth to a half, its height by more, {of_heat}means of force, which are highest before, by {}; did you mean a \
         `spacing` of {} m or less?",
        below(film, THINNEST),
        percent(resolution.force()),
        number(rounded(resolution.thickness() * droplet.diameter / THICK))
    ))
}

/// A number below a bound, with as many digits as tell it from that, up to three.
fn below(value: f64, bound: f64) -> String {
    let digits = (1..3).find(|&digits| format!("{value:.digits$}") != format!("{bound:.digits$}"));
    format!("{value:.0$}", digits.unwrap_or(3))
}

/// An error and what it may be off by, in words.
fn percents(heat: &HeatError) -> String {
    format!("{:+.0} ± {:.0} %", 100.0 * heat.expected, 100.0 * heat.half)
}

fn percent(error: f64) -> String {
    format!("{:.0} %", 100.0 * error)
}

/// To two digits.
fn digits(value: f64) -> String {
    if value < 10.0 { format!("{value:.2}") } else { format!("{value:.0}") }
}

/// To two digits, downward.
fn rounded(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    let text = format!("{:.1e}", (value / unit).floor() * unit);
    text.parse().expect("it was written as a number")
}
