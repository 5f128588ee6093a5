//! Footprints of drops by their places, each computed once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::footprint::Footprint;

/// Largest number of footprints that are kept.
const MOST: usize = 512;

/// Footprints at the places where drops have landed of late.
#[derive(Default)]
pub struct Footprints {
    known: Mutex<HashMap<[u64; 2], Arc<Footprint>>>,
}

impl Footprints {
    /// Returns the footprint at a place, which `compute` gives where it is not known.
    pub fn at(&self, place: [f64; 2], compute: impl FnOnce() -> Footprint) -> Arc<Footprint> {
        let key = place.map(f64::to_bits);
        let lock = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&key) {
            return Arc::clone(known);
        }
        let found = Arc::new(compute());
        let mut known = lock();
        if known.len() >= MOST {
            known.clear();
        }
        known.insert(key, Arc::clone(&found));
        found
    }
}
