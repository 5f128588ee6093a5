//! Loops over threads.
//!
//! Every item is computed independently and stored in its own place, so results do not depend on the number of threads.

use std::any::Any;
use std::mem::transmute;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};

use super::thread::{self, Started};

/// Number of pieces into which each thread's share of a loop is cut, for idle threads to take.
const PIECES: usize = 16;

/// Number of checks before a waiting thread sleeps: some tens of microseconds, the time to wake a thread.
const LOOKS: usize = 3000;

/// Threads that run one loop after another, and end with the value. The calling thread is one of them, so a team of one
/// starts none.
///
/// A loop inside a loop of the same team runs on the thread that reaches it.
pub struct Team {
    shared: Arc<Shared>,
    workers: Vec<Started>,
    /// Locked while the workers run a loop.
    in_use: Mutex<()>,
}

/// State shared by the threads of a team. Everything but `post` changes only while `post` is locked.
#[derive(Default)]
struct Shared {
    /// Grows with every call, and at the end.
    call: AtomicUsize,
    /// Number of workers that run the last call.
    inside: AtomicUsize,
    post: Mutex<Post>,
    called: Condvar,
    left: Condvar,
}

#[derive(Default)]
struct Post {
    /// Work of each thread, by its number; present only while a worker may still start it.
    work: Option<&'static (dyn Fn(usize) + Sync)>,
    /// The first panic of a worker in this call.
    panic: Option<Box<dyn Any + Send>>,
    over: bool,
}

impl Team {
    /// Creates a team of so many threads; of fewer if the system does not start them all, which changes no result.
    /// `threads` = 0 means 1.
    pub fn new(threads: usize) -> Self {
        let shared = Arc::new(Shared::default());
        let mut team = Self { shared, workers: Vec::new(), in_use: Mutex::new(()) };
        for number in 1..threads {
            let shared = Arc::clone(&team.shared);
            match thread::start(move || shared.serve(number)) {
                Some(worker) => team.workers.push(worker),
                None => break,
            }
        }
        team
    }

    pub fn threads(&self) -> usize {
        self.workers.len() + 1
    }

    /// Returns `[f(0), …, f(count − 1)]`.
    pub fn map<T: Send>(&self, count: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
        let mut all = Vec::with_capacity(count);
        self.for_each(&mut all.spare_capacity_mut()[..count], |i, place| {
            place.write(f(i));
        });
        // SAFETY: the loop wrote all of them.
        unsafe { all.set_len(count) };
        all
    }

    /// Calls `f(i, &mut items[i])` for every item.
    pub fn for_each<T: Send>(&self, items: &mut [T], f: impl Fn(usize, &mut T) + Sync) {
        self.for_pieces(items, |first, piece| {
            piece.iter_mut().enumerate().for_each(|(i, item)| f(first + i, item));
        });
    }

    /// Calls `f(i, &mut items[i..k])` for pieces that cover all items, for loops whose items share memory.
    pub fn for_pieces<T: Send>(&self, items: &mut [T], f: impl Fn(usize, &mut [T]) + Sync) {
        let threads = self.threads();
        if threads == 1 || items.len() <= 1 {
            return f(0, items);
        }
        let size = items.len().div_ceil(threads * PIECES);
        // Each lock is taken once, so no thread waits for one.
        let pieces: Vec<Mutex<&mut [T]>> = items.chunks_mut(size).map(Mutex::new).collect();
        let share = pieces.len().div_ceil(threads);
        let taken: Vec<AtomicUsize> = (0..threads).map(|_| AtomicUsize::new(0)).collect();
        let take = |t: usize| {
            let p = t * share + taken[t].fetch_add(1, Ordering::Relaxed);
            (p < ((t + 1) * share).min(pieces.len())).then_some(p)
        };
        // A thread starts with its own share, which is local in memory, and continues with others'.
        self.run(&|own: usize| {
            for t in (own..threads).chain(0..own) {
                while let Some(p) = take(t) {
                    f(p * size, &mut pieces[p].lock().expect("a piece is taken once"));
                }
            }
        });
    }

    /// Returns `[f(&mut items[0]), …]`.
    pub fn map_each<T: Send, R: Send>(
        &self,
        items: &mut [T],
        f: impl Fn(&mut T) -> R + Sync,
    ) -> Vec<R> {
        let mut pairs: Vec<(&mut T, Option<R>)> =
            items.iter_mut().map(|item| (item, None)).collect();
        self.for_each(&mut pairs, |_, (item, result)| *result = Some(f(item)));
        pairs.into_iter().map(|pair| pair.1.expect("every item had its turn")).collect()
    }

