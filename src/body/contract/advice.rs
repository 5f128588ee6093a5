//! Notes and warnings of a body for its user.

use crate::body::Reading;
use crate::body::droplet::Watch;
use crate::method::sph::WarmPlace;
use crate::warning::Warning;

/// Occasion on which a body in a state is asked for warnings.
#[derive(Debug, Clone, Copy)]
pub enum Occasion<'a> {
    /// A step was taken; the tests are quick.
    Step,
    /// Inputs were set in response to the last step: those at its beginning, and those now.
    Response { before: &'a [f64], now: &'a [f64] },
    /// A run ends.
    End,
}

/// Words for users, and what they follow from; a body that has none says nothing.
pub trait Advice {
    /// What was chosen or left out, and why: a sentence each.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// What may be wrong with a state.
    fn warnings(&self, _state: &[f64], _occasion: Occasion) -> Vec<Warning> {
        Vec::new()
    }

    /// What may be wrong with a value that is read.
    fn warning_on_value(&self, _reading: &Reading, _value: f64) -> Option<Warning> {
        None
    }

    /// Warns of a bound of errors by the body itself that exceeds the scene's tolerance, with a remedy.
    fn beyond_tolerance(&self, _remedy: &str) -> Option<Warning> {
        None
    }

    /// Time after a jump of what acts from which on the mesh resolves the temperatures of heated faces [s].
    fn resolved_from(&self) -> f64 {
        0.0
    }

    /// Points at which a fluid of the body would freeze or boil.
    fn watch(&self) -> Option<&Watch> {
        None
    }

    /// The coldest and the hottest place of a fluid in a state; nothing where there is none.
    fn warm_places(&self, _state: &[f64]) -> Option<[WarmPlace; 2]> {
        None
    }
}
