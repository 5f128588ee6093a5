//! Own threads, with a known stack and no residue in the process.
//!
//! On Unix they are started by the system's own function. The standard library's way registers a destructor on the
//! starting thread, and occupies a key of the process. On a host's thread both would outlive the last instance of a
//! unit: the first keeps the library in memory, and keys are few. Signals of the host stay with the host's threads.

use std::cell::Cell;
use std::mem::transmute;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicU64, Ordering};

use super::address_space::{self, ARENA, PRODUCTS, SPARE};

/// Address space of the stack of each own thread [B].
pub const STACK: usize = 2 << 20;

/// Largest address space of each own thread [B].
pub const SPACE: usize = STACK + ARENA + PRODUCTS;

/// Number of own threads.
static LIVING: Count = Count(AtomicU64::new(0));

/// Number of this process's threads of a kind. A forked process restarts at zero: the only thread it inherits is the
/// one that forked.
struct Count(AtomicU64);

impl Count {
    /// Adds one.
    fn add(&self) {
        self.change(std::process::id(), |count| count.saturating_add(1));
    }

    /// Subtracts one.
    fn take(&self) {
        self.change(std::process::id(), |count| count.saturating_sub(1));
    }

    fn get(&self) -> usize {
        of_process(self.0.load(Ordering::Relaxed), std::process::id()) as usize
    }

    /// The process is in the upper half of the number, the count in the lower.
    fn change(&self, process: u32, changed: impl Fn(u32) -> u32) {
        let next = |number| {
            let count = changed(of_process(number, process));
            Some(u64::from(process) << 32 | u64::from(count))
        };
        let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, next);
    }
}

/// The count of a process; zero if the number belongs to another.
fn of_process(number: u64, process: u32) -> u32 {
    if (number >> 32) as u32 == process { number as u32 } else { 0 }
}

thread_local! {
    static IS_OURS: Cell<bool> = const { Cell::new(false) };
}

/// Returns true if the calling thread is an own one.
pub fn is_ours() -> bool {
    IS_OURS.get()
}

/// Runs `work` on an own thread and waits for it. It runs on the calling thread if that is an own one, or if the system
/// cannot start another. A panic continues in the calling thread.
///
/// For work that needs more stack than a host's thread may have, or that keeps data per thread.
pub fn aside<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    if is_ours() {
        return work();
    }
    let mut work = Some(work);
    let mut result = None;
    let run: Box<dyn FnOnce() + Send> = Box::new(|| {
        let work = work.take().expect("runs once");
        result = Some(catch_unwind(AssertUnwindSafe(work)));
    });
    // SAFETY: the borrowed data outlives the thread, which is joined right here.
    let started = system::start(unsafe { transmute::<Box<_>, Box<dyn FnOnce() + Send>>(run) });
    match started {
        Some(thread) => thread.join(),
        None => return work.take().expect("has not run")(),
    }
    match result.expect("has run") {
        Ok(result) => result,
        Err(panic) => resume_unwind(panic),
    }
}

/// A running thread, to be joined.
pub struct Started(system::Thread);

impl Started {
    /// Waits for the thread's end, and releases all its resources.
    pub fn join(self) {
        self.0.join();
    }
}

/// Starts an own thread, if the system allows it and address space suffices for all of them: each reservation reduces
/// that of others. Panics of `work` end with the thread.
pub fn start(work: impl FnOnce() + Send + 'static) -> Option<Started> {
    let all = LIVING.get() + 1;
    if !address_space::fits(all * SPACE + SPARE) {
        return None;
    }
    system::start(Box::new(work)).map(Started)
}

/// Body of an own thread.
fn serve(work: Box<dyn FnOnce() + Send>) {
    IS_OURS.set(true);
    // Callers that need a panic catch it before.
    let _ = catch_unwind(AssertUnwindSafe(work));
    LIVING.take();
}

