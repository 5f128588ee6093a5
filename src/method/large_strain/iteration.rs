//! Linear systems of the iterations of a step.
//!
//! Tangents of one step differ little from each other, and a factor of a large one costs as much as some tens of
//! solutions with it. So the factor of one iteration is kept for later ones: as a preconditioner of conjugate gradients
//! with their exact tangents, which take Newton's method as far as solutions by factors do. Where they do not converge
//! within the cost of a factor, the tangent is factored, and its factor is kept. The last tangent itself serves once
//! more where the residual falls so fast that the change of the tangent does not matter.
//!
//! Nothing outlives a step, and what is kept follows from residuals and counts alone.

use super::tangent::{Factor, Singular, Stiffness};
use crate::math::cholesky::{RoundedCholesky, SparseCholesky};
use crate::math::conjugate_gradients::{Operator, solve_within};
use crate::math::random::Random;
use crate::runtime::parallel::Team;

/// Iterations of conjugate gradients, at most, which cost about two thirds of a factor.
const MOST: usize = 16;
/// Part of the residual at a factor to which it has to fall before the factor is worth keeping: its fall in a Newton
/// step is about half of the relative change of the tangent along that step.
const FALLEN: f64 = 0.2;
/// Largest residual of a linear system, over that before an iteration.
const LOOSEST: f64 = 1e-2;
/// Part that errors of linear systems may have in what an iteration leaves.
const PART: f64 = 0.1;
/// Part of the residual wanted up to which the last tangent may leave it.
const AGAIN: f64 = 0.02;
/// Relative residual at which conjugate gradients have converged for a random load.
const SURE: f64 = 1e-6;
const SEED: u64 = 1;

/// What the iterations of a step have left for later ones.
#[derive(Default)]
pub struct Iterations {
    kept: Option<Kept>,
    tangent: Option<Tangent>,
    /// Norm of the residual before the last iteration.
    before: Option<f64>,
    /// Iterations with a kept factor did not converge.
    has_failed: bool,
    has_begun: bool,
}

/// A factor of a positive definite tangent, and the norm of the residual where it was made.
struct Kept {
    factor: KeptFactor,
    norm: f64,
}

enum KeptFactor {
    /// Of the last tangent.
    Whole(SparseCholesky),
    /// Of an earlier one.
    Rounded(RoundedCholesky),
}

/// The tangent of an iteration.
struct Tangent {
    assembled: Assembled,
    /// Unknown where no factor was made.
    is_indefinite: Option<bool>,
}

/// The values of a tangent that is assembled.
pub struct Assembled {
    pub values: Vec<f64>,
    pub is_symmetric: bool,
    /// The next iteration may take it, too.
    pub serves_again: bool,
}

/// Forces that an iteration balances.
pub struct Load<'a> {
    pub forces: &'a [[f64; 3]],
    /// Norm of the residual, and the largest one of a solution.
    pub norm: f64,
    pub wanted: f64,
}

/// A tangent with a preconditioner.
struct Preconditioned<'a> {
    stiffness: &'a Stiffness,
    tangent: &'a [f64],
    factor: &'a RoundedCholesky,
    team: &'a Team,
}

impl Operator for Preconditioned<'_> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.stiffness.product(self.tangent, x, out, self.team);
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        out.copy_from_slice(residual);
        self.factor.solve_in_place(out, self.team);
    }
}

impl KeptFactor {
    fn rounded(self, team: &Team) -> RoundedCholesky {
        match self {
            Self::Whole(factor) => factor.rounded(team),
            Self::Rounded(factor) => factor,
        }
    }
}

impl Iterations {
    /// Begins a way of Newton's method. One that ended without a solution has left nothing of use.
    pub fn begin(&mut self) {
        if self.has_begun {
            *self = Self::default();
        }
        self.has_begun = true;
    }

