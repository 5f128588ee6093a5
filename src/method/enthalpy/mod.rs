//! Nonlinear heat conduction on a structured mesh: temperature-dependent constants, latent heat, radiation.
//!
//! `∂H/∂t = ∇·∇θ` with the volumetric enthalpy `H(T) = ∫ ρ c dT + ρ L f(T)` [J/m³] and the heat conductivity integral
//! `θ(T) = ∫ k dT` [W/m] of each material. The discretisation has linear elements on all nodes with trapezoidal
//! quadrature. The enthalpy of a node represents its volume, and the heat flow between two nodes is the difference of
//! their θ, so temperatures satisfy a maximum principle. The error is of second order in the node spacing.
//!
//! Time integration is implicit, of third order with an error estimate (`step`). Each stage is a nonlinear system
//! (`stage`), solved by Newton's method with conjugate gradients. These are preconditioned by the eigenvectors along x
//! and y and systems along z (`linear`, `lateral`), which represent layers, fronts and phases along z exactly.
//! Iterations are only needed for differences of constants within a level. The enthalpy at the end is the initial one
//! plus the stages' fluxes, never Newton's last iterate, and the fluxes of faces are recorded likewise. Heat therefore
//! balances to rounding whatever the tolerances are.

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
