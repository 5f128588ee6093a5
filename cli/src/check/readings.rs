//! Tables of what a scene reads: probes and fields.

use impinge::scene::{self, Field, Probe, Scene};

use super::words::{keys, metres};
use crate::table::table;

pub fn probes(scene: &Scene) -> String {
    let row = |probe: &Probe| {
        let at = probe.at.map(metres).join(", ");
        [probe.name.clone(), probe.body.clone(), at, keys(&probe.gives)]
    };
    let rows: Vec<_> = scene.probe.iter().map(row).collect();
    table(["probe", "in", "at x, y, z", "gives"], &rows)
}

pub fn fields(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .field
        .iter()
        .map(|field| {
            let size = field.size.map_or("whole".into(), |size| size.map(metres).join(" × "));
            let sampling = match (&field.footprint, field.grid) {
                (Some(footprint), _) => format!("means over {}", footprint.label(metres)),
                (None, grid) => {
                    let [nx, ny] = grid.unwrap_or_default();
                    format!("{nx} × {ny} points, {size}")
                }
            };
            [field.name.clone(), place(field), sampling, keys(&field.gives)]
        })
        .collect();
    table(["field", "on", "values", "gives"], &rows)
}

/// Names the face or section of a field.
fn place(field: &Field) -> String {
    match (&field.on, &field.body, field.plane) {
        (Some(face), ..) => face.clone(),
        (None, Some(body), Some(plane)) => {
            let (axis, at) = match plane {
                scene::Plane::X(at) => ("x", at),
                scene::Plane::Y(at) => ("y", at),
                scene::Plane::Z(at) => ("z", at),
            };
            format!("{body}, {axis} = {}", metres(at))
        }
        (None, body, _) => body.clone().unwrap_or_default(),
    }
}
