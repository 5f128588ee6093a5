//! Types of variables under both versions of the standard, and refusals of mismatches.

use crate::fmi::gate::answer::{Answer, Reference, Refusal};
use crate::variables::Slot;

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Real,
    Integer,
    Text,
}

impl Kind {
    /// Returns the type of a variable by its slot.
    pub fn of(slot: &Slot) -> Self {
        match slot {
            Slot::Threads => Kind::Integer,
            Slot::OutputDirectory => Kind::Text,
            Slot::Parameter(_) | Slot::Input(_) | Slot::Output(_) => Kind::Real,
        }
    }

    /// Name of the type under FMI 2.0, where variables are scalars.
    pub fn of_scalars(self) -> &'static str {
        match self {
            Kind::Real => "Real",
            Kind::Integer => "Integer",
            Kind::Text => "String",
        }
    }

    /// Name of the type under FMI 3.0, where variables are arrays.
    pub fn of_arrays(self) -> &'static str {
        match self {
            Kind::Real => "Float64",
            Kind::Integer => "Int32",
            Kind::Text => "String",
        }
    }
}

/// Refuses a variable whose type is not that of a function.
pub fn wrong_type(name: &str, wanted: &str, found: &str) -> Refusal {
    Refusal::error(format!("{name} is no {wanted} but a {found}"))
}

/// Looks a variable up by its reference.
pub fn look_up<T>(variables: &[T], reference: Reference) -> Answer<&T> {
    variables.get(reference as usize).ok_or_else(|| {
        let last = variables.len().saturating_sub(1);
        Refusal::error(format!("value reference {reference} is unknown; there are 0 to {last}"))
    })
}
