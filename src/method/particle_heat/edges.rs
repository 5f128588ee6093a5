//! Ends of the axes of a lattice: heat that enters and leaves through them.

use super::problem::{Condition, Face};
use super::rows::{Lattice, Operator, Row};
use crate::method::heat_totals::HeatTotals;

/// An end of an axis through which heat enters. The heat of a particle of the face is shared with those below it, as
/// the images of an inclined profile would share it.
pub struct Inlet {
    pub axis: usize,
    pub high: bool,
    /// Particles of the face.
    pub surface: Vec<usize>,
    /// Their shares in its area [m²].
    pub areas: Vec<f64>,
    /// For each particle of the face, `(particle, share)` of the heat that enters there; empty if held.
    pub shares: Vec<Vec<(usize, f64)>>,
}

/// Contributions of the rows to the ends of the axes.
#[derive(Default)]
pub struct Edges {
    /// Entries of all rows, see [`Row::gradient`] and [`Row::held_slope`].
    gradients: Vec<[[f64; 2]; 3]>,
    slopes: Vec<[[f64; 2]; 3]>,
    held: Vec<Exchange>,
}

/// Exchange of a row with the particles held at an end of an axis.
struct Exchange {
    row: usize,
    axis: usize,
    end: usize,
    entries: Vec<(usize, f64)>,
}

impl Edges {
    /// Moves the contributions of the next row here; its other entries remain.
    pub fn push(&mut self, row: &mut Row) {
        let index = self.gradients.len();
        self.gradients.push(row.gradient);
        self.slopes.push(row.held_slope);
        for (axis, ends) in std::mem::take(&mut row.held).into_iter().enumerate() {
            for (end, entries) in ends.into_iter().enumerate().filter(|(_, e)| !e.is_empty()) {
                self.held.push(Exchange { row: index, axis, end, entries });
            }
        }
    }

    /// Heat that leaves through held faces per kelvin of each particle [W/K]: the exchange of pairs of free and held
    /// particles. With the corrected operator it is scaled, column by column, to `k A` for a unit gradient, which it
    /// equals by itself at equal distances. With the plain operator it is not scaled, because the particles lose
    /// exactly that.
    pub fn leak(&self, lattice: &Lattice) -> Vec<f64> {
        let mut leak = vec![0.0; lattice.particles()];
        for Exchange { row, axis, end, entries } in &self.held {
            let place = lattice.place(*row);
            let factor = match lattice.settings.operator {
                Operator::Corrected => self.share_of_slope(lattice, place, *axis, *end),
                Operator::Plain => 1.0,
            };
            for (j, c) in entries {
                leak[*j] -= lattice.volume(place) * factor * c;
            }
        }
        leak
    }

    /// Flux through a face under a unit gradient, over the exchange of a place's column with it.
    fn share_of_slope(
        &self,
        lattice: &Lattice,
        mut place: [usize; 3],
        axis: usize,
        end: usize,
    ) -> f64 {
        let area = face_area(lattice, place, axis, end);
        let column = (0..lattice.counts()[axis]).map(|layer| {
            place[axis] = layer;
            lattice.volume(place) * self.slopes[lattice.index(place)][axis][end]
        });
        -lattice.conductivity * area / column.sum::<f64>()
    }

    /// Both ends of z, where loads act, and all other faces through which heat enters.
    pub fn inlets(&self, faces: &[Face], lattice: &Lattice) -> Vec<Inlet> {
        let faces = faces.iter().filter(|f| f.axis < 2 && f.condition != Condition::Held);
        let ends = faces.map(|f| (f.axis, f.high)).chain([(2, false), (2, true)]);
        ends.map(|(axis, high)| Inlet::new(lattice, &self.gradients, axis, high)).collect()
    }
}

impl Inlet {
    fn new(lattice: &Lattice, gradients: &[[[f64; 2]; 3]], axis: usize, high: bool) -> Self {
        let surface = face_particles(lattice, axis, high);
        let own = &lattice.axes[axis];
        let area = |&i: &usize| face_area(lattice, lattice.place(i), axis, usize::from(high));
        let areas = surface.iter().map(area).collect();
        let shares = |&i: &usize| {
            let mut place = lattice.place(i);
            if lattice.is_held(place) {
                return Vec::new();
            }
            let mut list = Vec::new();
            for layer in 0..lattice.counts()[axis] {
                place[axis] = if high { own.nodes.len() - 1 - layer } else { layer };
                let below = lattice.index(place);
                let gradient = gradients[below][axis][usize::from(high)];
                if gradient == 0.0 {
                    break;
                }
                list.push((below, lattice.volume(place) * gradient));
            }
            // Per area of the face, not of their sum: exact for inclined profiles on any lattice. The plain operator
            // misses the second moment of its kernel; its shares sum to one.
            let whole = match lattice.settings.operator {
                Operator::Corrected => lattice.conductivity * area(&i),
                Operator::Plain => list.iter().map(|(_, share)| share).sum(),
            };
            list.iter_mut().for_each(|(_, share)| *share /= whole);
            list
        };
        let shares = surface.iter().map(shares).collect();
        Self { axis, high, surface, areas, shares }
    }

    /// Adds the heat of each particle of the face [W] to the particles that share it.
    pub fn spread(
        &self,
        nodal: impl Iterator<Item = f64>,
        power: &mut [f64],
        passed: &mut HeatTotals,
    ) {
        for (heat, shares) in nodal.zip(&self.shares) {
            passed.brought_in += heat;
            if shares.is_empty() {
                passed.lost += heat;
            }
            for &(particle, share) in shares {
                power[particle] += heat * share;
            }
        }
    }
}

/// Particles of an end of an axis, in ascending order.
pub fn face_particles(lattice: &Lattice, axis: usize, high: bool) -> Vec<usize> {
    let end = if high { lattice.counts()[axis] - 1 } else { 0 };
    (0..lattice.particles()).filter(|&i| lattice.place(i)[axis] == end).collect()
}

/// Share of a column of particles in the area of a face [m²].
fn face_area(lattice: &Lattice, place: [usize; 3], axis: usize, end: usize) -> f64 {
    let own = &lattice.axes[axis];
    let at = own.nodes[if end == 0 { 0 } else { own.nodes.len() - 1 }];
    let round = if own.radial { std::f64::consts::TAU * at } else { 1.0 };
    let others = (0..3).filter(|&a| a != axis);
    others.map(|a| lattice.axes[a].measures[place[a]]).product::<f64>() * round
}
