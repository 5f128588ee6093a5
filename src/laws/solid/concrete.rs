//! Concrete: the law of Karagozian & Case, of solids of large strain.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::large_strain::concrete::{DamageFunction, Surfaces, energy};
use super::large_strain::{Concrete, Deviator, LargeStrainLaw};
use super::law::{Deformation, FlowLaw, Need};
use super::neo_hookean::moduli;
use super::{Elasticity, SolidLaw, law_of_parts};
use crate::laws::Part;
use crate::limits::{length, not_negative, plausible, positive, within};

law_of_parts! {
    /// Keys of concrete.
    ConcreteLaw { elasticity: Elasticity, crushing: Crushing }
}

/// Constants of concrete beyond elasticity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Crushing {
    /// Constants of strength and softening.
    pub kcc: Kcc,
}

impl Part for Crushing {}

/// Constants of the law of Karagozian & Case; none follows from others but by the formulas named here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Kcc {
    /// Strength f_t in uniaxial tension [Pa].
    #[schemars(transform = positive("Pa", "the strength").plausible(&plausible::TENSILE_STRENGTH))]
    pub tensile_strength: f64,
    /// Strength Δσ_m = a0 + p/(a1 + a2 p) over the pressure p in triaxial compression. The strength in uniaxial
    /// compression f_c follows from it: Δσ_m(f_c/3) = f_c.
    pub strength: SurfaceKeys,
    /// Surface of yielding Δσ_y, of the same form; uniaxial compression yields below f_c.
    pub yielding: SurfaceKeys,
    /// Strength p/(a1 + a2 p) that remains.
    pub residual: ResidualKeys,
    /// Damage function η(λ).
    pub damage: DamageKeys,
    /// Exponent b₁ of damage in compression, dλ = dε̄ᵖ/(1 + p/f_t)^b₁ [1].
    #[schemars(transform = within(-20.0, 20.0, "1", "the exponent of damage"))]
    pub compression_exponent: f64,
    /// The same in tension, b₂ [1].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = within(-energy::MOST, energy::MOST, "1", "the exponent of damage")
        .otherwise("from `fracture_energy`"))]
    pub tension_exponent: Option<f64>,
    /// Damage b₃ per volume that opens where tension from all sides is at its limit, dλ = b₃ dε_v [1].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = not_negative("1", "the damage by opening").otherwise("from `fracture_energy`"))]
    pub opening_damage: Option<f64>,
    /// Energy of a crack in tension per area beyond the peak, instead of b₂ and b₃ [J/m²].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("J/m²", "the energy of cracks")
        .plausible(&plausible::CRACK_ENERGY)
        .otherwise("`tension_exponent` and `opening_damage`"))]
    pub fracture_energy: Option<f64>,
    /// Width of the band in which a crack localises, with `fracture_energy`: that of the second smoothing if there is
    /// one [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("the width of a crack's band")
        .plausible(&plausible::EXTENT)
        .otherwise("none: b₂ and b₃ are set"))]
    pub crack_band: Option<f64>,
    /// Growth of the volume over that of flow along the normal, ω [1].
    #[schemars(transform = within(0.0, 1.0, "1", "the dilatancy"))]
    pub dilatancy: f64,
    /// Pressure over plastic compaction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "none: pressure is elastic"))]
    pub compaction: Option<CompactionKeys>,
    /// Damage from which on a node counts as broken and belongs to no fragment [1].
    #[serde(default = "usual_broken")]
    #[schemars(transform = within(0.0, 1.0, "1", "the damage of broken nodes").low_open())]
    pub broken: f64,
    /// Strength in equal biaxial compression over f_c [1].
    #[serde(default = "usual_biaxial")]
    #[schemars(transform = within(1.0, 2.0, "1", "the biaxial strength").low_open())]
    pub biaxial: f64,
    /// Strengths in triaxial extension over those in compression at high pressure.
    #[serde(default)]
    pub meridians: MeridianKeys,
}

