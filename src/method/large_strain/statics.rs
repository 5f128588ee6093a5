//! Equilibrium without inertia.

use std::cell::RefCell;

use super::iteration::{Assembled, Iterations, Load};
use super::mirrors::stay_beside_mirrors;
use super::newton::{self, Equations, Residual, sum};
use super::path::Path;
use super::tangent::{Linearised, Stiffness, Terms};
use super::{Courses, Deformable, FaceLoad, Failure, LoadedFaces, Stresses};
use crate::laws::solid::large_strain::Deformed;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// A body in equilibrium under prescribed displacements, forces and loads on faces.
pub struct Equilibrium {
    pub body: Deformable,
    pub loaded: LoadedFaces,
    pub(super) stiffness: Stiffness,
    held: Vec<[bool; 3]>,
    /// Bounds on the rounding of internal forces [N] and of the energy stored [J].
    rounding: f64,
    pub rounding_of_energy: f64,
}

/// Displacements of the nodes and history of the points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rest {
    /// u [m].
    pub displacement: Vec<[f64; 3]>,
    /// History of the law, point by point.
    pub history: Vec<f64>,
}

/// Conditions at the end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditions {
    /// Forces on the nodes [N].
    pub forces: Vec<[f64; 3]>,
    /// Displacements of held nodes [m]; those of others are not read.
    pub displacements: Vec<[f64; 3]>,
    /// Load on each loaded face.
    pub loads: Vec<FaceLoad>,
}

/// An equilibrium.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// Norm of the residual over that of the forces, after each iteration.
    pub residuals: Vec<f64>,
    /// Forces of held nodes on the body [N].
    pub reactions: Vec<[f64; 3]>,
    /// Energy stored [J].
    pub stored: f64,
    /// Work of the stresses over the step, along the straight path of C [J].
    pub work: f64,
    /// Largest change of the damage function of a point of concrete.
    pub passed: f64,
    /// Another equilibrium takes less energy: the stiffness is not positive definite.
    pub is_unstable: bool,
}

/// Name of the iterations in messages.
pub const STEPS: &str = "iterations towards the equilibrium of a solid of large strain";
/// Numbers that an iteration updates for each point, or as many as take as long.
pub const WORK: usize = 1000;
/// Largest residual over the norm of all forces at nodes.
const TOLERANCE: f64 = 1e-10;
/// Part of a prescribed displacement whose forces are taken as linear in concrete.
const SMALL: f64 = 1e-6;
/// Rounding of a strain over 1.
const ROUNDING: f64 = 4e-15;

/// A trial of displacements.
struct Trial<'a> {
    linearised: Linearised<'a>,
    stresses: Stresses,
    /// Forces on free nodes that are not balanced.
    residual: Vec<[f64; 3]>,
    norm: f64,
    scale: f64,
    history: Vec<f64>,
    reactions: Vec<[f64; 3]>,
}

/// A step to be made.
struct Step<'a> {
    from: &'a Rest,
    to: &'a Conditions,
    over: &'a Courses,
    team: &'a Team,
    allowance: &'a Allowance,
}

impl Step<'_> {
    /// Returns true under pressure, which follows a face.
    fn is_pressed(&self) -> bool {
        self.to.loads.iter().any(FaceLoad::follows)
    }
}

/// Flow in the tangent of an iteration. Rounding decides whether a point on its yield surface yields at the beginning of
/// a step, and a body with both kinds of points deforms unevenly. So no point yields in the first iteration, which is
/// right for a body that unloads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Flow {
    Not,
    AsItIs,
}

/// The equations of a step.
struct Balance<'a> {
    equilibrium: &'a Equilibrium,
    step: &'a Step<'a>,
    /// No point yields in the tangent of the first iteration.
    starts_elastic: bool,
    iterations: RefCell<Iterations>,
}

impl<'a> Equations for Balance<'a> {
    type Trial = Trial<'a>;

    fn at(&self, u: &[[f64; 3]]) -> Result<Trial<'a>, Failure> {
        self.equilibrium.at(self.step, u)
    }

    fn change(
        &self,
        u: &[[f64; 3]],
        now: &Trial,
        is_first: bool,
    ) -> Result<Vec<[f64; 3]>, Failure> {
        let flow = if is_first && self.starts_elastic { Flow::Not } else { Flow::AsItIs };
        let Residual { norm, wanted, .. } = self.residual(now);
        let load = Load { forces: &now.residual, norm, wanted };
        let mut iterations = self.iterations.borrow_mut();
        if is_first {
            iterations.begin();
        }
        self.equilibrium.change(self.step, u, (now, flow), (&mut iterations, &load))
    }

    fn residual(&self, trial: &Trial) -> Residual {
        let &Trial { norm, scale, .. } = trial;
        Residual { norm, scale, wanted: TOLERANCE * scale + self.equilibrium.rounding }
    }

    fn forces<'t>(&self, trial: &'t Self::Trial) -> &'t [[f64; 3]] {
        &trial.residual
    }

    fn softens(&self) -> bool {
        self.equilibrium.body.has_concrete()
    }

    fn unbalanced(&self, residual: f64) -> Failure {
        Failure::NoEquilibrium { residual }
    }
}

