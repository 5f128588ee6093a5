//! Variables that are inputs.

use std::ops::Range;

use super::registry::{Slot, Value, Variable};
use crate::inputs::{FaceInputKind, InputLayout, LoadInputs};
use crate::limits::{self, Bounds};
use crate::quantity::Quantity;
use crate::scene::{
    BodyInput, CellShape, CellValues, FaceName, Load, LoadRange, Role, Scene, Solid,
};

/// What comes from outside.
pub fn list(scene: &Scene, list: &mut Vec<Variable>) {
    let layout = InputLayout::of(scene);
    for (load, places) in scene.load.iter().zip(&layout.loads) {
        amounts(load, places, list);
        placement(load, places, list);
    }
    for input in &layout.faces {
        let Some(solid) = scene.solid(&input.body) else { continue };
        list.push(face_variable(&input.body, solid, input.face, input.kind, input.index));
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
    let start = &load.start;
    type Kind<'a> = (&'a str, &'a str, &'a Option<Range<usize>>, &'a Option<CellValues>);
    let kinds: [Kind; 5] = [
        ("heat_flux", "heat flux into the body", &places.heat_flux, &start.heat_flux),
        ("pressure", "pressure that acts into the body", &places.pressure, &start.pressure),
        ("shear_x", "shear traction along x", &places.shear_x, &start.shear_x),
        ("shear_y", "shear traction along y", &places.shear_y, &start.shear_y),
        ("shear_r", "radial shear traction, outward positive", &places.shear_r, &start.shear_r),
    ];
    for (key, meaning, range, start) in kinds {
        let Some(range) = range else { continue };
        let (quantity, bounds) = match key {
            "heat_flux" => (Quantity::HeatFlux, limits::heat_flux().bounds()),
            _ => (Quantity::Stress, limits::traction().bounds()),
        };
        let cells = cell_labels(load.footprint.cells());
        for (cell, at) in range.clone().enumerate() {
            let (label, place) = &cells[cell];
            list.push(Variable {
                name: format!("{}.{key}{label}", load.name),
                description: format!("{meaning}{place}, {} on {}", load.name, load.on),
                slot: Slot::Input(at),
                quantity: Some(quantity),
                start: Some(Value::Real(cell_start(start.as_ref(), load.footprint.cells(), cell))),
                bounds,
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

/// Index text of each cell in a variable's name, and the words for it.
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

/// The start value of one cell; zero where none is given.
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

fn face_variable(
    body: &str,
    solid: &Solid,
    face: FaceName,
    kind: FaceInputKind,
    index: usize,
) -> Variable {
    let condition = solid.faces[&face];
    let name = face.as_str();
    let (key, meaning, quantity, start) = match kind {
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
        slot: Slot::Input(index),
        quantity: Some(quantity),
        start: start.map(Value::Real),
        bounds: limits.bounds(),
        is_tunable: condition.role == Role::Parameter,
    }
}

/// Temperatures of the cells of walls.
fn walls(scene: &Scene, layout: &InputLayout, list: &mut Vec<Variable>) {
    for (wall, range) in scene.wall.iter().zip(&layout.walls) {
        let own = scene.droplet(&wall.under).map(|droplet| droplet.initial_temperature);
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
