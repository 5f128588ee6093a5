//! Numerics without physics: quadrature, shape functions, separable transforms, sparse solvers.

pub mod cholesky;
pub mod exponential;
pub mod gauss;
pub mod lagrange;
pub mod nested_dissection;
pub mod parallel;
pub mod separable;
pub mod stencil_matrix;
