//! Saving states, going back to them, and sending them elsewhere.

use std::ffi::c_void;
use std::process::Command;
use std::ptr::null_mut;
use std::{env, fs};

use crate::master::{ERROR, Folder, OK, SCENE, Saved, Unit, WARNING};

/// All values and the time.
type Seen = ((Vec<u64>, i32, String), u64);

fn seen(unit: &Unit) -> Seen {
    (unit.snapshot(), unit.time().to_bits())
}

/// Steps of different lengths under inputs that change, seen after each.
fn go_on(unit: &Unit) -> Vec<Seen> {
    let mut seen_after = Vec::new();
    for (i, step) in [1e-8, 3e-8, 0.5e-8].into_iter().enumerate() {
        assert_eq!(unit.set("spot.x", 1e-5 * i as f64), OK);
        assert_eq!(unit.set_derivative("spot.heat_flux", 1, 1e14), OK);
        assert_eq!(unit.step(unit.time(), step), OK, "{:?}", unit.messages.take());
        seen_after.push(seen(unit));
    }
    seen_after
}

/// A unit amid a run that has used all that belongs to a state.
fn busy(threads: i32) -> Unit {
    let unit = Unit::instantiated();
    assert_eq!(unit.setup(1e-6, Some(3e-6)), OK);
    assert_eq!(unit.set("plate.conductivity", 14.0), OK);
    assert_eq!(unit.set_threads(threads), OK);
    assert_eq!(unit.enter(), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.set("spot.y", -3e-5), OK);
    assert_eq!(unit.set_derivative("spot.x", 1, 500.0), OK);
    assert_eq!(unit.step(1e-6, 2e-8), OK, "{:?}", unit.messages.take());
    assert_eq!(unit.set("spot.pressure", 2e6), OK);
    assert_eq!(unit.set_derivative("spot.pressure", 1, 1e13), OK);
    unit.messages.take();
    unit
}

/// A state goes on as the unit did from which it was taken, in `other` and to the bit.
fn repeats(saved: &[u8], wanted: &[Seen], other: &Unit) {
    let state = other.deserialize(saved);
    assert_eq!(other.restore(state), OK, "{:?}", other.messages.take());
    assert_eq!(go_on(other), wanted);
}

#[test]
fn a_state_goes_on_to_the_bit_in_the_same_instance() {
    let unit = busy(1);
    let (state, before) = (unit.save(), seen(&unit));
    let first = go_on(&unit);
    for _ in 0..2 {
        assert_eq!(unit.restore(state), OK);
        assert_eq!(seen(&unit), before);
        assert_eq!(go_on(&unit), first);
    }
    assert_eq!(unit.terminate(), OK);
    assert_eq!(unit.restore(state), OK, "a terminated unit goes on");
    assert_eq!(go_on(&unit), first);
    assert_eq!(unit.reset(), OK);
    assert_eq!(unit.restore(state), OK, "a reset unit goes on");
    assert_eq!(go_on(&unit), first);
}

#[test]
fn a_state_goes_on_to_the_bit_in_another_instance_and_on_other_threads() {
    let unit = busy(1);
    let saved = unit.serialize(unit.save());
    let wanted = go_on(&unit);
    let reset = busy(2);
    assert_eq!(reset.reset(), OK);
    for other in [Unit::instantiated(), Unit::running(), Unit::terminated(), busy(2), reset] {
        repeats(&saved, &wanted, &other);
    }
}

#[test]
fn a_run_on_two_threads_saves_what_one_on_one_thread_does() {
    let [one, two] = [1, 2].map(|threads| {
        let unit = busy(threads);
        let saved = unit.serialize(unit.save());
        (
            saved,
            go_on(&unit).into_iter().map(|((values, ..), time)| (values, time)).collect::<Vec<_>>(),
        )
    });
    assert_eq!(one.1, two.1);
    // The number of threads is a parameter, and so are the checksum and the bytes of it different.
    let differ = one.0.iter().zip(&two.0).filter(|(a, b)| a != b).count();
    assert!((2..=17).contains(&differ), "{differ} bytes differ");
}

const SENT: &str = "IMPINGE_SENT_STATE";

/// Runs in a process of its own; see below.
#[test]
#[ignore = "is run by a_state_goes_on_to_the_bit_in_another_process"]
fn go_on_from_a_file() {
    let folder = std::path::PathBuf::from(env::var_os(SENT).unwrap());
    let unit = Unit::instantiated();
    let state = unit.deserialize(&fs::read(folder.join("state")).unwrap());
    assert_eq!(unit.restore(state), OK);
    fs::write(folder.join("seen"), format!("{:?}", go_on(&unit))).unwrap();
}

