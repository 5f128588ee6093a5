//! Shifts of particles from crowded to sparse regions.

use super::{Stepper, fill, record};
use crate::method::sph::failure::Failure;
use crate::method::sph::moment::least_eigenvalue;
use crate::method::sph::neighbours::Displacements;
use crate::method::sph::shifting::{Crowding, displacement};

impl Stepper<'_, '_> {
    /// Shifts particles from crowded to sparse regions.
    pub(super) fn shift(&mut self) -> Result<(), Failure> {
        let way = std::mem::take(&mut self.ledger.way);
        if !self.method.shifts {
            return Ok(());
        }
        let (method, team) = (self.method, self.team);
        // At the beginning and after sorting there are no lists yet.
        self.list(&Displacements::none(self.cloud.len()))?;
        let cloud = &*self.cloud;
        let fullness = team.map(cloud.len(), |i| least_eigenvalue(&cloud.moment[i]));
        let mut records = std::mem::take(&mut self.records);
        fill(&mut records, cloud.len(), team, |i| record(cloud, i, [0.0; 3], fullness[i]));
        let value = |q: f64| method.kernel.value(q, 1.0, method.dimension) / method.normalisation;
        let pass = Crowding {
            images: &method.images,
            records: &records,
            normalisation: method.normalisation,
            reference: 1.0 / value(method.spacing),
        };
        let sums = self.over_pairs(&pass, Vec::new());
        let frozen = &self.frozen;
        let shifts = team.map(sums.len(), |i| match frozen.bond(i).is_rigid() {
            true => [0.0; 3],
            false => displacement(&sums[i], fullness[i], way),
        });
        self.records = records;
        self.list(&Displacements::along(&shifts, f64::INFINITY, team))?;
        team.for_each(&mut self.cloud.position, |i, x| {
            (0..3).for_each(|a| x[a] += shifts[i][a]);
            method.images.reflect_back(x);
        });
        Ok(())
    }
}
