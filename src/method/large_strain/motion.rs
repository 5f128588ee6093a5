//! Motion with inertia, by explicit steps: kick, drift, kick (velocity Verlet), of second order in time.
//!
//! Momentum is conserved to rounding, and energy to the square of the time step.

use super::newton::sum;
use super::{
    Contacts, Course, Courses, Deformable, FaceLoad, Failure, Friction, Ledger, LoadedFaces,
    Motion, Plane, Shear, Spot, Stresses, Touch,
};
use crate::port::{Cover, WallCells};
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;
use crate::space::Form;

/// A body that moves.
pub struct Dynamics {
    pub body: Deformable,
    pub loaded: LoadedFaces,
    /// The plane below.
    pub plane: Plane,
    /// [m/s²]
    pub gravity: [f64; 3],
    /// Planes x = 0 and y = 0 that mirror the body.
    mirrors: [bool; 2],
    /// Cells of the surface on the plane that receive the impulse.
    pub cells: Option<WallCells>,
    /// Largest frequencies of the undeformed body and of contact [1/s].
    frequencies: [f64; 2],
}

/// Fraction of the largest stable step that is taken.
const SHARE: f64 = 0.8;
/// Name of the loop over time steps in messages.
const STEPS: &str = "time steps of a solid of large strain";
/// Numbers that a time step updates for each point of the volume, or as many as take as long.
const WORK: usize = 60;

/// Loads and thermal strain that act on a body over an advance, besides gravity and contact.
pub struct Acting<'a> {
    /// Loads on faces at a time [s] after its beginning.
    pub loads: &'a dyn Fn(f64) -> Vec<FaceLoad>,
    /// Courses of the points over a step, from the time of its end [s] and its length; `None` for a body whose
    /// temperature has no effect.
    pub courses: Option<&'a CoursesOver<'a>>,
}

/// See [`Acting::courses`].
pub type CoursesOver<'a> = dyn Fn([f64; 2]) -> Result<Courses, Failure> + 'a;

/// Stresses, contact and loads at a moment.
struct Moment {
    stresses: Stresses,
    touch: Touch,
    shear: Shear,
    /// Forces of loads, and of all, on the nodes [N].
    loads: Vec<[f64; 3]>,
    forces: Vec<[f64; 3]>,
}

impl Dynamics {
    pub fn new(
        (body, loaded): (Deformable, LoadedFaces),
        plane: Plane,
        gravity: f64,
        mirrors: [bool; 2],
        cells: Option<WallCells>,
    ) -> Self {
        let frequencies = [body.highest_frequency(), frequency_of_contact(&body, &plane)];
        let gravity = [0.0, 0.0, -gravity];
        Self { body, loaded, plane, gravity, mirrors, cells, frequencies }
    }

    /// The state at time zero, in which all nodes have one velocity [m/s].
    pub fn start(&self, velocity: [f64; 3]) -> Motion {
        let count = self.body.nodes();
        let mut velocity = vec![velocity; count];
        self.body.flatten(&mut velocity);
        let cells = self.cells.as_ref().map_or(0, WallCells::len);
        let exchange = vec![0.0; cells];
        let friction = self.plane.friction.map(|_| Friction::of(&self.body, cells));
        Motion {
            displacement: vec![[0.0; 3]; count],
            velocity,
            history: vec![0.0; self.body.history()],
            ledger: Ledger { exchange, ..Ledger::default() },
            friction: friction.unwrap_or_default(),
            ..Motion::default()
        }
    }

    /// Returns for x and y whether the motion is symmetric about the plane across that axis.
    pub fn symmetric(&self) -> [bool; 2] {
        let is_round = self.body.space.form == Form::Axisymmetric;
        self.mirrors.map(|mirrored| mirrored || is_round)
    }

    /// Largest time step of the undeformed body [s].
    pub fn usual_step(&self) -> f64 {
        self.stable(1.0)
    }

    /// Updates of numbers in a time step, for the allowance.
    pub fn work(&self) -> usize {
        WORK * self.body.space.volume.len()
    }

    fn stable(&self, stiffening: f64) -> f64 {
        let [own, of_contact] = self.frequencies;
        SHARE * 2.0 / (own * own * stiffening + of_contact * of_contact).sqrt()
    }

