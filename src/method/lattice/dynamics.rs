//! A strip that moves: explicit steps of kick, drift and kick (velocity Verlet), of second order in time.

use super::equilibrium::product;
use super::fragments::fragments;
use super::frame::COMPONENTS;
use super::frequency::highest_frequency;
use super::held::{Held, Holding};
use super::link::{Deformation, Link};
use super::member::{EndForces, Member, Pose, Strain};
use super::problem::{LatticePlan, at_particles, check_damage, links};
use super::{Broken, LatticeError, LatticeMotion, LatticeTotals, MotionTotals, Particles};
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

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
/// Links or particles that one thread computes at a time.
const BLOCK: usize = 2048;
/// Part of the critical damping with which faces of cracks meet: they part at half of the speed.
const RESTITUTION_DAMPING: f64 = 0.2;
/// Part of the energies by which those of a state may differ.
const ENERGY: f64 = 0.05;
/// Part of what is prescribed that a state may miss, and of damage.
const CHECKED: f64 = 1e-6;

/// A particle in a loop, one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Mover {
    pose: Pose,
    angle: f64,
    velocity: [f64; COMPONENTS],
}

/// A link in a loop.
#[derive(Debug, Clone, Copy)]
struct Strained {
    forces: EndForces,
    damage: f64,
    /// Stretch up to which damage does not grow [1].
    reached: f64,
    /// Force of the contact's dashpot, positive in tension [N], and the rate of opening that it refers to [m/s].
    dashpot: f64,
    rate: f64,
}

/// One change of all velocities: forces act for a time, damping fades speeds, and forces act for another time [s].
#[derive(Debug, Clone, Copy)]
struct Kick {
    before: f64,
    fading: f64,
    after: f64,
}

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
        run.count_contact();
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
            fragments: fragments(self.particles.places.len(), &self.links, &motion.damage),
        }
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

/// Place of a kick in a communication step, which begins and ends between two half kicks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    First,
    Middle,
    Last,
}

/// A communication step under way.
struct Run<'a> {
    of: &'a MovingLattice,
    movers: Vec<Mover>,
    strained: Vec<Strained>,
    /// Forces of supports and load on each particle.
    outside: Vec<[f64; COMPONENTS]>,
    team: Team,
    /// Time step [s].
    dt: f64,
    /// Time for which the present forces have acted [s].
    acted: f64,
    work: f64,
    impulse: f64,
    dissipated: f64,
    damped: f64,
}

impl<'a> Run<'a> {
    fn new(of: &'a MovingLattice, motion: &LatticeMotion, dt: f64) -> Self {
        let moved = motion.displacement.iter().zip(&motion.velocity);
        let mover = |(&[u, w, angle], &velocity): (&[f64; 3], &[f64; 3])| Mover {
            pose: Pose::new([u, w], angle),
            angle,
            velocity,
        };
        let strained = |(&damage, member): (&f64, &Member)| Strained {
            forces: [0.0; 4],
            damage,
            reached: if damage < 1.0 { member.onset } else { f64::INFINITY },
            dashpot: 0.0,
            rate: 0.0,
        };
        Self {
            of,
            movers: moved.map(mover).collect(),
            strained: motion.damage.iter().zip(&of.members).map(strained).collect(),
            outside: vec![[0.0; COMPONENTS]; motion.displacement.len()],
            team: Team::new(of.threads),
            dt,
            acted: 0.0,
            work: 0.0,
            impulse: 0.0,
            dissipated: 0.0,
            damped: 0.0,
        }
    }

    /// The same with the forces of all links.
    fn strained(mut self) -> Self {
        self.strain();
        self
    }

    fn store(&self, motion: &mut LatticeMotion) {
        for (mover, (displacement, velocity)) in
            self.movers.iter().zip(motion.displacement.iter_mut().zip(&mut motion.velocity))
        {
            let [u, w] = mover.pose.moved;
            (*displacement, *velocity) = ([u, w, mover.angle], mover.velocity);
        }
        motion.damage.iter_mut().zip(&self.strained).for_each(|(own, new)| *own = new.damage);
        motion.work += self.work;
        motion.impulse = self.impulse;
        motion.dissipated += self.dissipated;
        motion.damped += self.damped;
    }

    /// Inverse mass of a component.
    fn inverse(&self, component: usize) -> f64 {
        self.of.inverse[component / COMPONENTS][usize::from(component % COMPONENTS == 2)]
    }

