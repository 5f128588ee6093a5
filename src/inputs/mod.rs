//! The inputs of a scene: their places in a state, and their common path over a step.

mod layout;
mod path;

pub use layout::{FaceInput, FaceInputKind, InputLayout, LoadInputs};
pub use path::{HIGHEST_INPUT_DERIVATIVE, InputPath};
