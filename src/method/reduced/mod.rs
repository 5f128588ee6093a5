//! Balanced truncation of modal systems `ẋ = −Λ x + B u`, `y = C x + D u` with a bound of its error.
//!
//! [`clumped`] replaces many modes by few rates, [`balanced`] truncates what is left, [`certificate`] bounds the error
//! that both make, and [`system`] is the result: a few scalar equations that advance exactly. `stored` makes numbers of
//! these that are kept, and looks at those that come back.

pub mod balanced;
pub mod certificate;
pub mod clumped;
mod stored;
pub mod system;

pub use balanced::{Balanced, ReductionError};
pub use certificate::integral;
pub use clumped::{Clumped, Residues};
pub use system::{Ranges, ReducedSystem, Request};
