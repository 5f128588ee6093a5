//! Tables whose keys follow from one of them, the tag: materials by their model, viscosities by their law.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue};

use super::Decoder;
use super::failure::Misfit;
use super::keys::fields_of;
use super::value::Keys;
use crate::laws::{Part, PartVisitor};
use crate::scene::locate::Path;

/// A tag with its names.
pub struct Tag {
    pub key: &'static str,
    pub names: &'static [&'static str],
    /// Keys besides the tag in the table of a name.
    pub keys_of: fn(&str) -> Vec<&'static str>,
    /// Further tables that are allowed where the tag is missing.
    pub otherwise: &'static str,
}

impl Decoder<'_> {
    /// Returns the name that a table's tag chooses; refuses the table if it chooses none, and keys of other names.
    pub(super) fn read_tag(
        &mut self,
        path: &Path,
        table: &DeTable,
        tag: &Tag,
    ) -> Option<&'static str> {
        let chosen = table.get(tag.key).map(|name| name.get_ref());
        let text = chosen.and_then(DeValue::as_str);
        let Some(name) = tag.names.iter().copied().find(|own| Some(*own) == text) else {
            self.refuse_tag(path, chosen, tag);
            return None;
        };
        let known = (tag.keys_of)(name);
        for key in table.keys().map(|key| key.get_ref().as_ref()) {
            if key != tag.key && !known.contains(&key) {
                self.refuse_key(path, key, &known, tag);
            }
        }
        Some(name)
    }

    fn refuse_tag(&mut self, path: &Path, chosen: Option<&DeValue>, tag: &Tag) {
        let misfit = match chosen.map(DeValue::as_str) {
            None => Misfit::MissingKey(tag.key),
            Some(Some(name)) => {
                Misfit::UnknownName { name: name.to_owned(), known: tag.names.to_vec() }
            }
            Some(None) => Misfit::Unexpected { expected: "a string".to_owned() },
        };
        let place = if chosen.is_some() { path.key(tag.key) } else { path.clone() };
        let mut allowed = tag.names.join(", ");
        if chosen.is_none() {
            allowed.push_str(tag.otherwise);
        }
        self.note(&misfit, &place, allowed);
        self.left_out.insert(path.clone());
    }

    fn refuse_key(&mut self, path: &Path, key: &str, known: &[&'static str], tag: &Tag) {
        let place = path.key(key);
        let owners: Vec<String> = tag
            .names
            .iter()
            .filter(|name| (tag.keys_of)(name).contains(&key))
            .map(|name| format!("{} = \"{name}\"", tag.key))
            .collect();
        if owners.is_empty() {
            let misfit = Misfit::UnknownKey { key: key.to_owned(), known: known.to_vec() };
            self.note(&misfit, &place, misfit.allowed());
            self.leave_out(&misfit, place);
            return;
        }
        let message = format!("`{key}` is a key of another {}", tag.key);
        let allowed = format!("{}, or no such key", owners.join(", "));
        self.problems.push(self.source.problem_of_key(&place, message, allowed));
        self.left_out.insert(place);
    }
}

/// Collects the keys of parts.
#[derive(Default)]
pub struct PartKeys(pub Vec<&'static str>);

impl PartVisitor for PartKeys {
    fn part<P: Part + DeserializeOwned + JsonSchema>(&mut self) {
        self.0.extend(fields_of::<P>());
    }
}

/// Reads the parts of a table: each is a struct of its own, whose misfits keep their places.
pub struct PartReader<'r, 'a> {
    pub decoder: &'r mut Decoder<'a>,
    pub path: &'r Path,
    /// True if a part lacks a required key, so that the table as a whole is left out.
    pub is_left_out: bool,
}

impl PartVisitor for PartReader<'_, '_> {
    fn part<P: Part + DeserializeOwned + JsonSchema>(&mut self) {
        self.decoder.read::<P>(self.path, Keys::Among(fields_of::<P>()));
        // The other parts are read all the same, so that what is wrong with them is reported, too.
        self.is_left_out |= self.decoder.left_out.remove(self.path);
    }
}
