//! Temperatures at which a fluid would freeze or boil; the model has no phase change of droplets.

use crate::laws::Fluid;
use crate::method::sph::WarmPlace;
use crate::scene::{FirstContact, Scene};
use crate::warning::{self, Warning};

/// A phase change that the model omits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhaseChange {
    Freezing,
    Boiling,
}

/// The points that a scene sets for the fluid of a droplet.
#[derive(Debug, Clone, PartialEq)]
pub struct Watch {
    name: String,
    /// [K]
    points: Vec<(PhaseChange, f64)>,
}

impl Watch {
    pub fn of(name: &str, fluid: &Fluid) -> Self {
        let points =
            [(PhaseChange::Freezing, fluid.freezes_at), (PhaseChange::Boiling, fluid.boils_at)];
        let set = points.into_iter().filter_map(|(change, point)| Some((change, point?)));
        Self { name: name.to_owned(), points: set.collect() }
    }

    /// The phase changes for which the scene sets a temperature.
    pub fn changes(&self) -> impl Iterator<Item = PhaseChange> + '_ {
        self.points.iter().map(|(change, _)| *change)
    }

    /// The subject of warnings about a phase change.
    pub fn subject(&self, change: PhaseChange) -> String {
        format!("{} {change:?}", self.name)
    }

    /// Warns if the coldest or the hottest fluid is beyond the point of a change at a time [s].
    pub fn warning(
        &self,
        change: PhaseChange,
        [coldest, hottest]: [WarmPlace; 2],
        time: f64,
    ) -> Option<Warning> {
        let (_, point) = self.points.iter().find(|(other, _)| *other == change)?;
        let (is_beyond, extreme) = match change {
            PhaseChange::Freezing => (coldest.temperature < *point, coldest),
            PhaseChange::Boiling => (hottest.temperature > *point, hottest),
        };
        let WarmPlace { temperature, place } = extreme;
        let [x, y, z] = place.map(|along| format!("{along:.2e}"));
        let (time, temperature) = (format!("{time:.3e}"), format!("{temperature:.1}"));
        is_beyond.then(|| {
            let finding = match change {
                PhaseChange::Freezing => warning::fluid_freezes(time, temperature, x, y, z, point),
                PhaseChange::Boiling => warning::fluid_boils(time, temperature, x, y, z, point),
            };
            finding.at(&self.name).of_subject(self.subject(change))
        })
    }
}

/// Returns notes on the phases that the model leaves out, and on the contact temperature predicted below a drop.
pub fn note(scene: &Scene, (name, fluid): (&str, &Fluid)) -> String {
    let &Fluid { freezes_at, boils_at, .. } = fluid;
    let general = "liquids neither freeze nor boil in this model, and their constants do not change with temperature";
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
    format!(
        "{general}; in contact with `{below}` at {below_temperature} K the fluid is predicted to be at \
         {temperature:.1} K, (e₁T₁ + e₂T₂)/(e₁ + e₂) of effusivities e"
    )
}