#[test]
fn a_state_goes_on_to_the_bit_in_another_process() {
    let folder = Folder::new("sent");
    let unit = busy(1);
    fs::write(folder.0.join("state"), unit.serialize(unit.save())).unwrap();
    let output = Command::new(env::current_exe().unwrap())
        .args(["--ignored", "--exact", "states::go_on_from_a_file"])
        .env(SENT, &folder.0)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    let there = fs::read_to_string(folder.0.join("seen")).unwrap();
    assert_eq!(there, format!("{:?}", go_on(&unit)));
}

#[test]
fn a_step_can_be_rejected_and_repeated_shorter() {
    let twice = Unit::running();
    assert_eq!(twice.step(0.0, 1e-8), OK);
    let state = twice.save();
    assert_eq!(twice.step(1e-8, 4e-8), OK);
    assert_eq!(twice.restore(state), OK);
    assert_eq!(twice.time(), 1e-8);
    assert_eq!(twice.step(1e-8, 1.5e-8), OK);
    let once = Unit::running();
    assert_eq!(once.step(0.0, 1e-8), OK);
    assert_eq!(once.step(1e-8, 1.5e-8), OK);
    assert_eq!(seen(&twice), seen(&once));
}

#[test]
fn a_state_brings_its_phase_its_parameters_and_its_stop_time() {
    let unit = Unit::instantiated();
    let fresh = unit.save();
    assert_eq!(unit.set("plate.conductivity", 20.0), OK);
    assert_eq!(unit.setup(0.0, Some(2e-8)), OK);
    assert_eq!(unit.enter(), OK);
    let initializing = unit.save();
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 2e-8), OK);
    let running = unit.save();
    assert_eq!(unit.restore(fresh), OK);
    assert_eq!(unit.enter(), OK, "it is instantiated");
    assert_eq!(unit.get("plate.conductivity"), 10.0);
    assert_eq!(unit.restore(initializing), OK);
    assert_eq!(unit.get("plate.conductivity"), 20.0);
    assert_eq!(unit.exit(), OK, "it is initialising");
    assert_eq!(unit.restore(running), OK);
    unit.messages.take();
    assert_eq!(unit.step(2e-8, 1e-8), ERROR);
    unit.expect_message(ERROR, &["stop time 2e-8"]);
}

#[test]
fn saving_again_in_the_same_place_keeps_the_pointer() {
    let unit = Unit::running();
    let state = unit.save();
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let mut place = state;
    assert_eq!(unit.save_in(&mut place), OK);
    assert_eq!(place, state);
    let later = seen(&unit);
    assert_eq!(unit.step(1e-8, 1e-8), OK);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(seen(&unit), later);
}

#[test]
fn pointers_that_were_freed_or_are_of_others_are_recognised() {
    let unit = Unit::running();
    let mut freed = unit.save();
    let kept = freed;
    assert_eq!(unit.free_state(&mut freed), OK);
    assert!(freed.is_null());
    assert_eq!(unit.free_state(&mut freed), OK, "a null pointer is ignored");
    let other = Unit::running();
    let mut word = 0_u64;
    let nonsense = (&raw mut word).cast::<c_void>();
    let before = unit.snapshot();
    // A new state takes no pointer that was freed.
    unit.save();
    for pointer in [kept, other.save(), nonsense, null_mut()] {
        unit.messages.take();
        assert_eq!(unit.restore(pointer), ERROR);
        unit.expect_message(ERROR, &["fmi2SetFMUstate", "none that this instance"]);
        let mut size = 7;
        assert_eq!(unit.state_size(pointer, &mut size), ERROR);
        assert_eq!(size, 7);
        unit.expect_message(ERROR, &["fmi2SerializedFMUstateSize", "none that this instance"]);
        if !pointer.is_null() {
            let mut place = pointer;
            assert_eq!(unit.save_in(&mut place), ERROR);
            unit.expect_message(ERROR, &["fmi2GetFMUstate", "none that this instance"]);
            assert_eq!(unit.free_state(&mut place), ERROR);
            unit.expect_message(ERROR, &["fmi2FreeFMUstate", "none that this instance"]);
        }
        assert_eq!(unit.snapshot(), before);
    }
}

