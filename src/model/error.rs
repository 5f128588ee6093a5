//! Errors of models.

use crate::body::BodyError;
use crate::limits::{Bounds, number};
use crate::runtime::address_space::TooLittle;
use crate::runtime::allowance::Halt;
use crate::scene::SceneError;

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A body refused a call.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A state does not fit the model.
    #[error("{0}")]
    State(String),
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A step length outside the limits of the arithmetic.
    #[error("step size {} s {requirement} (allowed: {bounds} s)", number(*step))]
    StepLength { step: f64, requirement: String, bounds: Bounds },
    /// A scene is too large for the machine.
    #[error(
        "this needs about {:.3e} MB of memory, most of it for `{body}` with its {size}; {} \
         {:.3e} MB (allowed: a scene that fits, such as with {remedy})",
        needed / 1e6,
        if *is_own { "`solver.memory` of the scene lets it have" } else { "this process can have" },
        available / 1e6
    )]
    Memory {
        needed: f64,
        available: f64,
        is_own: bool,
        body: String,
        size: String,
        remedy: &'static str,
    },
    /// A scene needs more address space than the process may have.
    #[error(
        "{space}, most of it for `{body}` with its {size} (allowed: a scene that fits, such as with {remedy}, or \
         more address space)"
    )]
    Space { space: TooLittle, body: String, size: String, remedy: &'static str },
}

impl ModelError {
    /// Returns why a step was ended, if it was.
    pub fn halt(&self) -> Option<&Halt> {
        match self {
            Self::Body(BodyError::Halted { halt, .. }) => Some(halt),
            _ => None,
        }
    }
}

impl From<TooLittle> for ModelError {
    fn from(space: TooLittle) -> Self {
        BodyError::from(space).into()
    }
}
