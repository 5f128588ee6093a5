//! Cells of the top or the bottom of a solid: its temperatures for the body there, and the transfer from that body.

use faer::Mat;

use crate::math::gauss::gauss_on;
use crate::math::separable::{Side, transform};
use crate::method::mesh::{Axis, Geometry, Mesh};
use crate::port::WallCells;

use super::symmetry::split_load;
use super::transfer::Transfer;

/// The whole top or bottom of a solid, including mirror images, in cells about the ends of elements.
///
/// Other bodies transfer heat and force to functions that are linear between the ends of elements. As densities, these
/// become the nodal vectors of the elements' own shape functions. Both sets of functions sum to one everywhere, so the
/// transfer is conservative, and uniform values stay uniform. As the shape functions can represent those densities, the
/// surface follows them without overshoot: it is never warmer than the fluid that warms it.
pub struct FaceCells {
    mesh: Mesh,
    /// `(node, whether it is the image)` of the ends of elements along x and y, coordinates ascending.
    places: [Vec<(usize, bool)>; 2],
    /// From amounts on the linear functions to nodal vectors, along x and y of the mesh.
    consistent: [Mat<f64>; 2],
}

impl FaceCells {
    /// Cells of the top or the bottom, which have equal nodes; `lumped` is set for particles, each of which has a
    /// volume of its own.
    pub fn of(mesh: &Mesh, lumped: bool) -> Self {
        Self {
            mesh: mesh.clone(),
            places: [0, 1].map(|axis| {
                let order = mesh.order();
                let is_end = |&(node, _): &(usize, bool)| node % order == 0;
                mesh.unfolded(axis).into_iter().filter(is_end).collect()
            }),
            consistent: [0, 1].map(|axis| match lumped {
                true => Mat::identity(mesh.axes[axis].len(), mesh.axes[axis].len()),
                false => consistent(&mesh.axes[axis]),
            }),
        }
    }

    /// Returns the whole face from a layer of nodes of each symmetry class; classes that are zero are empty.
    fn unfolded(&self, classes: &[Vec<f64>], layer: usize) -> Vec<f64> {
        let [nx, ny, _] = self.mesh.node_counts();
        let first = nx * ny * layer;
        let mut whole = vec![0.0; self.places[0].len() * self.places[1].len()];
        let parts = self.mesh.parities().into_iter().zip(classes);
        for (parity, part) in parts.filter(|(_, part)| !part.is_empty()) {
            for (row, &(j, image_y)) in
                whole.chunks_exact_mut(self.places[0].len()).zip(&self.places[1])
            {
                for (value, &(i, image_x)) in row.iter_mut().zip(&self.places[0]) {
                    *value += parity.sign([image_x, image_y]) * part[first + i + nx * j];
                }
            }
        }
        whole
    }

    /// Nodal vectors, one for each symmetry class, of an amount at each cell: heat, or a component of a force whose
    /// sign mirrors reverse along the axes in `flips`. Classes that are odd about a plane in which the fluid is
    /// `symmetric` have none.
    fn nodal(&self, amounts: &[f64], flips: [bool; 2], symmetric: [bool; 2]) -> Vec<Vec<f64>> {
        let one = Mat::from_fn(1, 1, |_, _| 1.0);
        let matrices = [&self.consistent[0], &self.consistent[1], &one];
        let of_image = |image| transform(&self.seen(amounts, image), matrices, Side::Direct);
        let mut vectors = split_load(&self.mesh, flips, of_image);
        for (parity, vector) in self.mesh.parities().iter().zip(&mut vectors) {
            if (0..2).any(|axis| symmetric[axis] && parity.odd[axis]) {
                vector.clear();
            }
        }
        vectors
    }

    /// Amounts on the meshed part as seen at its image; the symmetry planes halve those on them.
    fn seen(&self, amounts: &[f64], image: [bool; 2]) -> Vec<f64> {
        let [nx, ny] = [0, 1].map(|axis| self.consistent[axis].ncols());
        let place = |axis: usize, node: usize| match (self.mesh.mirrored[axis], image[axis]) {
            (false, _) => (node, 1.0),
            (true, is_image) => {
                let middle = self.consistent[axis].ncols() - 1;
                let at = if is_image { middle - node } else { middle + node };
                (at, if node == 0 { 0.5 } else { 1.0 })
            }
        };
        let width = self.places[0].len();
        let mut out = Vec::with_capacity(nx * ny);
        for j in 0..ny {
            let (row, share_y) = place(1, j);
            for i in 0..nx {
                let (column, share_x) = place(0, i);
                out.push(share_x * share_y * amounts[column + width * row]);
            }
        }
        out
    }
}

