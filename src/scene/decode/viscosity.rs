//! Reads the tables of viscosities: over the temperature, or of a law.

use toml::de::DeValue;

use super::Decoder;
use super::tagged::{PartKeys, PartReader, Tag};
use super::value::Keys;
use crate::laws::Table;
use crate::laws::fluid::viscosity::{FluidLaw, Rheology};
use crate::scene::locate::Path;

const TAG: Tag = Tag {
    key: "law",
    names: FluidLaw::NAMES,
    keys_of: |law| {
        let mut keys = PartKeys::default();
        Rheology::visit_parts(law, &mut keys);
        keys.0
    },
    otherwise: "; or `temperature = […], value = […]` for a table over the temperature",
};

impl Decoder<'_> {
    /// Reads the viscosity of a fluid if it is a table, and notes all that is wrong with it.
    pub(super) fn read_viscosity(&mut self, path: &Path) {
        let Some(DeValue::Table(table)) = self.source.value(path) else { return };
        if self.left_out.iter().any(|left_out| path.is_within(left_out)) {
            return;
        }
        if !table.contains_key(TAG.key) && table.contains_key("temperature") {
            self.read::<Table>(path, Keys::All);
            return;
        }
        let Some(law) = self.read_tag(path, table, &TAG) else { return };
        let mut reader = PartReader { decoder: self, path, is_left_out: false };
        Rheology::visit_parts(law, &mut reader);
        if reader.is_left_out {
            self.left_out.insert(path.clone());
        }
    }
}
