//! Steps of heat in time.
//!
//! A step is cut into parts of a stiffly accurate Runge–Kutta method of three stages and third order, L-stable: long
//! parts leave nothing of fast modes (R. Alexander 1977, doi 10.1137/0714068). Its first two slopes give a result of
//! second order, whose distance estimates the error that sets the length of parts.

use super::super::{Deformable, Failure};
use super::conduction::{Conduction, Factored};
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// Exchange of a node with surroundings whose temperature changes linearly over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    pub node: usize,
    /// [W/K]
    pub conductance: f64,
    /// At the beginning and at the end [K].
    pub ambient: [f64; 2],
}

/// Conditions over a step; all change linearly.
#[derive(Debug, Clone, Default)]
pub struct HeatDrive {
    /// Temperature of held nodes at the beginning and at the end [K]; those of others are not read.
    pub held: Vec<[f64; 2]>,
    /// Heat flow into each node at the beginning and at the end [W].
    pub flows: Vec<[f64; 2]>,
    pub films: Vec<Film>,
}

/// Heat that passed in a step [J].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Passed {
    /// Into the body by flows.
    pub brought_in: f64,
    /// Out of it through held nodes.
    pub through_held: f64,
    /// Out of it through each film.
    pub through_films: Vec<f64>,
}

/// Name of the parts in messages.
pub const HEAT_STEPS: &str = "steps of heat in a solid of large strain";
/// Work of a part for each point, in updated numbers.
pub const HEAT_WORK: usize = 100;
/// Coefficient γ of all stages, the root of `γ³ − 3γ² + 3γ/2 − 1/6` within (1/6, 1/2).
const GAMMA: f64 = 0.435_866_521_508_459;
/// Weights of the slopes of earlier stages, stage by stage; those of the last are those of the method.
const WEIGHTS: [[f64; 3]; 3] = [
    [GAMMA, 0.0, 0.0],
    [0.5 * (1.0 - GAMMA), GAMMA, 0.0],
    [
        -0.25 * (6.0 * GAMMA * GAMMA - 16.0 * GAMMA + 1.0),
        0.25 * (6.0 * GAMMA * GAMMA - 20.0 * GAMMA + 5.0),
        GAMMA,
    ],
];
/// Fraction of a part at which each stage is.
const TIMES: [f64; 3] = [GAMMA, 0.5 * (1.0 + GAMMA), 1.0];
/// Weight of the second slope in the result of second order, the rest of which has the first.
const SECOND: f64 = (1.0 - 2.0 * GAMMA) / (1.0 - GAMMA);
/// Weights of the slopes in the error.
const ERROR: [f64; 3] = [WEIGHTS[2][0] - (1.0 - SECOND), WEIGHTS[2][1] - SECOND, WEIGHTS[2][2]];
/// Largest estimated error of a part over the range of the temperatures.
const TOLERANCE: f64 = 2e-3;
/// Error that is always allowed [K].
const LEAST_ERROR: f64 = 1e-6;
/// Bounds on the ratio of two parts, and safety of their estimate.
const RATIO: [f64; 2] = [0.1, 4.0];
const SAFETY: f64 = 0.9;
/// Smallest part of a step.
const LEAST: f64 = 1e-9;

/// A part of a step, from a fraction of it on.
struct Part<'a> {
    conduction: &'a Conduction,
    conductances: &'a [f64],
    drive: &'a HeatDrive,
    /// Conductance of all films of each node [W/K].
    films: &'a [f64],
    from: f64,
    part: f64,
    /// Its length [s].
    dt: f64,
}

/// Result of a part.
struct Made {
    temperature: Vec<f64>,
    passed: Passed,
    /// Largest estimated error [K].
    error: f64,
}

impl Conduction {
    /// Advances the temperatures of a body displaced by u over a duration [s].
    pub fn advance(
        &self,
        (body, u): (&Deformable, &[[f64; 3]]),
        temperature: &mut Vec<f64>,
        drive: &HeatDrive,
        duration: f64,
        allowance: &Allowance,
    ) -> Result<Passed, Failure> {
        let team: &Team = &body.team();
        let conductances = &self.conductances(body, u, team);
        let mut films = vec![0.0; temperature.len()];
        drive.films.iter().for_each(|film| films[film.node] += film.conductance);
        let mut sum = Passed { through_films: vec![0.0; drive.films.len()], ..Passed::default() };
        let (mut from, mut part) = (0.0, 1.0);
        while from < 1.0 {
            allowance.spend(1.0, HEAT_STEPS, HEAT_WORK * body.space.volume.len())?;
            let is_last = from + part >= 1.0 - LEAST;
            part = if is_last { 1.0 - from } else { part };
            let dt = part * duration;
            let own = Part { conduction: self, conductances, drive, films: &films, from, part, dt };
            let made = own.make(temperature)?;
            let allowed = LEAST_ERROR.max(TOLERANCE * range(temperature, &made.temperature, drive));
            let ratio = SAFETY * (allowed / made.error).cbrt();
            let ratio = ratio.clamp(RATIO[0], RATIO[1]);
            if made.error > allowed && part > LEAST {
                part *= ratio;
                continue;
            }
            *temperature = made.temperature;
            sum.add(&made.passed);
            from = if is_last { 1.0 } else { from + part };
            part *= ratio;
        }
        Ok(sum)
    }
}

