//! The beginning of an instance, and what its master chooses of the log, in every version of the standard.

use std::ptr;
use std::rc::Rc;

use super::answer::{Answer, Handle, Refusal, Status, Text};
use super::arguments::texts;
use super::instance::hand_out;
use super::log::Log;
use super::panics;
use crate::fmi::table::Function;
use crate::fmi::unit::{Packed, StepControl, Unit};

/// Makes a unit of what `load` reads, for calls of the functions `F`; null with a message in the log if it cannot.
pub fn instantiate<F: Function>(
    function: &str,
    log: Log,
    control: StepControl,
    load: impl FnOnce() -> Answer<Packed>,
) -> Handle {
    match panics::caught(load).unwrap_or_else(|panic| Err(Refusal::error(panic))) {
        Ok(packed) => {
            let mut unit = Unit::new(packed, log);
            unit.control = Rc::new(control);
            hand_out::<F>(unit)
        }
        Err(refusal) => no_instance(function, &log, refusal),
    }
}

/// Logs why there is no instance, and answers null.
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
