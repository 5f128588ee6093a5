//! Instances behind C pointers: every function that acts on one goes through [`call`].

use std::collections::VecDeque;
use std::ptr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};

use super::answer::{Answer, Handle, Refusal, Status};
use super::panics;
use crate::fmi::table::{Function, Phase};
use crate::fmi::unit::Unit;
use crate::model::Model;
use crate::runtime::allowance::Interrupt;
use crate::runtime::fork_lock::ForkLock;

/// What a `fmi2Component` or `fmi3Instance` points to. It is never freed but serves a later unit, so
/// that a call that comes while its unit is taken back, or later, looks at memory that is still there.
#[derive(Default)]
struct Instance {
    /// Tells the version of the standard, and that the instance has not been taken back.
    marker: AtomicU64,
    /// Locked during a call. A call that comes meanwhile, from another thread or from within the
    /// logger, is refused instead of waiting: FMI allows one call at a time.
    unit: Mutex<Option<Box<Unit>>>,
    /// That of the unit, for another thread to end a step with, under which the unit is locked.
    interrupt: Interrupt,
}

/// An instance that has been taken back.
struct Spare(&'static Instance);

// SAFETY: there is no unit in it, which is all that may not go to another thread.
unsafe impl Send for Spare {}

/// The one that was taken back first is in front.
static SPARE: ForkLock<VecDeque<Spare>> = ForkLock::new(VecDeque::new());
/// How many of them rest: a pointer that was freed leads to no unit before so many others were freed.
const RESTING: usize = 64;

/// Hands a unit over to the master, for calls of the functions `F`.
pub fn hand_out<F: Function>(mut unit: Unit) -> Handle {
    let instance = vacant_place();
    unit.interrupt = instance.interrupt.clone();
    // Nobody else has a place that is new or has just been found unlocked.
    *instance.unit.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(unit));
    instance.marker.store(F::MARKER, Ordering::Release);
    ptr::from_ref(instance).cast_mut().cast()
}

/// The place that has rested longest, or a new one: nobody waits for a thread that still calls the unit which
/// had the place, as a forked process may not have that thread.
fn vacant_place() -> &'static Instance {
    let mut all = SPARE.lock();
    let rested = if all.len() > RESTING { all.pop_front() } else { None };
    match rested {
        Some(Spare(place)) if !matches!(place.unit.try_lock(), Err(TryLockError::WouldBlock)) => {
            place
        }
        _ => Box::leak(Box::default()),
    }
}

/// Frees the places of units that were taken back, when the library goes.
#[cfg(target_os = "linux")]
pub fn free_spares() {
    // A process may end by a signal that came while a thread was here.
    let Some(mut spares) = SPARE.try_lock() else { return };
    for Spare(place) in std::mem::take(&mut *spares) {
        // SAFETY: comes from a box, and no unit is in it.
        drop(unsafe { Box::from_raw(ptr::from_ref(place).cast_mut()) });
    }
}

/// The instance behind a pointer, if it is one of this version.
///
/// # Safety
/// A pointer that is not null and is aligned must be readable.
unsafe fn instance<F: Function>(handle: Handle, _: F) -> Option<&'static Instance> {
    let pointer: *const Instance = handle.cast_const().cast();
    if pointer.is_null() || !pointer.is_aligned() {
        return None;
    }
    // SAFETY: readable by contract; only the marker is looked at before it is known to be valid.
    let marker = unsafe { AtomicU64::from_ptr((&raw const (*pointer).marker).cast_mut().cast()) };
    // SAFETY: instances are never freed.
    (marker.load(Ordering::Acquire) == F::MARKER).then(|| unsafe { &*pointer })
}

/// Ends the step under way behind `handle`, if there is one: what another thread may ask while a call
/// runs. Touches nothing of the unit but a number that is there for this.
///
/// # Safety
/// As for [`call`].
pub unsafe fn interrupt(handle: Handle, function: impl Function) -> bool {
    // SAFETY: by contract.
    unsafe { instance(handle, function) }.is_some_and(|instance| instance.interrupt.interrupt())
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
    let Some(instance) = (unsafe { instance(handle, function) }) else { return Status::Error };
    let Ok(mut unit) = instance.unit.try_lock() else { return Status::Error };
    let Some(unit) = unit.as_deref_mut() else { return Status::Error };
    run(unit, function, body)
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
    let Some(instance) = (unsafe { instance(handle, function) }) else { return };
    let Ok(mut place) = instance.unit.try_lock() else { return };
    let Some(unit) = place.as_deref_mut() else { return };
    if run(unit, function, |_| Ok(Status::Ok)) != Status::Ok {
        return;
    }
    // From here on nobody finds the unit any more.
    instance.marker.store(0, Ordering::Release);
    let unit = place.take();
    drop(place);
    let _ = panics::caught(move || {
        drop(unit);
        Model::forget_unused();
    });
    SPARE.lock().push_back(Spare(instance));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::two::table::Fmi2;

    #[test]
    fn a_panic_leaves_a_unit_that_can_be_reset() {
        let mut unit = Unit::for_tests();
        let status = run(&mut unit, Fmi2::fmi2SetupExperiment, |_| panic!("a bug"));
        assert_eq!((status, unit.phase), (Status::Error, Phase::Error));
        assert_eq!(
            run(&mut unit, Fmi2::fmi2EnterInitializationMode, |_| Ok(Status::Ok)),
            Status::Error
        );
        assert_eq!(run(&mut unit, Fmi2::fmi2Reset, Unit::reset), Status::Ok);
        assert_eq!(unit.phase, Phase::Instantiated);
    }

    #[test]
    fn a_second_panic_is_final() {
        let mut unit = Unit::for_tests();
        run(&mut unit, Fmi2::fmi2Reset, |_| panic!("a bug"));
        let status = run(&mut unit, Fmi2::fmi2Reset, |_| panic!("another bug"));
        assert_eq!((status, unit.phase), (Status::Fatal, Phase::Fatal));
        assert_eq!(run(&mut unit, Fmi2::fmi2Reset, Unit::reset), Status::Error);
    }
}
