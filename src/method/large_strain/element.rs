//! Stiffness of the points that are assembled together, as a dense matrix.
//!
//! A displacement of node I along axis a changes the components of F by `u_m[I]`: the gradient of its function, in the
//! row a, and round an axis its value over the radius. With the tangent T of a point and its volume V the stiffness is
//! `K[aI, cJ] += Σ_m u_m[I] t_m[cJ]`, `t_m[cJ] = V Σ_q T[m][q] u_q[J]`, with m and q of the axes a and c. A pressure that
//! the points share adds a term of the same form. So the rows of an axis are the product of the u_m and the t_m of all
//! points: blocks of kernels have hundreds of unknowns.

use std::ops::Range;

use faer::MatRef;

use super::tangent::{Block, GroupTangent, Swelling};
use super::{Deformable, eight_nodes};
use crate::math::product::product;
use crate::space::Form;

/// Components of F that displacements along an axis change, as places in F and in the changes of a point.
type Components = Vec<(usize, usize)>;

/// Place of a hoop among the changes of a point, after the three gradients.
const HOOP: usize = 3;
/// Nodes of a block below which a product takes longer to begin than to compute.
const FEW: usize = 16;

/// The matrix of a block, in memory that the next block uses again.
#[derive(Default)]
pub(super) struct Element {
    /// Changes of F at a point under displacements of the nodes: gradients along x, y and z, and values over the radius.
    changes: [Vec<f64>; 4],
    /// For each axis the u_m of all points, each of the length of the nodes, and the t_m, each of that of all unknowns.
    factors: Vec<[Vec<f64>; 2]>,
    /// Rows of the matrix of the unknowns of the block.
    values: Vec<f64>,
}

impl Element {
    /// The entries of the matrix, row by row.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Computes the stiffness matrix of the unknowns of a block.
    pub(super) fn compute(
        &mut self,
        body: &Deformable,
        of_group: &(dyn Fn(usize) -> GroupTangent + Sync),
        block: &Block,
    ) {
        let form = body.space.form;
        let components = components(form);
        self.factors.resize(components.len(), Default::default());
        self.factors.iter_mut().flatten().for_each(Vec::clear);
        for number in block.groups.clone() {
            let points = body.space.groups[number].clone();
            self.add_factors(body, &components, (&of_group(number), points), &block.nodes);
        }
        let width = components.len() * block.nodes.len();
        self.multiply(block.nodes.len(), width);
        self.keep(form, block);
    }

    /// Adds the u_m and t_m of the points of a group.
    fn add_factors(
        &mut self,
        body: &Deformable,
        components: &[Components],
        (group, points): (&GroupTangent, Range<usize>),
        nodes: &[u32],
    ) {
        let width = components.len() * nodes.len();
        let weights = &body.space.volume.weights[points.clone()];
        let mut swellings = vec![[vec![0.0; width], vec![0.0; width]]; group.swellings.len()];
        for (place, point) in points.enumerate() {
            let weight = group.scale * weights[place];
            self.set_changes(body, point, nodes);
            let Self { changes, factors, .. } = self;
            for (of_axis, [own, rows]) in components.iter().zip(factors) {
                for &(m, change) in of_axis {
                    own.extend_from_slice(&changes[change]);
                    let first = rows.len();
                    rows.resize(first + width, 0.0);
                    let tangent = (&group.points[place][m][..], weight);
                    contract(components, changes, tangent, &mut rows[first..]);
                }
            }
            for (sums, Swelling { forces, changes: other, .. }) in
                swellings.iter_mut().zip(&group.swellings)
            {
                let tensors = [(&forces[place], weights[place]), (&other[place], weight)];
                for (sums, (tensor, weight)) in sums.iter_mut().zip(tensors) {
                    contract(components, changes, (tensor.as_flattened(), weight), sums);
                }
            }
        }
        for ([forces, other], Swelling { stiffness, .. }) in swellings.iter().zip(&group.swellings)
        {
            let of_axes = forces.chunks_exact(nodes.len());
            for ([own, rows], forces) in self.factors.iter_mut().zip(of_axes) {
                own.extend(forces.iter().map(|force| stiffness * force));
                rows.extend_from_slice(other);
            }
        }
    }

