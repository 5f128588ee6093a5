//! Random sequences of calls, legal and illegal, on several instances in several threads.
//!
//! Checked are: no call crashes; it is done or refused as the table of legal calls and a model of the
//! instance say; a refused call changes nothing that can be seen and leaves no trace in what comes
//! later; what was refused writes into no array. A script that fails is cut down to the calls that it
//! takes and printed with its seed; where the process itself dies, the seeds that were being played
//! stand in files `fuzz-*` of cargo's folder for temporary files of tests.
//!
//! - `FUZZ_SECONDS=600` plays new scripts for that long (`make fuzz SECONDS=600`).
//! - `FUZZ_SEED=7` plays one script, in one thread.

mod call;
mod generate;
mod oracle;
mod play;
mod world;

use std::env;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use call::{Call, Kept, Line, Nulls, UNTOUCHED};
use impinge::variables::Causality;
use play::{Tally, play};
use world::{Kind, World};

use crate::functions::EXCHANGE;
use crate::master::{ERROR, Handle, Messages, OK, free};

const THREADS: u64 = 4;
/// Calls in a script.
const LENGTH: usize = 120;
/// Scripts of the run that belongs to the tests.
const FEW: u64 = 40;

fn setting(name: &str) -> Option<u64> {
    let text = env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name} is {text:?}, not a whole number")))
}

#[test]
fn random_calls_are_answered_as_the_standard_says() {
    let world = &World::new();
    if let Some(seed) = setting("FUZZ_SEED") {
        play_seed(world, seed, &mut Tally::default()).unwrap_or_else(|failure| panic!("{failure}"));
        return;
    }
    let seconds = setting("FUZZ_SECONDS");
    // Long runs are for what short ones have not seen, so they begin elsewhere each time.
    let first = seconds.map_or(0, |_| {
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs() << 24
    });
    let begin = Instant::now();
    let next = AtomicU64::new(first);
    let goes_on = |seed| match seconds {
        Some(seconds) => begin.elapsed() < Duration::from_secs(seconds),
        None => seed < FEW,
    };
    let (tally, failure) = (Mutex::new(Tally::default()), Mutex::new(None));
    thread::scope(|scope| {
        for worker in 0..THREADS {
            let (next, tally, failure) = (&next, &tally, &failure);
            scope.spawn(move || {
                let mut own = Tally::default();
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if !goes_on(seed) || failure.lock().unwrap().is_some() {
                        break;
                    }
                    note(worker, seed);
                    if let Err(message) = play_seed(world, seed, &mut own) {
                        *failure.lock().unwrap() = Some(message);
                    }
                }
                tally.lock().unwrap().add(&own);
            });
        }
    });
    if let Some(failure) = failure.into_inner().unwrap() {
        panic!("{failure}");
    }
    let tally = tally.into_inner().unwrap();
    for (name, [done, refused]) in &tally.0 {
        println!("{name:36} {done:9} done {refused:9} refused");
    }
    println!("{} calls in {:.1} s", tally.calls(), begin.elapsed().as_secs_f64());
    assert_both_ways(world, &tally);
}

/// Keeps the seed where it can be found if the process dies.
fn note(worker: u64, seed: u64) {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{worker}"));
    std::fs::write(file, seed.to_string()).unwrap();
}

fn play_seed(world: &World, seed: u64, tally: &mut Tally) -> Result<(), String> {
    let script = generate::script(world, seed, LENGTH);
    let Err(failure) = play(world, &script, tally) else { return Ok(()) };
    let shortest = shrink(world, script);
    let failure = play(world, &shortest, &mut Tally::default()).err().unwrap_or(failure);
    let lines: Vec<String> =
        shortest.iter().map(|line| format!("  {}: {:?}", line.instance, line.call)).collect();
    Err(format!("FUZZ_SEED={seed}, cut down to\n{}\n{failure}", lines.join("\n")))
}

