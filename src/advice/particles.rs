//! Too few particles, or too wide a kernel, for a scene.

use super::Reviewer;
use super::resolution::{HeatError, Resolution};
use crate::kernel::Kernel;
use crate::limits::number;
use crate::scene::Droplet;
use crate::scene::locate::Path;
use crate::warning::{self, Finding};

/// Particle spacings over the thickness of a film below which it breaks up too soon, and the proposed number.
const THINNEST: f64 = 1.5;
const THICK: f64 = 2.0;
/// Smallest expected error of heat that causes a warning, one and a half times the uncertainty of the estimate.
const LEAST_TOLD: f64 = 0.08;
/// Smallest number of particles across a drop that resolves its heat, and a recommended number.
const FEWEST: f64 = 7.9;
const SOME: f64 = 12.0;
/// δ below which pressures oscillate, and the usual δ.
const LEAST_DIFFUSION: f64 = 0.01;
const USUAL_DIFFUSION: f64 = 0.1;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, droplet) in scene.droplets().filter(|(_, droplet)| droplet.has_particles()) {
        let path = Path::default().key("body").key(name);
        pairs(reviewer, &path, droplet);
        ringing(reviewer, &path, droplet);
        streams(reviewer, &path, droplet);
        if scene.has_surface_below(name) {
            coarse(reviewer, &path.key("spacing"), droplet);
            resolved(reviewer, &path.key("spacing"), (name, droplet));
        }
    }
}

/// Largest support of a spline, in particle spacings, at which no pairs form under pressure: that of 55 neighbours and
/// of 180 (W. Dehnen & H. Aly 2012, Mon. Not. R. Astron. Soc. 425, 1068–1082, doi 10.1111/j.1365-2966.2012.21439.x).
/// Under Wendland's kernels none form.
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
    let finding = warning::kernel_forms_pairs(spline, widest, number(droplet.support));
    reviewer.warn(&path.key("kernel"), finding);
}

/// Warns of density diffusion too weak to damp pressure waves.
fn ringing(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    if droplet.density_diffusion >= LEAST_DIFFUSION {
        return;
    }
    let finding = warning::density_diffusion_too_weak(USUAL_DIFFUSION);
    reviewer.warn(&path.key("density_diffusion"), finding);
}

/// Warns of particles that align along streamlines without shifting.
fn streams(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let free = Droplet { shifting: None, ..droplet.clone() };
    if droplet.shifts() || !free.shifts() {
        return;
    }
    reviewer.warn(&path.key("shifting"), warning::particles_line_up());
}

/// Warns of a drop of very few particles.
fn coarse(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let across = droplet.diameter / droplet.spacing;
    if across >= FEWEST {
        return;
    }
    let (across, spacing) = (format!("{across:.1}"), number(rounded(droplet.diameter / SOME)));
    reviewer.warn(path, warning::drop_of_few_particles(across, spacing));
}

/// Warns of a film that becomes too thin for its particles by the stop time, or of particles too wide for its shear and
/// thermal layers.
fn resolved(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let Some(resolution) = Resolution::of(reviewer.scene, (name, droplet)) else { return };
    let heat = resolution.heat().filter(|_| droplet.fluid.conductivity > 0.0);
    if let Some(finding) = thin(&resolution, droplet, heat.as_ref()) {
        reviewer.warn(path, finding);
        return;
    }
    if let Some(across) = resolution.across_for_middle()
        && reviewer.scene.coupling_from(name).is_some()
    {
        let spacing = number(rounded(droplet.diameter / across));
        reviewer.warn(path, warning::middle_too_hot(spacing));
    }
    if let Some(finding) = wetted(&resolution, droplet) {
        reviewer.warn(path, finding);
    }
    let tolerated = reviewer.scene.fidelity.tolerance.max(LEAST_TOLD);
    let Some(heat) = heat else { return };
    let size = if heat.outside.is_some() { heat.half } else { heat.expected.abs() };
    if size <= tolerated {
        return;
    }
    let remedy = match resolution.across_for_heat(tolerated) {
        Some(across) => format!(
            "did you mean a `spacing` of {} m or less?",
            number(rounded(droplet.diameter / across))
        ),
        None => "no `spacing` is known to keep it".to_owned(),
    };
    reviewer.warn(path, off(&resolution, &heat, tolerated, remedy));
}

/// Expected error of heat and its cause, or outside the fitted ranges the interval that covers it.
fn off(resolution: &Resolution, heat: &HeatError, tolerated: f64, remedy: String) -> Finding {
    if let Some(outside) = &heat.outside {
        return warning::heat_error_not_fitted(percent(heat.half), outside, remedy);
    }
    let [film, sheared] = resolution.layers().map(digits);
    let warmed = digits(resolution.thermal_layers().unwrap_or(0.0));
    let (error, tolerated) = (percents(heat), percent(tolerated));
    warning::heat_beyond_tolerance(error, tolerated, film, sheared, warmed, remedy)
}

/// Warns of a film on a poor conductor whose wetted area is not resolved by its particles.
fn wetted(resolution: &Resolution, droplet: &Droplet) -> Option<Finding> {
    if droplet.fluid.conductivity == 0.0 {
        return None;
    }
    let layers = digits(resolution.layers()[1]);
    let spacing = |across: f64| number(rounded(droplet.diameter / across));
    match (resolution.across_for_film(), resolution.across_for_area()) {
        (Some(whole), area) => {
            Some(warning::film_breaks_up(layers, spacing(area.unwrap_or(whole))))
        }
        (None, Some(area)) => Some(warning::wetted_area_unresolved(layers, spacing(area))),
        (None, None) => None,
    }
}

/// Warns of a film that becomes too thin for its particles.
fn thin(resolution: &Resolution, droplet: &Droplet, heat: Option<&HeatError>) -> Option<Finding> {
    let [film, _] = resolution.layers();
    if film >= THINNEST {
        return None;
    }
    let of_heat = heat.map_or(String::new(), |heat| format!("{} for heat, ", percents(heat)));
    let spacing = number(rounded(resolution.thickness() * droplet.diameter / THICK));
    let (film, force) = (below(film, THINNEST), percent(resolution.force()));
    Some(warning::film_thinner_than_particles(film, THINNEST, of_heat, force, spacing))
}

/// Formats a number below a bound with as many digits as distinguish it from the bound, up to three.
fn below(value: f64, bound: f64) -> String {
    let digits = (1..3).find(|&digits| format!("{value:.digits$}") != format!("{bound:.digits$}"));
    format!("{value:.0$}", digits.unwrap_or(3))
}

/// Formats an error and its uncertainty.
fn percents(heat: &HeatError) -> String {
    format!("{:+.0} ± {:.0} %", 100.0 * heat.expected, 100.0 * heat.half)
}

fn percent(error: f64) -> String {
    format!("{:.0} %", 100.0 * error)
}

/// Formats to two digits.
fn digits(value: f64) -> String {
    if value < 10.0 { format!("{value:.2}") } else { format!("{value:.0}") }
}

/// Rounds down to two digits.
fn rounded(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    let text = format!("{:.1e}", (value / unit).floor() * unit);
    text.parse().expect("it was written as a number")
}
