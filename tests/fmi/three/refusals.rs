//! Calls with arguments that make no sense are refused, tell why and change nothing.

use std::ffi::c_char;
use std::ptr::{null, null_mut};

use crate::master::three::Unit;
use crate::master::{ERROR, Handle, call};

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
