//! The FMI 3.0 C ABI of the same units, and their XML: arrays instead of families of scalars.
//!
//! The functions exported here (`common`, `variables`, `absent`, `dependencies`, `states`, `derivatives`,
//! `step`, `other_modes`) go through the gate of [`super::instance`] under a table of their own
//! ([`legality`]) to the same [`super::unit::Unit`]; `values` lays its scalars out as arrays.

mod absent;
mod common;
mod dependencies;
mod derivatives;
mod legality;
mod other_modes;
mod states;
mod step;
mod types;
mod values;
mod variables;

pub mod xml;
