//! Saved states as bytes that another instance, process or machine can go on from.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | mark `impinge\n` |
//! | 4 | version of the format |
//! | 8 | length of everything, checksum included |
//! | 38 | GUID of the unit: scene, variables and program version |
//! | … | contents: phase, parameters, experiment, time, inputs, their derivatives, unknowns, running maxima |
//! | 16 | first half of the SHA-256 of everything before |
//!
//! Folder names are excluded, because bytes may come from anywhere: fields are written to the folder of the instance
//! that continues. Numbers are little-endian, counts 64 bits wide, and each body's unknowns carry their own count. The
//! model checks these counts.

use sha2::{Digest, Sha256};

use super::built::expect_room;
use super::saved::Snapshot;
use super::{Experiment, Unit};
use crate::fmi::gate::answer::{Answer, Refusal};
use crate::fmi::table::Phase;
use crate::model::{Peak, State};
use crate::scene::{MOST_THREADS, Scene};
use crate::variables::{Parameter, Registry, Slot};

const MARK: &[u8; 8] = b"impinge\n";
/// Version of the format, to be raised whenever the states of bodies change. Earlier versions are refused: version 3
/// included a folder name.
const VERSION: u32 = 5;
const GUID_LENGTH: usize = 38;
const HEAD: usize = MARK.len() + 4 + 8 + GUID_LENGTH;
const CHECKSUM: usize = 16;

impl Unit {
    /// Returns the bytes of a snapshot of this unit.
    pub fn serialize(&self, snapshot: &Snapshot) -> Vec<u8> {
        let mut contents = Writer::default();
        write_snapshot(&mut contents, snapshot, &self.registry);
        let length = HEAD + contents.0.len() + CHECKSUM;
        let mut bytes = Vec::with_capacity(length);
        bytes.extend(MARK);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((length as u64).to_le_bytes());
        bytes.extend(self.guid.as_bytes());
        bytes.extend(contents.0);
        bytes.extend(checksum(&bytes));
        bytes
    }

    /// Reads the snapshot from bytes that are complete and belong to this unit.
    pub fn deserialize(&self, bytes: &[u8]) -> Answer<Snapshot> {
        let contents = open(bytes, &self.guid).map_err(Refusal::error)?;
        let read = Reader(contents).snapshot(&self.packed, &self.registry);
        let contradicts = |message: String| {
            Refusal::error(format!("the saved state contradicts itself: {message}"))
        };
        let mut snapshot = read.map_err(contradicts)?;
        if let Some(message) = out_of_bounds(&self.registry, &snapshot.state.inputs) {
            return Err(contradicts(message));
        }
        // After a panic, too, there may be no model.
        let early = matches!(
            snapshot.phase,
            Phase::Instantiated | Phase::InitializationMode | Phase::Error
        );
        if early && snapshot.state.bodies.is_empty() {
            // There may be no model yet, nor valid parameters.
            let (inputs, count) = (&snapshot.state.inputs, self.state.inputs.len());
            let mut lists = std::iter::once(inputs).chain(&snapshot.state.derivatives);
            return match lists.find(|list| list.len() != count) {
                None if !snapshot.state.peaks.is_empty() => {
                    Err(contradicts("running maxima of no bodies".into()))
                }
                None => Ok(snapshot),
                Some(list) => Err(contradicts(format!("{} inputs, not {count}", list.len()))),
            };
        }
        let model = self.model_of(&snapshot.scene)?;
        expect_room(model.room(&snapshot.state))?;
        model.check_state(&snapshot.state).map_err(|error| contradicts(error.to_string()))?;
        snapshot.model = Some(model);
        Ok(snapshot)
    }
}

/// Returns why an input is out of bounds.
fn out_of_bounds(registry: &Registry, inputs: &[f64]) -> Option<String> {
    registry.variables.iter().find_map(|variable| match variable.slot {
        Slot::Input(index) => variable.refusal(*inputs.get(index)?),
        _ => None,
    })
}

