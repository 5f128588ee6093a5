//! Matrix-free stiffness of all bricks of a box: a few hundred operations per element (see
//! [`super::brick_polynomials`]), and no stored matrix.
//!
//! Sums over nodes are factorised by axis: along z for a layer of elements, along y for a row of them, along x within
//! the row.

use std::ops::Range;

use super::brick_polynomials::{PolynomialModuli, legendre, moduli};
use super::brick_row::{Row, RowLengths, RowPlace};
use crate::laws::Thermoelastic;
use crate::math::eight::{self, Eight};
use crate::method::mesh::Layering;
use crate::method::mesh::Mesh;
use crate::runtime::parallel::Team;

/// Source of nodal forces: the stress of strains or of temperatures.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cause {
    Displacement,
    Temperature,
}

/// The stiffness of a box. Vectors hold all displacements along x, then along y, then along z, with the x index of
/// nodes fastest.
pub struct BrickStiffness {
    order: usize,
    /// Lengths of elements along each axis [m].
    lengths: [Vec<f64>; 3],
    row: RowLengths,
    layering: Layering,
    /// Moduli and 2µ of each layer, from the lowest on.
    moduli: Vec<(Vec<PolynomialModuli>, f64)>,
    /// Free nodes along each axis, for each component.
    free: [[Range<usize>; 3]; 3],
}

/// Work space for one layer of elements.
struct Scratch {
    /// Values of rows of nodes along x, stacked, and a weighted sum of such rows.
    nodes: Vec<f64>,
    sums: Vec<f64>,
    /// Coefficients along z of each component and forces on them: `3 n` planes of rows, corners before middles.
    planes: Vec<f64>,
    forces: Vec<f64>,
    /// Coefficients along y and z: `3 n²` such rows.
    rows: Vec<f64>,
    row: Row,
}

/// One layer of elements whose forces are added.
struct Layer<'a, 'b> {
    cause: Cause,
    /// Counted from the lowest.
    number: usize,
    values: &'a [f64],
    /// The planes of nodes of each component, from the lowest node of the layer on.
    out: &'a mut [&'b mut [f64]; 3],
}

impl BrickStiffness {
    /// `laws` of the layers, from the lowest on.
    pub fn new(mesh: &Mesh, laws: &[Thermoelastic], free: [[Range<usize>; 3]; 3]) -> Self {
        let lengths: [Vec<f64>; 3] = mesh.axes.each_ref().map(|axis| {
            let length = |e| {
                let [a, b] = axis.bounds(e);
                b - a
            };
            (0..axis.elements()).map(length).collect()
        });
        let order = mesh.order();
        let row = RowLengths::new(&lengths[0]);
        let moduli = laws.iter().map(|law| (moduli(order, law), 2.0 * law.shear_modulus()));
        let layering = mesh.layering.clone();
        Self { order, lengths, row, layering, moduli: moduli.collect(), free }
    }

    fn nodes(&self) -> [usize; 3] {
        self.lengths.each_ref().map(|lengths| lengths.len() * self.order + 1)
    }

    /// Computes `out = K x`, zero at held nodes.
    pub fn apply(&self, x: &[f64], out: &mut [f64], team: &Team) {
        self.add_forces(Cause::Displacement, x, out, team);
        self.hold(out, team);
    }

    /// Computes nodal thermal forces at constant strain from temperatures above the stress-free one [K], with separate
    /// values for both layers on interfaces. They are zero at held nodes.
    pub fn thermal_forces(&self, temperature: &[f64], out: &mut [f64], team: &Team) {
        self.add_forces(Cause::Temperature, temperature, out, team);
        self.hold(out, team);
    }

    fn add_forces(&self, cause: Cause, x: &[f64], out: &mut [f64], team: &Team) {
        out.fill(0.0);
        let [columns, rows, _] = self.nodes();
        let plane = columns * rows;
        // Layers of elements that share no nodes: first those of even, then those of odd number.
        for colour in 0..2 {
            let mut layers = self.layers(out, plane, colour);
            team.for_pieces(&mut layers, |_, layers| {
                let mut scratch = self.scratch();
                for (number, out) in layers {
                    self.add_layer(Layer { cause, number: *number, values: x, out }, &mut scratch);
                }
            });
        }
    }

