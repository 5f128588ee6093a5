//! Numerical methods, one a folder: they know numbers, not scenes or inputs.

pub mod enthalpy;

pub mod heat_totals;

pub mod mesh;

pub mod fem;

pub mod inelastic;

pub mod particle_heat;

pub mod sph;
