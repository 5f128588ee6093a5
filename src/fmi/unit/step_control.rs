//! Control of a step: to its end, or only as far as its host and the limits allow.
//!
//! FMI 3.0 lets a unit return early, and report its progress to the host. A unit does so between parts of a step; each
//! part equals a step of its length.

use crate::model::{Cache, Model, ModelError, State};
use crate::runtime::allowance::{Allowance, EARLY_UPDATES, Halt, Interrupt};

/// Reports to the host a time within a step [s], and whether the step may end early; returns the time at which the host
/// wants it to end.
pub type Ask = Box<dyn Fn(f64, bool) -> Option<f64>>;

/// Settings of the host for a step.
#[derive(Default)]
pub struct StepControl {
    pub may_end_early: bool,
    pub ask: Option<Ask>,
}

/// Smallest fraction of a step that is tried after a longer one was too long.
const LEAST: f64 = 1e-12;

impl StepControl {
    /// Advances a state from `point` by `step` [s]. Its time afterwards is the sum of both, or an earlier one if the
    /// step ended early. After an error it is unchanged.
    pub fn advance(
        &self,
        (model, cache): (&Model, &mut Cache),
        state: &mut State,
        (point, step): (f64, f64),
        interrupt: &Interrupt,
    ) -> Result<(), ModelError> {
        let mut allowance = Allowance::of_step(interrupt);
        let mut length = step;
        loop {
            let advanced = self.go((model, &mut *cache), state, (point, length), &allowance);
            let Err(error) = advanced else { return Ok(()) };
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

    /// Advances towards the end of a step, in parts if the host follows its progress.
    fn go(
        &self,
        (model, cache): (&Model, &mut Cache),
        state: &mut State,
        (point, step): (f64, f64),
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        let Some(ask) = self.ask.as_ref().filter(|_| model.parts(step) > 1.0) else {
            model.step_within(allowance, state, cache, step)?;
            state.set_time(point + step);
            return Ok(());
        };
        model.foresee(state, step, allowance)?;
        let (before, may_end) = (state.clone(), self.may_end(state));
        let (mut now, mut end) = (point, point + step);
        while now < end {
            let parts = model.parts(end - now);
            let next = if parts > 1.0 { now + (end - now) / parts } else { end };
            // Guards against a step lost in rounding.
            let next = if next > now { next } else { end };
            let stepped = match now == point {
                true => model.step_within(allowance, state, cache, next - now),
                false => model.step_on(allowance, state, cache, next - now),
            };
            if let Err(error) = stepped {
                if now > point && may_end && is_too_long(&error) {
                    break;
                }
                *state = before;
                // The cache follows from the state that the parts reached.
                cache.clear();
                return Err(error);
            }
            now = next;
            state.set_time(now);
            if now < end
                && let Some(wanted) = ask(now, may_end).filter(|_| may_end)
            {
                // An invalid or past time means now.
                end = if wanted > now { end.min(wanted) } else { now };
            }
        }
        Ok(())
    }
}

fn is_too_long(error: &ModelError) -> bool {
    matches!(error.halt(), Some(Halt::TooLong { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

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
        let control = StepControl { may_end_early: true, ask: Some(ask) };
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
