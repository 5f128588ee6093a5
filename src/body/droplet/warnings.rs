//! Warnings about drops: landing positions, films, and walls that respond to them.

use std::f64::consts::PI;

use super::plan::fine_radius;
use super::watch::Watch;
use super::{Below, DropletBody, totals};
use crate::body::{Advice, Approach, Occasion, Reading};
use crate::method::sph::WarmPlace;
use crate::scene::{Body, Coupling, Scene};
use crate::warning::{self, Finding, Warning};

/// Temperature that was set for a cell of a wall after a step with constant wall temperature.
struct WallResponse {
    /// Rise above the temperature during the step [K].
    rise: f64,
    /// Temperature of the fluid before contact above that of the wall [K].
    range: f64,
    /// √(kρc) of a half space that the step's heat, as a constant flux, warms by that rise [W √s/(m² K)].
    effusivity: f64,
}

impl WallResponse {
    fn share(&self) -> f64 {
        self.rise / self.range
    }

    /// Excess of the share over the contact temperature of two half spaces, given the fluid's effusivity; NaN if the
    /// fluid's heat did not cause the rise.
    fn beyond(&self, fluid: f64) -> f64 {
        let Self { effusivity, .. } = *self;
        let is_warmed = effusivity.is_finite() && effusivity > 0.0;
        if is_warmed { self.share() - fluid / (fluid + effusivity) } else { f64::NAN }
    }
}

/// Largest share by which a wall may be set beyond the contact temperature. Beyond it, later steps correct less: on
/// alumina under water (0.12 beyond) the highest rise is accurate to 4 %, on marble (0.4 beyond) it is 38 % too high.
const BEYOND_CONTACT: f64 = 0.2;
/// Number of particle spacings below which the height of a film depends on the arrangement of particles.
const FEW_LAYERS: f64 = 3.0;

/// Share of the fluid that may detach before a warning.
pub(super) const STRAY_SHARE: f64 = 0.05;

impl DropletBody {
    /// Warns of a wall whose temperature was set from the heat of a step during which it was constant.
    fn held_wall(&self, state: &[f64], before: &[f64], now: &[f64]) -> Option<Finding> {
        let Below::Wall(wall) = &self.below else { return None };
        if self.droplet.plan().wall.as_ref().is_none_or(|wall| wall.effusivity.is_some()) {
            return None;
        }
        let exchange = self.droplet.exchange(state);
        let response = |(cell, input): (usize, usize)| {
            let heat = exchange.heat.get(cell)? / wall.areas.get(cell)?;
            let rise = now[input] - before[input];
            let response = WallResponse {
                rise,
                range: self.rest.temperature - before[input],
                effusivity: 2.0 * heat / (rise * (PI * exchange.duration).sqrt()),
            };
            (response.beyond(self.rest.effusivity) > BEYOND_CONTACT).then_some(response)
        };
        let worst = wall.inputs.clone().enumerate().filter_map(response);
        let worst = worst.max_by(|a, b| a.share().total_cmp(&b.share()))?;
        let [rise, range] = [worst.rise, worst.range].map(|difference| format!("{difference:.3e}"));
        Some(warning::held_wall_answers(rise, range, format!("{:.2e}", worst.effusivity)))
    }
}

impl DropletBody {
    /// Warns of fluid that has come off, and of drops that still wait.
    fn at_end(&self, state: &[f64]) -> Vec<Finding> {
        let totals = self.droplet.totals(state);
        let part = totals.stray_mass / totals.mass;
        let off =
            (part > STRAY_SHARE).then(|| warning::fluid_comes_off(format!("{:.0}", 100.0 * part)));
        let asked = totals.released + totals.waiting;
        let none = (self.demand.is_some() && asked == 0.0).then(warning::no_drop_asked_for);
        let waits = (totals.waiting > 0.0).then(|| warning::drops_wait(totals.waiting, asked));
        off.into_iter().chain(waits).chain(none).collect()
    }
}

impl Approach for DropletBody {}

impl Advice for DropletBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        let found = match occasion {
            Occasion::Step => {
                let late = self.droplet.late_release(state).map(warning::drop_is_late);
                let beyond = self.overflows(state).then(warning::fluid_beyond_edge);
                beyond.into_iter().chain(late).collect()
            }
            Occasion::Response { before, now } => {
                self.held_wall(state, before, now).into_iter().collect()
            }
            Occasion::End => self.at_end(state),
        };
        found.into_iter().map(|finding: Finding| finding.at(&self.name)).collect()
    }

    fn watch(&self) -> Option<&Watch> {
        Some(&self.watch)
    }

    fn warm_places(&self, state: &[f64]) -> Option<[WarmPlace; 2]> {
        self.droplet.extremes(state)
    }

    fn warning_on_value(&self, reading: &Reading, value: f64) -> Option<Warning> {
        let Reading::Total(place) = *reading else { return None };
        let layers = value / self.droplet.plan().spacing;
        let is_film = !matches!(self.below, Below::Nothing) && layers > 0.0 && layers < FEW_LAYERS;
        (totals::is_height(place) && is_film)
            .then(|| on_height(layers).at(format!("{}.height", self.name)))
    }
}

/// Warns of drops that may land outside the fine mesh of a solid.
pub fn warnings_on_landing(scene: &Scene) -> Vec<Warning> {
    let warning = |coupling: &Coupling| {
        let droplet = scene.droplet(&coupling.from)?;
        // On a disc drops fall on the middle, as other places are refused.
        let is_round =
            coupling.solid().and_then(|solid| scene.body.get(solid)).is_some_and(Body::is_round);
        let is_unknown = droplet.is_on_demand() && coupling.radius.is_none() && !is_round;
        is_unknown.then(|| {
            let radius = format!("{:.1e}", fine_radius(coupling, droplet, scene.stop_time));
            warning::drops_may_miss_fine_mesh(&coupling.to, radius).at(&coupling.from)
        })
    };
    scene.coupling.iter().filter_map(warning).collect()
}

/// Warns of the height of a film of this many particle spacings. The errors are medians and ninth deciles relative to
/// 56 particles over the diameter, for liquids from mercury to glycerol.
fn on_height(layers: f64) -> Finding {
    let [usual, large] = if layers < 2.0 { [20, 50] } else { [15, 40] };
    let finer = format!("{:.1}", 6.0 / layers);
    warning::film_height_unresolved(format!("{layers:.1}"), usual, large, finer)
}
