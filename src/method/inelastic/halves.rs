//! Bodies with moduli that relax: steps that are halved until strain between their ends is linear enough.
//!
//! The law is exact for strain and reduced time that are linear over a step (`laws/solid/relaxation`), so held bodies
//! need no shorter ones. Where strain follows from equilibrium, as in creep, a step is compared with its halves: the
//! error of these is a third of the difference, as the method is of second order. As everything is linear but yield,
//! that third is added to the halves, which makes the result of fourth order. Lengths are powers of ½ of the increment,
//! so that the factors of a few lengths serve all steps. Layers that creep in the same body cut each of them further.

use super::problem::{InelasticError, InelasticProblem, Lapse};
use super::substeps::{Increment, between};

/// Shortest step, over the whole.
const LEAST_PART: f64 = 1.0 / (1_u64 << 40) as f64;
/// Largest number of steps and halves in an increment.
const MOST_STEPS: usize = 4_000;
/// Lower bound of the strain to which errors are compared [1].
const LEAST_STRAIN: f64 = 1e-9;
/// Error over the allowed one below which the next step may be twice as long: its error will be eight times as large.
const SMALL: f64 = 0.1;

impl InelasticProblem {
    /// Advances a state over an increment, from the instantaneous response to what changed at its beginning on.
    pub(super) fn advance_by_halves(
        &self,
        state: &mut [f64],
        increment: &Increment,
    ) -> Result<(), InelasticError> {
        let mut now = state.to_vec();
        self.advance_part(&mut now, increment, [0.0, 0.0])?;
        let (mut done, mut part, mut most) = (0.0, 1.0, LEAST_STRAIN);
        let mut whole = None;
        for _ in 0..MOST_STEPS {
            let [middle, end] = [done + 0.5 * part, done + part];
            let whole_step = match whole.take() {
                Some(step) => step,
                None => self.stepped(&now, increment, [done, end])?,
            };
            let half = self.stepped(&now, increment, [done, middle])?;
            let mut halves = self.stepped(&half, increment, [middle, end])?;
            let [off, strain] = self.difference(&whole_step, &halves);
            most = most.max(strain);
            let error = off / (3.0 * increment.tolerance * most);
            if error.is_nan() || error > 1.0 {
                if part <= LEAST_PART {
                    break;
                }
                part *= 0.5;
                whole = Some(half);
                continue;
            }
            if !self.yields() && !self.creeps() {
                self.extrapolate(&whole_step, &mut halves);
            }
            (now, done) = (halves, end);
            if done >= 1.0 {
                state.copy_from_slice(&now);
                return Ok(());
            }
            let is_aligned = (done / (2.0 * part)).fract() == 0.0;
            if error < SMALL && is_aligned {
                part *= 2.0;
            }
        }
        Err(InelasticError::TooQuick { steps: MOST_STEPS, done: done * increment.duration })
    }

    fn stepped(
        &self,
        from: &[f64],
        increment: &Increment,
        ends: [f64; 2],
    ) -> Result<Vec<f64>, InelasticError> {
        let mut state = from.to_vec();
        self.advance_part(&mut state, increment, ends)?;
        Ok(state)
    }

    /// Advances between two parts of an increment: in one step, or in as many steps as creeping layers require.
    fn advance_part(
        &self,
        state: &mut [f64],
        increment: &Increment,
        [start, end]: [f64; 2],
    ) -> Result<(), InelasticError> {
        let duration = (end - start) * increment.duration;
        if !self.creeps() || duration == 0.0 {
            return self.advance_stage(state, increment, [start, end], Lapse::of(duration));
        }
        let ends = |lists: [&[f64]; 2]| [start, end].map(|part| between(lists, part));
        let (temperatures, forces) = (ends(increment.temperatures), ends(increment.forces));
        let part = Increment {
            temperatures: temperatures.each_ref().map(Vec::as_slice),
            forces: forces.each_ref().map(Vec::as_slice),
            duration,
            ..*increment
        };
        self.advance_creep(state, &part)
    }

    /// Largest difference of the strains of relaxing points between two states, and the largest of these.
    fn difference(&self, one: &[f64], other: &[f64]) -> [f64; 2] {
        let layout = self.layout();
        let of_layer = self.grid.per_layer() * layout.points * layout.of_point;
        let [one, other] = [one, other].map(|state| &state[layout.history.clone()]);
        let layers = one.chunks_exact(of_layer).zip(other.chunks_exact(of_layer));
        let relaxing = self.relaxation().into_iter().zip(layers);
        let relaxing = relaxing.filter_map(|(own, layer)| Some((own?, layer)));
        let of_points = relaxing.flat_map(|(own, (one, other))| {
            let points = one.chunks_exact(layout.of_point).zip(other.chunks_exact(layout.of_point));
            points.map(move |(one, other)| own.difference(one, other))
        });
        of_points.fold([0.0, 0.0], |[off, most], [a, b]| {
            // A NaN has to remain.
            [if a.is_nan() { a } else { off.max(a) }, most.max(b)]
        })
    }

    /// Adds to a state after two halves a third of its difference from the state after one step.
    fn extrapolate(&self, whole: &[f64], halves: &mut [f64]) {
        for (value, whole) in halves.iter_mut().zip(whole) {
            *value += (*value - whole) / 3.0;
        }
    }
}
