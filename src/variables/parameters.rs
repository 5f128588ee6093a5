//! Variables that are constants of the scene.

use super::registry::{Slot, Value, Variable};
use super::{DropletConstant, MaterialConstant, Parameter, layers};
use crate::limits::Bounds;
use crate::quantity::Quantity;
use crate::scene::{Droplet, MOST_THREADS, Scene};

/// Constants of the scene that may be set until initialisation ends.
pub fn list(scene: &Scene, list: &mut Vec<Variable>) {
    let mut add = |name: String, description: String, parameter: Parameter, quantity, bounds| {
        let start = Some(Value::Real(parameter.get(scene)));
        let slot = Slot::Parameter(parameter);
        list.push(Variable {
            name,
            description,
            slot,
            quantity: Some(quantity),
            start,
            bounds,
            is_tunable: false,
        });
    };
    for (body, solid) in scene.solids() {
        if let Some(choice) = &solid.material {
            let given = |constant: &&MaterialConstant| constant.is_given(choice.material());
            for constant in MaterialConstant::all().into_iter().filter(given) {
                add(
                    format!("{body}.{}", constant.key),
                    format!("{} of {body}", constant.description),
                    Parameter::Material { body: body.to_owned(), constant },
                    constant.quantity,
                    constant.bounds,
                );
            }
        }
        layers::parameters((body, solid), &mut add);
        add(
            format!("{body}.initial_temperature"),
            format!("uniform temperature of {body} at time zero, free of thermal stress"),
            Parameter::InitialTemperature { body: body.to_owned() },
            Quantity::Temperature,
            Bounds::from(0.0),
        );
        for (&face, _) in solid.faces.iter().filter(|(_, c)| c.convection.is_some()) {
            let name = face.as_str();
            add(
                format!("{body}.{name}.coefficient"),
                format!("heat transfer coefficient of the {name} of {body}"),
                Parameter::ConvectionCoefficient { body: body.to_owned(), face },
                Quantity::HeatTransferCoefficient,
                Bounds::from(0.0),
            );
        }
    }
    for (body, _) in scene.lumps() {
        add(
            format!("{body}.initial_temperature"),
            format!("temperature of {body} at time zero"),
            Parameter::InitialTemperature { body: body.to_owned() },
            Quantity::Temperature,
            Bounds::from(0.0),
        );
    }
    for (body, fluid) in scene.droplets() {
        of_droplet(body, fluid, list);
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

fn of_droplet(body: &str, droplet: &Droplet, list: &mut Vec<Variable>) {
    let mut copy = droplet.clone();
    // Inputs tell speed and temperature of drops on demand.
    let is_told = |key: &str| droplet.is_on_demand() && key == "impact_velocity";
    let is_of_particles = |key: &str| !droplet.has_particles() && key == "sound_speed";
    let is_offered = |key: &str| !is_told(key) && !is_of_particles(key);
    for constant in DropletConstant::ALL.iter().filter(|constant| is_offered(constant.key)) {
        list.push(Variable {
            name: format!("{body}.{}", constant.key),
            description: format!("{} of {body}", constant.description),
            slot: Slot::Parameter(Parameter::Droplet { body: body.to_owned(), constant }),
            quantity: Some(constant.quantity),
            start: Some(Value::Real(*constant.place(&mut copy))),
            bounds: Bounds::from(0.0),
            is_tunable: false,
        });
    }
    if droplet.is_on_demand() {
        return;
    }
    list.push(Variable {
        name: format!("{body}.initial_temperature"),
        description: format!("uniform temperature of {body} at the release"),
        slot: Slot::Parameter(Parameter::InitialTemperature { body: body.to_owned() }),
        quantity: Some(Quantity::Temperature),
        start: Some(Value::Real(droplet.initial_temperature)),
        bounds: Bounds::from(0.0),
        is_tunable: false,
    });
}