/// A strength a0 + p/(a1 + a2 p).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceKeys {
    /// Strength without pressure [Pa].
    #[schemars(transform = positive("Pa", "the strength without pressure"))]
    pub a0: f64,
    /// Pressure over the growth of the strength at low pressure [1].
    #[schemars(transform = positive("1", "the constant a1"))]
    pub a1: f64,
    /// One over the growth of the strength at high pressure [1/Pa].
    #[schemars(transform = positive("1/Pa", "the constant a2"))]
    pub a2: f64,
}

impl SurfaceKeys {
    fn numbers(&self) -> [f64; 3] {
        [self.a0, self.a1, self.a2]
    }
}

/// A strength p/(a1 + a2 p).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResidualKeys {
    /// Pressure over the strength at low pressure [1].
    #[schemars(transform = positive("1", "the constant a1"))]
    pub a1: f64,
    /// One over the strength at high pressure [1/Pa].
    #[schemars(transform = not_negative("1/Pa", "the constant a2"))]
    pub a2: f64,
}

/// η over λ, linear between its points: from 0 at 0 to 1 at the peak and to 0 at the end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DamageKeys {
    /// λ [1], ascending from 0.
    #[schemars(transform = not_negative("1", "λ").condition("ascending from 0"))]
    pub lambda: Vec<f64>,
    /// η at each λ [1].
    #[schemars(transform = within(0.0, 1.0, "1", "η").condition("ascending from 0 to 1, descending to 0"))]
    pub eta: Vec<f64>,
}

/// Pressure that compacts, over the plastic change of volume; linear between its points and beyond the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompactionKeys {
    /// Plastic logarithmic change of volume [1], ascending from 0.
    #[schemars(transform = within(0.0, 1.0, "1", "the compaction").condition("ascending from 0"))]
    pub strain: Vec<f64>,
    /// Pressure at each [Pa], ascending.
    #[schemars(transform = positive("Pa", "the pressure of compaction").condition("ascending"))]
    pub pressure: Vec<f64>,
}

/// Strengths in triaxial extension over those in compression, linear over the pressure from that of biaxial compression
/// on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeridianKeys {
    /// Pressures over f_c [1], ascending.
    #[schemars(transform = positive("1", "the pressure over f_c").condition("ascending"))]
    pub pressure: Vec<f64>,
    /// Ratio at each [1].
    #[schemars(transform = within(0.5, 1.0, "1", "the ratio of strengths"))]
    pub ratio: Vec<f64>,
}

/// Those of L. J. Malvar et al. 1997, doi 10.1016/S0734-743X(97)00023-7.
impl Default for MeridianKeys {
    fn default() -> Self {
        Self { pressure: vec![3.0, 8.45], ratio: vec![0.753, 1.0] }
    }
}

/// H. Kupfer, H. K. Hilsdorf & H. Rüsch 1969.
fn usual_biaxial() -> f64 {
    1.15
}

fn usual_broken() -> f64 {
    0.95
}

