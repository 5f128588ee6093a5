//! Parts of a scene that do not fit together: a droplet without a surface, loads wider than the plate, loads that the
//! mesh does not resolve.

use super::Reviewer;
use crate::scene::check::{fits, number};
use crate::scene::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::{Coupling, Droplet, Wall};
use crate::scene::{Footprint, Load, Mesh, Shape, Solid};
use crate::warning;

/// Smallest number of node spacings over the radius of a spot or half the size of tiles.
pub const NODES_PER_RADIUS: f64 = 2.0;

pub fn review(reviewer: &mut Reviewer) {
    let (scene, root) = (reviewer.scene, Path::default());
    for (name, _) in scene.droplets() {
        caught(reviewer, &root.key("body").key(name), name);
    }
    for (name, droplet) in scene.droplets() {
        if scene.has_surface_below(name) {
            arrives(reviewer, &root.key("body").key(name), droplet);
        }
    }
    for (i, coupling) in scene.coupling.iter().enumerate() {
        if let Some(droplet) = scene.drop_of(coupling) {
            let path = root.key("coupling").index(i);
            width(reviewer, &path, coupling, droplet);
            apart(reviewer, &path, i, (coupling, droplet));
        }
    }
    for (i, wall) in scene.wall.iter().enumerate() {
        if let Some(droplet) = scene.drop_above(wall) {
            resolved(reviewer, &root.key("wall").index(i).key("footprint"), wall, droplet);
        }
    }
    for (i, load) in scene.load.iter().enumerate() {
        seen(reviewer, &root.key("load").index(i), load);
    }
}

/// Warns of a droplet above a solid that it does not touch.
fn caught(reviewer: &mut Reviewer, path: &Path, name: &str) {
    let scene = reviewer.scene;
    if scene.has_surface_below(name) {
        return;
    }
    let mut solids = scene.solids().map(|(solid, _)| solid);
    if let Some(solid) = solids.find(|solid| scene.couplings_to(solid).next().is_none()) {
        reviewer.warn(path, warning::droplet_meets_no_wall(solid, name));
    }
}

/// Warns of a droplet whose first drop does not land by the stop time.
fn arrives(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let Some(arrival) = droplet.arrivals().first() else { return };
    let stop = reviewer.scene.stop_time;
    let down = arrival.time + droplet.fall_time(droplet.normal_speed());
    // A drop released half a particle spacing above the wall touches it.
    if down <= stop * (1.0 + 1e-9) || (arrival.time < stop && droplet.gap() <= droplet.spacing) {
        return;
    }
    let finding = match down.is_finite() {
        true => warning::drop_arrives_late(number(stop), number(down)),
        false => warning::drop_never_arrives(number(stop)),
    };
    let key = match (down.is_finite(), droplet.height) {
        (false, _) => "impact_velocity",
        (true, Some(_)) => "height",
        (true, None) => "arrivals",
    };
    reviewer.warn(&path.key(key), finding);
}

/// Warns of fine meshes and drops that are wider than the plate.
fn width(reviewer: &mut Reviewer, path: &Path, coupling: &Coupling, droplet: &Droplet) {
    let Some((solid, below)) = reviewer.scene.solid_below(coupling) else { return };
    let half = lateral_extents(&below.shape).map(|extent| 0.5 * extent);
    let room = half[0].min(half[1]);
    if coupling.radius.is_some_and(|radius| radius > room) {
        let finding = warning::fine_mesh_wider_than_solid(solid, number(room));
        reviewer.warn(&path.key("radius"), finding);
    }
    let reach = 0.5 * droplet.spread_diameter();
    let beyond = droplet.landings().any(|place| {
        let [x, y] = place.map(f64::abs);
        x + reach > half[0] || y + reach > half[1]
    });
    if beyond {
        let finding = warning::drop_spreads_beyond_edge(number(2.0 * reach), solid);
        reviewer.warn(&path.key("from"), finding);
    }
}

/// Warns of droplets of two bodies that are expected to overlap as they spread, or that inputs may place so.
fn apart(
    reviewer: &mut Reviewer,
    path: &Path,
    i: usize,
    (coupling, droplet): (&Coupling, &Droplet),
) {
    let scene = reviewer.scene;
    for earlier in scene.coupling[..i].iter().filter(|earlier| earlier.to == coupling.to) {
        let Some(other) = scene.drop_of(earlier) else { continue };
        if droplet.is_on_demand() || other.is_on_demand() {
            let finding = warning::droplets_of_two_bodies_may_meet(&earlier.from, &coupling.from);
            reviewer.warn(&path.key("from"), finding);
            continue;
        }
        let reach = 0.5 * (droplet.spread_diameter() + other.spread_diameter());
        let meet = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < reach;
        if droplet.landings().any(|a| other.landings().any(|b| meet(a, b))) {
            let finding = warning::droplets_of_two_bodies_meet(&earlier.from, &coupling.from);
            reviewer.warn(&path.key("from"), finding);
        }
    }
}

