//! One symmetry class of the heat problem: its modes along the surface and the loads of faces.

use faer::Mat;

use super::depth::DepthModes;
use super::{ThermalFace, end_conditions};
use crate::math::separable::{Side, contract, transform};
use crate::method::fem::modes::{AxisModes, EndCondition};
use crate::method::mesh::{Mesh, MeshFace, Parity};

/// The part of one symmetry class.
pub struct Class<C> {
    pub parity: Parity,
    pub lateral: [AxisModes; 2],
    pub columns: C,
    /// For each face, the load of a unit of its value.
    pub drives: Vec<FaceDrive>,
}

/// Vectors of a face, as products over the axes: nodal, or modal along the surface and in the basis along z.
pub struct FaceDrive {
    /// Nodes of the face that have its prescribed temperature.
    pub boundary: [Vec<f64>; 3],
    /// `M b`, in modes and basis.
    pub mass: [Vec<f64>; 3],
    /// `K b` is the sum of these.
    pub stiffness: [[Vec<f64>; 3]; 3],
    /// `∫ N dA` over the face, and the same nodal.
    pub area: [Vec<f64>; 3],
    area_nodal: [Vec<f64>; 3],
    /// Area of the face on the mesh [m²].
    pub measure: f64,
}

impl<C: Default> Class<C> {
    pub fn new(
        mesh: &Mesh,
        parity: Parity,
        depth: &impl DepthModes,
        conductivity: f64,
        faces: &[(MeshFace, ThermalFace)],
    ) -> Self {
        let lateral = [0, 1].map(|axis| {
            let mut ends = end_conditions(faces, axis, conductivity);
            if parity.odd[axis] {
                ends[0] = EndCondition::Prescribed;
            }
            AxisModes::of(&mesh.axes[axis], ends)
        });
        let drive = |f| FaceDrive::new(mesh, parity, (&lateral, depth), faces, f);
        let drives = (0..faces.len()).map(drive).collect();
        Self { parity, lateral, columns: C::default(), drives }
    }
}

impl<C> Class<C> {
    /// Number of pairs of modes along the surface.
    pub fn plane(&self) -> usize {
        self.lateral.iter().map(AxisModes::count).product()
    }

    /// Adds to a mixed array a load on the nodes of the end where the basis along z has these values.
    pub fn add_surface(&self, mixed: &mut [f64], nodal: &[f64], end: &[f64], factor: f64) {
        if nodal.is_empty() {
            return;
        }
        let [x, y] = &self.lateral;
        let one = Mat::from_fn(1, 1, |_, _| 1.0);
        let modal = transform(nodal, [&x.shapes, &y.shapes, &one], Side::Transposed);
        for (slab, amplitude) in mixed.chunks_exact_mut(modal.len()).zip(end) {
            for (value, m) in slab.iter_mut().zip(&modal) {
                *value += factor * amplitude * m;
            }
        }
    }

    /// `bᵀ M b'` and `bᵀ K b'` of two prescribed faces.
    pub fn boundary_overlap(&self, depth: &impl DepthModes, f: usize, g: usize) -> (f64, f64) {
        let (a, b) = (&self.drives[f].boundary, &self.drives[g].boundary);
        let along = |axis: usize, matrix: &Mat<f64>| dot(&a[axis], &multiply(matrix, &b[axis]));
        let [x, y] = &self.lateral;
        let (mx, my) = (along(0, &x.mass), along(1, &y.mass));
        let (kx, ky) = (along(0, &x.stiffness), along(1, &y.stiffness));
        let (mz, spread) = (along(2, depth.mass()), along(2, depth.conductance()));
        let kz = dot(&a[2], &depth.stiffness_times(&b[2]));
        (mx * my * mz, (kx * my + mx * ky) * spread + mx * my * kz)
    }

    /// `∫ b' dA` over the face `f`, for the prescribed nodes `b'` of face `g` [m²].
    pub fn face_overlap(&self, f: usize, g: usize) -> f64 {
        (0..3).map(|a| dot(&self.drives[f].area_nodal[a], &self.drives[g].boundary[a])).product()
    }

