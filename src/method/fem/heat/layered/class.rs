//! One symmetry class of the heat problem of a body of layers: its modes, and what faces do to them.

use std::collections::HashMap;
use std::sync::OnceLock;

use faer::Mat;

use super::super::{ThermalFace, dot, end_conditions, face_factor, multiply};
use crate::math::parallel;
use crate::math::separable::{Side, contract, transform};
use crate::method::fem::columns::{Column, DepthProblem};
use crate::method::fem::modes::{AxisModes, EndCondition};
use crate::method::mesh::{Mesh, MeshFace, Parity};

/// The part of one symmetry class.
pub struct LayeredClass {
    pub parity: Parity,
    pub lateral: [AxisModes; 2],
    /// Made when the class is first driven.
    pub columns: OnceLock<Columns>,
    /// Modes along z of each column.
    pub modes: usize,
    pub drives: Vec<Drive>,
}

/// Modes along z of all pairs of modes along the surface.
pub struct Columns {
    /// Place in the list of each pair, that along x running fastest.
    pub of: Vec<usize>,
    pub list: Vec<Column>,
}

/// Vectors of a face, as products over the axes: nodal, or modal along the surface and nodal along z.
pub struct Drive {
    /// Nodes of the face that have its prescribed temperature.
    pub boundary: [Vec<f64>; 3],
    /// `M(c) b`.
    pub mass: [Vec<f64>; 3],
    /// `K b` is the sum of these.
    pub stiffness: [[Vec<f64>; 3]; 3],
    /// `∫ N dA` over the face, and the same nodal.
    pub area: [Vec<f64>; 3],
    pub area_nodal: [Vec<f64>; 3],
    /// [m²]
    pub measure: f64,
}

impl LayeredClass {
    pub fn new(
        mesh: &Mesh,
        parity: Parity,
        depth: &DepthProblem,
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
        let drive = |f| Drive::new(mesh, parity, (&lateral, depth), faces, f);
        let drives = (0..faces.len()).map(drive).collect();
        Self { parity, lateral, columns: OnceLock::new(), modes: depth.count(), drives }
    }

    pub fn plane(&self) -> usize {
        self.lateral.iter().map(AxisModes::count).product()
    }

    pub fn len(&self) -> usize {
        self.plane() * self.modes
    }

    pub fn zeros(&self, depth: &DepthProblem) -> Vec<f64> {
        vec![0.0; self.plane() * depth.nodes()]
    }

    /// `f(place, decay)` of every mode.
    pub fn for_each_mode(&self, columns: &Columns, mut f: impl FnMut(usize, f64)) {
        let plane = self.plane();
        for mode in 0..self.modes {
            for (pair, &column) in columns.of.iter().enumerate() {
                f(pair + plane * mode, columns.list[column].decay[mode]);
            }
        }
    }

    /// `φᵀ v` along z.
    pub fn to_modal(&self, columns: &Columns, mixed: &[f64]) -> Vec<f64> {
        self.along_z(columns, mixed, self.modes, |shapes, own, out| {
            for (m, target) in out.iter_mut().enumerate() {
                *target = (0..own.len()).map(|node| shapes[(node, m)] * own[node]).sum();
            }
        })
    }

    /// `φ a` along z.
    pub fn to_mixed(&self, columns: &Columns, modal: &[f64]) -> Vec<f64> {
        let nodes = columns.list[0].shapes.nrows();
        self.along_z(columns, modal, nodes, |shapes, own, out| {
            out.fill(0.0);
            for (m, amplitude) in own.iter().enumerate() {
                for (node, target) in out.iter_mut().enumerate() {
                    *target += shapes[(node, m)] * amplitude;
                }
            }
        })
    }

    /// Each column of values turned into `count` others.
    pub fn along_z(
        &self,
        columns: &Columns,
        values: &[f64],
        count: usize,
        f: impl Fn(&Mat<f64>, &[f64], &mut [f64]),
    ) -> Vec<f64> {
        let plane = self.plane();
        let mut out = vec![0.0; plane * count];
        let (mut own, mut made) = (vec![0.0; values.len() / plane], vec![0.0; count]);
        for (pair, &column) in columns.of.iter().enumerate() {
            let given = values[pair..].iter().step_by(plane);
            own.iter_mut().zip(given).for_each(|(own, value)| *own = *value);
            f(&columns.list[column].shapes, &own, &mut made);
            let target = out[pair..].iter_mut().step_by(plane);
            target.zip(&made).for_each(|(target, value)| *target = *value);
        }
        out
    }

    pub fn add_surface(&self, mixed: &mut [f64], nodal: &[f64], high: bool) {
        if nodal.is_empty() {
            return;
        }
        let [x, y] = &self.lateral;
        let one = Mat::from_fn(1, 1, |_, _| 1.0);
        let modal = transform(nodal, [&x.shapes, &y.shapes, &one], Side::Transposed);
        let first = if high { mixed.len() - modal.len() } else { 0 };
        mixed[first..].iter_mut().zip(modal).for_each(|(value, m)| *value += m);
    }

