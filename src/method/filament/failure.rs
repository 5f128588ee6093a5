//! Reasons why a strand cannot be laid.

use crate::limits::number;
use crate::quantity::kelvin;

/// Reasons why a step of a filament has no physical meaning.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    #[error(
        "the outlet of the nozzle is at z = {} m {when} (allowed: {} m above the plate, and more)",
        number(*height),
        number(*least)
    )]
    NozzleInPlate { height: f64, least: f64, when: &'static str },
    #[error(
        "{} m³ would have come, more than `most`, {} m³ (allowed: less flow, a shorter run or a larger `most`)",
        number(*volume),
        number(*most)
    )]
    BeyondMost { volume: f64, most: f64 },
    #[error(
        "the strand has {segments} segments, twice as many as `most` has in one piece, because the flow stops and starts \
         often (allowed: fewer interruptions, a larger `most` or a smaller `spacing`)"
    )]
    Full { segments: usize },
    #[error("the flow of the nozzle falls to {} m³/s (allowed: 0 and more)", number(*flow))]
    NegativeFlow { flow: f64 },
    #[error("the fluid comes at {}, below absolute zero", kelvin(*temperature))]
    BelowAbsoluteZero { temperature: f64 },
    #[error(
        "the fluid comes at {}, frozen (allowed: above its liquidus, {})",
        kelvin(*temperature),
        kelvin(*liquidus)
    )]
    Frozen { temperature: f64, liquidus: f64 },
}
