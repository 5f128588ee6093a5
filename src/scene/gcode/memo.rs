//! The route of a file, kept for the next who asks for it: a scene is asked a dozen times before it runs.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use crate::scene::Route;

/// The last route. Copies share it.
#[derive(Debug, Clone, Default)]
pub struct Memo(Arc<Mutex<Option<Kept>>>);

/// A route and a hash of what it was made of.
#[derive(Debug)]
struct Kept {
    key: u64,
    route: Route,
}

/// Scenes are equal whatever they remember.
impl PartialEq for Memo {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Memo {
    /// Returns the route of a text and of the numbers that count beside it; makes it if these are new.
    pub fn route<E>(
        &self,
        (text, numbers): (&str, &[f64]),
        make: impl FnOnce() -> Result<Route, E>,
    ) -> Result<Route, E> {
        let mut hasher = DefaultHasher::new();
        text.hash(&mut hasher);
        numbers.iter().for_each(|number| number.to_bits().hash(&mut hasher));
        let key = hasher.finish();
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(own) = kept().as_ref().filter(|own| own.key == key) {
            return Ok(own.route.clone());
        }
        let route = make()?;
        *kept() = Some(Kept { key, route: route.clone() });
        Ok(route)
    }
}
