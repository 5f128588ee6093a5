//! Many instances in one process, on many threads.

use std::thread;

use crate::master::{ERROR, Handle, OK, Unit, call, free};

fn run(flux: f64) -> (Vec<u64>, i32, String) {
    let unit = Unit::initializing();
    assert_eq!(unit.set("spot.heat_flux", flux), OK);
    assert_eq!(unit.exit(), OK);
    for k in 0..5 {
        assert_eq!(unit.step(f64::from(k) * 1e-8, 1e-8), OK);
    }
    unit.snapshot()
}

#[test]
fn instances_on_threads_do_not_know_of_each_other() {
    let fluxes: Vec<f64> = (1..=6).map(|k| f64::from(k) * 1e6).collect();
    let alone: Vec<_> = fluxes.iter().map(|&flux| run(flux)).collect();
    let together: Vec<_> = thread::scope(|scope| {
        let started: Vec<_> = fluxes.iter().map(|&flux| scope.spawn(move || run(flux))).collect();
        started.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(alone, together);
    assert_ne!(alone[0], alone[1]);
}

/// Saves, steps under an input that grows and goes back, and so twice.
fn run_and_repeat(flux: f64) -> [(Vec<u64>, i32, String); 2] {
    let unit = Unit::initializing();
    assert_eq!(unit.set("spot.heat_flux", flux), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let state = unit.save();
    [(); 2].map(|()| {
        assert_eq!(unit.restore(state), OK);
        assert_eq!(unit.set_derivative("spot.pressure", 1, 1e13), OK);
        assert_eq!(unit.set_derivative("spot.x", 1, 300.0), OK);
        assert_eq!(unit.step(1e-8, 4e-8), OK);
        unit.snapshot()
    })
}

#[test]
fn four_instances_save_and_go_back_at_once_as_they_do_alone() {
    let fluxes: Vec<f64> = (1..=4).map(|k| f64::from(k) * 1e6).collect();
    let alone: Vec<_> = fluxes.iter().map(|&flux| run_and_repeat(flux)).collect();
    let together: Vec<_> = thread::scope(|scope| {
        let start = |&flux: &f64| scope.spawn(move || run_and_repeat(flux));
        let started: Vec<_> = fluxes.iter().map(start).collect();
        started.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(alone, together);
    assert!(alone.iter().all(|[first, again]| first == again));
}

#[test]
fn an_instance_may_move_between_threads() {
    struct Sendable(Unit);
    // SAFETY: FMI asks only that calls on an instance do not overlap.
    unsafe impl Send for Sendable {}
    let unit = Sendable(Unit::running());
    let back = thread::spawn(move || {
        let unit = unit;
        assert_eq!(unit.0.step(0.0, 1e-8), OK);
        unit
    });
    let unit = back.join().unwrap().0;
    assert_eq!(unit.step(1e-8, 1e-8), OK);
}

/// A call that comes while an instance is taken back, or later, is refused: its memory stays.
#[test]
fn instances_are_taken_back_while_other_threads_call() {
    struct Shared(Handle);
    // SAFETY: instances refuse calls that overlap.
    unsafe impl Send for Shared {}
    for _ in 0..50 {
        let unit = Unit::instantiated();
        let shared = Shared(unit.handle);
        let caller = thread::spawn(move || {
            let shared = shared;
            let calls = ["fmi2EnterInitializationMode", "fmi2Reset"].into_iter().cycle();
            let status = |name: &str| call!(name, shared.0 => Handle);
            calls.take(300).map(status).collect::<Vec<_>>()
        });
        thread::yield_now();
        let handle = unit.handle;
        drop(unit);
        let statuses = caller.join().unwrap();
        assert!(statuses.iter().all(|status| [OK, ERROR].contains(status)));
        // Refused if it came during a call.
        free(handle);
        assert_eq!(call!("fmi2Reset", handle => Handle), ERROR);
    }
}
