//! Keeps panics inside the library: caught, silent, and told as text.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;
use std::thread;

use crate::math::parallel::WORKER;

thread_local! {
    /// Whether this thread runs a call of the ABI.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
    /// What the hook saw on this thread: message and place.
    static SEEN: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `work`; a panic becomes its message.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    install_hook();
    let outer = INSIDE.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    INSIDE.set(outer);
    result.map_err(|payload| SEEN.take().unwrap_or_else(|| text_of(payload.as_ref())))
}

/// A host's terminal is not ours to write on. The hook belongs to this library's own copy of the
/// standard library; panics outside of the ABI go to the hook that was there before.
fn install_hook() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if INSIDE.get() {
                SEEN.set(Some(info.to_string().replace('\n', " ")));
            } else if thread::current().name() != Some(WORKER) {
                previous(info);
            } // A panic in a worker thread is passed on to the thread that waits for it.
        }));
    });
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
    use crate::math::parallel;

    #[test]
    fn a_panic_becomes_its_message_and_place() {
        let message = caught(|| panic!("too {}", "hot")).unwrap_err();
        assert!(message.contains("too hot") && message.contains("panics.rs"), "{message}");
        assert_eq!(caught(|| 7), Ok(7));
    }

    #[test]
    fn a_panic_of_a_worker_thread_becomes_its_message() {
        let give_up = |i: usize| assert!(i > 64, "worker {}", "gave up");
        assert!(caught(|| parallel::map(2, 64, give_up)).unwrap_err().contains("worker gave up"));
    }
}