#[cfg(unix)]
mod system {
    use std::ffi::c_void;
    use std::mem::{ManuallyDrop, MaybeUninit};
    use std::ptr;

    use super::{LIVING, STACK, serve};

    type Work = Box<dyn FnOnce() + Send>;

    /// A thread and its stack, which is leaked if nobody joins the thread.
    pub struct Thread(libc::pthread_t, ManuallyDrop<Stack>);

    /// Memory of a stack above a guard page. The C library would keep the stacks of ended threads for later ones, with
    /// their thread-local data. If another thread takes one of these during a fork, blocks of the child's stack are
    /// freed twice (glibc 2.36, `get_cached_stack`).
    struct Stack {
        place: *mut c_void,
        guard: usize,
    }

    // SAFETY: a shared stack has no method that writes; only its owner releases it.
    unsafe impl Sync for Stack {}

    impl Stack {
        /// Returns `None` if there is no memory for it.
        fn new() -> Option<Self> {
            // SAFETY: asks for a number.
            let guard = usize::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }).ok()?;
            let flags = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS | libc::MAP_NORESERVE;
            // SAFETY: a new mapping without other users; the page below stays inaccessible.
            unsafe {
                let size = guard + STACK;
                let place = libc::mmap(ptr::null_mut(), size, libc::PROT_NONE, flags, -1, 0);
                if place == libc::MAP_FAILED {
                    return None;
                }
                let stack = Self { place, guard };
                let open = libc::PROT_READ | libc::PROT_WRITE;
                (libc::mprotect(stack.lowest(), STACK, open) == 0).then_some(stack)
            }
        }

        /// Lowest address that the thread may use.
        fn lowest(&self) -> *mut c_void {
            self.place.wrapping_byte_add(self.guard)
        }
    }

    impl Drop for Stack {
        fn drop(&mut self) {
            // SAFETY: made in `new`, and its thread has ended or never began.
            unsafe { libc::munmap(self.place, self.guard + STACK) };
        }
    }

    /// Disables cancellation in `body`. A host that cancels its own thread while it waits for one of ours must not
    /// unwind it: the work borrows from its stack.
    #[cfg(target_os = "linux")]
    fn uncancelled<R>(body: impl FnOnce() -> R) -> R {
        unsafe extern "C" {
            fn pthread_setcancelstate(state: i32, old: *mut i32) -> i32;
        }
        const DISABLE: i32 = 1;
        let (mut before, mut disabled) = (0, 0);
        // SAFETY: both states are places of our own.
        unsafe { pthread_setcancelstate(DISABLE, &mut before) };
        let result = body();
        // SAFETY: as above.
        unsafe { pthread_setcancelstate(before, &mut disabled) };
        result
    }

    #[cfg(not(target_os = "linux"))]
    fn uncancelled<R>(body: impl FnOnce() -> R) -> R {
        body()
    }

    impl Thread {
        pub fn join(self) {
            // SAFETY: the thread has been started, and is joined once.
            let failed = uncancelled(|| unsafe { libc::pthread_join(self.0, ptr::null_mut()) });
            assert_eq!(failed, 0, "a thread of ours can be joined");
            drop(ManuallyDrop::into_inner(self.1));
        }
    }

    pub fn start(work: Work) -> Option<Thread> {
        let stack = Stack::new()?;
        LIVING.add();
        let work = Box::into_raw(Box::new(work));
        with_faults_alone(|| {
            let mut attributes = MaybeUninit::uninit();
            let mut thread = MaybeUninit::uninit();
            // SAFETY: attributes are made before they are used and destroyed once; `work` belongs to the
            // thread from its start on, and to us where there is none.
            unsafe {
                let mut failed = libc::pthread_attr_init(attributes.as_mut_ptr());
                if failed == 0 {
                    let attributes_set = attributes.as_mut_ptr();
                    failed = libc::pthread_attr_setstack(attributes_set, stack.lowest(), STACK);
                    if failed == 0 {
                        let (thread, attributes) = (thread.as_mut_ptr(), attributes.as_ptr());
                        failed = libc::pthread_create(thread, attributes, run, work.cast());
                    }
                    libc::pthread_attr_destroy(attributes.as_mut_ptr());
                }
                if failed != 0 {
                    LIVING.take();
                    drop(Box::from_raw(work));
                    return None;
                }
                Some(Thread(thread.assume_init(), ManuallyDrop::new(stack)))
            }
        })
    }

    /// Runs `body` so that threads started in it receive no signals except those of their own faults.
    fn with_faults_alone<R>(body: impl FnOnce() -> R) -> R {
        let faults =
            [libc::SIGSEGV, libc::SIGBUS, libc::SIGFPE, libc::SIGILL, libc::SIGTRAP, libc::SIGSYS];
        let (mut blocked, mut before) = (MaybeUninit::uninit(), MaybeUninit::uninit());
        // SAFETY: sets are filled before they are used, and the mask is put back as it was.
        unsafe {
            libc::sigfillset(blocked.as_mut_ptr());
            for fault in faults {
                libc::sigdelset(blocked.as_mut_ptr(), fault);
            }
            libc::pthread_sigmask(libc::SIG_BLOCK, blocked.as_ptr(), before.as_mut_ptr());
            let result = body();
            libc::pthread_sigmask(libc::SIG_SETMASK, before.as_ptr(), ptr::null_mut());
            result
        }
    }

    extern "C" fn run(work: *mut c_void) -> *mut c_void {
        #[cfg(target_os = "linux")]
        // SAFETY: a name of less than 16 bytes; debuggers show it.
        unsafe {
            libc::prctl(libc::PR_SET_NAME, c"impinge worker".as_ptr());
        }
        // SAFETY: comes from `start`, which has given it to this thread.
        serve(*unsafe { Box::from_raw(work.cast::<Work>()) });
        ptr::null_mut()
    }
}