/// A reason why constants make no law, with what is allowed.
pub type Obstacle = (&'static str, String);

impl Kcc {
    /// Returns the law for a Young's and a bulk modulus [Pa], or the reason why there is none.
    pub fn law(&self, young: f64, bulk: f64) -> Result<Concrete, Obstacle> {
        let meridians = pairs(&self.meridians.pressure, &self.meridians.ratio)?;
        let coefficients = [self.strength.numbers(), self.yielding.numbers()];
        let residual = [self.residual.a1, self.residual.a2];
        let tensile = self.tensile_strength;
        let surfaces = Surfaces::new(coefficients, residual, tensile, self.biaxial, &meridians)
            .ok_or((
                "uniaxial compression does not yield below its strength, or sections across the axis are not convex",
                "`yielding` below `strength`, `tensile_strength` far below both; `pressure` of `meridians` ascending from that of `biaxial`, ratios from 0.5 to 1"
                    .to_owned(),
            ))?;
        let points = pairs(&self.damage.lambda, &self.damage.eta)?;
        let function = DamageFunction::new(&points).ok_or((
            "η rises from 0 at λ = 0 to 1 and falls to 0",
            "as many `eta` as `lambda`, 0 to 1 ascending and 1 to 0 descending".to_owned(),
        ))?;
        let compaction = match &self.compaction {
            Some(table) => pairs(&table.strain, &table.pressure)?,
            None => Vec::new(),
        };
        let ascend = |pair: &[[f64; 2]]| pair[0][0] < pair[1][0] && pair[0][1] < pair[1][1];
        if compaction.first().is_some_and(|first| first[0] != 0.0)
            || !compaction.windows(2).all(ascend)
        {
            let allowed = "`strain` ascending from 0, `pressure` ascending".to_owned();
            return Err(("compaction needs more and more pressure", allowed));
        }
        let (tension, opening) = self.softening(&function)?;
        let law = Concrete {
            surfaces,
            function,
            exponents: [self.compression_exponent, tension],
            opening,
            dilatancy: self.dilatancy,
            broken: self.broken,
            compaction,
        };
        let brittleness = law.brittleness(young, bulk);
        if brittleness >= 1.0 {
            let allowed = "a narrower `crack_band`, or λ that is larger where η falls".to_owned();
            return Err(("tension softens faster than elastic strain recovers", allowed));
        }
        Ok(law)
    }

    /// b₂ and b₃.
    fn softening(&self, function: &DamageFunction) -> Result<(f64, f64), Obstacle> {
        let (tensile, dilatancy) = (self.tensile_strength, self.dilatancy);
        match (self.tension_exponent, self.opening_damage, self.fracture_energy, self.crack_band) {
            (Some(tension), Some(opening), None, None) => Ok((tension, opening)),
            (None, None, Some(energy), Some(band)) => {
                let of_volume = energy / band;
                let tension = energy::exponent(function, tensile, dilatancy, of_volume);
                let range = [energy::MOST, -energy::MOST]
                    .map(|b| band * energy::tension(function, tensile, b, dilatancy));
                let tension = tension.ok_or((
                    "no exponent gives this energy with this damage function",
                    format!("a `fracture_energy` of {:.3e} to {:.3e} J/m²", range[0], range[1]),
                ))?;
                Ok((tension, energy::opening(function, tensile, of_volume)))
            }
            _ => Err((
                "softening in tension has two constants",
                "`tension_exponent` and `opening_damage`, or `fracture_energy` and `crack_band`"
                    .to_owned(),
            )),
        }
    }
}

/// Points of a table of two lists.
fn pairs(first: &[f64], second: &[f64]) -> Result<Vec<[f64; 2]>, Obstacle> {
    if first.len() != second.len() || first.is_empty() {
        return Err(("a table has two lists", "lists of the same length, one or more".to_owned()));
    }
    Ok(first.iter().zip(second).map(|(a, b)| [*a, *b]).collect())
}

impl ConcreteLaw {
    fn at(&self, temperature: f64) -> Option<Result<LargeStrainLaw, Obstacle>> {
        let [bulk, shear] = moduli(&self.elasticity, temperature)?;
        let young = self.elasticity.young.as_ref()?.value(temperature);
        let law = |concrete| LargeStrainLaw { bulk, shear, deviator: Deviator::Concrete(concrete) };
        Some(self.crushing.kcc.law(young, bulk).map(law))
    }
}

impl Deformation for ConcreteLaw {
    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn needs(&self) -> Vec<Need> {
        let all = Elasticity::needs("concrete is elastic up to its surfaces");
        all.into_iter().filter(|need| need.key != "expansion").collect()
    }

    fn yields(&self) -> bool {
        true
    }

    fn is_of_large_strain(&self) -> bool {
        true
    }

    fn large_strain(&self, temperature: f64) -> Option<LargeStrainLaw> {
        self.at(temperature)?.ok()
    }

    fn obstacle(&self, temperature: f64) -> Option<Obstacle> {
        self.at(temperature)?.err()
    }

    fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        SolidLaw::from(self.elasticity.clone()).deformation().flow_law(stress_free_temperature)
    }
}
