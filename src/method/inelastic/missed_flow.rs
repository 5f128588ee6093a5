//! Rate-independent flow within a step that the end of the step does not show.
//!
//! A step returns stress to the yield surface at its end. Where the yield stress follows the temperature, stress may
//! have been beyond it in between: a polymer that cools through its glass transition flows while it is warm, and its
//! yield stress then rises above the stress. At a part s of a step, with stress linear between its ends and the radius
//! R of the surface at the temperature then, the step misses flow where
//!
//! `|dev σ(s) − β| − R > (1 − s) √6 G Δp + tolerance R`:
//!
//! the excess over the surface is larger than the stress that the flow Δp relaxes from then on.

use super::problem::{InelasticError, InelasticProblem, PointState};
use crate::laws::{FlowLaw, Overstress, PlasticHistory, PointConstants};
use crate::runtime::parallel::Team;

/// `√6`
const ROOT_OF_SIX: f64 = 2.449_489_742_783_178;
/// Parts of a range of temperatures at which yield surfaces are compared, and accumulated plastic strains [1].
const COMPARED: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
const STRAINS: [f64; 3] = [0.0, 1e-2, 1.0];

/// Nodal temperatures at a part of a step [K].
pub type Look = (f64, Vec<f64>);

impl InelasticProblem {
    /// Returns true if a step between two states misses flow at some point; `looks` are the temperatures at the
    /// beginning, at parts and at the end of the step.
    pub fn misses_flow(
        &self,
        [start, end]: [&[f64]; 2],
        looks: &[Look],
        tolerance: f64,
    ) -> Result<bool, InelasticError> {
        let [(_, first), between @ .., (_, last)] = looks else { return Ok(false) };
        if self.creeps() || !self.dips(looks, tolerance) {
            return Ok(false);
        }
        let (start, end) = (self.points(start, first)?, self.points(end, last)?);
        let team = Team::new(self.threads);
        for (part, temperatures) in between {
            let constants = self.constants(temperatures, 0.0, &team)?;
            let mut points = start.iter().zip(&end).zip(&constants);
            if points.any(|((start, end), own)| misses([start, end], *part, own, tolerance)) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns true if the radius of the yield surface falls somewhere below the chord of its values at the ends of a
    /// step by more than the tolerance. Otherwise no stress that is linear between them passes it by more: nodes are
    /// fewer than points, and have no history to be read.
    fn dips(&self, looks: &[Look], tolerance: f64) -> bool {
        let (levels, plane) =
            (self.mesh.order(), self.mesh.axes[0].len() * self.mesh.axes[1].len());
        let of_layer = |layer: usize| layer * levels * plane..((layer + 1) * levels + 1) * plane;
        let all = || looks.iter().flat_map(|(_, temperatures)| temperatures);
        let low = all().copied().fold(f64::INFINITY, f64::min);
        let high = all().copied().fold(f64::NEG_INFINITY, f64::max);
        (0..self.grid.layers()).any(|layer| {
            let law = self.law(layer);
            let at = |part: f64| surface(law, low + part * (high - low));
            let is_even = COMPARED.iter().all(|&part| at(part) == at(0.0));
            !is_even && of_layer(layer).any(|node| dips_at(law, node, looks, tolerance))
        })
    }
}

/// Radii of the yield surface at a temperature [Pa], at three plastic strains; `None` where constants are invalid.
fn surface(law: &dyn FlowLaw, temperature: f64) -> Option<[f64; 3]> {
    law.over_step(temperature, 0.0).map(|own| STRAINS.map(|strain| own.radius(strain)))
}

/// Returns true if the radius dips below its chord at a node.
fn dips_at(law: &dyn FlowLaw, node: usize, looks: &[Look], tolerance: f64) -> bool {
    let [(_, first), between @ .., (_, last)] = looks else { return false };
    let ends = [first, last].map(|temperatures| surface(law, temperatures[node]));
    let [Some(first), Some(last)] = ends else { return true };
    between.iter().any(|(part, temperatures)| {
        let Some(now) = surface(law, temperatures[node]) else { return true };
        let chord = |n: usize| first[n] + part * (last[n] - first[n]);
        (0..now.len()).any(|n| now[n] * (1.0 + tolerance) < chord(n))
    })
}

fn misses([start, end]: [&PointState; 2], part: f64, own: &PointConstants, tolerance: f64) -> bool {
    if own.overstress != Overstress::NONE || !own.yield_stress.is_finite() {
        return false;
    }
    let mean = |a: f64, b: f64| a + part * (b - a);
    let stress = std::array::from_fn(|n| mean(start.stress[n], end.stress[n]));
    let [before, after] = [&start.history, &end.history];
    let history = PlasticHistory {
        back_strain: std::array::from_fn(|n| mean(before.back_strain[n], after.back_strain[n])),
        accumulated: mean(before.accumulated, after.accumulated),
        ..PlasticHistory::default()
    };
    let flow = after.accumulated - before.accumulated;
    let made_up = (1.0 - part) * ROOT_OF_SIX * own.shear * flow;
    let allowed = made_up + tolerance * own.radius(history.accumulated);
    own.beyond_yield(&stress, &history) > allowed
}
