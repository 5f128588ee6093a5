//! Errors of bodies.

use crate::limits::number;
use crate::math::cholesky::SolverError;
use crate::method::damage::DamageError;
use crate::method::fem::NonlinearFailure;
use crate::method::filament;
use crate::method::inelastic::InelasticError;
use crate::method::large_strain;
use crate::method::lattice::LatticeError;
use crate::method::sph::Failure;
use crate::quantity::kelvin;
use crate::runtime::address_space::TooLittle;
use crate::runtime::allowance::Halt;

/// Reasons why a body refuses a call.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// An input is outside its limits; `index` is its place among the inputs.
    #[error("{message}")]
    Input { index: usize, message: String },
    /// An input leaves its limits during a step, after `after` seconds.
    #[error("{message}, {} s into the step", number(*after))]
    Underway { index: usize, message: String, after: f64 },
    /// The results of a step are too large for numbers.
    #[error("the solution of {body} grows beyond what numbers can hold")]
    Overflow { body: String },
    /// A step would cool a body below absolute zero.
    #[error(
        "{body} would cool to {}, below absolute zero: a negative heat flux takes more heat from it than it holds",
        kelvin(*temperature)
    )]
    BelowAbsoluteZero { body: String, temperature: f64 },
    /// Heat appeared or vanished in a step.
    #[error(
        "the heat of {body} does not balance: {missing:.1e} J appear or vanish in this step, of {passed:.1e} J that are \
         stored or have passed, as its constants, coefficients and lengths lie too far apart for double precision \
         (allowed: values nearer to those of real materials)"
    )]
    Unbalanced { body: String, missing: f64, passed: f64 },
    /// An output is too large for numbers.
    #[error(
        "the value is {0}, beyond what numbers can hold: an input or constant is far too large"
    )]
    NotFinite(f64),
    /// The nonlinear heat problem failed to advance.
    #[error("{body}: {failure}")]
    Heat { body: String, failure: NonlinearFailure },
    /// A body that yields found no equilibrium.
    #[error("{body}: {error}")]
    Equilibrium { body: String, error: InelasticError },
    /// A body that cracks found no equilibrium.
    #[error("{body}: {error}")]
    Cracking { body: String, error: DamageError },
    /// Loads on a body modelled by one part are not symmetric about its planes of symmetry.
    #[error(
        "{body}: temperatures or forces are not even about the planes of symmetry, which a body that yields, relaxes or \
         cracks needs (allowed: loads and faces that are, or `symmetry = \"none\"`)"
    )]
    Uneven { body: String },
    #[error("{0}")]
    Solver(#[from] SolverError),
    /// A step of a droplet has no physical meaning.
    #[error("{name}: {failure}")]
    Droplet { name: String, failure: Failure },
    /// A step of a solid of large strain has no physical meaning.
    #[error("{body}: {failure}")]
    LargeStrain { body: String, failure: large_strain::Failure },
    /// A step of a filament has no physical meaning.
    #[error("{body}: {failure}")]
    Filament { body: String, failure: filament::Failure },
    /// A lattice found no equilibrium.
    #[error("{body}: {error}")]
    Lattice { body: String, error: LatticeError },
    /// A reduced model could not be made.
    #[error("the body cannot be reduced: {message} (allowed: fidelity full)")]
    Reduction { message: String },
    /// The heat between two bodies in contact could not be found.
    #[error(
        "the heat between {} and {} could not be found (allowed: shorter communication steps, or a shorter `interval` \
         of the coupling)",
        sides[0],
        sides[1]
    )]
    Contact { sides: [String; 2] },
    /// The call needs more address space than the process may have.
    #[error(transparent)]
    NoRoom(#[from] TooLittle),
    /// A step was ended before it was complete.
    #[error("{body}: {halt}")]
    Halted { body: String, halt: Halt },
    /// This kind of body has no such value.
    #[error("the body has no such value")]
    NoSuchReading,
    /// The value has no derivative.
    #[error(
        "what droplets give, what follows from heat that is not linear, and running maxima are known step by step: they \
         have no derivative"
    )]
    NoRate,
}

impl BodyError {
    /// Converts an error of the inputs into one at a time within a step [s].
    pub fn underway(self, after: f64) -> Self {
        match self {
            Self::Input { index, message } => Self::Underway { index, message, after },
            other => other,
        }
    }

    /// Refuses values that are not finite.
    pub fn unless_finite(value: f64) -> Result<f64, Self> {
        if value.is_finite() { Ok(value) } else { Err(Self::NotFinite(value)) }
    }
}
