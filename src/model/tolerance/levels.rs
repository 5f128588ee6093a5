//! Resolution of `level = "auto"`: solids whose error bound keeps the tolerance are reduced.

use super::{Resolved, resolve};
use crate::body::{BodyError, KeptReduction, reductions};
use crate::inputs::InputLayout;
use crate::model::{Model, ModelError, check_memory, initial_inputs};
use crate::runtime::thread::aside;
use crate::scene::{ResolvedLevel, Scene, SolidLevel};

/// A scene in which every level is resolved.
pub struct Levels {
    pub scene: Scene,
    /// Notes on the chosen level of each solid, with reasons: one sentence each.
    pub notes: Vec<String>,
    /// Reductions made for this choice; models reuse them while this is held.
    pub kept: Vec<KeptReduction>,
}

/// Resolves the open levels of a scene: a solid is reduced if this is possible and its bound keeps the tolerance;
/// otherwise the full solid is used. Models that need more memory than is `available` [B] are not tried.
pub fn levels(scene: &Scene, available: f64) -> Levels {
    let mut found = Levels { scene: scene.clone(), notes: Vec::new(), kept: Vec::new() };
    for name in scene.open_levels() {
        let (level, note) = match obstacle((scene, available), name, &mut found.kept) {
            None => (SolidLevel::Reduced, format!("{name}: reduced, which keeps the tolerance")),
            Some(why) => (SolidLevel::Full, format!("{name}: full, as {why}")),
        };
        found.scene.resolved.insert(name.to_owned(), ResolvedLevel { level });
        found.notes.push(note);
    }
    found
}

/// Returns true if `available` memory [B] decides on none of the open levels of a scene.
pub fn levels_fit(scene: &Scene, available: f64) -> bool {
    let fits = |name: &str| check_memory(&alone(scene, name), available).is_ok();
    scene.open_levels().all(|name| scene.obstacle(name).is_some() || fits(name))
}

/// Returns what prevents the reduction of a solid within the tolerance.
fn obstacle(
    (scene, available): (&Scene, f64),
    name: &str,
    kept: &mut Vec<KeptReduction>,
) -> Option<String> {
    if let Some(obstacle) = scene.obstacle(name) {
        return Some(obstacle.message);
    }
    let model = match model(&alone(scene, name), available) {
        Ok(model) => model,
        Err(error) => return Some(error.to_string()),
    };
    let beyond = model.bodies.iter().find_map(|body| body.beyond_tolerance(""));
    if beyond.is_none() {
        kept.extend(model.reductions().into_iter().map(|(_, reduction)| reduction));
    }
    beyond.map(|warning| warning.finding().to_string())
}

/// Scene of one solid, reduced, without contacts.
fn alone(scene: &Scene, name: &str) -> Scene {
    let resolved = ResolvedLevel { level: SolidLevel::Reduced };
    Scene { resolved: [(name.to_owned(), resolved)].into(), ..scene.alone(name) }
}

/// Builds the model of a scene with reduced solids, which alone reports their orders and bounds.
pub fn reduced_model(scene: &Scene, available: f64) -> Result<Option<Model>, ModelError> {
    let has_any = scene.reduced_bodies().next().is_some();
    has_any.then(|| model(scene, available)).transpose()
}

fn model(scene: &Scene, available: f64) -> Result<Model, ModelError> {
    check_memory(scene, available)?;
    Model::build(scene, scene.solver.threads)
}

/// Returns the reductions of a scene, as bytes, each with the name of its body.
pub fn stored_reductions(scene: &Scene) -> Result<Vec<(String, Vec<u8>)>, BodyError> {
    let Resolved { scene, choices: _choices } = resolve(scene);
    let layout = InputLayout::of(&scene);
    let start = initial_inputs(&scene);
    aside(|| reductions(&scene, (&layout, &start), scene.solver.threads))
}
