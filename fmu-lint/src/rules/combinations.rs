//! Causality, variability and `initial` of a variable.

use super::{Check, Rule};
use crate::Subject;
use crate::combination;
use crate::description::Variable;
use crate::finding::Report;
use crate::vocabulary::{Causality, Initial, Kind, Variability};

pub static RULE: Rule = Rule {
    name: "combinations",
    section: "2.2.7",
    says: "causality, variability and initial go together as the tables allow; only reals are \
           continuous; there is at most one independent variable",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let variables = &subject.description.variables;
    for variable in variables {
        if variable.node.attribute("variability").is_none()
            && variable.kind.is_some_and(|kind| kind != Kind::Real)
        {
            let wrong = "variability is omitted, and its default, continuous, is for reals only";
            report.warning(subject.document.place(variable.node), wrong, "discrete, fixed, …");
        }
        if let Some((attribute, wrong, allowed)) = fault(variable) {
            report.error(subject.document.place_of(variable.node, attribute), wrong, allowed);
        }
    }
    let independent = |v: &&Variable| v.causality == Some(Causality::Independent);
    for second in variables.iter().filter(independent).skip(1) {
        let place = subject.document.place_of(second.node, "causality");
        report.error(place, "a second independent variable", "at most one");
    }
}

/// The faulty attribute, a description of the fault and the allowed values.
fn fault(variable: &Variable) -> Option<(&'static str, String, String)> {
    let (causality, variability) = (variable.causality?, variable.variability?);
    let real = variable.kind == Some(Kind::Real);
    if variability == Variability::Continuous && !real {
        let kind = variable.kind?.word();
        return Some((
            "variability",
            format!("a variable of type {kind} is continuous"),
            "discrete".into(),
        ));
    }
    if causality == Causality::Independent && !real {
        return Some(("causality", "the independent variable is no Real".into(), "Real".into()));
    }
    let Some(initial) = combination::allowed(causality, variability) else {
        let wrong =
            format!("causality {} with variability {}", causality.word(), variability.word());
        return Some(("variability", wrong, combination::variabilities(causality).join(", ")));
    };
    let written = variable.node.attribute("initial").and_then(Initial::read)?;
    (!initial.contains(&written)).then(|| {
        let wrong = format!(
            "initial {} with causality {} and variability {}",
            written.word(),
            causality.word(),
            variability.word()
        );
        let words: Vec<&str> = initial.iter().map(|initial| initial.word()).collect();
        let allowed = if words.is_empty() { "no such attribute".into() } else { words.join(", ") };
        ("initial", wrong, allowed)
    })
}