    fn at(
        &self,
        motion: &mut Motion,
        (time, dt): (f64, f64),
        acting: &Acting,
        team: &Team,
    ) -> Result<Moment, Failure> {
        let (body, u) = (&self.body, &motion.displacement);
        let over = match acting.courses {
            Some(courses) => courses([time, dt])?,
            None => body.in_all(Course::of(dt)),
        };
        let stresses = body.respond(u, &over, &mut motion.history, team)?;
        let mut of_loads = vec![[0.0; 3]; u.len()];
        self.loaded.add_forces(body, u, &(acting.loads)(time), &mut of_loads);
        let mut forces = sum(&body.forces(&stresses, team), &of_loads);
        let touch = self.plane.touch(body, u);
        touch.add_to(&mut forces);
        let shear = self.plane.rub(body, &touch, &mut motion.friction);
        shear.add_to(&mut forces);
        Ok(Moment { stresses, touch, shear, loads: of_loads, forces })
    }

    /// Contact and friction of a motion at this moment.
    pub fn contact(&self, motion: &Motion) -> Touch {
        let mut touch = self.plane.touch(&self.body, &motion.displacement);
        touch.energy += self.plane.rub(&self.body, &touch, &mut motion.friction.clone()).energy;
        touch
    }

    /// Advances by a duration [s]; notes the contact with cells where `contacts` are given.
    pub fn advance(
        &self,
        motion: &mut Motion,
        duration: f64,
        acting: &Acting,
        mut contacts: Option<&mut Contacts>,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        motion.ledger.exchange.fill(0.0);
        motion.friction.exchange.fill([0.0; 2]);
        (motion.ledger.outside, motion.ledger.duration) = (0.0, duration);
        let mut rest = duration;
        let team = &self.body.team();
        let mut now = self.at(motion, (0.0, 0.0), acting, team)?;
        while rest > 0.0 {
            // Equal steps to the end, so that none is tiny.
            let steps = (rest / self.stable(now.stresses.stiffening)).ceil();
            allowance.foresee(steps, STEPS, self.work())?;
            allowance.spend(1.0, STEPS, self.work())?;
            let dt = rest / steps;
            rest = if steps == 1.0 { 0.0 } else { rest - dt };
            let step = (duration - rest, dt);
            now = self.step(motion, now, step, acting, contacts.as_deref_mut(), team)?;
        }
        Ok(())
    }

    fn step(
        &self,
        motion: &mut Motion,
        now: Moment,
        (time, dt): (f64, f64),
        acting: &Acting,
        mut contacts: Option<&mut Contacts>,
        team: &Team,
    ) -> Result<Moment, Failure> {
        self.note(motion, &now, 0.5 * dt, contacts.as_deref_mut());
        self.kick(motion, &now, 0.5 * dt, team);
        let way: Vec<[f64; 3]> = motion.velocity.iter().map(|v| v.map(|v| dt * v)).collect();
        for (u, way) in motion.displacement.iter_mut().zip(&way) {
            (0..3).for_each(|a| u[a] += way[a]);
        }
        let next = self.at(motion, (time, dt), acting, team)?;
        self.note(motion, &next, 0.5 * dt, contacts);
        self.kick(motion, &next, 0.5 * dt, team);
        let work = [&now, &next].map(|moment| self.body.work(&moment.stresses, &way, team));
        let along = |loads: &[[f64; 3]]| {
            let products = loads.iter().flatten().zip(way.iter().flatten());
            products.map(|(f, u)| f * u).sum::<f64>()
        };
        let ledger = &mut motion.ledger;
        ledger.internal_work += 0.5 * (work[0] + work[1]);
        ledger.load_work += 0.5 * (along(&now.loads) + along(&next.loads));
        motion.friction.heat += next.shear.heat(&now.shear, &way);
        motion.warmth.swelling += 0.5 * dt * (now.stresses.swelling + next.stresses.swelling);
        ledger.time += dt;
        ledger.steps += 1.0;
        if now.touch.force > 0.0 && next.touch.force == 0.0 {
            ledger.lift_off = ledger.time;
        }
        Ok(next)
    }

