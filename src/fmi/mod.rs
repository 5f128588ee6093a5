//! The C ABI of units under FMI 2.0 and FMI 3.0, and the XML that belongs to it.
//!
//! A call enters through one of the exported functions of [`two`] or [`three`], whose [`table`] lists the phases that
//! allow it. It passes the [`gate`]: valid pointer, legal in this phase, panics caught, floating-point environment of
//! our own. [`unit::Unit`] executes it in plain safe Rust, the same for both versions. A refused call returns
//! `fmi2Error` or `fmi3Error` with one line in the log. It changes nothing, not even the phase, so a master may correct
//! its arguments and call again.

mod description;
mod gate;
mod table;
mod unit;

/// Program and version, embedded in every library that serves units.
pub const RELEASE: &str = concat!("impinge ", env!("CARGO_PKG_VERSION"));

/// The same with a checksum of the sources: libraries of one build for several platforms have it in common.
pub const MARK: &str =
    concat!("impinge ", env!("CARGO_PKG_VERSION"), " (sources ", env!("IMPINGE_SOURCES"), ")");

pub mod guid;
pub mod terminals;
pub mod three;
pub mod two;
