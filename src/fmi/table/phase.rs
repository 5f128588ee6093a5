//! Phases of an instance.

/// Phase of an instance, a state of the co-simulation state machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    Instantiated,
    InitializationMode,
    StepComplete,
    /// Seen only by calls during another call on the same instance.
    StepInProgress,
    StepFailed,
    StepCanceled,
    Terminated,
    Error,
    Fatal,
    /// Event Mode of FMI 3.0.
    EventMode,
}

impl Phase {
    /// All phases, ordered by their numbers in the bytes of saved states.
    pub const ALL: [Phase; 10] = [
        Phase::Instantiated,
        Phase::InitializationMode,
        Phase::StepComplete,
        Phase::StepInProgress,
        Phase::StepFailed,
        Phase::StepCanceled,
        Phase::Terminated,
        Phase::Error,
        Phase::Fatal,
        Phase::EventMode,
    ];

    /// Returns true while time goes on: between initialisation and termination, unless a step has failed.
    pub fn is_running(self) -> bool {
        matches!(self, Phase::StepComplete | Phase::EventMode)
    }

    /// Returns true if an instance can stay in this phase between calls, and so be saved in it.
    pub fn lasts(self) -> bool {
        !matches!(self, Phase::StepInProgress | Phase::Fatal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_listed_in_their_order() {
        assert!(Phase::ALL.into_iter().enumerate().all(|(i, phase)| phase as usize == i));
    }
}