    /// `bᵀ M(c) b'` and `bᵀ K b'` of two prescribed faces.
    pub fn boundary_overlap(&self, depth: &DepthProblem, f: usize, g: usize) -> (f64, f64) {
        let (a, b) = (&self.drives[f].boundary, &self.drives[g].boundary);
        let along = |axis: usize, matrix: &Mat<f64>| dot(&a[axis], &multiply(matrix, &b[axis]));
        let [x, y] = &self.lateral;
        let (mx, my) = (along(0, &x.mass), along(1, &y.mass));
        let (kx, ky) = (along(0, &x.stiffness), along(1, &y.stiffness));
        let (mz, spread) = (along(2, &depth.capacity), along(2, &depth.conductance));
        let kz = dot(&a[2], &depth.stiffness_times(&b[2]));
        (mx * my * mz, (kx * my + mx * ky) * spread + mx * my * kz)
    }

    /// `∫ b' dA` over the face `f`, for the prescribed nodes `b'` of face `g` [m²].
    pub fn face_overlap(&self, f: usize, g: usize) -> f64 {
        (0..3).map(|a| dot(&self.drives[f].area_nodal[a], &self.drives[g].boundary[a])).product()
    }

    /// Surface load that falls on nodes of a prescribed face [W].
    pub fn surface_at_boundary(&self, drive: &Drive, surface: &[Vec<f64>; 2]) -> f64 {
        let [bx, by, bz] = &drive.boundary;
        let ends = [bz[0], bz[bz.len() - 1]];
        let parts = surface.iter().zip(ends).filter(|(nodal, _)| !nodal.is_empty());
        parts.map(|(nodal, end)| contract(nodal, [bx, by, &[end]])).sum()
    }
}

impl Columns {
    /// `conserves` where heat that is the same all along the surface keeps its sum but for the ends along z.
    pub fn new(
        [x, y]: &[AxisModes; 2],
        depth: &DepthProblem,
        conserves: bool,
        threads: usize,
    ) -> Self {
        let sums = y.decay.iter().flat_map(|b| x.decay.iter().map(move |a| a + b));
        let mut places: HashMap<(u64, bool), usize> = HashMap::new();
        let mut wanted = Vec::new();
        let of = sums.enumerate().map(|(pair, sum)| {
            // The first modes of insulated axes are constant.
            let uniform = conserves && pair == 0;
            *places.entry((sum.to_bits(), uniform)).or_insert_with(|| {
                wanted.push((sum, uniform));
                wanted.len() - 1
            })
        });
        let of = of.collect();
        let column = |i: usize| depth.column(wanted[i].0, wanted[i].1);
        Self { of, list: parallel::map(threads, wanted.len(), column) }
    }
}

impl Drive {
    pub fn new(
        mesh: &Mesh,
        parity: Parity,
        (lateral, depth): (&[AxisModes; 2], &DepthProblem),
        faces: &[(MeshFace, ThermalFace)],
        f: usize,
    ) -> Self {
        let (face, condition) = faces[f];
        let counts = mesh.sided_counts();
        let end_node = |face: MeshFace| if face.high { counts[face.axis] - 1 } else { 0 };
        let mut boundary = counts.map(|count| vec![0.0; count]);
        if condition == ThermalFace::Prescribed {
            boundary = counts.map(|count| vec![1.0; count]);
            for axis in (0..2).filter(|&a| parity.odd[a]) {
                boundary[axis][0] = 0.0;
            }
            boundary[face.axis].fill(0.0);
            boundary[face.axis][end_node(face)] = 1.0;
            // A node on the edge of two prescribed faces belongs to the face listed first.
            for &(earlier, other) in &faces[..f] {
                if other == ThermalFace::Prescribed && earlier.axis != face.axis {
                    boundary[earlier.axis][end_node(earlier)] = 0.0;
                }
            }
        }
        let area_nodal = [0, 1, 2].map(|axis| match axis {
            2 => depth_factor(mesh, face),
            _ => face_factor(mesh, face, axis),
        });
        let measure = area_nodal.iter().map(|v| v.iter().sum::<f64>()).product();
        let projected = |axis: usize, v: &[f64]| lateral[axis].project(v);
        let area =
            [projected(0, &area_nodal[0]), projected(1, &area_nodal[1]), area_nodal[2].clone()];
        let mass = |axis: usize| projected(axis, &multiply(&lateral[axis].mass, &boundary[axis]));
        let stiff =
            |axis: usize| projected(axis, &multiply(&lateral[axis].stiffness, &boundary[axis]));
        let spread = multiply(&depth.conductance, &boundary[2]);
        let stiffness = [
            [stiff(0), mass(1), spread.clone()],
            [mass(0), stiff(1), spread],
            [mass(0), mass(1), depth.stiffness_times(&boundary[2])],
        ];
        let mass = [mass(0), mass(1), multiply(&depth.capacity, &boundary[2])];
        Self { boundary, mass, stiffness, area, area_nodal, measure }
    }
}

/// Factor along z of `∫ N dA` over a face.
fn depth_factor(mesh: &Mesh, face: MeshFace) -> Vec<f64> {
    if face.axis == 2 {
        let mut end = vec![0.0; mesh.sided_counts()[2]];
        let node = if face.high { end.len() - 1 } else { 0 };
        end[node] = 1.0;
        return end;
    }
    (0..mesh.layering.count()).flat_map(|layer| mesh.layer_axis(layer).integrals()).collect()
}
