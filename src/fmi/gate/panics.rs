//! Keeps panics inside the library: caught, not printed, and reported as text.

use std::any::Any;
use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};

use super::float_environment;
use super::set_up::SetUpOnce;
use crate::runtime::fork_lock::ForkLock;
use crate::runtime::thread::is_ours;

thread_local! {
    /// True while this thread runs a call of the ABI. There are no thread-local values with destructors: a destructor
    /// would keep the library in memory during the life of the host's thread.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Message and place of the last panic seen by the hook.
static SEEN: ForkLock<Option<String>> = ForkLock::new(None);

static HOOK: SetUpOnce = SetUpOnce::new();

/// Runs `work` in the standard floating-point environment; a panic becomes its message.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    HOOK.ensure(install_hook).map_err(|cut_off| cut_off.to_string())?;
    let outer = INSIDE.replace(true);
    let result = float_environment::standard(|| panic::catch_unwind(AssertUnwindSafe(work)));
    INSIDE.set(outer);
    result.map_err(|payload| {
        let text = text_of(payload.as_ref());
        let seen = SEEN.lock().take();
        // Another instance may have panicked meanwhile.
        seen.filter(|seen| seen.contains(&text)).unwrap_or(text)
    })
}

/// The hook keeps panics off the host's terminal. It belongs to this library's own copy of the standard library; panics
/// outside the ABI go to the previous hook.
fn install_hook() {
    let previous = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        // A panic on one of our threads is passed on to the waiting thread.
        if INSIDE.get() || is_ours() {
            let seen = info.to_string().replace('\n', " ");
            *SEEN.lock() = Some(seen);
        } else {
            previous(info);
        }
    }));
}

/// Frees the memory of the hook.
#[cfg(target_os = "linux")]
pub fn remove_hook() {
    if HOOK.is_done() && !std::thread::panicking() {
        drop(panic::take_hook());
        drop(SEEN.try_lock().and_then(|mut seen| seen.take()));
    }
}

fn text_of(payload: &(dyn Any + Send)) -> String {
    payload
        .downcast_ref::<String>()
        .cloned()
        .or_else(|| payload.downcast_ref::<&str>().map(|text| text.to_string()))
        .unwrap_or_else(|| "panic without a message".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runtime::parallel;
    use crate::runtime::thread::aside;

    #[test]
    fn panics_become_message_and_place() {
        let message = caught(|| panic!("too {}", "hot")).unwrap_err();
        assert!(message.contains("too hot") && message.contains("panics.rs"), "{message}");
        assert_eq!(caught(|| 7), Ok(7));
    }

    #[test]
    fn worker_panics_become_messages() {
        let give_up = |i: usize| assert!(i > 64, "worker {}", "gave up");
        let message = caught(|| parallel::map(2, 64, give_up)).unwrap_err();
        assert!(message.contains("worker gave up"), "{message}");
        let message = caught(|| aside(|| panic!("nothing left"))).unwrap_err();
        assert!(message.contains("nothing left") && message.contains("panics.rs"), "{message}");
    }
}
