//! Events of a body.

/// A body with events: moments after which it is of another kind, such as that of its first crack.
pub trait Events {
    /// Returns true if an event lies between two states of a run.
    fn event_between(&self, before: &[f64], after: &[f64]) -> bool;
}
