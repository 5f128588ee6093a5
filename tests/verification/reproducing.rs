//! Reproducing-kernel discretisations beside closed forms, with their orders of convergence.

#[path = "../reproducing/approximation.rs"]
mod approximation;
#[path = "../reproducing/cantilever.rs"]
mod cantilever;
#[path = "../reproducing/closed_forms.rs"]
pub mod closed_forms;
#[allow(dead_code)]
#[path = "../reproducing/linear.rs"]
mod linear;
#[path = "../reproducing/orders.rs"]
mod orders;
#[path = "../reproducing/poisson.rs"]
mod poisson;
