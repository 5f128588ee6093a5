//! Closed-form solutions that tests, benches and examples verify the models against, one family a
//! file. SI units; stress is positive in tension; depth `z` is positive into the body.
//!
//! | family | solutions |
//! |---|---|
//!
//! [`medium`] holds the constants they share, [`special`] the special functions and
//! [`quadrature`] the integrals that no closed form is known for.

pub mod medium;
pub mod quadrature;
pub mod special;

#[cfg(test)]
mod checks;

pub use medium::{Conductor, Elastic};
