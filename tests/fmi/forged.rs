//! States whose bytes are whole and whose checksum is right, but that no run leads to.

use std::ffi::c_int;
use std::ptr::null_mut;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use sha2::{Digest, Sha256};

use crate::droplets::WALL;
use crate::long_steps::Shared;
use crate::master::{DISCARD, ERROR, OK, Saved, Unit, free};

/// Bytes before the contents, and of the checksum behind them.
const HEAD: usize = 58;
const CHECKSUM: usize = 16;
/// Numbers of a droplet's state before those of its four wall cells, and before its particles.
const LEDGER: usize = 19;
const BEFORE_PARTICLES: usize = LEDGER + 4 * 4;
const NUMBERS_OF_A_PARTICLE: usize = 30;

/// A saved state, part by part.
#[derive(Clone)]
pub struct Forged {
    head: Vec<u8>,
    phase: u64,
    threads: u64,
    /// Parameters, start, stop, time and inputs.
    lists: [Vec<f64>; 5],
    has_set_derivatives: u64,
    derivatives: Vec<Vec<f64>>,
    bodies: Vec<Vec<f64>>,
    /// Value, time, x, y and z of each running maximum.
    pub peaks: Vec<f64>,
}

/// What is left of some bytes.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take(&mut self, count: usize) -> Vec<u8> {
        let (taken, rest) = self.0.split_at(count);
        self.0 = rest;
        taken.to_vec()
    }

    fn count(&mut self) -> u64 {
        u64::from_le_bytes(self.take(8).try_into().unwrap())
    }

    fn numbers(&mut self) -> Vec<f64> {
        let count = self.count();
        (0..count).map(|_| f64::from_le_bytes(self.take(8).try_into().unwrap())).collect()
    }

    fn lists(&mut self) -> Vec<Vec<f64>> {
        let count = self.count();
        (0..count).map(|_| self.numbers()).collect()
    }
}

impl Forged {
    pub fn of(bytes: &[u8]) -> Self {
        let mut rest = Reader(&bytes[HEAD..bytes.len() - CHECKSUM]);
        let (phase, threads) = (rest.count(), rest.count());
        let state = Self {
            head: bytes[..HEAD].to_vec(),
            phase,
            threads,
            lists: [(); 5].map(|()| rest.numbers()),
            has_set_derivatives: rest.count(),
            derivatives: rest.lists(),
            bodies: rest.lists(),
            peaks: rest.numbers(),
        };
        assert!(rest.0.is_empty());
        state
    }

    /// The bytes, with their true length and checksum.
    pub fn bytes(&self) -> Vec<u8> {
        let count = |value: usize| (value as u64).to_le_bytes();
        let numbers = |list: &Vec<f64>| {
            let values = list.iter().flat_map(|value| value.to_le_bytes());
            count(list.len()).into_iter().chain(values).collect::<Vec<u8>>()
        };
        let lists = |all: &Vec<Vec<f64>>| {
            let values = all.iter().flat_map(numbers);
            count(all.len()).into_iter().chain(values).collect::<Vec<u8>>()
        };
        let mut bytes = self.head.clone();
        bytes.extend(self.phase.to_le_bytes());
        bytes.extend(self.threads.to_le_bytes());
        bytes.extend(self.lists.iter().flat_map(numbers));
        bytes.extend(self.has_set_derivatives.to_le_bytes());
        bytes.extend(lists(&self.derivatives));
        bytes.extend(lists(&self.bodies));
        bytes.extend(numbers(&self.peaks));
        let length = bytes.len() + CHECKSUM;
        bytes[12..20].copy_from_slice(&count(length));
        let sum = Sha256::digest(&bytes);
        bytes.extend(&sum[..CHECKSUM]);
        bytes
    }

    /// Unknowns of a body.
    pub fn body(&mut self, place: usize) -> &mut Vec<f64> {
        &mut self.bodies[place]
    }

    fn particles(&self) -> usize {
        (self.bodies[0].len() - BEFORE_PARTICLES) / NUMBERS_OF_A_PARTICLE
    }

    /// The coordinates of a particle.
    fn position(&mut self, particle: usize) -> &mut [f64] {
        &mut self.bodies[0][BEFORE_PARTICLES + 3 * particle..][..3]
    }

    /// The k-th list of numbers behind positions and velocities: masses, densities, temperatures.
    fn number(&mut self, k: usize, particle: usize) -> &mut f64 {
        let count = self.particles();
        &mut self.bodies[0][BEFORE_PARTICLES + (6 + k) * count + particle]
    }
}

