//! Bodies: one discretisation a folder.

pub mod fem;

pub mod particle_heat;

pub mod sph;
