//! The inputs of a scene: their places in a state, their common path over a step, and the motion of a nozzle that
//! follows from them.

mod layout;
mod motion;
mod path;
mod trend;

pub use layout::{FaceInput, FaceInputKind, InputLayout, LoadInputs};
pub use motion::Motion;
pub use path::{HIGHEST_INPUT_DERIVATIVE, InputPath};
pub use trend::Trend;
