//! Readings of filaments.

use crate::body::{Descriptor, Direct};
use crate::method::filament::{Deviation, LineTotals};
use crate::method::sph::DropletTotals;
use crate::quantity::Quantity;
use crate::scene::{Filament, FilamentMethod, Scene};

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
    OfParticles,
    OfYieldingParticles,
    OfRestingParticles,
}

/// A strand, as readings see it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Seen {
    /// Volume that has come [m³], and mass [kg].
    pub volume: f64,
    pub mass: f64,
    /// Sums over the segments, and over the strand of a line its heat.
    pub totals: LineTotals,
    pub deviation: Deviation,
    pub segments: usize,
    /// Place of touchdown [m].
    pub touch: [f64; 2],
    /// Impulse given to what lies below, also beyond the edge of a solid [N s].
    pub impulse: [f64; 3],
    /// Heat as the fluid came, given to what lies below and to the air [J].
    pub supplied: f64,
    pub given: f64,
    pub lost: f64,
    /// Heat [J] and impulse along z [N s] of the last exchange, and its duration [s].
    pub exchanged: [f64; 2],
    pub duration: f64,
    /// Sums over particles; zero for a line.
    pub particles: DropletTotals,
    /// Number of particles that rest.
    pub resting: usize,
    /// Density at rest [kg/m³].
    pub density: f64,
}

impl Seen {
    /// A mean rate in the last step.
    fn rate(&self, amount: f64) -> f64 {
        if self.duration > 0.0 { amount / self.duration } else { 0.0 }
    }
}

const TOTALS: [Total; 37] = [
    total("volume", "volume that has come so far", Quantity::Volume, |seen| seen.volume),
    total(
        "volume_drift",
        "error of the volume balance: volume of the segments minus volume that has come",
        Quantity::Volume,
        |seen| seen.totals.volume - seen.volume,
    ),
    total("mass", "mass that has come so far", Quantity::Mass, |seen| seen.mass),
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
        seen.touch[0]
    }),
    total("touchdown_y", "y at which the strand touches down", Quantity::Length, |seen| {
        seen.touch[1]
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
    total("segments", "number of segments", Quantity::Count, |seen| seen.segments as f64),
    total(
        "impulse_x",
        "impulse along x given to what lies below since time zero",
        Quantity::Momentum,
        |seen| seen.impulse[0],
    ),
    total(
        "impulse_y",
        "impulse along y given to what lies below since time zero",
        Quantity::Momentum,
        |seen| seen.impulse[1],
    ),
    total(
        "impulse_z",
        "impulse along z given to what lies below since time zero",
        Quantity::Momentum,
        |seen| seen.impulse[2],
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
            |seen| seen.supplied,
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
            seen.lost
        }),
    ),
    of(
        Offered::OnASolid,
        total("heat", "heat given to the solid below since time zero", Quantity::Energy, |seen| {
            seen.given
        }),
    ),
    of(
        Offered::OnASolid,
        total(
            "heat_flow",
            "heat flow into the solid below, mean over the last exchange",
            Quantity::HeatFlow,
            |seen| seen.rate(seen.exchanged[0]),
        ),
    ),
    of(
        Offered::OnASolid,
        total(
            "force",
            "force into the solid below, mean over the last exchange",
            Quantity::Force,
            |seen| seen.rate(-seen.exchanged[1]),
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
    particles("particles", "number of particles", Quantity::Ratio, |seen| seen.particles.particles),
    particles("steps", "time steps made inside the unit", Quantity::Ratio, |seen| {
        seen.particles.steps
    }),
    particles(
        "pressure_iterations",
        "iterations of pressure and viscosity in a time step, mean since the start",
        Quantity::Count,
        |seen| seen.particles.iterations / seen.particles.steps.max(1.0),
    ),
    particles("max_speed", "highest speed of a particle", Quantity::Velocity, |seen| {
        seen.particles.max_speed
    }),
    particles("min_density", "lowest density of a particle", Quantity::Density, |seen| {
        seen.density * seen.particles.density_range[0]
    }),
    particles("max_density", "highest density of a particle", Quantity::Density, |seen| {
        seen.density * seen.particles.density_range[1]
    }),
    of(
        Offered::OfYieldingParticles,
        total("yielded_fraction", "fraction of the mass that yields", Quantity::Ratio, |seen| {
            seen.particles.yielded_fraction()
        }),
    ),
    of(
        Offered::OfRestingParticles,
        total(
            "resting",
            "number of particles at rest, which take no part in steps",
            Quantity::Count,
            |seen| seen.resting as f64,
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

const fn particles(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Seen) -> f64,
) -> Total {
    of(Offered::OfParticles, total(key, words, quantity, read))
}

const fn of(of: Offered, total: Total) -> Total {
    Total { of, ..total }
}

/// Returns the totals that a filament of a scene offers, each with its place in the table.
pub fn offered_totals(
    scene: &Scene,
    (name, filament): (&str, &Filament),
) -> Vec<(usize, Descriptor)> {
    let yields = filament.fluid.viscosity.yield_stress() > 0.0;
    let by_particles = filament.method == FilamentMethod::Particles;
    let is_offered = |total: &Total| match total.of {
        Offered::All => true,
        Offered::OfHeat => filament.fluid.conductivity > 0.0,
        Offered::Freezing => filament.fluid.melting.is_some(),
        Offered::Yielding => yields && !by_particles,
        Offered::OfParticles => by_particles,
        Offered::OfYieldingParticles => yields && by_particles,
        Offered::OfRestingParticles => filament.comes_to_rest() && by_particles,
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
