//! Locations of a field's values: points of a grid, or cells of a footprint.

use super::grid::Grid;
use super::lookup::Place;
use super::types::{FaceName, Field, Footprint, Solid};

/// Locations of a field's values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sampling {
    /// At points.
    Points(Grid),
    /// Means over the cells of a footprint.
    Cells(FieldCells),
}

/// The cells of a field on a face, the top or the bottom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldCells {
    pub face: FaceName,
    pub footprint: Footprint,
    /// Position of the footprint's centre [m].
    pub at: [f64; 2],
}

impl Field {
    /// Locations of the values of a checked field in its body.
    ///
    /// # Panics
    /// If the scene has not been checked and the field is in no plane of the body.
    pub fn sampling(&self, solid: &Solid) -> Sampling {
        match (self.body_and_place(), self.footprint) {
            ((_, Place::Face(face)), Some(footprint)) => {
                Sampling::Cells(FieldCells { face, footprint, at: self.at.unwrap_or_default() })
            }
            _ => Sampling::Points(Grid::of(self, solid)),
        }
    }
}
