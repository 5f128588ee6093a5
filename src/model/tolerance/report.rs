//! Reports of estimates: per body, in warnings, and in packed scenes.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use super::choice::{COARSEST_TRIED, Levels, Trials, factors, open, search};
use super::estimate::{Estimate, OutputError};
use super::resolve;
use super::small;
use super::twin::{Physics, Twin};
use crate::body::{forecast, warnings_on_landing, warnings_on_strands};
use crate::quantity::{Quantity, percent};
use crate::scene::{
    Footprint, Load, MeshFactors, Scene, Shape, Solid, SolidLevel, Stratum, lateral_extents,
};
use crate::variables::Registry;
use crate::warning::{self, Warning};

/// Estimated errors of the outputs of a body on its mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyEstimate {
    pub body: String,
    /// Relative to their ranges over the default experiment.
    pub outputs: Vec<OutputError>,
    /// Notes on omissions of the estimate and on outputs without one: one sentence each.
    pub notes: Vec<String>,
    /// Output whose error no finer mesh lessens.
    pub stuck: Option<String>,
}

impl BodyEstimate {
    /// Returns the largest error of any output; `None` without an estimate.
    pub fn worst(&self) -> Option<f64> {
        let all = self.outputs.iter().map(OutputError::total);
        all.fold(None, |worst, error| Some(worst.map_or(error, |worst: f64| worst.max(error))))
    }

    /// Returns the largest error along the surface or through the thickness.
    fn worst_of(&self, way: usize) -> f64 {
        Estimate { outputs: self.outputs.clone() }.worst_of(way)
    }
}

/// Returns a scene with all its meshes chosen and their errors included, and the error estimates of each solid.
pub fn estimates(scene: &Scene) -> (Scene, Vec<BodyEstimate>) {
    let mut resolved = resolve(scene).scene;
    let mut estimates: Vec<_> =
        resolved.with_fields().map(|(name, _)| estimate(&resolved, name)).collect();
    for one in &estimates {
        let own = MeshFactors::of([1.0; 2]);
        let factors = resolved.refinement.entry(one.body.clone()).or_insert(own);
        factors.estimated_error = one.worst();
    }
    estimates.extend(resolved.body.keys().filter_map(|name| small::estimate(&resolved, name)));
    (resolved, estimates)
}

/// Estimates the errors of the outputs of a solid on the mesh of a scene.
pub fn estimate(scene: &Scene, name: &str) -> BodyEstimate {
    let mut found =
        BodyEstimate { body: name.to_owned(), outputs: Vec::new(), notes: Vec::new(), stuck: None };
    if scene.meshed(name).is_none() {
        found.notes.push("no estimate: particles conduct the heat of the body".to_owned());
        return found;
    }
    if scene.lies_below_strand(name) {
        found.notes.push("no estimate: heat comes from a strand".to_owned());
        return found;
    }
    if scene.meshed(name).is_some_and(|solid| solid.bath.is_some()) {
        found.notes.push("no estimate: the body sinks into a bath".to_owned());
        return found;
    }
    if scene.asks_mechanics(name) && Twin::of(scene, name, Physics::Deformation).is_none() {
        let solid = scene.meshed(name);
        let why = match solid.is_some_and(Solid::cracks) {
            true => "cracks change them",
            false => "no probe, field or running maximum gives them",
        };
        found.notes.push(format!("no estimate of stress and displacement: {why}"));
    }
    for physics in [Physics::Heat, Physics::Deformation] {
        let Some(twin) = Twin::of(scene, name, physics) else { continue };
        for what in &twin.simplified {
            let note = format!("in the estimate {what}");
            if !found.notes.contains(&note) {
                found.notes.push(note);
            }
        }
        of_physics(&twin, physics, &mut found);
    }
    overshoot(scene, name, &mut found);
    if scene.is_reduced(name) {
        // The full body offers more readings.
        let offered = Registry::structured(scene);
        found.outputs.retain(|one| offered.find(&one.name).is_some());
    }
    found
}

