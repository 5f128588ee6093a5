//! Callbacks of a host of FMI 3.0: log messages and intermediate updates.

use std::ffi::CString;

use super::types::{Boolean, Environment, FALSE, IntermediateUpdate, LogMessage};
use crate::fmi::gate::float_environment;
use crate::fmi::gate::log::Sink;
use crate::fmi::unit::Ask;

/// Returns a sink for the callback of FMI 3.0, whose messages are not formats.
pub fn to_log_message(callback: LogMessage, environment: Environment) -> Sink {
    Box::new(move |status, category, message| {
        let Some(callback) = callback else { return };
        let message = CString::new(message.replace('\0', " ")).unwrap_or_default();
        // SAFETY: the callback came with fmi3Instantiate… and has this signature; the strings live
        // through the call.
        float_environment::of_host(|| unsafe {
            callback(environment, status, category.as_ptr(), message.as_ptr());
        });
    })
}

/// Reports the progress of a step to the host. No variable takes part: none can be set or read then.
pub fn to_ask(callback: IntermediateUpdate, environment: Environment) -> Option<Ask> {
    let callback = callback?;
    Some(Box::new(move |time, may_end_early| {
        let (mut wanted, mut end) = (FALSE, time);
        let can_return_early = Boolean::from(may_end_early);
        // SAFETY: the callback came with fmi3InstantiateCoSimulation and has this signature; both places
        // live through the call.
        float_environment::of_host(|| unsafe {
            let (wanted, end) = (&raw mut wanted, &raw mut end);
            callback(
                environment,
                time,
                FALSE,
                FALSE,
                Boolean::from(true),
                can_return_early,
                wanted,
                end,
            );
        });
        (wanted != FALSE).then_some(end)
    }))
}
