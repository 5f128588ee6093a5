//! Replayed drops on surfaces for which their records are unreliable.

use super::{Path, Reviewer, number};
use crate::closed_form::DropImpact;
use crate::limits::two_digits;
use crate::scene::{Droplet, DropletMethod, Scene, Solid};
use crate::warning;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, droplet) in scene.droplets().filter(|(_, droplet)| droplet.is_replayed()) {
        let path = Path::default().key("body").key(name).key("method");
        thin(reviewer, &path, (name, droplet));
        stacked(reviewer, (name, droplet));
        risky(reviewer, (name, droplet));
        cut(reviewer, (name, droplet));
        if droplet.method == DropletMethod::Film {
            insulated(reviewer, &path, (name, droplet));
            depleted(reviewer, &path, (name, droplet));
            unfitted(reviewer, &path, droplet);
        }
    }
}

/// Part of the time D/U in which a drop spreads, up to which a step hardly changes the probability of failure below: of
/// glass under water by 5 % at a tenth, by 60 % at a third.
const SHORT: f64 = 0.15;

/// Warns of steps that are long beside the spreading of films, where a probability of failure is read from the stress
/// at their ends.
fn risky(reviewer: &mut Reviewer, (name, droplet): (&str, &Droplet)) {
    let scene = reviewer.scene;
    let Some(coupling) = scene.coupling_from(name) else { return };
    let Some(solid) = scene.coupling[coupling].solid() else { return };
    let speed = droplet.normal_speed_at_contact();
    let most = SHORT * droplet.diameter / speed;
    if scene.solid(solid).is_some_and(Solid::has_flaws) && speed > 0.0 && scene.step > most {
        let finding = warning::film_risk_follows_step(solid, number(scene.step), two_digits(most));
        reviewer.warn(&Path::default().key("step"), finding);
    }
}

/// Parts of the momentum and of the largest radius that a record may leave out.
const LEFT_OUT: [f64; 2] = [0.01, 0.05];

/// Warns of records that end while the drop still comes down or spreads.
fn cut(reviewer: &mut Reviewer, (name, droplet): (&str, &Droplet)) {
    let Some(duration) = droplet.record.as_ref().and_then(|record| record.duration) else { return };
    let speed = droplet.normal_speed_at_contact();
    if speed <= 0.0 {
        return;
    }
    let impact = DropImpact { speed, ..droplet.impact() };
    let largest = 0.5 * droplet.diameter * impact.largest_spread();
    let wetted = impact.wetted_radius(largest, duration) / largest;
    let given = impact.momentum_given(duration);
    if 1.0 - given < LEFT_OUT[0] && 1.0 - wetted < LEFT_OUT[1] {
        return;
    }
    let whole = Droplet { record: None, ..droplet.clone() }.recorded_time(speed);
    let percent = |part: f64| format!("{:.0}", 100.0 * part);
    let finding = warning::record_cut_short(
        number(duration),
        percent(given),
        percent(wetted),
        two_digits(whole),
    );
    reviewer.warn(&Path::default().key("body").key(name).key("record").key("duration"), finding);
}

/// Largest number of films on one place that were compared with particles (`docs/fidelity.md`).
pub const MEASURED_FILMS: f64 = 3.0;
/// Time after which a film transfers a thousandth of its heat, over the time in which it cools.
const SPENT: f64 = 3.0;

/// Warns of arrivals on one place at which more films than were ever measured still transfer heat.
fn stacked(reviewer: &mut Reviewer, (name, droplet): (&str, &Droplet)) {
    let speed = droplet.normal_speed_at_contact();
    if droplet.fluid.conductivity == 0.0 || speed <= 0.0 || droplet.is_on_demand() {
        return;
    }
    let cooling = cooling_time(reviewer.scene, (name, droplet));
    let giving = droplet.recorded_time(speed) + SPENT * cooling;
    let reach = 0.5 * droplet.spread_diameter();
    let mut arrivals: Vec<_> = droplet.arrivals().iter().collect();
    arrivals.sort_by(|a, b| a.time.total_cmp(&b.time));
    let films = |n: usize| {
        let own = arrivals[n];
        let before = arrivals[..n].iter().rev().take_while(|other| own.time - other.time < giving);
        1 + before.filter(|other| (own.x - other.x).hypot(own.y - other.y) < reach).count()
    };
    let Some(at) = (0..arrivals.len()).find(|&n| films(n) as f64 > MEASURED_FILMS) else { return };
    let path = Path::default().key("body").key(name).key("arrivals");
    let (time, films) = (number(arrivals[at].time), films(at) - 1);
    reviewer.warn(&path, warning::drops_stack(time, films, MEASURED_FILMS));
}

