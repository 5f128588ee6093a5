//! Why a droplet could not be advanced.

/// A step that would have no physical meaning; the state is as it was before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    #[error(
        "the fluid is compressed to {ratio:.3} of its density at rest at x = {:.3e}, y = {:.3e}, z = {:.3e} m, t = {time:.6e} s: the speed of sound is too low for this flow", .at[0], .at[1], .at[2]
    )]
    Density { ratio: f64, at: [f64; 3], time: f64 },
    #[error("a particle's {quantity} is not finite at t = {time:.6e} s")]
    NotFinite { quantity: &'static str, time: f64 },
}
