//! The heat problem of a body of particles, from its faces and loads to steps in time.

use std::sync::OnceLock;

use super::lattice::{End, LatticeAxis};
use super::rows::{Lattice, Operator, Settings};
use crate::math::chebyshev::Evolution;
use crate::math::parallel;
use crate::math::sparse_rows::SparseRows;

/// What the particles are and what surrounds them; ends of the axes are set by the faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    pub axes: [LatticeAxis; 3],
    pub settings: Settings,
    /// ρc [J/(m³ K)]
    pub capacity: f64,
    /// k [W/(m K)]
    pub conductivity: f64,
    pub faces: Vec<Face>,
    /// Parts that the temperature splits into: odd or even about the low ends of x and y. The first
    /// is even about both.
    pub classes: Vec<[bool; 2]>,
    /// Number of copies of the lattice that make the body.
    pub copies: f64,
}

/// An end of an axis with a thermal condition; all others are insulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    pub axis: usize,
    pub high: bool,
    pub condition: Condition,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// Heat flux into the body [W/m²].
    Flux,
    /// Prescribed temperature.
    Held,
    /// Heat transfer coefficient [W/(m² K)].
    Convective(f64),
}

/// What drives the temperature during a step, all held constant.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// For each class, heat into the particles of the low and the high end of z [W]; empty for none.
    pub surface: &'a [[Vec<f64>; 2]],
    /// For each class and face: flux [W/m²], or temperature above the initial one [K].
    pub faces: &'a [Vec<f64>],
}

/// Heat that has passed since time zero [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    pub brought_in: f64,
    pub lost: f64,
}

/// What a problem will cost, estimated from its finest particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    pub particles: usize,
    /// Neighbours of a particle, itself included.
    pub neighbours: usize,
    /// Bound of the rates at which differences decay [1/s].
    pub bound: f64,
}

/// Everything known before time starts.
pub struct ParticleHeat {
    setup: Setup,
    threads: usize,
    /// Made when first needed, the even one at once.
    classes: Vec<OnceLock<Class>>,
}

/// The part of one symmetry class.
struct Class {
    lattice: Lattice,
    /// Rates [1/s]; rows of held particles are empty.
    matrix: SparseRows,
    bound: f64,
    inlets: Vec<Inlet>,
    /// Heat that leaves through held and convective faces, per kelvin of each particle [W/K].
    leak: Vec<f64>,
    fallback: usize,
}

/// An end of an axis through which heat comes in. What a particle of the face gets is shared with
/// those below it as the images of an inclined profile would share it.
struct Inlet {
    axis: usize,
    high: bool,
    /// Particles of the face.
    surface: Vec<usize>,
    /// Their shares in its area [m²].
    areas: Vec<f64>,
    /// For each particle of the face, `(particle, share)` of what comes in there; empty if held.
    shares: Vec<Vec<(usize, f64)>>,
}

/// Particles whose rows are computed at a time.
const BATCH: usize = 4096;

impl ParticleHeat {
    /// Finds neighbours and coefficients on at most `threads` threads.
    pub fn new(setup: Setup, threads: usize) -> Self {
        let classes = setup.classes.iter().map(|_| OnceLock::new()).collect();
        let problem = Self { setup, threads, classes };
        problem.class(0);
        problem
    }

    /// What `setup` will cost, without building it.
    pub fn cost(setup: &Setup) -> Cost {
        let lattice = lattice(setup, [false; 2]);
        let finest = lattice.axes.each_ref().map(|axis| {
            let scale = |&i: &usize| axis.scale(i);
            (0..axis.nodes.len()).min_by(|a, b| scale(a).total_cmp(&scale(b))).unwrap_or(0)
        });
        let row = |place| {
            let mut row = SparseRows::default();
            row.push(lattice.row(place).entries);
            row
        };
        let bound = row(finest).spectral_bound() / setup.capacity;
        let neighbours = row(lattice.counts().map(|count| count / 2)).entries();
        Cost { particles: lattice.particles(), neighbours, bound }
    }

