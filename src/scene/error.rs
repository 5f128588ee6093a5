//! Errors of a scene: position, value, reason and what is allowed instead.

use std::borrow::Cow;
use std::fmt;

use super::excerpt::Excerpt;
use crate::limits::number;

/// One error of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Name of the file, as given.
    pub file: String,
    /// Line of the value, counted from 1; `None` for an error of the whole file.
    pub line: Option<usize>,
    /// Dotted path of the value, as in `load[0].footprint.disc.radius`; empty for the file.
    pub path: String,
    /// Source text of the value; empty where there is none.
    pub value: String,
    /// Description of the error.
    pub message: String,
    /// The allowed values.
    pub allowed: String,
    /// The line of the scene's text; `None` if it has none.
    pub excerpt: Option<Excerpt>,
}

impl Problem {
    /// Forgets the line of a text that nobody wrote, such as that of a modified scene. The value is printed briefly: in
    /// TOML's notation, extreme numbers have hundreds of digits.
    pub(crate) fn forget_text(&mut self) {
        self.line = None;
        self.excerpt = None;
        if let Ok(value) = self.value.parse() {
            self.value = number(value);
        }
    }

    /// `FILE:LINE: KEY = VALUE`, without the parts that are not known.
    pub(crate) fn place(&self) -> String {
        let line = self.line.map_or(String::new(), |line| format!(":{line}"));
        let subject = match (self.path.is_empty(), self.value.is_empty()) {
            (true, true) => String::new(),
            (true, false) => format!(": `{}`", self.value),
            (false, true) => format!(": {}", self.path),
            (false, false) => format!(": {} = {}", self.path, self.value),
        };
        format!("{}{line}{subject}", self.file)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Names come unmodified from the scene.
        let place = self.place();
        write!(f, "{place}: {}; allowed: {}", printable(&self.message), printable(&self.allowed))
    }
}

/// All errors found in a scene, in the order of their lines. Never empty.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", one_a_line(problems))]
pub struct SceneError {
    pub problems: Vec<Problem>,
}

impl SceneError {
    /// Returns `Err` with the problems in the order of their lines, or `Ok` if there are none.
    pub(super) fn unless_empty(mut problems: Vec<Problem>) -> Result<(), Self> {
        if problems.is_empty() {
            return Ok(());
        }
        problems.sort_by_key(|problem| problem.line);
        Err(Self { problems })
    }

    /// Returns each problem with the line of the scene below it, for a terminal.
    pub fn with_excerpts(&self) -> String {
        let shown = |problem: &Problem| match &problem.excerpt {
            Some(excerpt) => format!("{problem}\n{excerpt}"),
            None => problem.to_string(),
        };
        self.problems.iter().map(shown).collect::<Vec<_>>().join("\n")
    }
}

impl From<Problem> for SceneError {
    fn from(problem: Problem) -> Self {
        Self { problems: vec![problem] }
    }
}

/// Escapes control characters.
fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(char::is_control) {
        return Cow::Borrowed(text);
    }
    let escape = |c: char| match c.is_control() {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    Cow::Owned(text.chars().map(escape).collect())
}

fn one_a_line(problems: &[Problem]) -> String {
    problems.iter().map(Problem::to_string).collect::<Vec<_>>().join("\n")
}
