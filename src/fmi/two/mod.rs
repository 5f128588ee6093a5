//! The C ABI of FMI 2.0, and its XML.
//!
//! [`table`] has a row for each function that acts on an instance; those with a body are in the other files.

mod derivatives;
mod life_cycle;
mod logger;
mod states;
mod step;
pub(super) mod table;
mod types;
mod uri;
mod variables;

pub mod xml;

/// Names of the exported functions of FMI 2.0 that act on an instance.
pub fn functions() -> impl Iterator<Item = &'static str> {
    use crate::fmi::table::Function;
    table::Fmi2::ALL.iter().map(|function| function.name())
}
