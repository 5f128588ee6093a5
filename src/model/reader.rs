use super::{Cache, Model, ModelError, State};
use crate::variables::Output;

/// Outputs of one state whose inputs have been found in order; see [`Model::reader`].
pub struct Reader<'a> {
    pub(super) model: &'a Model,
    pub(super) state: &'a State,
    pub(super) cache: &'a mut Cache,
}

impl Reader<'_> {
    pub fn value(&mut self, output: &Output) -> Result<f64, ModelError> {
        self.model.value(self.state, self.cache, output)
    }
}
