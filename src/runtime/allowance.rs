//! Computing budget of a step, and its interruption.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// Largest number of updates of unknowns in one communication step: hours to a day on one thread.
pub const MOST_UPDATES: f64 = 1e11;
/// Number of updates, minutes of work, after which an even longer step ends early if its host allows that.
pub const EARLY_UPDATES: f64 = 1e9;
/// Number of updates, seconds of work, after which a host with progress callbacks is notified.
pub const PART_UPDATES: f64 = 1e7;
/// Overhead of a round, in updates: it also bounds rounds over few unknowns.
const ROUND: f64 = 1e4;

/// Lets another thread interrupt a running step: a single number that any thread may read and change.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicU8>);

const IDLE: u8 = 0;
const UNDER_WAY: u8 = 1;
const INTERRUPTED: u8 = 2;

impl Interrupt {
    /// Requests the running step to end; returns true if there is one.
    pub fn interrupt(&self) -> bool {
        let (success, failure) = (Ordering::Relaxed, Ordering::Relaxed);
        let before = self.0.compare_exchange(UNDER_WAY, INTERRUPTED, success, failure);
        matches!(before, Ok(_) | Err(INTERRUPTED))
    }

    /// Marks a step as running for the lifetime of the returned value.
    pub fn begin(&self) -> UnderWay<'_> {
        self.0.store(UNDER_WAY, Ordering::Relaxed);
        UnderWay(self)
    }
}

/// A running step; it ends when this is dropped.
pub struct UnderWay<'a>(&'a Interrupt);

impl Drop for UnderWay<'_> {
    fn drop(&mut self) {
        self.0.0.store(IDLE, Ordering::Relaxed);
    }
}

/// Remaining computing budget of a step.
#[derive(Debug)]
pub struct Allowance {
    interrupt: Interrupt,
    /// Number of updates, as the bits of a float; only one thread at a time counts.
    left: AtomicU64,
    /// Number of times that bodies in contact were tried.
    exchanges: AtomicU64,
}

/// Reason why a step stopped; its state is unchanged.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Halt {
    #[error("the step was cancelled")]
    Interrupted,
    #[error(
        "{rounds:.1e} {what} over {size} unknowns are more than a communication step may take \
         (allowed: {MOST_UPDATES:.0e} updates of unknowns and {:.0e} rounds in all): take shorter \
         communication steps{}, or look for an extreme value",
        MOST_UPDATES / ROUND,
        proposal(*.fits)
    )]
    TooLong {
        rounds: f64,
        what: &'static str,
        size: usize,
        /// A feasible step length [s], if known.
        fits: Option<f64>,
    },
    #[error(
        "{what} have taken more than a communication step may take (allowed: {MOST_UPDATES:.0e} updates of unknowns and \
         {:.0e} rounds in all): take shorter communication steps in which loads change less, or look for an extreme \
         value",
        MOST_UPDATES / ROUND
    )]
    UsedUp { rounds: f64, what: &'static str, size: usize },
}

/// Proposes a step length [s], in words.
fn proposal(fits: Option<f64>) -> String {
    fits.map_or(String::new(), |fits| format!(" (of {fits:.0e} s, say)"))
}

/// Fraction of the longest step that is proposed, because its work is only an estimate.
const SAFETY_FACTOR: f64 = 0.5;

impl Halt {
    /// Fraction of a too long step that takes about so many updates; `None` if the step ended for another reason.
    pub fn part_within(&self, updates: f64) -> Option<f64> {
        match *self {
            Halt::TooLong { rounds, size, .. } | Halt::UsedUp { rounds, size, .. } => {
                Some((updates / cost(rounds, size)).min(1.0))
            }
            Halt::Interrupted => None,
        }
    }
}

impl Allowance {
    /// Budget of one communication step.
    pub fn of_step(interrupt: &Interrupt) -> Self {
        Self::of_updates(interrupt, MOST_UPDATES)
    }

    /// Budget of so many updates.
    pub fn of_updates(interrupt: &Interrupt, updates: f64) -> Self {
        Self {
            interrupt: interrupt.clone(),
            left: AtomicU64::new(updates.to_bits()),
            exchanges: AtomicU64::new(0),
        }
    }

    fn left(&self) -> f64 {
        f64::from_bits(self.left.load(Ordering::Relaxed))
    }

    /// Counts a trial of the fluxes between bodies in contact.
    pub fn note_exchange(&self) {
        self.exchanges.fetch_add(1, Ordering::Relaxed);
    }

    /// Number of trials of the fluxes between bodies in contact so far.
    pub fn exchanges(&self) -> u64 {
        self.exchanges.load(Ordering::Relaxed)
    }

