//! Displacements of a box by conjugate gradients: without factorisation, at memory proportional to the number of nodes.

use std::ops::Range;

use super::brick_inverse::BrickInverse;
use super::brick_stiffness::BrickStiffness;
use crate::laws::Thermoelastic;
use crate::math::conjugate_gradients::{self, NotConverged, Operator};
use crate::method::mesh::Mesh;
use crate::runtime::parallel::Team;

/// Stiffness of one symmetry class and its preconditioner.
pub struct BrickSolver {
    stiffness: BrickStiffness,
    inverse: BrickInverse,
    threads: usize,
}

/// Residual relative to the load in the energy norm; stresses then agree with those of a factorisation to nine digits.
pub const TOLERANCE: f64 = 1e-12;

impl BrickSolver {
    /// `free` holds the free nodes along each axis for each component; each component must be held somewhere.
    pub fn new(
        mesh: &Mesh,
        laws: &[Thermoelastic],
        free: [[Range<usize>; 3]; 3],
        threads: usize,
    ) -> Self {
        let inverse = BrickInverse::new(mesh, laws, &free, &Team::new(threads));
        Self { stiffness: BrickStiffness::new(mesh, laws, free), inverse, threads }
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.inverse.entries()
    }

    /// Memory to solve for this many unknowns and to read stresses [B].
    pub fn memory(order: usize, unknowns: usize) -> f64 {
        // Load, solution, residual, direction, product, preconditioned residual, the load by components and modes of
        // one; then strains, stresses and their recovery at all nodes, as measured with 10⁶ and 10⁷ nodes.
        const VECTORS: f64 = 25.0;
        8.0 * (VECTORS + (order + 1) as f64) * unknowns as f64
    }

    /// Replaces nodal forces, with x, y and z of each node together, by displacements. Temperatures above the
    /// stress-free one act too [K]; an empty list means none. Returns the number of iterations until the residual is
    /// below a share of the load.
    pub fn solve_in_place(
        &self,
        load: &mut [f64],
        temperature: &[f64],
        tolerance: f64,
    ) -> Result<usize, NotConverged> {
        let nodes = load.len() / 3;
        let team = Team::new(self.threads);
        let mut apart = vec![0.0; load.len()];
        if !temperature.is_empty() {
            self.stiffness.thermal_forces(temperature, &mut apart, &team);
        }
        for (c, forces) in apart.chunks_exact_mut(nodes).enumerate() {
            forces.iter_mut().zip(load.iter().skip(c).step_by(3)).for_each(|(sum, f)| *sum += f);
        }
        self.stiffness.hold(&mut apart, &team);
        let (solution, iterations) =
            conjugate_gradients::solve(&(self, &team), &apart, tolerance, &team)?;
        for (node, displacement) in load.chunks_exact_mut(3).enumerate() {
            (0..3).for_each(|c| displacement[c] = solution[c * nodes + node]);
        }
        Ok(iterations)
    }
}

impl Operator for (&BrickSolver, &Team) {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.0.stiffness.apply(x, out, self.1);
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        self.0.inverse.apply(residual, out, self.1);
    }
}

#[cfg(test)]
mod tests {
    use std::slice;

    use super::*;
    use crate::method::fem::hexahedron::HexahedronMatrices;
    use crate::method::mesh::Geometry;
    use crate::method::mesh::Layering;
    use crate::method::mesh::{Axis, Weight};

    fn graded(order: usize, counts: [usize; 3], growth: f64) -> Mesh {
        let axes = counts.map(|count| {
            let mut ends = vec![0.0];
            for e in 0..count {
                ends.push(ends[e] + growth.powi(e as i32));
            }
            Axis::from_element_ends(&ends, order, Weight::Uniform)
        });
        Mesh { axes, mirrored: [false; 2], geometry: Geometry::Box, layering: Layering::default() }
    }

    /// The mesh with interfaces below these elements.
    fn layered(mesh: Mesh, starts: &[usize]) -> Mesh {
        let layering = Layering::new(starts.to_vec(), vec![0.0; starts.len()]);
        Mesh { layering, ..mesh }
    }

    fn clamped_below(mesh: &Mesh) -> [[Range<usize>; 3]; 3] {
        let [x, y, z] = mesh.node_counts();
        [(); 3].map(|()| [0..x, 0..y, 1..z])
    }

