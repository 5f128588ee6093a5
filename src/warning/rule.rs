//! A rule, its finding, and the text of that.

use std::fmt;

/// Occasion on which a rule is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum When {
    /// When a scene is read, before anything is built.
    Check,
    /// When meshes are chosen and bodies are built.
    Build,
    /// When an input is set or a step is taken.
    Step,
    /// When an output is read.
    Read,
    /// When a run ends.
    End,
}

impl When {
    pub fn name(self) -> &'static str {
        match self {
            Self::Check => "check",
            Self::Build => "build",
            Self::Step => "step",
            Self::Read => "read",
            Self::End => "end",
        }
    }
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule {
    /// Stable name.
    pub id: &'static str,
    pub when: When,
    /// Message and remedy: formats, with values in braces.
    pub message: &'static str,
    pub remedy: &'static str,
}

/// Finding of a rule, before its place is named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    pub id: &'static str,
    pub message: String,
    /// Empty if there is no remedy.
    pub remedy: String,
}

impl Finding {
    /// Returns the warning of a body, a variable or a file.
    pub fn at(self, place: impl Into<String>) -> Warning {
        let place = place.into();
        Warning { subject: format!("{place}: {self}"), place, finding: self }
    }
}

impl fmt::Display for Finding {
    /// `what is wrong; remedy`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { message, remedy, .. } = self;
        if remedy.is_empty() { write!(f, "{message}") } else { write!(f, "{message}; {remedy}") }
    }
}

/// A finding at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    subject: String,
    place: String,
    finding: Finding,
}

impl Warning {
    /// Replaces the subject of the warning: hosts are warned once of each subject.
    pub fn of_subject(self, subject: impl Into<String>) -> Self {
        Self { subject: subject.into(), ..self }
    }

    /// Makes the rule and the place the subject: numbers of the message change from step to step.
    pub fn whatever_its_numbers(self) -> Self {
        let subject = format!("{}: {}", self.place, self.finding.id);
        self.of_subject(subject)
    }

    /// Key by which hosts recognise repeated warnings: the text, or a key that no number of it changes.
    pub fn subject(&self) -> &str {
        &self.subject
    }

    /// Returns the body, variable or file that it is about.
    pub fn place(&self) -> &str {
        &self.place
    }

    /// Returns message and remedy, without the place.
    pub fn finding(&self) -> &Finding {
        &self.finding
    }
}

impl fmt::Display for Warning {
    /// `place: what is wrong; remedy [id]`. The id is last, so that what lines begin with does not depend on it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} [{}]", self.place, self.finding, self.finding.id)
    }
}

/// Generates a table of rules, and for each row a function that takes its values and returns the finding.
macro_rules! rules {
    ($($when:ident $id:ident($($value:ident),*) $message:literal; $remedy:literal)*) => {
        /// The rules of this file.
        pub(super) const TABLE: &[$crate::warning::Rule] = &[$($crate::warning::Rule {
            id: stringify!($id),
            when: $crate::warning::When::$when,
            message: $message,
            remedy: $remedy,
        }),*];
        $(
            pub fn $id($($value: impl std::fmt::Display),*) -> $crate::warning::Finding {
                $crate::warning::Finding {
                    id: stringify!($id),
                    message: format!($message),
                    remedy: format!($remedy),
                }
            }
        )*
    };
}

pub(super) use rules;
