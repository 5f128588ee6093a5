//! The step over which points respond.

/// What acts on all points of a body over a step beside its displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Time in which the body relaxes, the reduced one where the temperature changes its pace [s].
    pub time: f64,
    /// Thermal stretch ϑ at the end.
    pub stretch: f64,
}

impl Course {
    /// No time at the temperature without stress.
    pub const NONE: Self = Self { time: 0.0, stretch: 1.0 };

    /// A duration [s] at the temperature without stress.
    pub fn of(time: f64) -> Self {
        Self { time, stretch: 1.0 }
    }
}
