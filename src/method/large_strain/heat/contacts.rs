//! Contact of a body with the cells of the face below over a step.

use std::collections::BTreeMap;

use super::super::contact::Touch;
use super::super::load::present_area;
use super::super::{Deformable, Film};
use crate::port::{Cover, Surface};

/// Present area with which each node has touched each place below, times the time of contact [m² s], images included.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contacts(BTreeMap<(u32, Place), f64>);

/// A place of the surface below.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    Cell(usize),
    /// The region beyond the cells of a wall, which is as warm as its nearest cell.
    BeyondCell(usize),
}

impl Place {
    /// The cell that has the temperature of the place.
    fn nearest(self) -> usize {
        match self {
            Self::Cell(cell) | Self::BeyondCell(cell) => cell,
        }
    }
}

impl Contacts {
    /// Adds the contact of a body displaced by u over a time [s]; `cover` returns the cells below a spot, by its
    /// number. Nothing lies beyond the cells if they `end` with the body.
    pub fn add(
        &mut self,
        (body, u): (&Deformable, &[[f64; 3]]),
        touch: &Touch,
        dt: f64,
        cover: impl Fn(usize) -> Cover,
        end: bool,
    ) {
        for (number, spot) in touch.spots.iter().enumerate() {
            let exposed = dt * present_area(body, spot.point, u);
            let Cover { cells, outside, nearest } = cover(number);
            let beyond = (Place::BeyondCell(nearest), if end { 0.0 } else { outside });
            let within = cells.into_iter().map(|(cell, weight)| (Place::Cell(cell), weight));
            for (place, weight) in within.chain([beyond]).filter(|(_, weight)| *weight > 0.0) {
                for value in body.space.boundary.samples.row(spot.point) {
                    let sum = self.0.entry((value.node, place)).or_default();
                    *sum += exposed * weight * value.value;
                }
            }
        }
    }

    /// Place of each film of [`Self::films`].
    pub fn places(&self) -> impl Iterator<Item = Place> {
        self.0.keys().map(|&(_, place)| place)
    }

    /// Films through which the nodes of one of `copies` images exchange heat with the cells over a step of this length
    /// [s], with a conductance [W/(m² K)] in series with the mean response of the surface, which warms meanwhile. In
    /// long steps the response counts as far as the surface does not overshoot the body's temperature.
    pub fn films(
        &self,
        surface: &Surface,
        conductance: f64,
        duration: f64,
        copies: f64,
    ) -> Vec<Film> {
        let [first, last] = [0.0, 1.0].map(|part| surface.free(part, duration));
        let mean = surface.response.of_growing_flux(duration) / duration;
        let end = surface.response.of_held_flux(duration);
        let through = 1.0 / (1.0 / conductance + mean).max(end);
        let film = |(&(node, place), &exposed): (&(u32, Place), &f64)| Film {
            node: node as usize,
            conductance: through * exposed / (duration * copies),
            ambient: [first[place.nearest()], last[place.nearest()]],
        };
        self.0.iter().map(film).collect()
    }
}