/// Raises the error of the highest temperature where the mesh does not resolve edges of footprints: a jump of the flux
/// overshoots there on every mesh alike, so that comparison with finer ones does not show it.
fn overshoot(scene: &Scene, name: &str, found: &mut BodyEstimate) {
    let Some(solid) = scene.meshed(name) else { return };
    let has_edge = |load: &Load| load.heats() && has_edge_on(&solid.shape, load);
    if !scene.loads_on(name).any(has_edge) {
        return;
    }
    let forecast = forecast(scene);
    let Some(body) = forecast.bodies.iter().find(|body| body.name == name) else { return };
    let along = body.spacing[..2].iter().map(|[least, _]| *least).filter(|least| *least > 0.0);
    let finest = along.fold(f64::INFINITY, f64::min);
    let [top, ..] = &solid.strata()[..] else { return };
    let spread = (top.constants.diffusivity() * scene.stop_time).sqrt();
    if spread > RESOLVED * finest {
        return;
    }
    let hottest = format!("{name}.max_temperature");
    for one in found.outputs.iter_mut().filter(|one| one.name == hottest) {
        if one.along >= OVERSHOOT {
            continue;
        }
        one.along = OVERSHOOT;
        found.stuck = Some(hottest.clone());
        found.notes.push(format!(
            "{hottest}: by the stop time heat spreads {spread:.1e} m, less than the mesh resolves along the surface, and \
             the highest value overshoots at edges of footprints"
        ));
    }
}

/// Returns true if the flux of a load jumps on its face; a footprint that covers the face has no edge on it.
fn has_edge_on(shape: &Shape, load: &Load) -> bool {
    let ends = lateral_extents(shape).map(|extent| 0.5 * extent);
    let reaches = |edge: f64, axis: usize| edge >= (1.0 - ROUNDING) * ends[axis];
    match (load.footprint.edges(load.start.radius), shape) {
        ([None, _], _) => false,
        ([Some(x), Some(y)], Shape::Box(_))
            if matches!(load.footprint, Footprint::Tiles { .. }) =>
        {
            !(reaches(x, 0) && reaches(y, 1))
        }
        ([Some(outer), None], Shape::Disc(_)) => !reaches(outer, 0),
        _ => true,
    }
}

/// Remedy for the overshoot at edges.
const OF_EDGES: &str = "finer meshes overshoot as much at the edge of a footprint: a probe off the edge or a mean over \
                        the footprint does not";

/// Share by which the highest temperature overshoots at the edge of a footprint (8.2 % measured under discs), and the
/// distance over which heat spreads, in spacings of nodes, from which on it does not.
const OVERSHOOT: f64 = 0.09;
const RESOLVED: f64 = 0.5;
/// Share of a length below which two count as equal.
const ROUNDING: f64 = 1e-9;

fn of_physics(twin: &Twin, physics: Physics, found: &mut BodyEstimate) {
    let what = match physics {
        Physics::Heat => "temperatures",
        Physics::Deformation => "stress and displacement",
    };
    let mut trials = Trials::new(twin, physics);
    if trials.is_blind() || trials.is_idle() {
        let why = if trials.is_idle() {
            "nothing acts on the body by itself"
        } else {
            "nothing of them can be read"
        };
        found.notes.push(format!("no estimate of {what}: {why}"));
        return;
    }
    // A mesh too large to be tried is judged by coarser ones.
    let down = (0..=-COARSEST_TRIED).find(|&down| !trials.is_too_large([-down; 2]));
    let Some(down) = down else {
        found.notes.push(format!("no estimate of {what}: the mesh is too large to be tried"));
        return;
    };
    let levels = [-down; 2];
    let estimate = match trials.judge(levels) {
        Ok(estimate) => estimate,
        Err(error) => {
            found.notes.push(format!("no estimate of {what}: {error}"));
            return;
        }
    };
    let may_flow = twin.solid().yields();
    if twin.has_history && may_flow && !trials.flows(levels) {
        found.notes.push(
            "nothing flows under the inputs that the estimate tries: once the body does, errors of stress are larger"
                .to_owned(),
        );
    }
    // An error of second order decreases by a half with each level, one of first order by √½.
    let (power, order) = if twin.has_history { (0.5, "that") } else { (1.0, "the square of that") };
    if down > 0 {
        found.notes.push(format!(
            "errors of {what} are those of a mesh {:.1} times as coarse over {order}",
            2f64.powf(0.5 * f64::from(down))
        ));
    }
    let scale = 0.5f64.powf(power * f64::from(down));
    found.outputs.extend(estimate.outputs.into_iter().map(|one| OutputError {
        along: one.along * scale,
        through: one.through * scale,
        ..one
    }));
}