    /// The planes of nodes of every second layer of elements, of each component.
    fn layers<'a>(
        &self,
        out: &'a mut [f64],
        plane: usize,
        colour: usize,
    ) -> Vec<(usize, [&'a mut [f64]; 3])> {
        let height = self.order * plane;
        let component = out.len() / 3;
        let mut parts = out.chunks_exact_mut(component);
        let mut parts = [0, 1, 2].map(|_| {
            let part = parts.next().expect("there are three");
            part[colour * height..].chunks_mut(2 * height)
        });
        let mut layers = Vec::new();
        for layer in (colour..self.lengths[2].len()).step_by(2) {
            layers.push((layer, parts.each_mut().map(|part| part.next().expect("one a layer"))));
        }
        layers
    }

    fn scratch(&self) -> Scratch {
        let (n, [_, rows, _]) = (self.order + 1, self.nodes());
        let strands = self.order * self.row.strand();
        let zeros = |count: usize| vec![0.0; count * strands];
        Scratch {
            nodes: zeros(n),
            sums: zeros(1),
            planes: zeros(3 * n * rows),
            forces: zeros(3 * n * rows),
            rows: zeros(3 * n * n),
            row: Row::new(&self.row, self.order),
        }
    }

    /// Applies the stiffness like [`Self::apply`], without processor-specific instructions.
    #[cfg(test)]
    pub fn apply_plainly(&self, x: &[f64]) -> Vec<f64> {
        let [columns, rows, _] = self.nodes();
        let mut out = vec![0.0; x.len()];
        for colour in 0..2 {
            for (number, mut out) in self.layers(&mut out, columns * rows, colour) {
                let layer = Layer { cause: Cause::Displacement, number, values: x, out: &mut out };
                self.layer::<eight::Array>(layer, &mut self.scratch());
            }
        }
        self.hold(&mut out, &Team::new(1));
        out
    }

    fn add_layer(&self, layer: Layer, scratch: &mut Scratch) {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") {
                // SAFETY: the processor has the function's instructions.
                return unsafe { self.layer_avx512(layer, scratch) };
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has the function's instructions.
                return unsafe { self.layer_avx2(layer, scratch) };
            }
        }
        self.layer::<eight::Array>(layer, scratch);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn layer_avx512(&self, layer: Layer, scratch: &mut Scratch) {
        self.layer::<eight::Avx512>(layer, scratch);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn layer_avx2(&self, layer: Layer, scratch: &mut Scratch) {
        self.layer::<eight::Array>(layer, scratch);
    }

    #[inline(always)]
    fn layer<E: Eight>(&self, layer: Layer, scratch: &mut Scratch) {
        match self.order {
            1 => self.add_layer_forces::<E, 2>(layer, scratch),
            _ => self.add_layer_forces::<E, 3>(layer, scratch),
        }
    }

    /// Adds the forces of a layer of elements; `N` nodes along an edge.
    #[inline(always)]
    fn add_layer_forces<E: Eight, const N: usize>(&self, layer: Layer, scratch: &mut Scratch) {
        let Layer { cause, number, values, out } = layer;
        let [columns, rows, _] = self.nodes();
        let (component, plane) = (self.nodes().iter().product::<usize>(), columns * rows);
        let below = self.layering.layer_of(number);
        // Nodal temperatures on interfaces are stored twice.
        let (components, doubled) = match cause {
            Cause::Displacement => (3, 0),
            Cause::Temperature => (1, below),
        };
        let matrix = legendre(N - 1);
        let (lengths, strand) = (&self.row, self.row.strand());
        let strands = (N - 1) * strand;
        let Scratch { nodes, sums, planes, forces, rows: polynomials, row } = scratch;
        forces.fill(0.0);
        for c in 0..components {
            let first = c * component + (number * (N - 1) + doubled) * plane;
            for j in 0..rows {
                for (d, nodes) in nodes.chunks_exact_mut(strands).enumerate() {
                    let row = &values[first + d * plane + j * columns..][..columns];
                    corners_first::<N>(row, nodes, strand);
                }
                for (l, weights) in matrix.iter().enumerate().take(N) {
                    let target = &mut planes[((c * N + l) * rows + j) * strands..][..strands];
                    let at = |d: usize| &nodes[d * strands..][..strands];
                    combine::<N>(weights, std::array::from_fn(at), target);
                }
            }
        }
        let (moduli, two_shear) = &self.moduli[below];
        for element in 0..self.lengths[1].len() {
            let first = element * (N - 1) * strands;
            let layers = planes.chunks_exact(rows * strands).take(N * components);
            for (plane, out) in layers.zip(polynomials.chunks_exact_mut(N * strands)) {
                let at = |b: usize| &plane[first + b * strands..][..strands];
                for (weights, out) in matrix.iter().zip(out.chunks_exact_mut(strands)) {
                    combine::<N>(weights, std::array::from_fn(at), out);
                }
            }
            row.read::<E, N>(lengths, &polynomials[..components * N * N * strands]);
            let across = [self.lengths[1][element], self.lengths[2][number]];
            let place = RowPlace { lengths, across, moduli, two_shear: *two_shear };
            match cause {
                Cause::Displacement => row.stress::<E, N>(place),
                Cause::Temperature => row.thermal_stress::<E, N>(place),
            }
            row.write::<E, N>(lengths, polynomials);
            let targets = forces.chunks_exact_mut(rows * strands);
            for (plane, from) in targets.zip(polynomials.chunks_exact(N * strands)) {
                let at = |l: usize| &from[l * strands..][..strands];
                for (b, target) in plane[first..].chunks_exact_mut(strands).take(N).enumerate() {
                    let weights = std::array::from_fn(|l| matrix[l][b]);
                    add_combined::<N>(&weights, std::array::from_fn(at), target);
                }
            }
        }
        for (out, planes) in out.iter_mut().zip(forces.chunks_exact(N * rows * strands)) {
            for (d, plane) in out.chunks_exact_mut(plane).take(N).enumerate() {
                let weights = [0, 1, 2].map(|l| matrix[l][d]);
                for (j, target) in plane.chunks_exact_mut(columns).enumerate() {
                    let at = |l: usize| &planes[(l * rows + j) * strands..][..strands];
                    combine::<N>(&weights, std::array::from_fn(at), sums);
                    add_in_order::<N>(sums, target, strand);
                }
            }
        }
    }

    /// Sets held unknowns to zero.
    pub fn hold(&self, out: &mut [f64], team: &Team) {
        let [columns, rows, layers] = self.nodes();
        let mut planes: Vec<&mut [f64]> = out.chunks_exact_mut(columns * rows).collect();
        team.for_each(&mut planes, |n, plane| {
            let [x, y, z] = &self.free[n / layers];
            if !z.contains(&(n % layers)) {
                return plane.fill(0.0);
            }
            for (j, row) in plane.chunks_exact_mut(columns).enumerate() {
                match y.contains(&j) {
                    true => {
                        row[..x.start].fill(0.0);
                        row[x.end..].fill(0.0);
                    }
                    false => row.fill(0.0),
                }
            }
        });
    }
}

