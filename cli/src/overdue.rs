//! Notice that a run takes far longer than its forecast.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use indicatif::ProgressBar;

use super::messages;
use super::units::lasting;

/// Time of a run over its forecast, and least time [s], after which the notice is printed.
const FACTOR: f64 = 5.0;
const LEAST: f64 = 10.0;

/// Prints a notice once if a run is under way longer than expected; until it is dropped.
pub struct Overdue {
    done: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Overdue {
    /// Begins to watch a run of an expected duration [s], whose completed steps a bar counts.
    pub fn watch(expected: f64, progress: &ProgressBar) -> Self {
        let (done, is_done) = mpsc::channel();
        let limit = LEAST.max(FACTOR * expected);
        let progress = progress.clone();
        let wait = move || {
            let time = Duration::try_from_secs_f64(limit).unwrap_or(Duration::MAX);
            if is_done.recv_timeout(time) == Err(RecvTimeoutError::Timeout) {
                let (step, steps) = (progress.position() + 1, progress.length().unwrap_or(0));
                let note = notice(limit, expected, (step.min(steps), steps));
                progress.suspend(|| messages::print_in_passing("note", &note));
            }
        };
        // Without a thread the run has no notice.
        let thread = thread::Builder::new().spawn(wait).ok();
        Self { done: Some(done), thread }
    }
}

impl Drop for Overdue {
    fn drop(&mut self) {
        self.done.take();
        if let Some(thread) = self.thread.take() {
            // A notice that failed is no reason to end a run.
            let _ = thread.join();
        }
    }
}

fn notice(spent: f64, expected: f64, (step, steps): (u64, u64)) -> String {
    format!(
        "step {step} of {steps} is under way after {}, while the forecast of the whole run is {}: this run is costlier than \
         the forecast assumes; shorter steps show its progress",
        lasting(spent),
        lasting(expected)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notice_has_both_times_and_the_step() {
        let text = notice(10.0, 0.043, (1, 10));
        assert!(text.starts_with("step 1 of 10 is under way after 10 s"), "{text}");
        assert!(text.contains("the forecast of the whole run is 43 ms"), "{text}");
    }

    #[test]
    fn watch_ends_with_the_run() {
        let progress = ProgressBar::hidden();
        drop(Overdue::watch(1e9, &progress));
        drop(Overdue::watch(f64::INFINITY, &progress));
    }
}