impl Transfer for FaceCells {
    fn cells(&self) -> WallCells {
        let [x, y] = [0, 1].map(|a| {
            let signed = |&(node, image): &(usize, bool)| {
                let at = self.mesh.axes[a].nodes[node];
                if image { -at } else { at }
            };
            self.places[a].iter().map(signed).collect::<Vec<f64>>()
        });
        match self.mesh.geometry {
            Geometry::Box => WallCells::Nodes { x, y },
            Geometry::Axisymmetric => WallCells::RadialNodes { r: x },
        }
    }

    fn at_cells(&self, planes: &[Vec<f64>], count: usize) -> Vec<f64> {
        let cells = self.places[0].len() * self.places[1].len();
        let mut parts = vec![0.0; cells * count];
        for layer in 0..count {
            let values = self.unfolded(planes, layer).into_iter().enumerate();
            values.for_each(|(cell, value)| parts[cell * count + layer] = value);
        }
        parts
    }

    fn heat(&self, amounts: &[f64], symmetric: [bool; 2]) -> Vec<Vec<f64>> {
        self.nodal(amounts, [false; 2], symmetric)
    }

    fn forces(
        &self,
        along: &dyn Fn(usize) -> Vec<f64>,
        symmetric: [bool; 2],
    ) -> Vec<(usize, Vec<Vec<f64>>)> {
        match self.mesh.geometry {
            Geometry::Box => {
                let flips = [[true, false], [false, true], [false; 2]];
                let nodal = |axis| (axis, self.nodal(&along(axis), flips[axis], symmetric));
                (0..3).map(nodal).collect()
            }
            Geometry::Axisymmetric => {
                let radial = self.nodal(&along(0), [true, false], symmetric);
                vec![(0, radial), (1, self.nodal(&along(2), [false; 2], symmetric))]
            }
        }
    }
}