    /// Stops the step if it will need more rounds of updates than the budget allows.
    pub fn foresee(&self, rounds: f64, what: &'static str, size: usize) -> Result<(), Halt> {
        // NaN also counts as too many.
        match cost(rounds, size) <= self.left() {
            true => Ok(()),
            false => Err(Halt::TooLong { rounds, what, size, fits: None }),
        }
    }

    /// Same for the whole of a step of `dt` [s]; the refusal proposes a shorter one.
    pub fn foresee_step(
        &self,
        dt: f64,
        rounds: f64,
        what: &'static str,
        size: usize,
    ) -> Result<(), Halt> {
        self.foresee(rounds, what, size).map_err(|halt| match halt {
            Halt::TooLong { rounds, what, size, .. } => {
                let fits = SAFETY_FACTOR * dt * MOST_UPDATES / cost(rounds, size);
                let fits = Some(fits).filter(|fits| fits.is_finite() && *fits > 0.0);
                Halt::TooLong { rounds, what, size, fits }
            }
            halt => halt,
        })
    }

    /// Subtracts rounds of updates from the budget. Call it between rounds: here a step is interrupted.
    pub fn spend(&self, rounds: f64, what: &'static str, size: usize) -> Result<(), Halt> {
        if self.interrupt.0.load(Ordering::Relaxed) == INTERRUPTED {
            return Err(Halt::Interrupted);
        }
        let left = self.left() - cost(rounds, size);
        // NaN also counts as too many.
        if left >= 0.0 {
            self.left.store(left.to_bits(), Ordering::Relaxed);
            return Ok(());
        }
        Err(Halt::UsedUp { rounds, what, size })
    }
}

impl Default for Allowance {
    /// Budget of a step that cannot be interrupted.
    fn default() -> Self {
        Self::of_step(&Interrupt::default())
    }
}

/// Cost in updates of rounds over so many unknowns.
pub fn cost(rounds: f64, size: usize) -> f64 {
    rounds * (size as f64 + ROUND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn allowance_decreases_and_ends_a_step() {
        let allowance = Allowance::default();
        for _ in 0..10 {
            allowance.spend(9e5, "rounds", 0).unwrap();
        }
        allowance.foresee(9.9e5, "rounds", 0).unwrap();
        for (rounds, size) in [(1.1e6, 0), (1.0, 20_000_000_000), (f64::NAN, 1)] {
            let halt = allowance.foresee(rounds, "rounds", size);
            assert!(matches!(halt, Err(Halt::TooLong { .. })), "{rounds} {size}: {halt:?}");
        }
        assert!(allowance.foresee(f64::INFINITY, "rounds", 1).is_err());
        // What was used up counts, not what the last round would have taken.
        let halt = allowance.spend(1.1e6, "rounds", 0).unwrap_err();
        assert!(
            matches!(halt, Halt::UsedUp { .. })
                && halt.to_string().starts_with("rounds have taken more")
        );
    }

    #[test]
    fn too_long_a_step_reports_the_feasible_fraction() {
        let allowance = Allowance::of_updates(&Interrupt::default(), EARLY_UPDATES);
        let halt = allowance.foresee(1e6, "rounds", 0).unwrap_err();
        assert_eq!(halt.part_within(EARLY_UPDATES), Some(0.1));
        allowance.foresee(0.99e5, "rounds", 0).unwrap();
        let halt = allowance.foresee(f64::INFINITY, "rounds", 0).unwrap_err();
        assert_eq!(halt.part_within(EARLY_UPDATES), Some(0.0));
        assert_eq!(Halt::Interrupted.part_within(EARLY_UPDATES), None);
    }

    #[test]
    fn proposed_step_is_accepted() {
        let allowance = Allowance::default();
        let halt = allowance.foresee_step(2.0, 1e9, "rounds", 90_000).unwrap_err();
        let Halt::TooLong { fits: Some(fits), .. } = halt else { panic!("{halt}") };
        assert!(halt.to_string().contains("(of 1e-3 s, say)"), "{halt}");
        assert_eq!(allowance.foresee_step(fits, 1e9 * fits / 2.0, "rounds", 90_000), Ok(()));
    }

    #[test]
    fn only_a_running_step_is_interrupted() {
        let interrupt = Interrupt::default();
        let allowance = Allowance::of_step(&interrupt);
        assert!(!interrupt.interrupt());
        assert_eq!(allowance.spend(1.0, "rounds", 1), Ok(()));
        let step = interrupt.begin();
        assert_eq!(allowance.spend(1.0, "rounds", 1), Ok(()));
        assert!(interrupt.interrupt() && interrupt.interrupt());
        assert_eq!(allowance.spend(1.0, "rounds", 1), Err(Halt::Interrupted));
        drop(step);
        assert!(!interrupt.interrupt());
        assert_eq!(allowance.spend(1.0, "rounds", 1), Ok(()));
    }
}
