//! Events: first cracks and parts that come off, with Event Mode and without.

use std::ffi::c_int;

use crate::master::three::{Stepped, Unit};
use crate::master::{self, ERROR, Handle, OK, STRIP, call};

/// A strip of links that is pulled apart.
const LINKS: &str = r#"
name = "Links"
stop_time = 1.0
step = 0.1
[body.strip]
kind = "lattice"
length = 0.1
depth = 0.05
thickness = 0.05
spacing = 1e-2
support = "ends"
material = { density = 2300.0, young = 30e9, poisson = 0.2, softening = { model = "openings", strength = 4.5e6, openings = [9.05e-6, 2e-5], share = 0.13 } }
"#;

fn instance(text: &str, event_mode_used: bool, early_return_allowed: bool) -> Unit {
    let unit = Unit::instantiated_with(text, |arguments| {
        arguments.event_mode_used = event_mode_used;
        arguments.early_return_allowed = early_return_allowed;
    });
    assert_eq!([unit.enter(0.0, None), unit.exit()], [OK; 2], "{:?}", unit.messages.take());
    if event_mode_used {
        handle_events(&unit);
    }
    unit.messages.take();
    unit
}

/// Calls fmi3UpdateDiscreteStates; returns its status and its flags.
fn update(unit: &Unit) -> (c_int, [bool; 5]) {
    let (mut flags, mut time) = ([true; 5], f64::NAN);
    let [discrete, terminate, nominals, values, next] = &mut flags;
    let status = call!("fmi3UpdateDiscreteStates", unit.handle => Handle, discrete => *mut bool,
        terminate => *mut bool, nominals => *mut bool, values => *mut bool, next => *mut bool,
        &raw mut time => *mut f64);
    (status, flags)
}

/// From Event Mode to Step Mode.
fn handle_events(unit: &Unit) {
    assert_eq!(update(unit), (OK, [false; 5]), "{:?}", unit.messages.take());
    assert_eq!(unit.simple("fmi3EnterStepMode"), OK);
}

fn cool(unit: &Unit, drop: f64) {
    for face in ["top", "bottom"] {
        assert_eq!(unit.put(&format!("plate.{face}.temperature"), 600.0 - drop), OK);
    }
}

const AT_END: [bool; 3] = [true, false, false];
const EARLY: [bool; 3] = [true, false, true];
const NONE: [bool; 3] = [false; 3];

#[track_caller]
fn stepped(unit: &Unit, point: f64, step: f64) -> Stepped {
    let (status, stepped) = unit.step(point, step);
    assert!(status == OK || status == master::WARNING, "{:?}", unit.messages.take());
    stepped
}

#[test]
fn first_crack_is_an_event_at_which_a_step_ends() {
    let unit = instance(STRIP, true, true);
    cool(&unit, 50.0);
    assert_eq!(stepped(&unit, 0.0, 1.0).flags, NONE);
    cool(&unit, 120.0);
    // The strip is cold within the first sixteenth of the step, the shortest part that is tried.
    let found = stepped(&unit, 1.0, 1.0);
    assert_eq!((found.flags, found.time), (EARLY, 1.0625));
    assert_eq!(unit.time(), found.time);
    assert_eq!([unit.value("plate.crack_count"), unit.value("plate.max_damage")], [1.0, 1.0]);
    // The body itself takes shorter parts.
    let first = unit.value("plate.first_crack_time");
    assert!(first > 1.0 && first <= found.time, "{first}");
    // In Event Mode inputs are set, and nothing advances.
    assert_eq!(unit.simple("fmi3EnterEventMode"), OK);
    assert_eq!(unit.step(found.time, 0.1).0, ERROR);
    unit.expect_message(ERROR, &["Event Mode", "only in Step Mode"]);
    cool(&unit, 121.0);
    handle_events(&unit);
    assert_eq!(stepped(&unit, found.time, 1.0).flags, NONE);
    assert_eq!(unit.value("plate.first_crack_time"), first);
    // A host that took a step of that length has the same state to the bit.
    let other = instance(STRIP, false, true);
    cool(&other, 50.0);
    stepped(&other, 0.0, 1.0);
    cool(&other, 120.0);
    assert_eq!(stepped(&other, 1.0, 0.0625).flags, NONE);
    cool(&other, 121.0);
    stepped(&other, found.time, 1.0);
    assert_eq!(unit.snapshot(), other.snapshot());
}

