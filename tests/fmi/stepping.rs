//! Steps: their times, what they refuse, and the files they write.

use std::ffi::c_int;
use std::fs;

use crate::master::{DISCARD, ERROR, Folder, Handle, OK, Unit, WARNING, call};

#[test]
fn times_add_up_without_drift() {
    let unit = Unit::running();
    let mut time = 0.0;
    for _ in 0..1000 {
        assert_eq!(unit.step(time, 1e-8), OK, "{:?}", unit.messages.take());
        time += 1e-8;
    }
    assert_eq!(unit.time(), time);
}

#[test]
fn masters_may_multiply_or_sum_their_times() {
    let unit = Unit::running();
    for k in 0..1000 {
        assert_eq!(unit.step(f64::from(k) * 1e-8, 1e-8), OK, "{:?}", unit.messages.take());
    }
}

#[test]
fn a_run_may_start_at_any_time() {
    let late = Unit::instantiated();
    assert_eq!(late.setup(0.5, Some(0.5 + 2.0_f64.powi(-20))), OK);
    assert_eq!(late.enter(), OK);
    assert_eq!(late.exit(), OK);
    assert_eq!(late.time(), 0.5);
    let early = Unit::running();
    let step = 2.0_f64.powi(-26);
    for k in 0..4 {
        assert_eq!(late.step(0.5 + f64::from(k) * step, step), OK);
        assert_eq!(early.step(f64::from(k) * step, step), OK);
    }
    assert_eq!(late.time(), 0.5 + 4.0 * step);
    assert_eq!(late.snapshot(), early.snapshot());
}

#[test]
fn bad_steps_are_refused_and_change_nothing() {
    let unit = Unit::instantiated();
    assert_eq!(unit.setup(0.0, Some(1e-7)), OK);
    assert_eq!(unit.enter(), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let before = unit.snapshot();
    unit.messages.take();
    for (point, step, fragment) in [
        (1e-8, 0.0, "step size 0.0"),
        (1e-8, -1e-8, "step size -1e-8"),
        (1e-8, f64::NAN, "step size NaN"),
        (1e-8, f64::INFINITY, "step size inf"),
        (0.0, 1e-8, "communication point 0.0"),
        (2e-8, 1e-8, "communication point 2e-8"),
        (f64::NAN, 1e-8, "communication point NaN"),
        (1e-8, 1e-7, "stop time 1e-7"),
        (1e-8, 1e-30, "lost in rounding"),
    ] {
        assert_eq!(unit.step(point, step), ERROR, "{fragment}");
        unit.expect_message(ERROR, &["fmi2DoStep", fragment]);
        assert_eq!(unit.snapshot(), before, "{fragment}");
        assert_eq!(unit.time(), 1e-8, "{fragment}");
    }
    assert_eq!(unit.step(1e-8, 9e-8), OK, "{:?}", unit.messages.take());
}

#[test]
fn only_the_last_successful_time_and_that_a_unit_goes_on_are_told() {
    let unit = Unit::running();
    assert_eq!((unit.time(), unit.wants_to_end()), (0.0, 0));
    for (name, kind, fragment) in [
        ("fmi2GetStatus", 0, "fmi2DoStepStatus"),
        ("fmi2GetRealStatus", 0, "fmi2DoStepStatus"),
        ("fmi2GetIntegerStatus", 2, "fmi2LastSuccessfulTime"),
        ("fmi2GetBooleanStatus", 0, "fmi2DoStepStatus"),
        ("fmi2GetRealStatus", 3, "fmi2Terminated"),
        ("fmi2GetStringStatus", 1, "fmi2PendingStatus"),
        ("fmi2GetStatus", 9, "kind 9 is unknown"),
    ] {
        let mut value = 0_u64;
        let status = call!(name, unit.handle => Handle, kind => c_int, &raw mut value => *mut u64);
        assert_eq!((status, value), (DISCARD, 0), "{name}");
        unit.expect_message(DISCARD, &[name, fragment]);
    }
}

#[test]
fn inputs_and_parameters_reach_the_model() {
    let unit = Unit::initializing();
    assert_eq!(unit.set("plate.initial_temperature", 350.0), OK);
    assert_eq!(unit.set("spot.heat_flux", 1e7), OK);
    assert_eq!(unit.get("plate.initial_temperature"), 350.0);
    assert_eq!(unit.get("plate.heat_in"), 0.0);
    // A parameter after a look at an output: the model is built anew, the inputs stay.
    assert_eq!(unit.set("plate.initial_temperature", 360.0), OK);
    assert_eq!(unit.get("spot.heat_flux"), 1e7);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let heat = unit.get("plate.heat_in");
    assert!(heat > 0.0);
    assert_eq!(unit.set("spot.heat_flux", 0.0), OK);
    assert_eq!(unit.step(1e-8, 1e-8), OK);
    assert_eq!(unit.get("plate.heat_in"), heat);
}

#[test]
fn a_footprint_off_its_face_is_refused_by_name_until_it_is_put_back() {
    let unit = Unit::running();
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let before = unit.snapshot();
    assert_eq!(unit.set("patch.x", 1.0), OK);
    unit.messages.take();
    assert_eq!(unit.step(1e-8, 1e-8), ERROR);
    unit.expect_message(ERROR, &["fmi2DoStep", "patch.x"]);
    let mut value = [7.0];
    assert_eq!(unit.get_in(&[unit.reference("centre.temperature")], &mut value), ERROR);
    unit.expect_message(ERROR, &["fmi2GetReal", "patch.x"]);
    assert_eq!((value, unit.time()), ([7.0], 1e-8));
    assert_eq!(unit.set("patch.x", 0.0), OK);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(unit.step(1e-8, 1e-8), OK);
}

#[test]
fn fields_are_written_if_there_is_a_folder_for_them() {
    let folder = Folder::new("fields");
    let unit = Unit::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    assert_eq!(unit.directory(), folder.0.to_str().unwrap());
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    assert_ne!(fs::read_dir(&folder.0).unwrap().count(), 0);
}

#[test]
fn fields_that_cannot_be_written_are_a_warning() {
    let folder = Folder::with_scene("fields", "a file");
    let unit = Unit::initializing();
    unit.messages.take();
    assert_eq!(unit.set_directory(&folder.0.join("scene.toml")), OK);
    assert_eq!(unit.exit(), WARNING);
    let warnings: Vec<_> =
        unit.messages.take().into_iter().filter(|message| message.status == WARNING).collect();
    assert!(warnings.len() == 1 && warnings[0].text.contains("output.directory"), "{warnings:?}");
    assert_eq!(unit.step(0.0, 1e-8), OK);
}