/// Returns the contents of bytes that are complete and belong to the unit with this GUID.
fn open<'a>(bytes: &'a [u8], guid: &str) -> Result<&'a [u8], String> {
    let size = bytes.len();
    if size < HEAD + CHECKSUM {
        return Err(format!("{size} bytes are too few for a saved state: it was cut off"));
    }
    let (before, sum) = bytes.split_at(size - CHECKSUM);
    let (mark, rest) = before.split_at(MARK.len());
    let (version, rest) = rest.split_at(4);
    let (length, rest) = rest.split_at(8);
    let (found, contents) = rest.split_at(GUID_LENGTH);
    if mark != MARK {
        return Err("these bytes are no saved state of impinge".into());
    }
    let version = version.iter().rev().fold(0, |sum, &byte| sum << 8 | u32::from(byte));
    if version != VERSION {
        return Err(format!(
            "the saved state has format version {version}; this program reads {VERSION}"
        ));
    }
    let length = length.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte));
    if length != size as u64 {
        return Err(format!(
            "the saved state says that it has {length} bytes, but {size} were given: it was cut \
             off, padded or damaged"
        ));
    }
    if checksum(before) != sum {
        return Err("the saved state is damaged: its checksum is wrong".into());
    }
    if found != guid.as_bytes() {
        return Err(format!(
            "the saved state is of the unit with GUID {}, not of {guid}",
            String::from_utf8_lossy(found)
        ));
    }
    Ok(contents)
}

fn checksum(bytes: &[u8]) -> [u8; CHECKSUM] {
    let hash = Sha256::digest(bytes);
    std::array::from_fn(|i| hash[i])
}

/// Returns the parameters that are numbers, in the order of the registry.
fn parameters(registry: &Registry) -> impl Iterator<Item = &Parameter> {
    registry.variables.iter().filter_map(|variable| match &variable.slot {
        Slot::Parameter(parameter) => Some(parameter),
        _ => None,
    })
}

fn write_snapshot(out: &mut Writer, snapshot: &Snapshot, registry: &Registry) {
    let Snapshot { scene, state, experiment, .. } = snapshot;
    out.count(snapshot.phase as usize);
    out.count(scene.solver.threads);
    out.numbers(&parameters(registry).map(|p| p.get(scene)).collect::<Vec<_>>());
    out.numbers(&[experiment.start]);
    out.numbers(experiment.stop.as_slice());
    out.numbers(&[state.time]);
    out.numbers(&state.inputs);
    out.count(usize::from(snapshot.has_set_derivatives));
    out.lists(&state.derivatives);
    out.lists(&state.bodies);
    out.numbers(state.peaks.iter().map(Peak::numbers).collect::<Vec<_>>().as_flattened());
}

/// Refuses times that no run can have.
fn check_times(Experiment { start, stop }: Experiment, time: f64) -> Result<(), String> {
    let numbers = [start, time, stop.unwrap_or(start)];
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err("a time that is not finite".to_owned());
    }
    if time < start || stop.is_some_and(|stop| stop <= start) {
        return Err(format!("{time} s in an experiment from {start} to {stop:?} s"));
    }
    Ok(())
}

#[derive(Default)]
struct Writer(Vec<u8>);

impl Writer {
    fn count(&mut self, value: usize) {
        self.0.extend((value as u64).to_le_bytes());
    }

    fn numbers(&mut self, values: &[f64]) {
        self.count(values.len());
        self.0.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }

    fn lists(&mut self, lists: &[Vec<f64>]) {
        self.count(lists.len());
        lists.iter().for_each(|list| self.numbers(list));
    }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn snapshot(mut self, packed: &Scene, registry: &Registry) -> Result<Snapshot, String> {
        let phase = self.count()?;
        // States can be saved only in these phases, so no other can be restored.
        let known = Phase::ALL.get(phase).filter(|phase| phase.lasts());
        let phase = *known.ok_or_else(|| format!("phase {phase}, in which nothing is saved"))?;
        let threads = self.count()?;
        if threads > MOST_THREADS {
            return Err(format!("{threads} threads, of at most {MOST_THREADS}"));
        }
        let mut scene = packed.clone();
        scene.solver.threads = threads;
        let values = self.numbers()?;
        let expected = parameters(registry).count();
        if values.len() != expected {
            return Err(format!("{} parameters, not {expected}", values.len()));
        }
        for (parameter, value) in parameters(registry).zip(values) {
            if !value.is_finite() {
                return Err(format!("a parameter that is not finite: {value}"));
            }
            parameter.set(&mut scene, value);
        }
        if scene != *packed {
            scene.forget_estimates();
        }
        let experiment =
            Experiment { start: self.number()?, stop: self.numbers()?.first().copied() };
        let time = self.number()?;
        check_times(experiment, time)?;
        let inputs = self.numbers()?;
        let has_set_derivatives = match self.count()? {
            0 => false,
            1 => true,
            other => return Err(format!("{other}, where yes or no is asked")),
        };
        let (derivatives, bodies) = (self.lists()?, self.lists()?);
        let peaks = self.peaks()?;
        if let Some(peak) = peaks.iter().find(|peak| peak.time < experiment.start) {
            let (time, start) = (peak.time, experiment.start);
            return Err(format!("a running maximum at {time} s, before the start at {start} s"));
        }
        if !self.0.is_empty() {
            return Err(format!("{} bytes too many", self.0.len()));
        }
        let state = State { time, inputs, derivatives, bodies, peaks };
        Ok(Snapshot {
            phase,
            scene,
            directory: None,
            experiment,
            state,
            has_set_derivatives,
            model: None,
        })
    }