/// Ratios of element counts along the surface and through the thickness between a mesh that would keep the tolerance of
/// a scene and the body's mesh; `None` if that mesh is too far away to be predicted.
pub fn finer_mesh(scene: &Scene, estimate: &BodyEstimate) -> Option<[f64; 2]> {
    let tolerance = scene.fidelity.tolerance;
    if let Some(twin) = Twin::of(scene, &estimate.body, Physics::Heat) {
        let mut trials = Trials::new(&twin, Physics::Heat);
        let is_watched = |one: &OutputError| trials.watched.iter().any(|own| own.name == one.name);
        let is_thermal = estimate.outputs.iter().all(is_watched);
        let start: Levels = [0; 2];
        if is_thermal
            && let (levels, Some(error)) = search(&mut trials, start, [true; 2], tolerance)
            && error <= tolerance
        {
            return Some(factors(levels));
        }
    }
    let by_order = by_order(estimate, tolerance);
    (by_order[0].max(by_order[1]) <= FARTHEST).then_some(by_order)
}

/// Ratios of element counts of a mesh that would keep a tolerance, for errors of second order.
fn by_order(estimate: &BodyEstimate, tolerance: f64) -> [f64; 2] {
    [0, 1].map(|way| (estimate.worst_of(way) / (0.5 * tolerance)).sqrt().max(1.0))
}

/// Largest ratio of element counts for which the order alone predicts a mesh.
const FARTHEST: f64 = 8.0;

/// The same ratio for the mesh that is proposed instead.
const NEXT: f64 = 2.0;

/// Growth of elements if a scene sets only node spacings.
const GROWTH: f64 = 1.2;

/// Smallest node spacings along the surface and through the thickness of a mesh with these ratios of element counts
/// [m].
fn finest(scene: &Scene, name: &str, factors: [f64; 2]) -> [f64; 2] {
    let mut finer = scene.clone();
    let own = finer.refinement.get(name).map_or([1.0; 2], MeshFactors::factors);
    let [along, through] = [0, 1].map(|way| own[way] * factors[way]);
    let mesh = MeshFactors::of([along, through]);
    finer.refinement.insert(name.to_owned(), mesh);
    let bodies = forecast(&finer).bodies;
    let body = bodies.iter().find(|body| body.name == name);
    let spacing = body.map_or([[0.0; 2]; 3], |body| body.spacing);
    let lateral = spacing[..2].iter().filter(|[_, most]| *most > 0.0);
    [lateral.map(|[least, _]| *least).fold(f64::INFINITY, f64::min), spacing[2][0]]
}

/// Warns of bodies whose mesh does not keep the tolerance of a scene, with the spacing that would, of drops that may
/// land where the mesh below is coarse, and of large and coarse meshes below strands.
pub fn warnings(scene: &Scene, estimates: &[BodyEstimate]) -> Vec<Warning> {
    let of_meshes = estimates.iter().filter_map(|estimate| beyond_tolerance(scene, estimate));
    let of_strands = warnings_on_strands(scene);
    of_meshes.chain(warnings_on_landing(scene)).chain(of_strands).collect()
}

/// Estimate of an output's error from which on the mesh of a body causes a warning.
pub fn warned_from(scene: &Scene, body: &str) -> f64 {
    let over = match scene.meshed(body) {
        Some(solid) if open(solid) == [true; 2] => OVER,
        Some(_) => 1.0,
        None => small::OVER,
    };
    over * scene.fidelity.tolerance
}

fn beyond_tolerance(scene: &Scene, estimate: &BodyEstimate) -> Option<Warning> {
    let tolerance = scene.fidelity.tolerance;
    if scene.meshed(&estimate.body).is_none() {
        return small::beyond_tolerance(scene, estimate);
    }
    let solid = scene.meshed(&estimate.body)?;
    let is_open = open(solid) == [true; 2];
    let most = warned_from(scene, &estimate.body);
    let worst = estimate.worst().filter(|&worst| worst > most)?;
    let name = &estimate.body;
    let output = estimate.outputs.iter().max_by(|a, b| a.total().total_cmp(&b.total()))?;
    let error = match worst {
        beyond if beyond > 1.0 => "its whole range or more".to_owned(),
        _ => format!("{} of its range at most", percent(worst)),
    };
    let (output, wanted) = (&output.name, percent(tolerance));
    if locks(solid) && is_mechanical(scene, output) {
        return Some(warning::mesh_locks(output, error, wanted).at(name));
    }
    let remedy = match is_open {
        _ if estimate.stuck.as_ref() == Some(output) => OF_EDGES.to_owned(),
        true => finer_factors(scene, estimate),
        false => finer_spacing(scene, estimate, solid),
    };
    Some(warning::mesh_beyond_tolerance(output, error, wanted, remedy).at(name))
}

