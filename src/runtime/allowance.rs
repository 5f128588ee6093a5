//! How much a step may compute, and whether it is still wanted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// Updates of unknowns that one communication step may take: hours to a day on one thread.
pub const MOST_UPDATES: f64 = 1e11;
/// Updates after which a step that asks for more than that ends early, where its host lets it: minutes.
pub const EARLY_UPDATES: f64 = 1e9;
/// Updates after which a host that wants to know of a step under way is told: seconds.
pub const PART_UPDATES: f64 = 1e7;
/// What a round of updates costs besides these, in updates: rounds over few unknowns end, too.
const ROUND: f64 = 1e4;

/// Lets another thread end a step that is under way. A single number that any thread may look at and
/// change.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicU8>);

const IDLE: u8 = 0;
const UNDER_WAY: u8 = 1;
const INTERRUPTED: u8 = 2;

impl Interrupt {
    /// Asks the step under way to end; whether there is one.
    pub fn interrupt(&self) -> bool {
        let (success, failure) = (Ordering::Relaxed, Ordering::Relaxed);
        let before = self.0.compare_exchange(UNDER_WAY, INTERRUPTED, success, failure);
        matches!(before, Ok(_) | Err(INTERRUPTED))
    }

    /// Says that a step is under way for as long as the value lives.
    pub fn begin(&self) -> UnderWay<'_> {
        self.0.store(UNDER_WAY, Ordering::Relaxed);
        UnderWay(self)
    }
}

/// A step under way; it is over when this is dropped.
pub struct UnderWay<'a>(&'a Interrupt);

impl Drop for UnderWay<'_> {
    fn drop(&mut self) {
        self.0.0.store(IDLE, Ordering::Relaxed);
    }
}

/// What one step may still compute.
#[derive(Debug)]
pub struct Allowance {
    interrupt: Interrupt,
    /// Updates, as the bits of a number; one thread counts at a time.
    left: AtomicU64,
}

/// Why a step does not go on; what it was to change is as it was before.
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
        /// A length that would have been taken [s], where it is known.
        fits: Option<f64>,
    },
}

/// A length of steps [s], in words.
fn proposal(fits: Option<f64>) -> String {
    fits.map_or(String::new(), |fits| format!(" (of {fits:.0e} s, say)"))
}

/// Part of the longest step that is proposed: work is only known about.
const SURELY: f64 = 0.5;

impl Halt {
    /// Part of a step that was too long which takes some updates, about; nothing where the step ended for
    /// another reason.
    pub fn part_within(&self, updates: f64) -> Option<f64> {
        match *self {
            Halt::TooLong { rounds, size, .. } => Some((updates / cost(rounds, size)).min(1.0)),
            Halt::Interrupted => None,
        }
    }
}

impl Allowance {
    /// Of one communication step.
    pub fn of_step(interrupt: &Interrupt) -> Self {
        Self::of_updates(interrupt, MOST_UPDATES)
    }

    /// Of so many updates.
    pub fn of_updates(interrupt: &Interrupt, updates: f64) -> Self {
        Self { interrupt: interrupt.clone(), left: AtomicU64::new(updates.to_bits()) }
    }

    fn left(&self) -> f64 {
        f64::from_bits(self.left.load(Ordering::Relaxed))
    }

    /// Ends the step if it is known to need more rounds of updates of so many unknowns than are left.
    pub fn foresee(&self, rounds: f64, what: &'static str, size: usize) -> Result<(), Halt> {
        // Numbers that are none are too many, too.
        match cost(rounds, size) <= self.left() {
            true => Ok(()),
            false => Err(Halt::TooLong { rounds, what, size, fits: None }),
        }
    }

    /// The same of all that a step of `dt` [s] takes; a refusal proposes a shorter one.
    pub fn foresee_step(
        &self,
        dt: f64,
        rounds: f64,
        what: &'static str,
        size: usize,
    ) -> Result<(), Halt> {
        self.foresee(rounds, what, size).map_err(|halt| match halt {
            Halt::TooLong { rounds, what, size, .. } => {
                let fits = SURELY * dt * MOST_UPDATES / cost(rounds, size);
                let fits = Some(fits).filter(|fits| fits.is_finite() && *fits > 0.0);
                Halt::TooLong { rounds, what, size, fits }
            }
            halt => halt,
        })
    }

    /// Takes rounds of updates from what is left; to be called between rounds, as this is where a step
    /// is interrupted.
    pub fn spend(&self, rounds: f64, what: &'static str, size: usize) -> Result<(), Halt> {
        if self.interrupt.0.load(Ordering::Relaxed) == INTERRUPTED {
            return Err(Halt::Interrupted);
        }
        self.foresee(rounds, what, size)?;
        self.left.store((self.left() - cost(rounds, size)).to_bits(), Ordering::Relaxed);
        Ok(())
    }
}

impl Default for Allowance {
    /// Of a step that nobody interrupts.
    fn default() -> Self {
        Self::of_step(&Interrupt::default())
    }
}

/// Updates that rounds over so many unknowns count for.
pub fn cost(rounds: f64, size: usize) -> f64 {
    rounds * (size as f64 + ROUND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_becomes_less_and_ends_a_step() {
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
    }

    #[test]
    fn a_step_that_is_too_long_tells_which_part_of_it_fits() {
        let allowance = Allowance::of_updates(&Interrupt::default(), EARLY_UPDATES);
        let halt = allowance.foresee(1e6, "rounds", 0).unwrap_err();
        assert_eq!(halt.part_within(EARLY_UPDATES), Some(0.1));
        allowance.foresee(0.99e5, "rounds", 0).unwrap();
        let halt = allowance.foresee(f64::INFINITY, "rounds", 0).unwrap_err();
        assert_eq!(halt.part_within(EARLY_UPDATES), Some(0.0));
        assert_eq!(Halt::Interrupted.part_within(EARLY_UPDATES), None);
    }

    #[test]
    fn a_step_that_is_proposed_is_taken() {
        let allowance = Allowance::default();
        let halt = allowance.foresee_step(2.0, 1e9, "rounds", 90_000).unwrap_err();
        let Halt::TooLong { fits: Some(fits), .. } = halt else { panic!("{halt}") };
        assert!(halt.to_string().contains("(of 1e-3 s, say)"), "{halt}");
        assert_eq!(allowance.foresee_step(fits, 1e9 * fits / 2.0, "rounds", 90_000), Ok(()));
    }

    #[test]
    fn only_a_step_under_way_is_interrupted() {
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
