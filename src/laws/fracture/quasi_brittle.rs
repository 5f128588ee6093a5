//! Scene keys of quasi-brittle materials.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::softening::SofteningLaw;
use crate::limits::{plausible, positive, within};

/// A quasi-brittle material: elastic up to its strength, then it softens.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    deny_unknown_fields,
    expecting = "a table, `{ substance = \"concrete\", softening = { … } }`"
)]
pub struct QuasiBrittle {
    /// Density ρ [kg/m³].
    #[schemars(transform = positive("kg/m³", "the density").plausible(&plausible::DENSITY))]
    pub density: f64,
    /// Young's modulus E [Pa].
    #[schemars(transform = positive("Pa", "Young's modulus").plausible(&plausible::YOUNG))]
    pub young: f64,
    /// Poisson's ratio ν [1]; links bend only up to a third.
    #[schemars(transform = within(-1.0 + LEAST_ABOVE, THIRD, "1", "")
        .low("Poisson's ratio must stay above minus one", ALLOWED)
        .high("above a third links would need a negative stiffness in bending", ALLOWED))]
    pub poisson: f64,
    /// Law of softening of links.
    pub softening: SofteningKeys,
}

/// Largest ratio of a lattice in plane stress, and the distance of the smallest from −1.
const THIRD: f64 = 0.333_333_333_333_333_3;
const LEAST_ABOVE: f64 = 1e-9;
const ALLOWED: &str = "-0.999999999 to 0.3333333333333333";

/// Softening of links: bilinear, over stretches as printed by Asadollahi (2014), or over openings, a cohesive law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    deny_unknown_fields,
    expecting = "a table, `{ model = \"openings\", strength = f, openings = [w2, w3], share = a }`"
)]
pub struct SofteningKeys {
    /// Measure over which the law softens.
    pub model: SofteningModel,
    /// Tensile strength f_t of links [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("Pa", "the strength")
        .plausible(&plausible::TENSILE_STRENGTH)
        .condition("of `openings`"))]
    pub strength: Option<f64>,
    /// Openings at the knee, w₂, and without force, w₃, beyond the elongation at the strength [m]. A crack takes 0.8 to
    /// 1.4 times the energy below this law, by the arrangement, and as much of that which links store up to their
    /// strength; `check --verbose` says how much.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("m", "the opening of a link")
        .plausible(&plausible::OPENING)
        .condition("of `openings`; ascending"))]
    pub openings: Option<[f64; 2]>,
    /// Stretch S_t at the strength [1].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = within(1e-9, 0.1, "1", "the stretch at the strength").condition("of `stretches`"))]
    pub onset: Option<f64>,
    /// Stretches at the knee, α₂, and without force, α₃, over S_t [1].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = within(1.0, 1e6, "1", "a stretch over that at the strength")
        .low_open()
        .condition("of `stretches`; ascending"))]
    pub stretches: Option<[f64; 2]>,
    /// Force at the knee over the largest, α₁ [1].
    #[schemars(transform = within(0.0, 1.0, "1", "").open().says(
        "the force falls from the strength to the knee and further to zero",
        "above 0, below 1",
    ))]
    pub share: f64,
    /// Share β of bending in the stretch that damages [1].
    #[serde(default = "usual_bending")]
    #[schemars(transform = within(0.0, 10.0, "1", "the share of bending"))]
    pub bending: f64,
}

/// Quantity over which links soften.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SofteningModel {
    /// The opening: the energy of a crack is the same for every spacing at which links store little up to their
    /// strength.
    Openings,
    /// The stretch: the energy of a crack grows with the spacing, to which constants have to be fitted.
    Stretches,
}

fn usual_bending() -> f64 {
    0.1
}

impl SofteningKeys {
    /// The law, if the keys of its model are there.
    pub fn law(&self) -> Option<SofteningLaw> {
        let share = self.share;
        match self.model {
            SofteningModel::Openings => Some(SofteningLaw::Openings {
                strength: self.strength?,
                ends: self.openings?,
                share,
            }),
            SofteningModel::Stretches => {
                Some(SofteningLaw::Stretches { onset: self.onset?, ends: self.stretches?, share })
            }
        }
    }
}
