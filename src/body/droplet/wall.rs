//! Readings of the wall below a droplet.

use super::totals::rate;
use crate::body::{Descriptor, Direct};
use crate::channel::Channel;
use crate::port::WallExchange;
use crate::quantity::Quantity;
use crate::scene::{Footprint, Scene, Wall};

/// A scalar of each cell of a wall, or of the region beyond its cells.
pub struct WallQuantity {
    pub descriptor: Descriptor,
    /// True if each cell has a value of its own.
    pub of_cells: bool,
    of: Offered,
    /// The amount of a cell in the last step.
    amount: fn(&WallExchange, usize) -> f64,
}

/// Walls that offer a quantity.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    Rings,
    Tiles,
    /// Tiles under a droplet of three dimensions.
    TilesInSpace,
}

/// All quantities, in the order in which a unit lists them.
pub fn wall_quantities() -> &'static [WallQuantity] {
    &QUANTITIES
}

const QUANTITIES: [WallQuantity; 7] = [
    of_cells(Channel::HeatFlux, "heat flux into the wall", Offered::All, |e, cell| e.heat[cell]),
    of_cells(Channel::Pressure, "pressure on the wall", Offered::All, |e, cell| {
        -e.impulse[cell][2]
    }),
    of_cells(
        Channel::ShearR,
        "radial shear on the wall, outward positive",
        Offered::Rings,
        |e, cell| e.impulse[cell][0],
    ),
    of_cells(Channel::ShearX, "shear on the wall along x", Offered::Tiles, |e, cell| {
        e.impulse[cell][0]
    }),
    of_cells(Channel::ShearY, "shear on the wall along y", Offered::TilesInSpace, |e, cell| {
        e.impulse[cell][1]
    }),
    beyond("heat_flow_outside", "heat flow", Quantity::HeatFlow, |e, _| e.heat_outside),
    beyond("force_outside", "force", Quantity::Force, |e, _| -e.impulse_outside[2]),
];

const fn of_cells(
    channel: Channel,
    words: &'static str,
    of: Offered,
    amount: fn(&WallExchange, usize) -> f64,
) -> WallQuantity {
    let (key, quantity) = (channel.key(), channel.quantity());
    let descriptor = Descriptor { key, words, quantity, direct: Direct::Nothing };
    WallQuantity { descriptor, of_cells: true, of, amount }
}

const fn beyond(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    amount: fn(&WallExchange, usize) -> f64,
) -> WallQuantity {
    let descriptor = Descriptor { key, words, quantity, direct: Direct::Nothing };
    WallQuantity { descriptor, of_cells: false, of: Offered::All, amount }
}

impl WallQuantity {
    /// Returns true if a wall of a scene offers the quantity.
    pub fn is_offered(&self, scene: &Scene, wall: &Wall) -> bool {
        let is_round = matches!(wall.footprint, Footprint::Rings { .. });
        let in_space = scene.droplet(&wall.under).is_some_and(|droplet| droplet.dimension == 3);
        match self.of {
            Offered::All => true,
            Offered::Rings => is_round,
            Offered::Tiles => !is_round,
            Offered::TilesInSpace => !is_round && in_space,
        }
    }

    /// The mean over the last step.
    pub(super) fn read(&self, exchange: &WallExchange, cell: usize, areas: &[f64]) -> f64 {
        let area = if self.of_cells { areas[cell] } else { 1.0 };
        rate((self.amount)(exchange, cell), exchange) / area
    }
}
