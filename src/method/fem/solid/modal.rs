//! A solid in modal form for reduction: decay rates, sources of loads, and rows of readings.

use super::{SolidFem, SolidLoads};
use crate::method::fem::conduction::{HeatValue, ModalHeat};
use crate::method::fem::heat::ModalRow;
use crate::method::mesh::Mesh;

/// The modes of a solid, if its heat has any.
#[derive(Clone, Copy)]
pub struct SolidModes<'a> {
    heat: &'a dyn ModalHeat,
    mesh: &'a Mesh,
    classes: usize,
}

impl SolidFem {
    /// Returns the modes; `None` if particles or Newton's method advance the heat.
    pub fn modes(&self) -> Option<SolidModes<'_>> {
        let (mesh, classes) = (&self.mesh, self.parities.len());
        self.heat.modal().map(|heat| SolidModes { heat, mesh, classes })
    }
}

impl SolidModes<'_> {
    /// Returns the symmetry classes that any of these loads drives; the even one is always included.
    pub fn driven_classes(&self, loads: &[SolidLoads]) -> Vec<bool> {
        let mut take = vec![false; self.classes];
        take[0] = true;
        for one in loads {
            let driven = self.heat.driven(&one.thermal());
            take.iter_mut().zip(driven).for_each(|(take, driven)| *take |= driven);
        }
        take
    }

    /// Decay rates of the modes of the classes in `take` [1/s].
    pub fn decay_rates(&self, take: &[bool]) -> Vec<f64> {
        self.heat.decay_rates(take)
    }

    /// Rate of change of the content of these modes under loads.
    pub fn sources(&self, take: &[bool], loads: &SolidLoads) -> Vec<f64> {
        self.heat.sources(take, &loads.thermal())
    }

    /// Heat flow supplied by loads [W].
    pub fn brought_in_by(&self, loads: &SolidLoads) -> f64 {
        self.heat.brought_in_by(&loads.thermal())
    }

    /// The temperature above the initial one at a point as a sum over modes and face values.
    pub fn temperature_row(&self, take: &[bool], point: [f64; 3]) -> ModalRow {
        let (place, image) = self.mesh.locate(point);
        self.value_row(take, &HeatValue::Point { place, image })
    }

    /// Expresses another value as a sum over modes and face values.
    pub fn value_row(&self, take: &[bool], value: &HeatValue) -> ModalRow {
        self.heat.value_row(self.mesh, take, value)
    }
}