/// `target = Σ_d weights_d sources_d`.
#[inline(always)]
fn combine<const N: usize>(weights: &[f64; 3], sources: [&[f64]; N], target: &mut [f64]) {
    let sources = sources.map(|source| &source[..target.len()]);
    for (i, target) in target.iter_mut().enumerate() {
        let mut sum = 0.0;
        for d in 0..N {
            sum += weights[d] * sources[d][i];
        }
        *target = sum;
    }
}

/// `target += Σ_d weights_d sources_d`.
#[inline(always)]
fn add_combined<const N: usize>(weights: &[f64; N], sources: [&[f64]; N], target: &mut [f64]) {
    let sources = sources.map(|source| &source[..target.len()]);
    for (i, target) in target.iter_mut().enumerate() {
        let mut sum = *target;
        for d in 0..N {
            sum += weights[d] * sources[d][i];
        }
        *target = sum;
    }
}

/// A row of nodes with the corners of elements before the middles, which begin at `strand`.
#[inline(always)]
fn corners_first<const N: usize>(nodes: &[f64], out: &mut [f64], strand: usize) {
    if N == 2 {
        return out[..nodes.len()].copy_from_slice(nodes);
    }
    let (corners, middles) = out.split_at_mut(strand);
    let (pairs, last) = nodes.as_chunks::<2>();
    for ((pair, corner), middle) in pairs.iter().zip(&mut *corners).zip(middles) {
        [*corner, *middle] = *pair;
    }
    corners[pairs.len()] = last[0];
}

/// The opposite of [`corners_first`], added to what is there.
#[inline(always)]
fn add_in_order<const N: usize>(row: &[f64], nodes: &mut [f64], strand: usize) {
    if N == 2 {
        return nodes.iter_mut().zip(row).for_each(|(node, value)| *node += value);
    }
    let (corners, middles) = row.split_at(strand);
    let (pairs, last) = nodes.as_chunks_mut::<2>();
    for ((pair, corner), middle) in pairs.iter_mut().zip(corners).zip(middles) {
        pair[0] += corner;
        pair[1] += middle;
    }
    last[0] += corners[pairs.len()];
}
