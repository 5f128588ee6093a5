//! Closed-form solutions that tests, benches and examples verify the models against, one family a
//! file. SI units; stress is positive in tension; depth `z` is positive into the body.
//!
//! | family | solutions |
//! |---|---|
//! | [`half_space_flux`] | half space under uniform flux, flux on a disc, flux `C/√t` |
//! | [`half_space_surface`] | half space with sudden surface temperature, or sudden convection |
//! | [`gaussian_flux`] | half space under a Gaussian flux, at rest or moving |
//! | [`contact`] | two half spaces brought together |
//! | [`spreading_film`] | film of fluid that spreads over a wall |
//! | [`cooling_film`] | film whose lower face is brought to another temperature |
//! | [`drop_impact`] | drop that hits a wall: spread, wetted radius, force |
//! | [`freezing_impact`] | largest spread of a drop that freezes while it spreads (fitted) |
//! | [`swinging_drop`] | viscous drop that swings under surface tension |
//! | [`gravity_current`] | viscous fluid that spreads under its weight, plane or axisymmetric |
//! | [`viscous_decay`] | shear wave and vortices that viscosity brings to rest |
//! | [`viscous_filament`] | filament, sheet and disc of viscous fluid: drawn, retracting, squeezed |
//! | [`heated_couette`] | shear flow whose viscosity varies with the temperature |
//! | [`herschel_bulkley`] | law of fluids with a yield stress |
//! | [`yielding_channel`] | such a fluid between plates, and as a film on an incline |
//! | [`yielding_pipe`] | such a fluid in a pipe |
//! | [`ceasing_flow`] | Bingham fluid between plates that comes to rest in finite time (numerical) |
//! | [`slump`] | slump of a cylinder of a fluid with a yield stress |
//! | [`resting_paste`] | thin layers of such a fluid at rest: drop and line |
//! | [`slab`] | slab under flux, its back insulated, held or convective |
//! | [`composite_slab`] | slab of layers with contacts that resist, under flux or sudden temperature |
//! | [`convective_slab`] | slab that meets a fluid, its back insulated |
//! | [`dipped_plate`] | thin plate that sinks into a bath at constant speed |
//! | [`kirchhoff`] | half space and slab with a conductivity linear in the temperature |
//! | [`melting_front`] | half space that melts or freezes from its surface |
//! | [`freezing_contact`] | two half spaces brought together, one of which freezes |
//! | [`freezing_column`] | the same across a contact that resists (numerical) |
//! | [`radiating_lump`] | body of one temperature that radiates |
//! | [`shocked_half_space`] | half space with inertia whose surface is suddenly warm |
//! | [`constrained_layer`] | step heating of a laterally constrained surface |
//! | [`bonded_plate`] | bonded layers that expand differently: bimetals, films |
//! | [`bent_strip`] | strip of neo-Hookean layers that expand differently and bend by any angle (numerical) |
//! | [`free_plate`] | free plate, temperature through the thickness |
//! | [`heated_disc`] | thin free disc and long free cylinder, temperature along the radius |
//! | [`disc_pressure`] | half space under uniform pressure on a disc |
//! | [`thick_cylinder`] | thick cylinder under internal pressure, plane strain |
//! | [`yielding_cylinder`] | the same of incompressible material that yields |
//! | [`drawn_rubber`] | neo-Hookean bar, sheet and block that are drawn (numerical) |
//! | [`bouncing_ball`] | elastic ball that bounces off a rigid plane |
//! | [`bilinear`] | bar or film that yields, strained to and fro |
//! | [`relaxing_solid`] | bar, film and shear of a solid whose shear modulus relaxes |
//! | [`circular_plate`], [`square_plate`] | clamped plates under uniform pressure |
//! | [`cantilever`] | beam under an end load, with shear |
//! | [`brittle_failure`] | risk of failure by flaws: bending, thermal shock |
//! | [`edge_crack`] | stress intensity of edge and penny-shaped cracks: uniform stress, thermal shock |
//! | [`gradient_damage`] | bars with gradient damage, the field around the tip of a crack |
//!
//! [`medium`] holds the constants they share, [`fitted_range`] the ranges that fitted laws state, [`special`] the
//! special functions, [`quadrature`] the integrals that no closed form is known for, and [`tridiagonal`] the
//! equations of numerical oracles.

