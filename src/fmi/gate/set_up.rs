//! Set-up of a process, done once, and release of resources when the library is unloaded.

use std::process;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// Nothing has been set up; no process has this number.
const NOTHING: u32 = 0;
/// All has been set up; no process has this number either.
const ALL: u32 = u32::MAX;
/// Pause between two checks while another thread is setting up.
const PAUSE: Duration = Duration::from_micros(20);

/// Part of the set-up of a process; holds the number of the process that is setting it up.
pub struct SetUpOnce(AtomicU32);

/// The process was forked while a thread that it does not have was setting it up.
#[derive(Debug, PartialEq, thiserror::Error)]
#[error(
    "this process was forked while another thread made the first unit of its parent: the parent has to \
     make one before it forks"
)]
pub struct CutOff;

impl SetUpOnce {
    /// A part that no thread has set up yet.
    pub const fn new() -> Self {
        Self(AtomicU32::new(NOTHING))
    }

    /// Calls `set_up` if no thread has; waits while another thread does.
    pub fn ensure(&self, set_up: impl FnOnce()) -> Result<(), CutOff> {
        let process = process::id();
        loop {
            match self.0.compare_exchange(NOTHING, process, Ordering::AcqRel, Ordering::Acquire) {
                Ok(_) => {
                    set_up();
                    self.0.store(ALL, Ordering::Release);
                    return Ok(());
                }
                Err(ALL) => return Ok(()),
                Err(other) if other == process => sleep(PAUSE),
                Err(_) => return Err(CutOff),
            }
        }
    }

    /// Returns true once a thread has set it up.
    #[cfg(any(target_os = "linux", test))]
    pub fn is_done(&self) -> bool {
        self.0.load(Ordering::Acquire) == ALL
    }
}

/// Called by the system when the library is unloaded, and when its process ends.
#[cfg(target_os = "linux")]
#[used]
#[unsafe(link_section = ".fini_array")]
static AT_UNLOAD: extern "C" fn() = {
    extern "C" fn give_back() {
        super::instance::free_spares();
        super::panics::remove_hook();
    }
    give_back
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_is_set_up_once() {
        let (once, mut count) = (SetUpOnce::new(), 0);
        for _ in 0..3 {
            once.ensure(|| count += 1).unwrap();
        }
        assert_eq!((count, once.is_done()), (1, true));
    }

    #[test]
    fn forked_processes_do_not_wait_for_parent_threads() {
        let once = SetUpOnce(AtomicU32::new(process::id().wrapping_add(1).max(1)));
        assert_eq!(once.ensure(|| ()), Err(CutOff));
        assert!(!once.is_done());
    }
}
