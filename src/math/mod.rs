//! Numerics without physics: quadrature, shape functions, separable transforms, sparse solvers and
//! exponentials of matrices.

pub mod anderson;
pub mod bicgstab;
pub mod chebyshev;
pub mod cholesky;
pub mod conjugate_gradients;
pub mod disc_rectangle;
pub mod eigenvectors;
pub mod eight;
pub mod exponential;
pub mod gauss;
pub mod geometric_dissection;
pub mod grid_matrix;
pub mod lagrange;
pub mod lanes;
pub mod matrix3;
pub mod nested_dissection;
mod panel_solve;
pub mod parts;
pub mod product;
pub mod random;
pub mod segments;
pub mod separable;
pub mod singular_values;
pub mod small_inverse;
pub mod sparse_rows;
pub mod stencil_matrix;
mod supernodes;