/// A unit with drops that has made a step, and its state.
fn stepped() -> (Unit, Forged) {
    let unit = Unit::of_scene(WALL);
    assert_eq!(unit.setup(0.0, None), OK);
    assert_eq!([unit.enter(), unit.exit()], [OK; 2], "{:?}", unit.messages.take());
    assert_eq!(unit.step(0.0, 2e-7), OK);
    let state = Forged::of(&unit.serialize(unit.save()));
    unit.messages.take();
    (unit, state)
}

#[track_caller]
fn refused(unit: &Unit, state: &Forged, words: &str) {
    let mut place: Saved = null_mut();
    assert_eq!(unit.deserialize_in(&state.bytes(), &mut place), ERROR, "taken: {words}");
    assert!(place.is_null());
    unit.expect_message(ERROR, &["contradicts itself", words]);
}

#[test]
fn the_state_itself_is_taken() {
    let (unit, state) = stepped();
    assert_eq!(unit.restore(unit.deserialize(&state.bytes())), OK);
    assert_eq!(unit.step(2e-7, 3e-7), OK, "{:?}", unit.messages.take());
}

/// A shift by the largest number of single precision brings what fills vectors behind the points of a
/// block near to other points.
#[test]
fn particles_that_are_nowhere_are_refused() {
    let (unit, state) = stepped();
    let most = f64::from(f32::MAX);
    let places = [[most; 3], [-most, -most, 1.0], [1e60; 3], [1e6, 0.0, 1.0], [0.0, 0.0, -0.1]];
    for place in places {
        let mut state = state.clone();
        state.position(1).copy_from_slice(&place);
        refused(&unit, &state, "which no run reaches");
    }
    for value in [f64::NAN, f64::INFINITY] {
        let mut state = state.clone();
        state.position(7)[1] = value;
        refused(&unit, &state, "not finite");
    }
}

#[test]
fn particles_far_above_the_speed_of_sound_are_refused() {
    let (unit, state) = stepped();
    let first = 3 * state.particles();
    for speed in [101.0, -1e6, 1e60] {
        let mut state = state.clone();
        state.bodies[0][BEFORE_PARTICLES + first + 5] = speed;
        refused(&unit, &state, "times the speed of sound");
    }
}

#[test]
fn particles_at_absolute_zero_and_below_are_refused() {
    let (unit, state) = stepped();
    // Temperatures stand above that of the first drop.
    for rise in [-350.0, -1e6] {
        let mut state = state.clone();
        *state.number(2, 3) = rise;
        refused(&unit, &state, "not above absolute zero");
    }
}

#[test]
fn particles_of_other_numbers_and_masses_are_refused() {
    let (unit, state) = stepped();
    for ratio in [-0.9, 2.5] {
        let mut state = state.clone();
        *state.number(1, 3) = ratio;
        refused(&unit, &state, "of the density at rest");
    }
    for (mass, words) in [(0.0, "a mass of"), (-1.0, "a mass of"), (7.0, "of mass, where")] {
        let mut state = state.clone();
        *state.number(0, 3) = mass;
        refused(&unit, &state, words);
    }
    let mut fewer = state.clone();
    let length = fewer.bodies[0].len();
    fewer.bodies[0].truncate(length - NUMBERS_OF_A_PARTICLE);
    refused(&unit, &fewer, "particles, where 1 drops have");
    let mut more = state.clone();
    more.bodies[0].extend([0.0; NUMBERS_OF_A_PARTICLE]);
    refused(&unit, &more, "particles, where 1 drops have");
}

#[test]
fn ledgers_that_contradict_the_plan_are_refused() {
    let (unit, state) = stepped();
    let cases = [
        (1, 2.0, "drops released"),
        (1, 0.0, "where 0 drops have"),
        (1, 0.5, "drops released"),
        (0, 1.0, "drops released"),
        (2, -1.0, "time steps of -1"),
        (11, -1e-9, "a last step"),
        (18, -1.0, "a volume"),
        (16, f64::NAN, "not finite"),
        (LEDGER + 2, f64::INFINITY, "not finite"),
    ];
    for (place, value, words) in cases {
        let mut state = state.clone();
        state.bodies[0][place] = value;
        refused(&unit, &state, words);
    }
}

#[test]
fn what_surrounds_the_unknowns_is_looked_at_too() {
    let (unit, state) = stepped();
    let forge = |change: &dyn Fn(&mut Forged), words: &str| {
        let mut state = state.clone();
        change(&mut state);
        refused(&unit, &state, words);
    };
    forge(&|s| s.threads = 1025, "1025 threads, of at most 1024");
    forge(&|s| s.threads = u64::MAX, "threads, of at most 1024");
    forge(&|s| s.lists[0][0] = f64::NAN, "finite");
    forge(&|s| s.lists[1][0] = f64::INFINITY, "finite");
    forge(&|s| s.lists[1][0] = 1.0, "in an experiment from 1");
    forge(&|s| s.lists[2] = vec![-1.0], "in an experiment from");
    forge(&|s| s.lists[3][0] = -1.0, "in an experiment from");
    forge(&|s| s.lists[4][0] = f64::NAN, "finite");
    forge(&|s| s.has_set_derivatives = 2, "yes or no");
    forge(&|s| s.bodies.push(Vec::new()), "bodies");
    forge(&|s| s.peaks = vec![300.0, 0.0, 0.0, 0.0, 0.0], "1 running maxima; the scene has 0");
}

