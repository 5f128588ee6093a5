//! Plausible ranges of constants, sizes, times and loads. They admit every real material between aerogel and diamond,
//! between liquid hydrogen and mercury or molten tungsten, but exclude values in wrong units.
//!
//! Bounds follow the extremes of D. R. Lide (ed.), *CRC Handbook of Chemistry and Physics*, 86th ed., CRC Press 2005,
//! with a margin.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// A plausible range of magnitudes. Zero is always plausible; where it is impossible, other checks refuse it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Range<'a> {
    /// Noun phrase, as in "the density of a solid".
    pub what: &'a str,
    pub unit: &'a str,
    pub lowest: f64,
    pub highest: f64,
    /// Units that are often used by mistake.
    #[serde(borrow, default, skip_serializing_if = "<[_]>::is_empty")]
    pub mistakes: Cow<'a, [Mistake<'a>]>,
}

/// A unit used by mistake: `wanted = factor · mistaken + offset`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mistake<'a> {
    pub unit: &'a str,
    pub factor: f64,
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

type Mistakes = Cow<'static, [Mistake<'static>]>;

const fn scaled(unit: &'static str, factor: f64) -> Mistake<'static> {
    Mistake { unit, factor, offset: 0.0 }
}

const LENGTHS: Mistakes =
    Cow::Borrowed(&[scaled("mm", 1e-3), scaled("µm", 1e-6), scaled("nm", 1e-9)]);
const CELSIUS: Mistakes = Cow::Borrowed(&[Mistake { unit: "°C", factor: 1.0, offset: 273.15 }]);
const GRAMS_PER_CM3: Mistakes = Cow::Borrowed(&[scaled("g/cm³", 1e3)]);
const KILOJOULES: Mistakes = Cow::Borrowed(&[scaled("kJ/(kg K)", 1e3)]);
const TIMES: Mistakes = Cow::Borrowed(&[scaled("µs", 1e-6), scaled("ns", 1e-9)]);

pub static DENSITY: Range<'static> = Range {
    what: "the density of a solid",
    unit: "kg/m³",
    lowest: 5.0,      // foams and aerogels
    highest: 23000.0, // osmium 22 590
    mistakes: GRAMS_PER_CM3,
};
pub static SPECIFIC_HEAT: Range<'static> = Range {
    what: "the specific heat capacity of a solid",
    unit: "J/(kg K)",
    lowest: 5.0,     // diamond at 77 K has 8, bismuth at room temperature 122
    highest: 6000.0, // lithium 3600
    mistakes: KILOJOULES,
};
pub static CONDUCTIVITY: Range<'static> = Range {
    what: "the conductivity of a solid",
    unit: "W/(m K)",
    lowest: 0.003,   // evacuated aerogel
    highest: 5000.0, // diamond 2200, of one isotope 3300
    mistakes: Cow::Borrowed(&[scaled("mW/(m K)", 1e-3), scaled("kW/(m K)", 1e3)]),
};
pub static YIELD_STRESS: Range<'static> = Range {
    what: "the yield stress",
    unit: "Pa",
    lowest: 1e3,   // pastes; indium has 1e6
    highest: 1e11, // of glass none is known; diamond 1e11
    mistakes: Cow::Borrowed(&[scaled("MPa", 1e6), scaled("GPa", 1e9)]),
};
pub static WEIBULL_MODULUS: Range<'static> = Range {
    what: "the Weibull modulus",
    unit: "1",
    lowest: 2.0,   // ground window glass and porous ceramics have 3 to 5
    highest: 60.0, // fibres of silica without flaws have 50 and more
    mistakes: Cow::Borrowed(&[]),
};
pub static STRENGTH: Range<'static> = Range {
    what: "the Weibull strength",
    unit: "Pa",
    lowest: 1e5,   // concrete and bricks have some MPa
    highest: 2e10, // fibres of silica without flaws 14 GPa
    mistakes: Cow::Borrowed(&[scaled("MPa", 1e6), scaled("GPa", 1e9)]),
};
pub static NOZZLE_ACCELERATION: Range<'static> = Range {
    what: "the acceleration of a nozzle",
    unit: "m/s²",
    lowest: 1e-3,   // arms that print walls
    highest: 100.0, // fast desktop printers have 20
    mistakes: Cow::Borrowed(&[scaled("mm/s²", 1e-3)]),
};
pub static GROWTH_EXPONENT: Range<'static> = Range {
    what: "the exponent of slow growth",
    unit: "1",
    lowest: 8.0,   // porous ceramics
    highest: 90.0, // silicon nitride and carbide have 50 and more
    mistakes: Cow::Borrowed(&[]),
};
pub static GROWTH_CONSTANT: Range<'static> = Range {
    what: "the constant of slow growth",
    unit: "Pa² s",
    lowest: 1e9,   // glass in water has 3e12
    highest: 1e20, // ceramics in dry air
    mistakes: Cow::Borrowed(&[scaled("MPa² s", 1e12), scaled("GPa² s", 1e18)]),
};
pub static GROWTH_SPEED: Range<'static> = Range {
    what: "the speed of slow growth",
    unit: "m/s",
    lowest: 1e-9,  // ceramics in dry air
    highest: 10.0, // glass in water has 6e-3 to 1
    mistakes: Cow::Borrowed(&[scaled("mm/s", 1e-3), scaled("µm/s", 1e-6)]),
};
pub static TOUGHNESS: Range<'static> = Range {
    what: "the toughness",
    unit: "Pa √m",
    lowest: 1e4,  // ice 1e5, aerogels less
    highest: 1e9, // tough steels 3e8
    mistakes: Cow::Borrowed(&[scaled("MPa √m", 1e6)]),
};
pub static CRACK_STRENGTH: Range<'static> = Range {
    what: "the strength",
    unit: "Pa",
    lowest: 1e5,   // porous ceramics, ice 1 MPa
    highest: 2e10, // fibres of silica without flaws 14 GPa
    mistakes: Cow::Borrowed(&[scaled("MPa", 1e6), scaled("GPa", 1e9)]),
};
pub static DAMAGE_LENGTH: Range<'static> = Range {
    what: "the length of damage",
    unit: "m",
    lowest: 1e-9, // strengths near that of atomic bonds
    highest: 0.5, // concrete
    mistakes: LENGTHS,
};
pub static CRACK_ENERGY: Range<'static> = Range {
    what: "the energy of cracks",
    unit: "J/m²",
    lowest: 0.01, // ice 1, aerogels less
    highest: 1e6, // tough steels
    mistakes: Cow::Borrowed(&[scaled("kJ/m²", 1e3)]),
};
pub static FLAW: Range<'static> = Range {
    what: "the depth of a flaw",
    unit: "m",
    lowest: 1e-8, // pores of the finest ceramics
    highest: 0.1, // cracks in walls
    mistakes: LENGTHS,
};
pub static MELTING: Range<'static> = Range {
    what: "a temperature of melting",
    unit: "K",
    lowest: 200.0,   // mercury 234; frozen gases, in scenes that say so
    highest: 4500.0, // tantalum hafnium carbide 4300
    mistakes: CELSIUS,
};
pub static LATENT_HEAT: Range<'static> = Range {
    what: "the latent heat of melting",
    unit: "J/kg",
    lowest: 3e3,  // helium 3.5e3, mercury 1.1e4
    highest: 5e6, // boron 4.6e6
    mistakes: Cow::Borrowed(&[scaled("kJ/kg", 1e3)]),
};
pub static EVAPORATION_HEAT: Range<'static> = Range {
    what: "the heat of evaporation",
    unit: "J/kg",
    lowest: 2e4,  // helium 2.1e4
    highest: 1e8, // carbon 6e7
    mistakes: Cow::Borrowed(&[scaled("kJ/kg", 1e3)]),
};
pub static MOLAR_MASS: Range<'static> = Range {
    what: "a molar mass",
    unit: "kg/mol",
    lowest: 2e-3, // hydrogen
    highest: 1.0, // volatile oligomers
    mistakes: Cow::Borrowed(&[scaled("g/mol", 1e-3)]),
};
pub static VAPOUR_DIFFUSIVITY: Range<'static> = Range {
    what: "the diffusivity of a vapour in air",
    unit: "m²/s",
    lowest: 1e-6,  // large molecules 3e-6
    highest: 1e-4, // hydrogen 7e-5
    mistakes: Cow::Borrowed(&[scaled("cm²/s", 1e-4)]),
};
pub static YOUNG: Range<'static> = Range {
    what: "Young's modulus",
    unit: "Pa",
    lowest: 700.0,   // soft hydrogels, brain tissue 1e3; metals in GPa are less
    highest: 1.4e12, // diamond 1.2e12
    mistakes: Cow::Borrowed(&[scaled("GPa", 1e9), scaled("MPa", 1e6)]),
};
pub static EXPANSION: Range<'static> = Range {
    what: "the coefficient of thermal expansion",
    unit: "1/K",
    lowest: 0.0,
    highest: 1e-3, // paraffin 5e-4
    mistakes: Cow::Borrowed(&[scaled("10⁻⁶/K", 1e-6)]),
};
/// Temperatures of solids and of fluids.
pub static TEMPERATURE: Range<'static> = Range {
    what: "a temperature",
    unit: "K",
    lowest: 200.0,   // the coldest places on Earth have 184
    highest: 6000.0, // above the boiling point of tungsten, 5828 K
    mistakes: CELSIUS,
};
pub static AMBIENT: Range<'static> = Range {
    what: "the temperature of what flows by",
    unit: "K",
    lowest: 200.0,
    highest: 50_000.0, // plasma jets
    mistakes: CELSIUS,
};
/// Temperatures in tables of constants, regardless of those of the scene.
pub static KNOT: Range<'static> = Range {
    what: "a temperature of a table",
    unit: "K",
    lowest: 200.0,
    highest: 50_000.0,
    mistakes: CELSIUS,
};
pub static FREEZING: Range<'static> = Range {
    what: "the temperature at which a liquid freezes",
    unit: "K",
    lowest: 10.0,    // hydrogen 14
    highest: 4500.0, // tantalum hafnium carbide 4300
    mistakes: CELSIUS,
};
pub static BOILING: Range<'static> = Range {
    what: "the temperature at which a liquid boils",
    unit: "K",
    lowest: 4.0,     // helium 4.2
    highest: 7000.0, // tungsten 5828
    mistakes: CELSIUS,
};
pub static HEAT_TRANSFER: Range<'static> = Range {
    what: "a heat transfer coefficient",
    unit: "W/(m² K)",
    lowest: 1e-3,
    highest: 1e9, // metals in contact
    mistakes: Cow::Borrowed(&[scaled("W/(cm² K)", 1e4)]),
};
pub static HEAT_FLUX: Range<'static> = Range {
    what: "a heat flux",
    unit: "W/m²",
    lowest: 0.0,
    highest: 2e13, // lasers that evaporate metals in nanoseconds
    mistakes: Cow::Borrowed(&[]),
};
pub static TRACTION: Range<'static> = Range {
    what: "a pressure or shear",
    unit: "Pa",
    lowest: 0.0,
    highest: 2e10, // water hammer at several km/s
    mistakes: Cow::Borrowed(&[]),
};
/// Extents of solids and of loads on them.
pub static EXTENT: Range<'static> = Range {
    what: "the extent of a solid",
    unit: "m",
    lowest: 1e-7,
    highest: 1.0,
    mistakes: LENGTHS,
};
/// Thickness of layers, from films of a few atoms on.
pub static STRIP: Range<'static> = Range {
    what: "the extent of a strip of concrete",
    unit: "m",
    lowest: 1e-3, // of mortar
    highest: 20.0,
    mistakes: LENGTHS,
};
pub static FADING: Range<'static> = Range {
    what: "the damping of a strip",
    unit: "1/s",
    lowest: 1e-2,
    highest: 1e8, // critical for a spacing of 0.1 mm
    mistakes: Cow::Borrowed(&[]),
};
pub static TENSILE_STRENGTH: Range<'static> = Range {
    what: "the tensile strength of concrete, mortar or rock",
    unit: "Pa",
    lowest: 1e4,  // foamed concrete
    highest: 1e8, // fibre concrete 15 MPa, rocks 25 MPa
    mistakes: Cow::Borrowed(&[scaled("MPa", 1e6), scaled("GPa", 1e9)]),
};
pub static OPENING: Range<'static> = Range {
    what: "the opening of a cohesive crack",
    unit: "m",
    lowest: 1e-8,
    highest: 5e-2, // fibre concrete some mm
    mistakes: LENGTHS,
};
pub static LAYER: Range<'static> = Range {
    what: "the thickness of a layer",
    unit: "m",
    lowest: 1e-9,
    highest: 1.0,
    mistakes: LENGTHS,
};
pub static CONTACT: Range<'static> = Range {
    what: "the thermal resistance of a contact",
    unit: "m² K/W",
    lowest: 1e-10, // metals that have grown on each other
    highest: 1.0,  // air gaps of centimetres
    mistakes: Cow::Borrowed(&[scaled("cm² K/W", 1e-4), scaled("mm² K/W", 1e-6)]),
};
pub static CONDUCTANCE: Range<'static> = Range {
    what: "the conductance of a contact",
    unit: "W/(m² K)",
    lowest: 1.0,   // air gaps of centimetres
    highest: 1e10, // metals that have grown on each other
    mistakes: Cow::Borrowed(&[scaled("W/(cm² K)", 1e4), scaled("W/(mm² K)", 1e6)]),
};
pub static DIAMETER: Range<'static> = Range {
    what: "the diameter of a drop",
    unit: "m",
    lowest: 1e-7,
    highest: 2e-2, // rain breaks up at 6 mm
    mistakes: LENGTHS,
};
pub static NOZZLE: Range<'static> = Range {
    what: "the diameter of a nozzle",
    unit: "m",
    lowest: 1e-6, // inks 1e-6
    highest: 0.3, // concrete 0.06
    mistakes: LENGTHS,
};
pub static SPEED: Range<'static> = Range {
    what: "the speed of a drop",
    unit: "m/s",
    lowest: 0.0,
    highest: 3000.0, // cold spray 1200
    mistakes: Cow::Borrowed(&[scaled("mm/s", 1e-3)]),
};
pub static GRAVITY: Range<'static> = Range {
    what: "gravity",
    unit: "m/s²",
    lowest: 0.0,
    highest: 1000.0,
    mistakes: Cow::Borrowed(&[scaled("mm/s²", 1e-3)]),
};
pub static HEIGHT: Range<'static> =
    Range { what: "the gap below a body", unit: "m", lowest: 0.0, highest: 1.0, mistakes: LENGTHS };
