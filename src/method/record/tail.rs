//! Heat that a drop transfers after the end of its profile.
//!
//! The splat cools further as a film does whose lower face has a prescribed temperature (see
//! `closed_form::cooling_film`), from the end of the profile on. Two numbers define such a film:
//! its progress and its rate. Both follow from the heat that the profile has transferred at its end
//! and shortly before. The rings share the heat as they did at the end.

use super::profile::{Amounts, Profile};
use crate::closed_form::cooling_film::{fourier_number, given_part};

/// Fraction of a profile, at its end, from which a film's rate follows.
const WINDOW: f64 = 0.125;
/// Fraction of all heat that may remain at the end of a drop; it is spread over the time before.
const LEFT: f64 = 1e-3;
/// Longest tail over the profile itself: fluid that has left the wall, or hardly touches it, ends
/// there.
const LONGEST: f64 = 1e4;

/// A cooling film.
#[derive(Debug, Clone, PartialEq)]
pub struct Tail {
    /// Fraction of all heat, transferred when the tail begins.
    part: f64,
    /// Fourier numbers at the beginning and end of the tail, and δ²/a [s].
    fourier: [f64; 2],
    scale: f64,
    /// Fraction of all heat, transferred when the tail ends.
    reached: f64,
    /// Remaining heat [J/K], and the share of each ring.
    left: f64,
    shares: Vec<f64>,
}

impl Tail {
    /// Tail of a profile; `None` if no heat remains or flows at the profile's end.
    pub fn of(profile: &Profile) -> Option<Self> {
        let capacity = profile.heat_capacity;
        let window = WINDOW * profile.duration;
        let ends = [profile.duration - window, profile.duration].map(|time| profile.at(time));
        let [before, part] = ends.each_ref().map(|rings| sum(rings) / capacity);
        if !(before > 0.0 && part > before && part < 1.0 - LEFT) {
            return None;
        }
        let [early, late] = [before, part].map(fourier_number);
        let scale = window / (late - early);
        let last = fourier_number(1.0 - LEFT).min(late + LONGEST * profile.duration / scale);
        let flux = |(a, b): (&Amounts, &Amounts)| (b.heat - a.heat).max(0.0);
        let fluxes: Vec<f64> = ends[0].iter().zip(&ends[1]).map(flux).collect();
        let all: f64 = fluxes.iter().sum();
        // A drop that leaves the wall, or is insulated from it, keeps its remaining heat.
        let reached = given_part(last);
        let whole = if reached >= 1.0 - 1.5 * LEFT { 1.0 } else { reached };
        Some(Self {
            part,
            fourier: [late, last],
            scale,
            reached,
            left: capacity * (whole - part),
            shares: fluxes.iter().map(|flux| flux / all).collect(),
        })
    }

    /// Duration [s].
    pub fn duration(&self) -> f64 {
        self.scale * (self.fourier[1] - self.fourier[0])
    }

    /// Heat that all rings have received at a time after the beginning [J/K].
    pub fn heat(&self, time: f64) -> f64 {
        let first = self.fourier[0];
        if time >= self.duration() {
            return self.left;
        }
        let fourier = first + time.max(0.0) / self.scale;
        self.left * (given_part(fourier) - self.part) / (self.reached - self.part)
    }

    /// Share of each ring; they sum to 1.
    pub fn shares(&self) -> &[f64] {
        &self.shares
    }
}

fn sum(rings: &[Amounts]) -> f64 {
    rings.iter().map(|amounts| amounts.heat).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A film that cools from the beginning, on two rings.
    fn film(duration: f64) -> Profile {
        let samples = 400;
        let amounts = (1..=samples).flat_map(|n| {
            let heat = 2.0 * given_part(duration * n as f64 / samples as f64);
            [0.75, 0.25].map(|share| Amounts { heat: share * heat, ..Amounts::default() })
        });
        Profile {
            speed: 1.0,
            heat_capacity: 2.0,
            duration,
            rings: 2,
            radius: 1.0,
            amounts: amounts.collect(),
            spread: vec![1.0; samples],
            stray: 0.0,
        }
    }

    /// The tail of a film is the rest of its own law, early and late.
    #[test]
    fn tail_continues_the_law_of_a_film() {
        for duration in [0.01, 0.3, 1.0] {
            let tail = film(duration).tail().unwrap();
            for later in [0.1, 0.5, 1.0] {
                let exact = 2.0 * (given_part(duration + later) - given_part(duration));
                let found = tail.heat(later);
                assert!((found - exact).abs() < 4e-3 * 2.0, "{duration} {later}: {found} {exact}");
            }
            let all = tail.heat(tail.duration()) + 2.0 * given_part(duration);
            assert!((all - 2.0).abs() < 1e-12);
            assert!((tail.shares()[0] - 0.75).abs() < 1e-9);
        }
    }

    #[test]
    fn rebounding_drop_keeps_its_heat() {
        let mut profile = film(0.3);
        let last = profile.amounts.len() - 2;
        let held = [profile.amounts[100], profile.amounts[101]];
        for pair in profile.amounts[100..last + 2].chunks_exact_mut(2) {
            pair.copy_from_slice(&held);
        }
        assert_eq!(profile.tail(), None);
    }
}