    /// Number of particles whose corrected operator is near singular, so that the plain one stands
    /// in for it.
    pub fn fallback(&self) -> usize {
        self.class(0).fallback
    }

    /// Length of the part of a body's state that belongs here: temperatures of each class above the
    /// initial one, then the two totals.
    pub fn state_len(&self) -> usize {
        self.classes.len() * self.particles() + 2
    }

    /// Advances `state` by `dt` [s] under sources held constant, without error in time.
    pub fn advance(&self, state: &mut [f64], sources: &Sources, dt: f64) {
        let count = self.particles();
        let (contents, totals) = state.split_at_mut(self.classes.len() * count);
        for (index, content) in contents.chunks_exact_mut(count).enumerate() {
            let (surface, values) = (&sources.surface[index], &sources.faces[index]);
            let driven = values.iter().chain(surface.iter().flatten()).any(|&v| v != 0.0);
            if driven || content.iter().any(|&v| v != 0.0) {
                let passed = self.advance_class(index, content, surface, values, dt);
                if index == 0 {
                    // Parts that are odd carry no heat in sum.
                    totals[0] += self.setup.copies * passed.brought_in;
                    totals[1] += self.setup.copies * passed.lost;
                }
            }
        }
    }

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let lattice = &self.class(0).lattice;
        let content = state[..self.particles()].iter().enumerate();
        let sum: f64 = content.map(|(i, value)| lattice.volume(lattice.place(i)) * value).sum();
        self.setup.copies * self.setup.capacity * sum
    }

    pub fn totals(&self, state: &[f64]) -> Totals {
        let n = state.len();
        Totals { brought_in: state[n - 2], lost: state[n - 1] }
    }

    /// Temperature of all particles above the initial one, class by class [K], held ones at the
    /// present `faces`; empty for a class that is zero.
    pub fn temperatures(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let contents = state.chunks_exact(self.particles()).zip(faces).enumerate();
        contents
            .map(|(index, (content, values))| {
                if content.iter().chain(values).all(|&v| v == 0.0) {
                    return Vec::new();
                }
                let mut out = content.to_vec();
                self.hold(index, &mut out, values);
                out
            })
            .collect()
    }

    fn particles(&self) -> usize {
        self.setup.axes.iter().map(|axis| axis.nodes.len()).product()
    }

    fn class(&self, index: usize) -> &Class {
        self.classes[index].get_or_init(|| {
            Class::new(&self.setup, lattice(&self.setup, self.setup.classes[index]), self.threads)
        })
    }

    fn advance_class(
        &self,
        index: usize,
        content: &mut [f64],
        surface: &[Vec<f64>; 2],
        values: &[f64],
        dt: f64,
    ) -> Totals {
        let class = self.class(index);
        let raised = self.hold(index, content, values);
        let (power, passed) = class.inflow(&self.setup, surface, values);
        let capacity =
            |i: usize| self.setup.capacity * class.lattice.volume(class.lattice.place(i));
        let constant: Vec<f64> = power
            .iter()
            .enumerate()
            .map(|(i, p)| if *p == 0.0 { 0.0 } else { p / capacity(i) })
            .collect();
        let evolution = Evolution {
            apply: |row, u: &[f64]| class.matrix.row_product(row, u),
            bound: class.bound,
            constant: &constant,
            threads: self.threads,
        };
        let leak = if index == 0 { class.leak.as_slice() } else { &[] };
        let leaked = evolution.advance(content, leak, dt);
        let lost = leaked + passed.lost * dt - self.setup.capacity * raised;
        Totals { brought_in: passed.brought_in * dt, lost }
    }

    /// Gives held particles the values of their faces; returns `Σ V Δθ` [m³ K]. A particle on the
    /// edge of two held faces belongs to the one listed first.
    fn hold(&self, index: usize, content: &mut [f64], values: &[f64]) -> f64 {
        let lattice = &self.class(index).lattice;
        let odd = self.setup.classes[index];
        let mut raised = 0.0;
        let held = self.setup.faces.iter().zip(values).rev();
        for (face, &value) in held.filter(|(face, _)| face.condition == Condition::Held) {
            for i in face_particles(lattice, face.axis, face.high) {
                let place = lattice.place(i);
                let on_plane = (0..2).any(|a| odd[a] && place[a] == 0);
                let own = if on_plane { 0.0 } else { value };
                raised += lattice.volume(place) * (own - content[i]);
                content[i] = own;
            }
        }
        raised
    }
}