    /// Changes velocities by the forces of a moment over a time, and notes the impulse on the plane.
    fn kick(&self, motion: &mut Motion, moment: &Moment, dt: f64, team: &Team) {
        let (forces, mass) = (&moment.forces, &self.body.mass);
        team.for_each(&mut motion.velocity, |node, velocity| {
            for a in 0..3 {
                velocity[a] += dt * (forces[node][a] / mass[node] + self.gravity[a]);
            }
        });
        self.body.flatten(&mut motion.velocity);
        for signs in self.images() {
            self.push(&mut motion.ledger, &moment.touch, dt, signs);
            self.drag(&mut motion.friction, moment, dt, signs);
        }
    }

    /// Signs of x and y of the images of the model that make up the body.
    fn images(&self) -> Vec<[f64; 2]> {
        let signs = |mirrored: bool| if mirrored { &[1.0, -1.0][..] } else { &[1.0][..] };
        let [along_x, along_y] = self.mirrors.map(signs);
        along_x.iter().flat_map(|&x| along_y.iter().map(move |&y| [x, y])).collect()
    }

    /// Cells below a point of an image of the body.
    fn cover(&self, cells: &WallCells, spot: &Spot, signs: [f64; 2]) -> Cover {
        match self.body.space.form {
            // Round cells cover as much of a square anywhere on its circle: even contact is even up to the axis, which
            // a ring between two radii leaves out.
            Form::Solid | Form::Axisymmetric => cells.cover(spot.rectangle(signs)),
            // A row of tiles, however deep.
            Form::Plane => cells.cover([spot.rectangle(signs)[0], [0.0; 2]]),
        }
    }

    /// Notes the contact of a moment that lasts for a time [s].
    fn note(&self, motion: &Motion, moment: &Moment, dt: f64, contacts: Option<&mut Contacts>) {
        let (Some(contacts), Some(cells)) = (contacts, &self.cells) else { return };
        for signs in self.images() {
            let cover = |spot: usize| self.cover(cells, &moment.touch.spots[spot], signs);
            let own = (&self.body, &motion.displacement[..]);
            contacts.add(own, &moment.touch, dt, cover, cells.end_with_the_body());
        }
    }

    /// Notes the impulse of an image of the body, with these signs of x and y, on the plane.
    fn push(&self, ledger: &mut Ledger, touch: &Touch, dt: f64, signs: [f64; 2]) {
        ledger.impulse_to_plane += dt * touch.force;
        let Some(cells) = &self.cells else {
            ledger.outside += dt * touch.force;
            return;
        };
        for spot in &touch.spots {
            let impulse = dt * spot.force;
            let cover = self.cover(cells, spot, signs);
            for (cell, weight) in cover.cells {
                ledger.exchange[cell] += weight * impulse;
            }
            ledger.outside += cover.outside * impulse;
        }
    }

    /// Notes the impulse of an image of the body, with these signs of x and y, along the plane.
    fn drag(&self, friction: &mut Friction, moment: &Moment, dt: f64, signs: [f64; 2]) {
        let spots = moment.touch.spots.iter().zip(&moment.shear.spots);
        for (spot, force) in spots {
            let impulse = [0, 1].map(|a| -dt * signs[a] * force[a]);
            let is_round = self.body.space.form == Form::Axisymmetric;
            if !is_round {
                (0..2).for_each(|a| friction.impulse[a] += impulse[a]);
            }
            let Some(cells) = &self.cells else { continue };
            let given = match cells.are_radial() && !is_round {
                true => radially([0, 1].map(|a| signs[a] * spot.at[a]), impulse),
                false => impulse,
            };
            for (cell, weight) in self.cover(cells, spot, signs).cells {
                (0..2).for_each(|a| friction.exchange[cell][a] += weight * given[a]);
            }
        }
    }
}

/// An impulse at a place: along its radius from the origin, and 0.
fn radially([x, y]: [f64; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    let radius = x.hypot(y);
    [if radius > 0.0 { (x * u + y * v) / radius } else { 0.0 }, 0.0]
}

/// Bound on the frequency that contact adds [1/s].
fn frequency_of_contact(body: &Deformable, plane: &Plane) -> f64 {
    let samples = &body.space.boundary.samples;
    let mut stiffness = vec![0.0; body.nodes()];
    for point in 0..samples.len() {
        for value in samples.row(point) {
            let share = plane.stiffness * samples.weights[point];
            stiffness[value.node as usize] += share * value.value.abs();
        }
    }
    let squares = stiffness.iter().zip(&body.mass).map(|(k, m)| k / m);
    squares.fold(0.0, f64::max).sqrt()
}
