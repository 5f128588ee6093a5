//! Drops that are colder or hotter than the table of their viscosity from the start, or get so on contact.

use super::{Reviewer, number};
use crate::laws::Viscosity;
use crate::scene::FirstContact;
use crate::scene::locate::Path;
use crate::warning;

pub fn review(reviewer: &mut Reviewer) {
    for (name, droplet) in reviewer.scene.droplets() {
        let Viscosity::Table(table) = &droplet.fluid.viscosity else { continue };
        let Some((low, high)) = table.temperature.first().zip(table.temperature.last()) else {
            continue;
        };
        let start = ("the drop".to_owned(), droplet.initial_temperature);
        let contact = reviewer.scene.first_contact(name);
        let contact = contact.filter(|_| droplet.fluid.conductivity > 0.0);
        let contact = contact.map(|FirstContact { below, temperature, .. }| {
            (format!("the fluid in contact with `{below}`"), temperature)
        });
        let mut met = [start].into_iter().chain(contact);
        if let Some((what, met)) = met.find(|(_, met)| !(low..=high).contains(&met)) {
            let path = Path::default().key("body").key(name).key("fluid").key("viscosity");
            let [met, low, high] = [met, *low, *high].map(number);
            reviewer.warn(&path, warning::viscosity_beyond_table(what, met, low, high));
        }
    }
}
