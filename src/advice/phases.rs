//! Freezing and boiling points that drops are beyond from the start, or get beyond on contact.

use super::{CELSIUS, Reviewer, celsius, number};
use crate::limits::plausible::{BESIDE_WARM, Cold};
use crate::scene::locate::Path;
use crate::scene::{Droplet, FirstContact};
use crate::warning;

pub fn review(reviewer: &mut Reviewer, cold: Cold) {
    for (name, droplet) in reviewer.scene.droplets() {
        let path = Path::default().key("body").key(name).key("fluid");
        freezing(reviewer, &path.key("freezes_at"), droplet, cold);
        boiling(reviewer, &path.key("boils_at"), droplet);
        contact(reviewer, &path, (name, droplet));
    }
}

/// Warns of drops that start frozen, and of points that match their drops if read in °C.
fn freezing(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet, cold: Cold) {
    let start = droplet.initial_temperature;
    let Some(point) = droplet.fluid.freezes_at else { return };
    if start < point {
        reviewer.warn(path, warning::drop_starts_frozen(number(start)));
        return;
    }
    let is_mistaken = point < BESIDE_WARM && point + CELSIUS < start;
    if is_mistaken && cold != Cold::Meant && !reviewer.is_in_degrees(path, point) {
        let meant = number(point + CELSIUS);
        let finding = warning::freezing_point_in_celsius(number(point), celsius(point), meant);
        reviewer.warn(path, finding);
    }
}

/// Warns of drops that start above their boiling point.
fn boiling(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let start = droplet.initial_temperature;
    let Some(point) = droplet.fluid.boils_at.filter(|&point| point < start) else { return };
    let meant = point + CELSIUS;
    let is_mistaken = point < BESIDE_WARM && start < meant && !reviewer.is_in_degrees(path, point);
    let remedy = match is_mistaken {
        true => format!("did you mean {} ({} °C)?", number(meant), number(point)),
        false => "lower `initial_temperature` below `boils_at`".to_owned(),
    };
    reviewer.warn(path, warning::drop_starts_boiling(number(start), remedy));
}

/// Warns of drops that start liquid and are predicted to freeze or boil where they touch what lies below.
fn contact(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    if droplet.fluid.conductivity == 0.0 {
        return;
    }
    let Some(FirstContact { below, temperature, .. }) = reviewer.scene.first_contact(name) else {
        return;
    };
    let start = droplet.initial_temperature;
    let shown = format!("{temperature:.1}");
    let freezes =
        droplet.fluid.freezing_point().filter(|_| reviewer.scene.freezing_of(name).is_none());
    if freezes.is_some_and(|point| temperature < point && point <= start) {
        reviewer.warn(&path.key("freezes_at"), warning::freezes_on_contact(below, shown));
    } else if droplet.fluid.boils_at.is_some_and(|point| temperature > point && point >= start) {
        reviewer.warn(&path.key("boils_at"), warning::boils_on_contact(below, shown));
    }
}
