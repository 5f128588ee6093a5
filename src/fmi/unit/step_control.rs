//! Control of a step: to its end, or only as far as its host and the limits allow.
//!
//! FMI 3.0 lets a unit return early, and report its progress and events to the host. A unit does so between parts of a
//! step; each part equals a step of its length.

use crate::model::{Cache, Model, ModelError, State};
use crate::runtime::allowance::{Allowance, EARLY_UPDATES, Halt, Interrupt};

/// Reports to the host a time within a step [s], and whether the step may end early; returns the time at which the host
/// wants it to end.
pub type Ask = Box<dyn Fn(f64, bool) -> Option<f64>>;

/// Settings of the host for a step.
#[derive(Default)]
pub struct StepControl {
    pub may_end_early: bool,
    /// True if the host handles events in Event Mode.
    pub reports_events: bool,
    pub ask: Option<Ask>,
}

/// Smallest fraction of a step that is tried after a longer one was too long.
const LEAST: f64 = 1e-12;
/// Number of halvings of a part of a step that search it for the time of an event.
const HALVINGS: u32 = 4;

/// A part of a step, between two times [s].
#[derive(Clone, Copy)]
struct Part<'a> {
    from: f64,
    to: f64,
    /// End of the whole step, at which inputs are reached that bodies follow evenly.
    until: f64,
    /// True if the step begins with it.
    is_first: bool,
    allowance: &'a Allowance,
}

impl StepControl {
    /// Advances a state from `point` by `step` [s]. Its time afterwards is the sum of both, or an earlier one if the
    /// step ended early. After an error it is unchanged. Returns true if an event lies in the step, at whose end it is
    /// if the step may end early.
    pub fn advance(
        &self,
        (model, cache): (&Model, &mut Cache),
        state: &mut State,
        (point, step): (f64, f64),
        interrupt: &Interrupt,
    ) -> Result<bool, ModelError> {
        let mut allowance = Allowance::of_step(interrupt);
        let mut length = step;
        loop {
            let times = (point, length, point + step);
            let advanced = self.go((model, &mut *cache), state, times, &allowance);
            let error = match advanced {
                Ok(is_at_event) => return Ok(is_at_event),
                Err(error) => error,
            };
            let part = error.halt().and_then(|halt| halt.part_within(EARLY_UPDATES));
            // Repeated shortening finds a length that fits, as the work is not always proportional to it.
            let shorter = part.map(|part| length * part.clamp(LEAST, 0.5));
            match shorter.filter(|&shorter| self.may_end(state) && point + shorter > point) {
                Some(shorter) => length = shorter,
                None => return Err(error),
            }
            allowance = Allowance::of_updates(interrupt, EARLY_UPDATES);
        }
    }

    /// Returns true if a step from a state may end early. It may not if inputs follow derivatives, as in a state saved
    /// under FMI 2.0, because these apply to a single step.
    fn may_end(&self, state: &State) -> bool {
        self.may_end_early && state.derivatives.is_empty()
    }

    /// Advances towards the end of a step at `until` [s], in parts if the host follows its progress.
    fn go(
        &self,
        (model, cache): (&Model, &mut Cache),
        state: &mut State,
        (point, step, until): (f64, f64, f64),
        allowance: &Allowance,
    ) -> Result<bool, ModelError> {
        let Some(ask) = self.ask.as_ref().filter(|_| model.parts(step) > 1.0) else {
            let part = Part { from: point, to: point + step, until, is_first: true, allowance };
            return self.go_on((model, cache), state, (part, step));
        };
        model.foresee(state, step, allowance)?;
        let (before, may_end) = (state.clone(), self.may_end(state));
        let (mut now, mut end, mut has_event) = (point, point + step, false);
        let mut parts = model.parts(end - now);
        while now < end {
            let next = if parts > 1.0 { now + (end - now) / parts } else { end };
            // Guards against a step lost in rounding.
            let next = if next > now { next } else { end };
            let part = Part { from: now, to: next, until, is_first: now == point, allowance };
            match self.go_on((model, &mut *cache), state, (part, next - now)) {
                Ok(is_at_event) => has_event |= is_at_event,
                Err(error) if now > point && may_end && is_too_long(&error) => break,
                Err(error) => {
                    *state = before;
                    // The cache follows from the state that the parts reached.
                    cache.clear();
                    return Err(error);
                }
            }
            now = state.time;
            if has_event && may_end {
                break;
            }
            if now < end
                && let Some(wanted) = ask(now, may_end).filter(|_| may_end)
            {
                // An invalid or past time means now.
                end = if wanted > now { end.min(wanted) } else { now };
            }
            // One part less at least, so that their number is bounded.
            parts = model.parts(end - now).min(parts - 1.0);
        }
        Ok(has_event)
    }

