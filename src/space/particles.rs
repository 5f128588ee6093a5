//! Total-Lagrangian smoothed particles: gradients are corrected sums over the neighbours of the reference state.
//!
//! The deformation gradient of a particle a with neighbours b of volumes V is `F_a = Σ V_b (x_b − x_a) ⊗ B_a ∇₀W_ab`,
//! with `B_a = [Σ V_b (X_b − X_a) ⊗ ∇₀W_ab]⁻¹` (J. Bonet & T.-S. L. Lok 1999, doi 10.1016/S0045-7825(99)00051-1): exact
//! for affine motion. The forces that do the work of the stresses at the particles are the antisymmetric pair forces of
//! total-Lagrangian SPH.
//!
//! One gradient for each particle does not see motion that alternates between neighbours. So second derivatives are
//! fitted, with the same weights, to what F_a leaves over of the neighbours' displacements. They give the gradient in
//! each quarter (eighth) of a particle's cell, where the stress is taken: no mode but rigid ones is without energy, and
//! there is no constant to be chosen. Beside a face that only one row of neighbours lies behind, they are not [`seen`]
//! across it, and zero. The points of a particle share one dilatation. Gradients are then made
//! [`consistent`].

mod consistent;
mod seen;

use consistent::{balance, whole_surface};
use seen::Seen;

use super::bins::Bins;
use super::factor::Factor;
use super::finite_elements::{boundary, sample};
use super::reproducing::{Refused, Shape, spacings};
use super::{Boundary, Cloud, Form, Mesh, Samples, Sharing, Space, Value};
use crate::kernel::{CubicSpline, Shape as Kernel};

/// A point at which the stress is taken.
struct Point {
    at: [f64; 3],
    weight: f64,
    row: Vec<Value>,
}

/// Part of a particle's cell: place and volume.
struct Part {
    at: [f64; 3],
    weight: f64,
}

/// Coordinates of the centres of both halves of a cell.
const HALVES: [f64; 2] = [0.25, 0.75];

/// Creates the space of particles at a mesh's nodes, with supports of a radius in spacings of nodes. Affine motion is
/// exact, and the nodal forces of a constant stress are its tractions.
pub fn particles(mesh: &Mesh, support: f64) -> Result<Space, Refused> {
    let parts = parts(mesh);
    let widest = |spacing: [f64; 3]| spacing.into_iter().fold(0.0, f64::max);
    let reach = spacings(mesh, Shape::Box).into_iter().map(|s| support * widest(s)).collect();
    let flat = |part: &Part| part.weight / mesh.form.depth(part.at);
    let volumes = parts.iter().map(|parts| parts.iter().map(flat).sum()).collect();
    let around = Around::new(mesh.form, &mesh.nodes, reach, volumes);
    let points = around.points(&parts, &whole_surface(mesh))?;
    let shares = parts.iter().map(|parts| parts.iter().map(|part| part.weight).sum()).collect();
    Ok(space((mesh.form, &mesh.nodes), points, boundary(mesh), shares, mesh.edges()))
}

/// Creates the space of particles at given points; see [`particles`]. The surface is that of the points' patches, and
/// the cell of a point on it lies behind these.
pub fn particles_of_cloud(cloud: &Cloud, support: f64) -> Result<Space, Refused> {
    let reach = cloud.spacings().into_iter().map(|spacing| support * spacing).collect();
    let around = Around::new(cloud.form, &cloud.nodes, reach, cloud.volumes.clone());
    let boundary = around.boundary(cloud)?;
    let points = around.points(&parts_of_cloud(cloud), &boundary)?;
    let nodes = (cloud.form, &cloud.nodes[..]);
    Ok(space(nodes, points, boundary, cloud.volumes.clone(), cloud.neighbours()))
}

fn space(
    (form, nodes): (Form, &[[f64; 3]]),
    points: Vec<Vec<Point>>,
    boundary: Boundary,
    shares: Vec<f64>,
    links: Vec<[u32; 2]>,
) -> Space {
    let mut volume = Samples::default();
    let mut groups = Vec::new();
    for points in points {
        let first = volume.len();
        points.into_iter().for_each(|point| volume.push(point.at, point.weight, point.row));
        groups.push(first..volume.len());
    }
    Space {
        form,
        order: 1,
        nodes: nodes.to_vec(),
        volume,
        groups,
        sharing: Sharing::Mean,
        boundary,
        at_nodes: None,
        shares,
        links,
    }
}

