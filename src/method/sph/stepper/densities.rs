//! Densities and temperatures over a step.

use super::Stepper;
use crate::method::sph::arrest::note_arrest;
use crate::method::sph::cloud::{Cloud, Part};
use crate::method::sph::continuity::Continuity;
use crate::method::sph::loops::{PART, for_parts};
use crate::method::sph::method::{Method, Push};
use crate::method::sph::wall_heat::Touching;
use crate::method::sph::wall_points::WallPoints;
use crate::runtime::parallel::Team;

impl Stepper<'_, '_> {
    /// Advances densities and temperatures over a step, and moves the particles from its middle to its end.
    pub(super) fn change_density_and_heat(&mut self, dt: f64) {
        let moved = self.frozen_moved(0.5 * dt);
        match (self.heats, self.method.needs_moments()) {
            (false, false) => self.change_density::<false, false>(dt),
            (false, true) => self.change_density::<false, true>(dt),
            (true, false) => self.change_density::<true, false>(dt),
            (true, true) => self.change_density::<true, true>(dt),
        }
        self.place_frozen(&moved);
    }

    /// Advances densities and temperatures over a step from the records at its middle, and moves
    /// the particles to its end.
    fn change_density<const HEAT: bool, const MOMENTS: bool>(&mut self, dt: f64) {
        let method = self.method;
        let pass = Continuity::<HEAT, MOMENTS> {
            images: &method.images,
            records: &self.records,
            densities: &self.densities,
            annexes: &self.annexes,
            normalisation: method.normalisation,
            diffusion: method.diffusion(dt),
            tension_dimension: method.surface.as_ref().map(|_| method.dimension),
            conduction: method.conduction / conducting(method, &self.cloud.moment),
        };
        let parts = self.cloud.parts(PART);
        let mut parts: Vec<_> = parts.into_iter().map(|part| (part, Vec::new())).collect();
        for_parts(
            &pass,
            &self.neighbours.blocks,
            method.pairs(),
            self.team,
            &mut parts,
            |(part, pushes), rates| {
                for (k, rate) in rates.iter().enumerate() {
                    method.change::<MOMENTS>(part, k, rate, dt);
                }
                drift(part, 0.5 * dt);
                method.rebound(part, pushes);
            },
        );
        let pushes: Vec<Push> = parts.into_iter().flat_map(|(_, pushes)| pushes).collect();
        if let Some(points) = &mut self.points {
            pushes.into_iter().for_each(|(at, impulse)| points.push(at, impulse));
            if HEAT {
                let touching = exchange_heat(method, self.cloud, points, dt, self.team);
                note_arrest(self.ledger, self.cloud, &touching, method);
            }
        }
    }
}

/// Moves particles along their velocities.
pub(super) fn drift(part: &mut Part, dt: f64) {
    for (x, v) in part.position.iter_mut().zip(&*part.velocity) {
        (0..3).for_each(|a| x[a] += dt * v[a]);
    }
}

/// Lower bound on the moment's trace, over its full value, of particles well inside the fluid.
const INSIDE: f64 = 0.85;

/// Effective over nominal conductivity of the plain sums, as a mean over all particles well inside
/// the fluid: 1 on a lattice, 0.95 once particles have settled. For a linear temperature, the sum
/// of fluxes is the moment matrix.
pub fn conducting(method: &Method, moments: &[[f64; 6]]) -> f64 {
    if !method.needs_moments() {
        return 1.0;
    }
    let trace = |moment: &[f64; 6]| moment[..3].iter().sum::<f64>() / 3.0;
    let flat = if method.dimension == 2 { 1.0 } else { 0.0 };
    let of_axes = |trace: f64| (3.0 * trace - flat) / method.dimension as f64;
    let inside = moments.iter().map(trace).map(of_axes).filter(|&part| part > INSIDE);
    let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), part| (sum + part, count + 1.0));
    if count > 0.0 { sum / count } else { 1.0 }
}

/// Exchanges heat with the wall for a time; returns the particles that touch it.
fn exchange_heat(
    method: &Method,
    cloud: &mut Cloud,
    points: &mut WallPoints,
    dt: f64,
    team: &Team,
) -> Vec<Touching> {
    let Some(heat) = &method.wall_heat else { return Vec::new() };
    let near = |part: &mut Part| {
        let touching = |k: usize| {
            let share = heat.share(part.position[k][2]);
            (share > 0.0).then(|| Touching {
                particle: part.first + k,
                at: method.place(part.position[k]),
                share,
                mass: part.mass[k],
                content: part.content.as_ref().map_or(part.temperature[k], |content| content[k]),
                initial: part.initial[k],
            })
        };
        (0..part.mass.len()).filter_map(touching).collect::<Vec<_>>()
    };
    let mut touching = team.map_each(&mut cloud.parts(PART), near).concat();
    let moving = touching.len();
    touching.extend_from_slice(&points.resting);
    let changes = heat.exchange(&touching, points, dt, team);
    touching.truncate(moving);
    for (touching, change) in touching.iter().zip(&changes) {
        cloud.heat(touching.particle, change.content, method.phases.as_ref());
        cloud.initial[touching.particle] += change.initial;
    }
    for (resting, change) in points.resting.iter_mut().zip(&changes[moving..]) {
        resting.content += change.content;
        resting.initial += change.initial;
    }
    touching
}
