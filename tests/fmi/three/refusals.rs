//! Calls with arguments that make no sense are refused, tell why and change nothing.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use super::master::Unit;
use crate::master::{ERROR, Folder, Handle, OK, call};

#[test]
fn variables_of_other_types_are_refused_by_name() {
    let unit = Unit::running();
    let before = unit.snapshot();
    let flux = unit.reference("patch.heat_flux");
    for kind in [
        "Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64",
        "Boolean", "String",
    ] {
        for prefix in ["fmi3Get", "fmi3Set"] {
            let name = format!("{prefix}{kind}");
            let mut values = [c"text".as_ptr(); 6];
            let status = call!(&name, unit.handle => Handle, &raw const flux => *const u32,
                1 => usize, values.as_mut_ptr() => *mut *const c_char, 6 => usize);
            assert_eq!(status, ERROR, "{name}");
            let reason = format!("patch.heat_flux is no {kind} but a Float64");
            unit.expect_message(ERROR, &[&name, &reason]);
        }
    }
    for name in ["fmi3GetBinary", "fmi3SetBinary"] {
        let (mut sizes, mut values) = ([0_usize; 6], [null::<u8>(); 6]);
        let status = call!(name, unit.handle => Handle, &raw const flux => *const u32, 1 => usize,
            sizes.as_mut_ptr() => *mut usize, values.as_mut_ptr() => *mut *const u8, 6 => usize);
        assert_eq!(status, ERROR, "{name}");
        unit.expect_message(ERROR, &[name, "no Binary"]);
    }
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn unknown_references_and_null_pointers_are_refused() {
    let unit = Unit::running();
    let before = unit.snapshot();
    let mut value = [0.0];
    assert_eq!(unit.get_in(&[4_000_000_000], &mut value), ERROR);
    unit.expect_message(ERROR, &["value reference 4000000000 is unknown"]);
    let flux = unit.reference("spot.heat_flux");
    for name in ["fmi3GetFloat64", "fmi3SetFloat64"] {
        for (references, values) in
            [(null(), value.as_mut_ptr().cast()), (&raw const flux, null_mut::<c_void>())]
        {
            let status = call!(name, unit.handle => Handle, references => *const u32, 1 => usize,
                values => *mut c_void, 1 => usize);
            assert_eq!(status, ERROR);
            unit.expect_message(ERROR, &[name, "null pointer"]);
        }
    }
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn a_step_without_room_for_its_answers_is_not_done() {
    let unit = Unit::running();
    let before = unit.snapshot();
    let names = ["eventHandlingNeeded", "terminateSimulation", "earlyReturn", "lastSuccessfulTime"];
    for (missing, name) in names.into_iter().enumerate() {
        let (mut flags, mut time) = ([true; 3], -1.0);
        let mut pointers = flags.each_mut().map(|flag| &raw mut *flag);
        let mut last = &raw mut time;
        match pointers.get_mut(missing) {
            Some(pointer) => *pointer = null_mut(),
            None => last = null_mut(),
        }
        let status = call!("fmi3DoStep", unit.handle => Handle, 0.0 => f64, 1e-8 => f64,
            false => bool, pointers[0] => *mut bool, pointers[1] => *mut bool,
            pointers[2] => *mut bool, last => *mut f64);
        assert_eq!(status, ERROR, "{name}");
        unit.expect_message(ERROR, &["fmi3DoStep", name, "null pointer"]);
        assert_eq!((flags, time), ([true; 3], -1.0), "{name}");
    }
    assert_eq!(unit.snapshot(), before);
    let (status, stepped) = unit.step(1.0, 1e-8);
    assert_eq!((status, stepped.time), (ERROR, 0.0));
    unit.expect_message(ERROR, &["communication point"]);
}

#[test]
fn parameters_are_fixed_once_steps_are_made() {
    let unit = Unit::running();
    assert_eq!(unit.set("plate.conductivity", &[20.0]), ERROR);
    unit.expect_message(ERROR, &["plate.conductivity is a fixed parameter"]);
    assert_eq!(unit.set("plate.heat_in", &[20.0]), ERROR);
    unit.expect_message(ERROR, &["plate.heat_in is an output"]);
    assert_eq!(unit.get("plate.conductivity"), [10.0]);
}

#[test]
fn whole_numbers_and_texts_are_taken_and_given_back() {
    let unit = Unit::instantiated();
    let (threads, mut value) = (unit.reference("solver.threads"), 2 as c_int);
    let number = |name: &str, value: &mut c_int| {
        call!(name, unit.handle => Handle, &raw const threads => *const u32, 1 => usize,
            value => *mut c_int, 1 => usize)
    };
    assert_eq!(number("fmi3SetInt32", &mut value), OK);
    value = -1;
    assert_eq!((number("fmi3GetInt32", &mut value), value), (OK, 2));
    value = -7;
    assert_eq!(number("fmi3SetInt32", &mut value), ERROR);
    unit.expect_message(ERROR, &["solver.threads = -7", "at least"]);

    let folder = Folder::new("fields");
    let path = CString::new(folder.0.to_str().unwrap()).unwrap();
    let (directory, mut text) = (unit.reference("output.directory"), path.as_ptr());
    let string = |name: &str, text: &mut *const c_char| {
        call!(name, unit.handle => Handle, &raw const directory => *const u32, 1 => usize,
            text => *mut *const c_char, 1 => usize)
    };
    assert_eq!(string("fmi3SetString", &mut text), OK);
    text = null();
    assert_eq!(string("fmi3GetString", &mut text), OK);
    // SAFETY: valid until the next call on the instance.
    assert_eq!(unsafe { CStr::from_ptr(text) }, path.as_c_str());
    assert_eq!((unit.enter(0.0, None), unit.exit()), (OK, OK));
    assert!(folder.0.read_dir().unwrap().next().is_some(), "fields are written");
}
