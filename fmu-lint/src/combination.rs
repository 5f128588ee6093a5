//! Allowed variability and `initial` of each causality: the tables of section 2.2.7.

use super::vocabulary::{Causality, Initial, Variability};

/// The allowed `initial` of a pair of causality and variability, the default first; empty for variables without that
/// attribute. `None` if the pair itself is not allowed.
pub fn allowed(causality: Causality, variability: Variability) -> Option<&'static [Initial]> {
    use {Causality as C, Variability as V};
    const EXACT: &[Initial] = &[Initial::Exact];
    const COMPUTED: &[Initial] = &[Initial::Calculated, Initial::Approx];
    const ANY: &[Initial] = &[Initial::Calculated, Initial::Exact, Initial::Approx];
    match (causality, variability) {
        (C::Parameter, V::Fixed | V::Tunable) => Some(EXACT),
        (C::Output | C::Local, V::Constant) => Some(EXACT),
        (C::CalculatedParameter | C::Local, V::Fixed | V::Tunable) => Some(COMPUTED),
        (C::Output | C::Local, V::Discrete | V::Continuous) => Some(ANY),
        (C::Input, V::Discrete | V::Continuous) => Some(&[]),
        (C::Independent, V::Continuous) => Some(&[]),
        _ => None,
    }
}

/// The allowed variabilities of a causality, as words.
pub fn variabilities(causality: Causality) -> Vec<&'static str> {
    let goes = |word: &&&str| {
        Variability::read(word).is_some_and(|variability| allowed(causality, variability).is_some())
    };
    Variability::WORDS.iter().filter(goes).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of the standard has 15 pairs: two for each kind of parameter and for inputs, three
    /// for outputs, five for local variables, one for the independent variable.
    #[test]
    fn there_are_fifteen_pairs() {
        let count = |word: &&str| variabilities(Causality::read(word).unwrap()).len();
        assert_eq!(Causality::WORDS.iter().map(count).collect::<Vec<_>>(), [2, 2, 2, 3, 5, 1]);
    }
}
