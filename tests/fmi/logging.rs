//! Who is told what.

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr::{null, null_mut};
use std::sync::atomic::{AtomicI32, AtomicPtr, Ordering};

use crate::master::{
    Arguments, Callbacks, DISCARD, ERROR, Folder, Handle, OK, SCENE, STRIP, Unit, WARNING, call,
    free, library,
};

fn configure(unit: &Unit, on: bool, names: &[&str]) -> c_int {
    let names: Vec<CString> = names.iter().map(|name| CString::new(*name).unwrap()).collect();
    let pointers: Vec<*const c_char> = names.iter().map(|name| name.as_ptr()).collect();
    call!("fmi2SetDebugLogging", unit.handle => Handle, on.into() => c_int,
        pointers.len() => usize, pointers.as_ptr() => *const *const c_char)
}

#[test]
fn messages_carry_instance_and_category() {
    let unit = Unit::running();
    assert_eq!(unit.step(5.0, 1.0), ERROR);
    let messages = unit.messages.take();
    assert_eq!((messages.len(), messages[0].instance.as_str()), (1, "unit"));
    assert_eq!(messages[0].category, "logStatusError");
}

#[test]
fn only_the_wanted_categories_come() {
    let unit = Unit::initializing();
    assert_eq!(configure(&unit, true, &["logStatusError"]), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.messages.take(), []);
    assert_eq!(unit.step(5.0, 1.0), ERROR);
    unit.expect_message(ERROR, &["communication point"]);
    assert_eq!(configure(&unit, true, &["logStatusWarning", "model"]), OK);
    assert_eq!(unit.step(5.0, 1.0), ERROR);
    assert_eq!(unit.messages.take(), []);
    for all in [&["logAll"][..], &[]] {
        assert_eq!(configure(&unit, true, all), OK);
        assert_eq!(unit.step(5.0, 1.0), ERROR);
        unit.expect_message(ERROR, &["communication point"]);
    }
}

#[test]
fn notes_on_the_model_come_when_it_is_built() {
    let unit = Unit::initializing();
    assert_eq!(unit.exit(), OK);
    let messages = unit.messages.take();
    assert!(messages.iter().any(|m| m.category == "model" && m.status == OK), "{messages:?}");
}

#[test]
fn an_input_that_is_hardly_meant_is_warned_of_once() {
    let unit = Unit::running();
    unit.messages.take();
    let warnings = || {
        let messages = unit.messages.take();
        let texts = messages.into_iter().filter(|m| m.status == WARNING).map(|m| m.text);
        texts.collect::<Vec<_>>()
    };
    assert_eq!(unit.set("plate.bottom.ambient", 20.0), OK);
    let said = warnings();
    assert!(said.len() == 1 && said[0].contains("plate.bottom.ambient = 20:"), "{said:?}");
    assert!(said[0].contains("did you mean 293.15 (20 °C)?"), "{said:?}");
    assert_eq!(unit.set("plate.bottom.ambient", 25.0), OK);
    assert_eq!(warnings(), [""; 0]);
    assert_eq!(unit.set("patch.heat_flux[1,1]", 1e15), OK);
    assert_eq!(unit.set("patch.heat_flux[2,1]", 1e15), OK);
    assert_eq!(warnings().len(), 1, "one for the elements of an array");
    assert_eq!(unit.set("spot.heat_flux", 1e7), OK);
    assert_eq!(warnings(), [""; 0]);
}

#[test]
fn without_debug_logging_only_errors_come() {
    let folder = Folder::with_scene("quiet", SCENE);
    let unit = Unit::initializing();
    assert_eq!(configure(&unit, false, &[]), OK);
    assert_eq!(unit.set_directory(&folder.0.join("scene.toml")), OK);
    unit.exit();
    assert_eq!(unit.messages.take(), []);
    assert_eq!(unit.step(5.0, 1.0), ERROR);
    unit.expect_message(ERROR, &["communication point"]);
}