    /// Solves for the change of displacements under a load; `assemble` computes the tangent, where a new one is needed.
    pub fn solve(
        &mut self,
        within: (&Stiffness, &Team),
        load: &Load,
        assemble: impl FnOnce() -> Assembled,
    ) -> Result<Vec<[f64; 3]>, Singular> {
        let fall = self.before.replace(load.norm).map_or(1.0, |before| load.norm / before);
        if fall * load.norm <= AGAIN * load.wanted
            && let Some(change) = self.solve_again(within, load)
        {
            return Ok(change);
        }
        self.tangent = None;
        let assembled = assemble();
        // Newton's method squares what it leaves of a residual, relative to that before.
        let tolerance = (PART * fall * fall).max(PART * load.wanted / load.norm);
        if assembled.is_symmetric && within.0.has_costly_factors && self.is_near(load) {
            let forces = within.0.of_unknowns(load.forces);
            let change = self.iterate(within, &assembled.values, (&forces, tolerance.min(LOOSEST)));
            if let Some(change) = change {
                self.tangent = Some(Tangent { assembled, is_indefinite: None });
                return Ok(within.0.of_nodes(&change));
            }
            self.has_failed = true;
        }
        self.factor(within, load, assembled)
    }

    /// Returns true if the kept factor is one of a tangent that is close to the present one.
    fn is_near(&self, load: &Load) -> bool {
        let is_near = |kept: &Kept| load.norm <= FALLEN * kept.norm;
        !self.has_failed && self.kept.as_ref().is_some_and(is_near)
    }

    /// Solves with the last tangent, if there is one that serves again.
    fn solve_again(
        &mut self,
        (stiffness, team): (&Stiffness, &Team),
        load: &Load,
    ) -> Option<Vec<[f64; 3]>> {
        let tangent = self.tangent.take_if(|tangent| tangent.assembled.serves_again)?;
        let mut forces = stiffness.of_unknowns(load.forces);
        let change = match &self.kept.as_ref()?.factor {
            KeptFactor::Whole(factor) => {
                factor.solve_in_place(&mut forces);
                Some(forces)
            }
            KeptFactor::Rounded(_) => {
                let tolerance = (PART * load.wanted / load.norm).min(LOOSEST);
                self.iterate((stiffness, team), &tangent.assembled.values, (&forces, tolerance))
            }
        };
        self.tangent = Some(tangent);
        change.map(|change| stiffness.of_nodes(&change))
    }

    /// Solves with a tangent by conjugate gradients and the kept factor; `None` if they do not converge.
    fn iterate(
        &mut self,
        (stiffness, team): (&Stiffness, &Team),
        tangent: &[f64],
        (forces, tolerance): (&[f64], f64),
    ) -> Option<Vec<f64>> {
        let Kept { factor, norm } = self.kept.take()?;
        let factor = factor.rounded(team);
        let operator = Preconditioned { stiffness, tangent, factor: &factor, team };
        let solved = solve_within(MOST, &operator, forces, tolerance, team);
        self.kept = Some(Kept { factor: KeptFactor::Rounded(factor), norm });
        Some(solved.ok()?.0)
    }

    /// Solves with a factor of a tangent, which is kept.
    fn factor(
        &mut self,
        (stiffness, team): (&Stiffness, &Team),
        load: &Load,
        assembled: Assembled,
    ) -> Result<Vec<[f64; 3]>, Singular> {
        self.kept = None;
        let factor = stiffness.factor_values(&assembled.values, assembled.is_symmetric, team)?;
        let change = stiffness.solve(&factor, load.forces);
        let is_indefinite = Some(matches!(factor, Factor::Indefinite(_)));
        self.tangent = Some(Tangent { assembled, is_indefinite });
        self.kept = match factor {
            Factor::Positive(factor) => {
                Some(Kept { factor: KeptFactor::Whole(factor), norm: load.norm })
            }
            Factor::Indefinite(_) | Factor::General(_) => None,
        };
        Ok(change)
    }