/// Ratio of effusivities up to which two layers count as equal.
const ALIKE: f64 = 1.25;

/// Warns of drops on layers thinner than the heat penetration depth during cooling: records were computed on a half
/// space, from which no heat returns.
fn thin(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let Some((thickness, diffusivity)) = half_space(reviewer.scene, name) else { return };
    let speed = droplet.normal_speed_at_contact();
    if droplet.fluid.conductivity == 0.0 || speed <= 0.0 {
        return;
    }
    let time = droplet.recorded_time(speed).max(cooling_time(reviewer.scene, (name, droplet)));
    let depth = (4.0 * diffusivity * time.min(reviewer.scene.stop_time)).sqrt();
    if depth <= thickness {
        return;
    }
    let (thickness, depth) = (format!("{thickness:.1e}"), format!("{depth:.1e}"));
    reviewer.warn(path, warning::layer_thinner_than_heat_penetrates(thickness, depth));
}

/// Thickness [m] over which the material below a droplet is similar to its top, and the diffusivity of that [m²/s].
fn half_space(scene: &Scene, name: &str) -> Option<(f64, f64)> {
    scene.effusivity_below(name)?;
    let coupling = &scene.coupling[scene.coupling_from(name)?];
    let strata = scene.solid_below(coupling)?.1.strata();
    let top = strata.first()?.constants;
    let is_alike = |effusivity: f64| {
        let ratio = effusivity / top.effusivity();
        ratio.max(1.0 / ratio) < ALIKE
    };
    let alike = strata.iter().take_while(|layer| is_alike(layer.constants.effusivity()));
    Some((alike.map(|layer| layer.thickness()).sum(), top.diffusivity()))
}

/// Time in which the film of a drop cools [s]: `δ²/a` over the square of the share of its heat that the wall absorbs.
fn cooling_time(scene: &Scene, (name, droplet): (&str, &Droplet)) -> f64 {
    let fluid = &droplet.fluid;
    let own = fluid.effusivity();
    let taken = scene.effusivity_below(name).map_or(1.0, |below| below / (below + own));
    let diffusivity = fluid.conductivity / (fluid.density * fluid.specific_heat);
    thickness(droplet).powi(2) / (diffusivity * taken.powi(2))
}

/// Thickness of the film that a drop forms [m].
fn thickness(droplet: &Droplet) -> f64 {
    let spread = droplet.spread_diameter() / droplet.diameter;
    2.0 / 3.0 * droplet.diameter / spread.powi(2)
}

/// Fourier number of a film over D/U from which on it has cooled through while its drop still arrives.
const COOLED: f64 = 0.25;

/// Warns of films that have cooled before fresh fluid stops arriving: metals on good conductors. They have their final
/// thickness from the start.
fn depleted(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let speed = droplet.normal_speed_at_contact();
    if droplet.fluid.conductivity == 0.0 || speed <= 0.0 {
        return;
    }
    let cooling = cooling_time(reviewer.scene, (name, droplet));
    let fourier = droplet.diameter / speed / cooling;
    if fourier < COOLED {
        return;
    }
    let fourier = number((100.0 * fourier).round() / 100.0);
    reviewer.warn(path, warning::film_cools_through(fourier, COOLED));
}

/// Effusivity of the material below over that of the fluid, below which heat follows the wetted area: mercury on
/// polymers.
const INSULATES: f64 = 0.15;

/// Warns of films on near-insulators, whose heat follows the wetted area (`docs/fidelity.md`).
fn insulated(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let Some(below) = reviewer.scene.effusivity_below(name) else { return };
    if droplet.fluid.conductivity == 0.0 || below >= INSULATES * droplet.fluid.effusivity() {
        return;
    }
    reviewer.warn(path, warning::film_on_insulator());
}

/// Reynolds number below which drops rest on a flat much smaller than the fitted footprint.
const VISCOUS: f64 = 4.0;

/// Warns of drops beyond the ranges over which footprints of films were fitted. Compared with particles (D/Δx 40 and
/// 80), heat after 1 D/U was 1.9 times as much at Re 2.4, 2.9 and 3.1 times at Re 0.7, and 8.9 times at Re 0.1.
fn unfitted(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let impact = droplet.impact();
    let Some(outside) = impact.outside_of_fitted().filter(|_| impact.speed > 0.0) else { return };
    let error = match impact.reynolds() < VISCOUS {
        true => "its footprint and heat are expected to be too large, heat by two to nine times",
        false => "the errors of its footprint and heat are not known",
    };
    reviewer.warn(path, warning::film_not_fitted(error, outside));
}
