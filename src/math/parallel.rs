//! Loops over threads: the only threads there are.
//!
//! Every item is computed by itself and stored in its own place, so results do not depend on how
//! many threads there are.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Name of the threads of these loops.
pub const WORKER: &str = "impinge worker";

/// Pieces into which each thread's share of a loop is cut, for others to take when they are done.
const PIECES: usize = 16;

/// `[f(0), …, f(count − 1)]` on at most `threads` threads.
pub fn map<T: Send>(threads: usize, count: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = threads.clamp(1, count.max(1));
    if threads == 1 {
        return (0..count).map(f).collect();
    }
    let size = count.div_ceil(threads * PIECES);
    let mut pieces: Vec<Vec<T>> = (0..count.div_ceil(size)).map(|_| Vec::new()).collect();
    for_each(threads, &mut pieces, |p, piece| {
        *piece = (p * size..((p + 1) * size).min(count)).map(&f).collect();
    });
    let mut all = Vec::with_capacity(count);
    pieces.into_iter().for_each(|piece| all.extend(piece));
    all
}

/// `f(i, &mut items[i])` for every item on at most `threads` threads.
pub fn for_each<T: Send>(threads: usize, items: &mut [T], f: impl Fn(usize, &mut T) + Sync) {
    let threads = threads.clamp(1, items.len().max(1));
    if threads == 1 {
        return items.iter_mut().enumerate().for_each(|(i, item)| f(i, item));
    }
    let size = items.len().div_ceil(threads * PIECES);
    // Each lock is taken once, so nobody waits for one.
    let pieces: Vec<Mutex<&mut [T]>> = items.chunks_mut(size).map(Mutex::new).collect();
    let share = pieces.len().div_ceil(threads);
    let taken: Vec<AtomicUsize> = (0..threads).map(|_| AtomicUsize::new(0)).collect();
    let take = |t: usize| {
        let p = t * share + taken[t].fetch_add(1, Ordering::Relaxed);
        (p < ((t + 1) * share).min(pieces.len())).then_some(p)
    };
    // A thread does its own share first, which keeps to its own part of memory, then others'.
    let work = |own: usize| {
        for t in (own..threads).chain(0..own) {
            while let Some(p) = take(t) {
                let mut piece = pieces[p].lock().expect("a piece is taken once");
                piece.iter_mut().enumerate().for_each(|(i, item)| f(p * size + i, item));
            }
        }
    };
    let work = &work;
    thread::scope(|scope| {
        let workers: Vec<_> = (1..threads)
            .map(|t| {
                let worker = thread::Builder::new().name(WORKER.into());
                worker.spawn_scoped(scope, move || work(t)).expect("the system starts a thread")
            })
            .collect();
        work(0);
        for worker in workers {
            if let Err(panic) = worker.join() {
                std::panic::resume_unwind(panic);
            }
        }
    });
}

/// `[f(&mut items[0]), …]` on at most `threads` threads.
pub fn map_each<T: Send, R: Send>(
    threads: usize,
    items: &mut [T],
    f: impl Fn(&mut T) -> R + Sync,
) -> Vec<R> {
    let mut pairs: Vec<(&mut T, Option<R>)> = items.iter_mut().map(|item| (item, None)).collect();
    for_each(threads, &mut pairs, |_, (item, result)| *result = Some(f(item)));
    pairs.into_iter().map(|pair| pair.1.expect("every item had its turn")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_kept_on_any_number_of_threads() {
        for threads in [0, 1, 2, 3, 8, 100] {
            for count in [0, 1, 7, 16] {
                let expected: Vec<usize> = (0..count).map(|i| i * i).collect();
                assert_eq!(map(threads, count, |i| i * i), expected);
                let mut squares: Vec<usize> = (0..count).collect();
                for_each(threads, &mut squares, |i, item| *item *= i);
                assert_eq!(squares, expected);
                let more = map_each(threads, &mut squares, |item| {
                    *item += 1;
                    *item
                });
                assert_eq!(more, squares);
                assert!(squares.iter().zip(expected).all(|(square, before)| *square == before + 1));
            }
        }
    }
}
