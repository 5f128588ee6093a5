//! Balanced truncation of modal systems `ẋ = −Λ x + B u`, `y = C x + D u` with a bound of its error.
//!
//! [`clumped`] replaces many modes by few rates, [`balanced`] truncates what is left, [`certificate`] bounds the error
//! that both make, and [`system`] is the result: a few scalar equations that advance exactly.

pub mod balanced;
pub mod certificate;
pub mod clumped;
pub mod system;

pub use balanced::{Balanced, ReductionError};
pub use certificate::integral;
pub use clumped::{Clumped, Residues};
pub use system::{Ranges, ReducedSystem, Request};
