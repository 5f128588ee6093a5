//! Rings on the top or the bottom of a box: its temperatures for axisymmetric drops, and the transfer from these.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use faer::Mat;

use super::face_cells::consistent;
use super::transfer::Transfer;
use crate::math::gauss::gauss_on;
use crate::math::separable::{Side, transform};
use crate::method::mesh::Mesh;
use crate::port::WallCells;

/// Rings about the middle of a face of a box, out to its nearest edge, with the functions φ that are linear between
/// their radii.
///
/// A ring's temperature is its mean over the face, interpolated between the ends of elements: `∫ φ h_i dA / ∫ φ dA` of
/// each node's. The ring's heat is distributed to the nodes with the same weights. The transfer is therefore
/// conservative and keeps uniform values uniform. Of the body's symmetry classes only the even one takes part.
pub struct FaceRings {
    mesh: Mesh,
    /// [m]
    radii: Vec<f64>,
    /// Nodes on the meshed part of the face at ends of elements along x and y.
    ends: [Vec<usize>; 2],
    /// Overlap of each ring with cells about these nodes, x fastest.
    shares: Vec<Vec<Share>>,
    /// From amounts on the linear functions to nodal vectors, along x and y of the mesh.
    consistent: [Mat<f64>; 2],
}

struct Share {
    cell: usize,
    /// Fraction of the ring, which covers an image of the cell as much as the cell.
    weight: f64,
    /// Mean outward direction times that fraction.
    outward: [f64; 2],
}

/// Numbers of integration points along the radius and along arcs for parts of a ring between the lines of the mesh.
const POINTS: [usize; 2] = [4, 4];
/// Number of parts into which a ring is cut, as circles not only touch lines of the mesh but pass through its corners.
const PARTS: usize = 4;
/// Longest arc [rad].
const ARC: f64 = 0.125 * PI;
/// Number of cells of a ring per line of the mesh: nodes of elements in two rows of these, around the whole circle.
const CELLS_OF_A_LINE: f64 = 7.0;
/// Relative distance below which two places are one.
const SAME: f64 = 1e-9;

impl FaceRings {
    /// Rings of the top or the bottom, which have equal nodes; `lumped` is set if each node has a volume of its own.
    pub fn of(mesh: &Mesh, lumped: bool) -> Self {
        let order = mesh.order();
        let ends = [0, 1].map(|axis| (0..mesh.axes[axis].len()).step_by(order).collect());
        let radii = radii(mesh);
        Self {
            shares: shares(mesh, &radii),
            mesh: mesh.clone(),
            radii,
            ends,
            consistent: [0, 1].map(|axis| match lumped {
                true => Mat::identity(mesh.axes[axis].len(), mesh.axes[axis].len()),
                false => consistent(&mesh.axes[axis]),
            }),
        }
    }

    /// Approximate memory of rings on a mesh [B]: a circle meets twice as many cells as it crosses lines.
    pub fn expected_bytes(mesh: &Mesh) -> f64 {
        let [x, y] = [0, 1].map(|axis| mesh.axes[axis].elements() as f64);
        CELLS_OF_A_LINE * size_of::<Share>() as f64 * x * (x + y)
    }

    /// Means over rings of a layer of nodes; the odd classes have none.
    fn means(&self, classes: &[Vec<f64>], layer: usize) -> Vec<f64> {
        let part = classes.get(self.even()).map_or(&[][..], Vec::as_slice);
        if part.is_empty() {
            return vec![0.0; self.radii.len()];
        }
        let [nx, ny, _] = self.mesh.node_counts();
        let plane = &part[nx * ny * layer..][..nx * ny];
        let [x, y] = &self.ends;
        let cells: Vec<f64> =
            y.iter().flat_map(|&j| x.iter().map(move |&i| plane[i + nx * j])).collect();
        let mean = |shares: &Vec<Share>| {
            shares.iter().map(|share| share.weight * cells[share.cell]).sum::<f64>()
        };
        self.shares.iter().map(mean).collect()
    }

    /// Nodal vectors, one for each symmetry class, of an amount of each ring that is uniform around it: heat, or force
    /// along z.
    fn nodal(&self, amounts: &[f64]) -> Vec<Vec<f64>> {
        self.nodal_of(amounts, |share| share.weight)
    }

    /// Nodal vectors of the component along x (0) or y (1) of outward forces.
    fn nodal_outward(&self, amounts: &[f64], axis: usize) -> Vec<Vec<f64>> {
        self.nodal_of(amounts, |share| share.outward[axis])
    }

