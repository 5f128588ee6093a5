//! InitialUnknowns of ModelStructure.

use std::collections::{BTreeMap, BTreeSet};

use super::{Check, Rule};
use crate::Subject;
use crate::description::Description;
use crate::document::child;
use crate::finding::Report;
use crate::vocabulary::{Causality, Initial};

pub static RULE: Rule = Rule {
    name: "initial-unknowns",
    section: "2.2.8",
    says: "ModelStructure/InitialUnknowns lists, in the order of their indices, the outputs, \
           calculated parameters, states and derivatives of states with initial approx or calculated",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    let expected = expected(description);
    let mut listed = BTreeMap::new();
    let mut last = 0;
    for unknown in &description.initial_unknowns {
        let Some(index) = unknown.index else { continue };
        let place = || subject.document.place_of(unknown.node, "index");
        let Some(variable) = description.variable(index) else {
            let count = description.variables.len();
            report.error(place(), format!("there is no variable {index}"), format!("1 to {count}"));
            continue;
        };
        if listed.insert(index, ()).is_some() {
            report.error(place(), format!("{:?} is listed twice", variable.name), RULE.says);
        } else if !expected.contains(&index) {
            report.error(place(), format!("{:?} does not belong here", variable.name), RULE.says);
        } else if index < last {
            report.error(
                place(),
                format!("index {index} stands after {last}"),
                "ascending indices",
            );
        }
        last = last.max(index);
    }
    let Some(structure) = child(description.root, "ModelStructure") else { return };
    let place = || subject.document.place(child(structure, "InitialUnknowns").unwrap_or(structure));
    for index in expected.iter().filter(|index| !listed.contains_key(index)) {
        let name = description.variable(*index).map_or("", |variable| variable.name);
        report.error(place(), format!("{name:?}, variable {index}, is not listed"), RULE.says);
    }
}

fn expected(description: &Description) -> BTreeSet<usize> {
    let of_derivatives = description.derivatives.iter().filter_map(|unknown| unknown.index);
    let state_of = |index| description.variable(index)?.derivative();
    let dynamic: BTreeSet<usize> =
        of_derivatives.flat_map(|index| [Some(index), state_of(index)]).flatten().collect();
    let belongs = |(at, variable): (usize, &crate::description::Variable)| {
        let computed = matches!(variable.initial, Some(Initial::Approx | Initial::Calculated));
        let exposed =
            matches!(variable.causality, Some(Causality::Output | Causality::CalculatedParameter));
        (computed && (exposed || dynamic.contains(&(at + 1)))).then_some(at + 1)
    };
    description.variables.iter().enumerate().filter_map(belongs).collect()
}