/// The quarters or eighths of a square or cube of each point's volume, about the centre of the point's cell.
fn parts_of_cloud(cloud: &Cloud) -> Vec<Vec<Part>> {
    let axes = cloud.form.axes();
    let count = 1 << axes.len();
    let of_point = |(volume, centre): (&f64, [f64; 3])| {
        let quarter = 0.25 * volume.powf(1.0 / axes.len() as f64);
        let part = |corner: usize| {
            let mut at = centre;
            for (bit, &axis) in axes.iter().enumerate() {
                at[axis] += if corner >> bit & 1 == 1 { quarter } else { -quarter };
            }
            Part { at, weight: volume / count as f64 }
        };
        (0..count).map(part).collect()
    };
    cloud.volumes.iter().zip(cloud.centres()).map(of_point).collect()
}

/// The parts of each node's cell: of every cell of the mesh the quarter or eighth next to it.
fn parts(mesh: &Mesh) -> Vec<Vec<Part>> {
    let mut parts: Vec<Vec<Part>> = mesh.nodes.iter().map(|_| Vec::new()).collect();
    for cell in &mesh.cells {
        for (corner, &node) in cell.iter().enumerate() {
            let local = match mesh.form {
                Form::Solid => [corner & 1, corner >> 1 & 1, corner >> 2].map(|bit| HALVES[bit]),
                _ => [HALVES[corner & 1], 0.0, HALVES[corner >> 1]],
            };
            let (at, weight, _) = sample(mesh, cell, (local, 1.0 / cell.len() as f64));
            parts[node as usize].push(Part { at, weight });
        }
    }
    parts
}

/// Particles with the supports of all.
struct Around<'a> {
    form: Form,
    nodes: &'a [[f64; 3]],
    /// Radii of supports [m].
    reach: Vec<f64>,
    /// Volumes, areas in a plane and in a meridian section.
    volumes: Vec<f64>,
    bins: Bins,
}

/// A neighbour of a particle.
struct Neighbour<const D: usize> {
    node: u32,
    /// `X_b − X_a` over the radius of a's support.
    y: [f64; D],
    /// `V_b |∇₀W|/|X_b − X_a|`, up to a factor that all share.
    weight: f64,
}

impl<'a> Around<'a> {
    fn new(form: Form, nodes: &'a [[f64; 3]], reach: Vec<f64>, volumes: Vec<f64>) -> Self {
        // Supports differ in their radii: a place is near to all nodes that the widest support would reach.
        let most = reach.iter().copied().fold(0.0, f64::max);
        let supports: Vec<[[f64; 3]; 2]> =
            nodes.iter().map(|at| [at.map(|x| x - most), at.map(|x| x + most)]).collect();
        let mean = reach.iter().sum::<f64>() / reach.len() as f64;
        let bins = Bins::new(form.axes(), &supports, [mean; 3]);
        Self { form, nodes, reach, volumes, bins }
    }

    /// Points at the parts of each particle's cell, whose forces balance with a surface.
    fn points(&self, parts: &[Vec<Part>], surface: &Boundary) -> Result<Vec<Vec<Point>>, Refused> {
        let rows_of = |(node, parts): (usize, &Vec<Part>)| self.rows_of(node, parts);
        let mut points: Vec<Vec<Point>> =
            parts.iter().enumerate().map(rows_of).collect::<Result<_, _>>()?;
        let nodes = (self.form, self.nodes);
        match self.form {
            Form::Solid => balance::<4>(nodes, surface, &mut points)?,
            Form::Plane | Form::Axisymmetric => balance::<3>(nodes, surface, &mut points)?,
        }
        Ok(points)
    }

    /// The patches of a cloud's surface: at each the function of its point, with the gradient of all around.
    fn boundary(&self, cloud: &Cloud) -> Result<Boundary, Refused> {
        let mut boundary = Boundary::default();
        for patch in &cloud.patches {
            let node = patch.node as usize;
            let at = Part { at: self.nodes[node], weight: patch.area() };
            let row = self.rows_of(node, &[at])?.remove(0).row;
            boundary.samples.push(self.nodes[node], patch.area(), row);
            boundary.normals.push(patch.normal());
            boundary.sides.push(patch.side);
        }
        Ok(boundary)
    }

