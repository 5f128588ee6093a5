//! The coldest and the hottest fluid of replayed drops.

use super::{Drop, Ledger, Replay};
use crate::method::sph::WarmPlace;

impl Replay {
    /// The coldest and the hottest fluid of drops that fall or transfer heat, as far as known:
    /// falling drops, films as a whole, and the contact with wetted rings. The contact temperature
    /// exceeds the wall's by the fraction `share` of the difference between drop and wall.
    pub fn extremes(&self, state: &[f64], share: f64) -> Option<[WarmPlace; 2]> {
        let (ledger, drops) = self.of(state);
        let places: Vec<WarmPlace> = drops
            .iter()
            .filter(|drop| self.end(drop) > ledger.time)
            .flat_map(|drop| self.places(&ledger, drop, share))
            .collect();
        WarmPlace::extremes(places.into_iter())
    }

    fn places(&self, ledger: &Ledger, drop: &Drop, share: f64) -> Vec<WarmPlace> {
        let [x, y] = drop.place;
        let at = |temperature: f64| WarmPlace { temperature, place: [x, y, 0.0] };
        if !drop.is_down() {
            return vec![at(drop.temperature)];
        }
        let amounts = self.plan.course.amounts(drop.speed, ledger.time - drop.contact, &drop.lag);
        let above = |ring: usize| drop.temperature - drop.wall[ring];
        let wetted = (0..amounts.len()).filter(|&ring| amounts[ring].heat > 0.0);
        let given: f64 = wetted.clone().map(|ring| above(ring) * amounts[ring].heat).sum();
        let film = at(drop.temperature - given / self.plan.heat_capacity);
        let contacts = wetted.map(|ring| at(drop.wall[ring] + share * above(ring)));
        contacts.chain([film]).collect()
    }
}
