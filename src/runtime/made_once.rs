//! Lazily made values, fork-safe.

use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

use super::fork_lock::ForkLock;

/// A value made by the first thread that needs it; other threads of the process wait for it. A forked process makes a
/// value again if a thread of its parent was making it. Values are published atomically, so a fork finds none or all of
/// a value.
pub struct MadeOnce<T> {
    value: AtomicPtr<T>,
    making: ForkLock<()>,
}

// SAFETY: the value is owned, and shared by reference between threads.
unsafe impl<T: Send> Send for MadeOnce<T> {}
// SAFETY: as above; whoever makes the value may be another thread than the one that drops it.
unsafe impl<T: Send + Sync> Sync for MadeOnce<T> {}

impl<T> MadeOnce<T> {
    pub const fn new() -> Self {
        Self { value: AtomicPtr::new(ptr::null_mut()), making: ForkLock::new(()) }
    }

    /// The value, if it has been made.
    pub fn get(&self) -> Option<&T> {
        // SAFETY: null or published below, and there as long as `self`.
        unsafe { self.value.load(Ordering::Acquire).as_ref() }
    }

    /// Returns the value, made by `make` on first use. `make` must not request the value itself.
    pub fn get_or_make(&self, make: impl FnOnce() -> T) -> &T {
        if let Some(value) = self.get() {
            return value;
        }
        let making = self.making.lock();
        if self.get().is_none() {
            self.value.store(Box::into_raw(Box::new(make())), Ordering::Release);
        }
        drop(making);
        self.get().expect("made above")
    }
}

impl<T> Default for MadeOnce<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T> Drop for MadeOnce<T> {
    fn drop(&mut self) {
        let value = *self.value.get_mut();
        if !value.is_null() {
            // SAFETY: comes from a box, and nobody borrows it any more.
            drop(unsafe { Box::from_raw(value) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn concurrent_requests_get_the_same_value() {
        let (once, made) = (MadeOnce::new(), AtomicUsize::new(0));
        let make = || {
            std::thread::sleep(std::time::Duration::from_millis(20));
            made.fetch_add(1, Ordering::Relaxed)
        };
        std::thread::scope(|scope| {
            let asked: Vec<_> = (0..4).map(|_| scope.spawn(|| *once.get_or_make(make))).collect();
            assert!(asked.into_iter().all(|thread| thread.join().unwrap() == 0));
        });
        assert_eq!(made.into_inner(), 1);
    }

    #[test]
    fn fork_recreates_unfinished_value() {
        let once = MadeOnce::new();
        once.making.hold_by_another_process();
        assert_eq!(once.get(), None);
        assert_eq!(*once.get_or_make(|| 7), 7);
        assert_eq!(*once.get_or_make(|| 8), 7);
    }

    #[test]
    fn panic_leaves_the_value_to_the_next_request() {
        let once = MadeOnce::new();
        let panic = catch_unwind(AssertUnwindSafe(|| *once.get_or_make(|| panic!("no value"))));
        assert!(panic.is_err());
        assert_eq!(*once.get_or_make(|| 3), 3);
    }
}
