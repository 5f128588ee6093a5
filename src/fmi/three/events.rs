//! FMI functions of Event Mode, sections 2.3.5 and 4.2 of the standard.
//!
//! An event is the moment at which a body cracks or comes apart. It changes no state: Event Mode lets the host act on
//! it, and set inputs anew.

use super::table::Fmi3;
use super::types::{Boolean, FALSE, Float64, Handle};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::arguments::{null, write};
use crate::fmi::gate::gated;
use crate::fmi::unit::Unit;

/// Enters Event Mode, after an event of the unit or of another one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterEventMode(instance: Handle) -> Status {
    gated!(instance, Fmi3::fmi3EnterEventMode, Unit::enter_event_mode)
}

/// Leaves Event Mode.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterStepMode(instance: Handle) -> Status {
    gated!(instance, Fmi3::fmi3EnterStepMode, Unit::leave_event_mode)
}

/// Reports that nothing is left to do: there are no discrete states, and the time of the next event is not known.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: Handle,
    discrete_states_need_update: *mut Boolean,
    terminate_simulation: *mut Boolean,
    nominals_of_continuous_states_changed: *mut Boolean,
    values_of_continuous_states_changed: *mut Boolean,
    next_event_time_defined: *mut Boolean,
    next_event_time: *mut Float64,
) -> Status {
    let flags = [
        (discrete_states_need_update, "discreteStatesNeedUpdate"),
        (terminate_simulation, "terminateSimulation"),
        (nominals_of_continuous_states_changed, "nominalsOfContinuousStatesChanged"),
        (values_of_continuous_states_changed, "valuesOfContinuousStatesChanged"),
        (next_event_time_defined, "nextEventTimeDefined"),
    ];
    gated!(instance, Fmi3::fmi3UpdateDiscreteStates, |unit| {
        if let Some((_, name)) = flags.iter().find(|(flag, _)| flag.is_null()) {
            return Err(null(name));
        }
        flags.iter().try_for_each(|(flag, name)| write(*flag, &[FALSE], name).map(drop))?;
        // Without a next event its time means nothing.
        write(next_event_time, &[unit.time()], "nextEventTime")
    })
}
