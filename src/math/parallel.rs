//! Loops over threads: the only threads there are.
//!
//! Every item is computed by itself and stored in its own place, so results do not depend on how
//! many threads there are.

use std::thread;

/// Name of the threads of these loops.
pub const WORKER: &str = "impinge worker";

/// `[f(0), …, f(count − 1)]`, in equal shares on at most `threads` threads.
pub fn map<T: Send>(threads: usize, count: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = threads.clamp(1, count.max(1));
    if threads == 1 {
        return (0..count).map(f).collect();
    }
    let share = count.div_ceil(threads);
    let f = &f;
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|t| {
                let range = t * share..((t + 1) * share).min(count);
                let share = move || range.map(f).collect::<Vec<T>>();
                let worker = thread::Builder::new().name(WORKER.into());
                worker.spawn_scoped(scope, share).expect("the system starts a thread")
            })
            .collect();
        let joined = workers.into_iter().map(|worker| match worker.join() {
            Ok(part) => part,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        joined.flatten().collect()
    })
}

/// `f(i, &mut items[i])` for every item, in equal shares on at most `threads` threads.
pub fn for_each<T: Send>(threads: usize, items: &mut [T], f: impl Fn(usize, &mut T) + Sync) {
    let threads = threads.clamp(1, items.len().max(1));
    let share = items.len().div_ceil(threads).max(1);
    let run = |first: usize, part: &mut [T]| {
        part.iter_mut().enumerate().for_each(|(i, item)| f(first + i, item));
    };
    if threads == 1 {
        return run(0, items);
    }
    let run = &run;
    thread::scope(|scope| {
        for (t, part) in items.chunks_mut(share).enumerate() {
            let worker = thread::Builder::new().name(WORKER.into());
            let work = move || run(t * share, part);
            worker.spawn_scoped(scope, work).expect("the system starts a thread");
        }
    });
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
            }
        }
    }
}
