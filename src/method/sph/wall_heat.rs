//! Heat exchange between the particles at a wall and its points.

use super::contact_law::ContactLaw;
use super::freezing_law::{Contents, FreezingLaw, Lost};
use super::phases::Phases;
use super::plan::DropletPlan;
use super::resistive_law::{Loss, Resistance, ResistiveLaw, Temperatures};
use super::units::Units;
use super::wall_points::{Point, Stencil, WallPoints};
use crate::math::exponential;
use crate::port::Surface;
use crate::runtime::parallel::Team;

/// Heights over Δx: a particle counts fully as at the wall below the first, and not at all above
/// the second. Shares of evenly spread fluid sum to one layer of particles.
const AT_WALL: [f64; 2] = [0.95, 1.05];
/// Fraction of a full layer of particles at a point: below the first no fluid covers it, above the
/// second fluid covers all of it. At an edge the fraction crosses their mean, and unevenly spread
/// particles stay above both.
const COVERED: [f64; 2] = [0.25, 0.75];
/// Difference of heat content beyond rounding [K].
pub const BEYOND_ROUNDING: f64 = 1e-6;
/// Number of passes that reconcile the law's relaxation with the wall temperature. Every pass keeps
/// the latter between its value without flux and that of the fluid. Through a resistance the
/// temperature within it is reconciled, too. Tangents reconcile a fluid that freezes.
const PASSES: usize = 3;
const RESISTIVE_PASSES: usize = 6;
const FREEZING_PASSES: usize = 4;

/// Constants of the heat of contact, from a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct WallHeat {
    law: ContactLaw,
    /// Law of a contact that resists.
    resistive: Option<ResistiveLaw>,
    /// Phases of a fluid that freezes, and its law.
    freezing: Option<(Phases, FreezingLaw)>,
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
    pub content: f64,
    /// Heat content before contact: that of the release, or that at which a contact began anew.
    pub initial: f64,
}

/// Changes of heat content [K] of a particle at the wall in a step, now and before contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Change {
    pub content: f64,
    pub initial: f64,
}

/// Contribution of a point to a step: heat capacity times relaxation [J/K], temperature of the
/// fluid, its relaxation, and the decrease of the flux, see [`Loss`]. A fluid that freezes has the
/// tangent of its loss at the wall's temperature, and the temperature of a wall that would end it.
#[derive(Clone, Copy, Default)]
struct Contact {
    conductance: f64,
    fluid: f64,
    relaxation: f64,
    fall: f64,
    begins_anew: bool,
}

/// Line that replaces the heat of a freezing fluid as a function of the wall's temperature.
#[derive(Clone, Copy)]
enum Line {
    /// The tangent at the wall's present temperature.
    Tangent,
    /// The secant to the temperature of the layer, where no heat flows.
    Secant,
}

/// Conductance of the fluid above a column [J/K], its product with the fluid's temperature, and the
/// products of both with the decrease of the flux.
#[derive(Clone, Copy, Default)]
struct Above {
    sum: f64,
    drive: f64,
    falling_sum: f64,
    falling_drive: f64,
}

impl Above {
    /// Adds a conductance of a contact.
    fn add(&mut self, conductance: f64, Contact { fluid, fall, .. }: &Contact) {
        self.sum += conductance;
        self.drive += conductance * fluid;
        self.falling_sum += fall * conductance;
        self.falling_drive += fall * (conductance * fluid);
    }
}

impl WallHeat {
    /// Constants of a plan; `None` without wall or heat. `area` is that of a point's square [m²].
    pub fn of(plan: &DropletPlan, units: &Units, area: f64) -> Option<Self> {
        let fluid = &plan.fluid;
        let wall = plan.wall.as_ref().filter(|_| fluid.conductivity > 0.0)?;
        let capacity = fluid.density * fluid.specific_heat;
        let lattice = (plan.kernel, plan.support, plan.dimension);
        let resistive = |conductance: f64| {
            let biot = conductance * plan.spacing / fluid.conductivity;
            let effusivity = (capacity * fluid.conductivity).sqrt();
            ResistiveLaw::of(lattice, [biot, 1.0 / conductance, effusivity])
        };
        Some(Self {
            law: ContactLaw::of(plan.kernel, plan.support, plan.dimension),
            resistive: wall.conductance.map(resistive),
            freezing: plan
                .phases()
                .map(|phases| (phases, FreezingLaw::of(lattice, &phases, &starts(plan, &phases)))),
            conduction: fluid.conductivity / (capacity * units.speed * units.length),
            spacing: 1.0 / plan.support,
            layer: fluid.density * plan.spacing * area / units.mass(),
            capacity: fluid.specific_heat * units.mass(),
            unit_of_time: units.time(),
        })
    }

    /// The resistance of the contact above a surface; `None` for perfect contact.
    pub fn resistance_above(&self, surface: &Surface) -> Option<Resistance> {
        self.resistive.as_ref().map(|law| law.above(&surface.response))
    }

    /// Fraction of a particle, at a height over H, that is at the wall.
    pub fn share(&self, height: f64) -> f64 {
        let [all, none] = AT_WALL;
        ((none - height / self.spacing) / (none - all)).clamp(0.0, 1.0)
    }

