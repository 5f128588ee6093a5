//! Flaws that grow slowly: their depth follows from the stress along their line, step by step.
//!
//! Superposition holds for the whole growth: K of any depth follows from the stress of the body without the flaw. That
//! stress changes linearly from one communication point to the next, so that K of a given depth does, too. The depth
//! follows `da/dt = v₀ (K(a, t)/K_Ic)^n` by steps of the third order with an estimate of the second (P. Bogacki & L. F.
//! Shampine 1989, doi 10.1016/0893-9659(89)90079-7). Where K reaches the toughness the flaw runs at once to the depth
//! at which K is below it again, or to the end of its line.

use super::SolidBody;
use super::crack::{Growing, Line, dot};
use super::memo::SolidMemo;
use super::reader::SolidReader;
use crate::body::BodyError;
use crate::laws::fracture::CrackGrowth;
use crate::limits::LARGEST;
use crate::state::{Field, Layout, Per};

/// Stress before anything is noted [Pa].
const NOTHING: f64 = f64::MIN;
/// Error of the depth in a step, relative to it.
const TOLERANCE: f64 = 1e-7;
/// Shortest steps, relative to all the time and to what has passed of it.
const SHORTEST: f64 = 1e-12;
const SHORTEST_OF_PAST: f64 = 1e-5;
/// Steps after which a flaw that stops and runs again and again follows K = K_Ic, in this many equal parts of the rest.
const MOST_STEPS: usize = 20_000;
const PARTS: usize = 1000;
/// Relative accuracy of the depth at which a flaw that runs stops.
const ACCURACY: f64 = 1e-9;

/// Growth of a flaw over a time in which the stress along its line changes linearly.
struct Growth<'a> {
    line: &'a Line,
    /// Depths that are tried for the end of a run, ascending, with the weights of the stresses in K.
    trials: &'a [(f64, Vec<f64>)],
    law: CrackGrowth,
    /// [Pa √m]
    toughness: f64,
    /// Stress along the line at the beginning and at the end [Pa].
    stress: [&'a [f64]; 2],
    /// [s]
    duration: f64,
}

impl Growth<'_> {
    /// Stress intensity over the toughness, by the weights of the stresses; `part` of the time has passed.
    fn ratio_of(&self, weights: &[f64], part: f64) -> f64 {
        let [first, last] = self.stress.map(|stress| dot(weights, stress));
        (first + part * (last - first)) / self.toughness
    }

    fn ratio(&self, depth: f64, part: f64) -> f64 {
        self.ratio_of(&self.line.weights(depth), part)
    }

    /// Rate of the depth over the part of the time that has passed [m].
    fn rate(&self, depth: f64, part: f64) -> f64 {
        match depth < self.line.end() {
            true => self.duration * self.law.rate(self.ratio(depth, part)),
            false => 0.0,
        }
    }

    /// Depth to which a flaw runs at once: the next at which K is below the toughness.
    fn run(&self, depth: f64, part: f64) -> f64 {
        if depth >= self.line.end() || self.ratio(depth, part) < 1.0 {
            return depth;
        }
        let mut low = depth;
        for (trial, weights) in self.trials.iter().filter(|(trial, _)| *trial > depth) {
            if self.ratio_of(weights, part) < 1.0 {
                return self.stop([low, *trial], part);
            }
            low = *trial;
        }
        self.line.end()
    }

    /// Depth between two at which K falls below the toughness, by halving.
    fn stop(&self, [mut low, mut high]: [f64; 2], part: f64) -> f64 {
        while high - low > ACCURACY * high {
            let middle = 0.5 * (low + high);
            match self.ratio(middle, part) < 1.0 {
                true => high = middle,
                false => low = middle,
            }
        }
        high
    }

    /// Depth at the end [m].
    fn grown(&self, start: f64) -> f64 {
        let (mut depth, mut past, mut step) = (self.run(start, 0.0), 0.0, 1.0);
        if self.duration == 0.0 {
            return depth;
        }
        let mut rate = self.rate(depth, 0.0);
        let mut steps = 0;
        while past < 1.0 {
            steps += 1;
            if steps > MOST_STEPS {
                let parts = (1..=PARTS).map(|n| past + (1.0 - past) * n as f64 / PARTS as f64);
                return parts.fold(depth, |depth, past| self.run(depth, past));
            }
            let shortest = (SHORTEST_OF_PAST * past).max(SHORTEST);
            let length = if past + step >= 1.0 { 1.0 - past } else { step };
            let second = self.rate(depth + 0.5 * length * rate, past + 0.5 * length);
            let third = self.rate(depth + 0.75 * length * second, past + 0.75 * length);
            let change = length * (2.0 * rate + 3.0 * second + 4.0 * third) / 9.0;
            let last = self.rate(depth + change, past + length);
            let error =
                length * (5.0 * rate - 6.0 * second - 8.0 * third + 9.0 * last).abs() / 72.0;
            let allowed = TOLERANCE * depth;
            if error <= allowed || length <= shortest {
                past = if length < step { 1.0 } else { past + length };
                let reached = (depth + change).min(self.line.end());
                depth = self.run(reached, past);
                rate = if depth == reached { last } else { self.rate(depth, past) };
            }
            // The error of a step is of the third order.
            let factor = 0.9 * (allowed / error.max(f64::MIN_POSITIVE)).cbrt();
            step = (length * factor.clamp(0.2, 5.0)).max(shortest);
        }
        depth
    }
}