/// `∫ N_i h_j w dx / ∫ h_j w dx` for shape functions N and functions h that are linear between the ends of
/// elements; every column sums to 1.
pub(super) fn consistent(axis: &Axis) -> Mat<f64> {
    let n = axis.len();
    if n == 1 {
        return Mat::from_fn(1, 1, |_, _| 1.0);
    }
    let mut matrix = Mat::<f64>::zeros(n, axis.elements() + 1);
    for below in 0..axis.elements() {
        let [a, b] = axis.bounds(below);
        // Linear times quadratic times the radius: four Gauss points are exact.
        for (x, w) in gauss_on(4, a, b) {
            let weight = w * axis.weight_at(x);
            let shape = axis.shape_in(below, x);
            let share = (x - a) / (b - a);
            for (j, hat) in [(below, 1.0 - share), (below + 1, share)] {
                for i in 0..shape.count {
                    matrix[(shape.first + i, j)] += weight * hat * shape.values[i];
                }
            }
        }
    }
    for j in 0..matrix.ncols() {
        let sum: f64 = (0..n).map(|i| matrix[(i, j)]).sum();
        (0..n).for_each(|i| matrix[(i, j)] /= sum);
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::{Layering, Weight};

    fn mesh(order: usize, mirrored: [bool; 2]) -> Mesh {
        let half = [0.0, 0.1, 0.3, 1.0];
        let whole = [-1.0, -0.2, 0.0, 0.3, 1.0];
        let axis = |mirrored: bool| {
            let ends: &[f64] = if mirrored { &half } else { &whole };
            Axis::from_element_ends(ends, order, Weight::Uniform)
        };
        let depth = Axis::from_element_ends(&[-0.2, 0.0], order, Weight::Uniform);
        let axes = [axis(mirrored[0]), axis(mirrored[1]), depth];
        Mesh { axes, mirrored, geometry: Geometry::Box, layering: Layering::default() }
    }

    fn meshes() -> Vec<Mesh> {
        let choices = [[false, false], [true, false], [true, true]];
        choices.iter().flat_map(|&m| [mesh(1, m), mesh(2, m)]).collect()
    }

    /// Transfer from a place to the cells.
    fn given(face: &FaceCells, x: f64, y: f64, amount: f64) -> Vec<f64> {
        let cells = face.cells();
        let mut out = vec![0.0; cells.len()];
        for (cell, weight) in cells.cover([[x; 2], [y; 2]]).cells {
            out[cell] += weight * amount;
        }
        out
    }

    #[test]
    fn transfer_is_conservative_everywhere() {
        for mesh in meshes() {
            let face = FaceCells::of(&mesh, false);
            for (x, y) in [(0.0, 0.0), (-0.33, 0.2), (0.7, -1.0), (0.05, 0.05)] {
                let parts = face.nodal(&given(&face, x, y, 3.0), [false; 2], [false; 2]);
                let total = mesh.copies() * parts[0].iter().sum::<f64>();
                assert!((total - 3.0).abs() < 1e-13, "{total} at {x}, {y}");
            }
        }
    }

    #[test]
    fn force_parts_sum_to_the_force_on_each_side() {
        let mesh = mesh(2, [true, false]);
        let face = FaceCells::of(&mesh, false);
        let flips = [true, false]; // A force along x.
        let parts = face.nodal(&given(&face, -0.6, 0.1, 2.0), flips, [false; 2]);
        let side = |image: bool| -> f64 {
            let signs = mesh.parities().into_iter().map(|p| p.vector_sign([image, false], 0));
            signs.zip(&parts).map(|(sign, part)| sign * part.iter().sum::<f64>()).sum()
        };
        assert!(side(false).abs() < 1e-14);
        assert!((side(true) - 2.0).abs() < 1e-14);
    }

    #[test]
    fn uniform_density_is_the_consistent_load() {
        let mesh = mesh(2, [false, false]);
        let face = FaceCells::of(&mesh, false);
        let [x, y] = [&mesh.axes[0], &mesh.axes[1]];
        let widths = |axis: &Axis| -> Vec<f64> {
            let ends: Vec<f64> = axis.nodes.iter().copied().step_by(2).collect();
            let at = |i: usize| ends[i.min(ends.len() - 1)];
            (0..ends.len()).map(|i| 0.5 * (at(i + 1) - at(i.saturating_sub(1)))).collect()
        };
        let amounts: Vec<f64> =
            widths(y).iter().flat_map(|b| widths(x).into_iter().map(move |a| a * b)).collect();
        let parts = face.nodal(&amounts, [false; 2], [false; 2]);
        let exact =
            y.integrals().into_iter().flat_map(|b| x.integrals().into_iter().map(move |a| a * b));
        for (value, exact) in parts[0].iter().zip(exact) {
            assert!((value - exact).abs() < 1e-14, "{value} {exact}");
        }
    }

    #[test]
    fn symmetric_fluid_has_no_odd_part() {
        let mesh = mesh(1, [true, true]);
        let face = FaceCells::of(&mesh, false);
        let amounts: Vec<f64> = (0..face.cells().len()).map(|i| 1.0 + 1e-16 * i as f64).collect();
        let parts = face.nodal(&amounts, [false; 2], [true; 2]);
        assert!(!parts[0].is_empty() && parts[1..].iter().all(Vec::is_empty));
    }

    #[test]
    fn temperatures_are_seen_on_both_sides_of_a_mirror() {
        let mesh = mesh(1, [true, false]);
        let face = FaceCells::of(&mesh, false);
        let [nx, ny, _] = mesh.node_counts();
        let field = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..nx * ny).map(|node| f(mesh.axes[0].nodes[node % nx])).collect()
        };
        let rise = face.at_cells(&[field(&|x| x * x), field(&|x| x)], 1);
        let WallCells::Nodes { x, .. } = face.cells() else { unreachable!() };
        for (i, rise) in rise.iter().enumerate() {
            let x = x[i % x.len()];
            assert!((rise - (x * x + x)).abs() < 1e-15);
        }
    }

    #[test]
    fn rings_about_an_axis_keep_the_sum_too() {
        let r = Axis::from_element_ends(&[0.0, 0.2, 1.0], 2, Weight::Radial);
        let z = Axis::from_element_ends(&[-0.2, 0.0], 2, Weight::Uniform);
        let axes = [r, Axis::point(), z];
        let mesh = Mesh {
            axes,
            mirrored: [false; 2],
            geometry: Geometry::Axisymmetric,
            layering: Layering::default(),
        };
        let face = FaceCells::of(&mesh, false);
        for x in [0.0, 0.05, 0.6] {
            let parts = face.nodal(&given(&face, x, 0.0, 1.0), [true, false], [true; 2]);
            assert!((parts[0].iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}
