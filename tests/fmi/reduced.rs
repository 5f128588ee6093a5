//! Reductions among a unit's resources: found, to the bit what is made without them, refused where they are damaged or
//! forged, and made anew where they do not fit.

use std::ffi::{CString, c_int};
use std::fs;
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use impinge::fmi::guid;
use impinge::model::tolerance::stored_reductions;
use impinge::runtime::sealed::{Content, Format, Reader};
use impinge::scene;
use impinge::variables::Registry;

use crate::master::three::Unit as Unit3;
use crate::master::{Arguments, DISCARD, Folder, Handle, Messages, OK, Saved, call, free};

const PLATE: &str = r#"
name = "Stored"
stop_time = 1e-3
step = 1e-5
fidelity = { level = "reduced", tolerance = 1e-3 }
[body.plate]
kind = "solid"
shape = { box = [2e-3, 1.6e-3, 0.4e-3] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 300.0
mesh = { spacing = 1e-4, depth_spacing = 3e-5, growth = 1.5 }
[body.plate.faces]
bottom = { temperature = 300.0 }
sides = { clamped = true }
[[load]]
name = "spot"
on = "plate.top"
carries = ["heat_flux"]
footprint = { gaussian = { radius = 2e-4 } }
start = { heat_flux = 3e7 }
[[probe]]
name = "a"
in = "plate"
at = [5e-5, 0.0, -2e-5]
gives = ["temperature", "stress"]
"#;

const REDUCTION: Format = Format { magic: b"IMPRED01", noun: "reduction", of: "a solid" };

/// Units of one process share what they reduce, so that these tests go one after the other.
fn alone() -> MutexGuard<'static, ()> {
    static LOCK: Mutex<()> = Mutex::new(());
    LOCK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An instance, whose resources hold a reduction or none.
struct Unit {
    handle: Handle,
    messages: Box<Messages>,
    registry: Registry,
    _folder: Folder,
}

impl Drop for Unit {
    fn drop(&mut self) {
        free(self.handle);
    }
}

fn folder(bytes: Option<&[u8]>) -> Folder {
    let folder = Folder::with_scene("reduced", PLATE);
    if let Some(bytes) = bytes {
        let reduced = folder.0.join("reduced");
        fs::create_dir(&reduced).unwrap();
        fs::write(reduced.join("plate.reduced"), bytes).unwrap();
    }
    folder
}

fn registry() -> Registry {
    Registry::of(&scene::parse(PLATE, "scene.toml").unwrap())
}

/// A unit with these bytes, or what is said when it is refused.
fn unit(bytes: Option<&[u8]>) -> Result<Unit, String> {
    let (folder, registry) = (folder(bytes), registry());
    let messages = Box::<Messages>::default();
    let guid = Some(CString::new(guid::guid(PLATE, &registry)).unwrap());
    let handle = Arguments { guid, ..Arguments::good(&folder) }.instantiate(&messages);
    match handle.is_null() {
        true => Err(messages.take().into_iter().map(|message| message.text).collect()),
        false => Ok(Unit { handle, messages, registry, _folder: folder }),
    }
}

impl Unit {
    fn reference(&self, name: &str) -> u32 {
        self.registry.find(name).unwrap() as u32
    }

    fn start(&self, conductivity: Option<f64>) -> c_int {
        let setup = call!("fmi2SetupExperiment", self.handle => Handle, 0 => c_int, 0.0 => f64,
            0.0 => f64, 0 => c_int, 0.0 => f64);
        assert_eq!(setup, OK);
        if let Some(value) = conductivity {
            assert_eq!(self.set("plate.conductivity", value), OK);
        }
        assert_eq!(call!("fmi2EnterInitializationMode", self.handle => Handle), OK);
        call!("fmi2ExitInitializationMode", self.handle => Handle)
    }

    fn said(&self) -> String {
        self.messages.take().into_iter().map(|message| message.text + "\n").collect()
    }

    fn set(&self, name: &str, value: f64) -> c_int {
        let reference = self.reference(name);
        call!("fmi2SetReal", self.handle => Handle, &raw const reference => *const u32,
            1 => usize, &raw const value => *const f64)
    }

    fn step(&self, n: u32) {
        let point = 1e-5 * f64::from(n);
        let status =
            call!("fmi2DoStep", self.handle => Handle, point => f64, 1e-5 => f64, 1 => c_int);
        assert_eq!(status, OK, "{}", self.said());
    }

    /// Bits of all values that follow from the state.
    fn outputs(&self) -> Vec<u64> {
        OUTPUTS.iter().map(|name| self.get(name).to_bits()).collect()
    }

    fn get(&self, name: &str) -> f64 {
        let (reference, mut value) = (self.reference(name), f64::NAN);
        let status = call!("fmi2GetReal", self.handle => Handle, &raw const reference => *const u32,
            1 => usize, &raw mut value => *mut f64);
        assert_eq!(status, OK);
        value
    }

    fn save(&self) -> Vec<u8> {
        let (mut state, mut size): (Saved, usize) = (ptr::null_mut(), 0);
        assert_eq!(
            call!("fmi2GetFMUstate", self.handle => Handle, &raw mut state => *mut Saved),
            OK
        );
        let status = call!("fmi2SerializedFMUstateSize", self.handle => Handle, state => Saved,
            &raw mut size => *mut usize);
        assert_eq!(status, OK);
        let mut bytes = vec![0u8; size];
        let status = call!("fmi2SerializeFMUstate", self.handle => Handle, state => Saved,
            bytes.as_mut_ptr() => *mut u8, size => usize);
        assert_eq!(status, OK);
        assert_eq!(
            call!("fmi2FreeFMUstate", self.handle => Handle, &raw mut state => *mut Saved),
            OK
        );
        bytes
    }

    fn restore(&self, bytes: &[u8]) {
        let mut state: Saved = ptr::null_mut();
        let status = call!("fmi2DeSerializeFMUstate", self.handle => Handle, bytes.as_ptr() => *const u8,
            bytes.len() => usize, &raw mut state => *mut Saved);
        assert_eq!(status, OK, "{}", self.said());
        assert_eq!(call!("fmi2SetFMUstate", self.handle => Handle, state => Saved), OK);
        assert_eq!(
            call!("fmi2FreeFMUstate", self.handle => Handle, &raw mut state => *mut Saved),
            OK
        );
    }
}

const OUTPUTS: [&str; 6] = [
    "a.temperature",
    "a.stress_xx",
    "a.von_mises",
    "plate.heat_stored",
    "plate.error_bound_temperature",
    "plate.error_bound_stress",
];

fn stored() -> Vec<u8> {
    let scene = scene::parse(PLATE, "scene.toml").unwrap();
    let [(name, bytes)] = <[_; 1]>::try_from(stored_reductions(&scene).unwrap()).unwrap();
    assert_eq!(name, "plate");
    bytes
}

/// Steps under a flux that changes.
fn run(unit: &Unit, steps: std::ops::Range<u32>) -> Vec<Vec<u64>> {
    let step = |n: u32| {
        assert_eq!(unit.set("spot.heat_flux", 1e7 * f64::from(n % 5)), OK);
        unit.step(n);
        unit.outputs()
    };
    steps.map(step).collect()
}

#[test]
fn with_and_without_its_reduction_a_unit_is_the_same_to_the_bit() {
    let _alone = alone();
    // One after the other: what one unit made another would find.
    let made = {
        let unit = unit(None).unwrap();
        assert_eq!(unit.start(None), OK);
        run(&unit, 0..20)
    };
    let bytes = stored();
    let unit = unit(Some(&bytes)).unwrap();
    assert_eq!(unit.start(None), OK);
    let said = unit.said();
    assert!(said.contains("unknowns") && !said.contains("reduced anew"), "{said}");
    assert_eq!(run(&unit, 0..10), made[..10]);
    let saved = unit.save();
    assert_eq!(run(&unit, 10..20), made[10..]);
    unit.restore(&saved);
    assert_eq!(run(&unit, 10..20), made[10..]);
    // By FMI 3.0, from the state that FMI 2.0 saved.
    drop(unit);
    let folder = folder(Some(&bytes));
    let place = format!("{}/", folder.0.display());
    let three = Unit3::instantiated_with(PLATE, |arguments| {
        arguments.resources = Some(CString::new(place.as_str()).unwrap());
    });
    assert_eq!((three.enter(0.0, None), three.exit()), (OK, OK));
    let outputs =
        || -> Vec<u64> { OUTPUTS.iter().map(|name| three.get(name)[0].to_bits()).collect() };
    for n in 0..20 {
        if n == 10 {
            let state = three.deserialize(&saved);
            assert_eq!(three.restore(state), OK);
        }
        assert_eq!(three.set("spot.heat_flux", &[1e7 * f64::from(n % 5)]), OK);
        assert_eq!(three.step(1e-5 * f64::from(n), 1e-5).0, OK);
        assert_eq!(outputs(), made[n as usize], "step {n}");
    }
}

#[test]
fn other_parameters_make_a_reduction_of_their_own() {
    let _alone = alone();
    let bytes = stored();
    let unit = unit(Some(&bytes)).unwrap();
    assert_eq!(unit.start(Some(12.0)), OK);
    let said = unit.said();
    assert!(
        said.contains("plate: reduced anew, as the reduction that the unit has stored"),
        "{said}"
    );
    let own = run(&unit, 0..5);
    drop(unit);
    let without = self::unit(None).unwrap();
    assert_eq!(without.start(Some(12.0)), OK);
    assert!(!without.said().contains("reduced anew"));
    assert_eq!(run(&without, 0..5), own);
    // Back at the packed parameters it is the stored one again.
    assert_eq!(call!("fmi2Reset", without.handle => Handle), OK);
    assert_eq!(without.start(None), OK);
    assert_ne!(run(&without, 0..5), own);
}

#[test]
fn damaged_reductions_are_refused() {
    let _alone = alone();
    let bytes = stored();
    assert!(unit(Some(&bytes)).is_ok());
    for place in [0, bytes.len() / 2, bytes.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[place] ^= 1;
        let said = unit(Some(&damaged)).err().unwrap();
        assert!(said.contains("plate.reduced: "), "{said}");
    }
    let said = unit(Some(&bytes[..bytes.len() - 9])).err().unwrap();
    assert!(said.contains("plate.reduced: the reduction is"), "{said}");
    let said = unit(Some(b"IMPREC02")).err().unwrap();
    assert!(said.contains("plate.reduced: "), "{said}");
}

/// Whole numbers and numbers behind them, as they follow in a reduction.
fn words(reader: &mut Reader) -> Option<([usize; 4], Vec<f64>)> {
    let [modes, inputs, outputs, order] =
        [reader.whole()?, reader.whole()?, reader.whole()?, reader.whole()?];
    let matrices = order * (2 + inputs + outputs) + 3 * inputs * outputs;
    let rest = reader.numbers(matrices + 2 * outputs + inputs)?;
    Some(([modes, inputs, outputs, order], rest))
}

fn sealed(key: &str, counts: [usize; 4], numbers: &[f64]) -> Vec<u8> {
    let mut content = Content::default();
    counts.into_iter().for_each(|count| content.count(count));
    content.numbers(numbers.iter().copied());
    REDUCTION.seal(key, &content)
}

#[test]
fn forged_reductions_with_a_good_checksum_are_refused() {
    let _alone = alone();
    let bytes = stored();
    let (key, (counts, numbers)) = REDUCTION.open(&bytes, words).unwrap();
    assert_eq!(sealed(&key, counts, &numbers), bytes);
    let edits: [(&str, usize, f64); 3] = [
        ("-1 as a rate of decay", 1, -1.0),
        ("NaN is no finite number", 5, f64::NAN),
        ("inf is no finite number", numbers.len() - 1, f64::INFINITY),
    ];
    for (words, place, value) in edits {
        let mut forged = numbers.clone();
        forged[place] = value;
        let said = unit(Some(&sealed(&key, counts, &forged))).err().unwrap();
        assert!(said.contains(words), "{said}");
    }
    // Matrices of other sizes than this unit's, whole in themselves.
    let [modes, _, _, _] = counts;
    let small = sealed(&key, [modes, 1, 1, 1], &[1.0, 0.0, 1.0, 1.0, 0.0, 0.1, 1.0, 0.0, 0.1, 1.0]);
    let unit = unit(Some(&small)).unwrap();
    assert_eq!(unit.start(None), DISCARD);
    let said = unit.said();
    assert!(said.contains("stored reduction of plate is of 1 inputs and 1 outputs"), "{said}");
}
