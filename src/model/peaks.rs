//! Running maxima of bodies, each with its time and place.
//!
//! They are noted only at communication points: when a step begins, under its first inputs, and when it ends. What does
//! not hold as a step begins is noted as it ends only, and once as the first begins, as it was before inputs acted.
//! Parts of a step that are reported to a host count as steps.

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

    /// Duration of the step that ends [s].
    fn duration(self) -> Option<f64> {
        match self {
            Self::Beginning => None,
            Self::End { duration } => Some(duration),
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
        let all = 0..self.peaks.len();
        let noted = all.map(|number| {
            let noted = self.noted_so_far(state, cache, number, when);
            noted.map_err(|error| (self.peaks[number].0, error))
        });
        let peaks = noted.collect::<Result<Vec<_>, _>>()?;
        let is_kept = |&place: &usize| {
            let (body, unknowns) = (&self.bodies[place], &state.bodies[place]);
            body.keeps_field() && (when.is_end() || body.field_holds_at_beginning(unknowns))
        };
        let kept: Vec<usize> = (0..self.bodies.len()).filter(is_kept).collect();
        for &place in &kept {
            let (unknowns, memo) = (&state.bodies[place], cache.memo(place));
            let observed = self.bodies[place].observe_field(unknowns, memo, when.duration());
            observed.map_err(|error| (place, error))?;
        }
        for place in kept {
            self.bodies[place].note_field(
                &mut state.bodies[place],
                cache.memo(place),
                when.duration(),
            );
        }
        state.peaks = peaks;
        Ok(())
    }

    /// Returns a running maximum updated to the present value; the earlier one where that does not hold yet.
    fn noted_so_far(
        &self,
        state: &State,
        cache: &mut Cache,
        number: usize,
        when: When,
    ) -> Result<Peak, BodyError> {
        let (place, which) = self.peaks[number];
        let known = self.noted_peak(state, (place, which)).copied();
        let holds = when.is_end() || self.bodies[place].holds_at_beginning(which);
        if let Some(known) = known.filter(|_| !holds) {
            return Ok(known);
        }
        let now = match when {
            When::Beginning => self.peak_at_beginning(state, cache, number, known)?,
            When::End { .. } => self.peak_now(state, cache, number)?,
        };
        Ok(known.filter(|known| known.highest.value >= now.highest.value).unwrap_or(now))
    }

    /// Returns a running maximum of a body by its number there, once it is noted.
    pub(super) fn noted_peak<'s>(
        &self,
        state: &'s State,
        peak: (usize, usize),
    ) -> Option<&'s Peak> {
        let number = self.peaks.iter().position(|place| *place == peak)?;
        state.peaks.get(number)
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
        match self.noted_peak(state, (body, which)) {
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

    /// Returns the highest value when a step begins, whose inputs may have jumped.
    fn peak_at_beginning(
        &self,
        state: &State,
        cache: &mut Cache,
        number: usize,
        known: Option<Peak>,
    ) -> Result<Peak, BodyError> {
        let (place, which) = self.peaks[number];
        let own = (&state.bodies[place][..], &state.inputs[..]);
        let so_far = known.map(|known| known.highest);
        let highest =
            self.bodies[place].observe_at_beginning(own, cache.memo(place), which, so_far)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::variables::{Registry, Slot};

    /// A plate of 1 mm at 500 K with further keys and faces.
    fn plate(name: &str, keys: &str, faces: &str) -> String {
        format!(
            "[body.{name}]\nkind = \"solid\"\nshape = {{ box = [2e-3, 2e-3, 1e-3] }}\n\
             initial_temperature = 500.0\nmesh = {{ spacing = 1e-3 }}\n{keys}\n\
             material = {{ model = \"thermoelastic\", density = 2500.0, specific_heat = 750.0, \
             conductivity = 1.0, young = 70e9, poisson = 0.22, expansion = 9e-6 }}\n\
             [body.{name}.faces]\n{faces}\n"
        )
    }

    struct Trial {
        model: Model,
        state: State,
        cache: Cache,
    }

    impl Trial {
        fn of(bodies: &[String]) -> Self {
            let text =
                format!("name = \"Plates\"\nstop_time = 1.0\nstep = 0.1\n{}", bodies.concat());
            let scene = scene::parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
            let model = Model::build(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
            Self { state: model.initial_state(), model, cache: Cache::default() }
        }

        fn step(&mut self, dt: f64) {
            self.model.step(&mut self.state, &mut self.cache, dt).unwrap();
            self.model.check_state(&self.state).unwrap();
        }

        fn get(&mut self, name: &str) -> f64 {
            let registry = Registry::of(self.model.scene());
            let variable = &registry.variables[registry.find(name).unwrap()];
            let Slot::Output(output) = &variable.slot else { panic!("{name} is no output") };
            self.model.output(&self.state, &mut self.cache, output).unwrap()
        }
    }

    const COOLING: &str = "top = { convection = { coefficient = 1e3, ambient = 300.0 } }";
    const HELD: &str = "bottom = { temperature = 300.0, clamped = true }";

    /// A body that cools is hottest at time zero, whatever other maxima wait for.
    #[test]
    fn maxima_are_noted_each_by_itself() {
        let kept = plate("a", "peaks = [\"temperature\"]", COOLING);
        let other = plate("b", "peaks = [\"von_mises\"]", HELD);
        let both = plate("a", "peaks = [\"temperature\", \"von_mises\"]", HELD);
        for bodies in [&[kept, other][..], &[both]] {
            let mut trial = Trial::of(bodies);
            trial.model.note_peaks(&mut trial.state, &mut trial.cache).unwrap();
            trial.model.check_state(&trial.state).unwrap();
            trial.step(1.0);
            assert_eq!(trial.get("a.peak_temperature"), 500.0);
            assert_eq!(trial.get("a.peak_temperature_time"), 0.0);
        }
    }

    /// Before a prescribed temperature acts the body has the stress of its initial temperature.
    #[test]
    fn stress_is_first_noted_as_it_was_before_faces_jumped() {
        let keys = "peaks = [\"von_mises\", \"max_principal\"]\nstress_free_temperature = 600.0";
        let names = ["a.max_von_mises", "a.max_principal"];
        let at_rest = plate("a", keys, "bottom = { clamped = true }");
        let mut trial = Trial::of(&[at_rest]);
        let wanted = names.map(|name| trial.get(name));
        for faces in [HELD, "bottom = { temperature = 600.0, clamped = true }"] {
            let mut trial = Trial::of(&[plate("a", keys, faces)]);
            trial.model.note_peaks(&mut trial.state, &mut trial.cache).unwrap();
            trial.model.check_state(&trial.state).unwrap();
            for (peak, wanted) in trial.state.peaks.iter().zip(wanted) {
                assert!((peak.highest.value / wanted - 1.0).abs() < 1e-9, "{peak:?} {wanted}");
            }
            let first = trial.state.peaks.clone();
            trial.step(1.0);
            for (peak, first) in trial.state.peaks.iter().zip(first) {
                assert!(peak.highest.value >= first.highest.value);
            }
        }
        let mut forged = trial.state.clone();
        trial.model.note_peaks(&mut forged, &mut trial.cache).unwrap();
        forged.peaks[1].highest.value = f64::MIN;
        assert!(trial.model.check_state(&forged).is_err());
    }

    /// Nothing is hotter than the body was when a face is cooled at once.
    #[test]
    fn cooled_faces_note_no_temperature_above_that_before() {
        let kept = plate("a", "peaks = [\"temperature\"]", HELD);
        let mut trial = Trial::of(std::slice::from_ref(&kept));
        assert!(trial.get("a.max_temperature") > 510.0, "nodes make up for the heat of the face");
        trial.step(1.0);
        assert_eq!(trial.get("a.peak_temperature"), 500.0);
        let mut trial = Trial::of(&[kept]);
        trial.state.inputs[0] = 500.0;
        trial.step(0.02);
        trial.state.inputs[0] = 300.0;
        trial.step(1.0);
        assert!((trial.get("a.peak_temperature") - 500.0).abs() < 1e-9);
    }

    /// A face that is heated at once is the hottest place, also while another one is cooled.
    #[test]
    fn heated_faces_are_noted_when_a_step_begins() {
        let faces = format!("{HELD}\ntop = {{ temperature = 510.0 }}");
        let mut trial = Trial::of(&[plate("a", "peaks = [\"temperature\"]", &faces)]);
        trial.step(1.0);
        assert!((trial.get("a.peak_temperature") - 510.0).abs() < 1e-9);
        assert_eq!(
            ["time", "z"].map(|key| trial.get(&format!("a.peak_temperature_{key}"))),
            [0.0; 2]
        );
    }
}
