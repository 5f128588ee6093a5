//! Variables that are outputs: one for each quantity that a body offers and the scene requests.

use super::inputs::cell_labels;
use super::registry::{Output, Slot, Variable};
use crate::body::{
    Descriptor, PeakPart, PointQuantity, Reading, flaw_quantities, peaks, point_quantities, totals,
    wall_quantities,
};
use crate::limits::Bounds;
use crate::quantity::Quantity;
use crate::scene::{Field, Gives, Probe, Sampling, Scene, Side, Wall};

/// Lists the outputs of a scene.
pub fn list(scene: &Scene, list: &mut Vec<Variable>) {
    for probe in &scene.probe {
        of_probe(scene, probe, list);
    }
    for place in 0..scene.field.len() {
        of_field(scene, place, list);
    }
    for flaw in 0..scene.flaw.len() {
        of_flaw(scene, flaw, list);
    }
    for name in in_order(scene) {
        of_body(scene, name, list);
    }
    for wall in &scene.wall {
        of_wall(scene, wall, list);
    }
}

/// Bodies in order: first those that have points.
fn in_order(scene: &Scene) -> impl Iterator<Item = &str> {
    let of = |resolves: bool| {
        let own = scene.body.iter().filter(move |(_, body)| body.resolves_fields() == resolves);
        own.map(|(name, _)| name.as_str())
    };
    of(true).chain(of(false))
}

fn place(scene: &Scene, body: &str) -> usize {
    scene.body.keys().position(|name| name == body).expect("a checked scene has the body")
}

fn variable(
    name: String,
    description: String,
    quantity: Quantity,
    (body, reading): (usize, Reading),
) -> Variable {
    let slot = Slot::Output(Output { body, reading });
    let quantity = Some(quantity);
    Variable {
        name,
        description,
        slot,
        quantity,
        start: None,
        bounds: Bounds::default(),
        is_tunable: false,
    }
}

fn of_probe(scene: &Scene, probe: &Probe, list: &mut Vec<Variable>) {
    let [x, y, z] = probe.at;
    let at = scene.point_of(probe);
    let side = match probe.side {
        None => "",
        Some(Side::Above) => ", above the interface",
        Some(Side::Below) => ", below the interface",
    };
    let body = place(scene, &probe.body);
    for (quantity, PointQuantity { descriptor, .. }) in wanted(&probe.gives) {
        let reading = Reading::Point { quantity, at, alone: true };
        let Descriptor { key, words, quantity, .. } = descriptor;
        let name = format!("{}.{key}", probe.name);
        let description =
            format!("{words} at x = {x} m, y = {y} m, z = {z} m of {}{side}", probe.body);
        list.push(variable(name, description, *quantity, (body, reading)));
    }
}

/// Lists the outputs of a field, by its place among the scene's.
fn of_field(scene: &Scene, field: usize, list: &mut Vec<Variable>) {
    let Field { name, gives, .. } = &scene.field[field];
    let (body_name, _) = scene.field[field].body_and_place();
    let body = place(scene, body_name);
    let sampling = scene.sampling(&scene.field[field]).expect("a checked field lies in a solid");
    for (quantity, PointQuantity { descriptor, .. }) in wanted(gives) {
        let Descriptor { key, words, quantity: measured, .. } = descriptor;
        for (place, (label, words_of_place)) in places(scene, field).into_iter().enumerate() {
            let reading = match &sampling {
                Sampling::Points(grid) => {
                    let [i, j] = [place / grid.count[1], place % grid.count[1]];
                    Reading::Point { quantity, at: grid.point(i, j), alone: false }
                }
                Sampling::Cells(_) => Reading::Mean { quantity, field, cell: place },
            };
            let variable_name = format!("{name}.{key}{label}");
            let description = format!("{words}{words_of_place}");
            list.push(variable(variable_name, description, *measured, (body, reading)));
        }
    }
}

/// Lists the outputs of a flaw, by its place among the scene's.
fn of_flaw(scene: &Scene, flaw: usize, list: &mut Vec<Variable>) {
    let own = &scene.flaw[flaw];
    let body = place(scene, &own.body);
    for (quantity, Descriptor { key, words, quantity: measured, .. }) in flaw_quantities(own) {
        let reading = Reading::Flaw { flaw, quantity };
        let description = format!("{words} of a flaw in {}", own.body);
        list.push(variable(format!("{}.{key}", own.name), description, measured, (body, reading)));
    }
}

