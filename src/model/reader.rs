use super::{Cache, Model, ModelError, State};
use crate::variables::{BodyTotal, Component, Output};

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

impl Model {
    /// Whether an output takes a solution of mechanics that the cache does not have: more stack than a
    /// host's thread need have.
    pub fn is_deep(&self, cache: &Cache, output: &Output) -> bool {
        let is_unsolved = |body: &str| !cache.is_solved(self.place(body));
        match output {
            Output::Droplet { .. } | Output::Wall { .. } => false,
            Output::Body { body, total: BodyTotal::MaxVonMises | BodyTotal::MaxPrincipal } => {
                !cache.has_max_stress(self.place(body))
            }
            Output::Body { .. } => false,
            Output::Probe { component: Component::Temperature, .. } => false,
            Output::Field { component: Component::Temperature, .. } => false,
            Output::Probe { probe, .. } => is_unsolved(&self.scene.probe[*probe].body),
            Output::Field { field, .. } => is_unsolved(self.scene.field[*field].body_and_place().0),
        }
    }
}
