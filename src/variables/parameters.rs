//! Variables that are constants of the scene.

use super::Parameter;
use super::registry::{Slot, Value, Variable};
use crate::limits::Bounds;
use crate::scene::{Body, Constant, Flaw, MOST_THREADS, Scene};

/// Constants of the scene that may be set until initialisation ends.
pub fn list(scene: &Scene, list: &mut Vec<Variable>) {
    for (name, body) in scene.bodies_by_kind() {
        of_body(name, body, list);
    }
    for (place, flaw) in scene.flaw.iter().enumerate() {
        list.extend(flaw.depth.given().map(|depth| of_flaw((place, flaw), depth)));
    }
    list.push(Variable {
        name: "solver.threads".into(),
        description: "threads this unit may use; 0 lets the program choose".into(),
        slot: Slot::Threads,
        quantity: None,
        start: Some(Value::Integer(scene.solver.threads as i32)),
        bounds: Bounds::between(0.0, MOST_THREADS as f64),
        is_tunable: false,
    });
    list.push(Variable {
        name: "output.directory".into(),
        description: "folder for the fields as a ParaView time series; nothing is written if empty"
            .into(),
        slot: Slot::OutputDirectory,
        quantity: None,
        start: Some(Value::Text(String::new())),
        bounds: Bounds::default(),
        is_tunable: false,
    });
}

/// The depth of a flaw.
fn of_flaw((place, flaw): (usize, &Flaw), depth: f64) -> Variable {
    let constant = Constant::FlawDepth { flaw: place };
    Variable {
        name: format!("{}.depth", flaw.name),
        description: format!("depth of a flaw in {}", flaw.body),
        quantity: Some(constant.quantity()),
        start: Some(Value::Real(depth)),
        bounds: constant.bounds(),
        slot: Slot::Parameter(Parameter { body: flaw.body.clone(), constant }),
        is_tunable: false,
    }
}

fn of_body(name: &str, body: &Body, list: &mut Vec<Variable>) {
    // Reading uses the same place as writing.
    let mut copy = body.clone();
    for offered in body.constants(name) {
        let constant = offered.constant;
        let start = copy.places_of(&constant).first().map_or(f64::NAN, |place| **place);
        list.push(Variable {
            name: format!("{name}.{}", offered.key),
            description: offered.description,
            quantity: Some(constant.quantity()),
            start: Some(Value::Real(start)),
            bounds: constant.bounds(),
            slot: Slot::Parameter(Parameter { body: name.to_owned(), constant }),
            is_tunable: false,
        });
    }
}
