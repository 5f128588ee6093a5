//! The scene: plain, checked data that says what to model. Nothing here knows how.

mod types;

pub use types::*;
