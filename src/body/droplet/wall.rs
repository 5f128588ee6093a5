//! Readings of the wall below a droplet.

use super::reader::DropletReader;
use super::totals::rate;
use crate::body::{BodyError, Descriptor, Direct};
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
    read: Read,
}

enum Read {
    /// Mean rate of an amount of a cell in the last step.
    Mean(fn(&WallExchange, usize) -> f64),
    /// Thickness of the frozen fluid above a cell.
    Frozen,
}

/// Walls that offer a quantity.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    Rings,
    Tiles,
    /// Tiles under a droplet of three dimensions.
    TilesInSpace,
    /// Walls under a fluid that freezes.
    Freezing,
}

/// All quantities, in the order in which a unit lists them.
pub fn wall_quantities() -> &'static [WallQuantity] {
    &QUANTITIES
}

const QUANTITIES: [WallQuantity; 8] = [
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
    WallQuantity {
        descriptor: Descriptor {
            key: "frozen",
            words: "thickness of the frozen fluid on the wall, as if spread evenly over the cell",
            quantity: Quantity::Length,
            direct: Direct::Nothing,
        },
        of_cells: true,
        of: Offered::Freezing,
        read: Read::Frozen,
    },
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
    WallQuantity { descriptor, of_cells: true, of, read: Read::Mean(amount) }
}

const fn beyond(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    amount: fn(&WallExchange, usize) -> f64,
) -> WallQuantity {
    let descriptor = Descriptor { key, words, quantity, direct: Direct::Nothing };
    WallQuantity { descriptor, of_cells: false, of: Offered::All, read: Read::Mean(amount) }
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
            Offered::Freezing => scene.freezing_of(&wall.under).is_some(),
        }
    }

    /// Returns true if a value is the mean over the last step.
    pub fn is_mean(&self) -> bool {
        matches!(self.read, Read::Mean(_))
    }

    pub(super) fn read(&self, reader: &mut DropletReader, cell: usize, areas: &[f64]) -> f64 {
        match self.read {
            Read::Mean(amount) => {
                self.rate(amount(reader.exchange(), cell), (reader.exchange(), cell, areas))
            }
            Read::Frozen => reader.frozen_on_wall()[cell],
        }
    }

    /// The mean over the last step of drops that never freeze.
    pub(super) fn mean(
        &self,
        exchange: &WallExchange,
        cell: usize,
        areas: &[f64],
    ) -> Result<f64, BodyError> {
        match self.read {
            Read::Mean(amount) => Ok(self.rate(amount(exchange, cell), (exchange, cell, areas))),
            Read::Frozen => Err(BodyError::NoSuchReading),
        }
    }

    fn rate(&self, amount: f64, (exchange, cell, areas): (&WallExchange, usize, &[f64])) -> f64 {
        let area = if self.of_cells { areas[cell] } else { 1.0 };
        rate(amount, exchange) / area
    }
}
