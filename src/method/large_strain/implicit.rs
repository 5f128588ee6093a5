//! Motion with inertia by implicit steps that conserve energy and momentum; see [`path`](super::path).
//!
//! A step obeys `M (v₁ − v₀)/Δt = f`, `u₁ − u₀ = ½ Δt (v₀ + v₁)` with the forces f of the stresses along its way, of
//! loads at its middle and of gravity. It is of second order, stable for any Δt, and solved by Newton's method with the
//! exact derivative, which is not symmetric. Prescribed displacements are linear over a step; the velocity of their
//! nodes is the mean one.

use super::newton::{self, Equations, Residual, difference, sum};
use super::path::{Path, Stations, gradients};
use super::statics::{rounding, rounding_of_energy};
use super::tangent::{Factor, Linearised, Stiffness, Terms};
use super::{Course, Courses, Deformable, FaceLoad, Failure, LoadedFaces, Motion};
use crate::math::matrix3::Matrix3;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// A body that moves by implicit steps.
pub struct ImplicitDynamics {
    pub body: Deformable,
    pub loaded: LoadedFaces,
    /// [m/s²]
    pub gravity: [f64; 3],
    stiffness: Stiffness,
    held: Vec<[bool; 3]>,
    /// Bounds on the rounding of internal forces [N] and of the energy stored [J].
    rounding: f64,
    pub rounding_of_energy: f64,
}

/// Conditions over a step.
pub struct Drive {
    /// Displacements of held nodes at its end [m]; those of others are not read.
    pub displacements: Vec<[f64; 3]>,
    /// Load on each loaded face at its middle.
    pub loads: Vec<FaceLoad>,
}

/// A step that was made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stepped {
    /// Norm of the residual over that of the forces, after each iteration.
    pub residuals: Vec<f64>,
    /// Forces of held nodes on the body over the step [N].
    pub reactions: Vec<[f64; 3]>,
}

/// Name of the iterations in messages.
pub const IMPLICIT_STEPS: &str = "iterations of implicit steps of a solid of large strain";
/// Numbers that an iteration updates for each point, or as many as take as long.
pub const IMPLICIT_WORK: usize = 3000;
/// Largest residual over the norm of all forces at nodes.
const TOLERANCE: f64 = 1e-11;
/// Energy of the body that may have no cause in a step, over the change of what it stores and over that itself.
const GAINED: f64 = 0.005;
const STORED: f64 = 1e-6;
/// Rounding of a displacement over its size.
const ROUNDING: f64 = 1e-15;

/// A step to be made.
struct Step<'a> {
    from: &'a Motion,
    start: &'a [Matrix3],
    over: &'a Courses,
    to: &'a Drive,
    dt: f64,
    team: &'a Team,
    allowance: &'a Allowance,
}

/// A trial of displacements at the end of a step.
struct Trial<'a> {
    path: Path<'a>,
    stations: Vec<Stations>,
    /// Forces of the stresses and of the loads on all nodes [N].
    internal: Vec<[f64; 3]>,
    loads: Vec<[f64; 3]>,
    /// Forces on free nodes that inertia does not balance.
    residual: Vec<[f64; 3]>,
    norm: f64,
    scale: f64,
    rounding: f64,
}

/// The equations of a step.
struct Balance<'a> {
    dynamics: &'a ImplicitDynamics,
    step: &'a Step<'a>,
}

impl<'a> Equations for Balance<'a> {
    type Trial = Trial<'a>;

    fn at(&self, u: &[[f64; 3]]) -> Result<Trial<'a>, Failure> {
        self.dynamics.at(self.step, u)
    }

    fn change(&self, u: &[[f64; 3]], now: &Trial, _: bool) -> Result<Vec<[f64; 3]>, Failure> {
        let factor = self.dynamics.factor(self.step, u, now)?;
        Ok(self.dynamics.stiffness.solve(&factor, &now.residual))
    }

    fn residual(&self, trial: &Trial) -> Residual {
        let &Trial { norm, scale, rounding, .. } = trial;
        Residual { norm, scale, wanted: TOLERANCE * scale + rounding }
    }

    fn forces<'t>(&self, trial: &'t Self::Trial) -> &'t [[f64; 3]] {
        &trial.residual
    }

    fn softens(&self) -> bool {
        self.dynamics.body.has_concrete()
    }

    fn unbalanced(&self, residual: f64) -> Failure {
        Failure::NotConverged { residual }
    }
}

impl ImplicitDynamics {
    /// `held` marks prescribed displacements, in addition to those that the body fixes.
    pub fn new(
        body: Deformable,
        held: &[[bool; 3]],
        loaded: LoadedFaces,
        gravity: f64,
    ) -> Result<Self, Failure> {
        let both = |(own, held): (&[bool; 3], &[bool; 3])| [0, 1, 2].map(|a| own[a] || held[a]);
        let held: Vec<[bool; 3]> = body.fixed.iter().zip(held).map(both).collect();
        let stiffness = Stiffness::new(&body, &held, &loaded.couplings(&body));
        let stiffness = stiffness.map_err(|_| Failure::Singular)?;
        let rounding = rounding(&body);
        let rounding_of_energy = rounding_of_energy(&body);
        Ok(Self {
            body,
            loaded,
            gravity: [0.0, 0.0, -gravity],
            stiffness,
            held,
            rounding,
            rounding_of_energy,
        })
    }

