//! Contact of a body with the cells of the face below over a step.

use std::collections::BTreeMap;

use super::super::contact::Touch;
use super::super::load::present_area;
use super::super::{Deformable, Film};
use crate::port::{Cover, Surface};

/// Present area with which each node has touched each cell, times the time of contact [m² s], images included.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contacts(BTreeMap<(u32, usize), f64>);

impl Contacts {
    /// Adds the contact of a body displaced by u over a time [s]; `cover` returns the cells below a spot, by its
    /// number.
    pub fn add(
        &mut self,
        body: &Deformable,
        u: &[[f64; 3]],
        touch: &Touch,
        dt: f64,
        cover: impl Fn(usize) -> Cover,
    ) {
        for (number, spot) in touch.spots.iter().enumerate() {
            let exposed = dt * present_area(body, spot.point, u);
            for (cell, weight) in cover(number).cells {
                for value in body.space.boundary.samples.row(spot.point) {
                    let sum = self.0.entry((value.node, cell)).or_default();
                    *sum += exposed * weight * value.value;
                }
            }
        }
    }

    /// Cell of each film of [`Self::films`].
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        self.0.keys().map(|&(_, cell)| cell)
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
        let film = |(&(node, cell), &exposed): (&(u32, usize), &f64)| Film {
            node: node as usize,
            conductance: through * exposed / (duration * copies),
            ambient: [first[cell], last[cell]],
        };
        self.0.iter().map(film).collect()
    }
}
