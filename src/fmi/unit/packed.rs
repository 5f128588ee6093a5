//! Contents of a packed unit: its scene and its other resources.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::start_state;
use crate::advice;
use crate::fmi::gate::set_up::SetUpOnce;
use crate::fmi::{MARK, guid};
use crate::math::product::look_up_caches;
use crate::model::{Kept, KeptReduction, State, keep_record, keep_reduction};
use crate::runtime::address_space::{self, PRODUCTS, SPARE};
use crate::runtime::thread::{STACK, aside};
use crate::scene::{self, Scene};
use crate::variables::Registry;
use crate::warning::Warning;

/// Contents of a unit's resources, with what follows from them.
pub struct Packed {
    pub(super) scene: Scene,
    pub(super) warnings: Vec<Warning>,
    pub(super) registry: Registry,
    pub(super) guid: String,
    /// State at the start time.
    pub(super) state: State,
    pub(super) records: Vec<Kept>,
    pub(super) reductions: Vec<(String, KeptReduction)>,
}

impl Packed {
    /// Returns true if the scene may have events.
    pub fn has_events(&self) -> bool {
        self.scene.has_events()
    }

    /// Returns true if the unit declares that it reports the progress of a step.
    pub fn reports_progress(&self) -> bool {
        self.scene.reports_progress()
    }

    pub(super) fn of((scene, warnings): (Scene, Vec<Warning>), text: &str) -> Self {
        let registry = Registry::of(&scene);
        let guid = guid::guid(text, &registry);
        let state = start_state(&scene);
        let (records, reductions) = (Vec::new(), Vec::new());
        Self { scene, warnings, registry, guid, state, records, reductions }
    }
}

static CACHES: SetUpOnce = SetUpOnce::new();

/// Reads the scene in a unit's resource folder and checks the GUID (in FMI 3.0, the instantiation token). Nothing
/// expensive is computed, as parameters may still change.
pub fn read(resources: &Path, guid: &str) -> Result<Packed, String> {
    address_space::expect(STACK + PRODUCTS + SPARE).map_err(|error| error.to_string())?;
    aside(|| {
        CACHES.ensure(look_up_caches).map_err(|cut_off| cut_off.to_string())?;
        read_here(resources, guid)
    })
}

fn read_here(resources: &Path, guid: &str) -> Result<Packed, String> {
    let path = resources.join("scene.toml");
    let file = path.display().to_string();
    let text = scene::text_of(&path, &file)
        .map_err(|error| format!("cannot read the unit's scene: {error}"))?;
    let scene = advice::parse_with_warnings(&text, &file).map_err(|error| error.to_string())?;
    let mut packed = Packed::of(scene, &text);
    if guid != packed.guid {
        let own = &packed.guid;
        return Err(format!(
            "the master's GUID {guid} is not {own}, which belongs to {file} and {MARK}: \
             modelDescription.xml, scene and library are not of one unit"
        ));
    }
    packed.records = kept_in(resources, RECORDS, keep_record)?.into_values().collect();
    packed.reductions = kept_in(resources, REDUCTIONS, keep_reduction)?.into_iter().collect();
    Ok(packed)
}

/// Optional folders of a unit's resources: recorded drops, and reduced solids.
const RECORDS: &str = "records";
const REDUCTIONS: &str = "reduced";

/// Largest total size of the files in one of these folders [B].
const MOST_KEPT: u64 = 256_000_000;
/// Largest ratio of memory to file size while a file is read.
const SPREAD: usize = 4;

/// Returns the contents of the files of a resource folder, by the names of bodies.
fn kept_in<T>(
    resources: &Path,
    folder: &str,
    keep: impl Fn(&[u8]) -> Result<T, String>,
) -> Result<BTreeMap<String, T>, String> {
    let Ok(files) = fs::read_dir(resources.join(folder)) else { return Ok(BTreeMap::new()) };
    let mut paths: Vec<_> = files.filter_map(|file| Some(file.ok()?.path())).collect();
    paths.sort();
    let mut left = MOST_KEPT;
    let kept = |path: PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let kept = own_bytes(resources, &path, left).and_then(|bytes| {
            left -= bytes.len() as u64;
            keep(&bytes)
        });
        Ok((name, kept.map_err(|reason| format!("{}: {reason}", path.display()))?))
    };
    paths.into_iter().map(kept).collect()
}

/// Reads a file of the unit of at most `most` bytes; links that lead out of the resources are refused.
fn own_bytes(resources: &Path, path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let place = |path: &Path| fs::canonicalize(path).map_err(|reason| reason.to_string());
    let found = place(path)?;
    if !found.starts_with(place(resources)?) {
        let found = found.display();
        return Err(format!("it leads to {found} (allowed: files among the unit's resources)"));
    }
    let size = fs::metadata(&found).map_err(|reason| reason.to_string())?.len().min(most);
    address_space::expect(SPREAD * size as usize).map_err(|reason| reason.to_string())?;
    scene::bytes_of(&found, most).map_err(|reason| reason.to_string())
}
