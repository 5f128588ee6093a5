//! The inputs of a scene: where each stands in a state, and the course that all take over a step.

mod layout;
mod path;

pub use layout::{FaceInput, FaceInputKind, InputLayout, LoadInputs};
pub use path::{HIGHEST_INPUT_DERIVATIVE, InputPath};
