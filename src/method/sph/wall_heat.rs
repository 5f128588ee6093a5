//! Heat exchange between the particles at a wall and its points.

use super::contact_law::ContactLaw;
use super::plan::DropletPlan;
use super::units::Units;
use super::wall_points::{Point, Stencil, WallPoints};
use crate::math::exponential;
use crate::runtime::parallel::Team;

/// Heights over Δx: a particle counts fully as at the wall below the first, and not at all above
/// the second. Shares of evenly spread fluid sum to one layer of particles.
const AT_WALL: [f64; 2] = [0.95, 1.05];
/// Fraction of a full layer of particles at a point: below the first no fluid covers it, above the
/// second fluid covers all of it. At an edge the fraction crosses their mean, and unevenly spread
/// particles stay above both.
const COVERED: [f64; 2] = [0.25, 0.75];
/// Number of passes that reconcile the law's relaxation with the wall temperature. Every pass keeps
/// the latter between its value without flux and that of the fluid.
const PASSES: usize = 3;

/// Constants of the heat of contact, from a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct WallHeat {
    law: ContactLaw,
    /// κ over c₀H, and Δx over H.
    conduction: f64,
    spacing: f64,
    /// Mass over ρ₀H^d of a full layer of particles above a point's square; for a ring, over its
    /// extent.
    layer: f64,
    /// Heat capacity of the unit of mass [J/K].
    capacity: f64,
    /// Unit of time [s].
    unit_of_time: f64,
}

/// A particle at the wall.
#[derive(Clone)]
pub struct Touching {
    pub particle: usize,
    /// Position on the wall [m].
    pub at: [f64; 2],
    /// Fraction of the particle that is at the wall.
    pub share: f64,
    pub mass: f64,
    pub temperature: f64,
    /// Temperature before contact.
    pub initial: f64,
}

/// Contribution of a point to a step: heat capacity times relaxation [J/K], and temperature of the
/// fluid.
#[derive(Clone, Copy, Default)]
struct Contact {
    conductance: f64,
    fluid: f64,
    relaxation: f64,
}

impl WallHeat {
    /// Constants of a plan; `None` without wall or heat. `area` is that of a point's square [m²].
    pub fn of(plan: &DropletPlan, units: &Units, area: f64) -> Option<Self> {
        let fluid = &plan.fluid;
        if plan.wall.is_none() || fluid.conductivity <= 0.0 {
            return None;
        }
        let capacity = fluid.density * fluid.specific_heat;
        Some(Self {
            law: ContactLaw::of(plan.kernel, plan.support, plan.dimension),
            conduction: fluid.conductivity / (capacity * units.speed * units.length),
            spacing: 1.0 / plan.support,
            layer: fluid.density * plan.spacing * area / units.mass(),
            capacity: fluid.specific_heat * units.mass(),
            unit_of_time: units.time(),
        })
    }

    /// Fraction of a particle, at a height over H, that is at the wall.
    pub fn share(&self, height: f64) -> f64 {
        let [all, none] = AT_WALL;
        ((none - height / self.spacing) / (none - all)).clamp(0.0, 1.0)
    }

    /// Exchanges heat for a time over H/c₀; returns the changes of temperature [K] of the particles
    /// at the wall.
    ///
    /// At every point the mean temperature of the particle layer relaxes towards that of the wall
    /// by the [`ContactLaw`], while the columns below absorb the heat. One flux applies to both
    /// sides, and temperatures are the columns' responses to it, so no step is too long. Each
    /// particle then approaches the wall by the same fraction of its own difference, so no
    /// temperature leaves the initial range.
    pub fn exchange(
        &self,
        touching: &[Touching],
        points: &mut WallPoints,
        dt: f64,
        team: &Team,
    ) -> Vec<f64> {
        let stencils = self.gather(touching, points);
        let seconds = dt * self.unit_of_time;
        points.time += seconds;
        self.settle(points, dt, team);
        let points = &points.points;
        team.map(touching.len(), |n| {
            let Touching { share, temperature, .. } = touching[n];
            let change = |(point, weight): (usize, f64)| {
                let point = &points[point];
                weight * point.relaxation * (point.wall - temperature)
            };
            share * stencils[n].weights().map(change).sum::<f64>()
        })
    }

    /// Accumulates the fluid at the wall in its points.
    fn gather(&self, touching: &[Touching], points: &mut WallPoints) -> Vec<Stencil> {
        let mut stencils = Vec::with_capacity(touching.len());
        for Touching { at, share, mass, temperature, initial, .. } in touching {
            let stencil = points.stencil(*at);
            for (index, weight) in stencil.weights() {
                if !points.points[index].active {
                    points.activate(index);
                }
                let point = &mut points.points[index];
                let part = weight * share * mass;
                point.mass += part;
                point.temperature_sum += part * temperature;
                point.initial_sum += part * initial;
            }
            stencils.push(stencil);
        }
        stencils
    }

