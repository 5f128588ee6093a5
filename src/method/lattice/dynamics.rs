//! A strip that moves: explicit steps of kick, drift and kick (velocity Verlet), of second order in time.

mod run;

use super::equilibrium::product;
use super::fragments::fragments;
use super::frame::COMPONENTS;
use super::frequency::highest_frequency;
use super::held::{Held, Holding};
use super::link::{Deformation, Link};
use super::member::{Member, Pose, Strain};
use super::problem::{LatticePlan, at_particles, check_damage, links};
use super::{Broken, LatticeError, LatticeMotion, LatticeTotals, MotionTotals, Particles};
use crate::runtime::allowance::Allowance;
use run::{Part, Run};

/// Mass and damping of a strip that moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// [kg/m³]
    pub density: f64,
    /// Rate at which speeds fade [1/s].
    pub damping: f64,
}

/// A lattice of links that soften and break, with inertia.
pub struct MovingLattice {
    plan: LatticePlan,
    particles: Particles,
    links: Vec<Link>,
    members: Vec<Member>,
    holding: Holding,
    /// Inverse mass [1/kg] and rotary inertia [1/(kg m²)] of each particle.
    inverse: Vec<[f64; 2]>,
    /// First of the `slots` of each particle: twice the number of a link, and one more at its second end.
    first_slot: Vec<u32>,
    slots: Vec<u32>,
    damping: f64,
    /// Speed of waves in a bar [m/s].
    wave_speed: f64,
    /// Longest time step [s].
    longest: f64,
    threads: usize,
}

/// Name of the loop over time steps in messages.
const STEPS: &str = "time steps of a lattice";
/// Part of the energies by which those of a state may differ.
const ENERGY: f64 = 0.05;
/// Part of what is prescribed that a state may miss, and of damage.
const CHECKED: f64 = 1e-6;

impl MovingLattice {
    /// Part of the longest stable step that is taken.
    pub const SHARE: f64 = 0.8;

    pub fn new(
        plan: LatticePlan,
        Inertia { density, damping }: Inertia,
        threads: usize,
    ) -> Result<Self, LatticeError> {
        let particles = plan.strip.fill();
        let holding = Holding::new(&particles, &plan.strip, plan.support);
        let links = links(&plan, &particles, &holding.loaded);
        let mass = density * plan.sheet.thickness;
        let of_cell = |cell: &super::arrangement::Cell| {
            [1.0 / (mass * cell.area), 1.0 / (mass * cell.moment)]
        };
        let inverse: Vec<_> = particles.cells.iter().map(of_cell).collect();
        let (first_slot, slots) = slots(particles.places.len(), &links);
        Ok(Self {
            members: links.iter().map(Member::new).collect(),
            longest: Self::SHARE * 2.0 / highest_frequency(&links, &inverse),
            wave_speed: (plan.sheet.young / density).sqrt(),
            plan,
            particles,
            links,
            holding,
            inverse,
            first_slot,
            slots,
            damping,
            threads,
        })
    }

    pub fn plan(&self) -> &LatticePlan {
        &self.plan
    }

    pub fn particles(&self) -> &Particles {
        &self.particles
    }

    pub fn initial_state(&self) -> LatticeMotion {
        let count = self.particles.places.len();
        LatticeMotion {
            displacement: vec![[0.0; COMPONENTS]; count],
            velocity: vec![[0.0; COMPONENTS]; count],
            damage: vec![0.0; self.links.len()],
            ..LatticeMotion::default()
        }
    }

    /// Longest time step [s].
    pub fn longest_step(&self) -> f64 {
        self.longest
    }

    /// Mass [kg].
    pub fn mass(&self) -> f64 {
        self.inverse.iter().map(|[mass, _]| 1.0 / mass).sum()
    }

    /// Updates of a time step, for the allowance.
    pub fn work(&self) -> usize {
        self.particles.places.len()
    }

    /// Refuses a step that would exceed the allowed work.
    pub fn foresee(&self, duration: f64, allowance: &Allowance) -> Result<(), LatticeError> {
        Ok(allowance.foresee_step(duration, duration / self.longest, STEPS, self.work())?)
    }