/// A plate that has made a step under its spot, and its state.
fn stepped_plate() -> (Unit, Forged) {
    let unit = Unit::running();
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let state = Forged::of(&unit.serialize(unit.save()));
    unit.messages.take();
    (unit, state)
}

#[test]
fn solids_of_temperatures_that_no_matter_has_are_refused() {
    let (unit, state) = stepped_plate();
    assert_eq!(unit.restore(unit.deserialize(&state.bytes())), OK);
    let modes = state.bodies[0].len() - 3;
    // The step has warmed it by some hundredths of a kelvin.
    for (factor, words) in [
        (-1e6, "which no run leads to"),
        (-1e9, "which no run leads to"),
        (-1e20, "which no run leads to"),
        (1e23, "more heat in plate than was brought in"),
    ] {
        let mut state = state.clone();
        state.bodies[0][..modes].iter_mut().for_each(|content| *content *= factor);
        refused(&unit, &state, words);
    }
    for value in [1e61, -1e155, 1e300] {
        let mut state = state.clone();
        state.bodies[0][3] = value;
        refused(&unit, &state, "larger than any run leads to");
    }
}

#[test]
fn heat_that_did_not_come_in_is_refused() {
    let (unit, state) = stepped_plate();
    let count = state.bodies[0].len();
    // Heat brought in and lost, and the slowest mode, which holds the mean temperature.
    for (place, part) in [(count - 2, 100.0), (count - 2, 1e30), (count - 1, -1e30), (0, 100.0)] {
        let mut state = state.clone();
        let number = &mut state.bodies[0][place];
        *number = if *number == 0.0 { part } else { *number * part };
        refused(&unit, &state, "more heat in plate than was brought in and not lost");
    }
    let mut state = state;
    state.bodies[0][count - 2] = 1e300;
    refused(&unit, &state, "larger than any run leads to");
}

/// From a phase that cannot be left a unit could be neither reset nor freed.
#[test]
fn a_unit_can_be_reset_and_freed_in_every_phase_that_is_taken() {
    let (unit, state) = stepped();
    let mut taken = 0;
    for phase in 0..12 {
        let mut state = state.clone();
        state.phase = phase;
        let mut place: Saved = null_mut();
        if unit.deserialize_in(&state.bytes(), &mut place) != OK {
            unit.expect_message(ERROR, &["contradicts itself", "in which nothing is saved"]);
            continue;
        }
        taken += 1;
        assert_eq!(unit.restore(place), OK);
        assert_eq!(unit.reset(), OK, "phase {phase}: {:?}", unit.messages.take());
        assert_eq!(unit.free_state(&mut place), OK);
    }
    assert_eq!(taken, 8, "all phases but those in a step and after a fatal error");
    let reused = unit.handle;
    drop(unit);
    // The place of a unit that was freed serves for the next one, and answers nothing before.
    assert_eq!(crate::master::call!("fmi2Reset", reused => crate::master::Handle), ERROR);
    free(reused);
}

/// Places of the numbers of a nozzle in the state of a strand above a plane: volume, outlet, impulse, jump, flow and
/// lateness stand before those of its particles.
struct StrandNumbers {
    /// Before the first particle.
    head: usize,
    particles: usize,
    /// Of a particle.
    width: usize,
}

const OF_A_NOZZLE: usize = 1 + 3 + 3 + 1 + 1 + 1;
/// Position, velocity, mass, density, temperature twice, acceleration, tension, potential, gradient, moment, stress,
/// layer and hold.
const NUMBERS_OF_PASTE: usize = 3 + 3 + 1 + 1 + 1 + 1 + 6 + 4 + 1 + 3 + 6 + 6 + 1 + 1;

impl StrandNumbers {
    fn of(unit: &Unit, state: &Forged) -> Self {
        let particles = unit.get("ink.particles") as usize;
        let all = state.bodies[0].len();
        Self { head: all - particles * NUMBERS_OF_PASTE, particles, width: NUMBERS_OF_PASTE }
    }

    /// Place of a number of the nozzle.
    fn nozzle(&self, n: usize) -> usize {
        self.head - OF_A_NOZZLE + n
    }

