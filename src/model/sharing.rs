//! Units of one process that have equal scenes share one immutable model.

use std::process;
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use super::{Model, ModelError, check_memory};
use crate::math::thread::{aside, is_alone};
use crate::scene::Scene;

/// A scene and the model that lives for it, if any unit still holds it.
type Entry = (Scene, Arc<Mutex<Weak<Model>>>);

/// The models of one process. Holds none alive and nothing that changes.
struct Known {
    process: u32,
    entries: Mutex<Vec<Entry>>,
}

/// That of this process, or of the one that it has been forked from, whose threads are gone and may have
/// left locks behind.
static KNOWN: AtomicPtr<Known> = AtomicPtr::new(ptr::null_mut());

/// Those of this process. What a process inherits when it is forked is taken over, unless somebody was
/// building then.
fn entries() -> MutexGuard<'static, Vec<Entry>> {
    let process = process::id();
    loop {
        let last = KNOWN.load(Ordering::Acquire);
        // SAFETY: null, or leaked below.
        let known = unsafe { last.as_ref() };
        if let Some(known) = known.filter(|known| known.process == process) {
            return known.entries.lock().unwrap_or_else(PoisonError::into_inner);
        }
        let inherited =
            known.filter(|_| is_alone()).and_then(|known| known.entries.try_lock().ok());
        let entries = Mutex::new(inherited.map_or_else(Vec::new, |entries| entries.clone()));
        let own = Box::into_raw(Box::new(Known { process, entries }));
        let (set, missed) = (Ordering::AcqRel, Ordering::Relaxed);
        if KNOWN.compare_exchange(last, own, set, missed).is_err() {
            // SAFETY: nobody else has got it.
            drop(unsafe { Box::from_raw(own) });
        }
    }
}

impl Model {
    /// The model of `scene`, built unless another holder in this process already has it. Those who
    /// ask for the same one meanwhile wait; those who ask for another do not. One that would take more
    /// memory than is `available` [B] is not built.
    pub fn shared(scene: &Scene, threads: usize, available: f64) -> Result<Arc<Model>, ModelError> {
        aside(|| Self::shared_here(scene, threads, available))
    }

    /// Forgets scenes whose models nobody holds any more.
    pub fn forget_unused() {
        let mut entries = entries();
        remove_stale(&mut entries);
        entries.shrink_to_fit();
    }

    fn shared_here(
        scene: &Scene,
        threads: usize,
        available: f64,
    ) -> Result<Arc<Model>, ModelError> {
        let slot = slot_of(scene);
        let mut weak = slot.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(model) = weak.upgrade() {
            return Ok(model);
        }
        check_memory(scene, available)?;
        let model = Arc::new(Model::build(scene, threads)?);
        *weak = Arc::downgrade(&model);
        Ok(model)
    }
}

fn slot_of(scene: &Scene) -> Arc<Mutex<Weak<Model>>> {
    let mut entries = entries();
    if let Some((_, slot)) = entries.iter().find(|(other, _)| other == scene) {
        return slot.clone();
    }
    remove_stale(&mut entries);
    let slot = Arc::new(Mutex::new(Weak::new()));
    entries.push((scene.clone(), slot.clone()));
    slot
}

/// A slot that only this list holds has no builder and no waiter; without a model it is stale.
fn remove_stale(entries: &mut Vec<Entry>) {
    entries.retain(|(_, slot)| {
        let stale = || slot.try_lock().is_ok_and(|weak| weak.strong_count() == 0);
        Arc::strong_count(slot) > 1 || !stale()
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");
    const ENOUGH: f64 = 1e9;

    #[test]
    fn equal_scenes_have_one_model_as_long_as_somebody_holds_it() {
        let scene = parse(SCENE, "scene.toml").unwrap();
        let first = Model::shared(&scene, 1, ENOUGH).unwrap();
        let second = Model::shared(&scene, 1, ENOUGH).unwrap();
        assert!(Arc::ptr_eq(&first, &second), "the second holder built nothing");
        let mut warmer = scene.clone();
        warmer.name = "Other".into();
        let other = Model::shared(&warmer, 1, ENOUGH).unwrap();
        assert!(!Arc::ptr_eq(&first, &other));
        let weak = Arc::downgrade(&first);
        drop((first, second));
        assert!(weak.upgrade().is_none(), "nobody holds the model");
    }

    #[test]
    fn only_a_model_that_is_to_be_built_asks_for_memory() {
        let mut scene = parse(SCENE, "scene.toml").unwrap();
        scene.name = "Large".into();
        let refused = Model::shared(&scene, 1, 1e3).err().unwrap();
        assert!(matches!(refused, ModelError::Memory { .. }), "{refused}");
        let first = Model::shared(&scene, 1, ENOUGH).unwrap();
        assert!(Arc::ptr_eq(&first, &Model::shared(&scene, 1, 1e3).unwrap()));
    }

    #[test]
    fn those_who_ask_at_once_get_the_same_model() {
        let mut scene = parse(SCENE, "scene.toml").unwrap();
        scene.name = "AtOnce".into();
        let models: Vec<Arc<Model>> = std::thread::scope(|scope| {
            let ask = |_| scope.spawn(|| Model::shared(&scene, 1, ENOUGH).unwrap());
            let asked: Vec<_> = (0..4).map(ask).collect();
            asked.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(models.iter().all(|model| Arc::ptr_eq(model, &models[0])));
    }
}
