//! Temperatures beyond which the constants of a fluid do not hold: it would freeze or boil, as the model has no phase
//! change of droplets, the table of its viscosity ends, or the range of its substance.

use crate::laws::{Fluid, Melting, Viscosity};
use crate::method::sph::WarmPlace;
use crate::scene::{FirstContact, NamedSubstance, Scene};
use crate::substances::Kind;
use crate::warning::{self, Warning};

/// The way in which a fluid gets beyond its constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    Freezing,
    Boiling,
    /// Colder than the table of viscosity.
    ColdEnd,
    /// Hotter than the table of viscosity.
    HotEnd,
    /// Colder than what the library's constants hold for.
    ColdRange,
    /// Hotter than that.
    HotRange,
}

/// The points that a scene sets for the fluid of a droplet.
#[derive(Debug, Clone, PartialEq)]
pub struct Watch {
    name: String,
    /// [K]
    points: Vec<(Passage, f64)>,
    /// Name of a substance of the library, and the temperatures between which its constants hold [K].
    substance: Option<(&'static str, [f64; 2])>,
}

impl Watch {
    /// `freezes` is true if the model has the fluid's freezing.
    pub fn of(scene: &Scene, (name, fluid): (&str, &Fluid), freezes: bool) -> Self {
        let substance = scene.substances_of(name).find(|named| named.kind == Kind::Fluid);
        let substance = substance.map(|named| (named.substance.name, named.valid));
        let slack = NamedSubstance::ROUNDED;
        let ends = substance.map(|(_, [low, high])| [low - slack, high + slack]);
        // Freezing and boiling say more where they are near. What is frozen has constants of its own.
        let is_liquid = |low: f64| fluid.freezing_point().is_none_or(|point| point < low - slack);
        let boils_later = |high: f64| fluid.boils_at.is_none_or(|point| point > high + slack);
        let low = ends.map(|[low, _]| low).filter(|low| !freezes && is_liquid(*low));
        let high = ends.map(|[_, high]| high).filter(|high| boils_later(*high));
        let knots = match &fluid.viscosity {
            Viscosity::Table(table) => &table.temperature[..],
            Viscosity::Constant(_) | Viscosity::Law(_) => &[],
        };
        let points = [
            (Passage::Freezing, fluid.freezing_point().filter(|_| !freezes)),
            (Passage::Boiling, fluid.boils_at),
            (Passage::ColdEnd, knots.first().copied()),
            (Passage::HotEnd, knots.last().copied()),
            (Passage::ColdRange, low),
            (Passage::HotRange, high),
        ];
        let set = points.into_iter().filter_map(|(passage, point)| Some((passage, point?)));
        Self { name: name.to_owned(), points: set.collect(), substance }
    }

    /// The passages for which the scene sets a temperature.
    pub fn passages(&self) -> impl Iterator<Item = Passage> + '_ {
        self.points.iter().map(|(passage, _)| *passage)
    }

    /// The subject of warnings about a passage.
    pub fn subject(&self, passage: Passage) -> String {
        format!("{} {passage:?}", self.name)
    }

    /// Warns if the coldest or the hottest fluid is beyond the point of a passage at a time [s].
    pub fn warning(
        &self,
        passage: Passage,
        [coldest, hottest]: [WarmPlace; 2],
        time: f64,
    ) -> Option<Warning> {
        let (_, point) = self.points.iter().find(|(other, _)| *other == passage)?;
        let (is_beyond, extreme) = match passage {
            Passage::Freezing | Passage::ColdEnd | Passage::ColdRange => {
                (coldest.temperature < *point, coldest)
            }
            Passage::Boiling | Passage::HotEnd | Passage::HotRange => {
                (hottest.temperature > *point, hottest)
            }
        };
        let WarmPlace { temperature, place } = extreme;
        let [x, y, z] = place.map(|along| format!("{along:.2e}"));
        let (time, temperature) = (format!("{time:.3e}"), format!("{temperature:.1}"));
        is_beyond.then(|| {
            let finding = match passage {
                Passage::Freezing => warning::fluid_freezes(time, temperature, x, y, z, point),
                Passage::Boiling => warning::fluid_boils(time, temperature, x, y, z, point),
                Passage::ColdEnd | Passage::HotEnd => {
                    warning::fluid_beyond_viscosity(time, temperature, x, y, z, point)
                }
                Passage::ColdRange | Passage::HotRange => {
                    let (name, [low, high]) = self.substance.unwrap_or_default();
                    let end = if passage == Passage::ColdRange { low } else { high };
                    warning::fluid_beyond_substance(time, temperature, x, y, z, end, name)
                }
            };
            finding.at(&self.name).of_subject(self.subject(passage))
        })
    }
}

/// The note on a fluid that freezes.
fn frozen_note(melting: &Melting) -> String {
    let Melting { solidus, liquidus, .. } = melting;
    let range = match melting.is_isothermal() {
        true => format!("at {solidus} K"),
        false => format!("between {liquidus} K and {solidus} K"),
    };
    format!(
        "the fluid freezes {range}, without undercooling; what is frozen by half or more is rigid and sticks to what it \
         touches, and neither shrinks nor bears thermal stress"
    )
}

/// Returns notes on the phases that the model leaves out, and on the contact temperature predicted below a drop.
pub fn note(scene: &Scene, (name, fluid): (&str, &Fluid)) -> String {
    let (freezes_at, boils_at) = (fluid.freezing_point(), fluid.boils_at);
    if let Some(freezing) = scene.freezing_of(name) {
        return frozen_note(&freezing.melting);
    }
    let general = match fluid.viscosity.depends_on_temperature() {
        true => {
            "liquids neither freeze nor boil in this model, and only their viscosity changes with temperature"
        }
        false => {
            "liquids neither freeze nor boil in this model, and their constants do not change with temperature"
        }
    };
    if freezes_at.or(boils_at).is_none() {
        return format!(
            "{general}: `freezes_at` and `boils_at` of the fluid (K) make it warn where that would matter"
        );
    }
    let Some(FirstContact { below, below_temperature, temperature }) = scene.first_contact(name)
    else {
        return format!(
            "{general}: a step warns once where fluid passes `freezes_at` or `boils_at`"
        );
    };
    if let Some(conductance) = scene.conductance_below(name) {
        return format!(
            "{general}; in contact with `{below}` at {below_temperature} K through {conductance} W/(m² K) its surface is \
             predicted to reach {temperature:.1} K by the stop time, as half spaces do"
        );
    }
    format!(
        "{general}; in contact with `{below}` at {below_temperature} K the fluid is predicted to be at \
         {temperature:.1} K, (e₁T₁ + e₂T₂)/(e₁ + e₂) of effusivities e"
    )
}