impl Class {
    fn new(setup: &Setup, lattice: Lattice, threads: usize) -> Self {
        let count = lattice.particles();
        let mut matrix = SparseRows::default();
        let mut edges = Edges::default();
        let mut fallback = 0;
        for first in (0..count).step_by(BATCH) {
            let rows = parallel::map(threads, BATCH.min(count - first), |i| {
                let place = lattice.place(first + i);
                (!lattice.is_held(place)).then(|| lattice.row(place))
            });
            for row in rows {
                let row = row.unwrap_or_default();
                fallback += usize::from(row.is_fallback);
                edges.push(row.gradient, row.held_slope, row.held);
                let rate = |(j, c)| (j, c / setup.capacity);
                matrix.push(row.entries.into_iter().map(rate).collect());
            }
        }
        let inlets = inlets(setup, &lattice, &edges.gradients);
        let leak = edges.leak(&lattice);
        let mut class = Self { lattice, matrix, bound: 0.0, inlets, leak, fallback };
        class.add_convection(setup);
        class.bound = class.matrix.spectral_bound();
        class
    }

    /// What the temperature of convective faces takes from the particles.
    fn add_convection(&mut self, setup: &Setup) {
        for face in &setup.faces {
            let Condition::Convective(coefficient) = face.condition else { continue };
            for inlet in self.inlets.iter().filter(|i| (i.axis, i.high) == (face.axis, face.high)) {
                for ((&i, area), shares) in
                    inlet.surface.iter().zip(&inlet.areas).zip(&inlet.shares)
                {
                    for &(j, share) in shares {
                        let capacity = setup.capacity * self.lattice.volume(self.lattice.place(j));
                        self.matrix.add(j, i, -coefficient * area * share / capacity);
                        self.leak[i] += coefficient * area * share;
                    }
                }
            }
        }
    }

    /// Heat into each particle that does not depend on temperatures [W], and what is brought in and
    /// lost at once [W]: on held particles, heat goes straight through.
    fn inflow(&self, setup: &Setup, surface: &[Vec<f64>; 2], values: &[f64]) -> (Vec<f64>, Totals) {
        let mut power = vec![0.0; self.lattice.particles()];
        let mut passed = Totals::default();
        for inlet in &self.inlets {
            let nodal = surface[usize::from(inlet.high)].iter().copied();
            if inlet.axis == 2 {
                inlet.spread(nodal, &mut power, &mut passed);
            }
            let own = |face: &Face| (face.axis, face.high) == (inlet.axis, inlet.high);
            for (face, &value) in setup.faces.iter().zip(values).filter(|(face, _)| own(face)) {
                match face.condition {
                    Condition::Flux => {
                        inlet.spread(
                            inlet.areas.iter().map(|a| value * a),
                            &mut power,
                            &mut passed,
                        );
                    }
                    Condition::Convective(h) => {
                        let mut gained = Totals::default();
                        let heat = inlet.areas.iter().map(|a| h * value * a);
                        inlet.spread(heat, &mut power, &mut gained);
                        // What the ambient gives to held particles they pass back to it.
                        passed.lost -= gained.brought_in - gained.lost;
                    }
                    Condition::Held => {}
                }
            }
        }
        (power, passed)
    }
}