impl Equilibrium {
    /// `held` marks prescribed displacements, in addition to those that the body fixes.
    pub fn new(body: Deformable, held: &[[bool; 3]], loaded: LoadedFaces) -> Result<Self, Failure> {
        let both = |(own, held): (&[bool; 3], &[bool; 3])| [0, 1, 2].map(|a| own[a] || held[a]);
        let held: Vec<[bool; 3]> = body.fixed.iter().zip(held).map(both).collect();
        let stiffness = Stiffness::new(&body, &held, &loaded.couplings(&body));
        let stiffness = stiffness.map_err(|_| Failure::Singular)?;
        let rounding = rounding(&body);
        let rounding_of_energy = rounding_of_energy(&body);
        Ok(Self { body, loaded, stiffness, held, rounding, rounding_of_energy })
    }

    /// The undeformed body.
    pub fn rest(&self) -> Rest {
        let displacement = vec![[0.0; 3]; self.body.nodes()];
        Rest { displacement, history: vec![0.0; self.body.history()] }
    }

    /// Finds the equilibrium after a step with the courses of all points; `rest` changes only if it is found.
    pub fn step(
        &self,
        rest: &mut Rest,
        to: &Conditions,
        over: &Courses,
        allowance: &Allowance,
    ) -> Result<Found, Failure> {
        let team = &self.body.team();
        let step = Step { from: rest, to, over, team, allowance };
        let mut u = rest.displacement.clone();
        let mut now = self.at(&step, &u)?;
        let (mut residuals, mut iterations) = (Vec::new(), Iterations::default());
        if let Some(jump) = self.jump(&u, to) {
            u = sum(&u, &self.follow(&step, &now, (&u, &jump), &mut iterations)?);
            now = self.at(&step, &u)?;
            residuals.push(now.norm / now.scale);
        }
        let starts_elastic = residuals.is_empty();
        let iterations = RefCell::new(iterations);
        let balance = Balance { equilibrium: self, step: &step, starts_elastic, iterations };
        let solved = newton::solve(&balance, u, now)?;
        let iterations = balance.iterations.into_inner();
        let last = (!solved.residuals.is_empty()).then_some(iterations);
        let (u, now) = (solved.u, solved.trial);
        residuals.extend(solved.residuals);
        let is_unstable = self.is_unstable(&step, &u, &now, last);
        let found = Found {
            residuals,
            work: self.work(&step, &now.linearised),
            reactions: now.reactions,
            stored: now.stresses.energy,
            passed: self.body.largest_passed(&rest.history, &now.history),
            is_unstable,
        };
        *rest = Rest { displacement: u, history: now.history };
        Ok(found)
    }

    /// Work of the stresses over a step [J].
    fn work(&self, step: &Step, end: &Linearised) -> f64 {
        let body = &self.body;
        let gradients = |all: &[Deformed]| all.iter().map(|at| at.gradient).collect::<Vec<_>>();
        let (start, _) =
            body.deformations(&step.from.displacement, (step.over, &step.from.history), step.team);
        let path = Path {
            body,
            start: &gradients(&start),
            end: gradients(&end.deformations),
            before: &step.from.history,
            over: step.over,
        };
        path.work(step.team)
    }

    /// Change of displacements that balances a load at a trial.
    fn change(
        &self,
        step: &Step,
        u: &[[f64; 3]],
        (now, flow): (&Trial, Flow),
        (iterations, load): (&mut Iterations, &Load),
    ) -> Result<Vec<[f64; 3]>, Failure> {
        let body = &self.body;
        let assemble = || {
            let terms = Terms {
                of_group: &|group| match flow {
                    Flow::Not => now.linearised.group_without_flow(body, group),
                    Flow::AsItIs => now.linearised.group(body, group),
                },
                inertia: 0.0,
                loads: &self.loaded.stiffness(body, u, &step.to.loads, 1.0),
                is_symmetric: body.has_symmetric_tangent() && !step.is_pressed(),
            };
            Assembled {
                values: self.stiffness.matrix(body, &terms, step.team),
                is_symmetric: terms.is_symmetric,
                // Concrete may have several equilibria, between which a tangent decides.
                serves_again: flow == Flow::AsItIs && !body.has_concrete(),
            }
        };
        let change = iterations.solve((&self.stiffness, step.team), load, assemble);
        change.map_err(|_| Failure::Singular)
    }

    /// Returns true if the stiffness at an equilibrium is known not to be positive definite: that of the last iteration,
    /// or under pressure its symmetric part.
    fn is_unstable(
        &self,
        step: &Step,
        u: &[[f64; 3]],
        now: &Trial,
        last: Option<Iterations>,
    ) -> bool {
        if !(self.body.has_symmetric_tangent() && step.is_pressed()) {
            return last.is_some_and(|last| last.found_unstable((&self.stiffness, step.team)));
        }
        let terms = Terms {
            of_group: &|group| now.linearised.group(&self.body, group),
            inertia: 0.0,
            loads: &self.loaded.stiffness(&self.body, u, &step.to.loads, 1.0),
            is_symmetric: true,
        };
        self.stiffness.is_indefinite(&self.body, &terms, step.team)
    }

