//! Nonlinear conduction of heat on a structured mesh: constants that depend on the temperature, latent heat, radiation.
//!
//! `∂H/∂t = ∇·∇θ` with the volumetric enthalpy `H(T) = ∫ ρ c dT + ρ L f(T)` [J/m³] and the heat conductivity integral
//! `θ(T) = ∫ k dT` [W/m] of each material. Linear elements on all nodes with integrals by the trapezoidal rule: the
//! enthalpy of a node stands for that of the volume next to it, and the heat between two nodes is the difference of
//! their θ, so temperatures keep to the range of what makes them. At second order in the distances of nodes.
//!
//! Time goes by implicit steps of third order with an estimate of the error (`step`); each stage is a nonlinear system
//! (`stage`) that Newton's method solves by conjugate gradients. These are preconditioned by the eigenvectors along x
//! and y and systems along z (`linear`, `lateral`), which follow the layers, fronts and phases along z to the last
//! digit: what iterations are for is how constants differ within a level. The enthalpy at the end is the one before
//! plus the stages' fluxes, never Newton's last iterate, and each face is charged for these: heat balances to
//! rounding whatever the tolerances are.

mod body;
mod grid;
mod lateral;
mod linear;
mod problem;
mod setup;
mod stage;
mod step;

pub use problem::{EnthalpyHeat, Failure};
pub use setup::{Condition, Contact, Face, Loads, Setup, SetupError, linear_mesh};