    fn nodal_of(&self, amounts: &[f64], weight: impl Fn(&Share) -> f64) -> Vec<Vec<f64>> {
        let [nx, ny] = self.ends.each_ref().map(Vec::len);
        let mut cells = vec![0.0; nx * ny];
        let images = 1.0 / self.mesh.copies();
        for (amount, shares) in amounts.iter().zip(&self.shares) {
            for share in shares {
                cells[share.cell] += images * amount * weight(share);
            }
        }
        let one = Mat::from_fn(1, 1, |_, _| 1.0);
        let matrices = [&self.consistent[0], &self.consistent[1], &one];
        let mut vectors = vec![Vec::new(); self.mesh.parities().len()];
        vectors[self.even()] = transform(&cells, matrices, Side::Direct);
        vectors
    }

    /// Returns the class that is even about both middle planes.
    fn even(&self) -> usize {
        let parities = self.mesh.parities();
        parities.iter().position(|parity| parity.is_even()).unwrap_or(0)
    }
}

impl Transfer for FaceRings {
    fn cells(&self) -> WallCells {
        WallCells::RadialNodes { r: self.radii.clone() }
    }

    fn at_cells(&self, planes: &[Vec<f64>], count: usize) -> Vec<f64> {
        let mut parts = vec![0.0; self.radii.len() * count];
        for layer in 0..count {
            let means = self.means(planes, layer).into_iter().enumerate();
            means.for_each(|(ring, mean)| parts[ring * count + layer] = mean);
        }
        parts
    }

    fn heat(&self, amounts: &[f64], _: [bool; 2]) -> Vec<Vec<f64>> {
        self.nodal(amounts)
    }

    fn forces(
        &self,
        along: &dyn Fn(usize) -> Vec<f64>,
        _: [bool; 2],
    ) -> Vec<(usize, Vec<Vec<f64>>)> {
        let outward = along(0);
        let aside = [0, 1].map(|axis| (axis, self.nodal_outward(&outward, axis)));
        aside.into_iter().chain([(2, self.nodal(&along(2)))]).collect()
    }
}

/// The radii of rings: 0, the ends of elements along x, and the distance of the nearest edge.
fn radii(mesh: &Mesh) -> Vec<f64> {
    let [x, y] = [0, 1].map(|axis| element_ends(mesh, axis));
    let edge = [&x, &y].map(|ends| ends[ends.len() - 1]).into_iter().fold(f64::INFINITY, f64::min);
    let widths = x.windows(2).map(|pair| pair[1] - pair[0]);
    // Narrower rings would have the temperatures of others.
    let least = 0.5 * widths.fold(edge, f64::min);
    let mut radii = vec![0.0];
    for r in x {
        if r - radii[radii.len() - 1] > least && r < edge - least {
            radii.push(r);
        }
    }
    radii.push(edge);
    radii
}

/// Ends of elements along an axis, ascending [m].
fn element_ends(mesh: &Mesh, axis: usize) -> Vec<f64> {
    let axis = &mesh.axes[axis];
    axis.nodes.iter().copied().step_by(axis.order).collect()
}

/// Computes the overlap of rings and cells, by integrals along arcs between the lines of the mesh.
fn shares(mesh: &Mesh, radii: &[f64]) -> Vec<Vec<Share>> {
    let ends = [0, 1].map(|axis| element_ends(mesh, axis));
    let mut sums: Vec<BTreeMap<usize, [f64; 3]>> = vec![BTreeMap::new(); radii.len()];
    let mut areas = vec![0.0; radii.len()];
    for (ring, pair) in radii.windows(2).enumerate() {
        let [inner, outer] = [pair[0], pair[1]];
        let lines = ends.iter().flatten().map(|end| end.abs());
        let cut = |n: usize| inner + (outer - inner) * n as f64 / PARTS as f64;
        for [low, high] in pieces(lines.chain((1..PARTS).map(cut)), [inner, outer]) {
            let length = high - low;
            // A circle extends beyond a line that it touches as √(r − low).
            for (part, weight) in gauss_on(POINTS[0], 0.0, 1.0) {
                let (r, dr) = (low + length * part * part, 2.0 * length * part * weight);
                let beyond = (r - inner) / (outer - inner);
                for (at, weights) in along_circle(&ends, mesh.mirrored, r) {
                    for (ring, part) in [(ring, 1.0 - beyond), (ring + 1, beyond)] {
                        let sum = sums[ring].entry(at).or_default();
                        (0..3).for_each(|n| sum[n] += part * dr * r * weights[n]);
                        areas[ring] += part * dr * r * weights[0];
                    }
                }
            }
        }
    }
    let share = |area: f64, (cell, sum): (usize, [f64; 3])| Share {
        cell,
        weight: sum[0] / area,
        outward: [sum[1] / area, sum[2] / area],
    };
    let rings = sums.into_iter().zip(areas);
    rings.map(|(sums, area)| sums.into_iter().map(|sum| share(area, sum)).collect()).collect()
}

