//! A refused call names what is wrong and leaves everything as it was.

use std::ffi::{c_char, c_int};
use std::ptr::{null, null_mut};

use crate::master::{ERROR, Folder, Handle, OK, Unit, UnitOf, Version, both_versions, call};

both_versions! {
    values_that_are_not_finite_are_refused_by_name,
    values_beyond_their_bounds_are_refused_with_the_bound,
    parameters_are_fixed_after_initialization,
    parameters_that_make_no_sense_end_no_initialization,
    outputs_cannot_be_set,
    a_set_of_several_values_is_all_or_nothing,
    a_refused_get_writes_nothing,
    null_arrays_are_refused_unless_they_are_empty,
    a_null_string_is_refused,
    experiments_that_make_no_sense_are_refused,
    a_model_beyond_the_memory_of_the_machine_is_refused_with_numbers,
    parameters_beyond_what_anything_real_has_are_refused_when_a_model_is_asked_for,
    whole_numbers_and_texts_are_taken_and_given_back,
}

/// `act` is refused with one message that holds the fragments, and changes no value and no time.
#[track_caller]
fn refused<V: Version>(
    unit: &UnitOf<V>,
    act: impl FnOnce(&UnitOf<V>) -> c_int,
    fragments: &[&str],
) {
    let before = unit.snapshot();
    unit.messages.take();
    assert_eq!(act(unit), ERROR);
    unit.expect_message(ERROR, fragments);
    assert_eq!(unit.snapshot(), before);
}

fn values_that_are_not_finite_are_refused_by_name<V: Version>() {
    for make in [UnitOf::<V>::initializing, UnitOf::<V>::running] {
        let unit = make();
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            refused(&unit, |u| u.put("spot.heat_flux", value), &["spot.heat_flux", "finite"]);
        }
    }
    let unit = UnitOf::<V>::initializing();
    refused(&unit, |u| u.put("plate.density", f64::NAN), &["plate.density", "finite"]);
}

fn values_beyond_their_bounds_are_refused_with_the_bound<V: Version>() {
    let unit = UnitOf::<V>::initializing();
    refused(&unit, |u| u.put("plate.poisson", 0.7), &["plate.poisson = 0.7", "at most 0.5"]);
    refused(&unit, |u| u.put("plate.density", -1.0), &["plate.density = -1.0", "at least 0"]);
    refused(&unit, |u| u.put("spot.x", 2e-4), &["spot.x = 0.0002", "at most 1e-4"]);
    refused(&unit, |u| u.set_threads(-1), &["solver.threads", "at least 0"]);
}

fn parameters_are_fixed_after_initialization<V: Version>() {
    let unit = UnitOf::<V>::running();
    let folder = Folder::new("fields");
    refused(&unit, |u| u.put("plate.young", 2e11), &["plate.young", "fixed parameter"]);
    refused(&unit, |u| u.set_threads(2), &["solver.threads", "fixed parameter"]);
    refused(&unit, |u| u.set_directory(&folder.0), &["output.directory", "fixed parameter"]);
}

fn parameters_that_make_no_sense_end_no_initialization<V: Version>() {
    let unit = UnitOf::<V>::initializing();
    assert_eq!(unit.put("plate.poisson", 0.5), OK);
    assert_eq!(unit.exit(), ERROR);
    unit.expect_message(ERROR, &[&V::name("ExitInitializationMode"), "poisson"]);
    assert_eq!(unit.put("plate.poisson", 0.3), OK);
    assert_eq!(unit.exit(), OK);
}

fn outputs_cannot_be_set<V: Version>() {
    let unit = UnitOf::<V>::running();
    refused(&unit, |u| u.put("centre.temperature", 300.0), &["centre.temperature is an output"]);
    refused(&unit, |u| u.put("plate.heat_in", 20.0), &["plate.heat_in is an output"]);
}

fn a_set_of_several_values_is_all_or_nothing<V: Version>() {
    let unit = UnitOf::<V>::running();
    let good = unit.reference("spot.heat_flux");
    let bad = unit.reference("spot.pressure");
    refused(&unit, |u| u.set_all(&[good, bad], &[1e3, f64::NAN]), &["spot.pressure"]);
    refused(&unit, |u| u.set_all(&[good, 99_999], &[1e3, 1.0]), &["99999", "unknown"]);
}

