//! A refused call names what is wrong and leaves everything as it was.

use std::ffi::{c_char, c_int};
use std::ptr::{null, null_mut};

use crate::master::{ERROR, Folder, Handle, OK, Unit, call};

/// `act` is refused with one message that holds the fragments, and changes no value and no time.
#[track_caller]
fn refused(unit: &Unit, act: impl FnOnce(&Unit) -> c_int, fragments: &[&str]) {
    let before = unit.snapshot();
    unit.messages.take();
    assert_eq!(act(unit), ERROR);
    unit.expect_message(ERROR, fragments);
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn values_that_are_not_finite_are_refused_by_name() {
    for make in [Unit::initializing, Unit::running] {
        let unit = make();
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            refused(&unit, |u| u.set("spot.heat_flux", value), &["spot.heat_flux", "finite"]);
        }
    }
    let unit = Unit::initializing();
    refused(&unit, |u| u.set("plate.density", f64::NAN), &["plate.density", "finite"]);
}

#[test]
fn values_beyond_their_bounds_are_refused_with_the_bound() {
    let unit = Unit::initializing();
    refused(&unit, |u| u.set("plate.poisson", 0.7), &["plate.poisson = 0.7", "at most 0.5"]);
    refused(&unit, |u| u.set("plate.density", -1.0), &["plate.density = -1.0", "at least 0"]);
    refused(&unit, |u| u.set("spot.x", 2e-4), &["spot.x = 0.0002", "at most 1e-4"]);
    refused(&unit, |u| u.set_threads(-1), &["solver.threads", "at least 0"]);
}

#[test]
fn parameters_are_fixed_after_initialization() {
    let unit = Unit::running();
    let folder = Folder::new("fields");
    refused(&unit, |u| u.set("plate.young", 2e11), &["plate.young", "fixed parameter"]);
    refused(&unit, |u| u.set_threads(2), &["solver.threads", "fixed parameter"]);
    refused(&unit, |u| u.set_directory(&folder.0), &["output.directory", "fixed parameter"]);
}

#[test]
fn parameters_that_make_no_sense_end_no_initialization() {
    let unit = Unit::initializing();
    assert_eq!(unit.set("plate.poisson", 0.5), OK);
    assert_eq!(unit.exit(), ERROR);
    unit.expect_message(ERROR, &["fmi2ExitInitializationMode", "poisson"]);
    assert_eq!(unit.set("plate.poisson", 0.3), OK);
    assert_eq!(unit.exit(), OK);
}

#[test]
fn outputs_cannot_be_set() {
    let unit = Unit::running();
    refused(&unit, |u| u.set("centre.temperature", 300.0), &["centre.temperature", "output"]);
}

#[test]
fn a_set_of_several_values_is_all_or_nothing() {
    let unit = Unit::running();
    let good = unit.reference("spot.heat_flux");
    let bad = unit.reference("spot.pressure");
    refused(&unit, |u| u.set_all(&[good, bad], &[1e3, f64::NAN]), &["spot.pressure"]);
    refused(&unit, |u| u.set_all(&[good, 99_999], &[1e3, 1.0]), &["99999", "unknown"]);
}

#[test]
fn a_refused_get_writes_nothing() {
    let unit = Unit::running();
    let mut values = [7.0, 7.0];
    let references = [unit.reference("centre.temperature"), u32::MAX];
    assert_eq!(unit.get_all(&references, &mut values), ERROR);
    unit.expect_message(ERROR, &["fmi2GetReal", "4294967295", "unknown"]);
    assert_eq!(values, [7.0, 7.0]);
}