    /// Calls `work` with 0, and with their numbers on workers that join meanwhile. Any single call completes the
    /// remaining work, so no thread waits for a worker that the system has not scheduled. If the team already runs a
    /// loop, no worker joins.
    fn run(&self, work: &(dyn Fn(usize) + Sync)) {
        let _in_use = match self.in_use.try_lock() {
            Ok(guard) => guard,
            // A panic ended an earlier loop, which was complete by then.
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return work(0),
        };
        // SAFETY: no worker begins with it or uses it after `close`.
        self.shared.open(unsafe { transmute::<&_, &'static _>(work) });
        let own = catch_unwind(AssertUnwindSafe(|| work(0)));
        let theirs = self.shared.close();
        if let Err(panic) = own {
            resume_unwind(panic);
        }
        if let Some(panic) = theirs {
            resume_unwind(panic);
        }
    }
}

impl Drop for Team {
    fn drop(&mut self) {
        let mut post = self.shared.post();
        post.over = true;
        self.shared.call.fetch_add(1, Ordering::Release);
        drop(post);
        self.shared.called.notify_all();
        for worker in self.workers.drain(..) {
            worker.join();
        }
    }
}

impl Shared {
    fn post(&self) -> MutexGuard<'_, Post> {
        self.post.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn open(&self, work: &'static (dyn Fn(usize) + Sync)) {
        let mut post = self.post();
        post.work = Some(work);
        self.call.fetch_add(1, Ordering::Release);
        drop(post);
        self.called.notify_all();
    }

    /// Admits no further worker and waits for those that have started; returns the panic of one of them.
    fn close(&self) -> Option<Box<dyn Any + Send>> {
        self.post().work = None;
        let is_waiting = || self.inside.load(Ordering::Acquire) > 0;
        look_while(is_waiting);
        let mut post = self.post();
        while is_waiting() {
            post = self.left.wait(post).unwrap_or_else(PoisonError::into_inner);
        }
        post.panic.take()
    }

    /// Loop of a worker until the end.
    fn serve(&self, number: usize) {
        let mut seen = 0;
        loop {
            look_while(|| self.call.load(Ordering::Acquire) == seen);
            let mut post = self.post();
            while self.call.load(Ordering::Acquire) == seen {
                post = self.called.wait(post).unwrap_or_else(PoisonError::into_inner);
            }
            if post.over {
                return;
            }
            seen = self.call.load(Ordering::Acquire);
            let Some(work) = post.work else { continue };
            self.inside.fetch_add(1, Ordering::Relaxed);
            drop(post);
            let result = catch_unwind(AssertUnwindSafe(|| work(number)));
            let mut post = self.post();
            if let Err(panic) = result {
                post.panic.get_or_insert(panic);
            }
            if self.inside.fetch_sub(1, Ordering::Release) == 1 {
                self.left.notify_one();
            }
        }
    }
}

fn look_while(waiting: impl Fn() -> bool) {
    for _ in 0..LOOKS {
        if !waiting() {
            return;
        }
        std::hint::spin_loop();
    }
}

/// [`Team::map`] on at most `threads` threads.
pub fn map<T: Send>(threads: usize, count: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    Team::new(threads.min(count)).map(count, f)
}

/// [`Team::for_each`] on at most `threads` threads.
pub fn for_each<T: Send>(threads: usize, items: &mut [T], f: impl Fn(usize, &mut T) + Sync) {
    Team::new(threads.min(items.len())).for_each(items, f);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_independent_of_thread_count() {
        for threads in [0, 1, 2, 3, 8, 100] {
            let team = Team::new(threads);
            assert_eq!(team.threads(), threads.max(1));
            for count in [0, 1, 7, 16, 1000] {
                let expected: Vec<usize> = (0..count).map(|i| i * i).collect();
                assert_eq!(map(threads, count, |i| i * i), expected);
                assert_eq!(team.map(count, |i| i * i), expected);
                let mut squares: Vec<usize> = (0..count).collect();
                for_each(threads, &mut squares, |i, item| *item *= i);
                assert_eq!(squares, expected);
                let more = team.map_each(&mut squares, |item| {
                    *item += 1;
                    *item
                });
                assert_eq!(more, squares);
                assert!(squares.iter().zip(expected).all(|(square, before)| *square == before + 1));
            }
        }
    }

    #[test]
    fn team_handles_short_and_long_waits() {
        let team = Team::new(3);
        for n in 0..2000 {
            if n % 500 == 0 {
                std::thread::sleep(std::time::Duration::from_millis(2));
            }
            assert_eq!(team.map(5, |i| i + n), [n, n + 1, n + 2, n + 3, n + 4]);
        }
    }

    #[test]
    fn nested_loops_run_on_one_thread() {
        let team = Team::new(4);
        let table = team.map(50, |i| team.map(i, |j| i * j));
        for (i, row) in table.iter().enumerate() {
            assert_eq!(*row, (0..i).map(|j| i * j).collect::<Vec<_>>());
        }
    }

    #[test]
    fn team_survives_panics() {
        let team = Team::new(3);
        for at in [0, 60, 99] {
            let give_up = |i: usize| assert!(i != at, "gave up at {i}");
            let panic = catch_unwind(AssertUnwindSafe(|| team.map(100, give_up))).unwrap_err();
            assert_eq!(panic.downcast_ref::<String>(), Some(&format!("gave up at {at}")));
            assert_eq!(team.map(3, |i| 2 * i), [0, 2, 4]);
        }
    }
}
