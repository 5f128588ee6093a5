//! What constants, sizes, times and loads plausibly are: wide enough for every real material between
//! aerogel and diamond, between liquid hydrogen and mercury or molten tungsten, narrow enough that values
//! in wrong units stand out.
//!
//! Bounds follow the extremes of D. R. Lide (ed.), *CRC Handbook of Chemistry and Physics*, 86th ed.,
//! CRC Press 2005, with a margin.

/// A plausible range of magnitudes; zero is never implausible, but refused where it is impossible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// In words, as in "the density of a solid".
    pub what: &'static str,
    pub unit: &'static str,
    pub lowest: f64,
    pub highest: f64,
    /// Units that people write values in by mistake.
    pub mistakes: &'static [Mistake],
}

/// A unit that is not the wanted one: `wanted = factor · mistaken + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mistake {
    pub unit: &'static str,
    pub factor: f64,
    pub offset: f64,
}

const fn scaled(unit: &'static str, factor: f64) -> Mistake {
    Mistake { unit, factor, offset: 0.0 }
}

const LENGTHS: &[Mistake] = &[scaled("mm", 1e-3), scaled("µm", 1e-6), scaled("nm", 1e-9)];
const CELSIUS: &[Mistake] = &[Mistake { unit: "°C", factor: 1.0, offset: 273.15 }];
const GRAMS_PER_CM3: &[Mistake] = &[scaled("g/cm³", 1e3)];
const KILOJOULES: &[Mistake] = &[scaled("kJ/(kg K)", 1e3)];
const TIMES: &[Mistake] = &[scaled("µs", 1e-6), scaled("ns", 1e-9)];

pub const DENSITY: Range = Range {
    what: "the density of a solid",
    unit: "kg/m³",
    lowest: 5.0,      // foams and aerogels
    highest: 23000.0, // osmium 22 590
    mistakes: GRAMS_PER_CM3,
};
pub const SPECIFIC_HEAT: Range = Range {
    what: "the specific heat capacity of a solid",
    unit: "J/(kg K)",
    lowest: 5.0,     // diamond at 77 K has 8, bismuth at room temperature 122
    highest: 6000.0, // lithium 3600
    mistakes: KILOJOULES,
};
pub const CONDUCTIVITY: Range = Range {
    what: "the conductivity of a solid",
    unit: "W/(m K)",
    lowest: 0.003,   // evacuated aerogel
    highest: 5000.0, // diamond 2200, of one isotope 3300
    mistakes: &[scaled("mW/(m K)", 1e-3), scaled("kW/(m K)", 1e3)],
};
pub const YIELD_STRESS: Range = Range {
    what: "the yield stress",
    unit: "Pa",
    lowest: 1e3,   // pastes; indium has 1e6
    highest: 1e11, // of glass none is known; diamond 1e11
    mistakes: &[scaled("MPa", 1e6), scaled("GPa", 1e9)],
};
pub const MELTING: Range = Range {
    what: "a temperature of melting",
    unit: "K",
    lowest: 50.0,    // nitrogen 63, mercury 234
    highest: 4500.0, // tantalum hafnium carbide 4300
    mistakes: CELSIUS,
};
pub const LATENT_HEAT: Range = Range {
    what: "the latent heat of melting",
    unit: "J/kg",
    lowest: 3e3,  // helium 3.5e3, mercury 1.1e4
    highest: 5e6, // boron 4.6e6
    mistakes: &[scaled("kJ/kg", 1e3)],
};
pub const YOUNG: Range = Range {
    what: "Young's modulus",
    unit: "Pa",
    lowest: 5e3,     // gels
    highest: 1.4e12, // diamond 1.2e12
    mistakes: &[scaled("GPa", 1e9), scaled("MPa", 1e6)],
};
pub const EXPANSION: Range = Range {
    what: "the coefficient of thermal expansion",
    unit: "1/K",
    lowest: 0.0,
    highest: 1e-3, // paraffin 5e-4
    mistakes: &[scaled("10⁻⁶/K", 1e-6)],
};
/// Of solids and of fluids, but around liquids as light as hydrogen.
pub const TEMPERATURE: Range = Range {
    what: "a temperature",
    unit: "K",
    lowest: 60.0,    // below liquid nitrogen
    highest: 6000.0, // above the boiling point of tungsten, 5828 K
    mistakes: CELSIUS,
};
/// The same around liquids as light as hydrogen and helium.
pub const CRYOGENIC: Range = Range { lowest: 1.0, ..TEMPERATURE };
pub const AMBIENT: Range = Range {
    what: "the temperature of what flows by",
    highest: 50_000.0, // plasma jets
    ..TEMPERATURE
};
pub const HEAT_TRANSFER: Range = Range {
    what: "a heat transfer coefficient",
    unit: "W/(m² K)",
    lowest: 1e-3,
    highest: 1e9, // metals in contact
    mistakes: &[scaled("W/(cm² K)", 1e4)],
};
pub const HEAT_FLUX: Range = Range {
    what: "a heat flux",
    unit: "W/m²",
    lowest: 0.0,
    highest: 2e13, // lasers that evaporate metals in nanoseconds
    mistakes: &[],
};
pub const TRACTION: Range = Range {
    what: "a pressure or shear",
    unit: "Pa",
    lowest: 0.0,
    highest: 2e10, // water hammer at several km/s
    mistakes: &[],
};
/// Extents of solids and of loads on them.
pub const EXTENT: Range = Range {
    what: "the extent of a solid",
    unit: "m",
    lowest: 1e-7,
    highest: 1.0,
    mistakes: LENGTHS,
};
/// From films of a few atoms on.
pub const LAYER: Range = Range {
    what: "the thickness of a layer",
    unit: "m",
    lowest: 1e-9,
    highest: 1.0,
    mistakes: LENGTHS,
};
pub const CONTACT: Range = Range {
    what: "the thermal resistance of a contact",
    unit: "m² K/W",
    lowest: 1e-10, // metals that have grown on each other
    highest: 1.0,  // air gaps of centimetres
    mistakes: &[scaled("cm² K/W", 1e-4), scaled("mm² K/W", 1e-6)],
};
pub const DIAMETER: Range = Range {
    what: "the diameter of a drop",
    unit: "m",
    lowest: 1e-7,
    highest: 2e-2, // rain breaks up at 6 mm
    mistakes: LENGTHS,
};
pub const SPEED: Range = Range {
    what: "the speed of a drop",
    unit: "m/s",
    lowest: 0.0,
    highest: 3000.0, // cold spray 1200
    mistakes: &[scaled("mm/s", 1e-3)],
};
pub const GRAVITY: Range = Range {
    what: "gravity",
    unit: "m/s²",
    lowest: 0.0,
    highest: 1000.0,
    mistakes: &[scaled("mm/s²", 1e-3)],
};
pub const HEIGHT: Range =
    Range { what: "the gap below a drop", unit: "m", lowest: 0.0, highest: 1.0, mistakes: LENGTHS };
