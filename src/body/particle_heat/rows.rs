//! The second derivative at each particle of a lattice as a list of coefficients.

use super::lattice::{LatticeAxis, Sighting};
use super::operators::{Neighbour, Tensor, corrected, plain, renormalisation};
use crate::kernel::Kernel;

/// How the heat equation is brought to particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    pub operator: Operator,
    pub kernel: Kernel,
    /// Support radius in distances of particles, along each axis its own.
    pub support: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Exact for quadratics on any set of particles.
    Corrected,
    /// Conserves heat pair by pair; for particles at equal distances.
    Plain,
}

/// Particles at the crossings of three axes; the first index runs fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    pub axes: [LatticeAxis; 3],
    pub settings: Settings,
}

/// `∇²T` at one particle [K/m²]: `Σ_j c_j (T_j − T_i)`, images among the j.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// `(particle, factor)`; entries of one particle add up.
    pub entries: Vec<(usize, f64)>,
    /// The part of the entries that is exchanged with held particles and images beyond them, by the
    /// axis and end that hold.
    pub held: [[Vec<(usize, f64)>; 2]; 3],
    /// What this part is where temperature is the distance from the held end [1/m].
    pub held_slope: [[f64; 2]; 3],
    /// What a unit gradient [K/m] out of the low and high end of each axis adds [1/m²].
    pub gradient: [[f64; 2]; 3],
    /// Whether the plain operator stands in for the corrected one.
    pub is_fallback: bool,
}

impl Lattice {
    pub fn counts(&self) -> [usize; 3] {
        self.axes.each_ref().map(|axis| axis.nodes.len())
    }

    pub fn particles(&self) -> usize {
        self.counts().iter().product()
    }

    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.counts();
        i + nx * (j + ny * k)
    }

    pub fn place(&self, index: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts();
        [index % nx, index / nx % ny, index / (nx * ny)]
    }

    /// Volume of a particle [m³]: its share in the body's.
    pub fn volume(&self, place: [usize; 3]) -> f64 {
        (0..3).map(|a| self.axes[a].measures[place[a]]).product()
    }

    pub fn is_held(&self, place: [usize; 3]) -> bool {
        (0..3).any(|a| self.axes[a].holds(place[a]))
    }

    /// The coefficients at one particle.
    ///
    /// Every particle measures each axis in its own unit, half the distance of its neighbours, so
    /// that its support holds as many neighbours along every axis however the lattice is graded.
    pub fn row(&self, place: [usize; 3]) -> Row {
        let axes: Vec<usize> = (0..3).filter(|&a| self.axes[a].is_modelled()).collect();
        let reach = self.settings.support;
        let seen = [0, 1, 2].map(|a| self.axes[a].sightings(place[a], reach));
        let (mut neighbours, mut sightings) = (Vec::new(), Vec::new());
        for z in &seen[2] {
            for y in &seen[1] {
                for x in &seen[0] {
                    let along = [x, y, z];
                    let mut offset = [0.0; 3];
                    for (slot, &a) in offset.iter_mut().zip(&axes) {
                        *slot = along[a].offset;
                    }
                    let volume = along.iter().map(|s| s.width).product();
                    let view = (self.settings.kernel, reach, axes.len());
                    if let Some(neighbour) = Neighbour::new(offset, volume, view) {
                        neighbours.push(neighbour);
                        sightings.push(along);
                    }
                }
            }
        }
        let (coefficients, is_fallback) = self.coefficients(place, &axes, &neighbours);
        let mut row = Row { is_fallback, ..Default::default() };
        for (c, along) in coefficients.into_iter().zip(sightings) {
            self.add(&mut row, place, c, along);
        }
        row
    }

    /// Coefficients of `Σ_a ∂²/∂x_a²` of all neighbours, and whether they are the fall-back's. On a
    /// radius r the term `1/r ∂/∂r` comes in, which is `∂²/∂r²` on the axis.
    fn coefficients(
        &self,
        place: [usize; 3],
        axes: &[usize],
        neighbours: &[Neighbour],
    ) -> (Vec<f64>, bool) {
        let mut tensor: Tensor = [[0.0; 3]; 3];
        for (slot, &a) in axes.iter().enumerate() {
            tensor[slot][slot] = self.axes[a].scale(place[a]).powi(-2);
        }
        let radius = self.axes[0].nodes[place[0]];
        let radial = self.axes[0].radial;
        if radial && radius == 0.0 {
            tensor[0][0] *= 2.0;
        }
        let dimension = axes.len();
        let exact = match self.settings.operator {
            Operator::Corrected => corrected(neighbours, dimension, &tensor),
            Operator::Plain => None,
        };
        let is_fallback = exact.is_none() && self.settings.operator == Operator::Corrected;
        let mut out = exact.unwrap_or_else(|| plain(neighbours, dimension, &tensor));
        if radial
            && radius > 0.0
            && let Some(b) = renormalisation(neighbours, dimension)
        {
            let slope = [1.0 / (radius * self.axes[0].scale(place[0])), 0.0, 0.0];
            for (c, extra) in out.iter_mut().zip(b.derivative(neighbours, slope)) {
                *c += extra;
            }
        }
        (out, is_fallback)
    }

    fn add(&self, row: &mut Row, place: [usize; 3], c: f64, [x, y, z]: [&Sighting; 3]) {
        let own = self.index(place);
        let first = row.entries.len();
        row.entries.push((own, -c));
        for &(k, factor_z) in &z.terms {
            for &(j, factor_y) in &y.terms {
                for &(i, factor_x) in &x.terms {
                    let factor = c * factor_x * factor_y * factor_z;
                    row.entries.push((self.index([i, j, k]), factor));
                }
            }
        }
        let along = [x, y, z];
        let ends = (0..3).flat_map(|a| [(a, 0), (a, 1)]).filter(|&(a, end)| along[a].held[end]);
        for (rank, (a, end)) in ends.enumerate() {
            if rank == 0 {
                row.held[a][end].extend_from_slice(&row.entries[first..]);
            }
            let axis = &self.axes[a];
            let distance = |&(node, factor): &(usize, f64)| factor * axis.distance(node, end);
            let other: f64 = along[a].terms.iter().map(distance).sum();
            row.held_slope[a][end] += c * (other - axis.distance(place[a], end));
        }
        for (gradient, sighting) in row.gradient.iter_mut().zip(along) {
            for (sum, distance) in gradient.iter_mut().zip(sighting.beyond) {
                // An image beyond an end that passes a gradient g is warmer by 2 g d.
                *sum += 2.0 * c * distance;
            }
        }
    }
}
