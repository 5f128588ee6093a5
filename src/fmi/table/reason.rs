//! Reasons of functions that only refuse.

use crate::fmi::gate::answer::Refusal;

/// Reason why a function is always refused.
#[derive(Debug, Clone, Copy)]
pub enum Reason {
    ModelExchange,
    NothingPending,
    ScheduledExecution,
    NoEvents,
    NoEventMode,
    NoDiscreteStates,
    NoClocks,
    NoStructuralParameters,
}

impl From<Reason> for Refusal {
    fn from(reason: Reason) -> Self {
        Refusal::error(match reason {
            Reason::ModelExchange => "belongs to model exchange; this unit is for co-simulation",
            Reason::NothingPending => "no step is pending",
            Reason::ScheduledExecution => {
                "belongs to scheduled execution; this unit is for co-simulation"
            }
            Reason::NoEvents => "this unit has no Event Mode: nothing in it cracks",
            Reason::NoEventMode => "the instance was made without eventModeUsed",
            Reason::NoDiscreteStates => "this unit has no discrete states to evaluate",
            Reason::NoClocks => "this unit has no clocks",
            Reason::NoStructuralParameters => "this unit has no structural parameters",
        })
    }
}
