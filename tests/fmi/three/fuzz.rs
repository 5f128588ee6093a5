//! Random calls, legal and illegal. A twin gets only those that were done: if the two ever differ, a
//! refused call has left a trace.
//!
//! `FUZZ_SECONDS=600` plays new scripts for that long.

use std::env;
use std::ffi::c_int;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use fastrand::Rng;
use impinge::variables::Causality;

use crate::functions::names;
use crate::master::three::Unit;
use crate::master::{DISCARD, ERROR, Handle, OK, Saved, Three, call};

/// Calls in a script, and scripts of the run that belongs to the tests.
const LENGTH: usize = 150;
const FEW: u64 = 2;
/// What stands in arrays that answers are written to.
const UNTOUCHED: f64 = -7.25;

#[derive(Debug, Clone)]
enum Call {
    Simple(&'static str),
    Enter {
        start: f64,
        stop: Option<f64>,
    },
    Step {
        from: f64,
        size: f64,
    },
    Set {
        references: Vec<u32>,
        values: Vec<f64>,
    },
    Get {
        references: Vec<u32>,
        room: usize,
    },
    Save,
    Restore(usize),
    Free(usize),
    /// As bytes and back, one byte changed or not.
    Send {
        state: usize,
        damage: Option<usize>,
    },
    Differentiate {
        name: &'static str,
        lists: [Vec<u32>; 2],
        seeds: usize,
        room: usize,
    },
    OutputDerivatives {
        references: Vec<u32>,
        order: c_int,
        room: usize,
    },
    /// A function with nothing but zeros.
    Empty(&'static str),
}

/// An instance with the states that it has saved; what was freed stays in the list.
struct Player {
    unit: Unit,
    states: Vec<Saved>,
}

impl Player {
    fn new() -> Self {
        Self { unit: Unit::instantiated(), states: Vec::new() }
    }

    /// The status of a call, and whether it has left arrays alone that only an answer may change.
    fn play(&mut self, call: &Call) -> (c_int, bool) {
        let unit = &self.unit;
        // No state is given out under an even number.
        let never = |place: usize| (2 * place + 2) as Saved;
        let state = |place: usize| self.states.get(place).copied().unwrap_or(never(place));
        let mut values = Vec::new();
        let status = match call {
            Call::Simple(name) => unit.simple(name),
            Call::Enter { start, stop } => unit.enter(*start, *stop),
            Call::Step { from, size } => unit.step(unit.time() + from, *size).0,
            Call::Set { references, values } => unit.set_all(references, values),
            Call::Get { references, room } => {
                values.resize(*room, UNTOUCHED);
                unit.get_in(references, &mut values)
            }
            Call::Save => {
                let mut saved: Saved = std::ptr::null_mut();
                let status = call!("fmi3GetFMUState", unit.handle => Handle,
                    &raw mut saved => *mut Saved);
                self.states.push(saved);
                status
            }
            Call::Restore(place) => unit.restore(state(*place)),
            Call::Free(place) => unit.free_state(&mut state(*place)),
            Call::Send { state: place, damage } => {
                let (saved, mut size) = (state(*place), 0_usize);
                let sized = call!("fmi3SerializedFMUStateSize", unit.handle => Handle,
                    saved => Saved, &raw mut size => *mut usize);
                if sized != OK {
                    return (sized, true);
                }
                let mut bytes = unit.serialize(saved);
                if let Some(at) = damage {
                    bytes[at % size] ^= 0x10;
                }
                let mut copy: Saved = std::ptr::null_mut();
                let status = unit.deserialize_in(&bytes, &mut copy);
                self.states.push(copy);
                status
            }
            Call::Differentiate { name, lists: [unknowns, knowns], seeds, room } => {
                values.resize(*room, UNTOUCHED);
                let seed = vec![1e-9; *seeds];
                unit.differentiate_in(name, [unknowns, knowns], &seed, &mut values)
            }
            Call::OutputDerivatives { references, order, room } => {
                values.resize(*room, UNTOUCHED);
                let orders = vec![*order; references.len()];
                unit.output_derivatives_in(references, &orders, &mut values)
            }
            Call::Empty(name) => {
                call!(*name, unit.handle => Handle, 0 => usize, 0 => usize, 0 => usize,
                    0 => usize, 0 => usize, 0 => usize, 0 => usize, 0 => usize)
            }
        };
        (status, values.iter().all(|value| *value == UNTOUCHED))
    }

    /// All that can be read now: no outputs before initialization.
    fn seen(&self) -> Vec<u64> {
        let kinds = [None, Some(Causality::Parameter), Some(Causality::Input)];
        let mut references: Vec<u32> =
            kinds.into_iter().flat_map(|kind| self.unit.floats(kind)).collect();
        let outputs = self.unit.floats(Some(Causality::Output));
        let mut values = vec![0.0; self.unit.size(&outputs)];
        if self.unit.get_in(&outputs, &mut values) == OK {
            references.extend(outputs);
        }
        let seen = self.unit.get_all(&references);
        self.unit.messages.take();
        seen.into_iter().map(f64::to_bits).collect()
    }
}

/// A number that is often good and sometimes absurd.
fn number(random: &mut Rng, good: f64) -> f64 {
    match random.u32(..20) {
        0 => [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300, -1e-300][random.usize(..6)],
        _ => good * (0.5 + random.f64()),
    }
}

/// A count that is nearly always right.
fn near(random: &mut Rng, right: usize) -> usize {
    match random.u32(..12) {
        0 => right + 1,
        1 => right.saturating_sub(1),
        _ => right,
    }
}

/// Some variables: a few of one causality, or any, or none that exist.
fn some(random: &mut Rng, unit: &Unit, causality: Causality) -> Vec<u32> {
    let count = random.usize(..4);
    let good = unit.floats(Some(causality));
    let pick = |random: &mut Rng| match random.u32(..30) {
        0 => random.u32(..),
        1 => random.u32(..unit.arrays.variables.len() as u32),
        _ => good[random.usize(..good.len())],
    };
    (0..count).map(|_| pick(random)).collect()
}

/// Number of elements of the variables that exist.
fn size(unit: &Unit, references: &[u32]) -> usize {
    let variables = references.iter().filter_map(|r| unit.arrays.variables.get(*r as usize));
    variables.map(|variable| variable.size()).sum()
}

fn set(random: &mut Rng, unit: &Unit) -> Call {
    let causality = [Causality::Input, Causality::Parameter][usize::from(random.u32(..4) == 0)];
    let references = some(random, unit, causality);
    let mut values = Vec::new();
    for reference in &references {
        let Some(variable) = unit.arrays.variables.get(*reference as usize) else { continue };
        let start = variable.elements(&unit.registry).first().and_then(|v| v.real_start());
        let good = start.filter(|start| *start != 0.0).unwrap_or(1e-5);
        values.extend((0..variable.size()).map(|_| number(random, good)));
    }
    values.resize(near(random, values.len()), 0.0);
    Call::Set { references, values }
}

fn any(random: &mut Rng, unit: &Unit, states: usize) -> Call {
    let outputs = |random: &mut Rng| some(random, unit, Causality::Output);
    match random.u32(..40) {
        0..4 => {
            let stop = (random.u32(..4) == 0).then(|| number(random, 1e-6));
            Call::Enter { start: 0.0, stop }
        }
        4..8 => Call::Simple("fmi3ExitInitializationMode"),
        8 => Call::Simple(["fmi3Terminate", "fmi3Reset"][random.usize(..2)]),
        9..16 => {
            let from = if random.u32(..10) == 0 { number(random, 1e-7) } else { 0.0 };
            Call::Step { from, size: number(random, 1e-8) }
        }
        16..23 => set(random, unit),
        23..27 => {
            let references = outputs(random);
            Call::Get { room: near(random, size(unit, &references)), references }
        }
        27..29 => Call::Save,
        29 => Call::Restore(random.usize(..states + 2)),
        30 => Call::Free(random.usize(..states + 2)),
        31 => {
            let damage = random.bool().then(|| random.usize(..4000));
            Call::Send { state: random.usize(..states + 2), damage }
        }
        32..34 => {
            let lists = [outputs(random), some(random, unit, Causality::Input)];
            let [unknowns, knowns] = lists.each_ref().map(|list| size(unit, list));
            let (name, seeds, room) = match random.bool() {
                true => ("fmi3GetDirectionalDerivative", knowns, unknowns),
                false => ("fmi3GetAdjointDerivative", unknowns, knowns),
            };
            Call::Differentiate { name, lists, seeds: near(random, seeds), room }
        }
        34..36 => {
            let references = outputs(random);
            let room = near(random, size(unit, &references));
            Call::OutputDerivatives { references, order: random.i32(0..3), room }
        }
        _ => {
            let names = names::<Three>();
            Call::Empty(names[random.usize(..names.len())])
        }
    }
}

/// Plays one script; answers how many of its calls were done.
fn play(seed: u64) -> usize {
    let mut random = Rng::with_seed(seed);
    let (mut player, mut twin) = (Player::new(), Player::new());
    let (mut done, mut script) = (0, Vec::new());
    for _ in 0..LENGTH {
        let call = any(&mut random, &player.unit, player.states.len());
        script.push(call.clone());
        let before = player.seen();
        let (status, untouched) = player.play(&call);
        let messages = player.unit.messages.take();
        let tail = || format!("seed {seed}: {:#?}", &script[script.len().saturating_sub(6)..]);
        if status == OK {
            done += 1;
            assert_eq!(twin.play(&call).0, OK, "{}", tail());
            continue;
        }
        assert!(matches!(status, DISCARD | ERROR), "{status}; {}", tail());
        assert!(messages.iter().any(|m| m.status == status), "{messages:?}; {}", tail());
        assert!(untouched, "{}", tail());
        // Lists of states stay alike: a save that was refused has left null in both.
        twin.states.resize(player.states.len(), std::ptr::null_mut());
        assert_eq!(player.seen(), before, "{}", tail());
        assert_eq!(player.seen(), twin.seen(), "{}", tail());
    }
    assert_eq!(player.seen(), twin.seen(), "seed {seed}");
    done
}

#[test]
fn refused_calls_leave_no_trace() {
    let seconds = env::var("FUZZ_SECONDS").ok().map(|text| text.parse().unwrap());
    let begin = Instant::now();
    // Long runs are for what short ones have not seen, so they begin elsewhere each time.
    let first = seconds.map_or(0, |_: u64| {
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs() << 24
    });
    let goes_on = |seed: u64| match seconds {
        Some(seconds) => begin.elapsed() < Duration::from_secs(seconds),
        None => seed < FEW,
    };
    let (mut scripts, mut done) = (0, 0);
    for seed in (first..).take_while(|seed| goes_on(*seed)) {
        done += play(seed);
        scripts += 1;
    }
    let calls = scripts * LENGTH;
    println!("{scripts} scripts: {done} of {calls} calls done");
    assert!(done > calls / 4 && done < calls);
}
