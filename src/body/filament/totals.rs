//! Readings of filaments.

use crate::body::{Descriptor, Direct};
use crate::method::filament::{Deviation, LineTotals, Strand};
use crate::quantity::Quantity;
use crate::scene::{Filament, Scene};

/// A scalar and its reader.
struct Total {
    descriptor: Descriptor,
    of: Offered,
    read: fn(&Seen) -> f64,
}

/// Filaments that offer a total.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    OfHeat,
    Freezing,
    Yielding,
    InAir,
    OnASolid,
    WithATarget,
}

/// A strand with its sums, as readings see it.
pub struct Seen<'a> {
    pub strand: &'a Strand,
    pub totals: &'a LineTotals,
    pub deviation: &'a Deviation,
    pub density: f64,
}

impl Seen<'_> {
    /// A mean rate in the last step.
    fn rate(&self, amount: f64) -> f64 {
        if self.strand.duration > 0.0 { amount / self.strand.duration } else { 0.0 }
    }
}

const TOTALS: [Total; 29] = [
    total("volume", "volume that has come so far", Quantity::Volume, |seen| seen.strand.volume),
    total(
        "volume_drift",
        "error of the volume balance: volume of the segments minus volume that has come",
        Quantity::Volume,
        |seen| seen.totals.volume - seen.strand.volume,
    ),
    total("mass", "mass that has come so far", Quantity::Mass, |seen| {
        seen.density * seen.strand.volume
    }),
    total("length", "length of the centre line laid so far", Quantity::Length, |seen| {
        seen.totals.length
    }),
    total("width", "mean width of the strand over its length", Quantity::Length, |seen| {
        seen.totals.width
    }),
    total(
        "height",
        "mean height of the strand, volume over covered area",
        Quantity::Length,
        |seen| seen.totals.height,
    ),
    total("last_width", "width of the segment laid last", Quantity::Length, |seen| {
        seen.totals.last_width
    }),
    total("last_height", "height of the segment laid last", Quantity::Length, |seen| {
        seen.totals.last_height
    }),
    total(
        "lag",
        "distance along the plate between the nozzle and the touchdown of the strand",
        Quantity::Length,
        |seen| seen.totals.lag,
    ),
    total("touchdown_x", "x at which the strand touches down", Quantity::Length, |seen| {
        seen.strand.touch[0]
    }),
    total("touchdown_y", "y at which the strand touches down", Quantity::Length, |seen| {
        seen.strand.touch[1]
    }),
    of(
        Offered::Yielding,
        total(
            "bearing_ratio",
            "largest weight of a stack over what the yield stress of its lowest layer bears: from 1 on it yields",
            Quantity::Ratio,
            |seen| seen.totals.bearing,
        ),
    ),
    total("segments", "number of segments", Quantity::Count, |seen| seen.strand.len() as f64),
    total(
        "impulse_x",
        "impulse along x given to what lies below since time zero",
        Quantity::Momentum,
        |seen| seen.strand.impulse[0],
    ),
    total(
        "impulse_y",
        "impulse along y given to what lies below since time zero",
        Quantity::Momentum,
        |seen| seen.strand.impulse[1],
    ),
    total(
        "impulse_z",
        "impulse along z given to what lies below since time zero",
        Quantity::Momentum,
        |seen| seen.strand.impulse[2],
    ),
    of(
        Offered::OfHeat,
        total(
            "max_temperature",
            "highest temperature of a segment",
            Quantity::Temperature,
            |seen| seen.totals.hottest,
        ),
    ),
    of(
        Offered::OfHeat,
        total(
            "min_temperature",
            "lowest temperature of a segment",
            Quantity::Temperature,
            |seen| seen.totals.coldest,
        ),
    ),
    of(
        Offered::OfHeat,
        total(
            "heat_supplied",
            "heat of the fluid as it came, above that at the start temperature of the nozzle",
            Quantity::Energy,
            |seen| seen.strand.supplied,
        ),
    ),
    of(
        Offered::OfHeat,
        total(
            "heat_stored",
            "heat gained since the fluid came, negative when cooled",
            Quantity::Energy,
            |seen| seen.totals.heat_stored,
        ),
    ),
    of(
        Offered::OfHeat,
        total(
            "heat_drift",
            "error of the heat balance: heat_stored, heat and heat_lost together",
            Quantity::Energy,
            |seen| seen.totals.missing,
        ),
    ),
    of(
        Offered::Freezing,
        total("solid_fraction", "frozen fraction of the volume", Quantity::Ratio, |seen| {
            seen.totals.frozen
        }),
    ),
    of(
        Offered::InAir,
        total("heat_lost", "heat given to the air since time zero", Quantity::Energy, |seen| {
            seen.strand.lost
        }),
    ),
    of(
        Offered::OnASolid,
        total("heat", "heat given to the solid below since time zero", Quantity::Energy, |seen| {
            seen.strand.given
        }),
    ),
    of(
        Offered::OnASolid,
        total(
            "heat_flow",
            "heat flow into the solid below, mean over the last exchange",
            Quantity::HeatFlow,
            |seen| seen.rate(seen.strand.cell_heat.iter().sum()),
        ),
    ),
    of(
        Offered::OnASolid,
        total(
            "force",
            "force into the solid below, mean over the last exchange",
            Quantity::Force,
            |seen| seen.rate(seen.strand.cell_impulse.iter().map(|impulse| -impulse[2]).sum()),
        ),
    ),
    of(
        Offered::WithATarget,
        total(
            "deviation",
            "mean distance of the centre line from the target, over its length",
            Quantity::Length,
            |seen| seen.deviation.mean,
        ),
    ),
    of(
        Offered::WithATarget,
        total(
            "largest_deviation",
            "largest distance of the centre line from the target",
            Quantity::Length,
            |seen| seen.deviation.largest,
        ),
    ),
    of(
        Offered::WithATarget,
        total(
            "gap",
            "length of the target that the strand does not cover",
            Quantity::Length,
            |seen| seen.deviation.gap,
        ),
    ),
];

const fn total(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Seen) -> f64,
) -> Total {
    let descriptor = Descriptor { key, words, quantity, direct: Direct::Nothing };
    Total { descriptor, of: Offered::All, read }
}

const fn of(of: Offered, total: Total) -> Total {
    Total { of, ..total }
}

/// Returns the totals that a filament of a scene offers, each with its place in the table.
pub fn offered_totals(
    scene: &Scene,
    (name, filament): (&str, &Filament),
) -> Vec<(usize, Descriptor)> {
    let is_offered = |total: &Total| match total.of {
        Offered::All => true,
        Offered::OfHeat => filament.fluid.conductivity > 0.0,
        Offered::Freezing => filament.fluid.melting.is_some(),
        Offered::Yielding => filament.fluid.viscosity.yield_stress() > 0.0,
        Offered::InAir => filament.convection.is_some(),
        Offered::OnASolid => scene.coupling_from(name).is_some(),
        Offered::WithATarget => scene.target_of(name).is_some(),
    };
    let places = TOTALS.iter().enumerate().filter(|(_, total)| is_offered(total));
    places.map(|(place, total)| (place, total.descriptor)).collect()
}

/// Reads the total at a place of the table.
pub fn read(place: usize, seen: &Seen) -> f64 {
    (TOTALS[place].read)(seen)
}