/// Integrals along the meshed part of a circle of the functions of cells, and of these times the cosine and the sine:
/// cell and integrals [rad], each cell once per arc that meets it.
fn along_circle(
    [x, y]: &[Vec<f64>; 2],
    mirrored: [bool; 2],
    r: f64,
) -> impl Iterator<Item = (usize, [f64; 3])> {
    let range = match mirrored {
        [true, true] => [0.0, 0.5 * PI],
        [true, false] => [-0.5 * PI, 0.5 * PI],
        [false, true] => [0.0, PI],
        [false, false] => [-PI, PI],
    };
    let crossed = |lines: &[f64]| {
        let within = lines.iter().map(|line| line / r).filter(|part| part.abs() < 1.0);
        within.collect::<Vec<f64>>()
    };
    let across_x = crossed(x).into_iter().flat_map(|part| [part.acos(), -part.acos()]);
    let upper = |part: f64| [part.asin(), PI - part.asin(), -PI - part.asin()];
    let across_y = crossed(y).into_iter().flat_map(upper);
    let long = (-8..=8).map(|n| ARC * f64::from(n));
    let mut found = Vec::new();
    for [low, high] in pieces(across_x.chain(across_y).chain(long), range) {
        let middle = 0.5 * (low + high);
        let [i, j] = [(x, middle.cos()), (y, middle.sin())]
            .map(|(lines, part)| lines.partition_point(|line| *line <= r * part));
        let [i, j] = [(i, x), (j, y)].map(|(at, lines)| at.clamp(1, lines.len() - 1) - 1);
        for (angle, weight) in gauss_on(POINTS[1], low, high) {
            let (sine, cosine) = angle.sin_cos();
            let share =
                |lines: &[f64], n: usize, at: f64| (at - lines[n]) / (lines[n + 1] - lines[n]);
            let (a, b) = (share(x, i, r * cosine), share(y, j, r * sine));
            for (column, along_x) in [(i, 1.0 - a), (i + 1, a)] {
                for (row, along_y) in [(j, 1.0 - b), (j + 1, b)] {
                    let part = weight * along_x * along_y;
                    found.push((column + x.len() * row, [part, part * cosine, part * sine]));
                }
            }
        }
    }
    found.into_iter()
}