#[cfg(not(unix))]
mod system {
    use std::thread::{Builder, JoinHandle};

    use super::{LIVING, STACK, serve};

    pub struct Thread(JoinHandle<()>);

    impl Thread {
        pub fn join(self) {
            self.0.join().expect("panics end with the work");
        }
    }

    pub fn start(work: Box<dyn FnOnce() + Send>) -> Option<Thread> {
        LIVING.add();
        let builder = Builder::new().name("impinge worker".into()).stack_size(STACK);
        let thread = builder.spawn(|| serve(work)).ok().map(Thread);
        if thread.is_none() {
            LIVING.take();
        }
        thread
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn background_work_runs_on_one_own_thread_and_may_borrow() {
        let mut sum = 0;
        let inner = aside(|| {
            sum += 1;
            let here = std::thread::current().id();
            (is_ours(), aside(|| std::thread::current().id()) == here)
        });
        assert_eq!((inner, sum, is_ours()), ((true, true), 1, false));
    }

    #[cfg(unix)]
    #[test]
    fn fork_inherits_no_threads() {
        let (end, ended) = std::sync::mpsc::channel::<()>();
        let thread = start(move || ended.recv().unwrap_or_default()).unwrap();
        assert!(LIVING.get() >= 1);
        // SAFETY: the child looks at a number and ends.
        let status = unsafe {
            let child = libc::fork();
            if child == 0 {
                let before = LIVING.get();
                LIVING.add();
                libc::_exit((before * 8 + LIVING.get()) as i32);
            }
            let mut status = 0;
            assert_eq!(libc::waitpid(child, &mut status, 0), child);
            status
        };
        drop(end);
        thread.join();
        assert_eq!((libc::WIFEXITED(status), libc::WEXITSTATUS(status)), (true, 1));
    }

    #[test]
    fn panics_propagate_to_the_waiting_thread() {
        let panic = catch_unwind(|| aside(|| panic!("aside"))).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"aside"));
    }
}
