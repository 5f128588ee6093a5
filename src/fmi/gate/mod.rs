//! The gate between the C ABI and [`Unit`](super::unit::Unit), the same for every version of the standard.
//!
//! Every exported function has one contract with its host. An instance is null or was created by this library; other
//! pointers are null or valid by the standard. [`gated!`] relies on it.

pub mod answer;
pub mod arguments;
pub mod float_environment;
pub mod instance;
pub mod life_cycle;
pub mod log;
pub mod panics;
pub mod refusing;
pub mod set_up;
pub mod states;

/// Calls a closure on the unit behind a handle, if the table allows the function now: the body of an exported
/// function.
macro_rules! gated {
    ($handle:expr, $function:expr, $body:expr $(,)?) => {
        // SAFETY: by the contract of exported functions.
        unsafe { $crate::fmi::gate::instance::call($handle, $function, $body) }
    };
}
pub(super) use gated;
