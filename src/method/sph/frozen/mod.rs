//! Frozen fluid, which is rigid.
//!
//! A particle of which at least half is frozen is rigid, so the front lies within half a particle distance of the
//! boundary between rigid and fluid particles. Rigid particles next to each other are bonded and form a piece. A piece
//! that touches a plane to which fluid sticks is held: its velocity is zero, and the plane receives the impulse of all
//! forces on it. Other pieces are free and move as rigid bodies: after every change of velocities, theirs are projected
//! onto the nearest rigid motion by kinetic energy, which has the same momentum and angular momentum. A piece that
//! freezes onto another, or onto the wall, collides inelastically.
//!
//! Fluid sticks to pieces: where it touches them, viscosity counts more, see `STICKING`.
//!
//! Pieces follow from positions and heat contents alone. Rigid particles keep density and pressure, by which they carry
//! fluid.

mod body;
mod links;

use super::cloud::Cloud;
use super::feed::{ASLEEP, FREE};
use super::images::Ends;
use super::method::Method;
use crate::runtime::parallel::Team;
use body::{Body, Displacement, Freedom, RigidMotion};
use links::connected;

/// Frozen fraction from which on a particle is rigid.
pub const RIGID: f64 = 0.5;
/// Largest distance over Δx of bonded particles: it exceeds the diagonals of the lattice, and pieces next to each other
/// do not hover.
const REACH: f64 = 1.75;
/// Distance from a plane over Δx below which rigid particles adhere to it; those nearer exchange heat with the wall.
const ADHERING: f64 = 1.05;

/// Factor of viscosity of rigid particles in sums over pairs of explicit viscosity. With it fluid has the velocity of
/// the rigid particles at the boundary of both, not at their centres, which are twice as far: a pair of both kinds
/// counts twice. In a film of six layers on a frozen one the plane without slip lies 0.02 Δx above the boundary;
/// without the factor it lay 0.55 Δx below.
const STICKING: f64 = 3.0;
/// Weight of rigid particles in the dissipation of implicit viscosity, for the same reason: the plane without slip lies
/// at the boundary to 0.01 Δx; without the factor it lay 0.41 Δx below.
const DISSIPATION: f64 = 2.5;

/// Largest factor of viscosity of a pair.
pub const STICKING_PAIR: f64 = 0.5 * (1.0 + STICKING);

/// Bond of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Bond {
    /// Fluid.
    #[default]
    None,
    /// Part of a piece on the wall.
    Wall,
    /// Part of a piece at another plane across z.
    Plane,
    /// Part of the free piece of this number.
    Piece(u32),
    /// Fluid in a nozzle, which has its velocity.
    Nozzle,
    /// Fluid at rest beside fluid that moves.
    Asleep,
}

impl Bond {
    pub fn is_rigid(self) -> bool {
        self != Self::None
    }

    fn is_frozen(self) -> bool {
        !matches!(self, Self::None | Self::Nozzle | Self::Asleep)
    }

    /// Factor of viscosity of a particle in sums over pairs of explicit viscosity.
    pub fn sticking(self) -> f64 {
        if self.is_frozen() { STICKING } else { 1.0 }
    }

    /// Weight of a particle in the dissipation of implicit viscosity.
    pub fn dissipation(self) -> f64 {
        if self.is_frozen() { DISSIPATION } else { 1.0 }
    }

    pub fn is_held(self) -> bool {
        matches!(self, Self::Wall | Self::Plane | Self::Nozzle | Self::Asleep)
    }
}

/// A piece that moves.
#[derive(Debug, Clone, PartialEq)]
struct FreePiece {
    members: Vec<u32>,
    /// Displacement of each member by whole periods, after which the piece is in one place.
    frames: Vec<[f64; 3]>,
    freedom: Freedom,
}

/// Rigid particles of a cloud, and the pieces that they form.
#[derive(Debug, Clone, PartialEq)]
pub struct Pieces {
    /// Bond of each particle; empty where all are fluid.
    bonds: Vec<Bond>,
    free: Vec<FreePiece>,
}