pub const FLUID_DENSITY: Range = Range {
    what: "the density of a liquid",
    unit: "kg/m³",
    lowest: 50.0,     // hydrogen 71
    highest: 23000.0, // molten osmium 20 000, mercury 13 534
    mistakes: GRAMS_PER_CM3,
};
pub const FLUID_SPECIFIC_HEAT: Range = Range {
    what: "the specific heat capacity of a liquid",
    unit: "J/(kg K)",
    lowest: 80.0, // mercury 139
    highest: 2e4, // hydrogen 9700
    mistakes: KILOJOULES,
};
pub const FLUID_CONDUCTIVITY: Range = Range {
    what: "the conductivity of a liquid",
    unit: "W/(m K)",
    lowest: 0.01,   // helium 0.02
    highest: 400.0, // molten silver 180
    mistakes: &[scaled("mW/(m K)", 1e-3)],
};
pub const VISCOSITY: Range = Range {
    what: "the viscosity of a liquid that forms drops",
    unit: "Pa s",
    lowest: 1e-6,   // helium 3e-6
    highest: 100.0, // honey 10, glass at its working point 1000
    mistakes: &[scaled("mPa s", 1e-3)],
};
pub const SURFACE_TENSION: Range = Range {
    what: "the surface tension",
    unit: "N/m",
    lowest: 5e-5, // helium 1e-4
    highest: 4.0, // molten tungsten 2.5
    mistakes: &[scaled("mN/m", 1e-3)],
};
pub const TIME: Range =
    Range { what: "a time", unit: "s", lowest: 1e-13, highest: 1e7, mistakes: TIMES };

impl Range {
    pub fn holds(&self, value: f64) -> bool {
        value == 0.0 || (self.lowest..=self.highest).contains(&value.abs())
    }

    /// What the value would be in SI units, were it in a unit that makes it plausible, and that unit.
    pub fn meant(&self, value: f64) -> Option<(f64, &'static str)> {
        let read = |mistake: &Mistake| (mistake.factor * value + mistake.offset, mistake.unit);
        self.mistakes.iter().map(read).find(|&(meant, _)| self.holds(meant))
    }
}
