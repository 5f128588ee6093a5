//! Instantiation, and the log settings of a master, in every version of the standard.

use std::ptr;
use std::rc::Rc;

use super::answer::{Answer, Handle, Refusal, Status, Text};
use super::arguments::texts;
use super::instance::hand_out;
use super::log::Log;
use super::panics;
use crate::fmi::table::Function;
use crate::fmi::unit::{Packed, StepControl, Unit};

/// Creates a unit from the result of `load`, for calls of the functions `F`; on failure it logs a message and returns
/// null.
pub fn instantiate<F: Function>(
    function: &str,
    log: Log,
    control: StepControl,
    load: impl FnOnce() -> Answer<Packed>,
) -> Handle {
    match panics::caught(load).unwrap_or_else(|panic| Err(Refusal::error(panic))) {
        Ok(packed) => {
            let ask = control.ask.filter(|_| packed.reports_progress());
            let mut unit = Unit::new(packed, log);
            unit.control = Rc::new(StepControl { ask, ..control });
            hand_out::<F>(unit)
        }
        Err(refusal) => no_instance(function, &log, refusal),
    }
}

/// Logs why there is no instance, and returns null.
pub fn no_instance(function: &str, log: &Log, refusal: Refusal) -> Handle {
    log.send(refusal.status, &format!("{function}: {}", refusal.message));
    ptr::null_mut()
}

/// Switches logging, and chooses the categories that the master wants.
///
/// # Safety
/// As for [`texts`].
pub unsafe fn set_logging(
    unit: &mut Unit,
    on: bool,
    categories: *const Text,
    count: usize,
) -> Answer {
    // SAFETY: by contract.
    let names = unsafe { texts(categories, count, "categories")? };
    unit.log.configure(on, &names).map_err(Refusal::error)?;
    Ok(Status::Ok)
}
