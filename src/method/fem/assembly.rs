//! Assembly of the matrices of whole meshes from those of elements.

use super::axisymmetric::{QuadrilateralMatrices, Rectangle};
use super::hexahedron::HexahedronMatrices;
use crate::laws::Thermoelastic;
use crate::math::cholesky::LowerTriangle;
use crate::math::stencil_matrix::{Reach, StencilMatrix};
use crate::method::mesh::{Geometry, Mesh};
use crate::runtime::parallel;

/// Nodal field that a matrix maps to forces.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Displacements.
    Stiffness,
    /// Temperatures.
    Thermal,
}

/// Assembles the matrix of a mesh whose layers have these laws, from the lowest on. `block` has the numbers of rows and
/// columns per pair of nodes.
pub fn assemble(
    mesh: &Mesh,
    laws: &[Thermoelastic],
    block: [usize; 2],
    part: Part,
    threads: usize,
) -> StencilMatrix {
    let reach = mesh.axes.each_ref().map(|axis| match axis.elements() {
        0 => Reach { first: vec![0], last: vec![0] },
        n => Reach::of_elements(n, axis.order),
    });
    let mut matrix = StencilMatrix::zeros(reach, block);
    match mesh.geometry {
        Geometry::Box => assemble_box(mesh, laws, part, threads, &mut matrix),
        Geometry::Axisymmetric => assemble_rings(mesh, laws, part, &mut matrix),
    }
    matrix
}

fn assemble_box(
    mesh: &Mesh,
    laws: &[Thermoelastic],
    part: Part,
    threads: usize,
    matrix: &mut StencilMatrix,
) {
    let [nx, ny, nz] = mesh.element_counts();
    let order = mesh.order();
    let length = |axis: usize, e: usize| {
        let [a, b] = mesh.axes[axis].bounds(e);
        b - a
    };
    let n = order + 1;
    for ez in 0..nz {
        let law = &laws[mesh.layering.layer_of(ez)];
        // One slab of element matrices at a time: computed in parallel, added in fixed order.
        let slab = parallel::map(threads, nx * ny, |e| {
            let size = [length(0, e % nx), length(1, e / nx), length(2, ez)];
            HexahedronMatrices::new(order, size, law)
        });
        for (e, element) in slab.iter().enumerate() {
            let node = |a: usize| {
                [e % nx * order + a % n, e / nx * order + a / n % n, ez * order + a / (n * n)]
            };
            for a in 0..n * n * n {
                for b in 0..n * n * n {
                    let target = matrix.block_mut(node(a), node(b));
                    match part {
                        Part::Stiffness => add(target, element.stiffness(a, b)),
                        Part::Thermal => add(target, element.thermal(a, b)),
                    }
                }
            }
        }
    }
}

fn assemble_rings(mesh: &Mesh, laws: &[Thermoelastic], part: Part, matrix: &mut StencilMatrix) {
    let [radii, _, heights] = &mesh.axes;
    let order = mesh.order();
    let n = order + 1;
    for ez in 0..heights.elements() {
        let law = &laws[mesh.layering.layer_of(ez)];
        for er in 0..radii.elements() {
            let rectangle = Rectangle { r: radii.bounds(er), z: heights.bounds(ez) };
            let element = QuadrilateralMatrices::new(order, rectangle, law);
            let node = |a: usize| [er * order + a % n, 0, ez * order + a / n];
            for a in 0..n * n {
                for b in 0..n * n {
                    let target = matrix.block_mut(node(a), node(b));
                    match part {
                        Part::Stiffness => {
                            let k = &element.stiffness;
                            let at = |i: usize, j: usize| k[(2 * a + i, 2 * b + j)];
                            add(target, &[at(0, 0), at(0, 1), at(1, 0), at(1, 1)]);
                        }
                        Part::Thermal => {
                            let t = &element.thermal;
                            add(target, &[t[(2 * a, b)], t[(2 * a + 1, b)]]);
                        }
                    }
                }
            }
        }
    }
}

fn add(target: &mut [f64], values: &[f64]) {
    for (t, v) in target.iter_mut().zip(values) {
        *t += v;
    }
}

/// Returns the lower triangle of the free part of a symmetric stencil matrix; by symmetry the columns are read from the
/// rows.
pub fn lower_triangle(matrix: &StencilMatrix, degrees: usize, number: &[usize]) -> LowerTriangle {
    let mut triangle = LowerTriangle { column_start: vec![0], ..Default::default() };
    for node in 0..matrix.nodes() {
        for c in 0..degrees {
            let column = number[node * degrees + c];
            if column == usize::MAX {
                continue;
            }
            matrix.for_each_block(node, |other, block| {
                for d in 0..degrees {
                    let row = number[other * degrees + d];
                    if row != usize::MAX && row >= column {
                        triangle.rows.push(row);
                        triangle.values.push(block[c * degrees + d]);
                    }
                }
            });
            triangle.column_start.push(triangle.rows.len());
        }
    }
    triangle
}
