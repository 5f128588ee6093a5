//! The C ABI of FMI 3.0 for the same units, and their XML: arrays instead of families of scalars.
//!
//! [`table`] has a row for each function that acts on an instance; those with a body are in the other files.

mod callbacks;
mod dependencies;
mod derivatives;
mod events;
mod life_cycle;
mod states;
mod step;
pub(super) mod table;
mod types;
mod variables;

pub mod xml;

/// Names of the exported functions of FMI 3.0 that act on an instance.
pub fn functions() -> impl Iterator<Item = &'static str> {
    use crate::fmi::table::Function;
    table::Fmi3::ALL.iter().map(|function| function.name())
}
