//! Saved states that a master must not get: damaged ones, those of others, those that were freed.

use std::ffi::c_void;
use std::ptr::null_mut;
use std::{env, fs};

use crate::master::{ERROR, Folder, OK, SCENE, Saved, Unit, UnitOf, Version, both_versions};
use crate::states::{busy, seen};

both_versions! {
    pointers_that_were_freed_or_are_of_others_are_recognised,
    too_little_room_for_the_bytes_is_refused_with_their_number,
    every_damaged_byte_and_every_cut_is_noticed,
    damage_among_the_unknowns_is_noticed_and_changes_nothing,
    a_state_of_another_scene_is_refused_with_both_guids,
    states_of_solved_pressure_are_read_back,
    null_pointers_are_refused,
}

fn pointers_that_were_freed_or_are_of_others_are_recognised<V: Version>() {
    let unit = UnitOf::<V>::running();
    let mut freed = unit.save();
    let kept = freed;
    assert_eq!(unit.free_state(&mut freed), OK);
    assert!(freed.is_null());
    assert_eq!(unit.free_state(&mut freed), OK, "a null pointer is ignored");
    let other = UnitOf::<V>::running();
    let mut word = 0_u64;
    let nonsense = (&raw mut word).cast::<c_void>();
    let before = unit.snapshot();
    // A new state takes no pointer that was freed.
    unit.save();
    for pointer in [kept, other.save(), nonsense, null_mut()] {
        unit.messages.take();
        assert_eq!(unit.restore(pointer), ERROR);
        unit.expect_message(ERROR, &[&V::name("SetFMUState"), "none that this instance"]);
        let mut size = 7;
        assert_eq!(unit.state_size(pointer, &mut size), ERROR);
        assert_eq!(size, 7);
        unit.expect_message(
            ERROR,
            &[&V::name("SerializedFMUStateSize"), "none that this instance"],
        );
        if !pointer.is_null() {
            let mut place = pointer;
            assert_eq!(unit.save_in(&mut place), ERROR);
            unit.expect_message(ERROR, &[&V::name("GetFMUState"), "none that this instance"]);
            assert_eq!(unit.free_state(&mut place), ERROR);
            unit.expect_message(ERROR, &[&V::name("FreeFMUState"), "none that this instance"]);
        }
        assert_eq!(unit.snapshot(), before);
    }
}

fn too_little_room_for_the_bytes_is_refused_with_their_number<V: Version>() {
    let unit = UnitOf::<V>::instantiated();
    let state = unit.save();
    let whole = unit.serialize(state);
    let mut room = vec![7_u8; whole.len() - 1];
    assert_eq!(unit.serialize_in(state, &mut room), ERROR);
    unit.expect_message(ERROR, &[&V::name("SerializeFMUState"), &whole.len().to_string()]);
    assert!(room.iter().all(|&byte| byte == 7));
    let mut room = vec![7_u8; whole.len() + 3];
    assert_eq!(unit.serialize_in(state, &mut room), OK);
    assert_eq!((&room[..whole.len()], &room[whole.len()..]), (&whole[..], &[7_u8; 3][..]));
}

/// Bytes are refused with one message and change nothing.
#[track_caller]
fn refused<V: Version>(unit: &UnitOf<V>, bytes: &[u8], what: &str) -> String {
    let mut state: Saved = null_mut();
    assert_eq!(unit.deserialize_in(bytes, &mut state), ERROR, "{what}");
    assert!(state.is_null(), "{what}");
    let messages = unit.messages.take();
    assert_eq!(messages.len(), 1, "{what}: {messages:?}");
    assert!(
        messages[0].text.starts_with(&format!("{}: ", V::name("DeserializeFMUState"))),
        "{what}: {messages:?}"
    );
    messages[0].text.clone()
}

fn every_damaged_byte_and_every_cut_is_noticed<V: Version>() {
    let unit = UnitOf::<V>::instantiated();
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
    assert_eq!(unit.begin(0.0, None), OK);
}

fn damage_among_the_unknowns_is_noticed_and_changes_nothing<V: Version>() {
    let unit = busy::<V>(1);
    let (whole, before) = (unit.serialize(unit.save()), seen(&unit));
    for place in (0..whole.len()).step_by(whole.len() / 97) {
        let mut bytes = whole.clone();
        bytes[place] ^= 0x10;
        refused(&unit, &bytes, "damaged");
        refused(&unit, &whole[..place], "cut off");
    }
    assert_eq!(seen(&unit), before);
}

fn a_state_of_another_scene_is_refused_with_both_guids<V: Version>() {
    let text = SCENE.replace("spacing = 5e-5", "spacing = 1e-4");
    let other = UnitOf::<V>::of_scene(&text);
    let bytes = other.serialize(other.save());
    let unit = UnitOf::<V>::running();
    let text = refused(&unit, &bytes, "another scene");
    assert!(text.contains(&other.guid) && text.contains(&unit.guid), "{text}");
    assert_eq!(unit.advance(0.0, 1e-8), OK);
}

/// A drop whose pressure is solved has no speed of sound that could be set.
const HONEY: &str = r#"name = "Honey"
stop_time = 1e-2
step = 1e-3
[body.honey]
kind = "droplet"
diameter = 1e-2
impact_velocity = 0.01
initial_temperature = 300.0
spacing = 1.5e-3
pressure = "implicit"
fluid = { density = 1400.0, viscosity = 10.0, specific_heat = 2000.0, conductivity = 0.3 }
"#;

fn states_of_solved_pressure_are_read_back<V: Version>() {
    let unit = UnitOf::<V>::of_scene(HONEY);
    assert_eq!([unit.begin(0.0, None), unit.exit()], [OK; 2]);
    let (bytes, before) = (unit.serialize(unit.save()), seen(&unit));
    assert_eq!(unit.advance(0.0, 1e-3), OK);
    assert_eq!(unit.restore(unit.deserialize(&bytes)), OK, "{:?}", unit.messages.take());
    assert_eq!(seen(&unit), before);
}

fn null_pointers_are_refused<V: Version>() {
    let unit = UnitOf::<V>::running();
    let state = unit.save();
    unit.messages.take();
    assert_eq!(unit.null_state_calls(state), [ERROR; 4]);
    let messages = unit.messages.take();
    assert_eq!(messages.len(), 4);
    assert!(messages.iter().all(|m| m.text.contains("null pointer")), "{messages:?}");
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
