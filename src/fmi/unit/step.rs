//! Steps of a unit.

use std::rc::Rc;
use std::sync::Arc;

use super::Unit;
use super::built::explain;
use super::rates::{check_path, keep_within_bounds};
use crate::fmi::gate::answer::{Answer, Refusal, Status};
use crate::fmi::table::Phase;
use crate::model::check_step_length;
use crate::runtime::allowance::Halt;

/// Two times are equal if they differ by less than this fraction of the step …
const STEP_TOLERANCE: f64 = 1e-9;
/// … plus this fraction of the times themselves, which masters sum up with rounding errors.
const TIME_TOLERANCE: f64 = 1e-13;

impl Unit {
    /// Advances from `point` by `step` [s]. The time afterwards is their sum, so that it never drifts from the
    /// master's. Inputs with derivatives follow them and keep their final values.
    ///
    /// A step that fails after a valid start is discarded; so is one cancelled by another thread. A step that may end
    /// early then ends at the time reached.
    pub fn step(&mut self, point: f64, step: f64) -> Answer {
        self.check_step(point, step)?;
        self.is_at_event = false;
        let registry = Arc::clone(&self.registry);
        let has_set = self.has_set_derivatives;
        let told = self.told.take();
        let listens = self.listens_to_answers();
        let (interrupt, control) = (self.interrupt.clone(), Rc::clone(&self.control));
        let (run, state) = self.run()?;
        let past = if has_set { None } else { Some(std::mem::take(&mut state.derivatives)) };
        let on_response = told.and_then(|before| run.model.warning_on_response(state, &before));
        let told = listens.then(|| state.inputs.clone());
        let stepping = interrupt.begin();
        let stepped = check_path(&registry, state, step).and_then(|()| {
            control.advance((&*run.model, &mut run.cache), state, (point, step), &interrupt)
        });
        drop(stepping);
        let is_at_event = match stepped {
            Ok(is_at_event) => is_at_event,
            Err(error) => {
                let is_cancelled = error.halt() == Some(&Halt::Interrupted);
                if let Some(past) = past {
                    state.derivatives = past;
                }
                let refusal = explain(&registry, error);
                if refusal.status == Status::Discard {
                    self.phase = if is_cancelled { Phase::StepCanceled } else { Phase::StepFailed };
                }
                return Err(refusal);
            }
        };
        if !state.derivatives.is_empty() {
            keep_within_bounds(&registry, state);
        }
        run.tangent = None;
        run.checked &= !has_set;
        let warnings = run.model.warnings(state);
        self.told = told;
        self.warn_once(warnings);
        self.warn_of_response(on_response);
        self.warn_of_phases();
        self.warn_of_length(step);
        self.has_set_derivatives = false;
        self.is_at_event = is_at_event;
        Ok(self.write_fields())
    }

    fn check_step(&self, point: f64, step: f64) -> Answer<()> {
        if !(step.is_finite() && step > 0.0) {
            return Err(Refusal::error(format!("step size {step:?} s is not positive and finite")));
        }
        check_step_length(step).map_err(|error| Refusal::error(error.to_string()))?;
        let time = self.time();
        // A step that is far too long may end early: its requested length does not indicate how far it gets.
        let usual = step.min(self.scene.step);
        let tolerance = STEP_TOLERANCE * usual + TIME_TOLERANCE * time.abs();
        if !point.is_finite() || (point - time).abs() > tolerance {
            let message =
                format!("communication point {point:?} s is not the unit's time {time:?} s");
            return Err(Refusal::error(message));
        }
        let end = point + step;
        if end <= point || end <= time {
            let message = format!("step size {step:?} s is lost in rounding at {point:?} s");
            return Err(Refusal::error(message));
        }
        match self.experiment.stop {
            Some(stop) if end > stop + tolerance => Err(Refusal::error(format!(
                "a step to {end:?} s goes beyond the stop time {stop:?} s"
            ))),
            _ => Ok(()),
        }
    }
}
