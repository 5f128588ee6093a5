//! Saving states, going back to them, and sending them elsewhere.

use std::process::Command;
use std::{env, fs};

use crate::master::{ERROR, Folder, OK, Two, Unit, UnitOf, Version, WARNING, both_versions};

both_versions! {
    a_state_goes_on_to_the_bit_in_the_same_instance,
    a_state_goes_on_to_the_bit_in_another_instance_and_on_other_threads,
    a_run_on_two_threads_saves_what_one_on_one_thread_does,
    a_step_can_be_rejected_and_repeated_shorter,
    a_state_brings_its_phase_its_parameters_and_its_stop_time,
    saving_again_in_the_same_place_keeps_the_pointer,
    fields_go_on_from_the_restored_time,
    a_state_from_bytes_names_no_folder,
    a_folder_that_is_written_to_gets_no_fields,
}

/// All values and the time.
type Seen = ((Vec<u64>, i32, String), u64);

pub fn seen<V: Version>(unit: &UnitOf<V>) -> Seen {
    (unit.snapshot(), unit.time().to_bits())
}

/// Steps of different lengths under inputs that change, seen after each.
fn go_on<V: Version>(unit: &UnitOf<V>) -> Vec<Seen> {
    let mut seen_after = Vec::new();
    for (i, step) in [1e-8, 3e-8, 0.5e-8].into_iter().enumerate() {
        assert_eq!(unit.put("spot.x", 1e-5 * i as f64), OK);
        assert_eq!(V::set_slope(unit, "spot.heat_flux", 1e14), OK);
        assert_eq!(unit.advance(unit.time(), step), OK, "{:?}", unit.messages.take());
        seen_after.push(seen(unit));
    }
    seen_after
}

/// A unit amid a run that has used all that belongs to a state.
pub fn busy<V: Version>(threads: i32) -> UnitOf<V> {
    let unit = UnitOf::<V>::instantiated();
    assert_eq!(unit.put("plate.conductivity", 14.0), OK);
    assert_eq!(unit.set_threads(threads), OK);
    assert_eq!([unit.begin(1e-6, Some(3e-6)), unit.exit()], [OK; 2]);
    let cells = V::family(&unit, "patch.heat_flux");
    assert_eq!(unit.set_all(&cells, &[1e7, 2e7, 3e7, 4e7, 5e7, 6e7]), OK);
    assert_eq!(unit.put("spot.y", -3e-5), OK);
    assert_eq!(V::set_slope(&unit, "spot.x", 500.0), OK);
    assert_eq!(unit.advance(1e-6, 2e-8), OK, "{:?}", unit.messages.take());
    assert_eq!(unit.put("spot.pressure", 2e6), OK);
    assert_eq!(V::set_slope(&unit, "spot.pressure", 1e13), OK);
    unit.messages.take();
    unit
}

/// A state goes on as the unit did from which it was taken, in `other` and to the bit.
fn repeats<V: Version>(saved: &[u8], wanted: &[Seen], other: &UnitOf<V>) {
    let state = other.deserialize(saved);
    assert_eq!(other.restore(state), OK, "{:?}", other.messages.take());
    assert_eq!(go_on(other), wanted);
}

