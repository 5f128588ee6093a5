//! The table of rules. Each rule states a requirement, its section of the standard, and a check.

mod attributes;
mod capabilities;
mod cells;
mod combinations;
mod declared_types;
mod default_experiment;
mod dependencies;
mod derivative;
mod elements;
mod exports;
mod guid;
mod initial_unknowns;
mod model_identifier;
mod platforms;
mod range;
mod reading;
mod sources;
mod start;
mod structure;
mod structured_names;
mod unique_names;
mod units;
mod value_references;
mod zip_duplicates;
mod zip_links;
mod zip_paths;
mod zip_sizes;

use super::Subject;
use super::finding::Report;
use super::package::Package;

pub use reading::{READABLE, VERSION, WELL_FORMED, check_encoding, of_this_version};
pub use zip_sizes::{RULE as SIZES, check_sizes};

pub struct Rule {
    pub name: &'static str,
    /// Section of FMI 2.0.4.
    pub section: &'static str,
    /// The requirement.
    pub says: &'static str,
    pub check: Check,
}

/// Input of a rule, which determines when it is checked.
#[derive(Clone, Copy)]
pub enum Check {
    /// Checked while the unit is read; later checks depend on it.
    Reading,
    Package(fn(&Package, &mut Report)),
    Unit(fn(&Subject, &mut Report)),
}

/// All rules in the order in which they are checked.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    const ALL: [&Rule; 30] = [
        &READABLE,
        &zip_sizes::RULE,
        &zip_paths::RULE,
        &zip_links::RULE,
        &zip_duplicates::RULE,
        &cells::RULE,
        &WELL_FORMED,
        &VERSION,
        &elements::RULE,
        &attributes::RULE,
        &unique_names::RULE,
        &structured_names::RULE,
        &value_references::RULE,
        &combinations::RULE,
        &start::RULE,
        &range::RULE,
        &derivative::RULE,
        &declared_types::RULE,
        &units::RULE,
        &default_experiment::RULE,
        &structure::OUTPUTS,
        &structure::DERIVATIVES,
        &initial_unknowns::RULE,
        &dependencies::RULE,
        &capabilities::RULE,
        &sources::RULE,
        &model_identifier::RULE,
        &platforms::RULE,
        &exports::RULE,
        &guid::RULE,
    ];
    ALL.into_iter()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn rule_names_are_unique() {
        let names: BTreeSet<&str> = all().map(|rule| rule.name).collect();
        assert_eq!(names.len(), all().count());
    }
}
