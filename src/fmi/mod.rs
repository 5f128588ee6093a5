//! The FMI 2.0 C ABI, and what belongs to it: legality of calls, log, GUID and XML; in [`three`] that of
//! FMI 3.0.
//!
//! A call comes in through one of the exported functions (`common`, `variables`, `step`, `states`,
//! `derivatives`, `model_exchange`), passes the gate in [`instance`] (valid pointer, legal in this phase, panics
//! caught, floating-point environment of our own) and is done by [`unit::Unit`], which is plain safe Rust. A refused call answers
//! `fmi2Error` with one line in the log and changes nothing, the phase included, so a master may
//! correct its arguments and call again.

mod adjoint;
mod common;
mod derivatives;
mod float_environment;
mod instance;
mod legality;
mod log;
mod model_exchange;
mod panics;
mod rates;
mod refused;
mod saved;
mod set_up;
mod state_bytes;
mod states;
mod step;
mod step_control;
mod types;
mod unit;
mod uri;
mod values;
mod variables;

/// Program and version, as they stand in every library that serves units.
pub const MARK: &str = concat!("impinge ", env!("CARGO_PKG_VERSION"));

pub mod guid;
pub mod terminals;
pub mod three;
pub mod xml;
