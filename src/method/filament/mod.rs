//! A filament that a moving nozzle lays as a strand on a plate, as a line of segments.
//!
//! A segment is a piece of the strand of about a nozzle's volume: `π/4 D²` times the length of a cell. Its volume and
//! heat content balance exactly; its cross-section has one width and one temperature. `laying` makes segments from the
//! motion of the nozzle, `sections` has their sections and widths, `beneath` finds what they lie on (their `carriers`),
//! `stacks` cuts the exchange of heat of these into parts, `exchange` makes a part of one segment, `spreading` has the
//! law of their width, `cooling` that of their heat, `footprint` their place on the cells of the plate; `line` is a
//! step of all; `target` measures the distance of the centre line from a wanted line.

mod beneath;
mod carriers;
mod cooling;
mod exchange;
mod failure;
mod footprint;
mod laying;
mod line;
mod plan;
mod sections;
mod segment;
mod slices;
mod spreading;
mod stacks;
mod strand;
mod target;
#[cfg(test)]
mod tests;

pub use failure::Failure;
pub use laying::guard;
pub use line::{Around, Line, LineTotals};
pub use plan::LinePlan;
pub use segment::Segment;
pub use slices::{Sliced, Slicing};
pub use strand::Strand;
pub use target::{Deviation, Target};
