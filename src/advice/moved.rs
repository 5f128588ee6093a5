//! Footprints that an input moves out of the fine mesh, or makes too small for it.

use super::arrangement::NODES_PER_RADIUS;
use super::place_of_input;
use crate::limits::number;
use crate::scene::lateral_extents;
use crate::scene::{Load, Mesh, MeshFactors, Scene, Solid};
use crate::warning::{self, Warning};

/// Growth of elements away from loads, unless the scene sets it.
const GROWTH: f64 = 1.2;
/// Number of nodes over the smallest feature of a load, unless the scene sets a spacing.
const NODES_PER_FEATURE: f64 = 10.0;

/// Returns a warning about a value [m] of the input `LOAD.x` or `LOAD.y` at which the mesh is too coarse for the
/// footprint.
///
/// It has no false positives, but may miss cases: it assumes the densest nodes that the body's loads and symmetry
/// allow.
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
        // If the mesh is at its finest, `check` warns of a load too small for it.
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

/// Returns a warning about a radius [m] that is too small even for the finest part of the mesh.
fn implausible_radius(scene: &Scene, load: &Load, (name, value): (&str, f64)) -> Option<Warning> {
    let body = load.body_and_face().0;
    let apart = spacing(scene.solid_under(load)?, load) / along(scene, body);
    let is_smaller = value < load.footprint.half_width(load.start.radius);
    (is_smaller && value < NODES_PER_RADIUS * apart).then(|| {
        let (apart, spacing) = (format!("{apart:.1e}"), number(value / NODES_PER_RADIUS));
        let finding = warning::load_shrunk_below_mesh(apart, &load.name, spacing);
        finding.at(place_of_input(name, value))
    })
}

fn is_radius(load: &Load, name: &str) -> bool {
    name.strip_prefix(load.name.as_str()).is_some_and(|rest| matches!(rest, ".radius" | "_radius"))
}

/// Ratio of a body's number of elements along the surface to the usual number.
fn along(scene: &Scene, body: &str) -> f64 {
    scene.refinement.get(body).map_or(1.0, |factors: &MeshFactors| factors.along)
}

/// Returns the coordinate of a load that a variable represents, in either naming.
fn axis(load: &Load, name: &str) -> Option<usize> {
    match name.strip_prefix(load.name.as_str())? {
        ".x" | "_x" => Some(0),
        ".y" | "_y" => Some(1),
        _ => None,
    }
}

/// Distance of a place from the fine mesh of a load, or from the image of that [m].
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

/// Node spacing at a load [m].
fn spacing(solid: &Solid, load: &Load) -> f64 {
    let least = load.range.radius.map(|[least, _]| least).or(load.start.radius);
    let feature = load.footprint.half_width(least);
    solid.mesh.spacing.unwrap_or(feature / NODES_PER_FEATURE)
}