/// Keys of a mesh that would keep the tolerance.
fn finer_spacing(scene: &Scene, estimate: &BodyEstimate, solid: &Solid) -> String {
    let Some([along, through]) = finer_mesh(scene, estimate) else {
        if solid.cracks() {
            return "the mesh of cracks is far from keeping it: take a smaller body".to_owned();
        }
        return "leave out `mesh.spacing` and `mesh.depth_spacing`, which are far from keeping it: the mesh then follows \
                from the tolerance"
            .to_owned();
    };
    let [spacing, depth] = finest(scene, &estimate.body, [along, through]);
    if solid.cracks() {
        return format!(
            "about `mesh.spacing = {spacing:.1e}`, `mesh.depth_spacing = {depth:.1e}` would keep it"
        );
    }
    let growth = solid.mesh.growth.unwrap_or(GROWTH);
    let growth = 1.0 + (growth - 1.0) / along.max(through);
    format!(
        "about `mesh.spacing = {spacing:.1e}`, `mesh.depth_spacing = {depth:.1e}`, `mesh.growth = {growth:.3}` would keep it"
    )
}

/// Estimate over the tolerance from which on a chosen mesh causes a warning: actual errors are less than half of the
/// estimates (`docs/fidelity.md`).
const OVER: f64 = 1.5;

/// Poisson's ratio from which on linear elements of a section lock.
const LOCKING: f64 = 0.49;

/// Returns true if a solid has elements that lock, because its layers are nearly incompressible.
fn locks(solid: &Solid) -> bool {
    let is_stiff_in_volume =
        |stratum: &Stratum| stratum.constants.poisson.is_some_and(|poisson| poisson > LOCKING);
    solid.mesh.order == Some(1)
        && matches!(solid.shape, Shape::Disc(_))
        && solid.strata().iter().any(is_stiff_in_volume)
}

/// Returns true if an output of a scene is a stress or a displacement.
fn is_mechanical(scene: &Scene, output: &str) -> bool {
    let registry = Registry::structured(scene);
    let quantity = registry.find(output).and_then(|place| registry.variables[place].quantity);
    matches!(quantity, Some(Quantity::Stress | Quantity::Displacement))
}

/// Factors of the mesh of a body that would keep the tolerance, for errors of second order.
fn finer_factors(scene: &Scene, estimate: &BodyEstimate) -> String {
    let name = &estimate.body;
    let [along, through] = scene.refinement.get(name).map_or([1.0; 2], MeshFactors::factors);
    let more = by_order(estimate, scene.fidelity.tolerance);
    let is_near = more[0].max(more[1]) <= FARTHEST;
    // So far from the tolerance no convergence order is reliable: a slightly finer mesh gives a better estimate.
    let next = more.map(|factor| if is_near { factor } else { factor.min(NEXT) });
    let promise = if is_near { "would keep it" } else { "would show which mesh keeps it" };
    format!(
        "its mesh has along = {along:.2}, through = {through:.2}, and finer ones are not tried here: about \
         `[refinement.{name}]` with along = {:.2}, through = {:.2} {promise}",
        along * next[0],
        through * next[1]
    )
}

/// Start of the text that packing adds to a scene, on which the unit's GUID does not depend.
pub const PACKED: &str =
    "\n# Added when packed: how fine meshes are, what outputs err by, and levels left open.\n";

/// Returns the text of a scene with the meshes, errors and levels of the same scene if these are known. Its unit then
/// neither chooses nor estimates anew.
pub fn packed_text(scene: &Scene, text: &str, known: &Scene) -> String {
    let mut packed = String::new();
    for (body, mesh) in
        known.refinement.iter().filter(|(body, _)| !scene.refinement.contains_key(*body))
    {
        let MeshFactors { along, through, estimated_error, .. } = mesh;
        let _ = write!(packed, "[refinement.{body}]\nalong = {along:?}\nthrough = {through:?}\n");
        if let Some(error) = estimated_error {
            let _ = writeln!(packed, "estimated_error = {error:e}");
        }
    }
    for (body, resolved) in
        known.resolved.iter().filter(|(body, _)| !scene.resolved.contains_key(*body))
    {
        let level = match resolved.level {
            SolidLevel::Full => "full",
            SolidLevel::Reduced => "reduced",
        };
        let _ = write!(packed, "[resolved.{body}]\nlevel = \"{level}\"\n");
    }
    match packed.is_empty() {
        true => text.to_owned(),
        false => format!("{text}{PACKED}{packed}"),
    }
}
