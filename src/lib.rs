//! `impinge` simulates heat and stress in a surface that a hot, fast droplet hits.
//!
//! Solids are finite elements, droplets are smoothed particles, recorded drops or closed-form films. A scene (one TOML
//! file) describes bodies, loads and couplings; it runs from the command line, from Rust, or as an FMI 2.0 or 3.0
//! co-simulation unit. All quantities are in SI units, temperatures in kelvin.
//!
//! # The way of the data
//!
//! ```text
//! scene.toml → Scene (plain data, checked) → Model (immutable) + State (flat, clonable)
//!            → step(inputs) → State → variables → FMI | command line | files
//! ```
//!
//! Data flows in one direction. [`Model`](model::Model) holds everything known before time starts: meshes, modes,
//! factorisations. [`State`](model::State) holds everything that changes, so a clone of it is a saved run.
//! [`Cache`](model::Cache) memoises what follows from a state. Results are the same to the bit on any number of
//! threads.
//!
//! # Example
//!
//! A plate of alumina under a heat flux of 1 MW/m² follows the closed form of the heated slab (Carslaw and Jaeger 1959,
//! §3.8) within 0.01 K:
//!
//! ```
//! use impinge::closed_form::{Conductor, HeatedSlab};
//! use impinge::model::{Cache, Model};
//! use impinge::scene;
//! use impinge::variables::{Registry, Slot};
//!
//! let text = r#"
//!     name = "Plate"
//!     stop_time = 1e-3                                # s
//!     step = 1e-4                                     # s
//!     [body.plate]
//!     kind = "solid"
//!     shape = { box = [4e-3, 4e-3, 0.5e-3] }          # m
//!     initial_temperature = 293.15                    # K
//!     [body.plate.material]
//!     model = "thermoelastic"
//!     density = 3950.0                                # kg/m³
//!     specific_heat = 900.0                           # J/(kg K)
//!     conductivity = 10.0                             # W/(m K)
//!     [body.plate.faces]
//!     top = { flux = 0.0 }                            # W/m²; other faces are insulated
//!     [[probe]]
//!     name = "surface"
//!     in = "plate"
//!     at = [0.0, 0.0, 0.0]
//!     gives = ["temperature"]
//! "#;
//! let scene = scene::parse(text, "plate.toml").unwrap();
//! let model = Model::build(&scene, 1).unwrap(); // on one thread
//! let (mut state, mut cache) = (model.initial_state(), Cache::default());
//!
//! // Variables have names; the registry maps them to the state's inputs and to outputs.
//! let registry = Registry::of(&scene);
//! let slot = |name: &str| &registry.variables[registry.find(name).unwrap()].slot;
//! let Slot::Input(flux) = *slot("plate.top.flux") else { unreachable!() };
//! let Slot::Output(surface) = slot("surface.temperature") else { unreachable!() };
//!
//! state.inputs[flux] = 1e6;
//! for _ in 0..10 {
//!     model.step(&mut state, &mut cache, 1e-4).unwrap();
//! }
//! let rise = model.output(&state, &mut cache, surface).unwrap() - 293.15;
//!
//! let body = Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 };
//! let slab = HeatedSlab { body, flux: 1e6, thickness: 0.5e-3 };
//! assert!((rise - slab.rise_with_insulated_back(0.0, 1e-3)).abs() < 0.01);
//! ```
//!
//! The programs `impinge` (`check`, `run`, `schema`) and `build-fmu` are separate packages of the workspace.
//!
//! # Modules
//!
//! A module uses only the modules above it in this table; a test enforces the order.
//!
//! | module | contents |
//! |---|---|
//! | [`runtime`] | Resources of the process: threads, parallel loops, memory, computing budgets, fork-safe locks. |
//! | [`math`] | Numerics without physics: quadrature, sparse Cholesky, Krylov solvers, exponential integrators. |
//! | [`quantity`] | Physical quantities with their SI and display units. |
//! | [`limits`] | Bounds, plausible ranges and words of refusals for the numbers of scenes. |
//! | [`warning`] | The table of warnings: id, occasion, message and remedy of each rule. |
//! | [`channel`] | Amounts that loads carry through a face: heat flux, pressure, shear. |
//! | [`substances`] | Library of substances: constants of solids and fluids with their sources. |
//! | [`laws`] | Constitutive laws of solids, fluids and heat, each with its keys, limits and parameters. |
//! | [`kernel`] | Smoothing kernels of particle methods. |
//! | [`state`] | Named fields of the flat vectors that hold the states of bodies. |
//! | [`space`] | Functions of nodes and their gradients at points, as sparse rows: finite elements, reproducing kernels. |
//! | [`scene`] | Types, parser, checks and JSON schema of `scene.toml`. |
//! | [`advice`] | Warnings about plausible mistakes in a scene, before it runs. |
//! | [`inputs`] | Layout of the inputs, and their polynomials in time over a step. |
//! | [`port`] | Exchange between bodies: cells of faces, fluxes through them, responses of surfaces. |
//! | [`method`] | Numerical methods: finite elements, enthalpy, plasticity, large strain, particles, recorded drops, reduction. |
//! | [`coupling`] | Conservative transfer of loads between faces, cells and rings. |
//! | [`body`] | The bodies of a scene behind one trait: solids, droplets, reservoirs. |
//! | [`variables`] | The registry of a unit's variables: names, units, bounds, start values. |
//! | [`model`] | Assembles bodies, steps them in turn, chooses meshes for a tolerance, reads outputs. |
//! | [`output`] | ParaView series and CSV tables. |
//! | [`fmi`] | The C functions of FMI 2.0 and 3.0, and the model descriptions. |
//!
//! `closed_form` is a package below the library: the closed-form solutions that tests compare with.
//!
//! # Features
//!
//! `verification` enables the slow accuracy studies of `make verify`; the library itself has no optional parts.
//!
//! # Further reading
//!
//! - `docs/scene.md` is the reference of all keys of a scene, and `docs/scene.schema.json` their JSON schema.
//! - `docs/theory/` has the equations, sources and measured errors, one page per method.
//! - `ARCHITECTURE.md` has the invariants, each with its test, and the files that an extension touches.

// Blank lines keep the order, which is the architecture.
#![allow(rustdoc::broken_intra_doc_links)] // Units are in brackets: [K], [Pa].
#![allow(rustdoc::private_intra_doc_links)] // These resolve with `--document-private-items`.

// Closed forms for tests, and the few that replayed films use.
pub use closed_form;

pub mod runtime;

pub mod math;

pub mod quantity;

pub mod limits;

pub mod warning;

pub mod channel;

pub mod substances;

pub mod laws;

pub mod kernel;

pub mod state;

pub mod space;

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