#[test]
fn too_little_room_for_the_bytes_is_refused_with_their_number() {
    let unit = Unit::instantiated();
    let state = unit.save();
    let whole = unit.serialize(state);
    let mut room = vec![7_u8; whole.len() - 1];
    assert_eq!(unit.serialize_in(state, &mut room), ERROR);
    unit.expect_message(ERROR, &["fmi2SerializeFMUstate", &whole.len().to_string()]);
    assert!(room.iter().all(|&byte| byte == 7));
    let mut room = vec![7_u8; whole.len() + 3];
    assert_eq!(unit.serialize_in(state, &mut room), OK);
    assert_eq!((&room[..whole.len()], &room[whole.len()..]), (&whole[..], &[7_u8; 3][..]));
}

/// Bytes are refused with one message and change nothing.
#[track_caller]
fn refused(unit: &Unit, bytes: &[u8], what: &str) -> String {
    let mut state: Saved = null_mut();
    assert_eq!(unit.deserialize_in(bytes, &mut state), ERROR, "{what}");
    assert!(state.is_null(), "{what}");
    let messages = unit.messages.take();
    assert_eq!(messages.len(), 1, "{what}: {messages:?}");
    assert!(messages[0].text.starts_with("fmi2DeSerializeFMUstate: "), "{what}: {messages:?}");
    messages[0].text.clone()
}

#[test]
fn every_damaged_byte_and_every_cut_is_noticed() {
    let unit = Unit::instantiated();
    let whole = unit.serialize(unit.save());
    for length in 0..whole.len() {
        let text = refused(&unit, &whole[..length], "cut off");
        assert!(text.contains("cut off"), "{length}: {text}");
    }
    refused(&unit, &[&whole[..], &[0]].concat(), "padded");
    for place in 0..whole.len() {
        for bit in [1, 0x80] {
            let mut bytes = whole.clone();
            bytes[place] ^= bit;
            let text = refused(&unit, &bytes, "damaged");
            let words = ["damaged", "no saved state of impinge", "format version"];
            assert!(words.iter().any(|word| text.contains(word)), "{place}: {text}");
        }
    }
    // The unit still works, and the whole state does.
    assert_eq!(unit.restore(unit.deserialize(&whole)), OK);
    assert_eq!(unit.enter(), OK);
}

#[test]
fn damage_among_the_unknowns_is_noticed_and_changes_nothing() {
    let unit = busy(1);
    let (whole, before) = (unit.serialize(unit.save()), seen(&unit));
    for place in (0..whole.len()).step_by(whole.len() / 97) {
        let mut bytes = whole.clone();
        bytes[place] ^= 0x10;
        refused(&unit, &bytes, "damaged");
        refused(&unit, &whole[..place], "cut off");
    }
    assert_eq!(seen(&unit), before);
}

#[test]
fn a_state_of_another_scene_is_refused_with_both_guids() {
    let text = SCENE.replace("spacing = 5e-5", "spacing = 1e-4");
    let other = Unit::of_scene(&text);
    let bytes = other.serialize(other.save());
    let unit = Unit::running();
    let text = refused(&unit, &bytes, "another scene");
    assert!(text.contains(&other.guid) && text.contains(&unit.guid), "{text}");
    assert_eq!(unit.step(0.0, 1e-8), OK);
}

#[test]
fn null_pointers_are_refused() {
    let unit = Unit::running();
    let state = unit.save();
    unit.messages.take();
    assert_eq!(unit.null_state_calls(state), [ERROR; 4]);
    let messages = unit.messages.take();
    assert_eq!(messages.len(), 4);
    assert!(messages.iter().all(|m| m.text.contains("null pointer")), "{messages:?}");
}

#[test]
fn fields_go_on_from_the_restored_time() {
    let folder = Folder::new("series");
    let unit = Unit::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let state = unit.save();
    assert_eq!(unit.step(1e-8, 1e-8), OK);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.step(1e-8, 3e-8), OK);
    let list = fs::read_to_string(folder.0.join("plate.pvd")).unwrap();
    let times: Vec<&str> =
        list.split("timestep=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert_eq!(times, ["0.0", "1e-8", "4e-8"]);
    // Another instance that has been set to go on in the same folder does, once the first one writes there no more.
    let bytes = unit.serialize(state);
    let other = Unit::instantiated();
    assert_eq!(other.set_directory(&folder.0), OK);
    let state = other.deserialize(&bytes);
    assert_eq!(other.restore(state), WARNING);
    assert_eq!(fs::read_to_string(folder.0.join("plate.pvd")).unwrap(), list);
    drop(unit);
    assert_eq!(other.restore(state), OK);
    assert_eq!(other.directory(), folder.0.to_str().unwrap());
    assert_eq!(other.step(1e-8, 1e-8), OK);
    let list = fs::read_to_string(folder.0.join("plate.pvd")).unwrap();
    assert_eq!(list.matches("timestep=").count(), 2, "{list}");
}

