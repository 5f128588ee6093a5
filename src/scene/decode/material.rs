//! Reads the table of a material part by part.

use toml::de::DeValue;

use super::Decoder;
use super::tagged::{PartKeys, PartReader, Tag};
use crate::laws::{Material, SolidLaw};
use crate::scene::locate::Path;

const TAG: Tag = Tag {
    key: "model",
    names: SolidLaw::MODELS,
    keys_of: |model| {
        let mut keys = PartKeys::default();
        Material::visit_parts(model, &mut keys);
        keys.0
    },
    otherwise: "; or `substance = \"copper\"` for constants of the library",
};

impl Decoder<'_> {
    /// Reads a material and notes all that is wrong with it.
    pub(super) fn read_material(&mut self, path: &Path) {
        let Some(DeValue::Table(table)) = self.source.value(path) else { return };
        if self.left_out.contains(path) {
            return;
        }
        let Some(model) = self.read_tag(path, table, &TAG) else { return };
        let mut reader = PartReader { decoder: self, path, is_left_out: false };
        Material::visit_parts(model, &mut reader);
        if reader.is_left_out {
            self.left_out.insert(path.clone());
        }
    }
}
