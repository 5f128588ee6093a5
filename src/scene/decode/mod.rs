//! Decodes located TOML values into the types of a scene, and reports every misfit at its position.
//!
//! serde stops at the first misfit. Here that value is recorded and omitted, and the rest is read again until no new
//! misfit occurs. So one run reports as many problems as possible.

mod failure;
mod keys;
mod material;
mod tagged;
mod unit;
mod value;
mod viscosity;

use std::collections::BTreeSet;

use serde::de::DeserializeOwned;
use toml::de::{DeFloat, DeValue};

use super::droplet::Droplet;
use super::error::{Problem, SceneError};
use super::filament::{Filament, PathFile, PathTable};
use super::large_strain::{KIND, LargeStrain};
use super::lattice::Lattice;
use super::locate::{Path, Source};
use super::reservoir::Reservoir;
use super::schema::Schema;
use super::spelling::hint;
use super::types::{Scene, Solid};
use crate::substances::Kind;
use failure::{Failure, Misfit, VARIANT, expectation};
use unit::with_unit;
use value::{Keys, Node, View};

/// Largest number of reported problems.
const MOST_PROBLEMS: usize = 100;

/// Decodes a scene whose keys, types and numbers are in order; their mutual consistency is checked later.
///
/// `misread` are texts that stand for nothing, with their problems.
pub fn decode(
    source: &Source,
    schema: &Schema,
    misread: Vec<(Path, Problem)>,
) -> Result<Scene, SceneError> {
    let (left_out, problems) = misread.into_iter().unzip();
    let mut decoder = Decoder { source, schema, left_out, problems };
    decoder.refuse_numbers_that_are_not_finite(source.root(), &Path::default());
    decoder.read_materials();
    decoder.read_bodies();
    let mut scene = decoder.read::<Scene>(&Path::default(), Keys::All);
    if let Some(scene) = &mut scene {
        decoder.look_up_materials(scene);
    }
    SceneError::unless_empty(decoder.problems)?;
    scene.ok_or_else(|| {
        source.problem(&Path::default(), "no scene".to_owned(), "a scene".to_owned()).into()
    })
}

struct Decoder<'a> {
    source: &'a Source<'a>,
    schema: &'a Schema,
    /// Values treated as absent.
    left_out: BTreeSet<Path>,
    problems: Vec<Problem>,
}