fn a_refused_get_writes_nothing<V: Version>() {
    let unit = UnitOf::<V>::running();
    let mut values = [7.0, 7.0];
    let references = [unit.reference("centre.temperature"), u32::MAX];
    assert_eq!(unit.get_in(&references, &mut values), ERROR);
    unit.expect_message(
        ERROR,
        &[&V::name(&format!("Get{}", V::REAL)), "value reference 4294967295 is unknown"],
    );
    assert_eq!(values, [7.0, 7.0]);
}

fn null_arrays_are_refused_unless_they_are_empty<V: Version>() {
    let unit = UnitOf::<V>::running();
    let reference = [unit.reference("spot.heat_flux")];
    let before = unit.snapshot();
    let null_pointer = |name: &str| format!("{name} is a null pointer");
    for name in ["Get", "Set"].map(|way| V::name(&format!("{way}{}", V::REAL))) {
        let call = |references: *const u32, count: usize| {
            call!(&name, unit.handle => Handle, references => *const u32, count => usize,
                null_mut() => *mut f64, count => usize)
        };
        assert_eq!(call(null(), 0), OK);
        assert_eq!(call(null(), 1), ERROR);
        unit.expect_message(ERROR, &[&name, &null_pointer(V::REFERENCES)]);
        assert_eq!(call(reference.as_ptr(), 1), ERROR);
        unit.expect_message(ERROR, &[&name, &null_pointer(V::VALUES)]);
    }
    assert_eq!(unit.snapshot(), before);
}

fn a_null_string_is_refused<V: Version>() {
    let unit = UnitOf::<V>::initializing();
    let reference = unit.reference("output.directory");
    let value: *const c_char = null();
    let set = |u: &UnitOf<V>| {
        call!(&V::name("SetString"), u.handle => Handle, &raw const reference => *const u32,
            1 => usize, &raw const value => *const *const c_char, 1 => usize)
    };
    refused(&unit, set, &[&format!("{} is a null pointer", V::VALUES)]);
}

fn experiments_that_make_no_sense_are_refused<V: Version>() {
    let unit = UnitOf::<V>::instantiated();
    for (start, stop, fragment) in [
        (f64::NAN, None, "start time"),
        (0.0, Some(0.0), "stop time"),
        (1.0, Some(0.5), "stop time"),
        (0.0, Some(f64::NAN), "stop time"),
    ] {
        assert_eq!(unit.begin(start, stop), ERROR);
        unit.expect_message(ERROR, &[V::EXPERIMENT, fragment]);
    }
    assert_eq!(unit.begin(0.0, Some(1e-6)), OK);
}

fn a_model_beyond_the_memory_of_the_machine_is_refused_with_numbers<V: Version>() {
    let unit =
        UnitOf::<V>::of_scene(&crate::master::SCENE.replace("spacing = 5e-5", "spacing = 1e-8"));
    assert_eq!(unit.begin(0.0, None), OK);
    unit.messages.take();
    assert_eq!(unit.exit(), ERROR);
    unit.expect_message(ERROR, &["MB of memory", "`plate`", "larger `mesh.spacing`"]);
    assert_eq!(unit.reset(), OK);
}

fn parameters_beyond_what_anything_real_has_are_refused_when_a_model_is_asked_for<V: Version>() {
    for (name, value) in [("drop.viscosity", 1e30), ("drop.conductivity", 1e45)] {
        let unit = UnitOf::<V>::of_scene(crate::droplets::WALL);
        assert_eq!(unit.begin(0.0, None), OK);
        assert_eq!(unit.put(name, value), OK);
        unit.messages.take();
        assert_eq!(unit.exit(), ERROR);
        let constant = name.trim_start_matches("drop.");
        unit.expect_message(ERROR, &[constant, "beyond all bounds", "allowed:"]);
    }
}

fn whole_numbers_and_texts_are_taken_and_given_back<V: Version>() {
    let unit = UnitOf::<V>::instantiated();
    let folder = Folder::new("fields");
    assert_eq!([unit.set_threads(2), unit.set_directory(&folder.0)], [OK; 2]);
    assert_eq!((unit.begin(0.0, None), unit.exit()), (OK, OK));
    assert_eq!((unit.threads(), unit.directory().as_str()), (2, folder.0.to_str().unwrap()));
    assert!(folder.0.read_dir().unwrap().next().is_some(), "fields are written");
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
