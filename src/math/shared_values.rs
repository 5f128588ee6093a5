//! Values of one process that are made once for equal keys and live as long as somebody holds them.

use std::process;
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use super::thread::is_alone;

/// A key and the value that lives for it, if anyone still holds it.
type Entry<K, V> = (K, Arc<Mutex<Weak<V>>>);

/// The values of one process. Holds none alive and nothing that changes.
struct Known<K, V> {
    process: u32,
    entries: Mutex<Vec<Entry<K, V>>>,
}

/// Values by their keys; as a `static`, those of this process, or of the one that it has been forked from, whose
/// threads are gone and may have left locks behind.
pub struct SharedValues<K, V> {
    known: AtomicPtr<Known<K, V>>,
}

impl<K: Clone + PartialEq, V> SharedValues<K, V> {
    #[expect(clippy::new_without_default, reason = "a static wants a constant")]
    pub const fn new() -> Self {
        Self { known: AtomicPtr::new(ptr::null_mut()) }
    }

    /// The value of a key, made unless another holder in this process already has it. Those who ask for the same one
    /// meanwhile wait; those who ask for another do not.
    pub fn get_or_make<E>(
        &self,
        key: &K,
        make: impl FnOnce() -> Result<V, E>,
    ) -> Result<Arc<V>, E> {
        let slot = self.slot_of(key);
        let mut weak = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = weak.upgrade() {
            return Ok(value);
        }
        let value = Arc::new(make()?);
        *weak = Arc::downgrade(&value);
        Ok(value)
    }

    /// Whether somebody holds the value of a key.
    pub fn has(&self, key: &K) -> bool {
        self.get(key).is_some()
    }

    /// The value of a key, if somebody holds it.
    pub fn get(&self, key: &K) -> Option<Arc<V>> {
        let entries = self.entries();
        let (_, slot) = entries.iter().find(|(other, _)| other == key)?;
        slot.try_lock().ok()?.upgrade()
    }

    /// Forgets keys whose values nobody holds any more.
    pub fn forget_unused(&self) {
        let mut entries = self.entries();
        remove_stale(&mut entries);
        entries.shrink_to_fit();
    }

    /// Those of this process. What a process inherits when it is forked is taken over, unless somebody was making a
    /// value then.
    fn entries(&self) -> MutexGuard<'_, Vec<Entry<K, V>>> {
        let process = process::id();
        loop {
            let last = self.known.load(Ordering::Acquire);
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
            if self.known.compare_exchange(last, own, set, missed).is_err() {
                // SAFETY: nobody else has got it.
                drop(unsafe { Box::from_raw(own) });
            }
        }
    }

    fn slot_of(&self, key: &K) -> Arc<Mutex<Weak<V>>> {
        let mut entries = self.entries();
        if let Some((_, slot)) = entries.iter().find(|(other, _)| other == key) {
            return slot.clone();
        }
        remove_stale(&mut entries);
        let slot = Arc::new(Mutex::new(Weak::new()));
        entries.push((key.clone(), slot.clone()));
        slot
    }
}

/// A slot that only this list holds has no maker and no waiter; without a value it is stale.
fn remove_stale<K, V>(entries: &mut Vec<Entry<K, V>>) {
    entries.retain(|(_, slot)| {
        let stale = || slot.try_lock().is_ok_and(|weak| weak.strong_count() == 0);
        Arc::strong_count(slot) > 1 || !stale()
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn a_value_is_made_once_as_long_as_somebody_holds_it() {
        let values: SharedValues<u32, u32> = SharedValues::new();
        let make = |value: u32| move || Ok::<_, Infallible>(value);
        let Ok(first) = values.get_or_make(&1, make(10));
        let Ok(second) = values.get_or_make(&1, make(11));
        let Ok(other) = values.get_or_make(&2, make(20));
        assert!(Arc::ptr_eq(&first, &second), "the second holder made nothing");
        assert_eq!((*first, *other), (10, 20));
        assert!(values.has(&1) && !values.has(&3));
        drop((first, second));
        assert!(!values.has(&1));
        values.forget_unused();
        assert_eq!(values.entries().len(), 1);
        let Ok(again) = values.get_or_make(&1, make(12));
        assert_eq!(*again, 12);
    }

    #[test]
    fn what_fails_is_tried_again() {
        let values: SharedValues<u32, u32> = SharedValues::new();
        assert_eq!(values.get_or_make(&1, || Err("no")), Err("no"));
        assert_eq!(values.get_or_make(&1, || Ok::<_, &str>(7)).map(|value| *value), Ok(7));
    }
}
