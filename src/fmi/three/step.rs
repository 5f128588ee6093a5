//! FMI functions of co-simulation, section 4.2 of the standard.

use super::table::Fmi3;
use super::types::{Boolean, FALSE, Float64, Handle};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::arguments::{null, write};
use crate::fmi::gate::gated;
use crate::fmi::table::Phase;
use crate::fmi::unit::Unit;

/// Advances the unit by a step.
///
/// Inputs are constant over the step. It never requests termination. If allowed, it ends early when it is too long for
/// one call, when the master requests it in an intermediate update, or at an event. Events are reported to masters that
/// use Event Mode; where a step may not end early, they are at its end.
///
/// A refused or discarded step leaves the unit unchanged: the master may correct inputs or times and try again. No
/// state is kept except those saved by the master, so `no_set_fmu_state_prior_to_current_point` has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: Handle,
    current_communication_point: Float64,
    communication_step_size: Float64,
    _no_set_fmu_state_prior_to_current_point: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_time: *mut Float64,
) -> Status {
    let flags = [
        (event_handling_needed, "eventHandlingNeeded"),
        (terminate_simulation, "terminateSimulation"),
        (early_return, "earlyReturn"),
    ];
    gated!(instance, Fmi3::fmi3DoStep, |unit| {
        if let Some((_, name)) = flags.iter().find(|(flag, _)| flag.is_null()) {
            return Err(null(name));
        }
        if last_successful_time.is_null() {
            return Err(null("lastSuccessfulTime"));
        }
        let answer = unit.step(current_communication_point, communication_step_size);
        stay_in_step_mode(unit);
        let end = current_communication_point + communication_step_size;
        let is_early = answer.is_ok() && unit.time() < end;
        for (flag, name) in flags {
            write(flag, &[FALSE], name)?;
        }
        let has_event = answer.is_ok() && unit.is_at_event;
        write(event_handling_needed, &[Boolean::from(has_event)], "eventHandlingNeeded")?;
        write(early_return, &[Boolean::from(is_early)], "earlyReturn")?;
        write(last_successful_time, &[unit.time()], "lastSuccessfulTime")?;
        answer
    })
}

/// Returns a unit whose step has failed to Step Mode.
///
/// FMI 3.0 has no failed steps: a unit that discards one stays in its previous mode.
pub fn stay_in_step_mode(unit: &mut Unit) {
    if matches!(unit.phase, Phase::StepFailed | Phase::StepCanceled) {
        unit.phase = Phase::StepComplete;
    }
}
