//! Stresses of a body at the end of a step, and the history of its points.

use std::ops::Range;

use super::deformable::Sheet;
use super::{Course, Courses, Deformable, Failure, Stresses};
use crate::math::matrix3::{Matrix3, contraction};
use crate::runtime::parallel::Team;

/// Groups whose points one thread computes at a time. Sums depend on it, and not on the number of threads.
const CHUNK: usize = 64;

/// Consecutive points in the hands of one thread.
struct Chunk<'a> {
    groups: Range<usize>,
    history: &'a mut [f64],
    loads: &'a mut [Matrix3],
    across: &'a mut [f64],
    energy: f64,
    swelling: f64,
    stiffening: f64,
    least: (f64, usize),
}

impl Deformable {
    /// Advances the history to displacements u at the end of a step, by the course of each group; returns the stresses
    /// there.
    pub fn respond(
        &self,
        u: &[[f64; 3]],
        over: &Courses,
        history: &mut [f64],
        team: &Team,
    ) -> Result<Stresses, Failure> {
        let count = self.space.volume.len();
        let mut stresses = Stresses {
            loads: vec![[[0.0; 3]; 3]; count],
            across: if self.is_sheet { vec![1.0; count] } else { Vec::new() },
            least: f64::INFINITY,
            ..Stresses::default()
        };
        let mut chunks = self.chunks(history, &mut stresses);
        team.for_each(&mut chunks, |_, chunk| self.respond_in(chunk, u, over));
        let (mut energy, mut swelling) = (0.0, 0.0);
        let (mut stiffening, mut least) = (0.0_f64, (f64::INFINITY, 0));
        for chunk in &chunks {
            energy += chunk.energy;
            swelling += chunk.swelling;
            stiffening = stiffening.max(chunk.stiffening);
            // A dilatation that is not a number is below all others.
            if chunk.least.0.is_nan() || chunk.least.0 < least.0 {
                least = chunk.least;
            }
        }
        drop(chunks);
        if least.0.is_nan() || least.0 <= 0.0 {
            let at = self.space.volume.at[least.1];
            return Err(match least.0.is_finite() {
                true => Failure::Inverted { at, dilatation: least.0 },
                false => Failure::NotFinite,
            });
        }
        if !energy.is_finite() {
            return Err(Failure::NotFinite);
        }
        Ok(Stresses { energy, swelling, stiffening, least: least.0, ..stresses })
    }

    /// Cuts history and results into chunks.
    fn chunks<'a>(&self, history: &'a mut [f64], stresses: &'a mut Stresses) -> Vec<Chunk<'a>> {
        let groups = &self.space.groups;
        let mut rest = (history, &mut stresses.loads[..], &mut stresses.across[..]);
        let mut chunks = Vec::new();
        for first in (0..groups.len()).step_by(CHUNK) {
            let last = (first + CHUNK).min(groups.len());
            let points = groups[last - 1].end - groups[first].start;
            let own = self.history_of(last - 1).end - self.history_of(first).start;
            let (history, after) = rest.0.split_at_mut(own);
            let (loads, later) = rest.1.split_at_mut(points);
            let sheets = if self.is_sheet { points } else { 0 };
            let (across, others) = rest.2.split_at_mut(sheets);
            rest = (after, later, others);
            chunks.push(Chunk {
                groups: first..last,
                history,
                loads,
                across,
                energy: 0.0,
                swelling: 0.0,
                stiffening: 0.0,
                least: (f64::INFINITY, 0),
            });
        }
        chunks
    }

    fn respond_in(&self, chunk: &mut Chunk, u: &[[f64; 3]], over: &Courses) {
        let (mut place, mut history) = (0, &mut chunk.history[..]);
        for number in chunk.groups.clone() {
            let course = over.at(self, number);
            let Course { time, stretch, growth } = course;
            let (area, volume) = (stretch * stretch, stretch * stretch * stretch);
            let (group, law) = (&self.space.groups[number], self.law_of(number));
            let (length, modulus) = (law.history(), law.wave_modulus());
            let own = if self.is_sheet { &history[..length] } else { &[] };
            let (deformed, shared) = self.group(number, u, course, Sheet::From(own));
            let pressure = self.pressure(number, law, &shared);
            for (in_group, (point, at)) in group.clone().zip(&deformed).enumerate() {
                let weight = self.space.volume.weights[point];
                let (own, rest) = history.split_at_mut(length);
                history = rest;
                let response = law.respond(at, time, own);
                let jp = pressure.at(in_group) * at.dilatation;
                let load = &mut chunk.loads[place];
                for n in 0..9 {
                    let (a, b) = (n / 3, n % 3);
                    load[a][b] =
                        area * weight * (response.stress[a][b] + jp * at.inverse_transposed[a][b]);
                }
                chunk.energy += volume * weight * response.energy;
                if growth != 0.0 {
                    // ∂W/∂ϑ = (3 W − P : F)/ϑ.
                    let stored = 3.0 * area * weight * response.energy;
                    chunk.swelling += growth * (stored - contraction(load, &at.gradient));
                }
                if let Some(across) = chunk.across.get_mut(place) {
                    *across = stretch * at.gradient[1][1];
                }
                let dilatation = volume * at.dilatation;
                if dilatation.is_nan() || dilatation < chunk.least.0 {
                    chunk.least = (dilatation, point);
                }
                let wave = response.wave + law.wave_of_dilatation(at, shared.at(in_group));
                chunk.stiffening = chunk.stiffening.max(stretch * wave / modulus);
                place += 1;
            }
            chunk.energy += self.energy_of_dilatation(number, law, (volume, &shared));
            if growth != 0.0 {
                let scale = growth * 3.0 * area;
                chunk.swelling += self.energy_of_dilatation(number, law, (scale, &shared));
            }
        }
    }
}
