//! The linear system of a viscous step.

use super::super::cloud::Cloud;
use super::super::frozen::{Bodies, Bond, Pieces};
use super::super::loops::{PairSum, for_all_of};
use super::super::method::Method;
use super::super::neighbours::Block;
use super::fit::{Fit, Whitening};
use super::moments::Moments;
use super::pressure::PressureForces;
use super::rate::Axes;
use super::strain::{Elongation, Strain};
use super::stress::Stress;
use super::tensor::{Products, Square, times, transposed_times};
use super::weights::{SHAPE, Weights};
use crate::math::conjugate_gradients::Operator;
use crate::runtime::parallel::Team;

/// β, the weight of pairs' deviations from the fit.
const PAIRS: f64 = 4.0 / 3.0;

/// Viscosities of a particle over ρ₀c₀H.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// Of the deviator of the fitted strain rate.
    pub shear: f64,
    /// Of its part of the volume.
    pub volume: f64,
    /// Of what the fit leaves over.
    pub pairs: f64,
}

impl Moduli {
    pub fn newtonian(viscosity: f64) -> Self {
        Self { shear: viscosity, volume: viscosity, pairs: viscosity }
    }
}

/// Forces on a particle per volume, by fluid and by the wall.
pub type Forces = [[f64; 3]; 2];

/// Reactions of wall and nozzle to the fluid in a step.
pub struct Reactions {
    /// Accelerations by the wall; empty without one.
    pub by_wall: Vec<[f64; 3]>,
    /// Force of a nozzle on the particles in it, over ρ₀c₀²H².
    pub by_nozzle: [f64; 3],
}

/// The system `(m + dt A) x = b` of velocities, with `A u = ∂E/∂u` for a viscosity of each particle.
pub struct System<'a> {
    pub method: &'a Method,
    pub cloud: &'a Cloud,
    frozen: &'a Pieces,
    bodies: Bodies<'a>,
    blocks: &'a [Block],
    team: &'a Team,
    pub dt: f64,
    pub axes: Axes,
    weights: Weights,
    fits: Vec<Fit>,
    pub moduli: Vec<Moduli>,
    /// Matrices from the sums of elongations to the form of the forces, see [`Stress`].
    responses: Vec<Square<6>>,
    /// Pressure, where it is solved.
    pressure: Option<PressureForces<'a>>,
}

impl<'a> System<'a> {
    pub fn of(
        method: &'a Method,
        cloud: &'a Cloud,
        frozen: &'a Pieces,
        blocks: &'a [Block],
        dt: f64,
        moduli: Vec<Moduli>,
        team: &'a Team,
    ) -> Self {
        let dimension = method.dimension;
        let weights = Weights::of(dimension, method.spacing);
        let mut system = Self {
            method,
            cloud,
            frozen,
            bodies: frozen.bodies(cloud),
            blocks,
            team,
            dt,
            axes: Axes::of(dimension),
            weights,
            fits: Vec::new(),
            moduli,
            responses: Vec::new(),
            pressure: (method.solves_pressure)
                .then(|| PressureForces::of(method, cloud, blocks, team)),
        };
        let records = system.records(&vec![0.0; 3 * cloud.len()]);
        let pass = Moments { images: &method.images, records: &records, weights };
        let moments = system.over_pairs(&pass);
        let whitening = Whitening::of(products(method), weights.moment);
        system.fits = team.map(moments.len(), |i| whitening.fit(&moments[i]));
        system.responses = team.map(moments.len(), |i| system.response(i));
        system
    }

    /// Replaces the viscosities.
    pub fn set_moduli(&mut self, moduli: Vec<Moduli>) {
        self.moduli = moduli;
        self.responses = self.team.map(self.fits.len(), |i| self.response(i));
    }

    /// `Kᵀ C K − β b L` of a particle with its viscosities C and b.
    fn response(&self, i: usize) -> Square<6> {
        let (Fit { rates, pairs }, Moduli { shear, volume, pairs: rest }) =
            (&self.fits[i], self.moduli[i]);
        let weight = self.weight(i);
        let mut response = [[0.0; 6]; 6];
        for b in 0..6 {
            let column = self.axes.scaled(&std::array::from_fn(|a| rates[a][b]), shear, volume);
            let column = transposed_times(rates, &column);
            let form = |a: usize| column[a] - PAIRS * rest * pairs[a][b];
            (0..6).for_each(|a| response[a][b] = weight * form(a));
        }
        response
    }

    /// Weight of a particle in the dissipation.
    fn weight(&self, i: usize) -> f64 {
        self.frozen.bond(i).dissipation()
    }