    /// Solves for the temperatures of points and columns at the end of a step, and deposits the
    /// heat in the columns.
    fn settle(&self, points: &mut WallPoints, dt: f64, team: &Team) {
        let seconds = dt * self.unit_of_time;
        let response = &points.surface.response;
        let count = response.len();
        let weights = weights(&response.rates, seconds);
        let part = points.time / points.duration;
        let free = |n: usize| {
            let column = &points.columns[n];
            let amplitudes = points.amplitudes[n * count..][..count].iter();
            let decayed: f64 = amplitudes.zip(&weights).map(|(a, [decay, _])| a * decay).sum();
            column.base + decayed + part * column.drift
        };
        let free: Vec<f64> = (0..points.columns.len()).map(free).collect();
        // Rise of a column per heat, for a constant flux over the step [K/J].
        let held = response.of_held_flux(seconds) / seconds;
        let answers: Vec<f64> = points.columns.iter().map(|column| held / column.area).collect();
        let mut walls = free.clone();
        let mut contacts = Vec::new();
        // Conductance of the fluid above each column [J/K], and its product with the fluid's temperature.
        let mut sums = vec![[0.0; 2]; walls.len()];
        for _ in 0..PASSES {
            contacts =
                team.map(points.points.len(), |n| self.contact(&points.points[n], &walls, dt));
            sums.fill([0.0; 2]);
            for (point, contact) in points.points.iter().zip(&contacts) {
                for &(column, part) in &point.below {
                    let conductance = part * contact.conductance;
                    let [sum, drive] = &mut sums[column as usize];
                    *sum += conductance;
                    *drive += conductance * contact.fluid;
                }
            }
            for (n, [sum, drive]) in sums.iter().enumerate() {
                walls[n] = (free[n] + answers[n] * drive) / (1.0 + answers[n] * sum);
            }
        }
        for (n, (column, [sum, drive])) in points.columns.iter_mut().zip(&sums).enumerate() {
            let heat = drive - sum * walls[n];
            column.heat += heat;
            let rate = heat / column.area;
            let amplitudes = points.amplitudes[n * count..][..count].iter_mut().zip(&weights);
            for ((amplitude, [decay, mean]), gain) in amplitudes.zip(&response.gains) {
                *amplitude = decay * *amplitude + mean * gain * rate;
            }
        }
        for (point, contact) in points.points.iter_mut().zip(contacts) {
            (point.mass, point.temperature_sum, point.initial_sum) = (0.0, 0.0, 0.0);
            // Where nothing is below, as beyond the edge of a body, there is nothing to relax
            // towards.
            point.relaxation = contact.relaxation * covered(point);
            point.wall = wall_below(point, &walls);
            if let Some((column, part)) = point.beyond {
                let fall = contact.fluid - walls[column as usize];
                points.heat_beyond += part * contact.conductance * fall;
            }
        }
    }

    /// Heat exchange of the fluid at a point with the columns below, at their given temperatures.
    fn contact(&self, point: &Point, walls: &[f64], dt: f64) -> Contact {
        let [bare, covered] = COVERED;
        let layers = point.mass / (self.layer * point.extent);
        if layers <= bare {
            return Contact::default();
        }
        let cover = ((layers - bare) / (covered - bare)).min(1.0);
        let fluid = point.temperature_sum / point.mass;
        // The fluid forms a layer on the part that it covers.
        let thickness = self.spacing * layers / cover;
        let diffusion = self.conduction * dt / (thickness * thickness);
        let wall = wall_below(point, walls);
        // Where drops of unequal temperature meet, the mean of the fluid at the point counts.
        let before = point.initial_sum / point.mass;
        let deficit = (before - fluid) / (before - wall);
        let relaxation = self.law.relaxation(Some(deficit).filter(|d| d.is_finite()), diffusion);
        Contact { conductance: self.capacity * point.mass * relaxation, fluid, relaxation }
    }
}

/// Mean temperature of the columns below a point.
fn wall_below(point: &Point, walls: &[f64]) -> f64 {
    let parts = point.below.iter().chain(&point.beyond);
    let (sum, whole) = parts.fold((0.0, 0.0), |(sum, whole), &(column, part)| {
        (sum + part * walls[column as usize], whole + part)
    });
    if whole > 0.0 { sum / whole } else { 0.0 }
}

/// Fraction of a point's square with something below it.
fn covered(point: &Point) -> f64 {
    point.below.iter().chain(&point.beyond).map(|&(_, part)| part).sum()
}

/// φ₀ and φ₁ for each rate.
fn weights(rates: &[f64], seconds: f64) -> Vec<[f64; 2]> {
    let both = |rate: &f64| {
        let [decay, mean, ..] = exponential::weights(rate * seconds);
        [decay, mean]
    };
    rates.iter().map(both).collect()
}
