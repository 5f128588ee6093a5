//! The step over which points respond.

use super::Deformable;

/// Time, thermal stretch and its rate at a point over a step, which act besides displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Time in which the body relaxes, the reduced one where the temperature changes its pace [s].
    pub time: f64,
    /// Thermal stretch ϑ at the end.
    pub stretch: f64,
    /// Its rate, whose power counts where a body has inertia [1/s].
    pub growth: f64,
}

impl Course {
    /// No time at the temperature without stress.
    pub const NONE: Self = Self { time: 0.0, stretch: 1.0, growth: 0.0 };

    /// A duration [s] at the temperature without stress.
    pub fn of(time: f64) -> Self {
        Self { time, ..Self::NONE }
    }
}

/// The steps of all points of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Courses {
    /// One for each layer, the temperature of which is uniform.
    OfLayers(Vec<Course>),
    /// One for each group of points.
    OfGroups(Vec<Course>),
}

impl Courses {
    /// The step of a group of points.
    pub fn at(&self, body: &Deformable, group: usize) -> Course {
        match self {
            Self::OfLayers(courses) => courses[body.layer_of_group[group]],
            Self::OfGroups(courses) => courses[group],
        }
    }
}
