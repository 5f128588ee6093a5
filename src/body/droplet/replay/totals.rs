//! Readings of replayed drops.

use crate::body::{Descriptor, Direct};
use crate::method::record::ReplayTotals;
use crate::port::WallExchange;
use crate::quantity::Quantity;
use crate::scene::{Droplet, Scene};

/// A scalar and its reader.
struct Total {
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    of: Offered,
    read: Read,
}

/// Drops that offer a total.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    OnDemand,
    OnASolid,
}

#[derive(Clone, Copy)]
enum Read {
    Totals(fn(&ReplayTotals) -> f64),
    /// An amount of the last exchange, as a mean rate.
    Rate(fn(&WallExchange) -> f64),
}

const TOTALS: [Total; 14] = [
    total("mass", "mass released so far", Quantity::Mass, |totals| totals.mass),
    total(
        "heat_stored",
        "heat gained since the release, negative when cooled",
        Quantity::Energy,
        |totals| -totals.heat,
    ),
    total("heat", "heat given to the wall since time zero", Quantity::Energy, |totals| totals.heat),
    rated(
        "heat_flow",
        "heat flow into the wall, mean over the last exchange",
        Quantity::HeatFlow,
        |exchange| exchange.heat.iter().sum::<f64>() + exchange.heat_outside,
    ),
    total(
        "impulse_x",
        "impulse along x given to the wall since time zero",
        Quantity::Momentum,
        |totals| totals.impulse[0],
    ),
    total(
        "impulse_y",
        "impulse along y given to the wall since time zero",
        Quantity::Momentum,
        |totals| totals.impulse[1],
    ),
    total(
        "impulse_z",
        "impulse along z given to the wall since time zero",
        Quantity::Momentum,
        |totals| totals.impulse[2],
    ),
    rated(
        "force",
        "force into the wall, mean over the last exchange",
        Quantity::Force,
        |exchange| {
            let pushes = exchange.impulse.iter().map(|impulse| -impulse[2]);
            pushes.sum::<f64>() - exchange.impulse_outside[2]
        },
    ),
    total(
        "spread_diameter",
        "diameter of the film of the drop that came down last",
        Quantity::Length,
        |totals| totals.spread,
    ),
    total("active", "drops that fall or give heat or force", Quantity::Count, |totals| {
        totals.active
    }),
    total(
        "overlapping",
        "drops that came down on the film of another that was still giving heat or force",
        Quantity::Count,
        |totals| totals.overlapping,
    ),
    Total { of: Offered::OnDemand, ..count("released", "drops released so far", |t| t.released) },
    Total {
        of: Offered::OnDemand,
        ..count(
            "waiting",
            "drops asked for that wait: none, as these may come down at once",
            |totals| totals.asked - totals.released,
        )
    },
    Total {
        of: Offered::OnASolid,
        ..rated(
            "force_outside",
            "force beyond the edge of the solid, which does not act on it, mean over the last exchange",
            Quantity::Force,
            |exchange| -exchange.impulse_outside[2],
        )
    },
];

const fn total(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&ReplayTotals) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::All, read: Read::Totals(read) }
}

const fn count(key: &'static str, words: &'static str, read: fn(&ReplayTotals) -> f64) -> Total {
    total(key, words, Quantity::Count, read)
}

const fn rated(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&WallExchange) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::All, read: Read::Rate(read) }
}

/// Returns the totals that drops of a scene offer, each with its place in the table. No total follows an input without
/// delay.
pub fn offered_totals(scene: &Scene, name: &str) -> Vec<(usize, Descriptor)> {
    let on_demand = scene.droplet(name).is_some_and(Droplet::is_on_demand);
    let is_offered = |total: &Total| match total.of {
        Offered::All => true,
        Offered::OnDemand => on_demand,
        Offered::OnASolid => scene.coupling_from(name).is_some(),
    };
    let totals = TOTALS.iter().enumerate().filter(|(_, total)| is_offered(total));
    let described = totals.map(|(place, &Total { key, words, quantity, .. })| {
        (place, Descriptor { key, words, quantity, direct: Direct::Nothing })
    });
    described.collect()
}

/// Reads a total by its place in the table.
pub fn read<'a>(
    place: usize,
    totals: &ReplayTotals,
    exchange: impl FnOnce() -> &'a mut WallExchange,
) -> f64 {
    match TOTALS[place].read {
        Read::Totals(of) => of(totals),
        Read::Rate(of) => {
            let exchange = exchange();
            exchange.rate(of(exchange))
        }
    }
}