/// New position and velocity of a particle.
pub struct Moved {
    pub particle: usize,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
}

impl Pieces {
    /// Those of fluid alone.
    pub const NONE: Self = Self { bonds: Vec::new(), free: Vec::new() };

    /// Pieces of particles.
    pub fn of(method: &Method, cloud: &Cloud) -> Self {
        let mut pieces = Self::NONE;
        pieces.hold(cloud);
        pieces.update(method, cloud);
        pieces
    }

    /// Bonds the particles in a nozzle to it.
    fn hold(&mut self, cloud: &Cloud) {
        let Some(origin) = &cloud.origin else { return };
        self.bonds.resize(cloud.len(), Bond::None);
        for (bond, hold) in
            self.bonds.iter_mut().zip(&origin.hold).filter(|(_, hold)| **hold != FREE)
        {
            *bond = if *hold == ASLEEP { Bond::Asleep } else { Bond::Nozzle };
        }
    }

    /// Finds the pieces of particles that have moved, or whose heat contents have changed, since the last time. Held
    /// pieces do not move, so they change only with the set of rigid particles.
    pub fn update(&mut self, method: &Method, cloud: &Cloud) {
        let (Some(phases), Some(contents)) = (&method.phases, &cloud.content) else { return };
        let is_rigid = |content: &f64| phases.frozen(*content) >= RIGID;
        if self.free.is_empty() {
            let stays = |(i, content): (usize, &f64)| match self.bond(i) {
                Bond::Nozzle | Bond::Asleep => true,
                bond => is_rigid(content) == bond.is_rigid(),
            };
            if contents.iter().enumerate().all(stays) {
                return;
            }
        }
        let rigid = (0..).zip(contents).filter(|(_, content)| is_rigid(content)).map(|(i, _)| i);
        *self = Self::among(method, cloud, &rigid.collect::<Vec<u32>>());
        self.hold(cloud);
    }

    /// Pieces that some rigid particles form.
    fn among(method: &Method, cloud: &Cloud, rigid: &[u32]) -> Self {
        let mut pieces = Self::NONE;
        if rigid.is_empty() {
            return pieces;
        }
        pieces.bonds = vec![Bond::None; cloud.len()];
        let places: Vec<_> = rigid.iter().map(|&i| cloud.position[i as usize]).collect();
        // What sleeps rests on the wall, by particles that may have left the cloud of a step.
        let sleeps =
            |i: u32| cloud.origin.as_ref().is_some_and(|origin| origin.hold[i as usize] == ASLEEP);
        for set in connected(&places, &method.images, REACH * method.spacing) {
            let held = set.members.iter().map(|&k| match sleeps(rigid[k as usize]) {
                true => Bond::Wall,
                false => hold(method, places[k as usize][2]),
            });
            let bond = match held.clone().find(|bond| *bond == Bond::Wall) {
                Some(wall) => wall,
                None => held.max_by_key(|bond| bond.is_held()).unwrap_or_default(),
            };
            let members: Vec<u32> = set.members.iter().map(|&k| rigid[k as usize]).collect();
            let bond = if bond.is_held() { bond } else { Bond::Piece(pieces.free.len() as u32) };
            members.iter().for_each(|&i| pieces.bonds[i as usize] = bond);
            if !bond.is_held() {
                let freedom = Freedom::of(method, set.bonds);
                pieces.free.push(FreePiece { members, frames: set.frames, freedom });
            }
        }
        pieces
    }

    /// Bonds of all particles; empty where all are fluid.
    pub fn bonds(&self) -> &[Bond] {
        &self.bonds
    }

    pub fn bond(&self, particle: usize) -> Bond {
        self.bonds.get(particle).copied().unwrap_or_default()
    }

    /// Returns true if no particle is rigid.
    pub fn are_none(&self) -> bool {
        self.bonds.is_empty()
    }

    pub fn any_is_free(&self) -> bool {
        !self.free.is_empty()
    }