/// Intervals into which places cut an interval.
fn pieces(places: impl Iterator<Item = f64>, [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
    let slack = SAME * (high - low);
    let mut cuts: Vec<f64> =
        places.filter(|place| *place > low + slack && *place < high - slack).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|next, kept| *next - *kept <= slack);
    let starts = std::iter::once(low).chain(cuts.iter().copied());
    starts.zip(cuts.iter().copied().chain([high])).map(|(start, end)| [start, end]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::{Axis, Geometry, Layering, Weight};
    use crate::port::Domain;

    /// A graded box, whole, half or a quarter, of linear or quadratic elements.
    fn mesh(order: usize, mirrored: [bool; 2]) -> Mesh {
        let half: Vec<f64> = (0..=6).map(|n| f64::from(n) / 10.0).chain([0.75, 1.0]).collect();
        let wide: Vec<f64> = half.iter().copied().chain([1.4]).collect();
        let axis = |half: &[f64], mirrored: bool| {
            let below = half[1..].iter().rev().map(|x| -x);
            let whole: Vec<f64> = below.chain(half.iter().copied()).collect();
            let ends = if mirrored { half } else { &whole };
            Axis::from_element_ends(ends, order, Weight::Uniform)
        };
        let depth = Axis::from_element_ends(&[-0.2, 0.0], order, Weight::Uniform);
        let axes = [axis(&wide, mirrored[0]), axis(&half, mirrored[1]), depth];
        Mesh { axes, mirrored, geometry: Geometry::Box, layering: Layering::default() }
    }

    fn meshes() -> Vec<Mesh> {
        let choices = [[false, false], [true, false], [false, true], [true, true]];
        choices.iter().flat_map(|&m| [mesh(1, m), mesh(2, m)]).collect()
    }

    /// Nodal temperatures of the even class, from a function of places.
    fn field(mesh: &Mesh, f: impl Fn(f64, f64) -> f64) -> Vec<Vec<f64>> {
        let [nx, ny, _] = mesh.node_counts();
        let at = |node: usize| f(mesh.axes[0].nodes[node % nx], mesh.axes[1].nodes[node / nx]);
        let mut classes = vec![Vec::new(); mesh.parities().len()];
        classes[0] = (0..nx * ny).map(at).collect();
        classes
    }

    fn amounts(rings: &FaceRings) -> Vec<f64> {
        (0..rings.radii.len()).map(|n| 1.0 + (n as f64).sin()).collect()
    }

    #[test]
    fn ring_transfer_is_conservative_and_radial() {
        for mesh in meshes() {
            let rings = FaceRings::of(&mesh, false);
            assert_eq!(*rings.radii.last().unwrap(), 1.0);
            let amounts = amounts(&rings);
            let given: f64 = amounts.iter().sum();
            let vectors = rings.nodal(&amounts);
            assert!(vectors[1..].iter().all(Vec::is_empty));
            let total = mesh.copies() * vectors[0].iter().sum::<f64>();
            assert!((total / given - 1.0).abs() < 1e-13, "{total} {given}");
            for axis in 0..2 {
                let force = rings.nodal_outward(&amounts, axis);
                let sum = force[0].iter().sum::<f64>();
                let whole = mesh.mirrored[axis];
                // For a half, 2/π of the force points away from the plane on average.
                let wanted = if whole { 2.0 / PI * given / mesh.copies() } else { 0.0 };
                assert!((sum - wanted).abs() < 1e-9 * given, "{axis}: {sum} {wanted}");
            }
        }
    }

    #[test]
    fn means_and_loads_are_each_others_transpose() {
        for mesh in meshes().into_iter().filter(|mesh| mesh.order() == 1) {
            let rings = FaceRings::of(&mesh, true);
            let temperatures = field(&mesh, |x, y| (3.0 * x).cos() + x * x * y * y);
            let amounts = amounts(&rings);
            let power: f64 =
                rings.at_cells(&temperatures, 1).iter().zip(&amounts).map(|(t, q)| t * q).sum();
            let top = &temperatures[0];
            let nodal = &rings.nodal(&amounts)[0];
            let of_body: f64 = top.iter().zip(nodal).map(|(t, q)| t * q).sum();
            let whole = mesh.copies() * of_body;
            assert!((whole / power - 1.0).abs() < 1e-13, "{whole} {power}");
        }
    }

    /// Even heat on all rings is that of a disc: nodal vectors as of the shape functions, where it covers them.
    #[test]
    fn even_heat_on_rings_is_even_on_the_face() {
        for mesh in meshes() {
            let rings = FaceRings::of(&mesh, false);
            let areas = rings.cells().areas(Domain::whole(3));
            let vector = &rings.nodal(&areas)[0];
            let [x, y] = [0, 1].map(|axis| mesh.axes[axis].integrals());
            let nx = x.len();
            for (node, found) in vector.iter().enumerate() {
                let [i, j] = [node % nx, node / nx];
                let place = [mesh.axes[0].nodes[i], mesh.axes[1].nodes[j]];
                if place[0].hypot(place[1]) > 0.5 {
                    continue;
                }
                let exact = x[i] * y[j];
                assert!((found / exact - 1.0).abs() < 1e-4, "{place:?}: {found} {exact}");
            }
        }
    }

    /// r² between lines a distance h apart is h²/6 too high on each axis; no plane has a mean.
    #[test]
    fn rings_are_as_warm_as_the_face_below_them() {
        for mesh in meshes() {
            let rings = FaceRings::of(&mesh, false);
            let even = rings.at_cells(&field(&mesh, |_, _| 1.0), 1);
            assert!(even.iter().all(|mean| (mean - 1.0).abs() < 1e-13), "{even:?}");
            let found = rings.at_cells(&field(&mesh, |x, y| x * x + y * y), 1);
            for (n, mean) in found.iter().enumerate().take(5) {
                // Of r² over a function that is linear on both sides of n h, with the same error of its own.
                let h = 0.1;
                let r = n as f64 * h;
                let exact = if n == 0 { 0.3 * h * h } else { r * r + 0.5 * h * h };
                assert!((mean - exact - h * h / 3.0).abs() < 0.03 * h * h, "{n}: {mean} {exact}");
            }
            if mesh.mirrored == [false; 2] {
                let tilted = rings.at_cells(&field(&mesh, |x, y| x - 2.0 * y), 1);
                assert!(tilted.iter().all(|mean| mean.abs() < 1e-13), "{tilted:?}");
            }
        }
    }
}