    /// The state at time zero, in which all free nodes have one velocity [m/s].
    pub fn start(&self, velocity: [f64; 3]) -> Motion {
        let at_start =
            |held: &[bool; 3]| [0, 1, 2].map(|a| if held[a] { 0.0 } else { velocity[a] });
        Motion {
            displacement: vec![[0.0; 3]; self.body.nodes()],
            velocity: self.held.iter().map(at_start).collect(),
            history: vec![0.0; self.body.history()],
            ..Motion::default()
        }
    }

    /// Makes a step of a length [s]; `motion` changes only if it is made.
    pub fn step(
        &self,
        motion: &mut Motion,
        to: &Drive,
        dt: f64,
        allowance: &Allowance,
    ) -> Result<Stepped, Failure> {
        let team = &self.body.team();
        let start = gradients(&self.body, &motion.displacement, team)?;
        let over = &self.body.in_all(Course::of(dt));
        let step = Step { from: motion, start: &start, over, to, dt, team, allowance };
        let (u, now) = self.first(&step)?;
        let mut residuals = vec![now.norm / now.scale];
        let solved = newton::solve(&Balance { dynamics: self, step: &step }, u, now)?;
        let (u, now) = (solved.u, solved.trial);
        residuals.extend(solved.residuals);
        let (internal, loads) = (now.internal, now.loads);
        let mut history = motion.history.clone();
        let energy = |u: &[[f64; 3]], history: &mut [f64], time: f64| -> Result<f64, Failure> {
            let over = self.body.in_all(Course::of(time));
            Ok(self.body.respond(u, &over, history, team)?.energy)
        };
        let before = energy(&motion.displacement, &mut history.clone(), 0.0)?;
        let after = energy(&u, &mut history, dt)?;
        let way = difference(&u, &motion.displacement);
        let along = internal.as_flattened().iter().zip(way.as_flattened());
        let work = -along.map(|(force, way)| force * way).sum::<f64>();
        // Laws with a history may dissipate.
        let gained = after - before - work;
        let gained = if self.body.history() == 0 { gained.abs() } else { gained };
        let caused = GAINED * ((after - before).abs() + work.abs()) + STORED * (before + after);
        if gained > caused + self.rounding_of_energy {
            return Err(Failure::Unbalanced { energy: gained });
        }
        let reactions = self.finish(motion, u, dt, &internal, &loads);
        motion.history = history;
        Ok(Stepped { residuals, reactions })
    }