/// Index text of each place of a field in names of variables, and its description.
fn places(scene: &Scene, field: usize) -> Vec<(String, String)> {
    let Field { name, on, body, grid, footprint, .. } = &scene.field[field];
    let whole = on.as_deref().or(body.as_deref()).unwrap_or_default();
    match (grid, footprint) {
        (_, Some(footprint)) => {
            let words = |(label, cell)| (label, format!(", mean{cell}, {name} on {whole}"));
            cell_labels(footprint.cells()).into_iter().map(words).collect()
        }
        (grid, None) => {
            let [rows, columns] = grid.unwrap_or_default();
            let point = |i: usize, j: usize| {
                (format!("[{i},{j}]"), format!(" at point {i}, {j} of the grid on {whole}"))
            };
            (1..=rows).flat_map(|i| (1..=columns).map(move |j| point(i, j))).collect()
        }
    }
}

/// Returns the quantities for a list of output names, each once, with its place among all.
fn wanted(gives: &[Gives]) -> impl Iterator<Item = (usize, &'static PointQuantity)> {
    let is_wanted =
        |quantity: &PointQuantity| quantity.given_by.iter().any(|wish| gives.contains(wish));
    let all = point_quantities().iter().enumerate();
    all.filter(move |(_, quantity)| is_wanted(quantity))
}

fn of_body(scene: &Scene, name: &str, list: &mut Vec<Variable>) {
    let body = place(scene, name);
    for (total, Descriptor { key, words, quantity, .. }) in totals(scene, name) {
        let description = format!("{words}{} ({name})", depth(quantity));
        let reading = Reading::Total(total);
        list.push(variable(format!("{name}.{key}"), description, quantity, (body, reading)));
    }
    if scene.body[name].resolves_fields() {
        let description = format!("{ERROR} ({name})");
        let name = format!("{name}.estimated_error");
        list.push(variable(name, description, Quantity::Ratio, (body, Reading::Error)));
    }
    for (which, descriptor) in peaks(scene, name).into_iter().enumerate() {
        of_peak((body, name), which, &descriptor, list);
    }
}

/// Description of the error estimate of a solid's outputs.
const ERROR: &str = "estimate of the largest error of an output by the mesh, of its range over the default experiment, \
                     -1 without one";

/// Lists a running maximum with its time and place.
fn of_peak(
    (body, name): (usize, &str),
    which: usize,
    descriptor: &Descriptor,
    list: &mut Vec<Variable>,
) {
    let Descriptor { key, words, quantity, .. } = descriptor;
    let highest = format!("the highest {words} of the body at any communication point so far");
    let mut add = |end: &str, description: String, quantity, part| {
        let reading = Reading::Peak { which, part };
        let description = format!("{description} ({name})");
        list.push(variable(format!("{name}.{key}{end}"), description, quantity, (body, reading)));
    };
    add("", highest.replacen("the ", "", 1), *quantity, PeakPart::Value);
    add("_time", format!("time of {highest}"), Quantity::Time, PeakPart::Time);
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let end = format!("_{letter}");
        add(&end, format!("{letter} of {highest}"), Quantity::Length, PeakPart::Along(axis));
    }
}

fn of_wall(scene: &Scene, wall: &Wall, list: &mut Vec<Variable>) {
    let body = place(scene, &wall.under);
    let is_plane = scene.body[&wall.under].is_plane();
    let mean = ", mean over the last step";
    let all = wall_quantities().iter().enumerate();
    for (quantity, kind) in all.filter(|(_, kind)| kind.is_offered(scene, wall)) {
        let Descriptor { key, words, quantity: measured, .. } = kind.descriptor;
        if !kind.of_cells {
            let measured = if is_plane { measured.per_depth() } else { measured };
            let depth = depth(measured);
            let name = format!("{}.{key}", wall.name);
            let description =
                format!("{words} into the wall beyond its cells{depth}, {}{mean}", wall.name);
            let reading = Reading::Cell { quantity, cell: 0 };
            list.push(variable(name, description, measured, (body, reading)));
            continue;
        }
        let cells = cell_labels(wall.footprint.cells());
        for (cell, (label, place)) in cells.into_iter().enumerate() {
            let name = format!("{}.{key}{label}", wall.name);
            let mean = if kind.is_mean() { mean } else { "" };
            let description = format!("{words}{place}, {}{mean}", wall.name);
            let reading = Reading::Cell { quantity, cell };
            list.push(variable(name, description, measured, (body, reading)));
        }
    }
}

/// Suffix of a quantity's description in a plane model.
fn depth(quantity: Quantity) -> &'static str {
    if quantity.is_per_depth() { ", per metre of depth" } else { "" }
}