    /// Returns true if the last tangent is symmetric and not positive definite.
    ///
    /// Where no factor was made of it, conjugate gradients with a random load decide. Their residual is a polynomial of
    /// the preconditioned tangent, 1 at zero, whose roots are positive where no curvature on the way was negative. So
    /// it is larger than 1 at a negative eigenvalue and close to 1 at one close to zero: along such a mode the residual
    /// does not fall. Of n unknowns a mode has about the part `n^(−1/2)` of a random load, thousands of times [`SURE`]
    /// in a large body, so there is no such mode where iterations converge. The preconditioner does not matter, as the
    /// signs of eigenvalues are the same for all that are positive definite (J. J. Sylvester 1852). Where iterations do
    /// not converge, a factor decides.
    pub fn found_unstable(mut self, (stiffness, team): (&Stiffness, &Team)) -> bool {
        let Some(tangent) = self.tangent.take() else { return false };
        tangent.is_indefinite.unwrap_or_else(|| {
            let mut random = Random::of(SEED);
            let values = tangent.assembled.values;
            let forces: Vec<f64> =
                (0..stiffness.unknowns()).map(|_| random.number() - 0.5).collect();
            self.iterate((stiffness, team), &values, (&forces, SURE)).is_none()
                && stiffness.is_indefinite_matrix(&values, team)
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::laws::solid::large_strain::LargeStrainLaw;
    use crate::method::large_strain::{
        Conditions, Course, Deformable, Equilibrium, LoadedFaces, Rest,
    };
    use crate::runtime::allowance::{Allowance, Interrupt};
    use crate::space::{Form, Mesh, finite_elements};

    const LENGTH: f64 = 16.0;
    /// Strain at which a column between two faces that do not turn buckles: `4 π² I/(A L²)` (L. Euler 1744).
    const BUCKLES: f64 = 3.29 / (LENGTH * LENGTH);

    /// Compresses a straight column by multiples of the strain at which it buckles, with kept factors or without;
    /// returns whether each equilibrium is unstable.
    fn compressed(strains: &[f64], is_kept: bool, threads: usize) -> (Rest, Vec<bool>) {
        let mesh = Mesh::of_box(Form::Solid, [0.0; 3], [1.0, 1.0, LENGTH], [2, 2, 48]);
        let law = LargeStrainLaw::elastic(1e6, 5e5);
        let body = Deformable::new(finite_elements(&mesh), law, 1.0, [false; 2], threads);
        let nodes = body.space.nodes.clone();
        let is_held = |at: &[f64; 3]| [at[2] == 0.0 || at[2] == LENGTH; 3];
        let held: Vec<[bool; 3]> = nodes.iter().map(is_held).collect();
        let mut equilibrium = Equilibrium::new(body, &held, LoadedFaces::default()).unwrap();
        equilibrium.stiffness.has_costly_factors = is_kept;
        let over = equilibrium.body.in_all(Course::NONE);
        let (mut rest, interrupt) = (equilibrium.rest(), Interrupt::default());
        let step = |strain: &f64| {
            let moved = |at: &[f64; 3]| [0.0, 0.0, -strain * BUCKLES * at[2]];
            let to = Conditions {
                forces: vec![[0.0; 3]; nodes.len()],
                displacements: nodes.iter().map(moved).collect(),
                loads: Vec::new(),
            };
            let allowance = Allowance::of_step(&interrupt);
            equilibrium.step(&mut rest, &to, &over, &allowance).unwrap().is_unstable
        };
        let unstable = strains.iter().map(step).collect();
        (rest, unstable)
    }

    /// No load of a straight column has a part along the mode in which it buckles.
    #[test]
    fn buckling_is_seen_where_no_load_has_a_part_along_it() {
        for (strains, wanted) in [(&[0.2, 0.5][..], [false; 2]), (&[0.3, 3.0], [false, true])] {
            let [(kept, found), (each, of_factors)] =
                [true, false].map(|is_kept| compressed(strains, is_kept, 1));
            assert_eq!((&found[..], &of_factors[..]), (&wanted[..], &wanted[..]), "{strains:?}");
            assert_ne!(kept, each, "a factor has served again");
            let [kept, each] = [&kept, &each].map(|rest| rest.displacement.as_flattened());
            let pairs = kept.iter().zip(each);
            pairs.for_each(|(own, other)| assert!((own - other).abs() < 1e-9 * LENGTH));
        }
    }

    #[test]
    fn iterations_are_bit_identical_for_any_number_of_threads() {
        let sequential = compressed(&[0.4, 1.0], true, 1);
        for threads in [2, 3] {
            assert!(sequential == compressed(&[0.4, 1.0], true, threads), "{threads} threads");
        }
    }
}
