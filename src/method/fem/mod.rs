//! A solid on a structured finite-element mesh.

pub mod assembly;
pub mod axisymmetric;
pub mod brick_inverse;
mod brick_polynomials;
mod brick_row;
mod brick_solver;
pub mod brick_stiffness;
mod columns;
mod conduction;
mod crack_mesh;
mod dilatation;
pub mod elastic;
mod end_response;
mod fineness;
pub mod free_faces;
mod grading;
mod heat;
pub mod hexahedron;
mod modes;
mod nonlinear;
mod plan;
pub mod recovery;
mod solid;
mod solver_choice;

pub use crate::method::heat_totals::HeatTotals;
pub use crate::method::mesh::{Axis, Geometry, Layering, Mesh, MeshFace, Parity, Weight};
pub use conduction::{HeatFailure, HeatValue, particle_cost};
pub use elastic::{
    Component, ElasticProblem, FaceRows, Functional, Term, forget_unused_stiffness, memory_of_row,
    most_memory_of_rows,
};
pub use heat::{HeatLoads, HeatProblem, ModalRow, ThermalFace};
pub use nonlinear::{NonlinearFailure, heat_mesh};
pub use plan::{Mechanics, Plan, PlanRequest, Refinement, conducts_along_thickness};
pub use solid::{
    ClassRow, Deformation, Extreme, Flaws, FlawsIn, ImageStress, NodalFields, NodalSum, Remembered,
    SolidFem, SolidLoads, SolidModes, Temperatures,
};
pub use solver_choice::{
    expected_entries, factor_memory, solver_memory, suits_conjugate_gradients,
};
