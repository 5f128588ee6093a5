//! Bodies: one discretisation a folder.

pub mod fem;

pub mod sph;
