//! Process-wide shared values: made once for equal keys, and dropped with their last user.

use std::sync::{Arc, Weak};

use super::fork_lock::ForkLock;

/// A key and its value, while that is in use.
type Entry<K, V> = (K, Arc<ForkLock<Weak<V>>>);

/// Weakly held values by their keys. A forked process inherits those of its parent; it makes the unfinished ones again.
pub struct SharedValues<K, V> {
    entries: ForkLock<Vec<Entry<K, V>>>,
}

impl<K: Clone + PartialEq, V> SharedValues<K, V> {
    #[expect(clippy::new_without_default, reason = "a static wants a constant")]
    pub const fn new() -> Self {
        Self { entries: ForkLock::new(Vec::new()) }
    }

    /// Returns the value of a key; makes it unless it is in use in this process. Concurrent requests for the same key
    /// wait; those for other keys do not.
    pub fn get_or_make<E>(
        &self,
        key: &K,
        make: impl FnOnce() -> Result<V, E>,
    ) -> Result<Arc<V>, E> {
        let slot = self.slot_of(key);
        let mut weak = slot.lock();
        if let Some(value) = weak.upgrade() {
            return Ok(value);
        }
        let value = Arc::new(make()?);
        *weak = Arc::downgrade(&value);
        Ok(value)
    }

    /// Returns true if the value of a key is in use.
    pub fn has(&self, key: &K) -> bool {
        self.get(key).is_some()
    }

    /// Returns the value of a key, if it is in use.
    pub fn get(&self, key: &K) -> Option<Arc<V>> {
        let entries = self.entries.lock();
        let (_, slot) = entries.iter().find(|(other, _)| other == key)?;
        slot.try_lock()?.upgrade()
    }

    /// Removes keys whose values are no longer in use.
    pub fn forget_unused(&self) {
        let mut entries = self.entries.lock();
        remove_stale(&mut entries);
        entries.shrink_to_fit();
    }

    fn slot_of(&self, key: &K) -> Arc<ForkLock<Weak<V>>> {
        let mut entries = self.entries.lock();
        if let Some((_, slot)) = entries.iter().find(|(other, _)| other == key) {
            return slot.clone();
        }
        remove_stale(&mut entries);
        let slot = Arc::new(ForkLock::new(Weak::new()));
        entries.push((key.clone(), slot.clone()));
        slot
    }
}

/// A slot referenced only by this list has no maker and no waiter; without a value it is stale.
fn remove_stale<K, V>(entries: &mut Vec<Entry<K, V>>) {
    entries.retain(|(_, slot)| {
        let stale = || slot.try_lock().is_some_and(|weak| weak.strong_count() == 0);
        Arc::strong_count(slot) > 1 || !stale()
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn value_is_shared_while_referenced() {
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
        assert_eq!(values.entries.lock().len(), 1);
        let Ok(again) = values.get_or_make(&1, make(12));
        assert_eq!(*again, 12);
    }

    #[test]
    fn fork_recreates_unfinished_values_and_keeps_the_rest() {
        let values: SharedValues<u32, u32> = SharedValues::new();
        let make = |value: u32| move || Ok::<_, Infallible>(value);
        let Ok(held) = values.get_or_make(&1, make(10));
        values.slot_of(&2).hold_by_another_process();
        let Ok(found) = values.get_or_make(&1, make(11));
        let Ok(made) = values.get_or_make(&2, make(20));
        assert!(Arc::ptr_eq(&held, &found));
        assert_eq!(*made, 20);
        values.entries.hold_by_another_process();
        let Ok(anew) = values.get_or_make(&1, make(12));
        assert_eq!(*anew, 12, "a list that may be half changed is begun anew");
    }

    #[test]
    fn failed_values_are_retried() {
        let values: SharedValues<u32, u32> = SharedValues::new();
        assert_eq!(values.get_or_make(&1, || Err("no")), Err("no"));
        assert_eq!(values.get_or_make(&1, || Ok::<_, &str>(7)).map(|value| *value), Ok(7));
    }
}