impl Passed {
    fn add(&mut self, other: &Self) {
        self.brought_in += other.brought_in;
        self.through_held += other.through_held;
        let films = self.through_films.iter_mut().zip(&other.through_films);
        films.for_each(|(sum, heat)| *sum += heat);
    }
}

/// Range of the temperatures before and after a part, and of those around the body [K].
fn range(before: &[f64], after: &[f64], drive: &HeatDrive) -> f64 {
    let around = drive.films.iter().flat_map(|film| film.ambient);
    let all = before.iter().chain(after).copied().chain(around);
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = all.fold(ends, |(low, high), t| (low.min(t), high.max(t)));
    high - low
}

impl Part<'_> {
    fn make(&self, before: &[f64]) -> Result<Made, Failure> {
        let Self { conduction, conductances, films, dt, .. } = *self;
        let storing: Vec<f64> = conduction.capacity.iter().map(|c| c / (GAMMA * dt)).collect();
        let diagonal: Vec<f64> = storing.iter().zip(films).map(|(c, film)| c + film).collect();
        let factor = &conduction.factor(conductances, &diagonal)?;
        let (mut slopes, mut stages) = (Vec::<Vec<f64>>::new(), Vec::new());
        for (weights, at) in WEIGHTS.iter().zip(TIMES) {
            let mut base = before.to_vec();
            for (weight, slope) in weights.iter().zip(&slopes) {
                base.iter_mut().zip(slope).for_each(|(t, slope)| *t += weight * dt * slope);
            }
            let stage = self.stage(factor, &storing, &base, at);
            let slope = base.iter().zip(&stage).map(|(from, to)| (to - from) / (GAMMA * dt));
            slopes.push(slope.collect());
            stages.push(stage);
        }
        let of_node = |node: usize| -> f64 {
            let sum: f64 = ERROR.iter().zip(&slopes).map(|(weight, own)| weight * own[node]).sum();
            if conduction.held[node] { 0.0 } else { storing[node] * dt * sum }
        };
        let mut error: Vec<f64> = (0..before.len()).map(of_node).collect();
        // Solved once more, the error of stiff modes, which have settled, does not shorten steps.
        factor.solve(&mut error);
        let passed = self.passed(before, &stages);
        let temperature = stages.swap_remove(2);
        if !temperature.iter().all(|t| t.is_finite()) {
            return Err(Failure::NotFinite);
        }
        let error = error.iter().fold(0.0, |most: f64, e| most.max(e.abs()));
        Ok(Made { temperature, passed, error })
    }

    /// Temperatures of a stage at a fraction of the part.
    fn stage(&self, factor: &Factored, storing: &[f64], base: &[f64], at: f64) -> Vec<f64> {
        let Self { conduction, conductances, drive, .. } = *self;
        let is_held = &conduction.held;
        let mut held = vec![0.0; base.len()];
        for node in (0..base.len()).filter(|&node| is_held[node]) {
            held[node] = self.at(drive.held[node], at);
        }
        let mut right: Vec<f64> = storing.iter().zip(base).map(|(c, t)| c * t).collect();
        for (right, flow) in right.iter_mut().zip(&drive.flows) {
            *right += self.at(*flow, at);
        }
        for film in &drive.films {
            right[film.node] += film.conductance * self.at(film.ambient, at);
        }
        let from_held = conduction.from_held(conductances, &held);
        for node in 0..base.len() {
            right[node] = if is_held[node] { held[node] } else { right[node] + from_held[node] };
        }
        factor.solve(&mut right);
        right
    }

    /// Heat that passes in the part, by the temperatures of its stages.
    fn passed(&self, before: &[f64], stages: &[Vec<f64>]) -> Passed {
        let Self { conduction, conductances, drive, dt, .. } = *self;
        let mut passed =
            Passed { through_films: vec![0.0; drive.films.len()], ..Passed::default() };
        for ((temperature, weight), at) in stages.iter().zip(WEIGHTS[2]).zip(TIMES) {
            let time = weight * dt;
            let mut outflow = conduction.outflow(conductances, temperature);
            for (out, flow) in outflow.iter_mut().zip(&drive.flows) {
                let flow = self.at(*flow, at);
                passed.brought_in += time * flow;
                *out -= flow;
            }
            for (heat, film) in passed.through_films.iter_mut().zip(&drive.films) {
                let excess = temperature[film.node] - self.at(film.ambient, at);
                *heat += time * film.conductance * excess;
                outflow[film.node] += film.conductance * excess;
            }
            for node in (0..before.len()).filter(|&node| conduction.held[node]) {
                passed.through_held -= time * outflow[node];
            }
        }
        for node in (0..before.len()).filter(|&node| conduction.held[node]) {
            passed.through_held -= conduction.capacity[node] * (stages[2][node] - before[node]);
        }
        passed
    }

    /// Value at a fraction of the part of what changes linearly over the step.
    fn at(&self, [first, last]: [f64; 2], at: f64) -> f64 {
        first + (self.from + at * self.part) * (last - first)
    }
}
