//! Walls of cells below bodies that fall: temperatures of cells as inputs, and readings of what cells receive.

use std::ops::Range;

use super::{Acts, BodyError, Descriptor, Direct, Link};
use crate::channel::Channel;
use crate::inputs::InputLayout;
use crate::port::{Domain, Surface, WallCells, WallExchange};
use crate::quantity::Quantity;
use crate::scene::{self, Footprint, Scene};

/// Partner with which a body that falls exchanges heat and momentum.
pub enum Below {
    /// Free space, or a rigid plane without cells.
    Nothing,
    Wall(Wall),
    /// Another body; `traction` is true if forces are transferred.
    Body {
        traction: bool,
    },
}

/// A wall whose cell temperatures are inputs.
pub struct Wall {
    /// Places of the temperatures among the inputs.
    pub inputs: Range<usize>,
    /// Area of each cell [m²].
    pub areas: Vec<f64>,
}

impl Below {
    /// Returns the partner below a body of a scene, and its cells; `on` holds the cells of a body below and the link
    /// with it.
    pub fn of(
        (scene, layout): (&Scene, &InputLayout),
        name: &str,
        on: Option<(WallCells, &Link)>,
    ) -> (Self, Option<WallCells>) {
        if let Some((cells, link)) = on {
            return (Self::Body { traction: link.traction }, Some(cells));
        }
        let Some(wall) = scene.wall_under(name) else { return (Self::Nothing, None) };
        let cells = cells_of(&scene.wall[wall].footprint);
        let dimension = if scene.body[name].is_plane() { 2 } else { 3 };
        let areas = cells.as_ref().map(|cells| cells.areas(Domain::whole(dimension)));
        let inputs = layout.walls[wall].clone();
        (Self::Wall(Wall { inputs, areas: areas.unwrap_or_default() }), cells)
    }

    /// The wall, if one lies below.
    pub fn wall(&self) -> Option<&Wall> {
        match self {
            Self::Wall(wall) => Some(wall),
            Self::Nothing | Self::Body { .. } => None,
        }
    }

    /// Refuses temperatures of a wall that are not above absolute zero.
    pub fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.wall().map_or(Ok(()), |wall| wall.check(inputs))
    }
}

impl Wall {
    /// Temperatures at the beginning and at the end of a step [K].
    pub fn over(&self, acts: &Acts) -> [Vec<f64>; 2] {
        [0.0, acts.duration].map(|time| acts.path.at(0, time)[self.inputs.clone()].to_vec())
    }

    /// The surface of the cells over a step.
    pub fn surface(&self, acts: &Acts) -> Surface {
        Surface::following(self.over(acts).each_ref().map(Vec::as_slice))
    }

    fn check(&self, inputs: &[f64]) -> Result<(), BodyError> {
        match self.inputs.clone().find(|&index| inputs[index] <= 0.0) {
            Some(index) => {
                let message = format!("{} K is not above absolute zero", inputs[index]);
                Err(BodyError::Input { index, message })
            }
            None => Ok(()),
        }
    }
}

/// Returns the cells of a wall's footprint; scenes with other footprints are refused.
fn cells_of(footprint: &Footprint) -> Option<WallCells> {
    match *footprint {
        Footprint::Rings { count, radius } => Some(WallCells::Rings { count, radius }),
        Footprint::Tiles { count, size } => Some(WallCells::Tiles { count, size }),
        _ => None,
    }
}

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
    /// Tiles under a body of three dimensions.
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
    pub fn is_offered(&self, scene: &Scene, wall: &scene::Wall) -> bool {
        let is_round = matches!(wall.footprint, Footprint::Rings { .. });
        match self.of {
            Offered::All => true,
            Offered::Rings => is_round,
            Offered::Tiles => !is_round,
            Offered::TilesInSpace => !is_round && !scene.body[&wall.under].is_plane(),
            Offered::Freezing => scene.freezing_of(&wall.under).is_some(),
        }
    }

    /// Returns true if a value is the mean over the last step.
    pub fn is_mean(&self) -> bool {
        matches!(self.read, Read::Mean(_))
    }

    /// Mean over the last step; refused for a quantity that is none.
    pub fn mean(
        &self,
        exchange: &WallExchange,
        cell: usize,
        wall: &Wall,
    ) -> Result<f64, BodyError> {
        let Read::Mean(amount) = self.read else { return Err(BodyError::NoSuchReading) };
        let area = if self.of_cells { wall.areas[cell] } else { 1.0 };
        Ok(exchange.rate(amount(exchange, cell)) / area)
    }
}
