//! Events of a body.

/// Moments after which a body is of another kind, such as that of its first crack; by default there are none.
pub trait Events {
    /// Returns true if the body may have events.
    fn has_events(&self) -> bool {
        false
    }

    /// Returns true if an event lies between two states of a run.
    fn event_between(&self, _before: &[f64], _after: &[f64]) -> bool {
        false
    }
}