    /// Exchanges heat for a time over H/c₀; returns the changes of the particles at the wall.
    ///
    /// At every point the mean content of the particle layer relaxes towards that of the wall
    /// by the [`ContactLaw`] or the [`FreezingLaw`], while the columns below absorb the heat. One flux applies to both
    /// sides, and temperatures are the columns' responses to it, so no step is too long. Each
    /// particle then approaches the wall by the same fraction of its own difference, so no
    /// content leaves the initial range.
    ///
    /// A layer that is hotter than at its release, above a wall colder than that, has met a wall that was hot before,
    /// and vice versa. No time of contact explains its content, so its contact begins anew, from the present content.
    pub fn exchange(
        &self,
        touching: &[Touching],
        points: &mut WallPoints,
        dt: f64,
        team: &Team,
    ) -> Vec<Change> {
        let stencils = self.gather(touching, points);
        let seconds = dt * self.unit_of_time;
        points.time += seconds;
        self.settle(points, dt, team);
        let points = &points.points;
        team.map(touching.len(), |n| {
            let Touching { share, content, initial, .. } = touching[n];
            let change = |(point, weight): (usize, f64)| {
                let point = &points[point];
                weight * (point.relaxation * (point.wall - content) - point.even_loss)
            };
            let begins_anew = |&(point, _): &(usize, f64)| points[point].begins_anew;
            let anew = stencils[n].weights().filter(begins_anew).map(|(_, weight)| weight);
            Change {
                content: share * stencils[n].weights().map(change).sum::<f64>(),
                initial: (content - initial) * anew.sum::<f64>(),
            }
        })
    }

