//! Running maxima of bodies, each with its time and place.
//!
//! They are noted only at communication points: when a step begins, under its first inputs, and when it ends. Parts of
//! a step that are reported to a host count as steps.

use super::{Cache, Model, ModelError, State};
use crate::body::{BodyError, Extreme, PeakPart};

/// Highest value of a body so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// [s]
    pub time: f64,
    pub highest: Extreme,
}

impl Peak {
    /// Value, time, x, y and z.
    pub fn numbers(&self) -> [f64; 5] {
        let Extreme { value, at: [x, y, z] } = self.highest;
        [value, self.time, x, y, z]
    }

    /// The inverse of [`Self::numbers`].
    pub fn of_numbers([value, time, x, y, z]: [f64; 5]) -> Self {
        Self { time, highest: Extreme { value, at: [x, y, z] } }
    }

    fn part(&self, part: PeakPart) -> f64 {
        match part {
            PeakPart::Value => self.highest.value,
            PeakPart::Time => self.time,
            PeakPart::Along(axis) => self.highest.at[axis],
        }
    }
}

/// End of a step at which maxima are noted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum When {
    Beginning,
    /// After a duration [s].
    End {
        duration: f64,
    },
}

impl When {
    fn is_end(self) -> bool {
        self != Self::Beginning
    }

    /// Time since the last moment at which maxima were noted [s].
    fn duration(self) -> f64 {
        match self {
            Self::Beginning => 0.0,
            Self::End { duration } => duration,
        }
    }
}

impl State {
    /// Sets the time of the state to the caller's value without accumulated rounding. Maxima noted at the end of that
    /// step receive the same time.
    pub fn set_time(&mut self, time: f64) {
        for peak in self.peaks.iter_mut().filter(|peak| peak.time == self.time) {
            peak.time = time;
        }
        self.time = time;
    }
}

impl Model {
    /// Updates the running maxima of a state with its present values; its inputs must be valid. A value equal to the
    /// earlier maximum leaves its time and place. An error changes nothing.
    pub fn note_peaks(&self, state: &mut State, cache: &mut Cache) -> Result<(), ModelError> {
        if self.keeps_maxima() {
            self.expect_room_to_step(state)?;
        }
        let noted = self.with_stack(|| self.note_peaks_here(state, cache, When::Beginning));
        Ok(noted.map_err(|(_, error)| error)?)
    }

    /// Updates the maxima without a check of the remaining stack; errors are returned with the place of the body.
    pub(super) fn note_peaks_here(
        &self,
        state: &mut State,
        cache: &mut Cache,
        when: When,
    ) -> Result<(), (usize, BodyError)> {
        if !self.keeps_maxima() {
            return Ok(());
        }
        cache.update(self, state);
        let holds = |number: usize| {
            let (place, which) = self.peaks[number];
            when.is_end() || self.bodies[place].holds_at_beginning(which)
        };
        // The first maxima are noted together.
        let is_soon = state.peaks.is_empty() && !(0..self.peaks.len()).all(holds);
        let count = if is_soon { 0 } else { self.peaks.len() };
        let peaks = (0..count).map(|number| {
            let known = state.peaks.get(number).copied();
            if let Some(known) = known.filter(|_| !holds(number)) {
                return Ok(known);
            }
            let now = self.peak_now(state, cache, number);
            let now = now.map_err(|error| (self.peaks[number].0, error))?;
            Ok(known.filter(|known| known.highest.value >= now.highest.value).unwrap_or(now))
        });
        let peaks = peaks.collect::<Result<Vec<_>, _>>()?;
        let is_kept = |&place: &usize| {
            let body = &self.bodies[place];
            body.keeps_field() && (when.is_end() || body.field_holds_at_beginning())
        };
        let keep = || (0..self.bodies.len()).filter(is_kept);
        for place in keep() {
            let (unknowns, memo) = (&state.bodies[place], cache.memo(place));
            let observed = self.bodies[place].observe_field(unknowns, memo);
            observed.map_err(|error| (place, error))?;
        }
        for place in keep() {
            self.bodies[place].note_field(
                &mut state.bodies[place],
                cache.memo(place),
                when.duration(),
            );
        }
        state.peaks = peaks;
        Ok(())
    }

    /// Returns true if a body has running maxima, of the whole body or of a field.
    fn keeps_maxima(&self) -> bool {
        !self.peaks.is_empty() || self.bodies.iter().any(|body| body.keeps_field())
    }

    /// Returns a part of a running maximum; before a maximum is noted, of the present value.
    pub(super) fn read_peak(
        &self,
        state: &State,
        cache: &mut Cache,
        (body, which): (usize, usize),
        part: PeakPart,
    ) -> Result<f64, ModelError> {
        let number = self.peaks.iter().position(|place| *place == (body, which));
        let number = number.expect("registered from a body that keeps it");
        match state.peaks.get(number) {
            Some(peak) => Ok(peak.part(part)),
            None => Ok(self.peak_now(state, cache, number)?.part(part)),
        }
    }

    fn peak_now(&self, state: &State, cache: &mut Cache, number: usize) -> Result<Peak, BodyError> {
        let (place, which) = self.peaks[number];
        let (body, unknowns) = (&self.bodies[place], &state.bodies[place]);
        let highest = body.observe(unknowns, cache.memo(place), which)?;
        BodyError::unless_finite(highest.value)?;
        Ok(Peak { time: state.time, highest })
    }

    /// Refuses running maxima that no run ending in the state produces.
    pub(super) fn check_peaks(&self, state: &State) -> Result<(), ModelError> {
        let refuse = |message: String| Err(ModelError::State(message));
        let (found, wanted) = (state.peaks.len(), self.peaks.len());
        if found != 0 && found != wanted {
            return refuse(format!("{found} running maxima; the scene has {wanted}"));
        }
        for (peak, &(place, which)) in state.peaks.iter().zip(&self.peaks) {
            let body = &self.bodies[place];
            if !peak.numbers().iter().all(|number| number.is_finite()) {
                return refuse(format!("a running maximum of {} is not finite", body.name()));
            }
            if peak.time > state.time {
                let (later, name) = (peak.time, body.name());
                return refuse(format!(
                    "a running maximum of {name} at {later} s, after the state's {} s",
                    state.time
                ));
            }
            body.check_peak(which, &peak.highest).or_else(refuse)?;
        }
        Ok(())
    }
}
