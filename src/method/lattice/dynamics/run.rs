//! A communication step under way: loops over links and particles, on threads.

use super::{MovingLattice, dot, remaining};
use crate::method::lattice::LatticeMotion;
use crate::method::lattice::frame::COMPONENTS;
use crate::method::lattice::held::Held;
use crate::method::lattice::link::Deformation;
use crate::method::lattice::member::{EndForces, Member, Pose, Strain};
use crate::runtime::parallel::Team;

/// Links or particles that one thread computes at a time.
const BLOCK: usize = 2048;
/// Part of the critical damping with which faces of cracks meet: they part at half of the speed.
const RESTITUTION_DAMPING: f64 = 0.2;

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
pub(super) struct Strained {
    forces: EndForces,
    damage: f64,
    /// Stretch up to which damage does not grow [1].
    reached: f64,
    /// Force of the contact's dashpot, positive in tension [N], and the rate of opening that it refers to [m/s].
    dashpot: f64,
    rate: f64,
}

impl Strained {
    /// Work that the contact's dashpot has taken over a time [s], at the mean of the rates before and after it.
    fn work(&self, rate: f64, acted: f64) -> f64 {
        0.5 * self.dashpot * (self.rate + rate) * acted
    }
}

/// One change of all velocities: forces act for a time, damping fades speeds, and forces act for another time [s].
#[derive(Debug, Clone, Copy)]
struct Kick {
    before: f64,
    fading: f64,
    after: f64,
}

/// Place of a kick in a communication step, which begins and ends between two half kicks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    First,
    Middle,
    Last,
}

/// A communication step under way.
pub(super) struct Run<'a> {
    of: &'a MovingLattice,
    movers: Vec<Mover>,
    pub(super) strained: Vec<Strained>,
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
    pub(super) fn new(of: &'a MovingLattice, motion: &LatticeMotion, dt: f64) -> Self {
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
    pub(super) fn strained(mut self) -> Self {
        self.strain();
        self
    }

    pub(super) fn store(&self, motion: &mut LatticeMotion) {
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
    pub(super) fn push(&mut self, speed: f64) {
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
    pub(super) fn strain(&mut self) {
        let (of, movers, dt, acted) = (self.of, &self.movers, self.dt, self.acted);
        let (bending, closes) = (of.plan.bending, of.plan.closes);
        let mut blocks: Vec<_> = self.strained.chunks_mut(BLOCK).enumerate().collect();
        let taken = self.team.map_each(&mut blocks, |(number, block)| {
            let first = *number * BLOCK;
            let (mut dissipated, mut damped) = (0.0, 0.0);
            let members = &of.members[first..first + block.len()];
            for (k, (member, strained)) in members.iter().zip(block.iter_mut()).enumerate() {
                let ends = member.ends.map(|i| &movers[i as usize]);
                let strain = member.strain(ends.map(|end| &end.pose));
                if strained.dashpot != 0.0 {
                    damped +=
                        strained.work(member.opening_rate(&strain, ends.map(Mover::speed)), acted);
                }
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
            [dissipated, damped]
        });
        self.dissipated += taken.iter().map(|[dissipated, _]| dissipated).sum::<f64>();
        self.damped += taken.iter().map(|[_, damped]| damped).sum::<f64>();
        self.acted = 0.0;
    }

    /// Counts what the dashpots of contacts have taken at the end of the communication step.
    pub(super) fn end(&mut self) {
        let (of, movers, acted) = (self.of, &self.movers, self.acted);
        let taken = |(strained, member): (&Strained, &Member)| {
            let ends = member.ends.map(|i| &movers[i as usize]);
            let strain = member.strain(ends.map(|end| &end.pose));
            strained.work(member.opening_rate(&strain, ends.map(Mover::speed)), acted)
        };
        let met = self.strained.iter().zip(&of.members).filter(|(own, _)| own.dashpot != 0.0);
        self.damped += met.map(taken).sum::<f64>();
    }

    /// Changes velocities by the forces, with those of supports and load that keep them at the speed of the load, and
    /// moves particles on, except at the end.
    pub(super) fn kick(&mut self, part: Part, speed: f64) {
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

    /// Adds the force of the dashpot of a contact. Faces of cracks that met elastically would rattle, and explicit
    /// steps as short as the contact would heat them.
    #[cold]
    fn meet(&self, member: &Member, strain: &Strain, ends: [&Mover; 2], strained: &mut Strained) {
        let masses = member.ends.map(|i| self.inverse[i as usize][0]);
        let coefficient = strained.damage * member.dashpot(RESTITUTION_DAMPING, masses);
        strained.rate = member.opening_rate(strain, ends.map(Mover::speed));
        strained.dashpot = member.damp(&mut strained.forces, strain, coefficient, strained.rate);
    }

    /// Forces on a particle: those of its links and those from outside.
    #[inline(always)]
    pub(super) fn force(
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
