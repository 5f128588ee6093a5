//! Balanced truncation of modal systems `ẋ = −Λ x + B u`, `y = C x + D u` with an error bound.
//!
//! [`clumped`] replaces many modes by few rates, [`balanced`] truncates the result, [`certificate`]
//! bounds the error of both, and [`system`] is the reduced system: a few scalar equations that
//! advance exactly. `stored` serialises reduced systems and checks them when they are read.

pub mod balanced;
pub mod certificate;
pub mod clumped;
mod stored;
pub mod system;

pub use balanced::{Balanced, ReductionError};
pub use certificate::integral;
pub use clumped::{Clumped, Residues};
pub use system::{Ranges, ReducedSystem, Request};
