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

/// Target of a `fmi2Component` or `fmi3Instance`. It is never freed but reused for a later unit. A call during or after
/// the release of its unit therefore still reads valid memory.
#[derive(Default)]
struct Instance {
    /// Identifies the version of the standard, and shows that the instance has not been released.
    marker: AtomicU64,
    /// Locked during a call. A concurrent call, from another thread or from within the logger, is refused instead of
    /// waiting: FMI allows one call at a time.
    unit: Mutex<Option<Box<Unit>>>,
    /// Interrupt of the unit, with which another thread ends a step while the unit is locked.
    interrupt: Interrupt,
}

/// A released instance.
struct Spare(&'static Instance);

// It contains no unit, the only part that may not move to another thread.
unsafe impl Send for Spare {}

/// The instance released first is in front.
static SPARE: ForkLock<VecDeque<Spare>> = ForkLock::new(VecDeque::new());
/// Number of released instances kept unused: a freed pointer leads to no unit until this many others were freed.
const RESTING: usize = 64;

/// Hands a unit over to the master, for calls of the functions `F`.
pub fn hand_out<F: Function>(mut unit: Unit) -> Handle {
    let instance = vacant_place();
    unit.interrupt = instance.interrupt.clone();
    // A place that is new or was found unlocked has no other user.
    *instance.unit.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(unit));
    instance.marker.store(F::MARKER, Ordering::Release);
    ptr::from_ref(instance).cast_mut().cast()
}

/// Returns the place released longest ago, or a new one. It never waits for a thread that still calls the place's
/// former unit, because a forked process may not have that thread.
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

/// Frees the places of released units when the library is unloaded.
#[cfg(target_os = "linux")]
pub fn free_spares() {
    // A signal may end the process while a thread is here.
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
    // Readable by contract; only the marker is read before the pointer is known to be valid.
    let marker = unsafe { AtomicU64::from_ptr((&raw const (*pointer).marker).cast_mut().cast()) };
    // SAFETY: instances are never freed.
    (marker.load(Ordering::Acquire) == F::MARKER).then(|| unsafe { &*pointer })
}

/// Ends the step under way behind `handle`, if there is one. Another thread may call this while a call runs. It
/// accesses only an atomic number of the unit.
///
/// # Safety
/// As for [`call`].
pub unsafe fn interrupt(handle: Handle, function: impl Function) -> bool {
    // SAFETY: by contract.
    unsafe { instance(handle, function) }.is_some_and(|instance| instance.interrupt.interrupt())
}

/// Runs `body` on the unit behind `handle` if `function` is allowed now. Refusals and panics become one log message and
/// the returned status.
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

/// After a panic the state is unreliable: only a reset is allowed; a second panic is fatal.
fn after_panic(unit: &mut Unit, panic: &str) -> Refusal {
    let (phase, status) = match unit.phase {
        Phase::Error | Phase::Fatal => (Phase::Fatal, Status::Fatal),
        _ => (Phase::Error, Status::Error),
    };
    unit.phase = phase;
    Refusal { status, message: format!("internal error, please report it: {panic}") }
}

/// Releases an instance if `function` is allowed to do so now.
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
    // From here on no call finds the unit any more.
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
    fn units_can_be_reset_after_a_panic() {
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
