//! A solid on a structured finite-element mesh.

mod axis;
mod axisymmetric;
mod conduction;
mod dilatation;
mod elastic;
mod fineness;
mod grading;
mod heat;
mod hexahedron;
mod mesh;
mod modes;
mod plan;
mod recovery;
mod solid;

pub use axis::{Axis, Weight};
pub use conduction::particle_cost;
pub use elastic::{expected_entries, factor_memory};
pub use heat::HeatTotals;
pub use mesh::{Geometry, Mesh, MeshFace, Parity};
pub use plan::{Mechanics, Plan, Refinement};
pub use solid::{Deformation, NodalFields, SolidFem, SolidLoads, Temperatures};
