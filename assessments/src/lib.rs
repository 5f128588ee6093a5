//! Assessments of scenes for the commands: levels, chosen meshes, estimated errors and warnings of them. A per-user
//! store keeps them, so that `impinge check`, `impinge run` and `build-fmu` assess a scene once.
//!
//! An assessment from the store equals one made anew to the bit: its key covers all data that it follows from. A store
//! that cannot be read or written changes nothing but the time that commands take. Units never read it.

mod environment;
mod folder;
mod key;
mod record;
mod store;

use std::collections::BTreeMap;

use impinge::model::tolerance::{self, BodyEstimate, Levels};
use impinge::runtime::{Usage, address_space};
use impinge::scene::{self, MeshFactors, ResolvedLevel, Scene};
use impinge::warning::Warning;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use key::Key;
use record::StoredWarning;
pub use store::{MOST_BYTES, Store};

/// Meshes of a scene.
pub struct Meshes {
    /// The scene with all its meshes chosen and their errors included.
    pub scene: Scene,
    /// Error estimates of each solid.
    pub estimates: Vec<BodyEstimate>,
    pub warnings: Vec<Warning>,
}

/// Resources that an assessment took when it was made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Processor time [s].
    pub time: f64,
    /// Growth of the peak memory of the process [B].
    pub memory: f64,
}

/// An assessment, made by this process or taken from the store.
pub struct Assessed<T> {
    pub found: T,
    pub cost: Cost,
    pub is_stored: bool,
}

/// Resolved levels as stored.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct StoredLevels {
    resolved: BTreeMap<String, ResolvedLevel>,
    notes: Vec<String>,
}

/// Meshes as stored.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct StoredMeshes {
    refinement: BTreeMap<String, MeshFactors>,
    estimates: Vec<BodyEstimate>,
    warnings: Vec<StoredWarning>,
}

impl Store {
    /// Resolves the open levels of a scene, as [`tolerance::levels`] does.
    pub fn levels(&self, scene: &Scene, available: f64) -> Assessed<Levels> {
        if scene.open_levels().next().is_none() {
            let found = tolerance::levels(scene, available);
            return Assessed { found, cost: Cost::default(), is_stored: false };
        }
        let read = |StoredLevels { resolved, notes }| {
            let scene = checked(Scene { resolved, ..scene.clone() })?;
            Some(Levels { scene, notes, kept: Vec::new() })
        };
        let written = |levels: &Levels| StoredLevels {
            resolved: levels.scene.resolved.clone(),
            notes: levels.notes.clone(),
        };
        // Levels that follow from the memory of this moment concern no other moment.
        let key = tolerance::levels_fit(scene, available).then(|| Key::of("levels", scene));
        self.assessed(key, || tolerance::levels(scene, available), (read, written))
    }

    /// Chooses and judges the meshes of a scene, as [`tolerance::estimates`] and [`tolerance::warnings`] do.
    pub fn meshes(&self, scene: &Scene) -> Assessed<Meshes> {
        let make = || {
            let (scene, estimates) = tolerance::estimates(scene);
            let warnings = tolerance::warnings(&scene, &estimates);
            Meshes { scene, estimates, warnings }
        };
        let read = |StoredMeshes { refinement, estimates, warnings }| {
            let scene = checked(Scene { refinement, ..scene.clone() })?;
            let warnings = warnings.into_iter().map(StoredWarning::read).collect::<Option<_>>()?;
            Some(Meshes { scene, estimates, warnings })
        };
        let written = |meshes: &Meshes| StoredMeshes {
            refinement: meshes.scene.refinement.clone(),
            estimates: meshes.estimates.clone(),
            warnings: meshes.warnings.iter().map(StoredWarning::of).collect(),
        };
        self.assessed(Some(Key::of("meshes", scene)), make, (read, written))
    }

    /// Takes an assessment from the store, or makes and stores it. Without a key it is neither looked up nor stored.
    fn assessed<T, S: Serialize + DeserializeOwned + PartialEq>(
        &self,
        key: Option<Key>,
        make: impl FnOnce() -> T,
        (read, written): (impl FnOnce(S) -> Option<T>, impl FnOnce(&T) -> S),
    ) -> Assessed<T> {
        // Trials that find too little address space end early, which another process may not do.
        let key = key.filter(|_| address_space::left().is_none());
        let stored = key.as_ref().and_then(|key| self.get::<(Cost, S)>(key));
        if let Some((cost, stored)) = stored
            && let Some(found) = read(stored)
        {
            return Assessed { found, cost, is_stored: true };
        }
        let begun = Usage::now();
        let found = make();
        let cost = Cost::since(begun);
        if let Some(key) = &key {
            self.put(key, &(cost, written(&found)));
        }
        Assessed { found, cost, is_stored: false }
    }
}

impl Cost {
    fn since(begun: Usage) -> Self {
        let done = Usage::now();
        Self {
            time: done.processor_time - begun.processor_time,
            memory: done.peak_memory - begun.peak_memory,
        }
    }
}

/// Returns a scene if the checks of packed scenes accept it.
fn checked(scene: Scene) -> Option<Scene> {
    scene::check(&scene).ok().map(|()| scene)
}
