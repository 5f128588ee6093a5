//! The global allocator: the system's, with retries and a small reserve.
//!
//! Rust ends the process if an allocation fails, which must not happen to a host. Large requests are checked ahead; two
//! cases remain. First, when a thread first allocates, the C library briefly takes twice 64 MiB of address space, and
//! another thread finds none: that passes. Second, a refusal must be reported when no memory is left: the reserve holds
//! its text.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::UnsafeCell;
use std::ptr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::sleep;
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: Patient = Patient;

struct Patient;

/// Number of retries, and their delay.
const RETRIES: usize = 40;
const PAUSE: Duration = Duration::from_micros(50);
/// Size beyond which requests fail at once: callers of such sizes handle failure.
const LARGEST_AWAITED: usize = 1 << 40;

// SAFETY: blocks come from the system, or are parts of the reserve without another owner; its address determines where
// a block is returned.
unsafe impl GlobalAlloc for Patient {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: by contract.
        let block = unsafe { System.alloc(layout) };
        if block.is_null() {
            retry(layout, |layout| unsafe { System.alloc(layout) })
        } else {
            block
        }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: by contract.
        let block = unsafe { System.alloc_zeroed(layout) };
        if !block.is_null() {
            return block;
        }
        let block = retry(layout, |layout| unsafe { System.alloc_zeroed(layout) });
        if RESERVE.holds(block) {
            // SAFETY: as large as asked for.
            unsafe { block.write_bytes(0, layout.size()) };
        }
        block
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        if RESERVE.holds(block) {
            return RESERVE.give_back();
        }
        // SAFETY: by contract, and it is the system's.
        unsafe { System.dealloc(block, layout) };
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !RESERVE.holds(block) {
            // SAFETY: by contract, and it is the system's.
            let moved = unsafe { System.realloc(block, layout, size) };
            if !moved.is_null() {
                return moved;
            }
        }
        // SAFETY: by contract a layout; blocks of both sizes do not overlap.
        unsafe {
            let new = Layout::from_size_align_unchecked(size, layout.align());
            let moved = self.alloc(new);
            if !moved.is_null() {
                ptr::copy_nonoverlapping(block, moved, layout.size().min(size));
                self.dealloc(block, layout);
            }
            moved
        }
    }
}

/// Retries for a while, then takes from the reserve; null if both fail.
#[cold]
fn retry(layout: Layout, ask: impl Fn(Layout) -> *mut u8) -> *mut u8 {
    if layout.size() > LARGEST_AWAITED {
        return ptr::null_mut();
    }
    for _ in 0..RETRIES {
        sleep(PAUSE);
        let block = ask(layout);
        if !block.is_null() {
            return block;
        }
    }
    RESERVE.take(layout)
}

const SIZE: usize = 1 << 20;

/// Statically allocated memory. Blocks are taken consecutively, and all space is reusable once all have been returned.
#[repr(align(4096))]
struct Reserve {
    room: UnsafeCell<[u8; SIZE]>,
    /// Number of bytes taken, and in the upper half the number of blocks in use.
    used: AtomicU64,
}

// SAFETY: parts of the room are given out once.
unsafe impl Sync for Reserve {}

static RESERVE: Reserve = Reserve { room: UnsafeCell::new([0; SIZE]), used: AtomicU64::new(0) };

const BLOCK: u64 = 1 << 32;

impl Reserve {
    fn holds(&self, block: *mut u8) -> bool {
        block.addr().wrapping_sub(self.room.get().addr()) < SIZE
    }

    fn take(&self, layout: Layout) -> *mut u8 {
        let mut used = self.used.load(Ordering::Acquire);
        loop {
            let from = ((used % BLOCK) as usize).next_multiple_of(layout.align());
            // Even an empty block needs an address of its own.
            let to = from.saturating_add(layout.size().max(1));
            if layout.align() > 4096 || to > SIZE {
                return ptr::null_mut();
            }
            let now = (used / BLOCK + 1) * BLOCK + to as u64;
            let (set, missed) = (Ordering::AcqRel, Ordering::Acquire);
            match self.used.compare_exchange_weak(used, now, set, missed) {
                Ok(_) => return self.room.get().cast::<u8>().wrapping_add(from),
                Err(other) => used = other,
            }
        }
    }

    fn give_back(&self) {
        let less = |used: u64| if used < 2 * BLOCK { 0 } else { used - BLOCK };
        let (set, missed) = (Ordering::AcqRel, Ordering::Acquire);
        let _ = self.used.fetch_update(set, missed, |used| Some(less(used)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserve_blocks_are_distinct_and_coalesce_when_freed() {
        // The stack of a test is too short for it.
        static RESERVE: Reserve =
            Reserve { room: UnsafeCell::new([0; SIZE]), used: AtomicU64::new(0) };
        let reserve = &RESERVE;
        let layout = |size, align| Layout::from_size_align(size, align).unwrap();
        for _ in 0..3 {
            let small = reserve.take(layout(3, 1));
            let aligned = reserve.take(layout(100, 64));
            assert!(
                reserve.holds(small) && reserve.holds(aligned) && aligned.addr().is_multiple_of(64)
            );
            assert!(aligned.addr() >= small.addr() + 3);
            assert!(reserve.take(layout(SIZE, 1)).is_null());
            reserve.give_back();
            reserve.give_back();
            let all = reserve.take(layout(SIZE, 4096));
            assert!(reserve.holds(all));
            reserve.give_back();
        }
        assert!(!reserve.holds(ptr::null_mut()));
    }

    #[test]
    fn impossible_requests_are_refused() {
        assert!(Vec::<u8>::new().try_reserve_exact(1 << 62).is_err());
    }
}
