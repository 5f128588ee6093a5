//! Constitutive laws, one per file. Each owns its scene keys with their limits, its history and its response.
//!
//! A [`Material`] conducts heat by [`heat::Conduction`], deforms by one of [`solid::SolidLaw`] and breaks as its
//! [`fracture::Brittleness`] says; these types are also the parser, the schema and the documentation of a scene's
//! `material` table.

mod constants;
pub mod fluid;
pub mod fracture;
pub mod heat;
mod material;
mod parameters;
mod part;
mod property;
pub mod solid;

pub use constants::Constants;
pub use fluid::{Evaporation, Fluid, Freezing, Frozen, SphericalCap, Viscosity};
pub use fracture::{Brittleness, Extent, FlawStatistics, Weibull};
pub use heat::{
    Conduction, ConductionError, Enthalpy, EnthalpyPoint, Melting, MeltingError,
    radiative_coefficient, radiative_flux, radiative_slope,
};
pub use material::Material;
pub use parameters::{AtStart, MaterialConstant};
pub use part::{Part, PartVisitor};
pub use property::{Curve, Property, PropertyError, Table};
pub use solid::{
    Creep, Elastic, Elastoplastic, FlowLaw, Growth, Law, OfTemperature, Overstress, Parted,
    PlasticHistory, PointConstants, PointTangent, Relaxation, Response, SolidLaw, Thermoelastic,
    Viscoelastic, Viscoplastic, admissible, constant, stress, stress_rate,
};

/// Molar gas constant R [J/(mol K)], exact since the SI of 2019.
const GAS_CONSTANT: f64 = 8.314_462_618_153_24;