    /// Sets what is held to the speed of the load [m/s] at once, as a blow does.
    fn push(&mut self, speed: f64) {
        let of = self.of;
        for held in &of.holding.held {
            let value = |(at, part): &(usize, f64)| {
                part * self.movers[at / COMPONENTS].velocity[at % COMPONENTS]
            };
            let before: f64 = held.parts.iter().map(value).sum();
            let now = held.rate * speed;
            let blow = (now - before) / self.compliance(held);
            for &(at, part) in &held.parts {
                let change = blow * part * self.inverse(at);
                self.movers[at / COMPONENTS].velocity[at % COMPONENTS] += change;
            }
            self.work += 0.5 * blow * (before + now);
            self.impulse += held.rate * blow;
        }
    }

    /// Speed of a combination over the impulse on it [1/kg].
    fn compliance(&self, held: &Held) -> f64 {
        held.parts.iter().map(|&(at, part)| part * part * self.inverse(at)).sum()
    }

    /// Computes the forces of all links, and lets damage grow.
    fn strain(&mut self) {
        self.count_contact();
        let (of, movers, dt) = (self.of, &self.movers, self.dt);
        let (bending, closes) = (of.plan.bending, of.plan.closes);
        let mut blocks: Vec<_> = self.strained.chunks_mut(BLOCK).enumerate().collect();
        let dissipated = self.team.map_each(&mut blocks, |(number, block)| {
            let first = *number * BLOCK;
            let mut dissipated = 0.0;
            let members = &of.members[first..first + block.len()];
            for (k, (member, strained)) in members.iter().zip(block.iter_mut()).enumerate() {
                let ends = member.ends.map(|i| &movers[i as usize]);
                let strain = member.strain(ends.map(|end| &end.pose));
                let stretch = member.stretch(&strain.q, bending);
                if stretch > strained.reached {
                    dissipated += of.grow((first + k, stretch), &strain.q, ends, dt, strained);
                }
                let parts = remaining(closes, &strain.q, strained.damage);
                strained.forces = member.forces(&strain, parts);
                strained.dashpot = 0.0;
                if closes && strain.q[0] < 0.0 && strained.damage > 0.0 {
                    of.meet(member, &strain, ends, strained);
                }
            }
            dissipated
        });
        self.dissipated += dissipated.iter().sum::<f64>();
    }

    /// Counts what the dashpots of contacts have taken with the present forces: their work at the mean of the rates
    /// before and after.
    fn count_contact(&mut self) {
        let (of, movers, acted) = (self.of, &self.movers, self.acted);
        let taken = |(strained, member): (&Strained, &Member)| {
            if strained.dashpot == 0.0 {
                return 0.0;
            }
            let ends = member.ends.map(|i| &movers[i as usize]);
            let strain = member.strain(ends.map(|end| &end.pose));
            let rate = member.opening_rate(&strain, ends.map(Mover::speed));
            0.5 * strained.dashpot * (strained.rate + rate) * acted
        };
        self.damped += self.strained.iter().zip(&of.members).map(taken).sum::<f64>();
        self.acted = 0.0;
    }

    /// Changes velocities by the forces, with those of supports and load that keep them at the speed of the load, and
    /// moves particles on, except at the end.
    fn kick(&mut self, part: Part, speed: f64) {
        let half = 0.5 * self.dt;
        let fading = |dt: f64| (-self.of.damping * dt).exp();
        let kick = match part {
            Part::First => Kick { before: 0.0, fading: fading(half), after: half },
            Part::Middle => Kick { before: half, fading: fading(self.dt), after: half },
            Part::Last => Kick { before: half, fading: fading(half), after: 0.0 },
        };
        self.acted += kick.before + kick.after;
        self.hold(kick, speed);
        let drift = if part == Part::Last { 0.0 } else { self.dt };
        let (of, strained, outside) = (self.of, &self.strained, &self.outside);
        let mut blocks: Vec<_> = self.movers.chunks_mut(BLOCK).enumerate().collect();
        let damped = self.team.map_each(&mut blocks, |(number, block)| {
            let first = *number * BLOCK;
            let mut damped = 0.0;
            for (k, mover) in block.iter_mut().enumerate() {
                let i = first + k;
                let forces = of.force(i, strained, outside[i]);
                damped += mover.kick(forces, of.inverse[i], kick);
                mover.drift(drift);
            }
            damped
        });
        self.damped += damped.iter().sum::<f64>();
    }

