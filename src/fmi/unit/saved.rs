//! States saved by a master: their contents and their life.

use std::collections::BTreeMap;
use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::process;
use std::ptr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::SystemTime;

use super::built::{Run, expect_room};
use super::{Experiment, Unit};
use crate::fmi::gate::answer::{Answer, Refusal, SavedState, Status};
use crate::fmi::table::Phase;
use crate::model::{Model, State};
use crate::scene::Scene;

/// All data for a bitwise identical continuation of a run (FMI 2.0.4, section 2.1.8): time, unknowns, inputs and their
/// derivatives, parameters, start and stop time, and the phase.
///
/// Data without effect on results are excluded. Name, callbacks and log settings belong to the instance, results
/// derived from the state are recomputed, and field files stay in place. Their series continues from the restored time,
/// and replaces what was written after that time.
#[derive(Clone)]
pub struct Snapshot {
    pub phase: Phase,
    /// The scene with its parameters.
    pub scene: Scene,
    /// Folder of the fields; `None` for states from bytes, which keep the instance's own.
    pub directory: Option<String>,
    pub experiment: Experiment,
    pub state: State,
    pub has_set_derivatives: bool,
    /// Set once the unit had a model; then the state holds matching unknowns.
    pub model: Option<Arc<Model>>,
}

/// Snapshots of one instance that its master has not freed, by their pointers.
///
/// Such a pointer is a number that this copy of the library never reuses in this process, and it is never dereferenced.
/// Other copies, loaded with other units, begin at other places among 2⁶² numbers. Pointers that were freed, came from
/// another instance or were never issued are therefore recognised.
#[derive(Default)]
pub struct SavedStates(BTreeMap<usize, Snapshot>);

/// Number of pointers issued after the first one.
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// The first issued number, or zero until it is known.
static FIRST: AtomicUsize = AtomicUsize::new(0);

/// The first issued number, odd so that none is null or the address of an aligned value.
///
/// It is a hash of the address of this copy of the library, of the process and of the time of the first call, with keys
/// drawn by the system.
fn first() -> usize {
    let known = FIRST.load(Ordering::Relaxed);
    if known != 0 {
        return known;
    }
    let place = (&raw const COUNT).addr();
    let of = (place, process::id(), SystemTime::now());
    let drawn = RandomState::new().hash_one(of) as usize | 1;
    // Among several threads, one draws for all.
    let set = FIRST.compare_exchange(0, drawn, Ordering::Relaxed, Ordering::Relaxed);
    set.map_or_else(|earlier| earlier, |_| drawn)
}

impl SavedStates {
    /// Keeps a snapshot under a new pointer.
    pub fn insert(&mut self, snapshot: Snapshot) -> SavedState {
        let number = first().wrapping_add(2 * COUNT.fetch_add(1, Ordering::Relaxed));
        self.0.insert(number, snapshot);
        ptr::without_provenance_mut(number)
    }

    /// The snapshot of a pointer.
    pub fn get(&self, pointer: SavedState) -> Answer<&Snapshot> {
        self.0.get(&pointer.addr()).ok_or_else(|| unknown(pointer))
    }

    /// Replaces the snapshot of a pointer.
    pub fn replace(&mut self, pointer: SavedState, snapshot: Snapshot) -> Answer<()> {
        *self.0.get_mut(&pointer.addr()).ok_or_else(|| unknown(pointer))? = snapshot;
        Ok(())
    }

    /// Removes the snapshot of a pointer.
    pub fn remove(&mut self, pointer: SavedState) -> Answer<()> {
        self.0.remove(&pointer.addr()).map(drop).ok_or_else(|| unknown(pointer))
    }
}

fn unknown(pointer: SavedState) -> Refusal {
    Refusal::error(format!(
        "FMUstate {pointer:?} is none that this instance has given out and not freed"
    ))
}

impl Unit {
    /// Saves the present state; a null pointer requests a new place, any other pointer is reused.
    pub fn save(&mut self, place: SavedState) -> Answer<SavedState> {
        self.expect_room()?;
        let snapshot = Snapshot {
            phase: self.phase,
            scene: self.scene.clone(),
            directory: Some(self.directory.clone()),
            experiment: self.experiment,
            state: self.state.clone(),
            has_set_derivatives: self.has_set_derivatives,
            model: self.run.as_ref().map(|run| Arc::clone(&run.model)),
        };
        if place.is_null() {
            return Ok(self.saved.insert(snapshot));
        }
        self.saved.replace(place, snapshot).map(|()| place)
    }

    /// Restores a saved state, which stays saved.
    pub fn restore(&mut self, place: SavedState) -> Answer {
        let snapshot = self.saved.get(place)?;
        if let Some(model) = &snapshot.model {
            expect_room(model.room(&snapshot.state))?;
        }
        let snapshot = snapshot.clone();
        let directory = snapshot.directory.unwrap_or_else(|| self.directory.clone());
        let same_files = directory == self.directory;
        // Instances that do not use Event Mode continue in steps.
        self.phase = match snapshot.phase {
            Phase::EventMode if !self.control.reports_events => Phase::StepComplete,
            phase => phase,
        };
        self.scene = snapshot.scene;
        self.directory = directory;
        self.experiment = snapshot.experiment;
        self.forget_answers();
        self.state = snapshot.state;
        self.has_set_derivatives = snapshot.has_set_derivatives;
        self.texts.clear();
        self.run = snapshot.model.map(Run::new);
        if !self.phase.is_running() {
            // A run that begins writes its files anew.
            let begins = matches!(self.phase, Phase::Instantiated | Phase::InitializationMode);
            match &mut self.series {
                Some(series) if same_files && !begins => series.release(),
                series => *series = None,
            }
            return Ok(Status::Ok);
        }
        match &mut self.series {
            Some(series) if same_files => {
                let gone_back = series.go_back(self.state.time);
                if let Err(error) = gone_back {
                    return Ok(self.warn_of_output(&error));
                }
            }
            _ => {
                self.series = None;
                return Ok(self.open_series());
            }
        }
        Ok(Status::Ok)
    }
}
