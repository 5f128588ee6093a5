//! Numerical methods, one a folder: they know numbers, not scenes or inputs. A method uses only those above it.

// Blank lines keep the order.
pub mod heat_totals;

pub mod mesh;

pub mod reduced;

pub mod particle_heat;

pub mod enthalpy;

pub mod fem;

pub mod inelastic;

pub mod sph;

pub mod record;
