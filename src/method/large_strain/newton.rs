//! Newton's method for the displacements of a body.
//!
//! Whole steps come first. Where a slender body turns, they raise the residual a thousandfold, by the stretch that is of
//! second order in the angle, and take it down again in the next; a search for steps that do not raise it would creep.
//! From a state that is too far away they never settle. Then the way begins anew, with steps that are halved while they
//! raise the residual. A body that softens has several equilibria, and halved steps from the first on stay near the last
//! one.

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
/// Halvings of a Newton step before it is given up.
const HALVINGS: usize = 8;
/// Growth of the residual at which a Newton step is halved: large rotations raise it on their way.
const GROWTH: f64 = 2.0;
/// Part of the forces up to which a residual that falls no more is rounding: slender bodies bend by little strain.
const STALLED: f64 = 1e-7;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Steps {
    Whole,
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
    match iterate(equations, (u.clone(), now), Steps::Whole) {
        Err(failure @ Failure::Halted(_)) => Err(failure),
        Err(_) => {
            let now = equations.at(&u)?;
            iterate(equations, (u, now), Steps::Halved)
        }
        solved => solved,
    }
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

/// A Newton step, halved while the material is turned inside out, or while the residual grows as well.
fn improve<E: Equations>(
    equations: &E,
    (u, now, is_first): (&[[f64; 3]], &E::Trial, bool),
    steps: Steps,
) -> Result<(Vec<[f64; 3]>, E::Trial), Failure> {
    let before = equations.residual(now);
    let mut change = equations.change(u, now, is_first)?;
    for _ in 0..HALVINGS {
        let next = sum(u, &change);
        match equations.at(&next) {
            Ok(trial) => {
                let norm = equations.residual(&trial).norm;
                let is_fine = steps == Steps::Whole || norm < GROWTH * before.norm;
                if norm.is_finite() && is_fine {
                    return Ok((next, trial));
                }
            }
            Err(Failure::Halted(halt)) => return Err(halt.into()),
            Err(_) => {}
        }
        change.iter_mut().flatten().for_each(|x| *x *= 0.5);
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