#[test]
fn unknown_categories_are_refused_and_change_nothing() {
    let unit = Unit::running();
    assert_eq!(configure(&unit, true, &["logStatusWarning"]), OK);
    assert_eq!(configure(&unit, false, &["logAll", "gossip"]), ERROR);
    assert_eq!(unit.step(5.0, 1.0), ERROR);
    assert_eq!(unit.messages.take(), []);
    assert_eq!(configure(&unit, true, &[]), OK);
    assert_eq!(configure(&unit, false, &["gossip"]), ERROR);
    unit.expect_message(ERROR, &["\"gossip\" is unknown", "logStatusError", "logAll"]);
    let status = call!("fmi2SetDebugLogging", unit.handle => Handle, 1 => c_int, 1 => usize,
        null() => *const *const c_char);
    assert_eq!(status, ERROR);
    unit.expect_message(ERROR, &["categories is a null pointer"]);
}

#[test]
fn each_category_comes_with_its_status_and_only_if_it_is_wanted() {
    type Act = fn(&Unit) -> c_int;
    let causes: [(&str, c_int, Act); 4] = [
        ("logStatusWarning", WARNING, |unit| {
            unit.set_directory(Path::new("/proc/none"));
            unit.exit()
        }),
        ("logStatusError", ERROR, |unit| unit.step(5.0, 1.0)),
        ("logStatusDiscard", DISCARD, |unit| {
            let mut value = 0;
            call!("fmi2GetIntegerStatus", unit.handle => Handle, 2 => c_int,
                &raw mut value => *mut c_int)
        }),
        ("model", OK, Unit::exit),
    ];
    for (category, status, cause) in causes {
        let make = if [WARNING, OK].contains(&status) { Unit::initializing } else { Unit::running };
        for wanted in causes.map(|(wanted, ..)| wanted) {
            let unit = make();
            assert_eq!(configure(&unit, true, &[wanted]), OK);
            unit.messages.take();
            assert_eq!(cause(&unit), status, "{category}");
            let messages = unit.messages.take();
            let came =
                messages.iter().any(|m| (m.category.as_str(), m.status) == (category, status));
            assert_eq!(came, wanted == category, "{category} of {wanted}: {messages:?}");
            assert!(messages.iter().all(|m| m.category == wanted), "{messages:?}");
        }
    }
}

#[test]
fn messages_are_short_whatever_they_quote() {
    let unit = Unit::initializing();
    unit.messages.take();
    assert_eq!(configure(&unit, true, &["%s".repeat(5000).as_str()]), ERROR);
    let messages = unit.messages.take();
    assert!(messages.len() == 1 && messages[0].text.len() < 1024, "{messages:?}");
    assert!(messages[0].text.contains("%s%s"), "{messages:?}");
}

#[test]
fn a_unit_without_logger_refuses_in_silence() {
    let folder = Folder::with_scene("mute", SCENE);
    let callbacks = Callbacks {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: null_mut(),
    };
    let handle = Arguments::good(&folder).instantiate_with(&callbacks);
    assert!(!handle.is_null());
    assert_eq!(call!("fmi2Terminate", handle => Handle), ERROR);
    assert_eq!(call!("fmi2EnterInitializationMode", handle => Handle), OK);
    assert_eq!(call!("fmi2ExitInitializationMode", handle => Handle), OK);
    assert_eq!(call!("fmi2DoStep", handle => Handle, 9.0 => f64, 1.0 => f64, 0 => c_int), ERROR);
    free(handle);
}

#[test]
fn percent_signs_in_messages_are_no_formats() {
    let folder = Folder::with_scene("taken", SCENE);
    let unit = Unit::initializing();
    unit.messages.take();
    let path = folder.0.join("scene.toml").join("100%s%n%d");
    assert_eq!(unit.set_directory(&path), OK);
    unit.exit();
    let messages = unit.messages.take();
    assert!(messages.iter().any(|m| m.text.contains("100%s%n%d")), "{messages:?}");
}

static INSTANCE: AtomicPtr<c_void> = AtomicPtr::new(null_mut());
static STATUS: AtomicI32 = AtomicI32::new(-1);

/// Calls back into the unit that is just speaking.
unsafe extern "C" fn nosy_logger(
    _: *mut c_void,
    _: *const c_char,
    _: c_int,
    _: *const c_char,
    _: *const c_char,
) {
    let handle = INSTANCE.load(Ordering::SeqCst);
    STATUS.store(call!("fmi2Reset", handle => Handle), Ordering::SeqCst);
    free(handle);
}

