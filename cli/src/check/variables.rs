//! Lists of a scene's parameters, inputs and outputs.

use std::fmt::Write;

use impinge::scene::Scene;
use impinge::variables::{ArrayRegistry, Causality, Registry, Value, Variable};

use crate::table::table;
use crate::units::decimal;

/// Lists the variables by causality: their number, unit and start value, with arrays folded. If `described`, also lists
/// the meaning of each output.
pub fn variables(scene: &Scene, described: bool) -> String {
    let (registry, arrays) = (Registry::of(scene), ArrayRegistry::of(scene));
    let kinds = [
        ("Parameters", Causality::Parameter),
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
    ];
    let mut text = String::new();
    for (title, causality) in kinds {
        let of_causality =
            arrays.variables.iter().filter(|v| v.causality(&registry) == Some(causality));
        let list: Vec<&[Variable]> = of_causality.map(|v| v.elements(&registry)).collect();
        let values: usize = list.iter().map(|elements| elements.len()).sum();
        let count = match list.len() {
            names if names == values => format!("{names}"),
            names => format!("{names}, {values} values"),
        };
        let rows: Vec<_> = list
            .into_iter()
            .map(|elements| {
                let unit = elements[0].quantity.map_or("", |quantity| quantity.unit());
                // The name with the highest indices determines the number of elements.
                let last = &elements[elements.len() - 1];
                let more = match causality {
                    Causality::Output if described => last.description.clone(),
                    _ => start(elements),
                };
                [last.name.clone(), unit.to_owned(), more]
            })
            .collect();
        let heading = match causality {
            Causality::Output if described => "meaning",
            Causality::Output => "",
            _ => "start",
        };
        let _ = write!(text, "\n{title} ({count})\n{}", table(["name", "unit", heading], &rows));
    }
    text
}

/// The start value, if all elements share it.
fn start(elements: &[Variable]) -> String {
    let first = &elements[0].start;
    if elements.iter().any(|element| element.start != *first) {
        return "various".into();
    }
    match first {
        None => String::new(),
        Some(Value::Real(value)) => decimal(*value),
        Some(Value::Integer(value)) => value.to_string(),
        Some(Value::Text(value)) => format!("{value:?}"),
    }
}
