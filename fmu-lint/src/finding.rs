//! Findings of rules.

use std::fmt;

use super::rules::Rule;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    Error,
    Warning,
}

/// Position of a fault.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Path in the unit; empty for the unit as a whole.
    pub file: String,
    pub line: Option<u32>,
    /// Element, variable or symbol; may be empty.
    pub element: String,
}

impl Place {
    /// The unit as a whole.
    pub fn unit() -> Self {
        Self::file("")
    }

    pub fn file(path: &str) -> Self {
        Self { file: path.into(), line: None, element: String::new() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(if self.file.is_empty() { "unit" } else { &self.file })?;
        if let Some(line) = self.line {
            write!(out, ":{line}")?;
        }
        if self.element.is_empty() { Ok(()) } else { write!(out, " {}", self.element) }
    }
}

/// A fault, with what would be right and where the standard says so.
pub struct Finding {
    pub severity: Severity,
    pub place: Place,
    /// Description of the fault.
    pub wrong: String,
    /// Allowed values.
    pub allowed: String,
    pub rule: &'static Rule,
}

impl fmt::Display for Finding {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let Rule { name, section, .. } = self.rule;
        write!(
            out,
            "{severity}: {}: {}\n  allowed: {} [{name}, FMI 2.0.4 section {section}]",
            self.place, self.wrong, self.allowed
        )
    }
}

/// A fault that prevents further reading of a unit.
pub struct Fault {
    pub place: Place,
    pub wrong: String,
}

impl Fault {
    pub fn new(place: Place, wrong: impl Into<String>) -> Self {
        Self { place, wrong: wrong.into() }
    }
}

/// Collects the findings of a rule.
pub struct Report<'a> {
    rule: &'static Rule,
    found: &'a mut Vec<Finding>,
    /// Errors and warnings of this rule.
    counts: [usize; 2],
}

/// Largest number of listed errors, and warnings, of a rule.
const MOST: usize = 1000;

impl<'a> Report<'a> {
    pub fn of(rule: &'static Rule, found: &'a mut Vec<Finding>) -> Self {
        Self { rule, found, counts: [0; 2] }
    }

    pub fn error(&mut self, place: Place, wrong: impl Into<String>, allowed: impl Into<String>) {
        self.add(Severity::Error, place, wrong.into(), allowed.into());
    }

    pub fn warning(&mut self, place: Place, wrong: impl Into<String>, allowed: impl Into<String>) {
        self.add(Severity::Warning, place, wrong.into(), allowed.into());
    }

    /// Returns the value, or reports its fault and returns `None`.
    pub fn take<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.error(fault.place, fault.wrong, self.rule.says)).ok()
    }

    fn add(&mut self, severity: Severity, place: Place, wrong: String, allowed: String) {
        let count = &mut self.counts[usize::from(severity == Severity::Warning)];
        *count += 1;
        let wrong = match *count {
            0..=MOST => wrong,
            count if count == MOST + 1 => "and more like this, which are not listed".to_owned(),
            _ => return,
        };
        self.found.push(Finding { severity, place, wrong, allowed, rule: self.rule });
    }
}
