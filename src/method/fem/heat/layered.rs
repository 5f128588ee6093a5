//! Modes along z through layers.
//!
//! With conductivity and capacity that vary along z alone the Galerkin matrices are
//! `K_x⊗M_y⊗M_z(k) + M_x⊗K_y⊗M_z(k) + M_x⊗M_y⊗K_z(k)` and `M_x⊗M_y⊗M_z(c)`. The modes of x and y diagonalise
//! them along the surface; each pair of these then has modes of its own along z ([`DepthProblem`]), which only its
//! sum of eigenvalues matters to. The basis along z is that of the nodes.

use std::borrow::Cow;
use std::collections::HashMap;

use faer::Mat;

use super::class::Class;
use super::depth::DepthModes;
use super::{HeatProblem, ThermalFace, end_conditions};
use crate::laws::Constants;
use crate::method::fem::columns::{Column, DepthProblem};
use crate::method::fem::modes::{AxisModes, EndCondition};
use crate::method::mesh::{Mesh, MeshFace};
use crate::runtime::made_once::MadeOnce;
use crate::runtime::parallel;

/// The depth problem of a layered body, from which the modes along z follow.
pub struct Layered {
    depth: DepthProblem,
    /// The identity.
    basis: Mat<f64>,
    /// True if no lateral face passes heat other than a flux.
    insulated: bool,
    threads: usize,
}

/// Modes along z of all pairs of modes along the surface.
pub struct Columns {
    /// Place in the list of each pair, that along x running fastest.
    of: Vec<usize>,
    list: Vec<Column>,
}

impl HeatProblem<Layered> {
    /// `constants` of the layers, from the lowest on. If lateral faces are convective, all layers have equal
    /// conductivity.
    pub fn layered(
        mesh: &Mesh,
        constants: &[Constants],
        faces: Vec<(MeshFace, ThermalFace)>,
        threads: usize,
    ) -> Self {
        let depth = DepthProblem::new(mesh, constants, depth_ends(&faces));
        let basis = Mat::identity(depth.nodes(), depth.nodes());
        let insulating =
            |&(face, condition): &(MeshFace, _)| face.axis == 2 || condition == ThermalFace::Flux;
        let insulated = faces.iter().all(insulating);
        let depth = Layered { depth, basis, insulated, threads };
        let built = Self::new(mesh, depth, constants[0].conductivity, faces);
        // Made now, so that the first step takes no longer than the others.
        built.depth.columns(&built.classes[0]);
        built
    }
}

impl Layered {
    /// Returns the modes of a class, which are made when it is first driven.
    fn columns<'c>(&self, class: &'c Class<MadeOnce<Columns>>) -> &'c Columns {
        let conserves = class.parity.is_even() && self.insulated;
        let make = || Columns::new(&class.lateral, &self.depth, conserves, self.threads);
        class.columns.get_or_make(make)
    }
}

impl DepthModes for Layered {
    type Columns = MadeOnce<Columns>;

    fn capacity(&self) -> f64 {
        1.0
    }

    fn conductivity(&self) -> f64 {
        1.0
    }

    fn mass(&self) -> &Mat<f64> {
        &self.depth.capacity
    }

    fn conductance(&self) -> &Mat<f64> {
        &self.depth.conductance
    }

    fn stiffness_times(&self, v: &[f64]) -> Vec<f64> {
        self.depth.stiffness_times(v)
    }

    fn basis(&self) -> &Mat<f64> {
        &self.basis
    }

    fn count(&self) -> usize {
        self.depth.count()
    }

    fn for_each_mode(&self, class: &Class<Self::Columns>, mut f: impl FnMut(usize, f64)) {
        let columns = self.columns(class);
        let plane = class.plane();
        for mode in 0..self.count() {
            for (pair, &column) in columns.of.iter().enumerate() {
                f(pair + plane * mode, columns.list[column].decay[mode]);
            }
        }
    }

    fn to_modal(&self, class: &Class<Self::Columns>, mixed: Vec<f64>) -> Vec<f64> {
        self.columns(class).along_z(&mixed, self.count(), |shapes, own, out| {
            for (m, target) in out.iter_mut().enumerate() {
                *target = (0..own.len()).map(|node| shapes[(node, m)] * own[node]).sum();
            }
        })
    }

    fn to_mixed<'a>(&self, class: &Class<Self::Columns>, modal: &'a [f64]) -> Cow<'a, [f64]> {
        let mixed = self.columns(class).along_z(modal, self.depth.nodes(), |shapes, own, out| {
            out.fill(0.0);
            for (m, amplitude) in own.iter().enumerate() {
                for (node, target) in out.iter_mut().enumerate() {
                    *target += shapes[(node, m)] * amplitude;
                }
            }
        });
        Cow::Owned(mixed)
    }
}

impl Columns {
    /// `conserves` is set if a field that is uniform along the surface conserves heat except at the ends along z.
    fn new([x, y]: &[AxisModes; 2], depth: &DepthProblem, conserves: bool, threads: usize) -> Self {
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

    /// Maps each column of values to `count` others, by its modes.
    fn along_z(
        &self,
        values: &[f64],
        count: usize,
        f: impl Fn(&Mat<f64>, &[f64], &mut [f64]),
    ) -> Vec<f64> {
        let plane = self.of.len();
        let mut out = vec![0.0; plane * count];
        let (mut own, mut made) = (vec![0.0; values.len() / plane], vec![0.0; count]);
        for (pair, &column) in self.of.iter().enumerate() {
            let given = values[pair..].iter().step_by(plane);
            own.iter_mut().zip(given).for_each(|(own, value)| *own = *value);
            f(&self.list[column].shapes, &own, &mut made);
            let target = out[pair..].iter_mut().step_by(plane);
            target.zip(&made).for_each(|(target, value)| *target = *value);
        }
        out
    }
}

/// Returns the conditions at the bottom and the top, with unscaled heat transfer coefficients.
pub fn depth_ends(faces: &[(MeshFace, ThermalFace)]) -> [EndCondition; 2] {
    end_conditions(faces, 2, 1.0)
}
