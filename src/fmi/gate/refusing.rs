//! Functions that only refuse: the tables of the versions export them.

use super::answer::{Handle, Reference, Status};
use super::arguments::array;
use super::instance::call;
use crate::fmi::table::Function;

/// Refuses a function that no phase allows, with the table's reason in the log.
///
/// # Safety
/// As for [`call`].
pub unsafe fn refuse(handle: Handle, function: impl Function) -> Status {
    // SAFETY: by contract.
    unsafe { call(handle, function, |_| unreachable!("the table never allows it")) }
}

/// Succeeds for an empty list of variables; refuses all others, as no variable has the function's type.
///
/// # Safety
/// As for [`call`] and [`array`].
pub unsafe fn absent<F: Function>(
    handle: Handle,
    function: F,
    references: *const Reference,
    count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(handle, function, |unit| match array(references, count, F::REFERENCES)?.first() {
            None => Ok(Status::Ok),
            Some(&reference) => Err(F::of_another_type(unit, reference, function.kind())),
        })
    }
}
