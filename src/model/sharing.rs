//! Units of one process that have equal scenes share one immutable model.

use std::sync::{Arc, Mutex, OnceLock, Weak};

use super::{Model, ModelError};
use crate::scene::Scene;

/// A scene and the model that lives for it, if any unit still holds it.
type Entry = (Scene, Arc<Mutex<Weak<Model>>>);

/// Holds no model alive and nothing that changes.
static KNOWN: OnceLock<Mutex<Vec<Entry>>> = OnceLock::new();

impl Model {
    /// The model of `scene`, built unless another holder in this process already has it. Those who
    /// ask for the same one meanwhile wait; those who ask for another do not.
    pub fn shared(scene: &Scene, threads: usize) -> Result<Arc<Model>, ModelError> {
        let slot = slot_of(scene);
        let mut weak = slot.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(model) = weak.upgrade() {
            return Ok(model);
        }
        let model = Arc::new(Model::build(scene, threads)?);
        *weak = Arc::downgrade(&model);
        Ok(model)
    }
}

fn slot_of(scene: &Scene) -> Arc<Mutex<Weak<Model>>> {
    let known = KNOWN.get_or_init(Mutex::default);
    let mut entries = known.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Some((_, slot)) = entries.iter().find(|(other, _)| other == scene) {
        return slot.clone();
    }
    // A slot that only this list holds has no builder and no waiter; without a model it is stale.
    entries.retain(|(_, slot)| {
        let stale = || slot.try_lock().is_ok_and(|weak| weak.strong_count() == 0);
        Arc::strong_count(slot) > 1 || !stale()
    });
    let slot = Arc::new(Mutex::new(Weak::new()));
    entries.push((scene.clone(), slot.clone()));
    slot
}
