//! Which solids of a scene that leaves it open are reduced: those whose bound keeps the tolerance.

use super::{Resolved, resolve};
use crate::body::{BodyError, KeptReduction, reductions};
use crate::inputs::InputLayout;
use crate::model::{Model, ModelError, check_memory, initial_inputs};
use crate::runtime::thread::aside;
use crate::scene::{ResolvedLevel, Scene, SolidLevel};

/// A scene in which no level is left open.
pub struct Levels {
    pub scene: Scene,
    /// What the level of each solid came to that was left open, and why: a sentence each.
    pub notes: Vec<String>,
    /// Reductions that were made to find out, for models that need them as long as this is held.
    pub kept: Vec<KeptReduction>,
}

/// Finds the levels that a scene leaves open: a solid is reduced where that can be and its bound keeps the tolerance,
/// else it is taken in full. Models that would take more memory than is `available` [B] are not tried.
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

/// What keeps a solid from being reduced within the tolerance.
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

/// One solid of a scene, reduced, which nothing touches.
fn alone(scene: &Scene, name: &str) -> Scene {
    let resolved = ResolvedLevel { level: SolidLevel::Reduced };
    Scene { resolved: [(name.to_owned(), resolved)].into(), ..scene.alone(name) }
}

/// The model of a scene with solids that are reduced: only that tells their orders and bounds.
pub fn reduced_model(scene: &Scene, available: f64) -> Result<Option<Model>, ModelError> {
    let has_any = scene.reduced_bodies().next().is_some();
    has_any.then(|| model(scene, available)).transpose()
}

fn model(scene: &Scene, available: f64) -> Result<Model, ModelError> {
    check_memory(scene, available)?;
    Model::build(scene, scene.solver.threads)
}

/// The reductions of a scene, each with the name of its body, as bytes.
pub fn stored_reductions(scene: &Scene) -> Result<Vec<(String, Vec<u8>)>, BodyError> {
    let Resolved { scene, choices: _choices } = resolve(scene);
    let layout = InputLayout::of(&scene);
    let start = initial_inputs(&scene);
    aside(|| reductions(&scene, (&layout, &start), scene.solver.threads))
}