#[test]
fn events_are_at_the_end_of_steps_that_may_not_end_early() {
    let [with, without] = [true, false].map(|used| instance(STRIP, used, false));
    cool(&with, 120.0);
    cool(&without, 120.0);
    let found = [&with, &without].map(|unit| stepped(unit, 0.0, 1.0));
    assert_eq!(found.map(|found| (found.flags, found.time)), [(AT_END, 1.0), (NONE, 1.0)]);
    assert_eq!(with.snapshot(), without.snapshot());
}

#[test]
fn event_mode_is_refused_where_it_is_not_used() {
    let unit = instance(STRIP, false, true);
    assert_eq!(unit.simple("fmi3EnterEventMode"), ERROR);
    unit.expect_message(ERROR, &["without eventModeUsed"]);
    assert_eq!(update(&unit).0, ERROR);
    unit.expect_message(ERROR, &["not allowed in state Step Mode", "Event Mode"]);
    assert_eq!(unit.simple("fmi3EnterStepMode"), ERROR);
    unit.messages.take();
    cool(&unit, 120.0);
    assert_eq!(stepped(&unit, 0.0, 1.0).flags, NONE);
}

/// A state saved in Event Mode continues in steps under FMI 2.0, and in a host without Event Mode.
#[test]
fn states_of_event_mode_continue_anywhere() {
    let unit = instance(STRIP, true, true);
    cool(&unit, 120.0);
    assert_eq!(stepped(&unit, 0.0, 1.0).flags, EARLY);
    assert_eq!(unit.simple("fmi3EnterEventMode"), OK);
    let bytes = unit.serialize(unit.save());
    let other = instance(STRIP, true, true);
    assert_eq!(other.restore(other.deserialize(&bytes)), OK);
    handle_events(&other);
    let plain = instance(STRIP, false, true);
    assert_eq!(plain.restore(plain.deserialize(&bytes)), OK);
    let two = master::Unit::of_scene(STRIP);
    assert_eq!([two.setup(0.0, None), two.enter(), two.exit()], [OK; 3]);
    assert_eq!(two.restore(two.deserialize(&bytes)), OK, "{:?}", two.messages.take());
    handle_events(&unit);
    for unit in [&unit, &other, &plain] {
        assert_eq!(stepped(unit, 0.0625, 1.0).flags, NONE);
    }
    assert_eq!(two.advance(0.0625, 1.0), OK, "{:?}", two.messages.take());
    assert_eq!(unit.snapshot(), other.snapshot());
    assert_eq!(unit.snapshot(), plain.snapshot());
    assert_eq!(two.value("plate.mechanical_work"), unit.value("plate.mechanical_work"));
}

#[test]
fn lattice_that_comes_apart_is_an_event() {
    let unit = instance(LINKS, true, false);
    assert_eq!(unit.put("strip.displacement", 1e-5), OK);
    assert_eq!(stepped(&unit, 0.0, 0.1).flags, NONE);
    assert_eq!(unit.put("strip.displacement", 1e-3), OK);
    assert_eq!(stepped(&unit, 0.1, 0.1).flags, AT_END);
    assert_eq!(unit.value("strip.max_damage"), 1.0);
}

/// A step that ends early leaves the load on its way: it is as fast as in the whole step.
#[test]
fn load_of_a_lattice_moves_as_evenly_in_a_step_that_ends_early() {
    let moving = LINKS.replace("support = \"ends\"", "support = \"ends\"\ninertia = true");
    let unit = instance(&moving, true, true);
    assert_eq!(unit.put("strip.displacement", 1e-4), OK);
    let found = stepped(&unit, 0.0, 1e-3);
    assert_eq!(found.flags, EARLY);
    let work = unit.value("strip.mechanical_work");
    // A host that takes the parts of the search, and moves the load by their shares, has the same state.
    let ramped = instance(&moving, true, false);
    let (sixteenths, mut done, mut time) = ((found.time * 16e3).round() as u32, 0, 0.0);
    for part in [8, 4, 2, 1].into_iter().filter(|part| (sixteenths - 1) & part != 0).chain([1]) {
        done += part;
        assert_eq!(ramped.put("strip.displacement", 1e-4 * f64::from(done) / 16.0), OK);
        let length = 1e-3 * f64::from(part) / 16.0;
        assert_eq!(stepped(&ramped, time, length).flags[0], done == sixteenths);
        time += length;
    }
    let expected = ramped.value("strip.mechanical_work");
    assert!((work / expected - 1.0).abs() < 1e-6, "{work} {expected}");
}
