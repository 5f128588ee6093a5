//! The gate between the C ABI and [`Unit`]: every function that acts on an instance goes through
//! [`call`].

use std::ptr;
use std::slice;
use std::sync::Mutex;

use super::legality::{Function, Phase};
use super::panics;
use super::types::{Answer, Handle, Refusal, Status};
use super::unit::Unit;
use crate::model::Model;

/// What a `fmi2Component` or `fmi3Instance` points to.
struct Instance {
    /// Tells the version of the standard, and that the instance has not been taken back.
    marker: u64,
    /// Locked during a call. A call that comes meanwhile, from another thread or from within the
    /// logger, is refused instead of waiting: FMI allows one call at a time.
    unit: Mutex<Unit>,
}

/// Hands a unit over to the master, for calls of the functions `F`.
pub fn hand_out<F: Function>(unit: Unit) -> Handle {
    Box::into_raw(Box::new(Instance { marker: F::MARKER, unit: Mutex::new(unit) })).cast()
}

/// The instance behind a pointer, if it is one of this version.
///
/// # Safety
/// A pointer that is not null and is aligned must be readable.
unsafe fn instance<'a, F: Function>(handle: Handle) -> Option<&'a Instance> {
    let pointer: *const Instance = handle.cast_const().cast();
    if pointer.is_null() || !pointer.is_aligned() {
        return None;
    }
    // SAFETY: readable by contract; only the marker is looked at before it is known to be valid.
    unsafe { (ptr::read_volatile(&raw const (*pointer).marker) == F::MARKER).then(|| &*pointer) }
}

/// Runs `body` on the unit behind `handle` if `function` is allowed now. Refusals and panics become
/// one message in the log and the status to answer.
///
/// # Safety
/// `handle` must be null or come from [`hand_out`].
pub unsafe fn call<F: Function>(
    handle: Handle,
    function: F,
    body: impl FnOnce(&mut Unit) -> Answer,
) -> Status {
    // SAFETY: by contract.
    let Some(instance) = (unsafe { instance::<F>(handle) }) else { return Status::Error };
    let Ok(mut unit) = instance.unit.try_lock() else { return Status::Error };
    run(&mut unit, function, body)
}

fn run<F: Function>(
    unit: &mut Unit,
    function: F,
    body: impl FnOnce(&mut Unit) -> Answer,
) -> Status {
    let work = || unit.check_phase(function).and_then(|()| body(unit));
    let answer = panics::caught(work).unwrap_or_else(|panic| Err(after_panic(unit, &panic)));
    answer.unwrap_or_else(|Refusal { status, message }| {
        unit.log.send(status, &format!("{}: {message}", function.name()));
        status
    })
}

/// After a panic the state is not to be trusted: only reset, or a second panic makes it final.
fn after_panic(unit: &mut Unit, panic: &str) -> Refusal {
    let (phase, status) = match unit.phase {
        Phase::Error | Phase::Fatal => (Phase::Fatal, Status::Fatal),
        _ => (Phase::Error, Status::Error),
    };
    unit.phase = phase;
    Refusal { status, message: format!("internal error, please report it: {panic}") }
}

/// Takes an instance back and frees it, if `function` is allowed to do so now.
///
/// # Safety
/// As for [`call`]; the pointer is invalid afterwards.
pub unsafe fn take_back(handle: Handle, function: impl Function) {
    // SAFETY: by contract.
    let status = unsafe { call(handle, function, |_| Ok(Status::Ok)) };
    if status != Status::Ok {
        return;
    }
    let pointer: *mut Instance = handle.cast();
    // SAFETY: `call` has found a valid instance, and nobody else may use it during this call.
    unsafe {
        ptr::write_volatile(&raw mut (*pointer).marker, 0);
        let boxed = Box::from_raw(pointer);
        let _ = panics::caught(move || {
            drop(boxed);
            Model::forget_unused();
        });
    }
}

/// A C array as a slice.
///
/// # Safety
/// `pointer` is null or leads to `length` values that stay unchanged during the call.
pub unsafe fn array<'a, T>(pointer: *const T, length: usize, name: &str) -> Answer<&'a [T]> {
    match (pointer.is_null(), length) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(name)),
        // SAFETY: by contract.
        (false, _) => Ok(unsafe { slice::from_raw_parts(pointer, length) }),
    }
}

/// Writes an answer into a C array.
///
/// # Safety
/// `pointer` is null or leads to room for as many values.
pub unsafe fn write<T: Copy>(pointer: *mut T, values: &[T], name: &str) -> Answer {
    if values.is_empty() {
        return Ok(Status::Ok);
    }
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: by contract.
    unsafe { ptr::copy_nonoverlapping(values.as_ptr(), pointer, values.len()) };
    Ok(Status::Ok)
}

/// The refusal of a null pointer.
pub fn null(name: &str) -> Refusal {
    Refusal::error(format!("{name} is a null pointer"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::legality::Fmi2;

    #[test]
    fn a_panic_leaves_a_unit_that_can_be_reset() {
        let mut unit = Unit::for_tests();
        let status = run(&mut unit, Fmi2::SetupExperiment, |_| panic!("a bug"));
        assert_eq!((status, unit.phase), (Status::Error, Phase::Error));
        assert_eq!(
            run(&mut unit, Fmi2::EnterInitializationMode, |_| Ok(Status::Ok)),
            Status::Error
        );
        assert_eq!(run(&mut unit, Fmi2::Reset, Unit::reset), Status::Ok);
        assert_eq!(unit.phase, Phase::Instantiated);
    }

    #[test]
    fn a_second_panic_is_final() {
        let mut unit = Unit::for_tests();
        run(&mut unit, Fmi2::Reset, |_| panic!("a bug"));
        let status = run(&mut unit, Fmi2::Reset, |_| panic!("another bug"));
        assert_eq!((status, unit.phase), (Status::Fatal, Phase::Fatal));
        assert_eq!(run(&mut unit, Fmi2::Reset, Unit::reset), Status::Error);
    }
}
