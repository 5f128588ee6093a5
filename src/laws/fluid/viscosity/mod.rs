//! Constitutive laws of viscosity: the shear stress τ of a fluid over its shear rate γ̇, one law per file.
//!
//! The rate is `γ̇ = √(2 D:D)` [1/s] of the symmetric velocity gradient D, and the deviatoric stress is `2 µ(γ̇) D`
//! with the secant viscosity `µ = τ/γ̇`. A law has a yield stress, below which fluid at rest stays at rest, and a
//! viscous part, which may change with temperature by an Arrhenius factor.
//!
//! To add a law, write its file with a struct of its keys that implements [`Part`] and [`ShearLaw`], and add it to the
//! list of [`FluidLaw`] below. Its keys, limits and parameters follow from these.

mod arrhenius;
mod bingham;
mod carreau_yasuda;
mod flow_curve;
mod forms;
mod herschel_bulkley;
mod newtonian;
mod over_temperature;
mod power;
mod shear_law;

pub use arrhenius::Arrhenius;
pub use bingham::Bingham;
pub use carreau_yasuda::CarreauYasuda;
pub use flow_curve::FlowCurve;
pub use forms::{Rheology, Viscosity};
pub use herschel_bulkley::HerschelBulkley;
pub use newtonian::Newtonian;
pub use power::Power;
pub use shear_law::{Shear, ShearLaw};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::laws::{MaterialConstant, Part, PartVisitor};
use crate::limits::tag;

macro_rules! fluid_laws {
    ($($(#[doc = $words:literal])+ $law:ident = $name:literal),+ $(,)?) => {
        /// A law of viscosity with its constants as the scene names them.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "law")]
        #[schemars(transform = tag("law", "Law of viscosity"))]
        pub enum FluidLaw {
            $($(#[doc = $words])+ #[serde(rename = $name)] $law($law)),+
        }

        impl FluidLaw {
            /// Values of the key `law`.
            pub const NAMES: &[&str] = &[$($name),+];

            /// Visits the type of the keys of the law with this name.
            pub fn visit_keys(name: &str, visitor: &mut impl PartVisitor) {
                match name {
                    $($name => visitor.part::<$law>(),)+
                    _ => {}
                }
            }

            /// The constants that units offer as parameters.
            pub fn parameters(&self) -> &'static [MaterialConstant] {
                match self { $(Self::$law(_) => $law::parameters()),+ }
            }

            /// The constant of a key, for modification.
            pub fn number(&mut self, key: &str) -> Option<&mut f64> {
                match self { $(Self::$law(law) => law.number(key)),+ }
            }
        }

        impl ShearLaw for FluidLaw {
            #[inline]
            fn yield_stress(&self) -> f64 {
                match self { $(Self::$law(law) => law.yield_stress()),+ }
            }

            #[inline]
            fn viscous(&self, rate: f64) -> Shear {
                match self { $(Self::$law(law) => law.viscous(rate)),+ }
            }

            fn is_newtonian(&self) -> bool {
                match self { $(Self::$law(law) => law.is_newtonian()),+ }
            }

            fn thinnest_rate(&self, factor: f64) -> Option<f64> {
                match self { $(Self::$law(law) => law.thinnest_rate(factor)),+ }
            }
        }
    };
}

fluid_laws! {
    /// Stress proportional to the rate.
    Newtonian = "newtonian",
    /// Stress as a power of the rate (Ostwald and de Waele).
    Power = "power",
    /// Stress beyond a yield stress proportional to the rate.
    Bingham = "bingham",
    /// Stress beyond a yield stress as a power of the rate.
    HerschelBulkley = "herschel_bulkley",
    /// Viscosity between two plateaus (Carreau and Yasuda).
    CarreauYasuda = "carreau_yasuda",
}
