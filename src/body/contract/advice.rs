//! What a body tells its user.

use crate::body::Reading;
use crate::body::droplet::Watch;
use crate::method::sph::WarmPlace;

/// Words for users, and what they follow from; a body that has none says nothing.
pub trait Advice {
    /// What was chosen or left out, and why: a sentence each.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// What of its own making errs by more than the scene's tolerance, in words.
    fn beyond_tolerance(&self) -> Option<String> {
        None
    }

    /// From when on after a jump of what acts the temperatures of heated faces can be told [s].
    fn resolved_from(&self) -> f64 {
        0.0
    }

    /// What a user should know of a state, quickly found.
    fn warning(&self, _state: &[f64]) -> Option<String> {
        None
    }

    /// Points at which a fluid of the body would freeze or boil.
    fn watch(&self) -> Option<&Watch> {
        None
    }

    /// The coldest and the hottest place of a fluid in a state; nothing where there is none.
    fn warm_places(&self, _state: &[f64]) -> Option<[WarmPlace; 2]> {
        None
    }

    /// What inputs tell since the last step, in answer to it, that does not go with how it was computed: those of its
    /// beginning, and those that there are now.
    fn warning_on_answer(&self, _state: &[f64], _before: &[f64], _now: &[f64]) -> Option<String> {
        None
    }

    /// What a user should know of a value that is read.
    fn warning_on_value(&self, _reading: &Reading, _value: f64) -> Option<String> {
        None
    }

    /// What a user should know of the state at the end of a run: a sentence each.
    fn closing_warnings(&self, _state: &[f64]) -> Vec<String> {
        Vec::new()
    }
}
