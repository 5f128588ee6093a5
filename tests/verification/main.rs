//! Accuracy against closed forms, with observed orders of convergence.
//!
//! `make verify` runs this and prints the tables that README.md here keeps.

#[path = "../common/mod.rs"]
#[allow(dead_code)]
mod common;
mod elasticity;
mod heat;
mod particles;
mod study;
mod thermal_stress;
mod time;