/// Widest cells over the particle spacing at which a separate solid is resolved if the fluid's heat warms it by more
/// than half of the temperature difference. Beyond, the error at its middle is more than a tenth of its rise.
const WIDEST_ON_POOR: f64 = 1.2;

/// Warns of cells narrower than particles, whose differences are then random. Also warns of wide cells on solids that
/// conduct less than the fluid: within these, flux and temperature vary.
fn resolved(reviewer: &mut Reviewer, path: &Path, wall: &Wall, droplet: &Droplet) {
    let (key, widths) = match wall.footprint {
        Footprint::Rings { count, radius } => ("rings", vec![radius / count as f64]),
        Footprint::Tiles { count, size } => {
            let axes = if droplet.dimension == 2 { 0..1 } else { 0..2 };
            ("tiles", axes.map(|axis| size[axis] / count[axis] as f64).collect())
        }
        _ => return,
    };
    let narrowest = widths.iter().copied().fold(f64::INFINITY, f64::min);
    let widest = widths.into_iter().fold(0.0, f64::max);
    if !fits(droplet.spacing, narrowest) {
        let (spacing, wide) = (number(droplet.spacing), number(2.0 * droplet.spacing));
        let narrowest = number(narrowest);
        let finding = warning::cells_narrower_than_particles(narrowest, &wall.under, spacing, wide);
        reviewer.warn(&path.key(key).key("count"), finding);
    }
    let effusivity = droplet.fluid.effusivity();
    if droplet.has_particles()
        && wall.effusivity.is_some_and(|solid| solid < effusivity)
        && widest > WIDEST_ON_POOR * droplet.spacing * (1.0 + 1e-9)
    {
        let (widest, spacing) = (number(widest), number(droplet.spacing));
        let finding = warning::cells_too_wide_on_poor_conductor(widest, spacing, &wall.under);
        reviewer.warn(&path.key(key).key("count"), finding);
    }
}

/// Largest node spacing along the surface for a `spacing` [m].
fn distance(spacing: f64, solid: &Solid) -> f64 {
    if solid.mesh.growth == Some(1.0) {
        return spacing;
    }
    let [x, y] = lateral_extents(&solid.shape);
    let default = if solid.sph().is_some() { 1 } else { 2 };
    let order = solid.mesh.order.unwrap_or(default) as f64;
    spacing.min(0.5 * x.max(y) / (Mesh::LATERAL_ELEMENTS * order))
}

/// Tolerance of extents for rounding, relative.
const SLACK: f64 = 1e-9;

/// Returns true if a load acts evenly on all of a face, where it has no edge that a mesh resolves.
fn covers(footprint: &Footprint, radius: Option<f64>, shape: &Shape) -> bool {
    let is_even = match footprint {
        Footprint::Tiles { count, .. } => *count == [1, 1],
        Footprint::Disc { .. } => matches!(shape, Shape::Disc(_)),
        _ => false,
    };
    let (halves, extents) = (footprint.half_extents(radius), lateral_extents(shape));
    is_even && (0..2).all(|axis| halves[axis] >= 0.5 * extents[axis] * (1.0 - SLACK))
}

/// Warns of loads that are smaller than the node spacings of the scene.
fn seen(reviewer: &mut Reviewer, path: &Path, load: &Load) {
    let Some(solid) = reviewer.scene.solid_under(load) else { return };
    if let (None, Footprint::Ring { inner, outer }) = (solid.mesh.spacing, load.footprint)
        && inner < Footprint::LEAST_HOLE * outer
    {
        let finding = warning::hole_of_ring_unresolved(number(inner / NODES_PER_RADIUS));
        reviewer.warn(&path.at("footprint.ring.inner"), finding);
    }
    let Some(spacing) = solid.mesh.spacing.map(|spacing| distance(spacing, solid)) else { return };
    let footprint = &load.footprint;
    let (key, radius) = match (load.range.radius, load.start.radius) {
        (Some([lowest, _]), _) => ("range.radius".to_owned(), Some(lowest)),
        (None, Some(start)) => ("start.radius".to_owned(), Some(start)),
        _ => (format!("footprint.{}.{}", footprint.name(), footprint.key_of_extent()), None),
    };
    let size = footprint.half_width(radius);
    if size < NODES_PER_RADIUS * spacing && !covers(footprint, radius, &solid.shape) {
        let finding = warning::load_unresolved(number(spacing), number(0.2 * size));
        reviewer.warn(&path.at(&key), finding);
    }
}
