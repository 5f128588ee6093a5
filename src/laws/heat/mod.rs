//! Laws of heat: conduction with constants that may depend on the temperature, melting, radiation.

mod conduction;
mod enthalpy;
mod melting;
mod plate;
mod radiation;

pub use conduction::{Conduction, ConductionError};
pub use enthalpy::{Enthalpy, EnthalpyPoint};
pub use melting::{Melting, MeltingError};
pub use plate::unevenness;
pub use radiation::{radiative_coefficient, radiative_flux, radiative_slope};
