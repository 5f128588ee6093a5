//! Scene keys of cracks by gradient damage.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::damage::{Dissipation, GradientDamage};
use super::split::{Principal, Split, pressed_of};
use crate::laws::Thermoelastic;
use crate::limits::{length, plausible, positive, within};

/// Cracks that run where they find the most energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ model = \"at1\", strength = σ }`")]
pub struct Cracking {
    /// Model of damage.
    pub model: Dissipation,
    /// Strength under uniaxial tension [Pa], from which the length follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("Pa", "the strength")
        .plausible(&plausible::CRACK_STRENGTH)
        .otherwise("`length`"))]
    pub strength: Option<f64>,
    /// Length over which damage is spread on both sides of a crack [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("the length of damage")
        .plausible(&plausible::DAMAGE_LENGTH)
        .otherwise("from `strength`"))]
    pub length: Option<f64>,
    /// Energy of cracks per area G_c [J/m²].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("J/m²", "the energy of cracks")
        .plausible(&plausible::CRACK_ENERGY)
        .otherwise("from `toughness`"))]
    pub energy: Option<f64>,
    /// Part of the elastic energy that cracks release.
    #[serde(default)]
    pub split: Split,
    /// Strength under uniaxial compression [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("Pa", "the compressive strength")
        .condition("with `split = \"star_convex\"` of `at1`, and at least the tensile strength")
        .otherwise("from the split"))]
    pub compressive_strength: Option<f64>,
    /// Half the width of the range, over its middle, in which the energy of cracks is distributed evenly from element
    /// to element [1].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = within(0.0, 0.9, "1", "").says("scatter is a part of the energy", "0 to 0.9"))]
    pub scatter: f64,
    /// Number of the sample of that distribution.
    #[serde(default, skip_serializing_if = "is_first")]
    pub seed: u32,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_first(seed: &u32) -> bool {
    *seed == 0
}

impl Cracking {
    /// Returns the law of a material with these constants; `None` if energy, or length and strength, are missing.
    ///
    /// `G_c = K²/E'` where a toughness K is given, with `E' = E/(1 − ν²)`, or E in plane stress (G. R. Irwin 1957).
    pub fn law(
        &self,
        solid: &Thermoelastic,
        toughness: Option<f64>,
        is_plane_stress: bool,
    ) -> Option<GradientDamage> {
        let Thermoelastic { young, poisson, expansion } = *solid;
        let across = if is_plane_stress { 1.0 } else { 1.0 - poisson * poisson };
        let energy = self.energy.or(toughness.map(|k| across * k * k / young))?;
        let law = GradientDamage {
            elastic: Principal { young, poisson, is_plane_stress },
            expansion,
            split: self.split,
            pressed: 1.0,
            dissipation: self.model,
            energy,
            length: self.length.unwrap_or(1.0),
            scatter: self.scatter,
            seed: self.seed,
        };
        let law = match (self.length, self.strength) {
            (Some(_), _) => law,
            (None, Some(strength)) => GradientDamage { length: law.length_of(strength), ..law },
            (None, None) => return None,
        };
        let ratio = self.compressive_strength.map(|own| own / law.strength());
        let pressed = ratio.map_or(1.0, |ratio| pressed_of(poisson, ratio));
        Some(GradientDamage { pressed, ..law })
    }
}
