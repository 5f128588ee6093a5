//! Plays scripts against the library and compares with what should happen.

use std::collections::BTreeMap;
use std::ffi::{CString, c_int};
use std::ptr::{null, null_mut};

use impinge::variables::Causality;

use super::call::{Answer, Birth, Call, INSTANCES, Kept, Line, Nulls, UNTOUCHED};
use super::oracle::{Oracle, Shelf};
use super::world::{Kind, World};
use crate::master::{Arguments, DISCARD, ERROR, Handle, Messages, OK, WARNING, free};

/// How often each function was called, done and refused.
#[derive(Default)]
pub struct Tally(pub BTreeMap<&'static str, [u64; 2]>);

impl Tally {
    fn count(&mut self, name: &'static str, done: bool) {
        self.0.entry(name).or_default()[usize::from(!done)] += 1;
    }

    pub fn add(&mut self, other: &Tally) {
        for (name, counts) in &other.0 {
            let sum = self.0.entry(name).or_default();
            *sum = [sum[0] + counts[0], sum[1] + counts[1]];
        }
    }

    pub fn calls(&self) -> u64 {
        self.0.values().flatten().sum()
    }
}

/// Plays a script, then once more without the calls that were refused: they must have left no trace.
pub fn play(world: &World, script: &[Line], tally: &mut Tally) -> Result<(), String> {
    let mut first = Stage::new(world);
    let mut done = Vec::new();
    for (at, line) in script.iter().enumerate() {
        let complain =
            |wrong| format!("line {at}, instance {}: {:?}: {wrong}", line.instance, line.call);
        let answer = first.play(line, true).map_err(complain)?;
        let was_done = [OK, WARNING].contains(&answer.status);
        tally.count(line.call.name(), was_done);
        // An instance that cannot be made leaves its place empty.
        let left_a_trace = answer.status == DISCARD || matches!(line.call, Call::Instantiate(_));
        if was_done || left_a_trace {
            done.push((line, answer));
        }
    }
    let mut second = Stage::new(world);
    for (line, answer) in done {
        let again = second.play(line, false)?;
        let differs = again.status != answer.status
            || line.call.name() != "fmi2GetString" && again.written != answer.written;
        if differs {
            let call = &line.call;
            return Err(format!(
                "{call:?} answers {answer:?}, without the refused calls {again:?}"
            ));
        }
    }
    for instance in 0..INSTANCES {
        let (with, without) = (first.look(instance)?, second.look(instance)?);
        if with != without {
            return Err(format!(
                "instance {instance}: with the refused calls {with:?}, without {without:?}"
            ));
        }
    }
    Ok(())
}

/// The instances of a script.
struct Stage<'a> {
    world: &'a World,
    kept: Kept,
    oracles: [Option<Oracle>; INSTANCES],
    shelf: Shelf,
    messages: Box<Messages>,
    inputs_and_parameters: Vec<u32>,
    outputs: Vec<u32>,
}

impl Drop for Stage<'_> {
    fn drop(&mut self) {
        self.kept.handles.iter().flatten().for_each(|&handle| free(handle));
    }
}

/// All that a master can see of an instance.
#[derive(Debug, PartialEq)]
struct Look {
    set: Answer,
    outputs: Answer,
    threads: Answer,
    directory: Option<CString>,
    time: Option<u64>,
}

impl<'a> Stage<'a> {
    fn new(world: &'a World) -> Self {
        Self {
            world,
            kept: Kept::default(),
            oracles: Default::default(),
            shelf: Shelf::default(),
            messages: Box::default(),
            inputs_and_parameters: world.reals_of(|causality| causality != Causality::Output),
            outputs: world.reals_of(|causality| causality == Causality::Output),
        }
    }

    /// Plays one line; `check` says whether to compare the answer with what is expected.
    fn play(&mut self, line: &Line, check: bool) -> Result<Answer, String> {
        let own = line.instance;
        match line.call {
            Call::Instantiate(birth) => return self.instantiate(own, birth),
            Call::Free => return Ok(self.free(own)),
            _ => {}
        }
        let Some(oracle) = self.oracles[own].clone() else {
            let answer = line.call.run(null_mut(), 0.0, &mut self.kept);
            let refused = answer.status == ERROR;
            return if refused {
                Ok(answer)
            } else {
                Err(format!("{answer:?} without an instance"))
            };
        };
        let handle = self.kept.handles[own].ok_or("an oracle without an instance")?;
        let before = if check && line.watched { self.look(own)? } else { None };
        self.messages.take();
        let answer = line.call.run(handle, oracle.time, &mut self.kept);
        if check {
            let expected = oracle.expects(self.world, &line.call, own, &self.shelf);
            if !expected.fits(answer.status) {
                let log = self.messages.take();
                return Err(format!("{} where {expected:?} was expected: {log:?}", answer.status));
            }
            self.check_answer(line, &answer)?;
        }
        if let Some(oracle) = &mut self.oracles[own] {
            oracle.follow(self.world, &line.call, answer.status, own, &mut self.shelf);
        }
        if let Some(before) = before {
            let unchanged = line.call.only_asks() || ![OK, WARNING].contains(&answer.status);
            let after = self.look(own)?;
            if unchanged && after.as_ref() != Some(&before) {
                return Err(format!("{}: changes {before:?} to {after:?}", answer.status));
            }
        }
        Ok(answer)
    }

