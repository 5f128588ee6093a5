//! Interface of all kinds of bodies. [`Body`] has the life cycle and the readings. Traits with defaults hold
//! capabilities that few bodies have.

mod advice;
mod approach;
mod conductor;
mod events;
mod giver;
mod linear;
mod maxima;
mod resources;
mod structured;

use std::any::Any;

pub use advice::{Advice, Occasion};
pub use approach::Approach;
pub use conductor::Conductor;
pub use events::Events;
pub use giver::{Given, Giver};
pub use linear::Linear;
pub use maxima::Maxima;
pub use resources::Resources;
pub use structured::Structured;

use super::{BodyError, Reading};
use crate::inputs::InputPath;
use crate::method::fem::NodalFields;
use crate::method::sph::ParticleFields;
use crate::port::Surface;
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;
use crate::state::Layout;

/// A body of a scene: everything that is known before time starts. Its state is a flat vector.
pub trait Body: Giver + Maxima + Approach + Events + Advice + Resources + Send + Sync {
    fn name(&self) -> &str;

    /// Returns the state at time zero.
    fn initial_state(&self) -> Vec<f64>;

    /// Returns the fields of a state, unless no state of this body has its length.
    fn layout(&self, state: &[f64]) -> Option<Layout>;

    /// Refuses a vector that no run of this body produces, with the reason; `inputs` are those of the moment.
    fn check_state(&self, state: &[f64], inputs: &[f64]) -> Result<(), String>;

    /// Refuses inputs that make no sense for this body.
    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError>;

    /// Creates the memo of inputs held constant and of the transfers received during the last step. Readings of the
    /// body extend it.
    fn memo(&self, inputs: &[f64], received: &[Received]) -> Memo;

    /// Keeps those parts of the memo of other inputs that remain valid under the new inputs and the same state.
    fn carry_over(&self, _from: Memo, _to: &mut Memo) {}

    /// Discards the parts that follow from the state; those of the loads remain.
    fn forget_state(&self, _memo: &mut Memo) {}

    /// Advances a state and returns the transfer through the port below, if there is one. `memo` is that of the inputs
    /// at the beginning, unless these change. After a failure the state is unchanged or unusable: the caller keeps a
    /// copy.
    fn advance(
        &self,
        state: &mut Vec<f64>,
        memo: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError>;

    /// Reads a value; the memo belongs to the state and its loads.
    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError>;

    /// Returns true if a value follows inputs without delay.
    fn follows_at_once(&self, _reading: &Reading) -> bool {
        false
    }

    /// Returns the values at all nodes or particles.
    fn fields(&self, state: &[f64], memo: &mut Memo) -> Result<Fields, BodyError>;

    /// Returns the body as a linear one, if it is linear between steps.
    fn linear(&self) -> Option<&dyn Linear> {
        None
    }

    /// Returns the body as a conductor, if its faces respond to heat.
    fn conductor(&self) -> Option<&dyn Conductor> {
        None
    }
}

/// Cached results of a state, in a form of the body's own.
pub type Memo = Box<dyn Any + Send + Sync>;

/// Loads on a body while it advances.
pub struct Acts<'a> {
    /// The inputs, from the beginning of the advance on.
    pub path: &'a InputPath,
    /// [s]
    pub duration: f64,
    /// Transfers through the ports of the body's faces.
    pub received: &'a [Received<'a>],
    /// The face on which the body stands, if that responds to heat.
    pub below: Option<&'a Surface>,
}

impl Acts<'_> {
    /// Advances through both halves of the time, one after the other.
    pub fn in_halves(
        &self,
        mut advance: impl FnMut(&Acts) -> Result<(), BodyError>,
    ) -> Result<(), BodyError> {
        let duration = 0.5 * self.duration;
        for part in 0..2 {
            let path = self.path.from(f64::from(part) * duration);
            advance(&Acts { path: &path, duration, ..*self })?;
        }
        Ok(())
    }
}

/// A transfer through a face.
#[derive(Debug, Clone, Copy)]
pub struct Received<'a> {
    pub face: FaceName,
    pub given: &'a Given,
}

/// Values of a whole body.
pub enum Fields {
    Nodes(NodalFields),
    Particles(ParticleFields),
}
