//! Numerical methods, one a folder. They know numbers and plain types of the scene, such as shapes and kernels, but no
//! inputs. A method uses only those above it.

// Blank lines keep the order.
pub mod heat_totals;

pub mod mesh;

pub mod reduced;

pub mod particle_heat;

pub mod enthalpy;

pub mod fem;

pub mod inelastic;

pub mod damage;

pub mod lattice;

pub mod large_strain;

pub mod sph;

pub mod record;

pub mod filament;
