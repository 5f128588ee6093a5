//! Steps that end early: where they are too long for one call, and where the master wants it.

use std::cell::RefCell;
use std::ffi::c_void;

use crate::droplets::{PLATE, WALL};
use crate::master::three::{Stepped, Unit};
use crate::master::{DISCARD, ERROR, OK};

/// A block whose heat particles conduct, so that the work of a step grows with its length.
const BLOCK: &str = r#"
name = "Block"
stop_time = 1.0
step = 0.1
[body.block]
kind = "solid"
shape = { box = [1e-3, 1e-3, 1e-3] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 300.0
heat = "sph"
mesh = { spacing = 2.5e-4, growth = 1.0 }
[body.block.faces]
bottom = { temperature = 320.0 }
[[load]]
name = "spot"
on = "block.top"
footprint = { disc = { radius = 3e-4 } }
carries = ["heat_flux"]
start = { heat_flux = 1e5 }
[[probe]]
name = "centre"
in = "block"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#;

/// What a master was told during a step: the time, and whether variables may be set, variables may be read, a part
/// of the step is finished, and the step may end early.
type Told = (f64, [bool; 4]);

/// What a master wants when it is told of a step.
#[derive(Default)]
struct Wishes {
    told: Vec<Told>,
    /// When the step is to end, from the second time on that the master is told of it.
    end: Option<f64>,
}

thread_local! {
    static WISHES: RefCell<Wishes> = RefCell::default();
}

unsafe extern "C" fn update(
    _environment: *mut c_void,
    time: f64,
    may_set: bool,
    may_get: bool,
    is_finished: bool,
    can_return_early: bool,
    wanted: *mut bool,
    end: *mut f64,
) {
    WISHES.with_borrow_mut(|wishes| {
        wishes.told.push((time, [may_set, may_get, is_finished, can_return_early]));
        if let Some(wish) = wishes.end.filter(|_| wishes.told.len() > 1) {
            // SAFETY: places that live through the call.
            unsafe { (*wanted, *end) = (true, wish) };
        }
    });
}

/// What the master was told since it wished last.
fn told() -> Vec<Told> {
    WISHES.take().told
}

fn wish(end: Option<f64>) {
    WISHES.set(Wishes { told: Vec::new(), end });
}

fn started(unit: Unit) -> Unit {
    assert_eq!(unit.enter(0.0, None), OK);
    assert_eq!(unit.exit(), OK, "{:?}", unit.messages.take());
    unit.messages.take();
    unit
}

fn listening(text: &str, early_return_allowed: bool) -> Unit {
    started(Unit::instantiated_with(text, |arguments| {
        arguments.early_return_allowed = early_return_allowed;
        arguments.update = Some(update);
    }))
}

fn plain(text: &str) -> Unit {
    started(Unit::of_scene(text))
}

#[track_caller]
fn early(unit: &Unit, (status, stepped): (i32, Stepped), end: f64) -> f64 {
    assert_eq!(status, OK, "{:?}", unit.messages.take());
    assert_eq!(stepped.flags, [false, false, true]);
    assert_eq!(stepped.time, unit.time());
    assert!(0.0 < stepped.time && stepped.time < end, "{}", stepped.time);
    stepped.time
}

#[test]
fn a_step_too_long_for_one_call_ends_early_where_it_may() {
    let long = 1e9;
    let unit = plain(BLOCK);
    let reached = early(&unit, unit.step(0.0, long), long);
    // It is a good part of what is allowed at most, and goes on from there.
    let (status, stepped) = unit.step(reached, 0.1 * reached);
    assert_eq!((status, stepped.flags), (OK, [false; 3]), "{:?}", unit.messages.take());
    let once = plain(BLOCK);
    let (status, stepped) = once.step(0.0, 1.1 * reached);
    assert_eq!((status, stepped.flags), (OK, [false; 3]), "{:?}", once.messages.take());
    for name in ["centre.temperature", "block.heat_stored", "block.heat_in", "block.heat_lost"] {
        let [a, b] = [&unit, &once].map(|unit| unit.get(name)[0]);
        assert!((a - b).abs() <= 1e-9 * b.abs(), "{name}: {a} and {b}");
    }
}

/// How much a step asks for says nothing of where it may begin.
#[test]
fn a_step_that_ends_early_begins_at_the_units_time() {
    let unit = plain(BLOCK);
    assert_eq!(unit.step(0.0, 0.1).0, OK);
    let before = unit.snapshot();
    for (point, step) in [(0.0, 1e9), (0.2, 1e9), (-0.5, 1e9), (0.1 + 1e-6, 1e6), (0.0, 1e60)] {
        let (status, stepped) = unit.step(point, step);
        assert_eq!((status, stepped.flags), (ERROR, [false; 3]), "{point} {step}");
        unit.expect_message(ERROR, &["is not the unit's time"]);
        assert_eq!(unit.snapshot(), before);
    }
}

/// Steps of the same lengths, whoever chose them, are the same to the bit.
#[test]
fn going_on_after_an_early_return_is_going_on_after_a_step() {
    let unit = plain(BLOCK);
    let reached = early(&unit, unit.step(0.0, 1e9), 1e9);
    let asked = plain(BLOCK);
    assert_eq!(asked.step(0.0, reached).0, OK);
    assert_eq!(unit.snapshot(), asked.snapshot());
}

#[test]
fn a_step_too_long_for_one_call_is_discarded_where_it_may_not_end_early() {
    for (scene, step) in [(BLOCK, 1e9), (WALL, 1e3), (WALL, 1e60)] {
        for hears in [false, true] {
            let unit = Unit::instantiated_with(scene, |arguments| {
                arguments.early_return_allowed = false;
                arguments.update = hears.then_some(update);
            });
            let unit = started(unit);
            let before = unit.snapshot();
            let (status, stepped) = unit.step(0.0, step);
            assert_eq!((status, stepped.flags, stepped.time), (DISCARD, [false; 3], 0.0));
            unit.expect_message(DISCARD, &["more than a communication step may take"]);
            assert_eq!(unit.snapshot(), before);
        }
    }
}

#[test]
fn a_master_ends_a_step_of_a_droplet_at_once_or_later() {
    for (scene, step) in [(WALL, 5e-4), (PLATE, 5e-4), (WALL, 1e3), (WALL, 1e60)] {
        let unit = listening(scene, true);
        for now in [f64::NAN, -1.0] {
            let begin = unit.time();
            wish(Some(now));
            let reached = early(&unit, unit.step(begin, step), begin + step);
            let told = told();
            assert_eq!(told.len(), 2, "{told:?}");
            assert_eq!(told[1], (reached, [false, false, true, true]));
            assert!(begin < told[0].0 && told[0].0 < reached);
            if step > 1.0 || scene == PLATE {
                break;
            }
        }
    }
    // A time that is still to come is met.
    let unit = listening(WALL, true);
    wish(Some(0.0));
    let reached = early(&unit, unit.step(0.0, 5e-4), 5e-4);
    let later = 2.7 * reached;
    told();
    wish(Some(later));
    assert_eq!(early(&unit, unit.step(reached, 5e-4), 5e-4), later);
    let told = told();
    assert!(told.iter().all(|told| told.0 < later) && told.len() > 2, "{told:?}");
}

#[test]
fn a_master_that_may_not_end_a_step_is_told_of_it() {
    let unit = listening(WALL, false);
    wish(Some(0.0));
    let (status, stepped) = unit.step(0.0, 2e-4);
    assert_eq!((status, stepped.flags, stepped.time), (OK, [false; 3], 2e-4));
    let told = told();
    assert!(told.len() > 2 && told.is_sorted_by(|a, b| a.0 < b.0), "{told:?}");
    assert!(told.iter().all(|&(time, flags)| time < 2e-4 && flags == [false, false, true, false]));
}

/// A solid that flies through thousands of time steps, in a unit that declares no updates.
#[test]
fn units_that_declare_no_updates_make_none() {
    let flying = r#"
name = "Flying"
stop_time = 0.1
step = 0.1
[body.block]
kind = "solid"
strain = "finite"
inertia = true
dimension = 2
shape = { box = [1e-3, 1e-3, 1e-3] }
material = { model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e6, poisson = 0.3 }
initial_temperature = 293.15
mesh = { spacing = 1e-3 }
start = { height = 1.0 }
"#;
    let unit = listening(flying, true);
    wish(Some(0.0));
    let (status, stepped) = unit.step(0.0, 0.1);
    assert_eq!((status, stepped.flags, stepped.time), (OK, [false; 3], 0.1));
    assert!(unit.get("block.steps")[0] > 1e3);
    assert!(told().is_empty());
}

/// What is told as a mean over the last step is one over all its parts, so that what a master passes on is
/// all that the droplet gave.
#[test]
fn means_of_a_step_in_parts_are_over_the_whole_step() {
    let (unit, step) = (listening(WALL, true), 2e-4);
    wish(None);
    let (status, stepped) = unit.step(0.0, step);
    assert_eq!((status, stepped.flags), (OK, [false; 3]));
    assert!(told().len() > 2);
    for (mean, sum) in [("drop.force", "drop.impulse_z"), ("drop.heat_flow", "drop.heat")] {
        let [mean, sum] = [unit.get(mean)[0], unit.get(sum)[0]];
        assert!(sum != 0.0 && (step * mean.abs() / sum.abs() - 1.0).abs() < 1e-12, "{mean} {sum}");
    }
}

/// A unit that is asked for steps of an ordinary length goes as one of FMI 2.0, whoever listens.
#[test]
fn listening_changes_no_bit_of_steps_that_are_not_cut() {
    let units = [plain(WALL), listening(WALL, true), listening(WALL, false)];
    for k in 0..5 {
        units.iter().for_each(|unit| assert_eq!(unit.step(f64::from(k) * 1e-7, 1e-7).0, OK));
    }
    assert!(told().is_empty());
    assert_eq!(units[1].snapshot(), units[0].snapshot());
    assert_eq!(units[2].snapshot(), units[0].snapshot());
}

/// A state saved under FMI 2.0 may bring derivatives of inputs, which are known for one step alone: that is
/// not cut.
#[test]
fn a_step_under_derivatives_of_inputs_goes_to_its_end() {
    let old = crate::droplets::started(WALL);
    assert_eq!(old.set_derivative("wall.temperature[1,1]", 1, 1e4), OK);
    let state = old.serialize(old.save());
    let unit = listening(WALL, true);
    assert_eq!(unit.restore(unit.deserialize(&state)), OK, "{:?}", unit.messages.take());
    wish(Some(0.0));
    let (status, stepped) = unit.step(0.0, 2e-4);
    assert_eq!((status, stepped.flags, stepped.time), (OK, [false; 3], 2e-4));
    assert!(told().iter().all(|told| !told.1[3]));
    assert!((unit.get("wall.temperature")[0] - 302.0).abs() < 1e-9);
    wish(Some(0.0));
    let (status, stepped) = unit.step(2e-4, 1e3);
    assert_eq!((status, stepped.flags), (OK, [false, false, true]), "{:?}", unit.messages.take());
}