    /// Surface load that falls on nodes of a prescribed face [W].
    pub fn surface_at_boundary(&self, drive: &FaceDrive, surface: &[Vec<f64>; 2]) -> f64 {
        let [bx, by, bz] = &drive.boundary;
        let ends = [bz[0], bz[bz.len() - 1]];
        let parts = surface.iter().zip(ends).filter(|(nodal, _)| !nodal.is_empty());
        parts.map(|(nodal, end)| contract(nodal, [bx, by, &[end]])).sum()
    }
}

impl FaceDrive {
    fn new(
        mesh: &Mesh,
        parity: Parity,
        (lateral, depth): (&[AxisModes; 2], &impl DepthModes),
        faces: &[(MeshFace, ThermalFace)],
        f: usize,
    ) -> Self {
        let boundary = prescribed_nodes(mesh, parity, faces, f);
        let area_nodal = [0, 1, 2].map(|axis| face_factor(mesh, faces[f].0, axis));
        let measure = area_nodal.iter().map(|v| v.iter().sum::<f64>()).product();
        let [x, y] = lateral;
        let area =
            [x.project(&area_nodal[0]), y.project(&area_nodal[1]), depth.project(&area_nodal[2])];
        let [mx, my] =
            [0, 1].map(|a| lateral[a].project(&multiply(&lateral[a].mass, &boundary[a])));
        let [kx, ky] =
            [0, 1].map(|a| lateral[a].project(&multiply(&lateral[a].stiffness, &boundary[a])));
        let mz = depth.project(&multiply(depth.mass(), &boundary[2]));
        let spread = depth.project(&multiply(depth.conductance(), &boundary[2]));
        let kz = depth.project(&depth.stiffness_times(&boundary[2]));
        let stiffness = [
            [kx, my.clone(), spread.clone()],
            [mx.clone(), ky, spread],
            [mx.clone(), my.clone(), kz],
        ];
        Self { boundary, mass: [mx, my, mz], stiffness, area, area_nodal, measure }
    }
}

/// Nodes that have the prescribed temperature of a face, one factor per axis.
fn prescribed_nodes(
    mesh: &Mesh,
    parity: Parity,
    faces: &[(MeshFace, ThermalFace)],
    f: usize,
) -> [Vec<f64>; 3] {
    let (face, condition) = faces[f];
    let counts = mesh.sided_counts();
    if condition != ThermalFace::Prescribed {
        return counts.map(|count| vec![0.0; count]);
    }
    let end_node = |face: MeshFace| if face.high { counts[face.axis] - 1 } else { 0 };
    let mut nodes = counts.map(|count| vec![1.0; count]);
    for axis in (0..2).filter(|&axis| parity.odd[axis]) {
        nodes[axis][0] = 0.0;
    }
    nodes[face.axis].fill(0.0);
    nodes[face.axis][end_node(face)] = 1.0;
    // A node on the edge of two prescribed faces belongs to the face listed first.
    for &(earlier, other) in &faces[..f] {
        if other == ThermalFace::Prescribed && earlier.axis != face.axis {
            nodes[earlier.axis][end_node(earlier)] = 0.0;
        }
    }
    nodes
}

/// Factor along one axis of `∫ N dA` over a face.
fn face_factor(mesh: &Mesh, face: MeshFace, axis: usize) -> Vec<f64> {
    if axis != face.axis {
        return match axis {
            2 => (0..mesh.layering.count()).flat_map(|l| mesh.layer_axis(l).integrals()).collect(),
            _ => mesh.axes[axis].integrals(),
        };
    }
    let along = &mesh.axes[axis];
    let mut end = vec![0.0; mesh.sided_counts()[axis]];
    let (node, place) = if face.high { (end.len() - 1, along.end()) } else { (0, along.start()) };
    end[node] = along.weight_at(place);
    end
}

/// `A v`.
pub fn multiply(matrix: &Mat<f64>, v: &[f64]) -> Vec<f64> {
    (0..matrix.nrows()).map(|i| (0..v.len()).map(|j| matrix[(i, j)] * v[j]).sum()).collect()
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