    pub fn volume(&self, i: usize) -> f64 {
        self.cloud.volume(i)
    }

    /// Position, velocity, volume and viscosity of each particle.
    fn records(&self, velocity: &[f64]) -> Vec<[f64; 8]> {
        self.team.map(self.cloud.len(), |i| {
            let [x, y, z] = self.cloud.position[i];
            let [u, v, w] = [0, 1, 2].map(|a| velocity[3 * i + a]);
            [x, y, z, u, v, w, self.volume(i), self.weight(i) * self.moduli[i].pairs]
        })
    }

    /// Sums over the elongations of all pairs at some velocities.
    pub fn elongations(&self, velocity: &[f64]) -> Vec<Elongation> {
        let (images, records) = (&self.method.images, &self.records(velocity));
        let mut pairs = self.over_pairs(&Strain { images, records, weights: self.weights });
        if let Some(pressure) = &self.pressure {
            let rates = pressure.compressions(velocity);
            pairs.iter_mut().zip(rates).for_each(|(pairs, rate)| pairs.compression = rate);
        }
        pairs
    }

    /// Strain rate y of a particle.
    pub fn rate(&self, pairs: &[Elongation], i: usize) -> Products {
        times(&self.fits[i].rates, &pairs[i].rates)
    }

    /// Square of the shear rate that the fit of a particle leaves over.
    pub fn rest(&self, pairs: &[Elongation], i: usize) -> f64 {
        let Elongation { rates, squares, .. } = &pairs[i];
        let explained = times(&self.fits[i].pairs, rates);
        let explained: f64 = explained.iter().zip(rates).map(|(a, b)| a * b).sum();
        PAIRS * (squares / self.weights.moment - explained).max(0.0)
    }

    /// Forms of the forces under the viscosities of the system.
    pub fn forms(&self, pairs: &[Elongation]) -> Vec<Products> {
        self.team.map(pairs.len(), |i| times(&self.responses[i], &pairs[i].rates))
    }

    /// Forms of the forces under some stresses in place of those of the fitted strain rates.
    pub fn forms_under(&self, pairs: &[Elongation], stresses: &[Products]) -> Vec<Products> {
        self.team.map(pairs.len(), |i| {
            let form = transposed_times(&self.fits[i].rates, &stresses[i]);
            let explained = times(&self.fits[i].pairs, &pairs[i].rates);
            let rest = PAIRS * self.moduli[i].pairs;
            std::array::from_fn(|n| self.weight(i) * (form[n] - rest * explained[n]))
        })
    }

    /// Viscous forces per volume, by fluid and by the wall, with those of the pressure's rise over the step.
    pub fn forces(&self, pairs: &[Elongation], forms: &[Products]) -> Vec<Forces> {
        let records = self.team.map(pairs.len(), |i| {
            let ([x, y, z], [xx, yy, zz, xy, yz, _]) = (self.cloud.position[i], forms[i]);
            [x, y, z, xx, yy, zz, xy, yz]
        });
        let annexes = self.team.map(pairs.len(), |i| [forms[i][5], self.volume(i), 1.0, 0.0]);
        let (images, records, annexes) = (&self.method.images, &records[..], &annexes[..]);
        let weights = self.weights;
        let mut forces = self.over_pairs(&Stress { images, records, annexes, weights });
        let scale = PAIRS / self.weights.moment;
        self.team.for_each(&mut forces, |i, forces| {
            for (force, pair) in forces.iter_mut().zip(pairs[i].forces) {
                (0..3).for_each(|a| force[a] += scale * pair[a]);
            }
        });
        if let Some(pressure) = &self.pressure {
            let rises = self.team.map(pairs.len(), |i| self.dt * pairs[i].compression);
            let rising = pressure.forces(&rises);
            self.team.for_each(&mut forces, |i, forces| *forces = sum(*forces, rising[i]));
        }
        forces
    }

    /// Impulses of forces over the step, with those of the pressure before it.
    pub fn load(&self, forces: &[Forces]) -> Vec<f64> {
        let impulse = |i: usize| {
            let [fluid, wall] = self.with_pressure(i, forces[i]);
            [0, 1, 2].map(|a| self.dt * self.volume(i) * (fluid[a] + wall[a]))
        };
        (0..forces.len()).flat_map(impulse).collect()
    }

    /// Forces on a particle with those of the pressure before the step.
    fn with_pressure(&self, i: usize, forces: Forces) -> Forces {
        self.pressure.as_ref().map_or(forces, |pressure| sum(forces, pressure.before[i]))
    }