impl Decoder<'_> {
    /// Reads the named materials, as [`Self::read_bodies`] does bodies.
    fn read_materials(&mut self) {
        let path = Path::default().key("material");
        let Some(DeValue::Table(materials)) = self.source.value(&path) else { return };
        for name in materials.keys() {
            self.read_material(&path.key(name.get_ref()));
        }
    }

    /// Copies the named material into each body and layer that uses it.
    fn look_up_materials(&mut self, scene: &mut Scene) {
        let known = &scene.material;
        for (name, body) in &mut scene.body {
            let path = Path::default().key("body").key(name);
            for (part, choice) in body.materials_mut() {
                let path = part.map_or(path.clone(), |layer| path.key("layers").index(layer));
                if !choice.look_up(|name| known.get(name)) {
                    let name = choice.name.as_deref().unwrap_or_default();
                    // Errors of an existing table have already been reported.
                    let table = Path::default().key("material").key(name);
                    if self.source.value(&table).is_some() {
                        continue;
                    }
                    let path = path.key("material");
                    let names = || known.keys().map(String::as_str);
                    let library = Kind::Solid.all().iter().map(|substance| substance.name);
                    let hint = hint(name, names().chain(library));
                    let message = format!("there is no material `{name}`{hint}");
                    let mut allowed: Vec<&str> = names().collect();
                    let new = format!("a table `[material.{name}]`");
                    allowed.extend([&new, "a substance of the library (`impinge substances`)"]);
                    self.problems.push(self.source.problem(&path, message, allowed.join(", ")));
                }
            }
        }
    }

    /// Reads tables whose type is chosen by one of their keys, from the inside out. serde loses the positions of values
    /// in such tables, so they must be valid before it reads them.
    fn read_bodies(&mut self) {
        let path = Path::default().key("body");
        let Some(DeValue::Table(bodies)) = self.source.value(&path) else { return };
        for name in bodies.keys() {
            let body = path.key(name.get_ref());
            let kind = self.source.value(&body.key("kind")).and_then(DeValue::as_str);
            // That of a lattice is no material of solids.
            if kind != Some("lattice") {
                self.read_material(&body.key("material"));
            }
            let layers = body.key("layers");
            let count = match self.source.value(&layers) {
                Some(DeValue::Array(list)) => list.len(),
                _ => 0,
            };
            for material in (0..count).map(|i| layers.index(i).key("material")) {
                self.read_material(&material);
            }
            self.read_viscosity(&body.key("fluid").key("viscosity"));
            self.read_if::<Solid>(&body, "kind", "solid");
            self.read_if::<Droplet>(&body, "kind", "droplet");
            self.read_if::<Reservoir>(&body, "kind", "reservoir");
            self.read_path(&body);
            self.read_if::<Filament>(&body, "kind", "filament");
            self.read_if::<Lattice>(&body, "kind", "lattice");
            self.read_if::<LargeStrain>(&body, "kind", KIND);
        }
    }

    /// Reads the path of a filament's nozzle if it is a table, of places or of a file.
    fn read_path(&mut self, body: &Path) {
        let kind = self.source.value(&body.key("kind")).and_then(DeValue::as_str);
        let path = body.key("path");
        let Some(DeValue::Table(table)) = self.source.value(&path) else { return };
        match table.contains_key("file") {
            _ if kind != Some("filament") => {}
            true => drop(self.read::<PathFile>(&path, Keys::All)),
            false => drop(self.read::<PathTable>(&path, Keys::All)),
        }
    }

    /// Reads the table at `path` as a `T` if its key `tag` is `name`.
    fn read_if<T: DeserializeOwned>(&mut self, path: &Path, tag: &'static str, name: &str) {
        let chosen = self.source.value(&path.key(tag)).and_then(DeValue::as_str);
        if chosen == Some(name) {
            self.read::<T>(path, Keys::But(tag));
        }
    }

    /// Reads the table at `path`, records all its misfits and omits them from then on.
    fn read<T: DeserializeOwned>(&mut self, path: &Path, keys: Keys) -> Option<T> {
        let value = self.source.value(path)?;
        while self.problems.len() < MOST_PROBLEMS && !self.left_out.contains(path) {
            let numbers = self.source.numbers();
            let view = View { left_out: &self.left_out, blank: None, numbers };
            let failure = match T::deserialize(Node::new(value, path.clone(), &view).with(keys)) {
                Ok(read) => return Some(read),
                Err(failure) => failure,
            };
            let place = failure.path.clone().unwrap_or_else(|| path.clone());
            if !self.is_consequence(&place, &failure.misfit) {
                let allowed = self.allowed::<T>(value, path, keys, &failure, &place);
                self.note(&failure.misfit, &place, allowed);
            }
            if !self.leave_out(&failure.misfit, place) {
                return None;
            }
        }
        None
    }

    /// Returns true if the misfit only reports an omitted value as missing.
    fn is_consequence(&self, place: &Path, misfit: &Misfit) -> bool {
        match misfit {
            Misfit::MissingKey(key) => self.left_out.contains(&place.key(key)),
            _ => self.left_out.iter().any(|path| path.is_within(place)),
        }
    }

    fn note(&mut self, misfit: &Misfit, place: &Path, allowed: String) {
        let place = match misfit {
            Misfit::MissingKey(key) => place.key(key),
            _ => place.clone(),
        };
        let value = self.source.value(&place);
        let is_table = matches!(value, Some(DeValue::Table(_)));
        let is_list = matches!(value, Some(DeValue::Array(_)));
        let allowed = match misfit {
            // One pair of brackets begins a table, two pairs the next table of a list.
            Misfit::Unexpected { expected } if is_table && expected == "a sequence" => {
                format!("`[[{place}]]`, with two brackets, once for each")
            }
            Misfit::Unexpected { expected } if is_list && expected == VARIANT => {
                format!("`[{place}]`, with one bracket")
            }
            Misfit::UnknownKey { .. } if self.is_of_substance(&place.parent()) => {
                format!("{allowed}, model, substance, at")
            }
            _ => with_unit(allowed, self.schema, &place),
        };
        let problem = match misfit {
            Misfit::UnknownKey { .. } => Source::problem_of_key,
            _ => Source::problem,
        };
        self.problems.push(problem(self.source, &place, misfit.message(), allowed));
    }

    /// Returns true if a table has the constants of a substance of the library.
    fn is_of_substance(&self, table: &Path) -> bool {
        self.source.substances().iter().any(|named| named.table == *table)
    }

    /// Omits a misfit: a whole table if it lacks a key, otherwise the single value; for a misspelt key also the
    /// intended one. Returns true if this changes anything.
    fn leave_out(&mut self, misfit: &Misfit, place: Path) -> bool {
        if let (Misfit::UnknownKey { .. }, Some(meant)) = (misfit, misfit.meant()) {
            let meant = place.parent().key(meant);
            if self.source.value(&meant).is_none() {
                self.left_out.insert(meant);
            }
        }
        self.left_out.insert(place)
    }

    /// Describes what would fit; for a missing key, what its type accepts.
    fn allowed<T: DeserializeOwned>(
        &self,
        value: &DeValue,
        path: &Path,
        keys: Keys,
        failure: &Failure,
        place: &Path,
    ) -> String {
        let Misfit::MissingKey(key) = failure.misfit else { return failure.misfit.allowed() };
        let blank = place.key(key);
        let numbers = self.source.numbers();
        let view = View { left_out: &self.left_out, blank: Some(&blank), numbers };
        match T::deserialize(Node::new(value, path.clone(), &view).with(keys)) {
            Err(failure) if failure.path.as_ref() == Some(&blank) => failure.misfit.allowed(),
            _ => failure.misfit.allowed(),
        }
    }

    /// Refuses numbers that are not finite: TOML allows `nan` and `inf`, and rounds numbers beyond the range of a
    /// double to infinity.
    fn refuse_numbers_that_are_not_finite(&mut self, value: &DeValue, path: &Path) {
        match value {
            DeValue::Float(float) if !is_finite(float) => {
                let message = "not a finite number".to_owned();
                let allowed = with_unit(expectation("f64"), self.schema, path);
                self.problems.push(self.source.problem(path, message, allowed));
            }
            DeValue::Array(array) => {
                for (i, element) in array.iter().enumerate() {
                    self.refuse_numbers_that_are_not_finite(element.get_ref(), &path.index(i));
                }
            }
            DeValue::Table(table) => {
                for (key, element) in table {
                    let path = path.key(key.get_ref());
                    self.refuse_numbers_that_are_not_finite(element.get_ref(), &path);
                }
            }
            _ => {}
        }
    }
}

fn is_finite(float: &DeFloat) -> bool {
    float.as_str().parse::<f64>().is_ok_and(f64::is_finite)
}
