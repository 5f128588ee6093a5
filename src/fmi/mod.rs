//! The C ABI of units under FMI 2.0 and FMI 3.0, and the XML that belongs to it.
//!
//! A call comes in through one of the exported functions of [`two`] or [`three`], whose [`table`] says when it is
//! allowed. It passes the [`gate`] (valid pointer, legal in this phase, panics caught, floating-point environment
//! of our own) and is done by [`unit::Unit`], which is plain safe Rust and the same for both. A refused call
//! answers `fmi2Error` or `fmi3Error` with one line in the log and changes nothing, the phase included, so a
//! master may correct its arguments and call again.

mod description;
mod gate;
mod table;
mod unit;

/// Program and version, as they stand in every library that serves units.
pub const MARK: &str = concat!("impinge ", env!("CARGO_PKG_VERSION"));

pub mod guid;
pub mod terminals;
pub mod three;
pub mod two;