    /// Place of the number of a particle in the n-th list from the end: 1 holds, 2 layers.
    fn count_from_end(&self, n: usize, particle: usize) -> usize {
        self.head + self.particles * (self.width - n) + particle
    }
}

/// A strand that rests in part, whose state is damaged number by number.
#[test]
fn strands_of_particles_that_no_nozzle_lays_are_refused() {
    let unit = crate::droplets::strand_at_rest();
    let state = Forged::of(&unit.serialize(unit.save()));
    unit.messages.take();
    assert_eq!(unit.restore(unit.deserialize(&state.bytes())), OK);
    let at = StrandNumbers::of(&unit, &state);
    let holds: Vec<f64> =
        (0..at.particles).map(|i| state.bodies[0][at.count_from_end(1, i)]).collect();
    let held_at = |hold: f64| holds.iter().position(|own| *own == hold).unwrap();
    let [free, in_nozzle, asleep] = [0.0, 1.0, 2.0].map(held_at);
    let cases = [
        (at.nozzle(0), -1e-15, "m³ have come"),
        (at.nozzle(0), 1.0, "m³ have come"),
        (at.nozzle(0), 0.0, "layers of fluid"),
        (at.nozzle(1), 1e9, "a nozzle at"),
        (at.nozzle(2), f64::NAN, "not finite"),
        (at.nozzle(7), -1.0, "a flag or a jump"),
        (at.nozzle(8), 0.5, "a flag or a jump"),
        (at.nozzle(9), 2.0, "a flag or a jump"),
        (at.count_from_end(1, free), 1.0, "with the hold 1"),
        (at.count_from_end(1, in_nozzle), 0.0, "with the hold 0"),
        (at.count_from_end(1, in_nozzle), 2.0, "with the hold 2"),
        (at.count_from_end(1, asleep), 3.0, "with the hold 3"),
        (at.count_from_end(2, free), -1.0, "of layer -1"),
        (at.count_from_end(2, free), 0.5, "of layer 0.5"),
        (at.count_from_end(2, free), 1e6, "of layer 1000000"),
        (at.count_from_end(2, in_nozzle), 0.0, "with the hold 1 in layer 0"),
        (at.head + 2, -0.1, "which no run reaches"),
        (at.head + 3 * (at.particles + asleep), 1e-3, "with the hold 2"),
        (1, 3.0, "layers of fluid"),
    ];
    for (place, value, words) in cases {
        let mut state = state.clone();
        state.bodies[0][place] = value;
        refused(&unit, &state, words);
    }
    let mut fewer = state.clone();
    fewer.bodies[0].truncate(state.bodies[0].len() - at.width);
    refused(&unit, &fewer, "particles, where");
}

/// Whatever is changed, a state is refused, or goes on without an internal error.
#[test]
fn no_change_of_numbers_leads_to_an_internal_error() {
    let (unit, state) = stepped();
    let (sender, receiver) = channel::<()>();
    let shared = Shared(unit.handle);
    // Forged speeds can make steps very short.
    let canceller = thread::spawn(move || {
        while receiver.recv_timeout(Duration::from_millis(50)) == Err(RecvTimeoutError::Timeout) {
            shared.cancel();
        }
    });
    let mut random = fastrand::Rng::with_seed(1);
    let special = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e6, 1e9, 1e38, 3.4e38, -3.4e38, 1e300, -1e300];
    let mut statuses: [usize; 4] = [0; 4];
    for _ in 0..150 {
        let mut forged = state.clone();
        for _ in 0..random.usize(1..20) {
            let list = &mut forged.bodies[0];
            // Of the first numbers, or of velocities, rates and forces.
            let place = match random.bool() {
                true => random.usize(..LEDGER),
                false => random.usize(list.len() / 10..list.len()),
            };
            list[place] = match random.bool() {
                true => special[random.usize(..special.len())],
                false => list[place] * 10f64.powi(random.i32(-9..9)),
            };
        }
        let mut place: Saved = null_mut();
        let mut status: c_int = unit.deserialize_in(&forged.bytes(), &mut place);
        if status == OK {
            assert_eq!(unit.restore(place), OK);
            status = unit.step(2e-7, 1e-9);
            assert!([OK, DISCARD].contains(&status), "{status}: {:?}", unit.messages.take());
            assert_eq!(unit.free_state(&mut place), OK);
        }
        statuses[status as usize] += 1;
        let messages = unit.messages.take();
        let messages: Vec<_> =
            messages.iter().filter(|m| !m.text.starts_with("fmi2CancelStep")).collect();
        assert!(messages.iter().all(|m| !m.text.contains("internal error")), "{messages:?}");
    }
    drop(sender);
    canceller.join().unwrap();
    assert!(statuses[OK as usize] > 5 && statuses[ERROR as usize] > 50, "{statuses:?}");
}