impl SolidBody {
    /// The flaws that grow, each with its place among the scene's.
    fn growing(&self) -> impl Iterator<Item = (usize, Growing<'_>)> {
        self.cracks.iter().filter_map(|(place, crack)| Some((*place, crack.growing()?)))
    }

    /// Returns true if a flaw grows.
    pub(super) fn has_growing_flaws(&self) -> bool {
        self.growing().next().is_some()
    }

    /// Fields of the flaws that grow.
    pub(super) fn layout_of_growth(&self) -> Layout {
        let (count, points) = self
            .growing()
            .fold((0, 0), |(count, points), (_, own)| (count + 1, points + own.line.count()));
        if count == 0 {
            return Layout::default();
        }
        let field = |name, words| Field { name, words, per: Per::Body, width: 1 };
        let depth = field("flaw_depth", "depth of flaws that grow [m]");
        let stress = field("flaw_stress", "stress along them when last noted [Pa]");
        Layout::default().with(depth, count).with(stress, points)
    }

    /// Depths of the scene, before anything is noted.
    pub(super) fn start_of_growth(&self) -> Vec<f64> {
        let points: usize = self.growing().map(|(_, own)| own.line.count()).sum();
        let depths = self.growing().map(|(_, own)| own.start);
        depths.chain(std::iter::repeat_n(NOTHING, points)).collect()
    }

