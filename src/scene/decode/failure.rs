//! Reasons why a value does not fit its type, and what would fit.

use std::fmt;

use serde::de::{Error, Expected, Unexpected};

use crate::scene::large_strain::KIND;
use crate::scene::locate::Path;
use crate::scene::spelling::meant;

/// The first value that does not fit.
#[derive(Debug)]
pub struct Failure {
    /// Position of the value; `None` until the failure has reached the innermost value with a known position.
    pub path: Option<Path>,
    pub misfit: Misfit,
}

/// Kind of misfit.
#[derive(Debug)]
pub enum Misfit {
    UnknownKey { key: String, known: Vec<&'static str> },
    UnknownName { name: String, known: Vec<&'static str> },
    MissingKey(&'static str),
    Unexpected { expected: String },
}

impl Failure {
    /// Failure of a value that is not `expected`, in serde's words.
    pub fn expecting(expected: impl fmt::Display) -> Self {
        Misfit::Unexpected { expected: expected.to_string() }.into()
    }

    /// Sets the position of the failure unless it has one.
    pub fn or_at(mut self, path: &Path) -> Self {
        self.path.get_or_insert_with(|| path.clone());
        self
    }
}

impl From<Misfit> for Failure {
    fn from(misfit: Misfit) -> Self {
        Self { path: None, misfit }
    }
}

impl Misfit {
    /// Describes the misfit in a sentence.
    pub fn message(&self) -> String {
        let hint = self.meant().map(|meant| format!(" (did you mean `{meant}`?)"));
        let hint = hint.unwrap_or_default();
        match self {
            Misfit::UnknownKey { key, .. } => format!("unknown key `{key}`{hint}"),
            Misfit::UnknownName { name, .. } => format!("`{name}` is not available{hint}"),
            Misfit::MissingKey(key) => format!("the key `{key}` is missing"),
            Misfit::Unexpected { expected } => format!("this is not {}", expectation(expected)),
        }
    }

    /// Describes what would fit.
    pub fn allowed(&self) -> String {
        match self {
            Misfit::UnknownKey { known, .. } | Misfit::UnknownName { known, .. } => {
                // The program's own name of a kind is none of a scene.
                let names = known.iter().copied().filter(|name| *name != KIND);
                let mut names: Vec<&str> = names.collect();
                // The other measure of strain chooses another kind of solid.
                if names == ["small"] {
                    names.push("finite");
                }
                names.join(", ")
            }
            Misfit::MissingKey(key) => format!("`{key} = …`"),
            Misfit::Unexpected { expected } => expectation(expected),
        }
    }

    /// The known key or name most similar to the unknown one.
    pub fn meant(&self) -> Option<&'static str> {
        let (Misfit::UnknownKey { key: word, known } | Misfit::UnknownName { name: word, known }) =
            self
        else {
            return None;
        };
        meant(word, known.iter().copied())
    }
}

/// serde's words for the name of a variant of an enum.
pub const VARIANT: &str = "variant identifier";

/// Describes what a type accepts, in terms of scenes instead of serde's.
pub fn expectation(serde: &str) -> String {
    match serde {
        "f64" => "a finite number".to_owned(),
        "usize" => "a whole number, not negative".to_owned(),
        "u32" => "a whole number from 0 to 4294967295".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a string" => "a text in quotes".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a map" | VARIANT => "a table".to_owned(),
        _ if serde.starts_with("struct ") || serde.contains(" enum ") => "a table".to_owned(),
        _ => match serde.strip_prefix("an array of length ") {
            Some(length) => format!("a list of {length} values"),
            None => serde.to_owned(),
        },
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; allowed: {}", self.misfit.message(), self.misfit.allowed())
    }
}

impl std::error::Error for Failure {}

impl Error for Failure {
    /// Only untagged enums arrive here, with the text of their `expecting`.
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::expecting(message)
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::expecting(expected)
    }

    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::expecting(expected)
    }

    fn invalid_length(_: usize, expected: &dyn Expected) -> Self {
        Self::expecting(expected)
    }

    fn unknown_field(key: &str, known: &'static [&'static str]) -> Self {
        Misfit::UnknownKey { key: key.to_owned(), known: known.to_vec() }.into()
    }

    fn unknown_variant(name: &str, known: &'static [&'static str]) -> Self {
        Misfit::UnknownName { name: name.to_owned(), known: known.to_vec() }.into()
    }

    fn missing_field(key: &'static str) -> Self {
        Misfit::MissingKey(key).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typing_errors_are_recognised() {
        let meant = |word: &str| {
            Failure::unknown_field(word, &["density", "young", "on", "at"]).misfit.meant()
        };
        assert_eq!(meant("desnity"), Some("density"));
        assert_eq!(meant("youngs"), Some("young"));
        assert_eq!(meant("In"), Some("on"));
        assert_eq!(meant("poisson"), None);
        assert_eq!(meant(""), None);
    }
}
