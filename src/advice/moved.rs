//! Footprints that an input moves to where the mesh does not see them, or makes too small for it.

use super::arrangement::NODES_PER_RADIUS;
use super::place_of_input;
use crate::limits::number;
use crate::scene::lateral_extents;
use crate::scene::{Load, Mesh, MeshFactors, Scene, Solid};
use crate::warning::{self, Warning};

/// Growth of elements away from loads, where the scene names none.
const GROWTH: f64 = 1.2;
/// Nodes over the least feature of a load, where the scene names no spacing.
const NODES_PER_FEATURE: f64 = 10.0;

/// The warning of a value [m] of the input `LOAD.x` or `LOAD.y` that puts the footprint where nodes are too far apart.
///
/// Certain rather than complete: nodes stand as densely as all loads of the body and its symmetry let them.
pub fn implausible_place(scene: &Scene, name: &str, value: f64) -> Option<Warning> {
    if let Some(load) = scene.load.iter().find(|load| is_radius(load, name)) {
        return implausible_radius(scene, load, (name, value));
    }
    let mut loads = scene.load.iter();
    let (load, axis) = loads.find_map(|load| Some((load, axis(load, name)?)))?;
    let body = load.body_and_face().0;
    let solid = scene.solid_under(load)?;
    let growth = solid.mesh.growth.unwrap_or(GROWTH);
    if growth == 1.0 || scene.couplings_to(body).next().is_some() {
        return None;
    }
    let on_body = || scene.load.iter().filter(|other| other.body_and_face().0 == body);
    let way = on_body().map(|other| way_from(other, axis, value)).fold(f64::INFINITY, f64::min);
    if way == 0.0 {
        // Where the mesh is as fine as anywhere, `check` warns of a load too small for it.
        return None;
    }
    let finest = on_body().map(|other| spacing(solid, other)).fold(f64::INFINITY, f64::min);
    let order = solid.mesh.order.unwrap_or(if solid.sph().is_some() { 1 } else { 2 }) as f64;
    let widest = lateral_extents(&solid.shape).into_iter().fold(0.0, f64::max);
    let coarsest = 0.5 * widest / (Mesh::LATERAL_ELEMENTS * order);
    let apart =
        (finest + (growth - 1.0) * way / order).min(coarsest.max(finest)) / along(scene, body);
    let size = load.footprint.half_width(load.start.radius);
    let key = ["x", "y"][axis];
    (size < NODES_PER_RADIUS * apart).then(|| {
        let apart = format!("{apart:.1e}");
        let finding = warning::load_moved_off_fine_mesh(apart, key, &load.name);
        finding.at(place_of_input(name, value))
    })
}

/// The warning of a radius [m] across which too few nodes lie, where nodes are as dense as anywhere.
fn implausible_radius(scene: &Scene, load: &Load, (name, value): (&str, f64)) -> Option<Warning> {
    let body = load.body_and_face().0;
    let apart = spacing(scene.solid_under(load)?, load) / along(scene, body);
    (value < NODES_PER_RADIUS * apart).then(|| {
        let (apart, spacing) = (format!("{apart:.1e}"), number(value / NODES_PER_RADIUS));
        let finding = warning::load_shrunk_below_mesh(apart, &load.name, spacing);
        finding.at(place_of_input(name, value))
    })
}

fn is_radius(load: &Load, name: &str) -> bool {
    name.strip_prefix(load.name.as_str()).is_some_and(|rest| matches!(rest, ".radius" | "_radius"))
}

/// How many times as many elements as usual a body has along the surface.
fn along(scene: &Scene, body: &str) -> f64 {
    scene.refinement.get(body).map_or(1.0, |factors: &MeshFactors| factors.along)
}

/// Which place of a load a variable is, in either way of naming.
fn axis(load: &Load, name: &str) -> Option<usize> {
    match name.strip_prefix(load.name.as_str())? {
        ".x" | "_x" => Some(0),
        ".y" | "_y" => Some(1),
        _ => None,
    }
}

/// How far a place is from where the mesh is fine for a load, or from the image of that [m].
fn way_from(load: &Load, axis: usize, value: f64) -> f64 {
    let (start, range) = match axis {
        0 => (load.start.x, load.range.x),
        _ => (load.start.y, load.range.y),
    };
    let reach = load.footprint.half_width(load.start.radius);
    let start = start.unwrap_or(0.0);
    let [from, to] = range.unwrap_or([start; 2]);
    let beyond = |at: f64| (from - at).max(at - to).max(0.0);
    (beyond(value).min(beyond(-value)) - reach).max(0.0)
}

/// Distance of nodes at a load [m].
fn spacing(solid: &Solid, load: &Load) -> f64 {
    let least = load.range.radius.map(|[least, _]| least).or(load.start.radius);
    let feature = load.footprint.half_width(least);
    solid.mesh.spacing.unwrap_or(feature / NODES_PER_FEATURE)
}