fn a_state_goes_on_to_the_bit_in_the_same_instance<V: Version>() {
    let unit = busy::<V>(1);
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

fn a_state_goes_on_to_the_bit_in_another_instance_and_on_other_threads<V: Version>() {
    let unit = busy::<V>(1);
    let saved = unit.serialize(unit.save());
    let wanted = go_on(&unit);
    let reset = busy::<V>(2);
    assert_eq!(reset.reset(), OK);
    for other in [
        UnitOf::<V>::instantiated(),
        UnitOf::<V>::running(),
        UnitOf::<V>::terminated(),
        busy::<V>(2),
        reset,
    ] {
        repeats(&saved, &wanted, &other);
    }
}

fn a_run_on_two_threads_saves_what_one_on_one_thread_does<V: Version>() {
    let [one, two] = [1, 2].map(|threads| {
        let unit = busy::<V>(threads);
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

fn a_step_can_be_rejected_and_repeated_shorter<V: Version>() {
    let twice = UnitOf::<V>::running();
    assert_eq!(twice.advance(0.0, 1e-8), OK);
    let state = twice.save();
    assert_eq!(twice.advance(1e-8, 4e-8), OK);
    assert_eq!(twice.restore(state), OK);
    assert_eq!(twice.time(), 1e-8);
    assert_eq!(twice.advance(1e-8, 1.5e-8), OK);
    let once = UnitOf::<V>::running();
    assert_eq!(once.advance(0.0, 1e-8), OK);
    assert_eq!(once.advance(1e-8, 1.5e-8), OK);
    assert_eq!(seen(&twice), seen(&once));
}

fn a_state_brings_its_phase_its_parameters_and_its_stop_time<V: Version>() {
    let unit = UnitOf::<V>::instantiated();
    let fresh = unit.save();
    assert_eq!(unit.put("plate.conductivity", 20.0), OK);
    assert_eq!(unit.begin(0.0, Some(2e-8)), OK);
    let initializing = unit.save();
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.advance(0.0, 2e-8), OK);
    let running = unit.save();
    assert_eq!(unit.restore(fresh), OK);
    assert_eq!(unit.begin(0.0, None), OK, "it is instantiated");
    assert_eq!(unit.value("plate.conductivity"), 10.0);
    assert_eq!(unit.restore(initializing), OK);
    assert_eq!(unit.value("plate.conductivity"), 20.0);
    assert_eq!(unit.exit(), OK, "it is initialising");
    assert_eq!(unit.restore(running), OK);
    unit.messages.take();
    assert_eq!(unit.advance(2e-8, 1e-8), ERROR);
    unit.expect_message(ERROR, &["stop time 2e-8"]);
}

fn saving_again_in_the_same_place_keeps_the_pointer<V: Version>() {
    let unit = UnitOf::<V>::running();
    let state = unit.save();
    assert_eq!(unit.advance(0.0, 1e-8), OK);
    let mut place = state;
    assert_eq!(unit.save_in(&mut place), OK);
    assert_eq!(place, state);
    let later = seen(&unit);
    assert_eq!(unit.advance(1e-8, 1e-8), OK);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(seen(&unit), later);
}

fn fields_go_on_from_the_restored_time<V: Version>() {
    let folder = Folder::new("series");
    let unit = UnitOf::<V>::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.advance(0.0, 1e-8), OK);
    let state = unit.save();
    assert_eq!(unit.advance(1e-8, 1e-8), OK);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.advance(1e-8, 3e-8), OK);
    let list = fs::read_to_string(folder.0.join("plate.pvd")).unwrap();
    let times: Vec<&str> =
        list.split("timestep=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert_eq!(times, ["0.0", "1e-8", "4e-8"]);
    // Another instance that has been set to go on in the same folder does, once the first one writes there no more.
    let bytes = unit.serialize(state);
    let other = UnitOf::<V>::instantiated();
    assert_eq!(other.set_directory(&folder.0), OK);
    let state = other.deserialize(&bytes);
    assert_eq!(other.restore(state), WARNING);
    assert_eq!(fs::read_to_string(folder.0.join("plate.pvd")).unwrap(), list);
    drop(unit);
    assert_eq!(other.restore(state), OK);
    assert_eq!(other.directory(), folder.0.to_str().unwrap());
    assert_eq!(other.advance(1e-8, 1e-8), OK);
    let list = fs::read_to_string(folder.0.join("plate.pvd")).unwrap();
    assert_eq!(list.matches("timestep=").count(), 2, "{list}");
}

/// Bytes may come from anywhere, and must not have an instance write where it was not set to.
fn a_state_from_bytes_names_no_folder<V: Version>() {
    let [folder, own] = ["elsewhere", "own"].map(Folder::new);
    let unit = UnitOf::<V>::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.advance(0.0, 1e-8), OK);
    let bytes = unit.serialize(unit.save());
    let name = folder.0.to_str().unwrap().as_bytes();
    assert!(!bytes.windows(name.len()).any(|part| part == name));
    drop(unit);
    fs::remove_dir_all(&folder.0).unwrap();
    let other = UnitOf::<V>::instantiated();
    assert_eq!(other.restore(other.deserialize(&bytes)), OK);
    assert_eq!((other.advance(1e-8, 1e-8), other.directory()), (OK, String::new()));
    assert!(!folder.0.exists());
    let third = UnitOf::<V>::instantiated();
    assert_eq!(third.set_directory(&own.0), OK);
    assert_eq!(third.restore(third.deserialize(&bytes)), OK);
    assert_eq!(third.advance(1e-8, 1e-8), OK);
    assert!(own.0.join("plate.pvd").exists() && !folder.0.exists());
}

/// The folder of another writer is left alone, and the run goes on.
fn a_folder_that_is_written_to_gets_no_fields<V: Version>() {
    let folder = Folder::new("busy");
    let writer = fs::File::open(&folder.0).unwrap();
    writer.try_lock().unwrap();
    let unit = UnitOf::<V>::initializing();
    assert_eq!(unit.set_directory(&folder.0), OK);
    unit.messages.take();
    assert_eq!(unit.exit(), WARNING);
    let messages = unit.messages.take();
    let says = |text: &str| text.contains("output.directory") && text.contains("another run is");
    assert!(messages.iter().any(|m| m.status == WARNING && says(&m.text)), "{messages:?}");
    assert_eq!(unit.advance(0.0, 1e-8), OK);
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
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
    let unit = busy::<Two>(1);
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
