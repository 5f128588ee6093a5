//! Free surfaces that give heat to the air.

use super::{Stepper, fill, record};
use crate::method::sph::exposure::{Exposure, outside};
use crate::method::sph::feed::FREE;
use crate::method::sph::moment::least_eigenvalue;

impl Stepper<'_, '_> {
    /// Finds the free surface of each particle, once in a time in which none moves far. Fluid that sleeps keeps its own,
    /// as what surrounds it may have left the cloud, and fluid in the nozzle has none.
    pub(super) fn find_exposed(&mut self) {
        let Some(cooling) = self.method.cooling.as_ref().filter(|_| !self.exposed) else { return };
        let cloud = &*self.cloud;
        let mut records = std::mem::take(&mut self.records);
        fill(&mut records, cloud.len(), self.team, |i| record(cloud, i, [0.0; 3], 0.0));
        let pass = Exposure {
            images: &self.method.images,
            records: &records,
            scale: cooling.factor * self.method.normalisation,
        };
        let areas = pass.areas(&self.neighbours.blocks, self.method.pairs(), self.team);
        self.records = records;
        self.exposed = true;
        let (Some(own), Some(origin)) = (&mut self.cloud.exposed, &self.cloud.origin) else {
            return;
        };
        for (i, area) in areas.into_iter().enumerate().filter(|(i, _)| origin.hold[*i] == FREE) {
            own[i] = outside(least_eigenvalue(&self.cloud.moment[i])) * area;
        }
    }
}
