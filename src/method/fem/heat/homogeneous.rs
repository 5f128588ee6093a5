//! Modes along z of a homogeneous body: one eigenproblem.

use std::borrow::Cow;

use faer::Mat;

use super::class::{Class, multiply};
use super::depth::DepthModes;
use super::{HeatProblem, ThermalFace, end_conditions};
use crate::method::fem::modes::AxisModes;
use crate::method::mesh::{Mesh, MeshFace};

/// The modes along z, which are also the basis along z.
pub struct Homogeneous {
    /// ρc [J/(m³ K)]
    capacity: f64,
    /// k [W/(m K)]
    conductivity: f64,
    modes: AxisModes,
}

impl HeatProblem<Homogeneous> {
    /// `capacity` is ρc [J/(m³ K)], `conductivity` k [W/(m K)].
    pub fn homogeneous(
        mesh: &Mesh,
        capacity: f64,
        conductivity: f64,
        faces: Vec<(MeshFace, ThermalFace)>,
    ) -> Self {
        let modes = AxisModes::of(&mesh.axes[2], end_conditions(&faces, 2, conductivity));
        Self::new(mesh, Homogeneous { capacity, conductivity, modes }, conductivity, faces)
    }
}

impl DepthModes for Homogeneous {
    type Columns = ();

    fn capacity(&self) -> f64 {
        self.capacity
    }

    fn conductivity(&self) -> f64 {
        self.conductivity
    }

    fn mass(&self) -> &Mat<f64> {
        &self.modes.mass
    }

    fn conductance(&self) -> &Mat<f64> {
        &self.modes.mass
    }

    fn stiffness_times(&self, v: &[f64]) -> Vec<f64> {
        multiply(&self.modes.stiffness, v)
    }

    fn basis(&self) -> &Mat<f64> {
        &self.modes.shapes
    }

    fn count(&self) -> usize {
        self.modes.count()
    }

    fn for_each_mode(&self, class: &Class<()>, mut f: impl FnMut(usize, f64)) {
        let diffusivity = self.conductivity / self.capacity;
        let [x, y] = class.lateral.each_ref().map(|modes| &modes.decay);
        let mut at = 0;
        for decay_z in &self.modes.decay {
            for decay_y in y {
                for decay_x in x {
                    f(at, diffusivity * (decay_x + decay_y + decay_z));
                    at += 1;
                }
            }
        }
    }

    fn to_modal(&self, _: &Class<()>, mixed: Vec<f64>) -> Vec<f64> {
        mixed
    }

    fn to_mixed<'a>(&self, _: &Class<()>, modal: &'a [f64]) -> Cow<'a, [f64]> {
        Cow::Borrowed(modal)
    }
}
