//! What an instance should be, and so what it should answer.

use std::collections::BTreeSet;
use std::ffi::c_int;

use impinge::limits::step;
use impinge::variables::Causality;

use super::call::{Call, INSTANCES, Nulls, PLACES, Place, Point, StateCall};
use super::world::{Kind, World};
use crate::functions::allowed_phases;
use crate::master::{DISCARD, ERROR, OK, WARNING};

/// What a call should come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected {
    /// Done, perhaps with a warning about files.
    Done,
    Refused,
    /// Done, or no answer to this question.
    Asked,
    /// Odd values may or may not make sense together.
    Either,
}

impl Expected {
    pub fn fits(self, status: c_int) -> bool {
        match self {
            Expected::Done => [OK, WARNING].contains(&status),
            Expected::Refused => status == ERROR,
            Expected::Asked => [OK, DISCARD].contains(&status),
            Expected::Either => (OK..=ERROR).contains(&status),
        }
    }
}

/// What is known of one instance.
#[derive(Debug, Clone)]
pub struct Oracle {
    /// Phase, by its letter in the table of legal calls; `f` after a failed step.
    pub phase: char,
    pub time: f64,
    stop: Option<f64>,
    /// Variables whose values are none of which every model can be built.
    odd: BTreeSet<u32>,
    /// Whether a step or a derivative was such that later values are no longer known to be finite.
    wild: bool,
}

/// A saved state: the instance that saved it, none if that is gone, and what it was like.
type Saved = (Option<usize>, Oracle);

/// What the places for saved states hold.
#[derive(Default)]
pub struct Shelf {
    states: [[Option<Saved>; PLACES]; INSTANCES],
    /// What serialised instances were like.
    bytes: [[Option<Oracle>; PLACES]; INSTANCES],
}

impl Shelf {
    fn state(&self, (i, k): Place) -> Option<&Saved> {
        self.states[i][k].as_ref()
    }

    /// What an instance saved in a place, if it did.
    fn own(&self, place: Place, instance: usize) -> Option<&Oracle> {
        let (owner, oracle) = self.state(place)?;
        (*owner == Some(instance)).then_some(oracle)
    }

    /// Marks the states of an instance that is gone.
    pub fn forget(&mut self, instance: usize) {
        for (owner, _) in self.states.iter_mut().flatten().flatten() {
            if *owner == Some(instance) {
                *owner = None;
            }
        }
    }

    /// Follows a call of an instance that was done.
    fn follow(&mut self, call: StateCall, instance: usize, oracle: &Oracle) {
        match call {
            StateCall::Save { into: (i, k) } => {
                self.states[i][k] = Some((Some(instance), oracle.clone()));
            }
            StateCall::Free { of: (i, k) } => self.states[i][k] = None,
            StateCall::Serialize { of: (i, k), .. } => {
                self.bytes[i][k] = self.own((i, k), instance).cloned();
            }
            StateCall::Deserialize { bytes: (i, k), into: (j, l), .. } => {
                let oracle = self.bytes[i][k].clone();
                self.states[j][l] = oracle.map(|oracle| (Some(instance), oracle));
            }
            StateCall::SaveNowhere | StateCall::Restore { .. } => {}
        }
    }
}

impl Oracle {
    pub fn new() -> Self {
        Self { phase: 'i', time: 0.0, stop: None, odd: BTreeSet::new(), wild: false }
    }

    /// Whether values of outputs can be relied on.
    pub fn is_plain(&self) -> bool {
        self.odd.is_empty() && !self.wild
    }

    fn if_plain(&self, expected: Expected) -> Expected {
        if self.is_plain() { expected } else { Expected::Either }
    }