    fn take(&mut self, count: usize) -> Result<&[u8], String> {
        let split = self.0.split_at_checked(count);
        let (taken, rest) = split.ok_or("its contents end too early")?;
        self.0 = rest;
        Ok(taken)
    }

    fn count(&mut self) -> Result<usize, String> {
        let value = self.take(8)?.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte));
        usize::try_from(value).map_err(|_| format!("a count of {value}"))
    }

    fn numbers(&mut self) -> Result<Vec<f64>, String> {
        let count = self.count()?;
        let bytes = self.take(count.checked_mul(8).ok_or("its contents end too early")?)?;
        let (values, _) = bytes.as_chunks::<8>();
        Ok(values.iter().map(|value| f64::from_le_bytes(*value)).collect())
    }

    fn peaks(&mut self) -> Result<Vec<Peak>, String> {
        let numbers = self.numbers()?;
        let (peaks, []) = numbers.as_chunks() else {
            return Err(format!("{} numbers of running maxima, which have five", numbers.len()));
        };
        Ok(peaks.iter().copied().map(Peak::of_numbers).collect())
    }

    fn number(&mut self) -> Result<f64, String> {
        self.numbers()?.first().copied().ok_or_else(|| "a number is missing".into())
    }

    fn lists(&mut self) -> Result<Vec<Vec<f64>>, String> {
        let count = self.count()?;
        (0..count).map(|_| self.numbers()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::gate::answer::Status;

    /// Returns a running unit with a snapshot of it.
    fn running() -> (Unit, Snapshot) {
        let mut unit = Unit::for_tests();
        unit.finish_initialization().unwrap();
        let place = unit.save(std::ptr::null_mut()).unwrap();
        let snapshot = unit.saved.get(place).unwrap().clone();
        (unit, snapshot)
    }

    /// Complete bytes of this unit with invalid contents are refused with these words.
    #[track_caller]
    fn refused(change: impl FnOnce(&mut Snapshot), words: &str) {
        let (unit, mut snapshot) = running();
        change(&mut snapshot);
        let Err(refusal) = unit.deserialize(&unit.serialize(&snapshot)) else {
            panic!("taken: {words}")
        };
        assert_eq!(refusal.status, Status::Error);
        assert!(refusal.message.contains(words), "{}", refusal.message);
    }

    #[test]
    fn model_checks_the_number_of_unknowns() {
        refused(|s| s.state.bodies[0].truncate(9), "unknowns of plate");
        refused(|s| s.state.bodies[0].push(0.0), "unknowns of plate");
        refused(|s| s.state.bodies.push(Vec::new()), "unknowns of 2 bodies; the scene has 1");
        refused(|s| s.state.bodies.clear(), "unknowns of 0 bodies");
    }

    #[test]
    fn contents_that_contradict_the_scene_are_refused() {
        refused(|s| s.state.inputs.truncate(1), "inputs; the scene has");
        refused(|s| s.state.derivatives.push(vec![0.0]), "values of 1 inputs");
        refused(|s| s.state.derivatives = vec![s.state.inputs.clone(); 3], "up to order 3");
        refused(|s| s.state.bodies[0][3] = f64::NAN, "not finite");
        refused(|s| s.state.time = f64::INFINITY, "not finite");
        let nonsense = |s: &mut Snapshot| {
            let parameters: Vec<Parameter> = parameters(&Registry::of(&s.scene)).cloned().collect();
            parameters[0].set(&mut s.scene, -1.0);
        };
        refused(nonsense, "density");
        let early = |s: &mut Snapshot| {
            (s.phase, s.state.bodies) = (Phase::Instantiated, Vec::new());
            s.state.inputs.pop();
        };
        refused(early, "contradicts itself");
    }

    #[test]
    fn another_version_of_the_format_is_refused_with_both() {
        let (unit, snapshot) = running();
        let mut bytes = unit.serialize(&snapshot);
        bytes[MARK.len()] = 3;
        let end = bytes.len() - CHECKSUM;
        let sum = checksum(&bytes[..end]);
        bytes[end..].copy_from_slice(&sum);
        let refusal = unit.deserialize(&bytes).err().unwrap();
        assert!(refusal.message.contains("version 3; this program reads 5"), "{}", refusal.message);
    }
}
