//! Stiffness of the points that are assembled together, as a dense matrix.
//!
//! A displacement of node I along axis a changes the components of F by `u_m[I]`: the gradient of its function, in the
//! row a, and round an axis its value over the radius. With the tangent T of a point and its volume V the stiffness is
//! `K[aI, cJ] += Σ_m u_m[I] t_m[cJ]`, `t_m[cJ] = V Σ_q T[m][q] u_q[J]`, with m and q of the axes a and c. The loops run
//! along rows of K, as blocks of kernels have hundreds of unknowns.

use super::Deformable;
use super::tangent::{Block, GroupTangent, Swelling};
use crate::laws::solid::large_strain::Tangent;
use crate::space::Form;

/// Components of F that displacements along an axis change, as places in F and in the changes of a point.
type Components = Vec<(usize, usize)>;

/// Place of a hoop among the changes of a point, after the three gradients.
const HOOP: usize = 3;

/// Changes of F at a point under displacements of the nodes of a block.
struct Strains {
    /// Of each axis in which nodes move.
    of_axes: Vec<Components>,
    /// Gradients along x, y and z, and values over the radius, node by node.
    changes: [Vec<f64>; 4],
}

/// A dense matrix of the displacements of all nodes of a block, axis by axis, and what it is made of.
struct Dense {
    strains: Strains,
    nodes: usize,
    values: Vec<f64>,
    /// t_m of each m.
    rows: Vec<Vec<f64>>,
}

/// Stiffness matrix of the unknowns of a block, row by row.
pub(super) fn element(body: &Deformable, group: &GroupTangent, block: &Block) -> Vec<f64> {
    let form = body.space.form;
    let mut dense = Dense::new(form, block.nodes.len());
    let weights = &body.space.volume.weights[block.points.clone()];
    let whole: f64 = weights.iter().sum();
    let mut swellings =
        vec![[vec![0.0; dense.width()], vec![0.0; dense.width()]]; group.swellings.len()];
    for (place, point) in block.points.clone().enumerate() {
        let weight = weights[place];
        dense.strains.set(body, point, &block.nodes);
        dense.add(&group.points[place], weight);
        for (sums, Swelling { forces, changes, .. }) in swellings.iter_mut().zip(&group.swellings) {
            for (sums, of) in sums.iter_mut().zip([&forces[place], &changes[place]]) {
                dense.strains.contract(of.as_flattened(), weight, sums);
            }
        }
    }
    for ([forces, changes], Swelling { stiffness, .. }) in swellings.iter().zip(&group.swellings) {
        let width = dense.width();
        for (row, force) in dense.values.chunks_exact_mut(width).zip(forces) {
            add_multiple(row, stiffness / whole * force, changes);
        }
    }
    let place = |of: usize| {
        form.axes().iter().position(|&axis| axis == of % 3).map(|axis| axis * dense.nodes + of / 3)
    };
    let places: Vec<usize> =
        block.columns.iter().filter_map(|column| place(column.place)).collect();
    assert_eq!(places.len(), block.columns.len(), "nodes have unknowns along the axes of a model");
    let mut matrix = Vec::with_capacity(places.len().pow(2));
    for &row in &places {
        let of_row = &dense.values[row * dense.width()..];
        matrix.extend(places.iter().map(|&column| group.scale * of_row[column]));
    }
    matrix
}

impl Strains {
    fn new(form: Form, nodes: usize) -> Self {
        let of_axis = |&axis: &usize| {
            let mut components: Components =
                form.axes().iter().map(|&b| (3 * axis + b, b)).collect();
            if form == Form::Axisymmetric && axis == 0 {
                components.push((4, HOOP));
            }
            components
        };
        Self {
            of_axes: form.axes().iter().map(of_axis).collect(),
            changes: [(); 4].map(|()| vec![0.0; nodes]),
        }
    }

    fn set(&mut self, body: &Deformable, point: usize, nodes: &[u32]) {
        let volume = &body.space.volume;
        self.changes.iter_mut().for_each(|changes| changes.fill(0.0));
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

    /// Adds the weighted contractions of a tensor with the changes of F under the displacements of all nodes.
    fn contract(&self, tensor: &[f64], weight: f64, sums: &mut [f64]) {
        let nodes = self.changes[0].len();
        for (components, sums) in self.of_axes.iter().zip(sums.chunks_exact_mut(nodes)) {
            for &(m, own) in components {
                add_multiple(sums, weight * tensor[m], &self.changes[own]);
            }
        }
    }
}

impl Dense {
    fn new(form: Form, nodes: usize) -> Self {
        let width = form.axes().len() * nodes;
        let strains = Strains::new(form, nodes);
        Self { strains, nodes, values: vec![0.0; width * width], rows: vec![vec![0.0; width]; 9] }
    }

    fn width(&self) -> usize {
        self.strains.of_axes.len() * self.nodes
    }

    /// Adds the stiffness of a point.
    fn add(&mut self, tangent: &Tangent, weight: f64) {
        let (width, nodes) = (self.width(), self.nodes);
        let Self { strains, values, rows, .. } = self;
        for (m, _) in strains.of_axes.iter().flatten() {
            rows[*m].fill(0.0);
            strains.contract(&tangent[*m], weight, &mut rows[*m]);
        }
        let of_axes = values.chunks_exact_mut(nodes * width).zip(&strains.of_axes);
        for (values, components) in of_axes {
            for (node, row) in values.chunks_exact_mut(width).enumerate() {
                for &(m, own) in components {
                    let change = strains.changes[own][node];
                    if change != 0.0 {
                        add_multiple(row, change, &rows[m]);
                    }
                }
            }
        }
    }
}

fn add_multiple(sums: &mut [f64], factor: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
