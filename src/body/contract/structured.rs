//! Bodies whose state is one structure with fields.

use super::{
    Acts, Advice, Approach, Body, Events, Fields, Given, Giver, Maxima, Memo, Received, Resources,
};
use crate::body::{BodyError, Reading};
use crate::method::sph::ParticleFields;
use crate::runtime::allowance::Allowance;
use crate::state::{self, Layout, expect_like, layout_like, load, store_all, stored};

/// A body whose state is one structure with fields, and whose readings are those of a view of it that is made once a
/// state. It is a [`Body`] by that.
pub trait Structured:
    Giver + Maxima + Approach + Events + Advice + Resources + Send + Sync
{
    type State: state::Fields + Clone;
    /// Results of a state from which values are read.
    type View: Send + Sync + 'static;

    fn name(&self) -> &str;

    /// Returns the state at time zero.
    fn start(&self) -> &Self::State;

    /// Returns a state of this many numbers, with any values; `None` if no state of this body has as many.
    fn of_length(&self, numbers: usize) -> Option<Self::State> {
        let mut start = self.start().clone();
        (Layout::of(&mut start).len() == numbers).then_some(start)
    }

    /// Refuses a state that no run of this body produces, with the reason.
    fn check(&self, state: &Self::State) -> Result<(), String>;

    /// Refuses inputs that make no sense for this body.
    fn check_inputs(&self, _inputs: &[f64]) -> Result<(), BodyError> {
        Ok(())
    }

    /// Advances a state and returns the transfer through the port below, if there is one.
    fn advance(
        &self,
        state: &mut Self::State,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError>;

    /// Computes the results of a state under inputs.
    fn view(&self, state: Self::State, inputs: &[f64]) -> Result<Self::View, BodyError>;

    /// Reads a value of a view.
    fn read(&self, view: &Self::View, reading: &Reading) -> Result<f64, BodyError>;

    /// Returns true if a value follows inputs without delay.
    fn follows_at_once(&self, _reading: &Reading) -> bool {
        false
    }

    /// Returns the particles that stand for a state under inputs in files.
    fn drawn(&self, state: Self::State, inputs: &[f64]) -> Result<ParticleFields, BodyError>;

    /// Returns the state of a list of numbers; that at time zero if the list is of another length.
    fn structure(&self, numbers: &[f64]) -> Self::State {
        let Some(mut state) = self.of_length(numbers.len()) else { return self.start().clone() };
        load(&mut state, numbers);
        state
    }
}

/// Inputs, and the view of a state under them once it is read.
struct Seen<View> {
    inputs: Vec<f64>,
    view: Option<View>,
}

impl<View: 'static> Seen<View> {
    fn of_mut(memo: &mut Memo) -> &mut Self {
        memo.downcast_mut().expect("a memo is that of the body that made it")
    }
}

impl<T: Structured> Body for T {
    fn name(&self) -> &str {
        Structured::name(self)
    }

    fn initial_state(&self) -> Vec<f64> {
        stored(self.start())
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        layout_like(&self.of_length(state.len())?, state)
    }

    fn check_state(&self, state: &[f64], _: &[f64]) -> Result<(), String> {
        let name = Structured::name(self);
        if self.of_length(state.len()).is_none() {
            return expect_like(self.start(), state, name);
        }
        self.check(&self.structure(state)).map_err(|reason| format!("{name}: {reason}"))
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        Structured::check_inputs(self, inputs)
    }

    fn memo(&self, inputs: &[f64], _: &[Received]) -> Memo {
        Box::new(Seen::<T::View> { inputs: inputs.to_vec(), view: None })
    }

    fn forget_state(&self, memo: &mut Memo) {
        Seen::<T::View>::of_mut(memo).view = None;
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let mut own = self.structure(state);
        let given = Structured::advance(self, &mut own, acts, allowance)?;
        store_all(&mut own, state);
        if !state.iter().all(|value| value.is_finite()) {
            return Err(BodyError::Overflow { body: Structured::name(self).to_owned() });
        }
        Ok(given)
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let Seen { inputs, view } = Seen::of_mut(memo);
        let seen = match view.take() {
            Some(known) => known,
            None => self.view(self.structure(state), inputs)?,
        };
        Structured::read(self, view.insert(seen), reading)
    }

    fn follows_at_once(&self, reading: &Reading) -> bool {
        Structured::follows_at_once(self, reading)
    }

    fn fields(&self, state: &[f64], memo: &mut Memo) -> Result<Fields, BodyError> {
        let inputs = &Seen::<T::View>::of_mut(memo).inputs;
        Ok(Fields::Particles(self.drawn(self.structure(state), inputs)?))
    }
}