    /// Advances through a part of a step of a length [s], or to an event in it if the step may end early. Returns true
    /// if there is one. After an error the state is unchanged.
    fn go_on(
        &self,
        (model, cache): (&Model, &mut Cache),
        state: &mut State,
        (part, length): (Part, f64),
    ) -> Result<bool, ModelError> {
        let start = (self.reports_events && model.has_events()).then(|| state.clone());
        part.advance((model, &mut *cache), state, length)?;
        let Some(start) = start.filter(|start| model.event_between(start, state)) else {
            return Ok(false);
        };
        if self.may_end(&start) {
            let searched = part.search((model, &mut *cache), start.clone(), state);
            cache.clear();
            if let Err(error) = searched {
                *state = start;
                return Err(error);
            }
        }
        Ok(true)
    }
}

impl Part<'_> {
    /// Advances a state by a length [s] to the end of the part.
    fn advance(
        &self,
        (model, cache): (&Model, &mut Cache),
        state: &mut State,
        length: f64,
    ) -> Result<(), ModelError> {
        let ahead = if self.to < self.until { self.until - self.from } else { length };
        match self.is_first {
            true => model.step_within(self.allowance, state, cache, (length, ahead))?,
            false => model.step_on(self.allowance, state, cache, (length, ahead))?,
        }
        state.set_time(self.to);
        Ok(())
    }

    /// Halves the time in which an event lies, and sets the state to that at the end of its last part, reached in the
    /// parts of the search. An event that does not come again in these keeps the state of the longer part.
    fn search(
        self,
        (model, cache): (&Model, &mut Cache),
        start: State,
        state: &mut State,
    ) -> Result<(), ModelError> {
        let (mut rest, mut before, mut is_in_parts) = (self, start, true);
        for _ in 0..HALVINGS {
            let half = Part { to: 0.5 * (rest.from + rest.to), ..rest };
            let Some(trial) = half.tried((model, &mut *cache), &before)? else { return Ok(()) };
            if model.event_between(&before, &trial) {
                (rest, *state, is_in_parts) = (half, trial, true);
            } else {
                rest = Part { from: half.to, is_first: false, ..rest };
                (before, is_in_parts) = (trial, false);
            }
        }
        if !is_in_parts
            && let Some(last) = rest.tried((model, cache), &before)?
            && model.event_between(&before, &last)
        {
            *state = last;
        }
        Ok(())
    }

    /// Returns the state at the end of the part from a state at its beginning; `None` if that takes too long.
    fn tried(
        &self,
        (model, cache): (&Model, &mut Cache),
        before: &State,
    ) -> Result<Option<State>, ModelError> {
        let mut trial = before.clone();
        cache.clear();
        match self.advance((model, cache), &mut trial, self.to - self.from) {
            Err(error) if is_too_long(&error) => Ok(None),
            advanced => advanced.map(|()| Some(trial)),
        }
    }
}