pub mod bent_strip;
pub mod bilinear;
pub mod bonded_plate;
pub mod bouncing_ball;
pub mod brittle_failure;
pub mod cantilever;
pub mod ceasing_flow;
pub mod circular_plate;
pub mod composite_slab;
pub mod constrained_layer;
pub mod contact;
pub mod convective_slab;
pub mod cooling_film;
pub mod dipped_plate;
pub mod disc_pressure;
pub mod drawn_rubber;
pub mod drop_impact;
pub mod edge_crack;
pub mod fitted_range;
pub mod free_plate;
pub mod freezing_column;
pub mod freezing_contact;
pub mod freezing_impact;
pub mod gaussian_flux;
pub mod gradient_damage;
pub mod gravity_current;
pub mod half_space_flux;
pub mod half_space_surface;
pub mod heated_couette;
pub mod heated_disc;
pub mod herschel_bulkley;
pub mod kirchhoff;
pub mod medium;
pub mod melting_front;
pub mod quadrature;
pub mod radiating_lump;
pub mod relaxing_solid;
pub mod resistive_contact;
pub mod resting_paste;
pub mod shocked_half_space;
pub mod slab;
pub mod slump;
pub mod special;
pub mod spreading_film;
pub mod square_plate;
pub mod swinging_drop;
pub mod thick_cylinder;
pub mod tridiagonal;
pub mod viscous_decay;
pub mod viscous_filament;
pub mod yielding_channel;
pub mod yielding_cylinder;
pub mod yielding_pipe;

#[cfg(test)]
mod checks;

pub use bent_strip::{BentLayer, BentStrip};
pub use bilinear::Bilinear;
pub use bonded_plate::{BondedLayer, BondedPlate};
pub use bouncing_ball::ElasticBall;
pub use cantilever::Cantilever;
pub use ceasing_flow::{Bingham, CeasingFlow};
pub use circular_plate::CircularPlate;
pub use composite_slab::{Back, CompositeSlab, SlabLayer};
pub use contact::Contact;
pub use convective_slab::ConvectiveSlab;
pub use disc_pressure::DiscPressure;
pub use drawn_rubber::{Rubber, Sides};
pub use drop_impact::DropImpact;
pub use fitted_range::FittedRange;
pub use free_plate::FreePlate;
pub use freezing_column::{FreezingColumn, Frozen};
pub use freezing_contact::FreezingContact;
pub use freezing_impact::FreezingImpact;
pub use gaussian_flux::GaussianFlux;
pub use gravity_current::{GravityCurrent, Spreading};
pub use half_space_flux::{DecayingFlux, DiscFlux, UniformFlux};
pub use half_space_surface::{ConvectiveSurface, SuddenSurface};
pub use heated_couette::HeatedCouette;
pub use heated_disc::{LongCylinder, ThinDisc};
pub use herschel_bulkley::HerschelBulkley;
pub use kirchhoff::LinearConductivity;
pub use medium::{Conductor, Elastic};
pub use melting_front::MeltingFront;
pub use radiating_lump::RadiatingLump;
pub use resistive_contact::ResistiveContact;
pub use resting_paste::RestingPaste;
pub use shocked_half_space::ShockedHalfSpace;
pub use slab::HeatedSlab;
pub use slump::Slump;
pub use spreading_film::flux_over_rest;
pub use square_plate::SquarePlate;
pub use swinging_drop::SwingingDrop;
pub use thick_cylinder::ThickCylinder;
pub use viscous_decay::{ShearWave, TaylorGreen};
pub use viscous_filament::{SqueezedDisc, ViscousFilament, ViscousSheet};
pub use yielding_channel::{YieldingChannel, YieldingFilm};
pub use yielding_cylinder::YieldingCylinder;
pub use yielding_pipe::YieldingPipe;
