//! Accuracy against closed forms, with observed orders of convergence.
//!
//! `make verify` runs this and prints the tables that README.md here keeps.

#[path = "../common/capillary.rs"]
#[allow(dead_code)]
mod capillary;
#[path = "../common/classical_flows.rs"]
#[allow(dead_code)]
mod classical_flows;
#[path = "../common/mod.rs"]
#[allow(dead_code)]
mod common;
mod concrete;
mod conduction;
mod contact;
mod cracks;
mod cracks_in_space;
#[path = "../common/edge_crack.rs"]
mod edge_crack;
mod elasticity;
#[path = "../common/falling_drop.rs"]
#[allow(dead_code)]
mod falling_drop;
mod flows;
mod fracture_mechanics;
mod heat;
mod kinematic;
mod large_strain;
mod lattice;
mod particles;
mod quench;
#[path = "../common/random_scenes.rs"]
mod random_scenes;
mod reproducing;
mod spread;
mod springback;
mod strand_particles;
mod study;
mod tension;
mod thermal_stress;
#[path = "../common/thick_flows.rs"]
#[allow(dead_code)]
mod thick_flows;
mod time;
mod tolerance;
mod viscous;
