//! Newton's method for the displacements of a body.
//!
//! Whole steps come first. Where a slender body turns, they raise the residual a thousandfold, by the stretch that is of
//! second order in the angle, and take it down again in the next; a search for steps that do not raise it would creep.
//! From a state that is too far away they never settle, as where metal yields by many times its yield strain. Then the
//! way begins anew, with steps that end where the work of the residual along them vanishes, about: at the least energy,
//! which metals without softening have in a step. The last attempt halves steps while they raise the residual. A body
//! that softens has several equilibria, and halved steps from the first on stay near the last one.

use super::Failure;

/// Equations whose residual are forces on the nodes.
pub trait Equations {
    type Trial;

    /// Evaluates the residual at displacements u.
    fn at(&self, u: &[[f64; 3]]) -> Result<Self::Trial, Failure>;

    /// Finds the change of displacements that balances the linearised equations; `is_first` at the beginning.
    fn change(
        &self,
        u: &[[f64; 3]],
        now: &Self::Trial,
        is_first: bool,
    ) -> Result<Vec<[f64; 3]>, Failure>;

    fn residual(&self, trial: &Self::Trial) -> Residual;

    /// Forces on free nodes that are not balanced [N].
    fn forces<'t>(&self, trial: &'t Self::Trial) -> &'t [[f64; 3]];

    /// Returns true if a body has several equilibria.
    fn softens(&self) -> bool;

    /// The failure of a residual that does not fall, over the scale of the forces.
    fn unbalanced(&self, residual: f64) -> Failure;
}

/// Norms of forces on all nodes [N].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    pub norm: f64,
    /// That of the forces which should balance.
    pub scale: f64,
    /// Largest norm of a solution.
    pub wanted: f64,
}

/// A solution.
pub struct Solved<T> {
    pub u: Vec<[f64; 3]>,
    pub trial: T,
    /// Norm of the residual over the scale, after each iteration.
    pub residuals: Vec<f64>,
}

const ITERATIONS: usize = 25;
/// Iterations after which the residuals of whole steps fall, or the way begins anew.
const RISING: usize = 5;
/// Lengths of a Newton step that are tried before it is given up.
const LENGTHS: usize = 8;
const HALF: f64 = 0.5;
/// Least part, and part less than the whole, to which a search shortens a step.
const LEAST: f64 = 0.1;
/// Growth of the residual at which a Newton step is halved: large rotations raise it on their way.
const GROWTH: f64 = 2.0;
/// Work of the residual along a step, over that at its beginning, at which a step has passed the least energy by too
/// much.
const PAST: f64 = 0.8;
/// Part of the forces up to which a residual that falls no more is rounding: slender bodies bend by little strain.
const STALLED: f64 = 1e-7;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Steps {
    Whole,
    /// To about the least energy.
    Searched,
    /// While the residual grows.
    Halved,
}

/// Solves equations from displacements and their trial.
pub fn solve<E: Equations>(
    equations: &E,
    u: Vec<[f64; 3]>,
    now: E::Trial,
) -> Result<Solved<E::Trial>, Failure> {
    if equations.softens() {
        return iterate(equations, (u, now), Steps::Halved);
    }
    let mut now = Some(now);
    for steps in [Steps::Whole, Steps::Searched] {
        let first = now.take().map_or_else(|| equations.at(&u), Ok)?;
        match iterate(equations, (u.clone(), first), steps) {
            Err(failure @ Failure::Halted(_)) => return Err(failure),
            Err(_) => {}
            solved => return solved,
        }
    }
    let now = equations.at(&u)?;
    iterate(equations, (u, now), Steps::Halved)
}

fn iterate<E: Equations>(
    equations: &E,
    (mut u, mut now): (Vec<[f64; 3]>, E::Trial),
    steps: Steps,
) -> Result<Solved<E::Trial>, Failure> {
    let mut residuals = Vec::new();
    loop {
        let Residual { norm: before, scale, wanted } = equations.residual(&now);
        if before <= wanted {
            break;
        }
        if residuals.len() == ITERATIONS {
            return Err(equations.unbalanced(before / scale));
        }
        (u, now) = improve(equations, (&u, &now, residuals.is_empty()), steps)?;
        let Residual { norm, scale, wanted } = equations.residual(&now);
        residuals.push(norm / scale);
        if is_rounding([before, norm], scale) {
            break;
        }
        if steps == Steps::Whole && residuals.len() > RISING && norm >= before && norm > wanted {
            return Err(equations.unbalanced(norm / scale));
        }
    }
    Ok(Solved { u, trial: now, residuals })
}

/// A Newton step, shortened while the material is turned inside out, or as the search for its length asks.
fn improve<E: Equations>(
    equations: &E,
    (u, now, is_first): (&[[f64; 3]], &E::Trial, bool),
    steps: Steps,
) -> Result<(Vec<[f64; 3]>, E::Trial), Failure> {
    let before = equations.residual(now);
    let mut change = equations.change(u, now, is_first)?;
    // Work of the residual along the whole step.
    let way = change.clone();
    let along = |trial: &E::Trial| {
        let forces = equations.forces(trial).as_flattened().iter();
        forces.zip(way.as_flattened()).map(|(force, way)| force * way).sum::<f64>()
    };
    let first = along(now);
    for _ in 0..LENGTHS {
        let next = sum(u, &change);
        let part = match equations.at(&next) {
            Ok(trial) => {
                let (norm, last) = (equations.residual(&trial).norm, along(&trial));
                let (is_fine, part) = match steps {
                    Steps::Whole => (true, HALF),
                    Steps::Searched => (last > -PAST * first, first / (first - last)),
                    Steps::Halved => (norm < GROWTH * before.norm, HALF),
                };
                if norm.is_finite() && is_fine {
                    return Ok((next, trial));
                }
                if part.is_finite() { part.clamp(LEAST, 1.0 - LEAST) } else { HALF }
            }
            Err(Failure::Halted(halt)) => return Err(halt.into()),
            Err(_) => HALF,
        };
        change.iter_mut().flatten().for_each(|x| *x *= part);
    }
    Err(equations.unbalanced(before.norm / before.scale))
}

/// Returns true if an iteration that took a residual to another did not halve it, and it is small beside the forces.
fn is_rounding([before, after]: [f64; 2], scale: f64) -> bool {
    after > 0.5 * before && after <= STALLED * scale
}

pub fn sum(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<[f64; 3]> {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|n| a[n] + b[n])).collect()
}

pub fn difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<[f64; 3]> {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|n| a[n] - b[n])).collect()
}
