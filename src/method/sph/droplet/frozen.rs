//! The frozen part of a fluid and its thickness on the wall.

use super::DropletSph;
use crate::method::sph::cloud::Cloud;
use crate::method::sph::images::sides;
use crate::method::sph::method::Method;
use crate::port::{Cover, Domain, WallCells};

/// Frozen fraction of each particle; empty for a fluid that stays liquid.
pub fn solid_fractions(method: &Method, cloud: &Cloud) -> Vec<f64> {
    let phases = method.phases.iter().zip(&cloud.content);
    phases.flat_map(|(phases, content)| content.iter().map(|&c| phases.frozen(c))).collect()
}

impl DropletSph {
    /// Thickness of the frozen fluid above each cell of the wall, as if spread evenly over the cell [m].
    pub fn frozen_on_wall(&self, state: &[f64]) -> Vec<f64> {
        let (method, cloud) = (&self.method, self.cloud(state));
        let Some(cells) = &method.wall else { return Vec::new() };
        let unit = method.units.mass() / self.plan.fluid.density;
        let mut volumes = vec![0.0; cells.len()];
        let fractions = solid_fractions(method, &cloud);
        for (i, fraction) in fractions.iter().enumerate().filter(|(_, part)| **part > 0.0) {
            let volume = unit * cloud.mass[i] * fraction;
            for (cell, part) in self.above(cells, method.place(cloud.position[i])).cells {
                for signs in sides(method.mirrors) {
                    for (image, share) in cells.image(cell, signs) {
                        volumes[image] += share * part * volume;
                    }
                }
            }
        }
        let areas = cells.areas(Domain::whole(self.plan.dimension));
        volumes.iter().zip(areas).map(|(volume, area)| volume / area).collect()
    }

    /// Cells below a particle at a place [m], which is as wide as the distance of particles.
    fn above(&self, cells: &WallCells, [x, y]: [f64; 2]) -> Cover {
        let half = 0.5 * self.plan.spacing;
        let about = |at: f64| [at - half, at + half];
        if self.plan.axisymmetric {
            let [inner, outer] = about(x);
            return cells.cover_ring([inner.max(0.0), outer]);
        }
        let across = if self.plan.dimension == 2 { [0.0; 2] } else { about(y) };
        cells.cover([about(x), across])
    }
}