/// Bytes may come from anywhere, and must not have an instance write where it was not set to.
#[test]
fn a_state_from_bytes_names_no_folder() {
    let [folder, own] = ["elsewhere", "own"].map(Folder::new);
    let unit = Unit::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let bytes = unit.serialize(unit.save());
    let name = folder.0.to_str().unwrap().as_bytes();
    assert!(!bytes.windows(name.len()).any(|part| part == name));
    drop(unit);
    fs::remove_dir_all(&folder.0).unwrap();
    let other = Unit::instantiated();
    assert_eq!(other.restore(other.deserialize(&bytes)), OK);
    assert_eq!((other.step(1e-8, 1e-8), other.directory()), (OK, String::new()));
    assert!(!folder.0.exists());
    let third = Unit::instantiated();
    assert_eq!(third.set_directory(&own.0), OK);
    assert_eq!(third.restore(third.deserialize(&bytes)), OK);
    assert_eq!(third.step(1e-8, 1e-8), OK);
    assert!(own.0.join("plate.pvd").exists() && !folder.0.exists());
}

/// Two copies of the library in one process, as two units of different names are loaded.
#[test]
fn a_state_of_another_copy_of_the_library_is_refused() {
    use crate::master::{Callbacks, Handle};
    use libloading::Library;
    use std::ffi::{CString, c_char, c_int};
    type Instantiate = unsafe extern "C" fn(
        *const c_char,
        c_int,
        *const c_char,
        *const c_char,
        *const Callbacks,
        c_int,
        c_int,
    ) -> Handle;
    type Act = unsafe extern "C" fn(Handle, *mut Saved) -> c_int;
    type Restore = unsafe extern "C" fn(Handle, Saved) -> c_int;
    let unit = Unit::running();
    let own = unit.save();
    let folder = Folder::with_scene("copy", SCENE);
    let path = folder.0.join("libcopy.so");
    fs::copy(env::current_exe().unwrap().with_file_name("libimpinge.so"), &path).unwrap();
    let callbacks = Callbacks {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: null_mut(),
    };
    let text = |text: &str| CString::new(text).unwrap();
    let (name, guid, uri) = (text("copy"), text(&unit.guid), text(&folder.uri()));
    // SAFETY: the types are those of the header; texts and callbacks outlive the instance.
    unsafe {
        let copy = Library::new(&path).unwrap();
        let other = copy.get::<Instantiate>("fmi2Instantiate").unwrap()(
            name.as_ptr(),
            1,
            guid.as_ptr(),
            uri.as_ptr(),
            &callbacks,
            0,
            0,
        );
        assert!(!other.is_null());
        let mut states = [null_mut(); 3];
        for state in &mut states {
            assert_eq!(copy.get::<Act>("fmi2GetFMUstate").unwrap()(other, state), OK);
            assert_eq!(unit.restore(*state), ERROR);
        }
        assert_eq!(copy.get::<Restore>("fmi2SetFMUstate").unwrap()(other, own), ERROR);
        let mut foreign = own;
        assert_eq!(copy.get::<Act>("fmi2FreeFMUstate").unwrap()(other, &mut foreign), ERROR);
        copy.get::<unsafe extern "C" fn(Handle)>("fmi2FreeInstance").unwrap()(other);
    }
    assert_eq!(unit.restore(own), OK);
}

/// The folder of another writer is left alone, and the run goes on.
#[test]
fn a_folder_that_is_written_to_gets_no_fields() {
    let folder = Folder::new("busy");
    let writer = fs::File::open(&folder.0).unwrap();
    writer.try_lock().unwrap();
    let unit = Unit::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    unit.messages.take();
    assert_eq!(unit.exit(), WARNING);
    let messages = unit.messages.take();
    let says = |text: &str| text.contains("output.directory") && text.contains("another run is");
    assert!(messages.iter().any(|m| m.status == WARNING && says(&m.text)), "{messages:?}");
    assert_eq!(unit.step(0.0, 1e-8), OK);
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
}