    /// Finds the forces of supports and load in a kick, and counts the work and the impulse of the load.
    fn hold(&mut self, Kick { before, fading, after }: Kick, speed: f64) {
        let of = self.of;
        for held in &of.holding.held {
            for (at, _) in &held.parts {
                self.outside[at / COMPONENTS][at % COMPONENTS] = 0.0;
            }
        }
        for held in &of.holding.held {
            let (mut moving, mut driven) = (0.0, 0.0);
            for &(at, part) in &held.parts {
                let (i, component) = (at / COMPONENTS, at % COMPONENTS);
                moving += part * self.movers[i].velocity[component];
                let force = of.force(i, &self.strained, [0.0; COMPONENTS])[component];
                driven += part * force * self.inverse(at);
            }
            let wanted = (held.rate * speed - fading * moving) / (fading * before + after);
            let force = (wanted - driven) / self.compliance(held);
            for &(at, part) in &held.parts {
                self.outside[at / COMPONENTS][at % COMPONENTS] += part * force;
            }
            let impulse = held.rate * force * (before + after);
            self.impulse += impulse;
            self.work += impulse * speed;
        }
    }
}

impl MovingLattice {
    /// Lets the damage of a link grow to what its stretch causes; returns the energy that this dissipates [J].
    #[cold]
    fn grow(
        &self,
        (l, stretch): (usize, f64),
        q: &Deformation,
        ends: [&Mover; 2],
        dt: f64,
        strained: &mut Strained,
    ) -> f64 {
        strained.reached = stretch;
        let growth = self.links[l].softening.damage(stretch).0 - strained.damage;
        if growth <= 0.0 {
            return 0.0;
        }
        strained.damage += growth;
        // As in equilibrium, `½ Δω q₀·D q₁` balances the mean forces of both ends of a step.
        let before = ends.map(|end| end.before(dt));
        let before = self.members[l].strain(before.each_ref()).q;
        let mut forces = self.links[l].elastic(&before);
        if self.plan.closes && q[0] < 0.0 {
            forces[0] = 0.0;
        }
        0.5 * growth * dot(&forces, q)
    }

    /// Adds the force of the dashpot of a contact. Faces of cracks that met elastically would rattle, and explicit steps
    /// as short as the contact would heat them.
    #[cold]
    fn meet(&self, member: &Member, strain: &Strain, ends: [&Mover; 2], strained: &mut Strained) {
        let masses = member.ends.map(|i| self.inverse[i as usize][0]);
        let coefficient = strained.damage * member.dashpot(RESTITUTION_DAMPING, masses);
        strained.rate = member.opening_rate(strain, ends.map(Mover::speed));
        strained.dashpot = member.damp(&mut strained.forces, strain, coefficient, strained.rate);
    }

    /// Forces on a particle: those of its links and those from outside.
    #[inline(always)]
    fn force(
        &self,
        i: usize,
        strained: &[Strained],
        outside: [f64; COMPONENTS],
    ) -> [f64; COMPONENTS] {
        let mut force = outside;
        for &slot in &self.slots[self.first_slot[i] as usize..self.first_slot[i + 1] as usize] {
            let [x, z, first, second] = strained[(slot >> 1) as usize].forces;
            let (sign, moment) = if slot & 1 == 0 { (-1.0, first) } else { (1.0, second) };
            force[0] += sign * x;
            force[1] += sign * z;
            force[2] += moment;
        }
        force
    }
}

impl Mover {
    /// Velocity of its middle [m/s].
    fn speed(&self) -> [f64; 2] {
        [self.velocity[0], self.velocity[1]]
    }

    /// Pose a time earlier.
    fn before(&self, dt: f64) -> Pose {
        let [u, w] = self.pose.moved;
        let [x, z, spin] = self.velocity.map(|rate| rate * dt);
        Pose::new([u - x, w - z], self.angle - spin)
    }

    /// Changes the velocity; returns the energy that damping takes [J].
    #[inline(always)]
    fn kick(
        &mut self,
        forces: [f64; COMPONENTS],
        [mass, inertia]: [f64; 2],
        Kick { before, fading, after }: Kick,
    ) -> f64 {
        let rates = [forces[0] * mass, forces[1] * mass, forces[2] * inertia];
        let pushed = [0, 1, 2].map(|c| self.velocity[c] + before * rates[c]);
        self.velocity = [0, 1, 2].map(|c| fading * pushed[c] + after * rates[c]);
        let [x, z, spin] = pushed.map(|rate| rate * rate);
        0.5 * (1.0 - fading * fading) * ((x + z) / mass + spin / inertia)
    }

    #[inline(always)]
    fn drift(&mut self, dt: f64) {
        let [u, w] = self.pose.moved;
        let [x, z, spin] = self.velocity.map(|rate| rate * dt);
        self.angle += spin;
        self.pose = Pose::new([u + x, w + z], self.angle);
    }
}
