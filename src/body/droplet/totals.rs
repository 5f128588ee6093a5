//! Readings of a whole droplet.

use super::reader::DropletReader;
use crate::body::{Descriptor, Direct};
use crate::method::sph::DropletTotals;
use crate::port::WallExchange;
use crate::quantity::Quantity;
use crate::scene::{Droplet, PressureAdvance, Scene};

/// A scalar of a whole droplet, and its reader.
struct Total {
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    of: Offered,
    read: Read,
}

/// Droplets that offer a total.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    /// Those above a wall or a solid.
    AboveAWall,
    /// Those released by inputs.
    OnDemand,
    /// Those on a solid, which may run over its edge.
    OnASolid,
    /// Those of a fluid with a yield stress.
    Yielding,
    /// Those whose pressure is solved.
    WithPressure,
    /// Those of a fluid that may freeze above a wall or a solid.
    Freezing,
}

enum Read {
    /// From sums over the fluid.
    Totals(fn(&DropletTotals) -> f64),
    /// An amount of the last exchange, as a mean rate.
    Rate(fn(&WallExchange) -> f64),
    Reader(fn(&mut DropletReader) -> f64),
}

const TOTALS: [Total; 38] = [
    of_all(
        "height",
        "height of the body of fluid above the wall, without strays",
        Quantity::Length,
        |totals| totals.height,
    ),
    of_all("kinetic_energy", "kinetic energy", Quantity::Energy, |totals| totals.kinetic_energy),
    of_all(
        "compression_energy",
        "elastic energy of the weak compression",
        Quantity::Energy,
        |totals| totals.compression_energy,
    ),
    of_all(
        "surface_energy",
        "energy of free and wetted surface, against a dry wall",
        Quantity::Energy,
        |totals| totals.surface_energy,
    ),
    of_all("mass", "mass released so far", Quantity::Mass, |totals| totals.mass),
    of_all("momentum_x", "momentum along x", Quantity::Momentum, |totals| totals.momentum[0]),
    of_all("momentum_y", "momentum along y", Quantity::Momentum, |totals| totals.momentum[1]),
    of_all("momentum_z", "momentum along z", Quantity::Momentum, |totals| totals.momentum[2]),
    of_all(
        "heat_stored",
        "heat gained since the release, negative when cooled",
        Quantity::Energy,
        |totals| totals.heat - totals.heat_released,
    ),
    of_all(
        "heat_drift",
        "heat stored and given to the wall, together: zero but for rounding",
        Quantity::Energy,
        |totals| totals.heat - totals.heat_released + totals.heat_to_wall,
    ),
    of_all(
        "max_pressure",
        "highest pressure of a single particle, which rings and grows with resolution",
        Quantity::Stress,
        |totals| totals.max_pressure,
    ),
    of_all("max_speed", "highest speed of a particle", Quantity::Velocity, |totals| {
        totals.max_speed
    }),
    of_reader("min_density", "lowest density of a particle", Quantity::Density, |reader| {
        reader.totals().density_range[0] * reader.rest_density()
    }),
    of_reader("max_density", "highest density of a particle", Quantity::Density, |reader| {
        reader.totals().density_range[1] * reader.rest_density()
    }),
    of_all(
        "min_temperature",
        "lowest temperature of a particle",
        Quantity::Temperature,
        |totals| totals.temperature_range[0],
    ),
    of_all(
        "max_temperature",
        "highest temperature of a particle",
        Quantity::Temperature,
        |totals| totals.temperature_range[1],
    ),
    of_all("mean_temperature", "mean temperature by mass", Quantity::Temperature, |totals| {
        totals.mean_temperature
    }),
    of_reader(
        "particles",
        "number of particles, images at mirrors included",
        Quantity::Ratio,
        |reader| reader.copies() * reader.totals().particles,
    ),
    of_all("steps", "time steps made inside the unit", Quantity::Ratio, |totals| totals.steps),
    of_all(
        "stray_mass",
        "mass that has come off the body of fluid, in lumps below a tenth of a drop",
        Quantity::Mass,
        |totals| totals.stray_mass,
    ),
    of_reader(
        "stray_particles",
        "number of particles that have come off the body of fluid, images included",
        Quantity::Ratio,
        |reader| reader.copies() * reader.totals().stray_particles,
    ),
    above_a_wall(
        "spread_diameter",
        "diameter of the film on the wall, without holes and spray; zero before fluid is near it",
        Quantity::Length,
        Read::Totals(|totals| totals.spread_diameter),
    ),
    above_a_wall(
        "heat",
        "heat given to the wall since time zero",
        Quantity::Energy,
        Read::Totals(|totals| totals.heat_to_wall),
    ),
    above_a_wall(
        "heat_flow",
        "heat flow into the wall, mean over the last exchange",
        Quantity::HeatFlow,
        Read::Rate(|exchange| exchange.heat.iter().sum::<f64>() + exchange.heat_outside),
    ),
    above_a_wall(
        "impulse_x",
        "impulse along x given to the wall since time zero",
        Quantity::Momentum,
        Read::Totals(|totals| totals.impulse_to_wall[0]),
    ),
    above_a_wall(
        "impulse_y",
        "impulse along y given to the wall since time zero",
        Quantity::Momentum,
        Read::Totals(|totals| totals.impulse_to_wall[1]),
    ),
    above_a_wall(
        "impulse_z",
        "impulse along z given to the wall since time zero",
        Quantity::Momentum,
        Read::Totals(|totals| totals.impulse_to_wall[2]),
    ),
    above_a_wall(
        "force",
        "force into the wall, mean over the last exchange, which rings with the fluid's sound",
        Quantity::Force,
        Read::Rate(|exchange| {
            let pushes = exchange.impulse.iter().map(|impulse| -impulse[2]);
            pushes.sum::<f64>() - exchange.impulse_outside[2]
        }),
    ),
    on_demand("released", "drops released so far", |totals| totals.released),
    on_demand("waiting", "drops asked for that wait until their place is free", |totals| {
        totals.waiting
    }),
    yielding("yielded_fraction", "fraction of the mass that yields", Quantity::Ratio, |totals| {
        totals.yielded_fraction()
    }),
    yielding(
        "creep",
        "largest shear rate of fluid that does not yield, in the last time step: zero but for the solver's tolerance",
        Quantity::ShearRate,
        |totals| totals.creep,
    ),
    Total {
        key: "pressure_iterations",
        words: "iterations of pressure and viscosity in a time step, mean since the start",
        quantity: Quantity::Count,
        of: Offered::WithPressure,
        read: Read::Totals(|totals| totals.iterations / totals.steps.max(1.0)),
    },
    freezing("solid_fraction", "frozen fraction of the mass", Quantity::Ratio, |totals| {
        totals.solid_fraction
    }),
    freezing("frozen_mass", "frozen mass", Quantity::Mass, |totals| totals.frozen_mass),
    freezing(
        "latent_heat",
        "latent heat that frozen fluid has given off, and takes to melt again",
        Quantity::Energy,
        |totals| totals.latent_heat,
    ),
    freezing(
        "arrest_time",
        "time since which the layer of fluid at the wall has been frozen, so that its edge rests, zero while some of it is \
         liquid",
        Quantity::Time,
        |totals| totals.arrest_time,
    ),
    Total {
        key: "force_outside",
        words: "force beyond the edge of the solid, which does not act on it, mean over the last exchange",
        quantity: Quantity::Force,
        of: Offered::OnASolid,
        read: Read::Rate(|exchange| -exchange.impulse_outside[2]),
    },
];