    /// Changes of prescribed displacements; `None` if there are none.
    fn jump(&self, u: &[[f64; 3]], to: &Conditions) -> Option<Vec<[f64; 3]>> {
        let mut jump = vec![[0.0; 3]; u.len()];
        for (node, held) in self.held.iter().enumerate() {
            for a in (0..3).filter(|&a| held[a]) {
                jump[node][a] = to.displacements[node][a] - u[node][a];
            }
        }
        jump.iter().flatten().any(|&x| x != 0.0).then_some(jump)
    }

    /// Change in which held nodes make a jump and the others follow linearly.
    fn follow(
        &self,
        step: &Step,
        now: &Trial,
        (u, jump): (&[[f64; 3]], &[[f64; 3]]),
        iterations: &mut Iterations,
    ) -> Result<Vec<[f64; 3]>, Failure> {
        let forces = match self.body.has_concrete() {
            true => self.slopes(step, now, u, jump)?,
            false => now.linearised.forces(&self.body, jump, step.team),
        };
        let forces = sum(&now.residual, &forces);
        let of_unknowns = self.stiffness.of_unknowns(&forces);
        let norm = of_unknowns.iter().map(|force| force * force).sum::<f64>().sqrt();
        let load = Load { forces: &forces, norm, wanted: 0.0 };
        let change = self.change(step, u, (now, Flow::Not), (iterations, &load))?;
        Ok(sum(&change, jump))
    }

    /// Changes of forces for a jump, from those of a small part of it. Held nodes alone move, so that concrete softens
    /// beside them first; an even tangent would keep a bar that breaks on an equilibrium that is even and not stable.
    fn slopes(
        &self,
        step: &Step,
        now: &Trial,
        u: &[[f64; 3]],
        jump: &[[f64; 3]],
    ) -> Result<Vec<[f64; 3]>, Failure> {
        let small: Vec<[f64; 3]> = jump.iter().map(|x| x.map(|x| SMALL * x)).collect();
        let moved = self.at(step, &sum(u, &small))?;
        let slope = |(before, after): (&[f64; 3], &[f64; 3])| {
            [0, 1, 2].map(|n| (after[n] - before[n]) / SMALL)
        };
        Ok(now.residual.iter().zip(&moved.residual).map(slope).collect())
    }

    fn at<'s>(&self, step: &Step<'s>, u: &[[f64; 3]]) -> Result<Trial<'s>, Failure> {
        let body = &self.body;
        step.allowance.spend(1.0, STEPS, WORK * body.space.volume.len())?;
        stay_beside_mirrors(body, u)?;
        let mut history = step.from.history.clone();
        let stresses = body.respond(u, step.over, &mut history, step.team)?;
        let (deformations, dilatations) =
            body.deformations_under(u, (step.over, &stresses), step.team);
        let internal = body.forces(&stresses, step.team);
        let mut external = step.to.forces.clone();
        self.loaded.add_forces(body, u, &step.to.loads, &mut external);
        let mut residual = sum(&internal, &external);
        let (mut norm, mut scale) = (0.0, 0.0);
        let mut reactions = vec![[0.0; 3]; u.len()];
        for (node, held) in self.held.iter().enumerate() {
            for a in 0..3 {
                scale += internal[node][a].powi(2) + external[node][a].powi(2);
                if held[a] {
                    reactions[node][a] = -residual[node][a];
                    residual[node][a] = 0.0;
                }
                norm += residual[node][a].powi(2);
            }
        }
        let before = &step.from.history[..];
        let linearised = Linearised { deformations, dilatations, before, over: step.over };
        let scale = scale.sqrt().max(f64::MIN_POSITIVE);
        Ok(Trial { linearised, stresses, residual, norm: norm.sqrt(), scale, history, reactions })
    }
}

/// Bound on the rounding of the internal forces, as a norm over the nodes [N].
pub(super) fn rounding(body: &Deformable) -> f64 {
    ROUNDING * body.wave_modulus() * stretch(body)
}

/// Bound on the rounding of the energy stored [J], which is that of a difference of invariants.
pub(super) fn rounding_of_energy(body: &Deformable) -> f64 {
    ROUNDING * body.wave_modulus() * body.space.volume.weights.iter().sum::<f64>()
}

/// Norm over the nodes of the forces of a unit stress, without cancellation [m²].
fn stretch(body: &Deformable) -> f64 {
    let volume = &body.space.volume;
    let mut sums = vec![0.0; body.nodes()];
    for point in 0..volume.len() {
        for value in volume.row(point) {
            let slope: f64 = value.gradient.iter().map(|g| g.abs()).sum();
            sums[value.node as usize] += volume.weights[point] * slope;
        }
    }
    sums.iter().map(|sum| sum * sum).sum::<f64>().sqrt()
}