    /// Depths and stresses of a state.
    fn growth_of<'s>(&self, state: &'s [f64]) -> [&'s [f64]; 2] {
        let place = self.place_of_growth(state);
        let own = &state[place..][..self.layout_of_growth().len()];
        let (depths, stress) = own.split_at(self.growing().count());
        [depths, stress]
    }

    fn place_of_growth(&self, state: &[f64]) -> usize {
        self.place_of_noted(state) - self.layout_of_growth().len()
    }

    /// Present depth of a flaw that grows, by its place among the scene's [m].
    pub(super) fn grown_depth(&self, state: &[f64], flaw: usize) -> Option<f64> {
        // Thousands of flaws of fixed depth are read without a search.
        self.crack(flaw).ok()?.growing()?;
        let number = self.growing().position(|(place, _)| place == flaw)?;
        let [depths, _] = self.growth_of(state);
        Some(depths[number])
    }

    /// Flaws that have grown, by name, with the part of their line that they cover.
    pub(super) fn grown_parts<'b>(
        &'b self,
        state: &'b [f64],
    ) -> impl Iterator<Item = (&'b str, f64)> {
        let [depths, _] = self.growth_of(state);
        let all = self.growing().zip(depths).filter(|((_, own), depth)| **depth > own.start);
        all.map(|((_, own), depth)| (own.name, depth / own.line.end()))
    }

    /// Computes the present stress along the flaws that grow, which [`Self::note_growth_of_flaws`] needs.
    pub(super) fn observe_growth(
        &self,
        state: &[f64],
        memo: &mut SolidMemo,
    ) -> Result<(), BodyError> {
        let mut found = Vec::new();
        let mut reader = SolidReader { body: self, state, memo };
        for (_, crack) in self.cracks.iter().filter(|(_, crack)| crack.growing().is_some()) {
            found.extend(crack.stresses(&mut reader)?);
        }
        let wrong = found.iter().copied().find(|value| !value.is_finite());
        wrong.map_or(Ok(0.0), BodyError::unless_finite)?;
        memo.keep_along_flaws(found);
        Ok(())
    }

    /// Returns true if the stress along flaws of a state is noted.
    pub(super) fn has_noted_growth(&self, state: &[f64]) -> bool {
        let [_, noted] = self.growth_of(state);
        noted.first().is_some_and(|own| *own != NOTHING)
    }

    /// Lets flaws grow up to the observed stress, a duration [s] after the last time. Without one they run at once
    /// where they do, and the stress is not noted. Before the first note the stress counts as if it had been there from
    /// the start.
    pub(super) fn note_growth_of_flaws(
        &self,
        state: &mut [f64],
        memo: &SolidMemo,
        duration: Option<f64>,
    ) {
        let place = self.place_of_growth(state);
        let length = self.layout_of_growth().len();
        let (depths, noted) = state[place..][..length].split_at_mut(self.growing().count());
        let observed = memo.along_flaws();
        let is_first = noted.first() == Some(&NOTHING);
        let noted_before = if is_first { observed } else { &*noted };
        let mut first = 0;
        for ((_, own), depth) in self.growing().zip(depths) {
            let along = first..first + own.line.count();
            first = along.end;
            let stress = [&noted_before[along.clone()], &observed[along]];
            let Growing { line, trials, law, toughness, .. } = own;
            let duration = duration.unwrap_or(0.0);
            *depth = Growth { line, trials, law, toughness, stress, duration }.grown(*depth);
        }
        if duration.is_some() {
            noted.copy_from_slice(observed);
        }
    }

    /// Refuses depths and stresses that no run produces.
    pub(super) fn check_growth(&self, state: &[f64]) -> Result<(), String> {
        let [depths, noted] = self.growth_of(state);
        let is_possible = |((_, own), depth): ((usize, Growing), &f64)| {
            (own.start..=own.line.end()).contains(depth)
        };
        let is_known = noted.iter().all(|own| own.abs() <= LARGEST);
        let is_start = noted.iter().all(|own| *own == NOTHING);
        match (is_start || is_known) && self.growing().zip(depths).all(is_possible) {
            true => Ok(()),
            false => Err(format!("flaws of {} that no run leads to", self.name)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: CrackGrowth = CrackGrowth { exponent: 16.0, speed: 6e-3 };
    const TOUGHNESS: f64 = 0.75e6;
    const DEPTH: f64 = 2e-5;

    /// A line of a millimetre, and the trials along it.
    fn line() -> (Line, Vec<(f64, Vec<f64>)>) {
        let line = Line::new((0..=20).map(|i| f64::from(i) * 5e-5).collect(), 1);
        let trials = line.trials().into_iter().map(|depth| (depth, line.weights(depth)));
        let trials = trials.collect();
        (line, trials)
    }

    /// Depth after the growth of DEPTH under stresses that are linear along the line, at the beginning and at the end.
    fn grown(law: CrackGrowth, stress: [&dyn Fn(f64) -> f64; 2], duration: f64) -> f64 {
        let (line, trials) = line();
        let [first, last] =
            stress.map(|of| line.distances().into_iter().map(of).collect::<Vec<_>>());
        let stress = [&first[..], &last[..]];
        let growth =
            Growth { line: &line, trials: &trials, law, toughness: TOUGHNESS, stress, duration };
        growth.grown(DEPTH)
    }

    /// Time in which a flaw grows to a depth, `a^(1 − n/2)` falls by `(n/2 − 1) v₀ t ⟨(Yσ/K_Ic)^n⟩` in uniform stress,
    /// where `K = Yσ√a` (A. G. Evans & S. M. Wiederhorn 1974, doi 10.1007/BF00035405): stress is linear in time between
    /// two values [Pa].
    fn time_to(depth: f64, law: CrackGrowth, [first, last]: [f64; 2]) -> f64 {
        let shape = closed_form::edge_crack::edge(1.0, |_| 1.0);
        // Powers of K/K_Ic at the start: stresses overflow.
        let ratio = |stress: f64| shape * stress.max(0.0) * DEPTH.sqrt() / TOUGHNESS;
        let [from, to] = [first, last].map(ratio);
        let power = |ratio: f64| ratio.powf(law.exponent + 1.0);
        let mean = match first == last {
            true => from.powf(law.exponent),
            // Where the stress turns to pressure the flaw rests.
            false => {
                let slope = (last - first) / first.max(last) * from.max(to);
                (power(to) - power(from)) / ((law.exponent + 1.0) * slope)
            }
        };
        let half = 0.5 * law.exponent - 1.0;
        (1.0 - (depth / DEPTH).powf(-half)) * DEPTH / (half * law.speed * mean)
    }

    #[test]
    fn steady_and_changing_uniform_stress_have_the_closed_form() {
        for exponent in [3.0, 16.0, 50.0] {
            let law = CrackGrowth { exponent, ..GLASS };
            for stress in [[40e6, 40e6], [0.0, 60e6], [55e6, -20e6]] {
                // Growth by a tenth, and by half.
                for wanted in [1.1 * DEPTH, 1.5 * DEPTH] {
                    let [first, last] = stress;
                    let duration = time_to(wanted, law, stress);
                    let found = grown(law, [&|_| first, &|_| last], duration);
                    // Near failure the depth follows rounding; the time in which it is reached does not.
                    let (error, bound) = match wanted < 1.2 * DEPTH {
                        true => (found / wanted - 1.0, 1e-5),
                        false => (time_to(found, law, stress) / duration - 1.0, 5e-5),
                    };
                    assert!(error.abs() < bound, "{exponent} {stress:?}: {found} {error}");
                }
            }
        }
    }

    #[test]
    fn unstable_flaw_under_uniform_stress_breaks_through_its_line() {
        assert_eq!(grown(GLASS, [&|_| 60e6, &|_| 60e6], 1e3), 1e-3);
        assert_eq!(grown(GLASS, [&|_| 0.0, &|_| 200e6], 1e-9), 1e-3);
        // Without time the stress of the end is that of the beginning.
        assert_eq!(grown(GLASS, [&|_| 200e6, &|_| 200e6], 0.0), 1e-3);
        assert_eq!(grown(GLASS, [&|_| 20e6, &|_| 20e6], 0.0), DEPTH);
    }

    #[test]
    fn flaw_that_runs_into_pressure_stops_at_its_toughness() {
        // Tension at the mouth, pressure from a tenth of a millimetre on.
        let stress = |z: f64| 200e6 * (1.0 - z / 1e-4);
        let found = grown(GLASS, [&stress, &stress], 0.0);
        let intensity = closed_form::edge_crack::edge(found, stress);
        assert!((intensity / TOUGHNESS - 1.0).abs() < 1e-3, "{found} {intensity}");
        // It goes on slowly from there, less than it did in the first instant.
        let later = grown(GLASS, [&stress, &stress], 1.0);
        assert!(later > found && later < 1.5 * found, "{later}");
        let much_later = grown(GLASS, [&stress, &stress], 1e6);
        assert!(much_later > later && much_later < 2.0 * found, "{much_later}");
    }

    #[test]
    fn closed_flaw_does_not_grow() {
        assert_eq!(grown(GLASS, [&|_| -1e8, &|_| -1e8], 1e9), DEPTH);
    }
}
