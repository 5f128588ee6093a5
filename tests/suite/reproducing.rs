//! Reproducing-kernel discretisations: what they reproduce, and what their integration keeps.

#[allow(dead_code)]
#[path = "../reproducing/linear.rs"]
mod linear;
#[path = "../reproducing/modes.rs"]
mod modes;
#[path = "../reproducing/patch.rs"]
mod patch;
#[path = "../reproducing/reproduction.rs"]
mod reproduction;
