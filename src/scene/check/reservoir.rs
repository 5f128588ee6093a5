//! Checks that reservoirs have all keys that heat loss needs.

use super::Checker;
use crate::scene::locate::Path;

pub fn check(checker: &mut Checker) {
    for (name, reservoir) in checker.scene.reservoirs() {
        let (key, message) = match (reservoir.conductance, reservoir.ambient) {
            (Some(_), None) => ("conductance", "`conductance` is set without `ambient`"),
            (None, Some(_)) => ("ambient", "`ambient` is set without `conductance`"),
            _ => continue,
        };
        let path = Path::default().key("body").key(name).key(key);
        checker.refuse(&path, message, "`conductance` and `ambient`, or neither");
    }
}
