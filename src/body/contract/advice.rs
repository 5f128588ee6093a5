//! Notes and warnings of a body for its user.

use crate::body::Reading;
use crate::body::droplet::Watch;
use crate::method::sph::WarmPlace;
use crate::warning::Warning;

/// Occasion on which the warnings of a body are collected.
#[derive(Debug, Clone, Copy)]
pub enum Occasion<'a> {
    /// A step was taken; the tests are quick.
    Step,
    /// Inputs were set in response to the last step: those at its beginning, and those now.
    Response { before: &'a [f64], now: &'a [f64] },
    /// A run ends.
    End,
}

/// Messages to users and the data behind them; by default there are none.
pub trait Advice {
    /// Returns notes on choices and simplifications, with reasons: one sentence each.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns warnings about a state.
    fn warnings(&self, _state: &[f64], _occasion: Occasion) -> Vec<Warning> {
        Vec::new()
    }

    /// Returns a warning about a value that is read.
    fn warning_on_value(&self, _reading: &Reading, _value: f64) -> Option<Warning> {
        None
    }

    /// Warns, with a remedy, if the body's own error bound exceeds the scene's tolerance.
    fn beyond_tolerance(&self, _remedy: &str) -> Option<Warning> {
        None
    }

    /// Time after a jump in the loads from which on the mesh resolves the temperatures of heated faces [s].
    fn resolved_from(&self) -> f64 {
        0.0
    }

    /// Returns the points at which a fluid of the body would freeze or boil, or leaves what its constants hold for.
    fn watch(&self) -> Option<&Watch> {
        None
    }

    /// Returns the lowest and the highest temperature of a solid that inputs set or heat, where its state has them [K].
    fn temperature_range(&self, _state: &[f64], _inputs: &[f64]) -> Option<[f64; 2]> {
        None
    }

    /// Returns the coldest and the hottest place of a fluid in a state, if the body has fluid.
    fn warm_places(&self, _state: &[f64]) -> Option<[WarmPlace; 2]> {
        None
    }
}