    fn rows_of(&self, node: usize, parts: &[Part]) -> Result<Vec<Point>, Refused> {
        match self.form {
            Form::Solid => self.rows::<3, 6>([0, 1, 2], node, parts),
            Form::Plane | Form::Axisymmetric => self.rows::<2, 3>([0, 2], node, parts),
        }
    }

    fn neighbours<const D: usize>(&self, axes: [usize; D], node: usize) -> Vec<Neighbour<D>> {
        let (at, reach) = (self.nodes[node], self.reach[node]);
        let of = |&other: &u32| {
            let y = axes.map(|a| (self.nodes[other as usize][a] - at[a]) / reach);
            let q = y.iter().map(|y| y * y).sum::<f64>().sqrt();
            let weight = -self.volumes[other as usize] * CubicSpline.slope_over_q(q);
            (other as usize != node && q < 1.0 && weight > 0.0).then_some(Neighbour {
                node: other,
                y,
                weight,
            })
        };
        self.bins.near(at).iter().filter_map(of).collect()
    }

    /// Rows of the parts of a particle's cell.
    fn rows<const D: usize, const M: usize>(
        &self,
        axes: [usize; D],
        node: usize,
        parts: &[Part],
    ) -> Result<Vec<Point>, Refused> {
        let neighbours = self.neighbours(axes, node);
        let few = || Refused::FewParticles { at: self.nodes[node], neighbours: neighbours.len() };
        let fits = fits::<D, M>(&neighbours).ok_or_else(few)?;
        let of_part = |part: &Part| {
            let offset = axes.map(|a| (part.at[a] - self.nodes[node][a]) / self.reach[node]);
            let mut own = Value { node: node as u32, value: 1.0, gradient: [0.0; 3] };
            let mut row = Vec::with_capacity(neighbours.len() + 1);
            for (neighbour, fit) in neighbours.iter().zip(&fits) {
                let (value, slope) = fit.at(offset);
                let mut gradient = [0.0; 3];
                axes.iter().zip(slope).for_each(|(&a, s)| gradient[a] = s / self.reach[node]);
                own.value -= value;
                (0..3).for_each(|a| own.gradient[a] -= gradient[a]);
                row.push(Value { node: neighbour.node, value, gradient });
            }
            row.push(own);
            Point { at: part.at, weight: part.weight, row }
        };
        Ok(parts.iter().map(of_part).collect())
    }
}

/// Share of a neighbour's displacement in the derivatives at a particle.
struct Fit<const D: usize, const M: usize> {
    first: [f64; D],
    /// Factors of the [`quadratics`].
    second: [f64; M],
}

impl<const D: usize, const M: usize> Fit<D, M> {
    /// Value and gradient at an offset from the particle.
    fn at(&self, y: [f64; D]) -> (f64, [f64; D]) {
        let terms = quadratics::<D, M>(y);
        let mut gradient = self.first;
        let mut value = (0..D).map(|a| self.first[a] * y[a]).sum::<f64>();
        for (k, (a, b)) in pairs::<D>().enumerate() {
            value += self.second[k] * terms[k];
            gradient[a] += self.second[k] * y[b];
            if a != b {
                gradient[b] += self.second[k] * y[a];
            }
        }
        (value, gradient)
    }
}

/// Pairs of coordinates of the second derivatives.
fn pairs<const D: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..D).flat_map(|a| (a..D).map(move |b| (a, b)))
}

/// The quadratic terms of a Taylor series.
fn quadratics<const D: usize, const M: usize>(y: [f64; D]) -> [f64; M] {
    let mut terms = [0.0; M];
    for (term, (a, b)) in terms.iter_mut().zip(pairs::<D>()) {
        *term = if a == b { 0.5 * y[a] * y[a] } else { y[a] * y[b] };
    }
    terms
}