    /// Moves the load at constant speed to a displacement [m] over a communication step of a duration [s]. After an
    /// error the state is unusable.
    pub fn advance(
        &self,
        motion: &mut LatticeMotion,
        target: f64,
        duration: f64,
        allowance: &Allowance,
    ) -> Result<(), LatticeError> {
        let speed = (target - motion.prescribed) / duration;
        if speed.abs() > self.wave_speed {
            let [speed, most] = [speed.abs(), self.wave_speed];
            return Err(LatticeError::TooFast { speed, most });
        }
        let steps = (duration / self.longest).ceil().max(1.0);
        allowance.foresee(steps, STEPS, self.work())?;
        let mut run = Run::new(self, motion, duration / steps);
        run.push(speed);
        run.strain();
        run.kick(Part::First, speed);
        for step in 1..=steps as usize {
            allowance.spend(1.0, STEPS, self.work())?;
            run.strain();
            run.kick(if step as f64 == steps { Part::Last } else { Part::Middle }, speed);
        }
        run.end();
        run.store(motion);
        (motion.prescribed, motion.speed) = (target, speed);
        motion.duration = duration;
        motion.steps += steps;
        self.balance(motion)
    }

    /// Refuses a motion that has lost its energy balance: steps were too long for what links did.
    fn balance(&self, motion: &LatticeMotion) -> Result<(), LatticeError> {
        let (missing, size) = self.missing(motion);
        // NaN also counts as lost.
        match missing.abs() <= size {
            true => Ok(()),
            false => Err(LatticeError::Unbalanced { missing }),
        }
    }

    /// Work without cause [J], and how much may be: a part of all energies, and `Σ dt² f²/(8 m)`, by which the kinetic
    /// energy of explicit steps differs from that which they conserve.
    fn missing(&self, motion: &LatticeMotion) -> (f64, f64) {
        let gone = motion.dissipated + motion.damped;
        let energies = [gone, self.elastic_energy(motion), self.kinetic_energy(motion)];
        let size: f64 = energies.iter().map(|energy| energy.abs()).sum();
        let run = Run::new(self, motion, self.longest).strained();
        let square = |(i, [mass, inertia]): (usize, &[f64; 2])| {
            let [x, z, moment] = self.force(i, &run.strained, [0.0; COMPONENTS]);
            (x * x + z * z) * mass + moment * moment * inertia
        };
        let unresolved: f64 = self.inverse.iter().enumerate().map(square).sum();
        let allowed =
            ENERGY * (size + motion.work.abs()) + 0.125 * self.longest * self.longest * unresolved;
        (motion.work - energies.iter().sum::<f64>(), allowed)
    }

    fn strains<'a>(&'a self, motion: &'a LatticeMotion) -> impl Iterator<Item = Strain> + 'a {
        let poses: Vec<_> =
            motion.displacement.iter().map(|&[u, w, angle]| Pose::new([u, w], angle)).collect();
        self.members
            .iter()
            .map(move |member| member.strain(member.ends.map(|i| &poses[i as usize])))
    }

    /// Elastic energy [J].
    pub fn elastic_energy(&self, motion: &LatticeMotion) -> f64 {
        let of_link = |((link, strain), damage): ((&Link, Strain), &f64)| {
            let parts = remaining(self.plan.closes, &strain.q, *damage);
            0.5 * dot(&scaled(link.elastic(&strain.q), parts), &strain.q)
        };
        self.links.iter().zip(self.strains(motion)).zip(&motion.damage).map(of_link).sum()
    }

    fn kinetic_energy(&self, motion: &LatticeMotion) -> f64 {
        let of_particle = |([u, w, spin], [mass, inertia]): (&[f64; 3], &[f64; 2])| {
            0.5 * ((u * u + w * w) / mass + spin * spin / inertia)
        };
        motion.velocity.iter().zip(&self.inverse).map(of_particle).sum()
    }

