//! Heat in solids of large strain, on the nodes and functions of their mechanics.
//!
//! Temperatures are those of the nodes, `T = Σ Ψ_I T_I`, and heat obeys `C_I Ṫ_I = −Σ_J K_IJ T_J + Q_I` with capacities
//! lumped to the nodes. Heat flows as in the deformed body, `q = −k grad T`, which in the reference configuration is
//! the conductivity `k J F⁻¹ F⁻ᵀ`: a body that is pressed to half of its height passes more heat across. Its capacity
//! goes with its mass. Face conditions and contact act per present area.

mod conduction;
mod contacts;
mod step;
mod warmth;

pub use conduction::{Conduction, HeatOfLayer};
pub use contacts::{Contacts, Place};
pub use step::{Film, HEAT_STEPS, HEAT_WORK, HeatDrive, Passed};
pub use warmth::Warmth;

#[cfg(test)]
mod tests;