#[test]
fn a_call_from_within_the_logger_is_refused() {
    let folder = Folder::with_scene("nosy", SCENE);
    let callbacks = Callbacks {
        logger: Some(nosy_logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: null_mut(),
    };
    let handle = Arguments::good(&folder).instantiate_with(&callbacks);
    INSTANCE.store(handle, Ordering::SeqCst);
    assert_eq!(call!("fmi2Terminate", handle => Handle), ERROR);
    assert_eq!(STATUS.load(Ordering::SeqCst), ERROR);
    assert_eq!(call!("fmi2EnterInitializationMode", handle => Handle), OK);
    free(handle);
}

/// Runs alone in a process of its own; see below.
#[cfg(unix)]
#[test]
#[ignore = "is run by nothing_is_written_to_the_hosts_terminal"]
fn whole_run_with_the_terminal_caught() {
    let file = Folder::new("terminal");
    let path = CString::new(file.0.join("out").to_str().unwrap()).unwrap();
    // SAFETY: plain POSIX calls on descriptors of this process.
    unsafe {
        let caught = libc::open(path.as_ptr(), libc::O_CREAT | libc::O_WRONLY, 0o600);
        let kept = [1, 2].map(|descriptor| libc::dup(descriptor));
        for descriptor in [1, 2] {
            libc::dup2(caught, descriptor);
        }
        let unit = Unit::running();
        unit.step(0.0, 1e-8);
        unit.step(0.0, f64::NAN);
        unit.snapshot();
        unit.terminate();
        drop(unit);
        for (kept, descriptor) in kept.into_iter().zip([1, 2]) {
            libc::dup2(kept, descriptor);
        }
    }
    assert_eq!(std::fs::read_to_string(file.0.join("out")).unwrap(), "");
}

#[cfg(unix)]
#[test]
fn nothing_is_written_to_the_hosts_terminal() {
    library();
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "logging::whole_run_with_the_terminal_caught"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}

/// Messages of warnings that have come since the last look.
fn warnings(unit: &Unit) -> Vec<String> {
    let messages = unit.messages.take().into_iter();
    let warnings = messages.filter(|m| m.category == "logStatusWarning" && m.status == WARNING);
    warnings.map(|message| message.text).collect()
}

#[test]
fn what_is_hardly_meant_is_told_once() {
    let soft = SCENE.replace("young = 300e9", "young = 300.0").replace("5e-5", "1e-5");
    let unit = Unit::of_scene(&soft);
    assert_eq!((unit.setup(0.0, None), unit.enter(), unit.exit()), (OK, OK, OK));
    let found = warnings(&unit);
    assert_eq!(found.len(), 1, "{found:?}");
    for words in ["scene.toml:10:", "body.plate.material.young = 300.0", "3e11 (300 GPa)"] {
        assert!(found[0].contains(words), "{words} is not in {found:?}");
    }
    assert_eq!(unit.step(0.0, 1e-8), OK);
    assert_eq!((unit.reset(), unit.setup(0.0, None)), (OK, OK));
    // The parameters of the second run are cured, but for another one.
    assert_eq!((unit.set("plate.young", 3e11), unit.set("plate.density", 3.95)), (OK, OK));
    assert_eq!((unit.enter(), unit.exit()), (OK, OK));
    let found = warnings(&unit);
    assert!(found.len() == 1 && found[0].contains("density"), "{found:?}");
}

/// Steps that are far shorter than those that a mesh was chosen for underestimate the effect of a jump: a rise of 20 %
/// of the closed form after 1e-11 s on the mesh for 1e-8 s, of 99 % after one of these.
#[test]
fn steps_too_short_for_the_mesh_are_warned_of_once() {
    const SLAB: &str = r#"
name = "Slab"
stop_time = 1e-7
step = 1e-8
[body.slab]
kind = "solid"
shape = { box = [1e-3, 1e-3, 1e-3] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 300.0
faces = { top = { flux = 1e8 } }
[[probe]]
name = "centre"
in = "slab"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#;
    let rise = |unit: &Unit| unit.get("centre.temperature") - 300.0;
    let exact = |time: f64| 2e8 * (time / (std::f64::consts::PI * 10.0 * 3950.0 * 900.0)).sqrt();
    let started = || {
        let unit = Unit::of_scene(SLAB);
        assert_eq!((unit.setup(0.0, None), unit.enter(), unit.exit()), (OK, OK, OK));
        unit.messages.take();
        unit
    };
    let unit = started();
    assert_eq!(unit.step(0.0, 1e-11), OK);
    assert!(rise(&unit) < 0.5 * exact(1e-11));
    let found = warnings(&unit);
    assert!(found.len() == 1 && found[0].contains("slab: a step of 1.0e-11 s"), "{found:?}");
    assert_eq!(unit.step(1e-11, 1e-11), OK);
    assert_eq!(warnings(&unit), [""; 0]);
    let quiet = |steps: &[(f64, f64)]| {
        let unit = started();
        for &(time, step) in steps {
            assert_eq!(unit.step(time, step), OK);
            assert_eq!(warnings(&unit), [""; 0], "{step}");
        }
        unit
    };
    quiet(&[(0.0, 1e-8), (1e-8, 5e-9), (1.5e-8, 1e-18)]);
    // One that is short by itself is what a master has left over.
    let unit = quiet(&[(0.0, 1e-8), (1e-8, 5e-9), (1.5e-8, 1e-11), (1.501e-8, 5e-9)]);
    assert!((rise(&unit) / exact(2.001e-8) - 1.0).abs() < 0.02);
    assert_eq!((unit.step(2.001e-8, 1e-11), unit.step(2.002e-8, 1e-11)), (OK, OK));
    assert_eq!(warnings(&unit).len(), 1);
    // Unless an input has jumped before it.
    let unit = quiet(&[(0.0, 1e-8)]);
    assert_eq!((unit.set("slab.top.flux", 2e8), unit.step(1e-8, 1e-11)), (OK, OK));
    assert_eq!(warnings(&unit).len(), 1);
}

#[test]
fn a_step_to_below_absolute_zero_is_discarded_with_the_reason() {
    let unit = Unit::running();
    let saved = unit.save();
    let before = unit.serialize(saved);
    assert_eq!(unit.set("spot.heat_flux", -1e13), OK);
    let held = unit.serialize(unit.save());
    assert_eq!(unit.step(0.0, 1e-8), DISCARD);
    unit.expect_message(DISCARD, &["plate would cool to -", "below absolute zero"]);
    assert_ne!(before, held);
    assert_eq!(unit.restore(saved), OK);
    assert_eq!(unit.serialize(unit.save()), before);
    assert_eq!(unit.step(0.0, 1e-8), OK);
}

#[test]
fn outputs_beyond_numbers_are_errors() {
    let unit = Unit::instantiated();
    let extremes = [
        ("plate.density", 1e-60),
        ("plate.specific_heat", 1e-60),
        ("plate.young", 1e60),
        ("plate.expansion", 1e60),
        ("plate.bottom.coefficient", 0.0),
        ("spot.heat_flux", 1e60),
    ];
    for (name, value) in extremes {
        assert_eq!(unit.set(name, value), OK, "{name}");
    }
    unit.expect_message(WARNING, &["spot.heat_flux = 1e60: a heat flux is plausible"]);
    assert_eq!([unit.setup(0.0, None), unit.enter(), unit.exit()], [OK; 3]);
    assert_eq!(unit.step(0.0, 1e20), OK, "{:?}", unit.messages.take());
    let mut value = [7.0];
    let reference = unit.reference("plate.max_von_mises");
    unit.messages.take();
    assert_eq!(unit.get_in(&[reference], &mut value), ERROR);
    unit.expect_message(
        ERROR,
        &["no value of plate.max_von_mises", "beyond what numbers can hold"],
    );
    assert_eq!(value, [7.0]);
    assert!(unit.get("plate.max_temperature") > 1e100);
}

/// A strip of one strength throughout is damaged evenly before it breaks.
#[test]
fn termination_tells_what_only_the_end_of_a_run_shows() {
    let unit = Unit::of_scene(&STRIP.replace(", scatter = 0.04", ""));
    assert_eq!((unit.setup(0.0, None), unit.enter(), unit.exit()), (OK, OK, OK));
    for (time, part) in [(0.0, 0.95), (1.0, 1.04)] {
        let cooled = 600.0 - part * 300e6 / (340e9 * 8e-6);
        assert_eq!(unit.set("plate.top.temperature", cooled), OK);
        assert_eq!(unit.set("plate.bottom.temperature", cooled), OK);
        assert_eq!(unit.step(time, 1.0), OK);
    }
    let about = |found: &[String]| found.iter().filter(|text| text.contains("scatter")).count();
    assert_eq!(about(&warnings(&unit)), 0);
    unit.terminate();
    let found = warnings(&unit);
    assert_eq!(about(&found), 1, "{found:?}");
}