impl Inlet {
    /// Adds the heat of each particle of the face [W] to those that share it.
    fn spread(&self, nodal: impl Iterator<Item = f64>, power: &mut [f64], passed: &mut Totals) {
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

/// What the rows say of the ends of the axes.
#[derive(Default)]
struct Edges {
    gradients: Vec<[[f64; 2]; 3]>,
    slopes: Vec<[[f64; 2]; 3]>,
    /// `(row, axis, end, entries)` of what is exchanged with held particles.
    held: Vec<(usize, usize, usize, Vec<(usize, f64)>)>,
}

impl Edges {
    fn push(
        &mut self,
        gradient: [[f64; 2]; 3],
        slope: [[f64; 2]; 3],
        held: [[Vec<(usize, f64)>; 2]; 3],
    ) {
        let row = self.gradients.len();
        self.gradients.push(gradient);
        self.slopes.push(slope);
        for (axis, ends) in held.into_iter().enumerate() {
            for (end, entries) in ends.into_iter().enumerate().filter(|(_, e)| !e.is_empty()) {
                self.held.push((row, axis, end, entries));
            }
        }
    }

    /// Heat that leaves through held faces per kelvin of each particle [W/K]: what the pairs of free
    /// and held particles exchange. With the corrected operator it is brought to `k A` for a unit
    /// gradient, column by column, which it is by itself at equal distances; the plain operator's
    /// stays as it is, because that is what its particles lose.
    fn leak(&self, lattice: &Lattice) -> Vec<f64> {
        let mut leak = vec![0.0; lattice.particles()];
        for (row, axis, end, entries) in &self.held {
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

    /// What passes a face under a unit gradient over what the column of a place exchanges with it.
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
}

/// Share of a column of particles in the area of a face [m²].
fn face_area(lattice: &Lattice, place: [usize; 3], axis: usize, end: usize) -> f64 {
    let own = &lattice.axes[axis];
    let at = own.nodes[if end == 0 { 0 } else { own.nodes.len() - 1 }];
    let round = if own.radial { std::f64::consts::TAU * at } else { 1.0 };
    let others = (0..3).filter(|&a| a != axis);
    others.map(|a| lattice.axes[a].measures[place[a]]).product::<f64>() * round
}

/// The lattice with the ends that faces and symmetry give it.
fn lattice(setup: &Setup, odd: [bool; 2]) -> Lattice {
    let mut axes = setup.axes.clone();
    for face in setup.faces.iter().filter(|face| face.condition == Condition::Held) {
        axes[face.axis].ends[usize::from(face.high)] = End::Held;
    }
    for (axis, _) in axes.iter_mut().zip(odd).filter(|&(_, odd)| odd) {
        axis.ends[0] = End::Held;
    }
    Lattice { axes, settings: setup.settings, conductivity: setup.conductivity }
}

/// Particles of an end of an axis, in ascending order.
fn face_particles(lattice: &Lattice, axis: usize, high: bool) -> Vec<usize> {
    let end = if high { lattice.counts()[axis] - 1 } else { 0 };
    (0..lattice.particles()).filter(|&i| lattice.place(i)[axis] == end).collect()
}

/// Both ends of z, where loads act, and all other faces that heat comes in by.
fn inlets(setup: &Setup, lattice: &Lattice, gradients: &[[[f64; 2]; 3]]) -> Vec<Inlet> {
    let faces = setup.faces.iter().filter(|f| f.axis < 2 && f.condition != Condition::Held);
    let ends = faces.map(|f| (f.axis, f.high)).chain([(2, false), (2, true)]);
    ends.map(|(axis, high)| Inlet::new(lattice, gradients, axis, high)).collect()
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
            // Per area of the face, not of their sum: exact for inclined profiles on any lattice. The
            // plain operator misses the second moment of its kernel; its shares make one whole.
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
}

#[cfg(test)]
mod tests;
