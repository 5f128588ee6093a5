//! Reads the table of a material part by part: each is a struct of its own, whose misfits keep their places.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use toml::de::DeValue;

use super::Decoder;
use super::failure::Misfit;
use super::keys::fields_of;
use super::value::Keys;
use crate::laws::{Material, Part, PartVisitor, SolidLaw};
use crate::scene::locate::Path;

const TAG: &str = "model";

impl Decoder<'_> {
    /// Reads a material and notes all that is wrong with it.
    pub(super) fn read_material(&mut self, path: &Path) {
        let Some(value @ DeValue::Table(table)) = self.source.value(path) else { return };
        if self.left_out.contains(path) {
            return;
        }
        let tag = value.get(TAG).map(|model| model.get_ref());
        let Some(model) =
            tag.and_then(DeValue::as_str).filter(|own| SolidLaw::MODELS.contains(own))
        else {
            return self.refuse_model(path, tag);
        };
        let known = keys_of(model);
        for key in table.keys().map(|key| key.get_ref().as_ref()) {
            if key != TAG && !known.contains(&key) {
                self.refuse_key(path, key, &known);
            }
        }
        let mut reader = PartReader { decoder: self, path, is_left_out: false };
        Material::visit_parts(model, &mut reader);
        if reader.is_left_out {
            self.left_out.insert(path.clone());
        }
    }

    fn refuse_model(&mut self, path: &Path, tag: Option<&DeValue>) {
        let known = SolidLaw::MODELS.to_vec();
        let misfit = match tag.map(DeValue::as_str) {
            None => Misfit::MissingKey(TAG),
            Some(Some(name)) => Misfit::UnknownName { name: name.to_owned(), known },
            Some(None) => Misfit::Unexpected { expected: "a string".to_owned() },
        };
        let place = if tag.is_some() { path.key(TAG) } else { path.clone() };
        let mut allowed = SolidLaw::MODELS.join(", ");
        if tag.is_none() {
            allowed.push_str("; or `substance = \"copper\"` for constants of the library");
        }
        self.note(&misfit, &place, allowed);
        self.left_out.insert(path.clone());
    }

    fn refuse_key(&mut self, path: &Path, key: &str, known: &[&'static str]) {
        let place = path.key(key);
        let models: Vec<&str> = SolidLaw::MODELS
            .iter()
            .copied()
            .filter(|model| keys_of(model).contains(&key))
            .collect();
        if models.is_empty() {
            let misfit = Misfit::UnknownKey { key: key.to_owned(), known: known.to_vec() };
            self.note(&misfit, &place, misfit.allowed());
            self.leave_out(&misfit, place);
            return;
        }
        let quoted: Vec<String> =
            models.iter().map(|model| format!("{TAG} = \"{model}\"")).collect();
        let message = format!("`{key}` is a key of another model");
        let allowed = format!("{}, or no such key", quoted.join(", "));
        self.problems.push(self.source.problem_of_key(&place, message, allowed));
        self.left_out.insert(place);
    }
}

/// The keys of a model's table, beside the tag.
fn keys_of(model: &str) -> Vec<&'static str> {
    let mut keys = PartKeys(Vec::new());
    Material::visit_parts(model, &mut keys);
    keys.0
}

struct PartKeys(Vec<&'static str>);

impl PartVisitor for PartKeys {
    fn part<P: Part + DeserializeOwned + JsonSchema>(&mut self) {
        self.0.extend(fields_of::<P>());
    }
}

struct PartReader<'r, 'a> {
    decoder: &'r mut Decoder<'a>,
    path: &'r Path,
    /// True if a part lacks a required key, so that the material as a whole is left out.
    is_left_out: bool,
}

impl PartVisitor for PartReader<'_, '_> {
    fn part<P: Part + DeserializeOwned + JsonSchema>(&mut self) {
        self.decoder.read::<P>(self.path, Keys::Among(fields_of::<P>()));
        // The other parts are read all the same, so that what is wrong with them is reported, too.
        self.is_left_out |= self.decoder.left_out.remove(self.path);
    }
}