    /// A refused call writes nothing and says in the log which function it was; a good answer is
    /// written whole and finite.
    fn check_answer(&self, line: &Line, answer: &Answer) -> Result<(), String> {
        let done = [OK, WARNING].contains(&answer.status);
        if !done && answer.written.iter().any(|&bits| bits != UNTOUCHED) {
            return Err(format!("refused, but wrote {:x?}", answer.written));
        }
        for message in self.messages.take() {
            if message.text.contains("internal error") {
                return Err(message.text);
            }
            if message.status >= DISCARD && !message.text.starts_with(line.call.name()) {
                // Serialising asks for the size first.
                let is_size = message.text.starts_with("fmi2SerializedFMUstateSize");
                if !is_size {
                    return Err(format!("the log does not name the function: {message:?}"));
                }
            }
        }
        let Call::Get { kind: Kind::Real, nulls: Nulls::None, .. } = line.call else {
            return Ok(());
        };
        let plain = self.oracles[line.instance].as_ref().is_some_and(Oracle::is_plain);
        let finite = |&bits: &u64| f64::from_bits(bits).is_finite();
        if done && plain && !answer.written.iter().all(finite) {
            return Err(format!("values that are not finite: {:x?}", answer.written));
        }
        Ok(())
    }

    fn instantiate(&mut self, own: usize, birth: Birth) -> Result<Answer, String> {
        self.free(own);
        let good = self.world.arguments();
        let arguments = match birth {
            Birth::Good | Birth::NoCallbacks => good,
            Birth::NoName => Arguments { name: None, ..good },
            Birth::NoGuid => Arguments { guid: None, ..good },
            Birth::OtherGuid => Arguments { guid: Some(c"{other}".into()), ..good },
            Birth::NoResources => Arguments { resources: None, ..good },
            Birth::ForModelExchange => Arguments { fmu_type: 0, ..good },
        };
        let handle = match birth {
            Birth::NoCallbacks => arguments.instantiate_with(null()),
            _ => arguments.instantiate(&self.messages),
        };
        let made = !handle.is_null();
        if made != (birth == Birth::Good) {
            return Err(format!("made: {made}; {:?}", self.messages.take()));
        }
        self.kept.handles[own] = made.then_some(handle);
        self.oracles[own] = made.then(Oracle::new);
        Ok(Answer { status: if made { OK } else { ERROR }, written: Vec::new() })
    }

    fn free(&mut self, own: usize) -> Answer {
        free(self.kept.handles[own].take().unwrap_or(null_mut()));
        self.oracles[own] = None;
        self.shelf.forget(own);
        Answer { status: OK, written: Vec::new() }
    }

    /// Looks at an instance if it is in a phase that allows to.
    fn look(&mut self, own: usize) -> Result<Option<Look>, String> {
        let (Some(oracle), Some(handle)) = (&self.oracles[own], self.kept.handles[own]) else {
            return Ok(None);
        };
        if !"mstf".contains(oracle.phase) {
            return Ok(None);
        }
        let tells_time = oracle.phase != 'm';
        let reals = |references: &[u32]| get(handle, Kind::Real, references);
        let look = Look {
            set: reals(&self.inputs_and_parameters),
            outputs: reals(&self.outputs),
            threads: get(handle, Kind::Integer, &self.world.references(Kind::Integer)),
            directory: directory(handle, &self.world.references(Kind::String)),
            time: tells_time.then(|| time(handle)),
        };
        let statuses = [look.set.status, look.threads.status];
        if statuses != [OK; 2] || look.directory.is_none() {
            return Err(format!("values cannot be read: {look:?}; {:?}", self.messages.take()));
        }
        let said = self.messages.take();
        if let Some(panic) = said.iter().find(|message| message.text.contains("internal error")) {
            return Err(panic.text.clone());
        }
        let expected = tells_time.then(|| oracle.time.to_bits());
        if look.time != expected {
            return Err(format!(
                "time is {:?}, not {:?}",
                look.time.map(f64::from_bits),
                oracle.time
            ));
        }
        Ok(Some(look))
    }
}

fn get(handle: Handle, kind: Kind, references: &[u32]) -> Answer {
    let call = Call::Get { kind, references: references.to_vec(), nulls: Nulls::None };
    call.run(handle, 0.0, &mut Kept::default())
}

fn directory(handle: Handle, references: &[u32]) -> Option<CString> {
    let answer = get(handle, Kind::String, references);
    let pointer = *answer.written.first().filter(|_| answer.status == OK)? as usize;
    // SAFETY: the text stays where it is until the next call on the instance.
    Some(unsafe { std::ffi::CStr::from_ptr(pointer as *const _) }.to_owned())
}

fn time(handle: Handle) -> u64 {
    const LAST_SUCCESSFUL_TIME: c_int = 2;
    let mut value = UNTOUCHED;
    crate::master::call!("fmi2GetRealStatus", handle => Handle, LAST_SUCCESSFUL_TIME => c_int,
        &raw mut value => *mut u64);
    value
}