/// Least-squares fit of first and second derivatives; `None` if the neighbours do not determine them.
fn fits<const D: usize, const M: usize>(neighbours: &[Neighbour<D>]) -> Option<Vec<Fit<D, M>>> {
    let linear = Factor::of(&moments(neighbours, |neighbour| neighbour.y))?;
    let first: Vec<[f64; D]> =
        neighbours.iter().map(|own| linear.solve(own.y.map(|y| own.weight * y))).collect();
    // Gradients that the linear fit finds in the quadratic terms, where neighbours lie on one side.
    let mut found = [[0.0; D]; M];
    for (own, gradient) in neighbours.iter().zip(&first) {
        for (found, term) in found.iter_mut().zip(quadratics::<D, M>(own.y)) {
            (0..D).for_each(|a| found[a] += term * gradient[a]);
        }
    }
    let rest = |own: &Neighbour<D>| -> [f64; M] {
        let mut rest = quadratics::<D, M>(own.y);
        for (rest, found) in rest.iter_mut().zip(&found) {
            *rest -= (0..D).map(|a| found[a] * own.y[a]).sum::<f64>();
        }
        rest
    };
    let whole = moments(neighbours, |own| quadratics::<D, M>(own.y));
    let quadratic = Seen::of(moments(neighbours, rest), &whole)?;
    let second = |own: &Neighbour<D>| quadratic.solve(rest(own).map(|term| own.weight * term));
    let fit = |(own, first): (&Neighbour<D>, &[f64; D])| {
        let (mut first, second) = (*first, second(own));
        for (factor, found) in second.iter().zip(&found) {
            (0..D).for_each(|a| first[a] -= factor * found[a]);
        }
        Fit { first, second }
    };
    Some(neighbours.iter().zip(&first).map(fit).collect())
}