#[test]
fn references_of_another_type_are_refused_by_name() {
    let unit = Unit::running();
    let threads = unit.reference("solver.threads");
    let directory = unit.reference("output.directory");
    let flux = unit.reference("spot.heat_flux");
    let wrong = |name: &str, reference: u32| {
        let mut room = 0_u64;
        call!(name, unit.handle => Handle, &raw const reference => *const u32, 1 => usize,
            &raw mut room => *mut u64)
    };
    for (name, reference, fragments) in [
        ("fmi2GetReal", threads, ["solver.threads", "no Real"]),
        ("fmi2SetReal", directory, ["output.directory", "no Real"]),
        ("fmi2GetInteger", flux, ["spot.heat_flux", "no Integer"]),
        ("fmi2SetInteger", directory, ["output.directory", "no Integer"]),
        ("fmi2GetBoolean", flux, ["spot.heat_flux", "no Boolean"]),
        ("fmi2SetBoolean", threads, ["solver.threads", "no Boolean"]),
        ("fmi2GetString", flux, ["spot.heat_flux", "no String"]),
    ] {
        assert_eq!(wrong(name, reference), ERROR, "{name}");
        unit.expect_message(ERROR, &fragments);
    }
}

#[test]
fn null_arrays_are_refused_unless_they_are_empty() {
    let unit = Unit::running();
    let reference = [unit.reference("spot.heat_flux")];
    for name in ["fmi2GetReal", "fmi2SetReal"] {
        let call = |references: *const u32, count| {
            call!(name, unit.handle => Handle, references => *const u32, count => usize,
                null_mut() => *mut f64)
        };
        assert_eq!(call(null(), 0), OK);
        assert_eq!(call(null(), 1), ERROR);
        unit.expect_message(ERROR, &[name, "vr is a null pointer"]);
        assert_eq!(call(reference.as_ptr(), 1), ERROR);
        unit.expect_message(ERROR, &[name, "value is a null pointer"]);
    }
}

#[test]
fn a_null_string_is_refused() {
    let unit = Unit::initializing();
    let reference = unit.reference("output.directory");
    let value: *const c_char = null();
    let set = |u: &Unit| {
        call!("fmi2SetString", u.handle => Handle, &raw const reference => *const u32, 1 => usize,
            &raw const value => *const *const c_char)
    };
    refused(&unit, set, &["value is a null pointer"]);
}

#[test]
fn experiments_that_make_no_sense_are_refused() {
    let unit = Unit::instantiated();
    for (start, stop, fragment) in [
        (f64::NAN, None, "start time"),
        (0.0, Some(0.0), "stop time"),
        (1.0, Some(0.5), "stop time"),
        (0.0, Some(f64::NAN), "stop time"),
    ] {
        assert_eq!(unit.setup(start, stop), ERROR);
        unit.expect_message(ERROR, &["fmi2SetupExperiment", fragment]);
    }
    assert_eq!(unit.setup(0.0, Some(1e-6)), OK);
}

#[test]
fn a_model_beyond_the_memory_of_the_machine_is_refused_with_numbers() {
    let unit = Unit::of_scene(&crate::master::SCENE.replace("spacing = 5e-5", "spacing = 1e-8"));
    assert_eq!(unit.setup(0.0, None), OK);
    assert_eq!(unit.enter(), OK);
    unit.messages.take();
    assert_eq!(unit.exit(), ERROR);
    unit.expect_message(ERROR, &["MB of memory", "`plate`", "larger `mesh.spacing`"]);
    assert_eq!(unit.reset(), OK);
}

#[test]
fn parameters_beyond_what_anything_real_has_are_refused_when_a_model_is_asked_for() {
    for (name, value) in [("drop.viscosity", 1e30), ("drop.conductivity", 1e45)] {
        let unit = Unit::of_scene(crate::droplets::WALL);
        assert_eq!(unit.setup(0.0, None), OK);
        assert_eq!(unit.enter(), OK);
        assert_eq!(unit.set(name, value), OK);
        unit.messages.take();
        assert_eq!(unit.exit(), ERROR);
        let constant = name.trim_start_matches("drop.");
        unit.expect_message(ERROR, &[constant, "beyond all bounds", "allowed:"]);
    }
}
