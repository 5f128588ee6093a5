//! Reasons why a droplet could not be advanced.

use super::kick::{FARTHEST, FASTEST};
use crate::math::conjugate_gradients::NotConverged;
use crate::quantity::kelvin;
use crate::runtime::allowance::Halt;

/// A step without physical meaning; the state is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    #[error(
        "the fluid is compressed to {ratio:.3} of its density at rest at x = {:.3e}, y = {:.3e}, z = {:.3e} m, t = {time:.6e} s: the speed of sound is too low for this flow", .at[0], .at[1], .at[2]
    )]
    Density { ratio: f64, at: [f64; 3], time: f64 },
    #[error("a particle's {quantity} is not finite at t = {time:.6e} s")]
    NotFinite { quantity: &'static str, time: f64 },
    #[error(
        "65 535 or more particles surround a block of 128 at x = {:.3e}, y = {:.3e}, z = {:.3e} m, t = {time:.6e} s: the flow is no longer resolved", .at[0], .at[1], .at[2]
    )]
    Crowded { at: [f64; 3], time: f64 },
    #[error(
        "a particle is {FARTHEST:.0e} support radii away at t = {time:.6e} s, beyond which rounding makes positions inaccurate"
    )]
    OutOfRange { time: f64 },
    #[error(
        "a particle moves at {ratio:.3e} times the speed of sound at t = {time:.6e} s (allowed: less than {FASTEST}): the speed of sound is too low for this flow"
    )]
    TooFast { ratio: f64, time: f64 },
    #[error(
        "a particle would cool to {} at t = {time:.6e} s, not above absolute zero: the body below absorbs more heat than the particle holds",
        kelvin(*temperature)
    )]
    BelowAbsoluteZero { temperature: f64, time: f64 },
    #[error(
        "nozzle and fluid move at {speed:.3e} m/s at t = {time:.6e} s (allowed: up to {most:.3e} m/s, a fifth of the speed of \
         sound; a higher `sound_speed` of the fluid allows more)"
    )]
    NozzleTooFast { speed: f64, most: f64, time: f64 },
    #[error(
        "viscosity at t = {time:.6e} s: {reason} (allowed: viscosities that differ less from place to place, or \
         `pressure = \"explicit\"`, whose steps are shorter)"
    )]
    Viscosity { reason: NotConverged, time: f64 },
    #[error("the recorded drop is invalid: {reason}")]
    Unrecorded { reason: String },
    #[error("{0}")]
    Halted(#[from] Halt),
}
