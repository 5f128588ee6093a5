//! Saved states as bytes that another instance, process or machine can go on from.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | mark `impinge\n` |
//! | 4 | version of the format |
//! | 8 | length of everything, checksum included |
//! | 38 | GUID of the unit: scene, variables and program version |
//! | … | contents: phase, parameters, experiment, time, inputs, their derivatives, unknowns |
//! | 16 | first half of the SHA-256 of everything before |
//!
//! Numbers are little-endian, counts 64 bits wide, and each body's unknowns carry their own count:
//! how many there may be is for the model to say.

use sha2::{Digest, Sha256};

use super::legality::Phase;
use super::saved::Snapshot;
use super::types::{Answer, Refusal};
use super::unit::{Experiment, Unit, explain};
use crate::model::State;
use crate::scene::Scene;
use crate::variables::{Parameter, Registry, Slot};

const MARK: &[u8; 8] = b"impinge\n";
const VERSION: u32 = 1;
const GUID_LENGTH: usize = 38;
const HEAD: usize = MARK.len() + 4 + 8 + GUID_LENGTH;
const CHECKSUM: usize = 16;

impl Unit {
    /// The bytes of a snapshot of this unit.
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

    /// The snapshot in these bytes, if they are whole and of this unit.
    pub fn deserialize(&self, bytes: &[u8]) -> Answer<Snapshot> {
        let contents = open(bytes, &self.guid).map_err(Refusal::error)?;
        let read = Reader(contents).snapshot(&self.packed, &self.registry);
        let contradicts = |message: String| {
            Refusal::error(format!("the saved state contradicts itself: {message}"))
        };
        let mut snapshot = read.map_err(contradicts)?;
        let wanted = snapshot.state.inputs.len() == self.state.inputs.len();
        if !wanted {
            let count = snapshot.state.inputs.len();
            return Err(contradicts(format!("{count} inputs, not {}", self.state.inputs.len())));
        }
        if !snapshot.state.bodies.is_empty() {
            let model = self.model_of(&snapshot.scene)?;
            model
                .check_state(&snapshot.state)
                .map_err(|error| contradicts(explain(&self.registry, error).message))?;
            snapshot.model = Some(model);
        } else if !matches!(snapshot.phase, Phase::Instantiated | Phase::InitializationMode) {
            return Err(contradicts(format!("no unknowns in {}", snapshot.phase.name())));
        }
        Ok(snapshot)
    }
}

/// The contents of bytes that are whole and of the unit with this GUID.
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

/// The parameters that are numbers, in the order of the registry.
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
    out.count(snapshot.directory.len());
    out.0.extend(snapshot.directory.as_bytes());
    out.numbers(&parameters(registry).map(|p| p.get(scene)).collect::<Vec<_>>());
    out.numbers(&[experiment.start]);
    out.numbers(experiment.stop.as_slice());
    out.numbers(&[state.time]);
    out.numbers(&state.inputs);
    out.count(usize::from(snapshot.has_set_derivatives));
    out.lists(&state.derivatives);
    out.lists(&state.bodies);
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
        let phase = *Phase::ALL.get(phase).ok_or_else(|| format!("phase {phase}"))?;
        let threads = self.count()?;
        let length = self.count()?;
        let directory = String::from_utf8(self.take(length)?.to_vec())
            .map_err(|_| "a folder that is not UTF-8".to_owned())?;
        let mut scene = packed.clone();
        scene.solver.threads = threads;
        let values = self.numbers()?;
        let expected = parameters(registry).count();
        if values.len() != expected {
            return Err(format!("{} parameters, not {expected}", values.len()));
        }
        for (parameter, value) in parameters(registry).zip(values) {
            parameter.set(&mut scene, value);
        }
        let experiment =
            Experiment { start: self.number()?, stop: self.numbers()?.first().copied() };
        let time = self.number()?;
        let inputs = self.numbers()?;
        let has_set_derivatives = self.count()? != 0;
        let (derivatives, bodies) = (self.lists()?, self.lists()?);
        if !self.0.is_empty() {
            return Err(format!("{} bytes too many", self.0.len()));
        }
        let state = State { time, inputs, derivatives, bodies };
        Ok(Snapshot {
            phase,
            scene,
            directory,
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

    fn number(&mut self) -> Result<f64, String> {
        self.numbers()?.first().copied().ok_or_else(|| "a number is missing".into())
    }

    fn lists(&mut self) -> Result<Vec<Vec<f64>>, String> {
        let count = self.count()?;
        (0..count).map(|_| self.numbers()).collect()
    }
}