fn is_too_long(error: &ModelError) -> bool {
    matches!(error.halt(), Some(Halt::TooLong { .. } | Halt::UsedUp { .. }))
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;

    use super::*;
    use crate::scene;
    use crate::variables::{Registry, Slot};

    /// A drop in flight.
    const DROP: &str = r#"
name = "Drop"
stop_time = 1e-3
step = 1e-4
[body.drop]
kind = "droplet"
diameter = 6e-5
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
"#;

    /// A body that is moved by a face in implicit steps, and one that flies in explicit ones.
    const MOVED: &str = r#"
name = "Moved"
stop_time = 1e-2
step = 1e-3
[body.pad]
kind = "solid"
strain = "finite"
inertia = true
motion = "implicit"
dimension = 2
shape = { box = [8e-3, 4e-3, 8e-3] }
symmetry = "none"
material = { model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e6, poisson = 0.3 }
initial_temperature = 293.15
mesh = { spacing = 4e-3 }
faces.bottom = { displacement = [0.0, 0.0, 0.0] }
[body.block]
kind = "solid"
strain = "finite"
inertia = true
dimension = 2
shape = { box = [1e-3, 1e-3, 1e-3] }
symmetry = "none"
material = { model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e6, poisson = 0.3 }
initial_temperature = 293.15
mesh = { spacing = 1e-3 }
start = { height = 1.0 }
"#;

    /// A strip of links that is pulled apart in equilibrium.
    const LINKS: &str = r#"
name = "Links"
stop_time = 1.0
step = 0.1
[body.strip]
kind = "lattice"
length = 0.1
depth = 0.05
thickness = 0.05
spacing = 1e-2
support = "ends"
material = { density = 2300.0, young = 30e9, poisson = 0.2, softening = { model = "openings", strength = 4.5e6, openings = [9.05e-6, 2e-5], share = 0.13 } }
"#;

    /// A model that is stepped as a unit does it.
    struct Stepped {
        model: Model,
        registry: Registry,
        state: State,
        cache: Cache,
    }

    impl Stepped {
        fn new(text: &str) -> Self {
            let scene = scene::parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
            let model = Model::build(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
            let (registry, state) = (Registry::of(&scene), model.initial_state());
            Self { model, registry, state, cache: Cache::default() }
        }

        fn slot(&self, name: &str) -> Slot {
            let mut all = self.registry.variables.iter();
            all.find(|variable| variable.name == name).unwrap().slot.clone()
        }

        fn set(&mut self, name: &str, value: f64) {
            let Slot::Input(index) = self.slot(name) else { panic!("{name} is no input") };
            self.state.inputs[index] = value;
        }

        fn get(&mut self, name: &str) -> f64 {
            let Slot::Output(output) = self.slot(name) else { panic!("{name} is no output") };
            self.model.output(&self.state, &mut self.cache, &output).unwrap()
        }

        /// Advances to a time [s]; returns true if there is an event.
        fn advance(&mut self, control: &StepControl, to: f64) -> bool {
            let (times, interrupt) =
                ((self.state.time, to - self.state.time), Interrupt::default());
            let run = (&self.model, &mut self.cache);
            control.advance(run, &mut self.state, times, &interrupt).unwrap()
        }
    }

    /// A control that notes the times at which it asks its host.
    fn asking(times: &Rc<RefCell<Vec<f64>>>) -> StepControl {
        let times = Rc::clone(times);
        let ask: Ask = Box::new(move |time, _| {
            times.borrow_mut().push(time);
            None
        });
        StepControl { ask: Some(ask), ..StepControl::default() }
    }

    #[test]
    fn parts_of_a_step_move_faces_and_average_forces_as_the_whole() {
        let (duration, way) = (0.04, 1e-3);
        let times = Rc::default();
        let mut cut = Stepped::new(MOVED);
        let parts = cut.model.parts(duration);
        cut.set("pad.bottom.displacement_z", way);
        cut.advance(&asking(&times), duration);
        let mut ends = times.take();
        assert_eq!(ends.len() as f64, parts - 1.0);
        assert!(ends.len() > 1);
        ends.push(duration);
        // A host that takes these parts itself and moves the face evenly.
        let mut ramped = Stepped::new(MOVED);
        let (mut impulse, mut time) = (0.0, 0.0);
        for end in ends {
            ramped.set("pad.bottom.displacement_z", way * end / duration);
            ramped.advance(&StepControl::default(), end);
            impulse += (end - time) * ramped.get("pad.bottom.force_z");
            time = end;
        }
        for name in ["pad.momentum_z", "pad.kinetic", "pad.stored", "pad.height"] {
            let [found, wanted] = [&mut cut, &mut ramped].map(|own| own.get(name));
            assert!((found / wanted - 1.0).abs() < 1e-6, "{name}: {found} {wanted}");
        }
        let found = duration * cut.get("pad.bottom.force_z");
        assert!((found / impulse - 1.0).abs() < 1e-6, "{found} {impulse}");
        let momentum = cut.get("pad.momentum_z");
        assert!((found / momentum - 1.0).abs() < 1e-6, "{found} {momentum}");
    }

    #[test]
    fn load_of_a_lattice_at_rest_is_on_its_way_at_an_event() {
        let (duration, way) = (1.0, 5e-5);
        let control = StepControl { may_end_early: true, reports_events: true, ask: None };
        let mut strip = Stepped::new(LINKS);
        strip.set("strip.displacement", way);
        assert!(strip.advance(&control, duration));
        let reached = strip.get("strip.mechanical_work");
        let sixteenths = (16.0 * strip.state.time / duration).round() as u32;
        assert!(sixteenths > 1 && sixteenths < 16, "{sixteenths}");
        // A host that takes the same parts, and moves the load by their shares, finds the strip apart at last.
        let whole = StepControl { reports_events: true, ..StepControl::default() };
        let mut ramped = Stepped::new(LINKS);
        let mut done = 0;
        let before_last = [8, 4, 2, 1].into_iter().filter(|part| (sixteenths - 1) & part != 0);
        for part in before_last.chain([1]) {
            done += part;
            let share = f64::from(done) / 16.0;
            ramped.set("strip.displacement", way * share);
            assert_eq!(ramped.advance(&whole, duration * share), done == sixteenths, "{share}");
        }
        let wanted = ramped.get("strip.mechanical_work");
        assert!((reached / wanted - 1.0).abs() < 1e-9, "{reached} {wanted}");
    }

    #[test]
    fn errors_in_later_parts_change_nothing() {
        let scene = scene::parse(DROP, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        let model = Model::build(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
        let interrupt = Interrupt::default();
        let asked = interrupt.clone();
        let ask: Ask = Box::new(move |_, _| {
            assert!(asked.interrupt());
            None
        });
        let control = StepControl { may_end_early: true, ask: Some(ask), ..StepControl::default() };
        let mut state = model.initial_state();
        let before = state.clone();
        let under_way = interrupt.begin();
        let advance =
            control.advance((&model, &mut Cache::default()), &mut state, (0.0, 5e-4), &interrupt);
        drop(under_way);
        assert_eq!(advance.unwrap_err().halt(), Some(&Halt::Interrupted));
        assert_eq!(state, before);
    }
}