    /// Sets the changes of F at a point.
    fn set_changes(&mut self, body: &Deformable, point: usize, nodes: &[u32]) {
        let volume = &body.space.volume;
        for changes in &mut self.changes {
            changes.clear();
            changes.resize(nodes.len(), 0.0);
        }
        for value in volume.row(point) {
            let place =
                nodes.binary_search(&value.node).expect("a block has the nodes of its rows");
            for (changes, gradient) in self.changes.iter_mut().zip(value.gradient) {
                changes[place] = gradient;
            }
            if body.space.form == Form::Axisymmetric {
                self.changes[HOOP][place] = value.value / volume.at[point][0];
            }
        }
    }

    /// Multiplies the factors: rows of the displacements of all nodes, axis by axis.
    fn multiply(&mut self, nodes: usize, width: usize) {
        self.values.clear();
        self.values.resize(width * width, 0.0);
        let of_axes = self.values.chunks_exact_mut(nodes * width);
        for (out, [own, rows]) in of_axes.zip(&self.factors) {
            if is_hexahedron(width / nodes, nodes) {
                eight_nodes::multiply(out, own, rows);
                continue;
            }
            if nodes < FEW {
                for (own, row) in own.chunks_exact(nodes).zip(rows.chunks_exact(width)) {
                    for (out, factor) in out.chunks_exact_mut(width).zip(own) {
                        out.iter_mut().zip(row).for_each(|(sum, value)| *sum += factor * value);
                    }
                }
                continue;
            }
            let terms = own.len() / nodes;
            // The columns of the product are the rows of the matrix.
            let left = MatRef::from_column_major_slice(rows, width, terms);
            product(out, left, MatRef::from_row_major_slice(own, terms, nodes));
        }
    }

    /// Keeps the rows and columns of the unknowns of a block.
    fn keep(&mut self, form: Form, block: &Block) {
        let (axes, nodes) = (form.axes(), block.nodes.len());
        let place =
            |of: usize| axes.iter().position(|&axis| axis == of % 3).map(|n| n * nodes + of / 3);
        let places: Vec<usize> =
            block.columns.iter().filter_map(|column| place(column.place)).collect();
        assert_eq!(
            places.len(),
            block.columns.len(),
            "nodes have unknowns along the axes of a model"
        );
        let width = axes.len() * nodes;
        if places.len() == width {
            return;
        }
        // Each entry moves towards the beginning, as unknowns have the order of the matrix.
        let mut next = 0;
        for &row in &places {
            for &column in &places {
                self.values[next] = self.values[row * width + column];
                next += 1;
            }
        }
        self.values.truncate(next);
    }
}

/// Returns true for blocks of eight nodes that move along three axes.
fn is_hexahedron(axes: usize, nodes: usize) -> bool {
    axes * nodes == eight_nodes::WIDTH && nodes == eight_nodes::NODES
}

/// Components of each axis along which nodes move.
fn components(form: Form) -> Vec<Components> {
    let of_axis = |&axis: &usize| {
        let mut components: Components = form.axes().iter().map(|&b| (3 * axis + b, b)).collect();
        if form == Form::Axisymmetric && axis == 0 {
            components.push((4, HOOP));
        }
        components
    };
    form.axes().iter().map(of_axis).collect()
}

/// Adds the weighted contractions of a tensor with the changes of F under the displacements of all nodes.
fn contract(
    components: &[Components],
    changes: &[Vec<f64>; 4],
    (tensor, weight): (&[f64], f64),
    sums: &mut [f64],
) {
    if is_hexahedron(components.len(), changes[0].len()) {
        let changes = [&changes[0][..], &changes[1], &changes[2]];
        return eight_nodes::contract(changes, tensor, weight, sums);
    }
    for (components, sums) in components.iter().zip(sums.chunks_exact_mut(changes[0].len())) {
        for &(m, own) in components {
            let factor = weight * tensor[m];
            for (sum, change) in sums.iter_mut().zip(&changes[own]) {
                *sum += factor * change;
            }
        }
    }
}