    /// The free pieces as rigid bodies at the positions of their particles.
    pub fn bodies<'a>(&'a self, cloud: &'a Cloud) -> Bodies<'a> {
        let bodies = self.free.iter().map(|piece| Body::of(piece.freedom, piece.points(cloud)));
        Bodies { pieces: self, cloud, bodies: bodies.collect() }
    }
}

impl FreePiece {
    /// Number, and position in the frame of the piece, of each member.
    fn places<'a>(
        &'a self,
        cloud: &'a Cloud,
    ) -> impl Iterator<Item = (usize, [f64; 3])> + Clone + 'a {
        self.members.iter().zip(&self.frames).map(|(&i, frame)| {
            let x = cloud.position[i as usize];
            (i as usize, [0, 1, 2].map(|a| x[a] + frame[a]))
        })
    }

    fn points<'a>(
        &'a self,
        cloud: &'a Cloud,
    ) -> impl Iterator<Item = (f64, [f64; 3])> + Clone + 'a {
        self.places(cloud).map(|(i, x)| (cloud.mass[i], x))
    }
}

/// Bond to planes across z of a rigid particle at a height over H.
fn hold(method: &Method, height: f64) -> Bond {
    let Ends::Planes { near, far } = method.images.ends()[2] else { return Bond::None };
    let reach = ADHERING * method.spacing;
    if near && height < reach {
        return if method.wall.is_some() { Bond::Wall } else { Bond::Plane };
    }
    if far.is_some_and(|end| end - height < reach) { Bond::Plane } else { Bond::None }
}

/// Free pieces as rigid bodies.
pub struct Bodies<'a> {
    pieces: &'a Pieces,
    cloud: &'a Cloud,
    bodies: Vec<Body>,
}

impl Bodies<'_> {
    /// Rigid motion of each piece that is nearest to some velocities of the particles.
    fn fit(&self, velocity: impl Fn(usize) -> [f64; 3]) -> Vec<RigidMotion> {
        let fit = |(piece, body): (&FreePiece, &Body)| {
            let places = piece.places(self.cloud);
            body.fit(places.map(|(i, x)| (self.cloud.mass[i], x, velocity(i))))
        };
        self.pieces.free.iter().zip(&self.bodies).map(fit).collect()
    }

    /// Numbers and projected velocities of the particles of all free pieces, for velocities of all particles.
    pub fn projected(&self, velocity: impl Fn(usize) -> [f64; 3]) -> Vec<(usize, [f64; 3])> {
        let mut all = Vec::new();
        for (n, motion) in self.fit(velocity).iter().enumerate() {
            let places = self.pieces.free[n].places(self.cloud);
            all.extend(places.map(|(i, x)| (i, self.bodies[n].velocity(motion, x))));
        }
        all
    }

    /// Projects velocities of all particles onto motions in which free pieces are rigid, and held ones at rest.
    pub fn project(&self, velocities: &mut [[f64; 3]], team: &Team) {
        if self.pieces.are_none() {
            return;
        }
        let projected = self.projected(|i| velocities[i]);
        projected.into_iter().for_each(|(i, velocity)| velocities[i] = velocity);
        team.for_each(velocities, |i, velocity| {
            if self.pieces.bond(i).is_held() {
                *velocity = [0.0; 3];
            }
        });
    }

    /// Positions and velocities of the particles of free pieces after a time without forces.
    pub fn moved(&self, dt: f64) -> Vec<Moved> {
        let mut all = Vec::new();
        for (n, motion) in self.fit(|i| self.cloud.velocity[i]).iter().enumerate() {
            let body = &self.bodies[n];
            let displacement: Displacement = body.displacement(motion, dt);
            all.extend(self.pieces.free[n].places(self.cloud).map(|(particle, place)| {
                let (way, velocity) = displacement.of(body.arm(place));
                let x = self.cloud.position[particle];
                Moved { particle, position: [0, 1, 2].map(|a| x[a] + way[a]), velocity }
            }));
        }
        all
    }
}
