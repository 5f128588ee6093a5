//! A lock that a forked process takes over from threads that it lacks.
//!
//! A fork copies memory but only the calling thread: a lock of the standard library that another thread held stays
//! locked in the child for ever. This lock records the process of its holder. A child that finds another process there
//! replaces the value, which may be half changed, by the default one.

use std::cell::UnsafeCell;
use std::hint::spin_loop;
use std::mem::ManuallyDrop;
use std::ops::{Deref, DerefMut};
use std::process;
use std::ptr;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// No process has this number.
const FREE: u32 = 0;
/// Attempts before a waiting thread sleeps.
const SPINS: u32 = 100;
/// Length of the first sleep and of the longest; each is twice as long as the one before.
const PAUSES: [Duration; 2] = [Duration::from_micros(20), Duration::from_millis(1)];

/// A value that one thread holds at a time. A value held by a thread of another process is leaked, not dropped.
pub struct ForkLock<T> {
    /// Process whose thread holds the lock.
    holder: AtomicU32,
    value: UnsafeCell<ManuallyDrop<T>>,
}

// SAFETY: one thread at a time reaches the value.
unsafe impl<T: Send> Send for ForkLock<T> {}
// SAFETY: as above.
unsafe impl<T: Send> Sync for ForkLock<T> {}

impl<T> ForkLock<T> {
    pub const fn new(value: T) -> Self {
        Self { holder: AtomicU32::new(FREE), value: UnsafeCell::new(ManuallyDrop::new(value)) }
    }
}

impl<T: Default> ForkLock<T> {
    /// Waits while another thread of this process holds the lock.
    pub fn lock(&self) -> ForkGuard<'_, T> {
        let mut pause = PAUSES[0];
        for attempt in 0.. {
            if let Some(guard) = self.try_lock() {
                return guard;
            }
            if attempt < SPINS {
                spin_loop();
            } else {
                sleep(pause);
                pause = (2 * pause).min(PAUSES[1]);
            }
        }
        unreachable!("the loop has no end");
    }

    /// Returns `None` while another thread of this process holds the lock.
    pub fn try_lock(&self) -> Option<ForkGuard<'_, T>> {
        let process = process::id();
        let take = |from| {
            self.holder.compare_exchange(from, process, Ordering::Acquire, Ordering::Relaxed)
        };
        match take(FREE) {
            Ok(_) => {}
            Err(holder) if holder == process => return None,
            Err(gone) => {
                take(gone).ok()?;
                // SAFETY: the thread that held the lock does not exist in this process, and no other thread
                // took it over.
                unsafe { ptr::write(self.value.get(), ManuallyDrop::new(T::default())) };
            }
        }
        Some(ForkGuard { lock: self, process })
    }
}

impl<T> Drop for ForkLock<T> {
    fn drop(&mut self) {
        // Any other holder belongs to another process: nobody borrows the lock.
        if *self.holder.get_mut() == FREE {
            // SAFETY: dropped once.
            unsafe { ManuallyDrop::drop(self.value.get_mut()) };
        }
    }
}

/// Access to the value of a held lock.
pub struct ForkGuard<'a, T> {
    lock: &'a ForkLock<T>,
    process: u32,
}

impl<T> Deref for ForkGuard<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        // SAFETY: this thread holds the lock.
        unsafe { &*self.lock.value.get() }
    }
}

impl<T> DerefMut for ForkGuard<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        // SAFETY: as above.
        unsafe { &mut *self.lock.value.get() }
    }
}

impl<T> Drop for ForkGuard<'_, T> {
    fn drop(&mut self) {
        let (success, failure) = (Ordering::Release, Ordering::Relaxed);
        let _ = self.lock.holder.compare_exchange(self.process, FREE, success, failure);
    }
}

#[cfg(test)]
impl<T> ForkLock<T> {
    /// Leaves the lock as after a fork during which another thread held it.
    pub fn hold_by_another_process(&self) {
        self.holder.store(process::id().wrapping_add(1).max(1), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn mutual_exclusion() {
        let lock = ForkLock::new(0_u64);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..1000).for_each(|_| *lock.lock() += 1));
            }
        });
        assert_eq!(*lock.lock(), 4000);
    }

    #[test]
    fn try_lock_fails_while_locked() {
        let lock = ForkLock::new(1);
        let guard = lock.lock();
        assert!(lock.try_lock().is_none());
        drop(guard);
        assert_eq!(lock.try_lock().map(|value| *value), Some(1));
    }

    #[test]
    fn stale_lock_of_a_parent_is_taken_over_with_a_new_value() {
        let shared = Arc::new(());
        let lock = ForkLock::new(Some(Arc::clone(&shared)));
        lock.hold_by_another_process();
        assert!(lock.lock().is_none());
        assert_eq!(Arc::strong_count(&shared), 2, "what may be half changed is not dropped");
        *lock.lock() = Some(Arc::new(()));
        assert!(lock.lock().is_some());
    }
}