    /// What `call` on instance `own` should come to.
    pub fn expects(&self, world: &World, call: &Call, own: usize, shelf: &Shelf) -> Expected {
        if self.phase == 'f' {
            return Expected::Either;
        }
        if !allowed_phases(call.name()).contains(self.phase) {
            return Expected::Refused;
        }
        let refused_if =
            |refused: bool, otherwise| if refused { Expected::Refused } else { otherwise };
        let offered =
            |offered: bool, otherwise| if offered { otherwise } else { Expected::Refused };
        match call {
            Call::Logging { categories, nulls, .. } => {
                let known = categories.iter().all(|name| *name != "gossip");
                let empty = categories.is_empty() && *nulls != Nulls::AllOfMany;
                let good = empty || *nulls == Nulls::None && known;
                refused_if(!good, Expected::Done)
            }
            Call::Setup { tolerance, start, stop } => {
                let bad_stop = stop.is_some_and(|stop| !(stop.is_finite() && stop > *start));
                let bad_tolerance = tolerance.is_some_and(|t| !(t.is_finite() && t > 0.0));
                refused_if(!start.is_finite() || bad_stop || bad_tolerance, Expected::Done)
            }
            Call::Plain("fmi2ExitInitializationMode") => self.if_plain(Expected::Done),
            Call::Plain(_) => Expected::Done,
            Call::Exchange(_) => Expected::Refused,
            Call::Get { kind, references, nulls } => self.get(world, *kind, references, *nulls),
            Call::Set { kind, references, values, nulls } => {
                let good = |(reference, value)| self.takes(world, *kind, reference, value);
                let all = references.iter().copied().zip(values.iter().copied()).all(good);
                refused_if(is_null(references, *nulls) || !all, Expected::Done)
            }
            Call::SetTexts { references, values, nulls } => {
                let good = |r: &u32| self.takes(world, Kind::String, *r, 0.0);
                let texts =
                    values.iter().all(|text| text.is_some_and(|t| str::from_utf8(t).is_ok()));
                let all = references.iter().all(good) && texts;
                refused_if(is_null(references, *nulls) || !all, Expected::Done)
            }
            Call::Step { point, size } => self.step(*point, *size),
            Call::Status { null, .. } => refused_or_asked(*null),
            Call::State(state) => {
                offered(world.offers.states, state_call(world, *state, own, shelf))
            }
            Call::Directional { unknowns, knowns, changes, nulls } => {
                // At time zero parameters are knowns too.
                let may_be_known = |causality| match causality {
                    Causality::Input => true,
                    Causality::Parameter => self.phase == 'm',
                    Causality::Output => false,
                };
                let good = world.offers.directional
                    && !is_null(knowns, *nulls)
                    && (*nulls != Nulls::AllOfMany)
                    && all_of(world, unknowns, Causality::Output)
                    && all_are(world, knowns, may_be_known)
                    && changes.iter().all(|change| change.is_finite());
                let tame = changes.iter().all(|change| change.abs() < 1e9);
                let done = if tame { self.if_plain(Expected::Done) } else { Expected::Either };
                refused_if(!good, done)
            }
            Call::InputDerivatives { references, orders, values, nulls } => {
                let good = world.offers.input_derivatives
                    && !is_null(references, *nulls)
                    && all_of(world, references, Causality::Input)
                    && values.iter().all(|value| value.is_finite())
                    && orders.iter().all(|order| *order > 0);
                // How high the order may be is the unit's to say.
                let low = orders.iter().all(|order| *order == 1);
                refused_if(!good, if low { Expected::Done } else { Expected::Either })
            }
            Call::OutputDerivatives { references, orders, nulls } => {
                let good = world.offers.output_derivatives
                    && !is_null(references, *nulls)
                    && all_of(world, references, Causality::Output)
                    && orders.iter().all(|order| *order > 0);
                let low = orders.iter().all(|order| *order == 1);
                let done = if low { self.if_plain(Expected::Done) } else { Expected::Either };
                refused_if(!good, done)
            }
            Call::Instantiate(_) | Call::Free => Expected::Done,
        }
    }

    fn get(&self, world: &World, kind: Kind, references: &[u32], nulls: Nulls) -> Expected {
        let known = references.iter().all(|&reference| world.kind(reference) == Some(kind));
        if is_null(references, nulls) || !known {
            return Expected::Refused;
        }
        let is_output =
            |r: &u32| world.variable(*r).is_some_and(|v| v.causality() == Causality::Output);
        let asks_model = references.iter().any(is_output);
        if asks_model { self.if_plain(Expected::Done) } else { Expected::Done }
    }

    /// Whether a variable may be set to a value now.
    fn takes(&self, world: &World, kind: Kind, reference: u32, value: f64) -> bool {
        let Some(variable) = world.variable(reference) else { return false };
        let value = if kind == Kind::Integer { f64::from(value as i32) } else { value };
        let settable = match variable.causality() {
            Causality::Output => false,
            Causality::Parameter => self.phase != 's',
            Causality::Input => true,
        };
        world.kind(reference) == Some(kind)
            && settable
            && value.is_finite()
            && variable.bounds.hold(value)
    }

