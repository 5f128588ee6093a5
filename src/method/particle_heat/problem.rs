//! The heat problem of a body of particles, from its faces and loads to time steps.

use super::edges::{Edges, Inlet, face_particles};
use super::lattice::{End, LatticeAxis};
use super::rows::{Lattice, Settings};
use crate::math::chebyshev::Evolution;
use crate::math::separable::dot;
use crate::math::sparse_rows::SparseRows;
use crate::method::heat_totals::HeatTotals;
use crate::runtime::allowance::{Allowance, Halt};
use crate::runtime::made_once::MadeOnce;
use crate::runtime::parallel;
use crate::runtime::thread::aside;
use crate::state::{Field, Layout, Per};

/// Particles and their surroundings; the faces set the ends of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    pub axes: [LatticeAxis; 3],
    pub settings: Settings,
    /// ρc [J/(m³ K)]
    pub capacity: f64,
    /// k [W/(m K)]
    pub conductivity: f64,
    pub faces: Vec<Face>,
    /// Symmetry classes of the temperature: odd or even about the low ends of x and y. The first is even about both.
    pub classes: Vec<[bool; 2]>,
    /// Number of copies of the lattice that form the body.
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

/// Driving terms of the temperature, or their time derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// For each class, heat into the particles of the low and the high end of z [W]; empty for none.
    pub surface: &'a [[Vec<f64>; 2]],
    /// For each class and face: flux [W/m²], or temperature above the initial one [K].
    pub faces: &'a [Vec<f64>],
}

/// Forecast cost of a problem, estimated from its finest particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    pub particles: usize,
    /// Number of neighbours of a particle, itself included.
    pub neighbours: usize,
    /// Upper bound of the decay rates [1/s].
    pub bound: f64,
}

/// Everything known before time starts.
pub struct ParticleHeat {
    setup: Setup,
    threads: usize,
    /// Classes, made when first needed; the even one immediately.
    classes: Vec<MadeOnce<Class>>,
}

/// The problem of one symmetry class.
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

/// Particles whose rows are computed at a time.
const BATCH: usize = 4096;

impl ParticleHeat {
    /// Finds neighbours and coefficients on at most `threads` threads.
    pub fn new(setup: Setup, threads: usize) -> Self {
        let classes = setup.classes.iter().map(|_| MadeOnce::new()).collect();
        let problem = Self { setup, threads, classes };
        problem.class(0);
        problem
    }

    /// Forecasts the cost of `setup` without building it.
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

    /// Number of particles with a nearly singular corrected operator, which the plain one replaces.
    pub fn fallback(&self) -> usize {
        self.class(0).fallback
    }

    /// The fields of a state: temperatures of each class, then totals.
    pub fn layout(&self) -> Layout {
        let words = "temperature above the initial one [K]";
        let rise = Field { name: "rise", words, per: Per::Particle, width: 1 };
        let classes = self.classes.iter();
        let layout = classes.fold(Layout::default(), |all, _| all.with(rise, self.particles()));
        HeatTotals::at_end_of(layout)
    }

    /// Advances `state` by `dt` [s] under sources that are polynomials in time, without time error. `sources` has one
    /// entry for their values at the beginning and one for each derivative. After a halt the values of `state` are
    /// undefined.
    pub fn advance(
        &self,
        state: &mut [f64],
        sources: &[Sources],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), Halt> {
        let count = self.particles();
        let (contents, totals) = state.split_at_mut(self.classes.len() * count);
        for (index, content) in contents.chunks_exact_mut(count).enumerate() {
            let last = sources.iter().rposition(|part| part.acts_on(index));
            if last.is_some() || content.iter().any(|&v| v != 0.0) {
                let sources = &sources[..=last.unwrap_or(0)];
                let passed = self.advance_class(index, content, (sources, dt), allowance)?;
                if index == 0 {
                    // Odd parts contain no total heat.
                    passed.times(self.setup.copies).add_to(totals);
                }
            }
        }
        Ok(())
    }

