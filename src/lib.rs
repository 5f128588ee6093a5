//! `impinge`: what a hot, fast droplet does to the surface it hits.
//!
//! Data flows one way: scene → checked plain data → immutable [`model::Model`] + flat
//! [`model::State`] → step → variables → FMI, command line or files. A module uses only the
//! modules listed above it here; a test holds that order.

// Blank lines keep the order, which is the architecture.
#![allow(rustdoc::broken_intra_doc_links)] // Units stand in brackets: [K], [Pa].

// Closed forms of tests, and the few that drops that are repeated follow.
pub use closed_form;

pub mod runtime;

pub mod math;

pub mod quantity;

pub mod limits;

pub mod warning;

pub mod channel;

pub mod material;

pub mod kernel;

pub mod state;

pub mod scene;

pub mod advice;

pub mod inputs;

pub mod port;

pub mod method;

pub mod coupling;

pub mod body;

pub mod variables;

pub mod model;

pub mod output;

pub mod fmi;