    /// Replaces impulses by those that move particles as pieces allow.
    pub fn reduce(&self, load: &mut [f64]) {
        if self.frozen.are_none() {
            return;
        }
        self.respond(load);
        let mass = &self.cloud.mass;
        load.iter_mut().enumerate().for_each(|(n, load)| *load *= mass[n / 3]);
    }

    /// Replaces impulses by the changes of velocity that they cause.
    fn respond(&self, load: &mut [f64]) {
        let velocities = load.as_chunks_mut::<3>().0;
        self.team.for_each(velocities, |i, load| {
            (0..3).for_each(|a| load[a] /= self.cloud.mass[i]);
        });
        self.bodies.project(velocities, self.team);
    }

    /// Computes the reactions of wall and nozzle that go with changes of velocities. The wall balances the forces of
    /// fluid on pieces that it holds, the nozzle all forces on the particles in it.
    pub fn reactions(&self, forces: &[Forces], changes: &[f64]) -> Reactions {
        let mut reactions = Reactions { by_wall: Vec::new(), by_nozzle: [0.0; 3] };
        let in_nozzle = |i: &usize| self.frozen.bond(*i) == Bond::Nozzle;
        for i in (0..forces.len()).filter(in_nozzle) {
            let [fluid, wall] = self.with_pressure(i, forces[i]);
            let given = &mut reactions.by_nozzle;
            (0..3).for_each(|a| given[a] -= self.volume(i) * (fluid[a] + wall[a]));
        }
        if self.method.wall.is_none() {
            return reactions;
        }
        reactions.by_wall = self.team.map(forces.len(), |i| {
            let [fluid, wall] = self.with_pressure(i, forces[i]);
            let force = match self.frozen.bond(i) {
                Bond::Wall | Bond::Asleep => fluid.map(|force| -force),
                Bond::Plane => [0.0; 3],
                Bond::None | Bond::Piece(_) | Bond::Nozzle => wall,
            };
            force.map(|force| force * self.volume(i) / self.cloud.mass[i])
        });
        if self.method.images.are_open() {
            self.balance(&mut reactions, changes);
        }
        reactions
    }

    /// Adds to the wall's accelerations what the solver's residual lacks, so that the wall receives the momentum that
    /// the fluid loses. Before any fluid is at the wall, the nozzle gives it.
    fn balance(&self, reactions: &mut Reactions, changes: &[f64]) {
        let mass = &self.cloud.mass;
        let Reactions { by_wall, by_nozzle } = reactions;
        let at_wall = |pull: &[f64; 3]| *pull != [0.0; 3];
        let pulled: f64 =
            by_wall.iter().zip(mass).filter(|(pull, _)| at_wall(pull)).map(|(_, m)| m).sum();
        let is_even = [self.method.even[0], self.method.even[1], false];
        for a in (0..3).filter(|&a| !is_even[a]) {
            let gained: f64 = mass.iter().enumerate().map(|(i, m)| m * changes[3 * i + a]).sum();
            let found: f64 = mass.iter().zip(&*by_wall).map(|(m, pull)| m * pull[a]).sum();
            let rest = gained / self.dt - found - by_nozzle[a];
            if pulled > 0.0 {
                let rest = rest / pulled;
                by_wall.iter_mut().filter(|pull| at_wall(pull)).for_each(|pull| pull[a] += rest);
            } else {
                by_nozzle[a] += rest;
            }
        }
    }

    fn over_pairs<P: PairSum<Output: Clone + Default>>(&self, pass: &P) -> Vec<P::Output> {
        let kind = self.method.pairs();
        for_all_of(SHAPE, pass, self.blocks, kind, self.team, Vec::new())
    }
}

fn sum(forces: Forces, others: Forces) -> Forces {
    [0, 1].map(|by| [0, 1, 2].map(|a| forces[by][a] + others[by][a]))
}

/// Products of coordinates that a model has; across the plane of a ring the odd ones cancel.
fn products(method: &Method) -> &'static [usize] {
    match (method.dimension, method.rings) {
        (2, _) => &[0, 2, 5],
        (_, true) => &[0, 1, 2, 5],
        (_, false) => &[0, 1, 2, 3, 4, 5],
    }
}

impl Operator for System<'_> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        let pairs = self.elongations(x);
        let forces = self.forces(&pairs, &self.forms(&pairs));
        self.team.for_each(out.as_chunks_mut::<3>().0, |i, out| {
            let [fluid, wall] = forces[i];
            for a in 0..3 {
                let force = self.volume(i) * (fluid[a] + wall[a]);
                out[a] = self.cloud.mass[i] * x[3 * i + a] - self.dt * force;
            }
        });
        self.reduce(out);
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        out.copy_from_slice(residual);
        self.respond(out);
    }
}