    /// Time derivative of a state, laid out like the state itself; `sources` act now and `rates` are their time
    /// derivatives. It is that of the equations, with held particles at the present values of their faces.
    pub fn rates(&self, state: &[f64], sources: &Sources, rates: &Sources) -> Vec<f64> {
        let count = self.particles();
        let mut out = Vec::with_capacity(state.len());
        let mut totals = HeatTotals::default();
        for (index, content) in state.chunks_exact(count).take(self.classes.len()).enumerate() {
            let driven = sources.acts_on(index) || rates.acts_on(index);
            if !driven && content.iter().all(|&v| v == 0.0) {
                out.resize(out.len() + count, 0.0);
                continue;
            }
            let class = self.class(index);
            let mut held = content.to_vec();
            self.hold(index, &mut held, &sources.faces[index]);
            let (mut rate, passed) = self.drive(index, sources, Some(rates));
            parallel::for_each(self.threads, &mut rate, |row, rate| {
                *rate += class.matrix.row_product(row, &held);
            });
            if index == 0 {
                let lost = dot(&class.leak, &held) + passed.lost - self.held_heat(class, &rate);
                totals = HeatTotals {
                    brought_in: self.setup.copies * passed.brought_in,
                    lost: self.setup.copies * lost,
                };
            }
            out.extend(rate);
        }
        out.extend([totals.brought_in, totals.lost]);
        out
    }

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let lattice = &self.class(0).lattice;
        let content = state[..self.particles()].iter().enumerate();
        let sum: f64 = content.map(|(i, value)| lattice.volume(lattice.place(i)) * value).sum();
        self.setup.copies * self.setup.capacity * sum
    }

    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        HeatTotals::read(state)
    }

    /// Temperature of all particles above the initial one, class by class [K], held ones at the present `faces`; empty
    /// for a class that is zero.
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
        self.classes[index].get_or_make(|| {
            let make = || lattice(&self.setup, self.setup.classes[index]);
            aside(|| Class::new(&self.setup, make(), self.threads))
        })
    }

    fn advance_class(
        &self,
        index: usize,
        content: &mut [f64],
        (sources, dt): (&[Sources], f64),
        allowance: &Allowance,
    ) -> Result<HeatTotals, Halt> {
        let class = self.class(index);
        let before = self.held_heat(class, content);
        self.hold(index, content, &sources[0].faces[index]);
        let mut passed = HeatTotals::default();
        let mut drives = Vec::with_capacity(sources.len());
        let mut weight = 1.0;
        for (k, source) in sources.iter().enumerate() {
            let (drive, rate) = self.drive(index, source, sources.get(k + 1));
            drives.push(drive);
            // ∫ t^k/k! dt
            weight *= dt / (k + 1) as f64;
            passed.brought_in += weight * rate.brought_in;
            passed.lost += weight * rate.lost;
        }
        let evolution = Evolution {
            apply: |row, u: &[f64]| class.matrix.row_product(row, u),
            bound: class.bound,
            sources: &drives,
            threads: self.threads,
        };
        let leak = if index == 0 { class.leak.as_slice() } else { &[] };
        let leaked = evolution.advance(content, leak, dt, allowance)?;
        passed.lost += leaked - (self.held_heat(class, content) - before);
        Ok(passed)
    }

    /// Rate of the temperatures due to `source` [K/s], and the heat flows that it adds and removes directly [W]. Held
    /// particles follow their faces, whose rates are in `next`.
    fn drive(
        &self,
        index: usize,
        source: &Sources,
        next: Option<&Sources>,
    ) -> (Vec<f64>, HeatTotals) {
        let class = self.class(index);
        let (mut rate, passed) =
            class.inflow(&self.setup, &source.surface[index], &source.faces[index]);
        for (i, power) in rate.iter_mut().enumerate().filter(|(_, power)| **power != 0.0) {
            *power /= self.setup.capacity * class.lattice.volume(class.lattice.place(i));
        }
        if let Some(next) = next {
            self.hold(index, &mut rate, &next.faces[index]);
        }
        (rate, passed)
    }

    /// Sets held particles to the values of their faces. A particle on the edge of two held faces belongs to the one
    /// listed first.
    fn hold(&self, index: usize, content: &mut [f64], values: &[f64]) {
        let lattice = &self.class(index).lattice;
        let odd = self.setup.classes[index];
        let held = self.setup.faces.iter().zip(values).rev();
        for (face, &value) in held.filter(|(face, _)| face.condition == Condition::Held) {
            for i in face_particles(lattice, face.axis, face.high) {
                let place = lattice.place(i);
                let on_plane = (0..2).any(|a| odd[a] && place[a] == 0);
                content[i] = if on_plane { 0.0 } else { value };
            }
        }
    }

    /// Heat in the held particles of one copy of the lattice [J], or its rate from theirs.
    fn held_heat(&self, class: &Class, content: &[f64]) -> f64 {
        let held = content.iter().enumerate().filter_map(|(i, value)| {
            let place = class.lattice.place(i);
            class.lattice.is_held(place).then(|| class.lattice.volume(place) * value)
        });
        self.setup.capacity * held.sum::<f64>()
    }
}

impl Sources<'_> {
    /// Returns true if any source of a class is nonzero.
    fn acts_on(&self, index: usize) -> bool {
        let mut values = self.faces[index].iter().chain(self.surface[index].iter().flatten());
        values.any(|&v| v != 0.0)
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
                let mut row = row.unwrap_or_default();
                fallback += usize::from(row.is_fallback);
                edges.push(&mut row);
                let rate = |(j, c)| (j, c / setup.capacity);
                matrix.push(row.entries.into_iter().map(rate).collect());
            }
        }
        let inlets = edges.inlets(&setup.faces, &lattice);
        let leak = edges.leak(&lattice);
        let mut class = Self { lattice, matrix, bound: 0.0, inlets, leak, fallback };
        class.add_convection(setup);
        class.bound = class.matrix.spectral_bound();
        class
    }

    /// Adds the heat loss of convective faces, proportional to the particles' temperature.
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
                    }
                    if !shares.is_empty() {
                        self.leak[i] += coefficient * area;
                    }
                }
            }
        }
    }

    /// Heat into each particle, independent of temperatures [W], and the total heat flows that enter and leave directly
    /// [W]: heat into held particles leaves at once.
    fn inflow(
        &self,
        setup: &Setup,
        surface: &[Vec<f64>; 2],
        values: &[f64],
    ) -> (Vec<f64>, HeatTotals) {
        let mut power = vec![0.0; self.lattice.particles()];
        let mut passed = HeatTotals::default();
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
                        let mut gained = HeatTotals::default();
                        let heat = inlet.areas.iter().map(|a| h * value * a);
                        inlet.spread(heat, &mut power, &mut gained);
                        // Held particles return the heat that they receive from the surroundings.
                        passed.lost -= gained.brought_in - gained.lost;
                    }
                    Condition::Held => {}
                }
            }
        }
        (power, passed)
    }
}

/// The lattice with the ends that faces and symmetry require.
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

#[cfg(test)]
mod tests;