    /// Accumulates the fluid at the wall in its points.
    fn gather(&self, touching: &[Touching], points: &mut WallPoints) -> Vec<Stencil> {
        let mut stencils = Vec::with_capacity(touching.len());
        for Touching { at, share, mass, content, initial, .. } in touching {
            let stencil = points.stencil(*at);
            for (index, weight) in stencil.weights() {
                if !points.points[index].active {
                    points.activate(index);
                }
                let point = &mut points.points[index];
                let part = weight * share * mass;
                point.mass += part;
                point.content_sum += part * content;
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
            let decayed: f64 = amplitudes.zip(&weights).map(|(a, [decay, ..])| a * decay).sum();
            column.base + decayed + part * column.drift
        };
        let free: Vec<f64> = (0..points.columns.len()).map(free).collect();
        // Rise of a column per heat, for a constant flux over the step [K/J]. A flux that falls
        // raises it by another factor.
        let held = response.of_held_flux(seconds) / seconds;
        let falling = match held > 0.0 {
            true => response.of_falling_flux(seconds) / seconds / held,
            false => 0.0,
        };
        let answers: Vec<f64> = points.columns.iter().map(|column| held / column.area).collect();
        let mut walls = free.clone();
        let mut contacts = Vec::new();
        let mut above = vec![Above::default(); walls.len()];
        let passes = match (&self.freezing, &points.resistance) {
            (Some(_), _) => FREEZING_PASSES,
            (None, Some(_)) => RESISTIVE_PASSES,
            (None, None) => PASSES,
        };
        for pass in 1..=passes {
            // Tangents converge quickly; a secant at the end ends at the temperature of the layer.
            let line = if pass < passes { Line::Tangent } else { Line::Secant };
            contacts = team.map(points.points.len(), |n| {
                let resistance = points.resistance.as_ref();
                self.contact(&points.points[n], &walls, dt, resistance, line)
            });
            above.fill(Above::default());
            for (point, contact) in points.points.iter().zip(&contacts) {
                for &(column, part) in &point.below {
                    above[column as usize].add(part * contact.conductance, contact);
                }
            }
            for (n, above) in above.iter().enumerate() {
                let drive = above.drive + falling * above.falling_drive;
                let sum = above.sum + falling * above.falling_sum;
                walls[n] = (free[n] + answers[n] * drive) / (1.0 + answers[n] * sum);
            }
        }
        for (n, (column, above)) in points.columns.iter_mut().zip(&above).enumerate() {
            let heat = above.drive - above.sum * walls[n];
            column.heat += heat;
            let rate = heat / column.area;
            let fall = (above.falling_drive - above.falling_sum * walls[n]) / column.area;
            let amplitudes = points.amplitudes[n * count..][..count].iter_mut().zip(&weights);
            for ((amplitude, [decay, mean, falling]), gain) in amplitudes.zip(&response.gains) {
                *amplitude = decay * *amplitude + mean * gain * rate + falling * gain * fall;
            }
        }
        for (point, contact) in points.points.iter_mut().zip(contacts) {
            let wall = wall_below(point, &walls);
            self.approach(point, &contact, wall);
            (point.mass, point.content_sum, point.initial_sum) = (0.0, 0.0, 0.0);
            if let Some((column, part)) = point.beyond {
                let fall = contact.fluid - walls[column as usize];
                points.heat_beyond += part * contact.conductance * fall;
            }
        }
    }

    /// Heat exchange of the fluid at a point with the columns below, at their given temperatures.
    fn contact(
        &self,
        point: &Point,
        walls: &[f64],
        dt: f64,
        resistance: Option<&Resistance>,
        line: Line,
    ) -> Contact {
        let [bare, covered] = COVERED;
        let layers = point.mass / (self.layer * point.extent);
        if layers <= bare {
            return Contact::default();
        }
        let cover = ((layers - bare) / (covered - bare)).min(1.0);
        let content = point.content_sum / point.mass;
        // The fluid forms a layer on the part that it covers.
        let thickness = self.spacing * layers / cover;
        let diffusion = self.conduction * dt / (thickness * thickness);
        let wall = wall_below(point, walls);
        // Where drops of unequal temperature meet, the mean of the fluid at the point counts.
        let before = point.initial_sum / point.mass;
        let capacity = self.capacity * point.mass;
        if let Some((phases, law)) = &self.freezing {
            let at = Contents { before, fluid: content, wall };
            let parts = resistance.map_or([0.0; 2], |found| found.parts(thickness / self.spacing));
            let begins_anew = law.begins_anew(at, parts);
            let loss = law.loss(at, diffusion, parts);
            let Lost { content: lost, fall } = loss;
            let gap = phases.rise(content) - wall;
            let secant = if gap == 0.0 { 0.0 } else { lost / gap };
            let slope = match line {
                Line::Tangent => law.slope(at, diffusion, parts, loss),
                Line::Secant => 0.0,
            };
            let (relaxation, fluid) =
                if slope > 0.0 { (slope, wall + lost / slope) } else { (secant, wall + gap) };
            let conductance = capacity * relaxation;
            return Contact { conductance, fluid, relaxation, fall, begins_anew };
        }
        let fluid = content;
        let begins_anew = is_beyond_release(before, fluid, wall);
        let before = if begins_anew { fluid } else { before };
        let Loss { part: relaxation, fall } = if let Some(resistance) = resistance {
            let at = Temperatures { before, fluid, wall };
            resistance.loss(at, diffusion, thickness / self.spacing)
        } else {
            let deficit = (before - fluid) / (before - wall);
            let deficit = Some(deficit).filter(|d| d.is_finite());
            Loss { part: self.law.relaxation(deficit, diffusion), fall: 0.0 }
        };
        Contact { conductance: capacity * relaxation, fluid, relaxation, fall, begins_anew }
    }

    /// Sets how the fluid at a point loses the heat of its contact with a wall of a temperature: relaxation times the
    /// difference of temperatures.
    fn approach(&self, point: &mut Point, contact: &Contact, wall: f64) {
        let Contact { fluid, relaxation, begins_anew, .. } = *contact;
        point.begins_anew = begins_anew;
        // Where nothing is below, as beyond the edge of a body, there is nothing to relax towards.
        let covered = covered(point);
        (point.relaxation, point.wall, point.even_loss) = (relaxation * covered, wall, 0.0);
        let Some((phases, _)) = &self.freezing else { return };
        let lost = relaxation * (fluid - wall) * covered;
        point.wall = phases.content(wall);
        let part = lost / (point.content_sum / point.mass - point.wall);
        // Contents that differ within the layer approach that of the wall, but where rounding or the linear response to
        // the wall's temperature would carry some beyond.
        let approaches = (0.0..=1.0).contains(&part);
        point.relaxation = if approaches { part } else { 0.0 };
        point.even_loss = if approaches || lost == 0.0 { 0.0 } else { lost };
    }
}

/// Returns true if the content of a layer and that of fluid at the wall's temperature lie on opposite sides of that before
/// contact, beyond rounding [K].
pub fn is_beyond_release(before: f64, fluid: f64, wall: f64) -> bool {
    let [passed, ahead] = [fluid - before, before - wall];
    passed * ahead > 0.0 && passed.abs().min(ahead.abs()) > BEYOND_ROUNDING
}

/// Hottest drop on demand with a table of its own, over the expected one's temperature.
const HOTTER: f64 = 1.5;

/// Temperatures of release, above the reference of a plan [K], for which the law of freezing is tabulated: those of its
/// drops. Inputs may set others of drops on demand and of a nozzle, between which the law interpolates.
fn starts(plan: &DropletPlan, phases: &Phases) -> Vec<f64> {
    let reference = plan.reference_temperature();
    let drops = plan.drops().map(|drop| drop.temperature - reference);
    let [_, liquidus] = phases.melting;
    let is_set = plan.demand.is_some() || plan.feed.is_some();
    let set = is_set.then_some([0.0, liquidus, (HOTTER - 1.0) * reference]);
    drops.chain(set.into_iter().flatten()).collect()
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

/// φ₀, φ₁ and φ₁ − 2φ₂ for each rate: of the past, of a constant flux and of one that falls from 1 to
/// −1.
fn weights(rates: &[f64], seconds: f64) -> Vec<[f64; 3]> {
    let of_rate = |rate: &f64| {
        let [decay, mean, growing, ..] = exponential::weights(rate * seconds);
        [decay, mean, mean - 2.0 * growing]
    };
    rates.iter().map(of_rate).collect()
}
