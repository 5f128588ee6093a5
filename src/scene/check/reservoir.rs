//! Whether reservoirs have sensible constants.

use super::{Checker, LARGEST};
use crate::scene::locate::Path;

/// [J/K]
const CAPACITIES: [f64; 2] = [1e-30, 1e30];
/// [W/K]
const MOST_CONDUCTANCE: f64 = 1e30;

pub fn check(checker: &mut Checker) {
    for (name, reservoir) in checker.scene.reservoirs() {
        let path = Path::default().key("body").key(name);
        let what = "the heat capacity of a reservoir";
        let capacity = reservoir.heat_capacity;
        checker.positive_within(&path.key("heat_capacity"), capacity, CAPACITIES, what);
        checker.temperature(&path.key("initial_temperature"), reservoir.initial_temperature);
        let bounds = [-LARGEST, LARGEST];
        checker.within(&path.key("heating"), reservoir.heating, bounds, "the heating");
        if let Some(conductance) = reservoir.conductance {
            let path = path.key("conductance");
            checker.within(&path, conductance, [0.0, MOST_CONDUCTANCE], "the conductance");
        }
        if let Some(ambient) = reservoir.ambient {
            checker.temperature(&path.key("ambient"), ambient);
        }
        let (key, message) = match (reservoir.conductance, reservoir.ambient) {
            (Some(_), None) => ("conductance", "a reservoir loses heat to an `ambient`"),
            (None, Some(_)) => ("ambient", "a reservoir loses heat by a `conductance`"),
            _ => continue,
        };
        checker.refuse(&path.key(key), message, "`conductance` and `ambient`, or neither");
    }
}