/// Leaves out calls, many at a time and then fewer, as long as the rest still fails.
fn shrink(world: &World, mut script: Vec<Line>) -> Vec<Line> {
    let fails = |script: &[Line]| play(world, script, &mut Tally::default()).is_err();
    let mut share = script.len() / 2;
    while share > 0 {
        let mut at = 0;
        while at < script.len() {
            let end = (at + share).min(script.len());
            let rest = [&script[..at], &script[end..]].concat();
            if fails(&rest) { script = rest } else { at = end }
        }
        share /= 2;
    }
    script
}

/// A fuzzer that never gets anywhere, or is never refused, would find nothing.
fn assert_both_ways(world: &World, tally: &Tally) {
    let offers = &world.offers;
    let offered = |name: &str| match name {
        "fmi2CancelStep" | "fmi2SetBoolean" => false,
        "fmi2SerializeFMUstate" | "fmi2DeSerializeFMUstate" => offers.bytes,
        "fmi2GetDirectionalDerivative" => offers.directional,
        "fmi2SetRealInputDerivatives" => offers.input_derivatives,
        "fmi2GetRealOutputDerivatives" => offers.output_derivatives,
        "fmi2GetStatus" | "fmi2GetIntegerStatus" | "fmi2GetBooleanStatus" => false,
        "fmi2GetStringStatus" => false,
        _ if name.ends_with("FMUstate") => offers.states,
        _ => true,
    };
    let by_script = ["fmi2Instantiate", "fmi2DoStep", "fmi2GetReal", "fmi2SetReal"];
    assert!(by_script.iter().all(|name| tally.0.contains_key(name)), "{:?}", tally.0.keys());
    for (&name, &[done, refused]) in &tally.0 {
        let exchange = EXCHANGE.contains(&name);
        assert!(refused > 0 || name == "fmi2FreeInstance", "{name} was never refused");
        assert!(done > 0 || exchange || !offered(name), "{name} was never done");
    }
}

/// FMI allows one call at a time on an instance; a second one meanwhile is refused, not waited for,
/// and does no harm.
#[test]
fn calls_that_overlap_are_refused_and_do_no_harm() {
    struct Shared(Handle);
    // SAFETY: this very use is what the library guards against.
    unsafe impl Sync for Shared {}
    let world = &World::new();
    let messages = Messages::default();
    let handle = world.arguments().instantiate(&messages);
    assert!(!handle.is_null());
    let plain = |name| Call::Plain(name).run(handle, 0.0, &mut Kept::default()).status;
    assert_eq!(plain("fmi2EnterInitializationMode"), OK);
    assert_eq!(plain("fmi2ExitInitializationMode"), OK);
    let shared = &Shared(handle);
    let reals = &world.references(Kind::Real);
    let input = world.reals_of(|causality| causality == Causality::Input)[0];
    thread::scope(|scope| {
        for worker in 0..THREADS {
            let (kind, nulls) = (Kind::Real, Nulls::None);
            let get = Call::Get { kind, references: reals.clone(), nulls };
            let set =
                Call::Set { kind, references: vec![input], values: vec![worker as f64], nulls };
            scope.spawn(move || {
                for _ in 0..1000 {
                    let answers =
                        [&set, &get].map(|call| call.run(shared.0, 0.0, &mut Kept::default()));
                    assert!(answers.iter().all(|answer| [OK, ERROR].contains(&answer.status)));
                    let untouched = answers[1].written.iter().all(|&bits| bits == UNTOUCHED);
                    assert_eq!(untouched, answers[1].status == ERROR);
                }
            });
        }
    });
    let get = Call::Get { kind: Kind::Real, references: vec![input], nulls: Nulls::None };
    let last = f64::from_bits(get.run(handle, 0.0, &mut Kept::default()).written[0]);
    assert!((0..THREADS).any(|worker| worker as f64 == last), "{last}");
    assert_eq!(plain("fmi2Reset"), OK);
    free(handle);
}
