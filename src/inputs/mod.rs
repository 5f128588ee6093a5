//! The inputs of a scene: where each stands in a state, and the path that all follow over a step.

mod layout;
mod path;

pub use layout::{FaceInput, FaceInputKind, InputLayout, LoadInputs};
pub use path::{HIGHEST_INPUT_DERIVATIVE, InputPath};