const fn of_all(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&DropletTotals) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::All, read: Read::Totals(read) }
}

const fn of_reader(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&mut DropletReader) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::All, read: Read::Reader(read) }
}

const fn above_a_wall(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: Read,
) -> Total {
    Total { key, words, quantity, of: Offered::AboveAWall, read }
}

const fn on_demand(
    key: &'static str,
    words: &'static str,
    read: fn(&DropletTotals) -> f64,
) -> Total {
    Total { key, words, quantity: Quantity::Count, of: Offered::OnDemand, read: Read::Totals(read) }
}

const fn yielding(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&DropletTotals) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Yielding, read: Read::Totals(read) }
}

const fn freezing(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&DropletTotals) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Freezing, read: Read::Totals(read) }
}

/// Returns the totals that a droplet of a scene offers, each with its place in the table. In a plane model they are
/// amounts per metre of depth. No total of a moving fluid follows an input without delay.
pub fn offered_totals(scene: &Scene, name: &str) -> Vec<(usize, Descriptor)> {
    let coupled = scene.coupling_from(name).is_some();
    let stands = coupled || scene.wall_under(name).is_some();
    let is_plane = scene.droplet(name).is_some_and(|droplet| droplet.dimension == 2);
    let on_demand = scene.droplet(name).is_some_and(Droplet::is_on_demand);
    let yields =
        scene.droplet(name).is_some_and(|droplet| droplet.fluid.viscosity.yield_stress() > 0.0);
    let freezes = scene.freezing_of(name).is_some();
    let solves_pressure =
        (scene.droplet(name)).is_some_and(|droplet| droplet.pressure == PressureAdvance::Implicit);
    let is_offered = |total: &Total| match total.of {
        Offered::All => true,
        Offered::AboveAWall => stands,
        Offered::OnDemand => on_demand,
        Offered::OnASolid => coupled,
        Offered::Yielding => yields,
        Offered::WithPressure => solves_pressure,
        Offered::Freezing => freezes,
    };
    let totals = TOTALS.iter().enumerate().filter(|(_, total)| is_offered(total));
    let described = totals.map(|(place, &Total { key, words, quantity, .. })| {
        let quantity = if is_plane { quantity.per_depth() } else { quantity };
        (place, Descriptor { key, words, quantity, direct: Direct::Nothing })
    });
    described.collect()
}

/// Returns true if a total is the height of the fluid.
pub fn is_height(place: usize) -> bool {
    TOTALS[place].key == "height"
}

pub fn read(reader: &mut DropletReader, place: usize) -> f64 {
    match TOTALS[place].read {
        Read::Totals(of) => of(reader.totals()),
        Read::Rate(of) => {
            let exchange = reader.exchange();
            exchange.rate(of(exchange))
        }
        Read::Reader(of) => of(reader),
    }
}
