//! Meshes that keep the tolerance of a scene, and error estimates of outputs.
//!
//! Each body is tried alone over the default experiment, on meshes of several levels. Differences to outputs on meshes
//! that are coarser along the surface, or through the thickness, estimate the error of either direction. The mesh is
//! refined where the error is too large.

pub mod choice;
pub mod estimate;
pub mod experiment;
mod levels;
mod order;
mod report;
pub mod responses;
mod sample;
mod small;
pub mod twin;

use std::convert::Infallible;
use std::sync::Arc;

pub use crate::quantity::percent;
use crate::runtime::shared_values::SharedValues;
use crate::scene::{MeshFactors, Scene};
use choice::{Choice, choose, is_chosen};
pub use levels::{Levels, levels, levels_fit, reduced_model, stored_reductions};
pub use report::{
    BodyEstimate, PACKED, estimate as estimate_of, estimates, finer_mesh, packed_text, warned_from,
    warnings,
};
use twin::MOST_PROBES;

/// Meshes by scene and name of the body.
static CHOICES: SharedValues<(Scene, String), Choice> = SharedValues::new();

/// A scene in which every mesh that follows from the tolerance is chosen.
pub struct Resolved {
    pub scene: Scene,
    /// The choices made; other scenes with equal keys reuse them while this is held.
    pub choices: Vec<Arc<Choice>>,
}

/// Chooses the open meshes of a scene so that they keep its tolerance.
pub fn resolve(scene: &Scene) -> Resolved {
    let mut resolved = Resolved { scene: scene.clone(), choices: Vec::new() };
    for name in scene.body.keys().filter(|name| is_chosen(scene, name)) {
        let key = (scene.clone(), name.clone());
        let Ok(choice) = CHOICES.get_or_make(&key, || Ok::<_, Infallible>(choose(scene, name)));
        let [along, through] = choice.factors;
        let factors =
            MeshFactors { estimated_error: choice.error, ..MeshFactors::of([along, through]) };
        resolved.scene.refinement.insert(name.clone(), factors);
        resolved.choices.push(choice);
    }
    resolved
}

/// Notes, ahead of the trials, that a scene has more probes than are tried.
pub fn note_on_sample(scene: &Scene) -> Option<String> {
    let probes = scene.probe.len();
    (probes > MOST_PROBES).then(|| {
        format!("of {probes} probes, {MOST_PROBES} a body determine its mesh and the estimates of errors")
    })
}

/// Drops choices that are no longer held.
pub fn forget_unused() {
    CHOICES.forget_unused();
}