    pub fn totals(&self, motion: &LatticeMotion) -> MotionTotals {
        let all = motion.displacement.as_flattened();
        let opening = self.holding.mouth.as_ref().map(|mouth| product(mouth, all));
        MotionTotals {
            sums: LatticeTotals {
                displacement: motion.prescribed,
                opening,
                elastic_energy: self.elastic_energy(motion),
                broken: Broken::of(&self.particles, &motion.damage),
            },
            kinetic_energy: self.kinetic_energy(motion),
            fragments: self.fragments(motion),
        }
    }

    /// Number of parts that unbroken links connect.
    pub fn fragments(&self, motion: &LatticeMotion) -> usize {
        fragments(self.particles.places.len(), &self.links, &motion.damage)
    }

    /// Largest damage of the links of each particle, and the pressure in it [Pa].
    pub fn at_particles(&self, motion: &LatticeMotion) -> Vec<(f64, f64)> {
        let normal = |((link, strain), damage): ((&Link, Strain), &f64)| {
            let parts = remaining(self.plan.closes, &strain.q, *damage);
            scaled(link.elastic(&strain.q), parts)[0]
        };
        let strains = self.strains(motion);
        let normals = self.links.iter().zip(strains).zip(&motion.damage).map(normal);
        at_particles(&self.plan, &self.particles, (&self.links, &motion.damage), normals)
    }

    /// Refuses a state that breaks a law: damage that no stretch explains, supports that move, energy without cause.
    pub fn check(&self, motion: &LatticeMotion) -> Result<(), String> {
        check_damage(&self.links, &motion.damage)?;
        let least = -CHECKED * (motion.work.abs() + motion.dissipated.abs());
        if motion.steps < 0.0 || motion.duration < 0.0 || motion.damped < least {
            return Err("steps, their lengths and what damping takes are not negative".to_owned());
        }
        for (values, wanted) in
            [(&motion.displacement, motion.prescribed), (&motion.velocity, motion.speed)]
        {
            let all = values.as_flattened();
            let size =
                wanted.abs() + all.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            let misses = |held: &&Held| {
                let value = product(&held.parts, all);
                (value - held.rate * wanted).abs() > CHECKED * size
            };
            if self.holding.held.iter().any(|held| misses(&held)) {
                return Err("a support or the load moves otherwise than it is held".to_owned());
            }
        }
        let mut links = self.links.iter().zip(&self.members).zip(self.strains(motion));
        let grows = |((link, member), strain): ((&Link, &Member), Strain), damage: f64| {
            let stretch = member.stretch(&strain.q, self.plan.bending);
            stretch > member.onset && link.softening.damage(stretch).0 - damage > CHECKED
        };
        if motion.damage.iter().any(|&damage| links.next().is_some_and(|link| grows(link, damage)))
        {
            return Err("less damage than the stretch of a link causes".to_owned());
        }
        self.balance(motion).map_err(|error| error.to_string())
    }
}

/// Parts of axial and flexural stiffness that remain of a link.
#[inline(always)]
fn remaining(closes: bool, q: &Deformation, damage: f64) -> [f64; 2] {
    [if closes && q[0] < 0.0 { 1.0 } else { 1.0 - damage }, 1.0 - damage]
}

fn scaled(forces: Deformation, [axial, flexural]: [f64; 2]) -> Deformation {
    [axial * forces[0], flexural * forces[1], flexural * forces[2]]
}

fn dot(a: &Deformation, b: &Deformation) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Links of each particle: where its slots begin, and the slots.
fn slots(particles: usize, links: &[Link]) -> (Vec<u32>, Vec<u32>) {
    let mut of_particles: Vec<Vec<u32>> = vec![Vec::new(); particles];
    for (l, link) in links.iter().enumerate() {
        for (end, &i) in link.ends.iter().enumerate() {
            of_particles[i].push((2 * l + end) as u32);
        }
    }
    let mut first = vec![0];
    let mut slots = Vec::with_capacity(2 * links.len());
    for own in of_particles {
        slots.extend(own);
        first.push(slots.len() as u32);
    }
    (first, slots)
}