pub static FLUID_DENSITY: Range<'static> = Range {
    what: "the density of a liquid",
    unit: "kg/m³",
    lowest: 50.0,     // hydrogen 71
    highest: 23000.0, // molten osmium 20 000, mercury 13 534
    mistakes: GRAMS_PER_CM3,
};
pub static FLUID_SPECIFIC_HEAT: Range<'static> = Range {
    what: "the specific heat capacity of a liquid",
    unit: "J/(kg K)",
    lowest: 80.0, // mercury 139
    highest: 2e4, // hydrogen 9700
    mistakes: KILOJOULES,
};
pub static FLUID_CONDUCTIVITY: Range<'static> = Range {
    what: "the conductivity of a liquid",
    unit: "W/(m K)",
    lowest: 0.01,   // helium 0.02
    highest: 400.0, // molten silver 180
    mistakes: Cow::Borrowed(&[scaled("mW/(m K)", 1e-3)]),
};
pub static VISCOSITY: Range<'static> = Range {
    what: "the viscosity of a liquid that forms drops",
    unit: "Pa s",
    lowest: 1e-6,   // helium 3e-6
    highest: 100.0, // honey 10, glass at its working point 1000
    mistakes: Cow::Borrowed(&[scaled("mPa s", 1e-3)]),
};
pub static STRAND_VISCOSITY: Range<'static> = Range {
    what: "the viscosity of a fluid that is laid",
    unit: "Pa s",
    lowest: 1e-6,
    highest: 1e7, // polymer melts and pastes 1e6
    mistakes: Cow::Borrowed(&[scaled("mPa s", 1e-3)]),
};
/// Viscosity of a fluid at rest, which thins when a drop moves.
pub static ZERO_SHEAR_VISCOSITY: Range<'static> = Range {
    what: "the viscosity of a fluid at low shear rates",
    unit: "Pa s",
    lowest: 1e-6,
    highest: 1e7, // polymer melts 1e6
    mistakes: Cow::Borrowed(&[scaled("mPa s", 1e-3)]),
};
pub static FLUID_YIELD_STRESS: Range<'static> = Range {
    what: "the yield stress of a fluid",
    unit: "Pa",
    lowest: 1e-4, // blood 4e-3
    highest: 1e5, // clay and dough 1e4
    mistakes: Cow::Borrowed(&[scaled("mPa", 1e-3)]),
};
pub static CONSISTENCY: Range<'static> = Range {
    what: "the consistency of a fluid",
    unit: "Pa sⁿ",
    lowest: 1e-6,
    highest: 1e6, // polymer melts 1e5
    mistakes: Cow::Borrowed(&[scaled("mPa sⁿ", 1e-3)]),
};
pub static SHEAR_EXPONENT: Range<'static> = Range {
    what: "the exponent of a shear rate",
    unit: "1",
    lowest: 0.05, // carbopol gels 0.3
    highest: 2.5, // suspensions of starch 2
    mistakes: Cow::Borrowed(&[]),
};
pub static SHEAR_TIME: Range<'static> = Range {
    what: "the time of a law of viscosity",
    unit: "s",
    lowest: 1e-10, // of molecules of a thin liquid
    highest: 1e5,  // polymer solutions 1e3
    mistakes: TIMES,
};
pub static RELAXATION_TIME: Range<'static> = Range {
    what: "the relaxation time",
    unit: "s",
    lowest: 1e-13, // vibrations of molecules
    highest: 1e20, // glasses far below their transition
    mistakes: Cow::Borrowed(&[]),
};
pub static ACTIVATION_ENERGY: Range<'static> = Range {
    what: "the activation energy of flow",
    unit: "J/mol",
    lowest: 500.0, // liquefied gases 2e3
    highest: 1e6,  // glasses near their transition 6e5
    mistakes: Cow::Borrowed(&[scaled("kJ/mol", 1e3)]),
};
pub static SURFACE_TENSION: Range<'static> = Range {
    what: "the surface tension",
    unit: "N/m",
    lowest: 5e-5, // helium 1e-4
    highest: 4.0, // molten tungsten 2.5
    mistakes: Cow::Borrowed(&[scaled("mN/m", 1e-3)]),
};
pub static TIME: Range<'static> =
    Range { what: "a time", unit: "s", lowest: 1e-13, highest: 1e7, mistakes: TIMES };

/// Lowest plausible temperature in intentionally cold scenes, and in those with liquids as light as hydrogen [K].
pub const CRYOGENIC: f64 = 1.0;
/// Lowest plausible temperature in scenes that also contain something warmer than this [K].
pub const BESIDE_WARM: f64 = 250.0;
/// The same for melting points: above that of tin in °C, 231.9, and below that of mercury, 234.3 K.
pub const MELTS_BESIDE_WARM: f64 = 233.0;

/// Coldness of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cold {
    /// The scene is intentionally cold.
    Meant,
    /// Nothing in the scene is as warm as [`BESIDE_WARM`].
    Throughout,
    /// Something in the scene is that warm.
    BesideWarm,
}

impl<'a> Range<'a> {
    pub fn holds(&self, value: f64) -> bool {
        value == 0.0 || (self.lowest..=self.highest).contains(&value.abs())
    }

    /// Value in SI units and unit of the mistake that makes it plausible.
    pub fn meant(&self, value: f64) -> Option<(f64, &'a str)> {
        let read = |mistake: &Mistake<'a>| (mistake.factor * value + mistake.offset, mistake.unit);
        self.mistakes.iter().map(read).find(|&(meant, _)| self.holds(meant))
    }
}
