//! States that a master has saved: what belongs to one, and which of them live.

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

/// All that a run needs to go on to the bit (FMI 2.0.4, section 2.1.8): time, unknowns, inputs and
/// their derivatives, parameters, start and stop time, and the phase.
///
/// What is left out does not bear on results: name, callbacks and log settings belong to the
/// instance, results derived from the state are computed again, and files of fields stay where they
/// are. Their series goes on from the restored time, and replaces what was written from then on.
#[derive(Clone)]
pub struct Snapshot {
    pub phase: Phase,
    /// The scene with its parameters.
    pub scene: Scene,
    /// Folder of the fields; nothing in states from bytes, which leave the instance its own.
    pub directory: Option<String>,
    pub experiment: Experiment,
    pub state: State,
    pub has_set_derivatives: bool,
    /// There once the unit had one; then the state holds unknowns that fit it.
    pub model: Option<Arc<Model>>,
}

/// The snapshots of one instance that its master has not freed, by the pointers that stand for
/// them.
///
/// Such a pointer is a number that this copy of the library never gives out again in this process, and
/// nobody looks at what it points to. Other copies, as other units load them, begin elsewhere among
/// 2⁶² numbers. So one that was freed, came from another instance or was never given out is recognised.
#[derive(Default)]
pub struct SavedStates(BTreeMap<usize, Snapshot>);

/// Numbers given out after the first one.
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// The number given out first, once it is known; until then zero.
static FIRST: AtomicUsize = AtomicUsize::new(0);

/// The number given out first, odd so that none is null or could be an address of an aligned value.
///
/// It follows from where this copy of the library lies, from the process and from the time of the first
/// call, by a hash whose keys are drawn by the system.
fn first() -> usize {
    let known = FIRST.load(Ordering::Relaxed);
    if known != 0 {
        return known;
    }
    let place = (&raw const COUNT).addr();
    let of = (place, process::id(), SystemTime::now());
    let drawn = RandomState::new().hash_one(of) as usize | 1;
    // Of several threads one draws for all.
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

    /// Puts another snapshot under the pointer of one.
    pub fn replace(&mut self, pointer: SavedState, snapshot: Snapshot) -> Answer<()> {
        *self.0.get_mut(&pointer.addr()).ok_or_else(|| unknown(pointer))? = snapshot;
        Ok(())
    }

    /// Forgets the snapshot of a pointer.
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
    /// Saves the present state; a null pointer asks for a new place, another for its own again.
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

    /// Takes a saved state over; it stays saved.
    pub fn restore(&mut self, place: SavedState) -> Answer {
        let snapshot = self.saved.get(place)?;
        if let Some(model) = &snapshot.model {
            expect_room(model.room(&snapshot.state))?;
        }
        let snapshot = snapshot.clone();
        let directory = snapshot.directory.unwrap_or_else(|| self.directory.clone());
        let same_files = directory == self.directory;
        self.phase = snapshot.phase;
        self.scene = snapshot.scene;
        self.directory = directory;
        self.experiment = snapshot.experiment;
        self.forget_answers();
        self.state = snapshot.state;
        self.has_set_derivatives = snapshot.has_set_derivatives;
        self.texts.clear();
        self.run = snapshot.model.map(Run::new);
        if self.phase != Phase::StepComplete {
            self.series = None;
            return Ok(Status::Ok);
        }
        match &mut self.series {
            Some((series, _)) if same_files => {
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