    fn wave(count: usize) -> Vec<f64> {
        (0..count).map(|i| (1.7 * (i * i % 1009) as f64).sin()).collect()
    }

    fn assert_close(found: &[f64], wanted: &[f64], order: usize) {
        let largest = wanted.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (f, w) in found.iter().zip(wanted) {
            assert!((f - w).abs() < 1e-13 * largest, "order {order}: {f}, not {w}");
        }
    }

    /// Forces of displacements or of temperatures from the matrices of single elements.
    fn assembled(mesh: &Mesh, laws: &[Thermoelastic], x: &[f64], columns_of: usize) -> Vec<f64> {
        let [nx, ny, nz] = mesh.element_counts();
        let [columns, rows, _] = mesh.node_counts();
        let (order, nodes) = (mesh.order(), mesh.nodes());
        let n = order + 1;
        let mut out = vec![0.0; 3 * nodes];
        for e in 0..nx * ny * nz {
            let element = [e % nx, e / nx % ny, e / (nx * ny)];
            let size = [0, 1, 2].map(|a| {
                let [low, high] = mesh.axes[a].bounds(element[a]);
                high - low
            });
            let layer = mesh.layering.layer_of(element[2]);
            let matrices = HexahedronMatrices::new(order, size, &laws[layer]);
            // Nodal temperatures on interfaces are stored twice.
            let sided = if columns_of == 1 { layer * columns * rows } else { 0 };
            let node = |a: usize| {
                let at = [a % n, a / n % n, a / (n * n)];
                let [i, j, k] = [0, 1, 2].map(|axis| element[axis] * order + at[axis]);
                i + columns * (j + rows * k)
            };
            for a in 0..n * n * n {
                for b in 0..n * n * n {
                    let block: &[f64] = match columns_of {
                        1 => matrices.thermal(a, b),
                        _ => matrices.stiffness(a, b),
                    };
                    for i in 0..3 {
                        for j in 0..columns_of {
                            let entry = block[columns_of * i + j];
                            out[i * nodes + node(a)] += entry * x[j * nodes + node(b) + sided];
                        }
                    }
                }
            }
        }
        out
    }

    #[test]
    fn forces_are_those_of_the_elements_matrices() {
        let law = |young, poisson| Thermoelastic { young, poisson, expansion: 1e-3 };
        let laws = [law(200.0, 0.3), law(900.0, 0.05), law(10.0, 0.4)];
        for (order, count) in [(1, 1), (2, 1), (1, 3), (2, 3)] {
            let laws = &laws[..count];
            let mesh = layered(graded(order, [4, 3, 5], 1.5), &[2, 4][..count - 1]);
            let stiffness = BrickStiffness::new(&mesh, laws, clamped_below(&mesh));
            let x = wave(3 * mesh.nodes());
            let mut found = vec![7.0; x.len()];
            stiffness.apply(&x, &mut found, &Team::new(2));
            let mut wanted = assembled(&mesh, laws, &x, 3);
            stiffness.hold(&mut wanted, &Team::new(1));
            assert_close(&found, &wanted, order);
            let heat = wave(mesh.sided_nodes());
            stiffness.thermal_forces(&heat, &mut found, &Team::new(2));
            let mut wanted = assembled(&mesh, laws, &heat, 1);
            stiffness.hold(&mut wanted, &Team::new(1));
            assert_close(&found, &wanted, order);
        }
    }