    /// First trial: the body follows its held nodes and its momentum as if it were linear. Concrete keeps its velocities,
    /// and a body that this turns inside out stays where it is.
    fn first<'s>(&'s self, step: &Step<'s>) -> Result<(Vec<[f64; 3]>, Trial<'s>), Failure> {
        let from = &step.from.displacement;
        let change = match self.body.has_concrete() {
            true => self.flight(step),
            false => self.follow(step)?,
        };
        let u = sum(from, &change);
        match self.at(step, &u) {
            Err(Failure::Inverted { .. }) => {
                let u = sum(from, &self.jump(step));
                let trial = self.at(step, &u)?;
                Ok((u, trial))
            }
            trial => Ok((u, trial?)),
        }
    }

    /// Changes of prescribed displacements over a step; zero elsewhere.
    fn jump(&self, step: &Step) -> Vec<[f64; 3]> {
        let from = &step.from.displacement;
        let of_node = |(node, held): (usize, &[bool; 3])| {
            let way = |a: usize| step.to.displacements[node][a] - from[node][a];
            [0, 1, 2].map(|a| if held[a] { way(a) } else { 0.0 })
        };
        self.held.iter().enumerate().map(of_node).collect()
    }

    /// The same, with nodes that keep their velocities.
    fn flight(&self, step: &Step) -> Vec<[f64; 3]> {
        let mut change = self.jump(step);
        for (node, held) in self.held.iter().enumerate() {
            for a in (0..3).filter(|&a| !held[a]) {
                change[node][a] = step.dt * step.from.velocity[node][a];
            }
        }
        change
    }

    /// Change in which held nodes move as prescribed and the others follow linearly, without flow. Where a step begins
    /// the derivative of the mean stress is half that at its end.
    fn follow(&self, step: &Step) -> Result<Vec<[f64; 3]>, Failure> {
        let (body, from) = (&self.body, step.from);
        let now = self.at(step, &from.displacement)?;
        let course = (step.over, &from.history[..]);
        let (deformations, dilatations) = body.deformations(&from.displacement, course, step.team);
        let start =
            Linearised { deformations, dilatations, before: &from.history, over: step.over };
        let jump = self.jump(step);
        let forces = start.forces(body, &jump, step.team);
        let load: Vec<[f64; 3]> = now
            .residual
            .iter()
            .zip(&forces)
            .map(|(r, f)| [0, 1, 2].map(|a| 2.0 * r[a] + f[a]))
            .collect();
        let is_pressed = step.to.loads.iter().any(FaceLoad::follows);
        let terms = Terms {
            of_group: &|group| start.group_without_flow(body, group),
            inertia: 4.0 / (step.dt * step.dt),
            loads: &self.loaded.stiffness(body, &from.displacement, &step.to.loads, 1.0),
            is_symmetric: body.has_symmetric_tangent() && !is_pressed,
        };
        let factor = self.stiffness.factor(body, &terms, step.team);
        let factor = factor.map_err(|_| Failure::Singular)?;
        Ok(sum(&self.stiffness.solve(&factor, &load), &jump))
    }

    fn factor(&self, step: &Step, u: &[[f64; 3]], now: &Trial) -> Result<Factor, Failure> {
        let middle = middle(&step.from.displacement, u);
        let terms = Terms {
            of_group: &|group| now.path.tangent(group, &now.stations[group]),
            inertia: 2.0 / (step.dt * step.dt),
            loads: &self.loaded.stiffness(&self.body, &middle, &step.to.loads, 0.5),
            is_symmetric: false,
        };
        self.stiffness.factor(&self.body, &terms, step.team).map_err(|_| Failure::Singular)
    }

    fn at<'s>(&'s self, step: &Step<'s>, u: &[[f64; 3]]) -> Result<Trial<'s>, Failure> {
        let (body, from, dt) = (&self.body, step.from, step.dt);
        step.allowance.spend(1.0, IMPLICIT_STEPS, IMPLICIT_WORK * body.space.volume.len())?;
        let end = gradients(body, u, step.team)?;
        let path = Path { body, start: step.start, end, before: &from.history, over: step.over };
        let stations = path.stations(step.team);
        let internal = body.forces_of(&path.loads(&stations, step.team), step.team);
        let mut loads = vec![[0.0; 3]; u.len()];
        let middle = middle(&from.displacement, u);
        self.loaded.add_forces(body, &middle, &step.to.loads, &mut loads);
        let mut residual = vec![[0.0; 3]; u.len()];
        let (mut norm, mut scale, mut size) = (0.0, 0.0, 0.0);
        for (node, held) in self.held.iter().enumerate() {
            let mass = body.mass[node];
            for a in (0..3).filter(|&a| !held[a]) {
                let (before, after) = (from.displacement[node][a], u[node][a]);
                let momentum = mass * from.velocity[node][a];
                let external = loads[node][a] + mass * self.gravity[a];
                let inertia = 2.0 * mass * (after - before) / (dt * dt) - 2.0 * momentum / dt;
                let force = internal[node][a] + external - inertia;
                residual[node][a] = force;
                norm += force * force;
                let largest = internal[node][a].abs().max(external.abs());
                scale += largest.max((momentum / dt).abs()).powi(2);
                size += (mass * before.abs().max(after.abs())).powi(2);
            }
        }
        if !norm.is_finite() {
            return Err(Failure::NotFinite);
        }
        let scale = scale.sqrt().max(f64::MIN_POSITIVE);
        let rounding = self.rounding + ROUNDING * 2.0 / (dt * dt) * size.sqrt();
        Ok(Trial { path, stations, internal, loads, residual, norm: norm.sqrt(), scale, rounding })
    }

    /// Ends a step with displacements u; returns the forces of held nodes.
    fn finish(
        &self,
        motion: &mut Motion,
        u: Vec<[f64; 3]>,
        dt: f64,
        internal: &[[f64; 3]],
        loads: &[[f64; 3]],
    ) -> Vec<[f64; 3]> {
        let way = difference(&u, &motion.displacement);
        let mut reactions = vec![[0.0; 3]; u.len()];
        let ledger = &mut motion.ledger;
        let before = ledger.works();
        for (node, held) in self.held.iter().enumerate() {
            let mass = self.body.mass[node];
            for a in 0..3 {
                let velocity = &mut motion.velocity[node][a];
                let (before, way) = (*velocity, way[node][a]);
                *velocity = if held[a] { way / dt } else { 2.0 * way / dt - before };
                ledger.internal_work -= internal[node][a] * way;
                ledger.load_work += loads[node][a] * way;
                if held[a] {
                    let own = internal[node][a] + loads[node][a] + mass * self.gravity[a];
                    reactions[node][a] = mass * (*velocity - before) / dt - own;
                    let kinetic = 0.5 * mass * (*velocity * *velocity - before * before);
                    ledger.face_work += kinetic - own * way;
                }
            }
        }
        let changes = ledger.works().into_iter().zip(before);
        ledger.turnover += changes.map(|(after, before)| (after - before).abs()).sum::<f64>();
        ledger.time += dt;
        ledger.steps += 1.0;
        motion.displacement = u;
        reactions
    }
}

fn middle(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<[f64; 3]> {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|n| 0.5 * (a[n] + b[n]))).collect()
}

#[cfg(test)]
mod tests;