/// Lower triangle of `Σ w t tᵀ`.
fn moments<const D: usize, const N: usize>(
    neighbours: &[Neighbour<D>],
    terms: impl Fn(&Neighbour<D>) -> [f64; N],
) -> [[f64; N]; N] {
    let mut sums = [[0.0; N]; N];
    for neighbour in neighbours {
        let own = terms(neighbour);
        for i in 0..N {
            (0..=i).for_each(|j| sums[i][j] += neighbour.weight * own[i] * own[j]);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Patch;

    fn number(n: usize) -> f64 {
        (n as f64 * 0.618_033_988_749_895).fract() - 0.5
    }

    /// A box whose inner nodes are moved at random by a part of the spacing.
    fn uneven(form: Form, part: f64) -> Mesh {
        let mut mesh = Mesh::of_box(form, [1.0, -1.0, -3.0], [3.0, 1.0, 0.0], [5, 4, 7]);
        for (n, at) in mesh.nodes.iter_mut().enumerate() {
            let inside =
                [at[0] > 1.01 && at[0] < 2.99, at[1].abs() < 0.99, at[2] > -2.99 && at[2] < -0.01];
            for &a in form.axes().iter().filter(|&&a| inside[a]) {
                at[a] += part * 0.4 * number(3 * n + a);
            }
        }
        mesh
    }

    /// A box of points with shaken inner ones, its surface in patches, one or more a point.
    fn cloud(form: Form, part: f64) -> Cloud {
        let mesh = uneven(form, part);
        let elements = crate::space::finite_elements(&mesh);
        let boundary = &elements.boundary;
        let mut vectors = std::collections::BTreeMap::new();
        for (point, (side, normal)) in boundary.sides.iter().zip(&boundary.normals).enumerate() {
            for own in boundary.samples.row(point) {
                let vector = vectors.entry((own.node, *side)).or_insert([0.0; 3]);
                let share = own.value * boundary.samples.weights[point];
                (0..3).for_each(|a| vector[a] += share * normal[a]);
            }
        }
        let patch = |((node, side), vector)| Patch { node, side, vector };
        let patches = vectors.into_iter().map(patch).collect();
        Cloud::new(form, mesh.nodes, elements.shares, patches).unwrap()
    }

    /// Affine motion of points without cells is exact, and a constant stress balances with the patches of the surface.
    #[test]
    fn points_without_cells_pass_the_patch_test() {
        for form in [Form::Plane, Form::Solid] {
            let cloud = cloud(form, 0.5);
            let space = particles_of_cloud(&cloud, 2.5).unwrap();
            let slope = [-0.2, if form == Form::Solid { 0.5 } else { 0.0 }, 0.7];
            let field = |at: [f64; 3]| 0.3 + (0..3).map(|a| slope[a] * at[a]).sum::<f64>();
            let mut forces = vec![[0.0; 3]; space.nodes.len()];
            for point in 0..space.volume.len() {
                let mut gradient = [0.0; 3];
                for own in space.volume.row(point) {
                    let u = field(space.nodes[own.node as usize]);
                    let force = &mut forces[own.node as usize];
                    for a in 0..3 {
                        gradient[a] += own.gradient[a] * u;
                        force[a] -= space.volume.weights[point] * own.gradient[a];
                    }
                }
                assert!((0..3).all(|a| (gradient[a] - slope[a]).abs() < 1e-11), "{gradient:?}");
            }
            for (n, normal) in space.boundary.normals.iter().enumerate() {
                for own in space.boundary.samples.row(n) {
                    let part = space.boundary.samples.weights[n] * own.value;
                    (0..3).for_each(|a| forces[own.node as usize][a] += part * normal[a]);
                }
            }
            let most = forces.iter().flatten().fold(0.0, |most: f64, f| most.max(f.abs()));
            assert!(most < 1e-10, "{form:?} {most:e}");
            let whole: f64 = space.volume.weights.iter().sum();
            let wanted = if form == Form::Solid { 12.0 } else { 6.0 };
            assert!((whole / wanted - 1.0).abs() < 1e-12 && space.shares == cloud.volumes);
        }
    }

    /// Patches that miss the volume by little are closed: `Σ a = 0`, `Σ X ⊗ a = V 1`.
    #[test]
    fn surfaces_that_are_nearly_closed_are_closed() {
        let exact = cloud(Form::Solid, 0.5);
        let shake = |(n, patch): (usize, &Patch)| {
            let vector = patch.vector.map(|x| x * (1.0 + 0.02 * number(n)));
            Patch { vector, ..*patch }
        };
        let patches: Vec<Patch> = exact.patches.iter().enumerate().map(shake).collect();
        let (nodes, volumes) = (exact.nodes.clone(), exact.volumes.clone());
        let closed = Cloud::new(Form::Solid, nodes, volumes, patches).unwrap();
        let whole: f64 = closed.volumes.iter().sum();
        for a in 0..3 {
            let sum: f64 = closed.patches.iter().map(|patch| patch.vector[a]).sum();
            assert!(sum.abs() < 1e-12, "{sum:e}");
            for b in 0..3 {
                let at = |patch: &Patch| closed.nodes[patch.node as usize][b];
                let sum: f64 = closed.patches.iter().map(|own| own.vector[a] * at(own)).sum();
                let wanted = if a == b { whole } else { 0.0 };
                assert!((sum - wanted).abs() < 1e-11, "{a} {b} {sum}");
            }
        }
    }

    #[test]
    fn affine_fields_are_exact_and_volumes_add_up() {
        for form in [Form::Plane, Form::Axisymmetric, Form::Solid] {
            let mesh = uneven(form, 0.5);
            let space = particles(&mesh, 2.5).unwrap();
            let field = |at: [f64; 3]| 0.3 - 0.2 * at[0] + 0.5 * at[1] + 0.7 * at[2];
            let slope = [-0.2, if form == Form::Solid { 0.5 } else { 0.0 }, 0.7];
            for point in 0..space.volume.len() {
                let (mut value, mut gradient) = (0.0, [0.0; 3]);
                for own in space.volume.row(point) {
                    let u = field(space.nodes[own.node as usize]);
                    value += own.value * u;
                    (0..3).for_each(|a| gradient[a] += own.gradient[a] * u);
                }
                assert!((value - field(space.volume.at[point])).abs() < 1e-12);
                assert!((0..3).all(|a| (gradient[a] - slope[a]).abs() < 1e-11), "{gradient:?}");
            }
            let whole: f64 = space.shares.iter().sum();
            let wanted = match form {
                Form::Plane => 6.0,
                Form::Axisymmetric => std::f64::consts::PI * 8.0 * 3.0,
                Form::Solid => 12.0,
            };
            assert!((whole / wanted - 1.0).abs() < 1e-3, "{form:?} {whole}");
        }
    }

    #[test]
    fn quadratic_fields_are_near() {
        let space = particles(&uneven(Form::Solid, 0.5), 2.6).unwrap();
        let field = |[x, y, z]: [f64; 3]| x * x - 0.5 * x * y + 0.3 * z * z + y * z;
        for point in 0..space.volume.len() {
            let [x, y, z] = space.volume.at[point];
            let wanted = [2.0 * x - 0.5 * y, -0.5 * x + z, 0.6 * z + y];
            let mut gradient = [0.0; 3];
            for own in space.volume.row(point) {
                let u = field(space.nodes[own.node as usize]);
                (0..3).for_each(|a| gradient[a] += own.gradient[a] * u);
            }
            assert!(
                (0..3).all(|a| (gradient[a] - wanted[a]).abs() < 0.3),
                "{gradient:?} {wanted:?}"
            );
        }
    }

    /// Nodal forces of a constant stress are its tractions, also on the axis and on planes of symmetry.
    #[test]
    fn constant_stress_balances() {
        for mesh in [
            uneven(Form::Plane, 0.5),
            uneven(Form::Axisymmetric, 0.5),
            uneven(Form::Solid, 0.5),
            Mesh::of_box(Form::Axisymmetric, [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [5, 1, 6]),
            Mesh::of_ball(Form::Plane, 1.0, 3, 3, [true, false]),
        ] {
            let space = particles(&mesh, 2.5).unwrap();
            let mut forces = vec![[0.0; 3]; space.nodes.len()];
            for (n, normal) in space.boundary.normals.iter().enumerate() {
                for own in space.boundary.samples.row(n) {
                    let part = space.boundary.samples.weights[n] * own.value;
                    (0..3).for_each(|a| forces[own.node as usize][a] += part * normal[a]);
                }
            }
            for point in 0..space.volume.len() {
                let weight = space.volume.weights[point];
                for own in space.volume.row(point) {
                    let hoop = match mesh.form {
                        Form::Axisymmetric => own.value / space.volume.at[point][0],
                        _ => 0.0,
                    };
                    let force = &mut forces[own.node as usize];
                    (0..3).for_each(|a| force[a] -= weight * own.gradient[a]);
                    force[0] -= weight * hoop;
                }
            }
            let held = |at: f64| at == 0.0 && mesh.nodes.iter().all(|node| node[0] >= 0.0);
            for (force, at) in forces.iter().zip(&space.nodes) {
                let is_free = |&&a: &&usize| a != 0 || !held(at[0]);
                for &a in mesh.form.axes().iter().filter(is_free) {
                    assert!(force[a].abs() < 1e-3, "{:?} {at:?} {force:?}", mesh.form);
                }
            }
        }
    }

    #[test]
    fn lone_particles_are_refused() {
        let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [4, 1, 4]);
        let refused = particles(&mesh, 0.9).unwrap_err();
        assert!(matches!(refused, Refused::FewParticles { neighbours: 0, .. }), "{refused}");
        assert!(refused.to_string().contains("raise `sph.support`"), "{refused}");
    }

    #[test]
    fn bodies_two_particles_thin_have_affine_motion() {
        let thin = Mesh::of_box(Form::Solid, [0.0; 3], [0.8, 0.1, 0.1], [8, 1, 1]);
        let space = particles(&thin, 2.2).unwrap();
        for point in 0..space.volume.len() {
            let mut gradient = [0.0; 3];
            for own in space.volume.row(point) {
                let [x, y, z] = space.nodes[own.node as usize];
                (0..3).for_each(|a| gradient[a] += own.gradient[a] * (x - 2.0 * y + 0.5 * z));
            }
            assert!(
                (0..3).all(|a| (gradient[a] - [1.0, -2.0, 0.5][a]).abs() < 1e-8),
                "{gradient:?}"
            );
        }
    }

    /// In a body of many distances the system is ill conditioned, and is solved by a factor.
    #[test]
    fn constant_stress_balances_in_long_bodies() {
        let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [400.0, 0.0, 4.0], [400, 1, 4]);
        let space = particles(&mesh, 2.2).unwrap();
        let mut forces = vec![[0.0; 3]; space.nodes.len()];
        for point in 0..space.volume.len() {
            for own in space.volume.row(point) {
                let force = &mut forces[own.node as usize];
                (0..3).for_each(|a| force[a] += space.volume.weights[point] * own.gradient[a]);
            }
        }
        for (at, force) in space.nodes.iter().zip(forces) {
            if (0.5..399.5).contains(&at[0]) && (0.5..3.5).contains(&at[2]) {
                assert!((0..3).all(|a| force[a].abs() < 1e-9), "{at:?} {force:?}");
            }
        }
    }
}