    fn step(&self, point: Point, size: f64) -> Expected {
        let at = point.of(self.time, size);
        let end = at + size;
        if !(step().bounds().hold(size) && at.is_finite()) {
            return Expected::Refused;
        }
        // Near the limits of what is taken for equal the unit may decide either way.
        let off = (at - self.time).abs();
        let room = 1e-9 * size + 1e-13 * self.time.abs();
        if off > 4.0 * room || end <= at {
            return Expected::Refused;
        }
        let beyond = self.stop.map_or(f64::NEG_INFINITY, |stop| end - stop);
        if beyond > 4.0 * room {
            return Expected::Refused;
        }
        if off > 0.25 * room || beyond > 0.0 || end <= self.time || size > 1e-2 {
            return Expected::Either;
        }
        self.if_plain(Expected::Done)
    }

    /// Follows a call that was done, or a step that was discarded.
    pub fn follow(
        &mut self,
        world: &World,
        call: &Call,
        status: c_int,
        own: usize,
        shelf: &mut Shelf,
    ) {
        if status == DISCARD && matches!(call, Call::Step { .. }) {
            self.phase = 'f';
        }
        if ![OK, WARNING].contains(&status) {
            return;
        }
        match call {
            Call::Setup { start, stop, .. } => (self.time, self.stop) = (*start, *stop),
            Call::Plain("fmi2EnterInitializationMode") => self.phase = 'm',
            Call::Plain("fmi2ExitInitializationMode") => self.phase = 's',
            Call::Plain("fmi2Terminate") => self.phase = 't',
            Call::Plain("fmi2Reset") => *self = Self::new(),
            Call::Set { references, values, .. } => {
                for (&reference, &value) in references.iter().zip(values) {
                    let (low, high) = world.plain_values(reference);
                    if (low..=high).contains(&value) {
                        self.odd.remove(&reference);
                    } else {
                        self.odd.insert(reference);
                    }
                }
            }
            Call::Step { point, size } => {
                self.time = point.of(self.time, *size) + size;
                self.wild |= *size > 1e-2 || !self.odd.is_empty();
            }
            Call::InputDerivatives { references, .. } => self.wild |= !references.is_empty(),
            Call::State(StateCall::Restore { from }) => {
                if let Some(saved) = shelf.own(*from, own) {
                    *self = saved.clone();
                }
            }
            Call::State(state) => shelf.follow(*state, own, self),
            _ => {}
        }
    }
}

fn state_call(world: &World, call: StateCall, own: usize, shelf: &Shelf) -> Expected {
    let done_if = |fine: bool| if fine { Expected::Done } else { Expected::Refused };
    let free_or_own = |place| shelf.state(place).is_none() || shelf.own(place, own).is_some();
    match call {
        StateCall::Save { into: place } | StateCall::Free { of: place } => {
            done_if(free_or_own(place))
        }
        StateCall::SaveNowhere => Expected::Refused,
        StateCall::Restore { from } => done_if(shelf.own(from, own).is_some()),
        StateCall::Serialize { of, room } => {
            done_if(world.offers.bytes && shelf.own(of, own).is_some() && room >= 0)
        }
        StateCall::Deserialize { bytes: (i, k), cut, changed, .. } => {
            let whole = cut == 0 && changed.is_none();
            done_if(world.offers.bytes && shelf.bytes[i][k].is_some() && whole)
        }
    }
}

fn refused_or_asked(null: bool) -> Expected {
    if null { Expected::Either } else { Expected::Asked }
}

/// Whether an array that must not be is null.
fn is_null(references: &[u32], nulls: Nulls) -> bool {
    match nulls {
        Nulls::None => false,
        Nulls::References | Nulls::Values => !references.is_empty(),
        Nulls::AllOfMany => true,
    }
}

fn all_of(world: &World, references: &[u32], causality: Causality) -> bool {
    all_are(world, references, |other| other == causality)
}

/// Whether all are reals of a wanted causality.
fn all_are(world: &World, references: &[u32], wanted: impl Fn(Causality) -> bool) -> bool {
    references.iter().all(|&reference| {
        world.kind(reference) == Some(Kind::Real)
            && world.variable(reference).is_some_and(|v| wanted(v.causality()))
    })
}
