//! Variables that are inputs.

use super::registry::{Slot, Value, Variable};
use crate::inputs::{FaceInput, FaceInputKind, InputLayout, LoadInputs};
use crate::limits::{self, Bounds};
use crate::quantity::Quantity;
use crate::scene::{Body, BodyInput, CellShape, CellValues, Face, Load, LoadRange, Role, Scene};

/// Lists the inputs of a scene.
pub fn list(scene: &Scene, list: &mut Vec<Variable>) {
    let layout = InputLayout::of(scene);
    for (load, places) in scene.load.iter().zip(&layout.loads) {
        amounts(load, places, list);
        placement(load, places, list);
    }
    for input in &layout.faces {
        let mut faces = scene.body[&input.body].faces();
        if let Some((_, condition)) = faces.find(|(face, _)| *face == input.face) {
            list.push(face_variable(input, &condition));
        }
    }
    walls(scene, &layout, list);
    for (name, range) in &layout.bodies {
        let inputs = scene.body[name].inputs();
        list.extend(range.clone().zip(inputs).map(|(at, input)| body_variable(name, &input, at)));
    }
}

fn body_variable(body: &str, input: &BodyInput, at: usize) -> Variable {
    Variable {
        name: format!("{body}.{}", input.key),
        description: format!("{} ({body})", input.words),
        slot: Slot::Input(at),
        quantity: Some(input.quantity),
        start: Some(Value::Real(input.start)),
        bounds: input.bounds,
        is_tunable: false,
    }
}

fn amounts(load: &Load, places: &LoadInputs, list: &mut Vec<Variable>) {
    let cells = cell_labels(load.footprint.cells());
    for (channel, range) in &places.amounts {
        let start = load.start.amounts(*channel);
        for (cell, at) in range.clone().enumerate() {
            let (label, place) = &cells[cell];
            list.push(Variable {
                name: format!("{}.{}{label}", load.name, channel.key()),
                description: format!("{}{place}, {} on {}", channel.words(), load.name, load.on),
                slot: Slot::Input(at),
                quantity: Some(channel.quantity()),
                start: Some(Value::Real(cell_start(
                    start.as_deref(),
                    load.footprint.cells(),
                    cell,
                ))),
                bounds: channel.limits().bounds(),
                is_tunable: false,
            });
        }
    }
}

fn placement(load: &Load, places: &LoadInputs, list: &mut Vec<Variable>) {
    let LoadRange { x, y, radius } = load.range;
    let own_radius = load.footprint.radius().unwrap_or_default();
    let kinds = [
        ("x", "x of the centre", places.x, load.start.x.unwrap_or(0.0), x),
        ("y", "y of the centre", places.y, load.start.y.unwrap_or(0.0), y),
        ("radius", "outer radius", places.radius, load.start.radius.unwrap_or(own_radius), radius),
    ];
    for (key, meaning, at, start, range) in kinds {
        let Some(at) = at else { continue };
        let own = if key == "radius" { limits::footprint_radius() } else { limits::place() };
        let bounds = range.map_or(own.bounds(), |[low, high]| Bounds::between(low, high));
        list.push(Variable {
            name: format!("{}.{key}", load.name),
            description: format!("{meaning} of the footprint of {} on {}", load.name, load.on),
            slot: Slot::Input(at),
            quantity: Some(Quantity::Length),
            start: Some(Value::Real(start)),
            bounds,
            is_tunable: load.role == Role::Parameter,
        });
    }
}

/// Index text of each cell in a variable's name, and its description.
pub(super) fn cell_labels(cells: Option<CellShape>) -> Vec<(String, String)> {
    match cells {
        None => vec![(String::new(), String::new())],
        Some(CellShape::Rings(count)) => {
            (1..=count).map(|i| (format!("[{i}]"), format!(" on ring {i}"))).collect()
        }
        Some(CellShape::Tiles([nx, ny])) => (1..=nx)
            .flat_map(|i| {
                (1..=ny).map(move |j| (format!("[{i},{j}]"), format!(" on tile {i}, {j}")))
            })
            .collect(),
    }
}

/// Returns the start value of one cell; zero if none is set.
pub(super) fn cell_start(start: Option<&CellValues>, cells: Option<CellShape>, cell: usize) -> f64 {
    match (start, cells) {
        (Some(CellValues::Uniform(value)), _) => *value,
        (Some(CellValues::Rings(values)), _) => values[cell],
        (Some(CellValues::Tiles(rows)), Some(CellShape::Tiles([_, ny]))) => {
            rows[cell / ny][cell % ny]
        }
        _ => 0.0,
    }
}

fn face_variable(input: &FaceInput, condition: &Face) -> Variable {
    let (body, name) = (&input.body, input.face.as_str());
    let (key, meaning, quantity, start) = match input.kind {
        FaceInputKind::Temperature => {
            ("temperature", "prescribed temperature", Quantity::Temperature, condition.temperature)
        }
        FaceInputKind::Ambient => (
            "ambient",
            "ambient temperature",
            Quantity::Temperature,
            condition.convection.map(|c| c.ambient),
        ),
        FaceInputKind::Flux => {
            ("flux", "heat flux into the body", Quantity::HeatFlux, condition.flux)
        }
    };
    let limits = match quantity {
        Quantity::HeatFlux => limits::heat_flux(),
        _ => limits::temperature(),
    };
    Variable {
        name: format!("{body}.{name}.{key}"),
        description: format!("{meaning} at the {name} of {body}"),
        slot: Slot::Input(input.index),
        quantity: Some(quantity),
        start: start.map(Value::Real),
        bounds: limits.bounds(),
        is_tunable: condition.role == Role::Parameter,
    }
}

/// Temperatures of the cells of walls.
fn walls(scene: &Scene, layout: &InputLayout, list: &mut Vec<Variable>) {
    for (wall, range) in scene.wall.iter().zip(&layout.walls) {
        let own = scene.body.get(&wall.under).map(Body::initial_temperature);
        let shape = wall.footprint.cells();
        for (cell, (label, place)) in cell_labels(shape).into_iter().enumerate() {
            let given = wall.start.temperature.as_ref();
            let start = given.map(|values| cell_start(Some(values), shape, cell)).or(own);
            list.push(Variable {
                name: format!("{}.temperature{label}", wall.name),
                description: format!("temperature of the wall{place}, {}", wall.name),
                slot: Slot::Input(range.start + cell),
                quantity: Some(Quantity::Temperature),
                start: start.map(Value::Real),
                bounds: limits::temperature().bounds(),
                is_tunable: false,
            });
        }
    }
}