    #[test]
    fn few_iterations_are_needed() {
        for (order, poisson, growth, counts, most) in [
            (1, 0.21, 1.0, [10, 10, 10], 45),
            (1, 0.3, 1.05, [10, 10, 10], 50),
            (1, 0.3, 1.3, [10, 10, 10], 70),
            (2, 0.0, 1.3, [6, 6, 6], 50),
            (2, 0.21, 1.0, [6, 6, 6], 50),
            (2, 0.3, 1.3, [7, 7, 7], 55),
            (2, 0.45, 1.3, [6, 6, 6], 100),
        ] {
            let law = Thermoelastic { young: 200.0, poisson, expansion: 1e-3 };
            let mesh = graded(order, counts, growth);
            let solver = BrickSolver::new(&mesh, slice::from_ref(&law), clamped_below(&mesh), 2);
            let load = wave(3 * mesh.nodes());
            let mut solution = load.clone();
            let iterations = solver.solve_in_place(&mut solution, &[], TOLERANCE).unwrap();
            let case = format!("order {order}, ν {poisson}, growth {growth}, {counts:?}");
            assert!(iterations <= most, "{case}: {iterations}");
            let apart = |list: &[f64]| -> Vec<f64> {
                (0..3).flat_map(|c| list.iter().skip(c).step_by(3)).copied().collect()
            };
            let mut wanted = apart(&load);
            solver.stiffness.hold(&mut wanted, &Team::new(1));
            let mut found = vec![0.0; load.len()];
            solver.stiffness.apply(&apart(&solution), &mut found, &Team::new(1));
            let off = found.iter().zip(&wanted).map(|(f, w)| (f - w).abs()).fold(0.0, f64::max);
            assert!(off < 1e-8, "{case}: {off}");
        }
    }

    #[test]
    fn layers_of_other_moduli_need_few_more() {
        for (order, counts) in [(1, [8, 8, 8]), (2, [8, 8, 8])] {
            for (young, poisson, start) in [(2000.0, 0.3, 6), (20_000.0, 0.2, 4), (0.02, 0.44, 6)] {
                let lower = Thermoelastic { young: 200.0, poisson: 0.3, expansion: 1e-3 };
                let laws = [lower, Thermoelastic { young, poisson, expansion: 2e-3 }];
                let mesh = layered(graded(order, counts, 1.3), &[start]);
                let solver = BrickSolver::new(&mesh, &laws, clamped_below(&mesh), 2);
                let mut solution = wave(3 * mesh.nodes());
                let iterations = solver.solve_in_place(&mut solution, &[], TOLERANCE).unwrap();
                let most = if order == 1 { 100 } else { 80 };
                assert!(iterations <= most, "order {order}, {counts:?}, {young}: {iterations}");
            }
        }
    }

    #[test]
    fn displacements_are_bitwise_independent_of_threads() {
        let law = Thermoelastic { young: 200.0, poisson: 0.3, expansion: 1e-3 };
        for order in [1, 2] {
            let mesh = graded(order, [5, 6, 7], 1.2);
            let solved = |threads: usize| {
                let solver =
                    BrickSolver::new(&mesh, slice::from_ref(&law), clamped_below(&mesh), threads);
                let mut load = wave(3 * mesh.nodes());
                solver.solve_in_place(&mut load, &[], TOLERANCE).unwrap();
                load
            };
            assert_eq!(solved(1), solved(3));
        }
    }

    #[test]
    fn all_vectors_give_the_same_bits() {
        let law = Thermoelastic { young: 200.0, poisson: 0.3, expansion: 1e-3 };
        for order in [1, 2] {
            let mesh = graded(order, [11, 3, 2], 1.2);
            let stiffness = BrickStiffness::new(&mesh, slice::from_ref(&law), clamped_below(&mesh));
            let x = wave(3 * mesh.nodes());
            let mut found = vec![0.0; x.len()];
            stiffness.apply(&x, &mut found, &Team::new(1));
            assert_eq!(found, stiffness.apply_plainly(&x));
        }
    }

    #[test]
    fn numbers_beyond_single_precision_are_taken_in_double() {
        for (finest, single) in [(1e-9_f64, false), (1e-2, true)] {
            let law = Thermoelastic { young: 2e11, poisson: 0.3, expansion: 1e-5 };
            let mut mesh = graded(2, [4, 4, 3], 1.0);
            let ends = [0.0, finest, (1e3 * finest).sqrt(), 1e3];
            mesh.axes = [(); 3].map(|()| Axis::from_element_ends(&ends, 2, Weight::Uniform));
            let solver = BrickSolver::new(&mesh, slice::from_ref(&law), clamped_below(&mesh), 1);
            assert_eq!(solver.inverse.is_single(), single, "{finest}");
            let iterations =
                solver.solve_in_place(&mut wave(3 * mesh.nodes()), &[], TOLERANCE).unwrap();
            assert!(iterations <= 40, "{finest}: {iterations}");
        }
    }
}
