//! From located TOML values to the types of a scene, with every misfit at its place.
//!
//! serde stops at the first misfit. Here that value is noted, left out and the rest read again,
//! until nothing new turns up, so that one run reports what one run can.

mod failure;
mod keys;
mod material;
mod unit;
mod value;

use std::collections::BTreeSet;

use serde::de::DeserializeOwned;
use toml::de::{DeFloat, DeValue};

use super::droplet::Droplet;
use super::error::{Problem, SceneError};
use super::locate::{Path, Source};
use super::reservoir::Reservoir;
use super::schema::Schema;
use super::spelling::hint;
use super::types::{Body, Scene, Solid};
use failure::{Failure, Misfit, expectation};
use unit::with_unit;
use value::{Keys, Node, View};

/// More problems than this are not worth reading.
const MOST_PROBLEMS: usize = 100;

/// Reads a scene whose keys, types and numbers are in order; whether they make sense together is
/// not looked at.
pub fn decode(source: &Source, schema: &Schema) -> Result<Scene, SceneError> {
    let mut decoder = Decoder { source, schema, left_out: BTreeSet::new(), problems: Vec::new() };
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
    /// What reads as if it were not there.
    left_out: BTreeSet<Path>,
    problems: Vec<Problem>,
}

impl Decoder<'_> {
    /// Reads the materials that have names, as [`Self::read_bodies`] does bodies.
    fn read_materials(&mut self) {
        let path = Path::default().key("material");
        let Some(DeValue::Table(materials)) = self.source.value(&path) else { return };
        for name in materials.keys() {
            self.read_material(&path.key(name.get_ref()));
        }
    }

    /// Gives each body and layer that names a material a copy of it.
    fn look_up_materials(&mut self, scene: &mut Scene) {
        let known = &scene.material;
        for (name, body) in &mut scene.body {
            let Body::Solid(solid) = body else { continue };
            let path = Path::default().key("body").key(name);
            let layers = solid.layers.iter_mut().flatten().enumerate();
            let layers =
                layers.map(|(i, layer)| (path.key("layers").index(i), &mut layer.material));
            let own = solid.material.iter_mut().map(|choice| (path.clone(), choice));
            for (path, choice) in own.chain(layers) {
                if !choice.look_up(|name| known.get(name)) {
                    let name = choice.name.as_deref().unwrap_or_default();
                    // What is wrong with a table that is there has been said.
                    let table = Path::default().key("material").key(name);
                    if self.source.value(&table).is_some() {
                        continue;
                    }
                    let path = path.key("material");
                    let names = || known.keys().map(String::as_str);
                    let message = format!("there is no material `{name}`{}", hint(name, names()));
                    let mut allowed: Vec<&str> = names().collect();
                    let new = format!("a table `[material.{name}]`");
                    allowed.push(&new);
                    self.problems.push(self.source.problem(&path, message, allowed.join(", ")));
                }
            }
        }
    }

    /// Reads tables whose type a key of theirs chooses, from the inside out: serde loses the
    /// places of values in such tables, so that they must be faultless when it gets to them.
    fn read_bodies(&mut self) {
        let path = Path::default().key("body");
        let Some(DeValue::Table(bodies)) = self.source.value(&path) else { return };
        for name in bodies.keys() {
            let body = path.key(name.get_ref());
            self.read_material(&body.key("material"));
            let layers = body.key("layers");
            let count = match self.source.value(&layers) {
                Some(DeValue::Array(list)) => list.len(),
                _ => 0,
            };
            for material in (0..count).map(|i| layers.index(i).key("material")) {
                self.read_material(&material);
            }
            self.read_if::<Solid>(&body, "kind", "solid");
            self.read_if::<Droplet>(&body, "kind", "droplet");
            self.read_if::<Reservoir>(&body, "kind", "reservoir");
        }
    }

    /// Reads the table at `path` as a `T` where its key `tag` says `name`.
    fn read_if<T: DeserializeOwned>(&mut self, path: &Path, tag: &'static str, name: &str) {
        let chosen = self.source.value(&path.key(tag)).and_then(DeValue::as_str);
        if chosen == Some(name) {
            self.read::<T>(path, Keys::But(tag));
        }
    }

    /// Reads the table at `path`, notes all that is wrong with it and leaves that out from then on.
    fn read<T: DeserializeOwned>(&mut self, path: &Path, keys: Keys) -> Option<T> {
        let value = self.source.value(path)?;
        while self.problems.len() < MOST_PROBLEMS && !self.left_out.contains(path) {
            let view = View { left_out: &self.left_out, blank: None };
            let failure = match T::deserialize(Node::new(value, path.clone(), &view).with(keys)) {
                Ok(read) => return Some(read),
                Err(failure) => failure,
            };
            let place = failure.path.clone().unwrap_or_else(|| path.clone());
            if !self.is_echo(&place, &failure.misfit) {
                let allowed = self.allowed::<T>(value, path, keys, &failure, &place);
                self.note(&failure.misfit, &place, allowed);
            }
            if !self.leave_out(&failure.misfit, place) {
                return None;
            }
        }
        None
    }

    /// Whether the misfit only says that something is gone that was left out.
    fn is_echo(&self, place: &Path, misfit: &Misfit) -> bool {
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
        let is_table = matches!(self.source.value(&place), Some(DeValue::Table(_)));
        let allowed = match misfit {
            // One pair of brackets begins a table, two pairs the next table of a list.
            Misfit::Unexpected { expected } if is_table && expected == "a sequence" => {
                format!("`[[{place}]]`, with two brackets, once for each")
            }
            _ => with_unit(allowed, self.schema, &place),
        };
        self.problems.push(self.source.problem(&place, misfit.message(), allowed));
    }

    /// A table that lacks a key goes as a whole; anything else that does not fit goes alone, and
    /// with a misspelt key goes the one that was meant.
    /// Returns whether that changes anything.
    fn leave_out(&mut self, misfit: &Misfit, place: Path) -> bool {
        if let (Misfit::UnknownKey { .. }, Some(meant)) = (misfit, misfit.meant()) {
            let meant = place.parent().key(meant);
            if self.source.value(&meant).is_none() {
                self.left_out.insert(meant);
            }
        }
        self.left_out.insert(place)
    }

    /// What would fit; for a missing key, what its type takes.
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
        let view = View { left_out: &self.left_out, blank: Some(&blank) };
        match T::deserialize(Node::new(value, path.clone(), &view).with(keys)) {
            Err(failure) if failure.path.as_ref() == Some(&blank) => failure.misfit.allowed(),
            _ => failure.misfit.allowed(),
        }
    }

    /// TOML knows `nan` and `inf`, and rounds numbers beyond the range of a double to the latter.
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
