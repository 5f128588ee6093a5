//! Numerics without physics: quadrature, shape functions, separable transforms, sparse solvers,
//! exponentials of matrices, and bounds of how much they compute.

pub mod address_space;
pub mod allowance;
pub mod anderson;
pub mod bicgstab;
pub mod chebyshev;
pub mod cholesky;
pub mod conjugate_gradients;
pub mod disc_rectangle;
pub mod eigenvectors;
pub mod eight;
pub mod exponential;
pub mod fork_lock;
pub mod gauss;
pub mod lagrange;
pub mod made_once;
pub mod nested_dissection;
pub mod parallel;
pub mod product;
pub mod sealed;
pub mod separable;
pub mod shared_values;
pub mod singular_values;
pub mod small_inverse;
pub mod sparse_rows;
pub mod stencil_matrix;
mod supernodes;
pub mod thread;
