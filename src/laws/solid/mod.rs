//! Laws of deformation of solids, one per file.
//!
//! To add one, write its file with a struct of its keys made of [`Part`]s by [`law_of_parts!`], and a [`Deformation`]
//! that turns them into a [`Law`]. Then add it to the list of [`SolidLaw`] below.

mod admissible;
mod concrete;
mod elasticity;
mod elastoplastic;
pub mod large_strain;
mod law;
mod neo_hookean;
mod overstress;
mod plastic_history;
mod saturating;
mod relaxation;
mod shift;
pub mod stress;
pub mod stress_rate;
mod thermoelastic;
mod viscoelastic;
mod viscoplastic;
mod yielding;

pub use admissible::admissible;
pub use concrete::{ConcreteLaw, Kcc};
pub use elasticity::Elasticity;
pub use elastoplastic::{
    Elastoplastic, ElastoplasticLaw, Growth, OfTemperature, PointConstants, PointTangent, constant,
};
pub use law::{Deformation, Elastic, FlowLaw, Keys, Law, Need, Response};
pub use neo_hookean::NeoHookeanLaw;
pub use overstress::{Overstress, Parted};
pub use plastic_history::PlasticHistory;
pub use relaxation::{Branch, Present, Relaxation, Relaxed};
pub use saturating::{Saturating, Saturation};
pub use shift::Shift;
pub use thermoelastic::{Thermoelastic, ThermoelasticLaw};
pub use viscoelastic::{Relaxing, Viscoelastic, ViscoelasticLaw};
pub use viscoplastic::{Creep, Flow, Viscoplastic, ViscoplasticLaw};
pub use yielding::Yielding;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::part::{Part, PartVisitor};
use crate::limits::tag;

/// Declares a law's keys as the union of parts.
macro_rules! law_of_parts {
    ($(#[$attribute:meta])* $name:ident { $($part:ident: $kind:ty),+ $(,)? }) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[schemars(inline)]
        pub struct $name { $(#[serde(flatten)] pub $part: $kind),+ }

        impl $name {
            /// Visits the type of each part, in the order of the keys.
            pub fn visit_parts(visitor: &mut impl crate::laws::part::PartVisitor) {
                $(visitor.part::<$kind>();)+
            }
        }

        impl crate::laws::solid::law::Keys for $name {
            fn parts(&self) -> Vec<&dyn crate::laws::part::Part> {
                vec![$(&self.$part),+]
            }

            fn parts_mut(&mut self) -> Vec<&mut dyn crate::laws::part::Part> {
                vec![$(&mut self.$part),+]
            }
        }
    };
}
use law_of_parts;

macro_rules! solid_laws {
    ($($(#[doc = $words:literal])+ $law:ident($keys:ty) = $model:literal),+ $(,)?) => {
        /// The law by which a solid deforms, with its constants as the scene names them.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "model")]
        #[schemars(transform = tag("model", "Constitutive law"))]
        pub enum SolidLaw {
            $($(#[doc = $words])+ #[serde(rename = $model)] $law($keys)),+
        }

        impl SolidLaw {
            /// Values of the key `model`.
            pub const MODELS: &[&str] = &[$($model),+];

            /// Visits the types of the parts that the table of a model consists of, except those of heat.
            pub fn visit_parts(model: &str, visitor: &mut impl PartVisitor) {
                match model {
                    $($model => <$keys>::visit_parts(visitor),)+
                    _ => {}
                }
            }

            /// Returns the law behind the interface shared by all laws.
            pub fn deformation(&self) -> &dyn Deformation {
                match self { $(Self::$law(law) => law),+ }
            }

            /// Returns the law's constants for modification.
            pub fn parts_mut(&mut self) -> Vec<&mut dyn Part> {
                match self { $(Self::$law(law) => law::Keys::parts_mut(law)),+ }
            }
        }
    };
}

solid_laws! {
    /// Isotropic thermo-elasticity.
    Thermoelastic(ThermoelasticLaw) = "thermoelastic",
    /// The same, but the body yields: J₂ plasticity with linear hardening.
    Elastoplastic(ElastoplasticLaw) = "elastoplastic",
    /// The same, but flow takes time: creep, or viscoplasticity beyond a yield stress.
    Viscoplastic(ViscoplasticLaw) = "viscoplastic",
    /// Thermo-elasticity whose moduli relax: the generalised Maxwell model.
    Viscoelastic(ViscoelasticLaw) = "viscoelastic",
    /// Rubber and gels of large strain: compressible neo-Hooke.
    NeoHookean(NeoHookeanLaw) = "neo_hookean",
    /// Concrete that cracks, crushes and dilates: the law of Karagozian & Case.
    Concrete(ConcreteLaw) = "concrete",
}
