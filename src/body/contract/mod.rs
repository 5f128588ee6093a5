//! What every kind of body answers to. Its life and its readings are in [`Body`]; what few bodies have stands beside it
//! in traits of their own, with defaults.

mod advice;
mod conductor;
mod giver;
mod linear;
mod maxima;
mod resources;

use std::any::Any;

pub use advice::{Advice, Occasion};
pub use conductor::Conductor;
pub use giver::{Given, Giver};
pub use linear::Linear;
pub use maxima::Maxima;
pub use resources::Resources;

use super::{BodyError, Reading};
use crate::inputs::InputPath;
use crate::method::fem::NodalFields;
use crate::method::sph::ParticleFields;
use crate::port::Surface;
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;
use crate::state::Layout;

/// A body of a scene: everything known of it before time starts. What changes is a flat vector, its state.
pub trait Body: Giver + Maxima + Advice + Resources + Send + Sync {
    fn name(&self) -> &str;

    /// The state at time zero.
    fn initial_state(&self) -> Vec<f64>;

    /// The fields of a state; nothing if it has a length that no state of this body has.
    fn layout(&self, state: &[f64]) -> Option<Layout>;

    /// Refuses a vector that no run of this body leads to, with what is wrong with it; `inputs` are those of
    /// the moment.
    fn check_state(&self, state: &[f64], inputs: &[f64]) -> Result<(), String>;

    /// Refuses inputs that make no sense for this body.
    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError>;

    /// What follows from inputs, held, and from what was received through ports during the last step; filled further
    /// as the body is read.
    fn memo(&self, inputs: &[f64], received: &[Received]) -> Memo;

    /// Takes over from the memo of other inputs what is the same under these, of the same state.
    fn carry_over(&self, _from: Memo, _to: &mut Memo) {}

    /// Forgets what follows from the state; what acts stays.
    fn forget_state(&self, _memo: &mut Memo) {}

    /// Advances a state; what was given through the port below, if there is one. `memo` is that of the inputs at the
    /// beginning, unless these change. A failure leaves the state as it was, or of no use: the caller has a copy.
    fn advance(
        &self,
        state: &mut Vec<f64>,
        memo: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError>;

    /// A value, where the memo is that of what acts and of the state.
    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError>;

    /// Whether a value follows inputs without delay.
    fn follows_at_once(&self, _reading: &Reading) -> bool {
        false
    }

    /// Values at all nodes or particles.
    fn fields(&self, state: &[f64], memo: &mut Memo) -> Result<Fields, BodyError>;

    /// The body as one that is linear between steps, if it is.
    fn linear(&self) -> Option<&dyn Linear> {
        None
    }

    /// The body as one whose faces answer to heat, if they do.
    fn conductor(&self) -> Option<&dyn Conductor> {
        None
    }
}

/// What a body remembers of a state, in a form of its own.
pub type Memo = Box<dyn Any + Send + Sync>;

/// What acts on a body while it advances.
pub struct Acts<'a> {
    /// The inputs, from the beginning of the advance on.
    pub path: &'a InputPath,
    /// [s]
    pub duration: f64,
    /// Through the ports of the body's faces.
    pub received: &'a [Received<'a>],
    /// What the body stands on, if that answers to it.
    pub below: Option<&'a Surface>,
}

/// What comes through a face.
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
