//! A solid as numbers, for models that are reduced: rates of its modes, what loads drive, rows that give values.

use super::{SolidFem, SolidLoads};
use crate::method::fem::conduction::HeatValue;
use crate::method::fem::heat::ModalRow;

impl SolidFem {
    /// Whether modes give the heat.
    pub fn is_modal(&self) -> bool {
        let faces = vec![Vec::new(); self.parities.len()];
        let heat = vec![[Vec::new(), Vec::new()]; self.parities.len()];
        let none = SolidLoads { heat, faces, ..SolidLoads::default() };
        self.heat.driven(&none.thermal()).is_some()
    }

    /// The symmetry classes that any of these loads drives; the even one always.
    pub fn driven_classes(&self, loads: &[SolidLoads]) -> Vec<bool> {
        let mut take = vec![false; self.parities.len()];
        take[0] = true;
        for one in loads {
            let driven = self.heat.driven(&one.thermal()).unwrap_or_default();
            take.iter_mut().zip(driven).for_each(|(take, driven)| *take |= driven);
        }
        take
    }

    /// Rates of decay of the modes of the classes that take part [1/s].
    pub fn modal_rates(&self, take: &[bool]) -> Vec<f64> {
        self.heat.modal_rates(take)
    }

    /// Rate of change of the content of these modes under loads.
    pub fn modal_sources(&self, take: &[bool], loads: &SolidLoads) -> Vec<f64> {
        self.heat.modal_sources(take, &loads.thermal())
    }

    /// Heat that loads bring in [W].
    pub fn brought_in_by(&self, loads: &SolidLoads) -> f64 {
        self.heat.brought_in_by(&loads.thermal())
    }

    /// The temperature above the initial one at a point as a sum over modes and face values.
    pub fn temperature_row(&self, take: &[bool], point: [f64; 3]) -> ModalRow {
        let (place, image) = self.mesh.locate(point);
        self.heat.heat_row(&self.mesh, take, &HeatValue::Point { place, image })
    }

    /// The same of another value.
    pub fn heat_row(&self, take: &[bool], value: &HeatValue) -> ModalRow {
        self.heat.heat_row(&self.mesh, take, value)
    }
}
