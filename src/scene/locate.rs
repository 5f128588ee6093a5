//! Positions in a scene's text: maps the path of a value to its line and its source text.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Problem, SceneError};
use super::excerpt::Excerpt;
use super::shorthand::NamedSubstance;
use super::slip;

/// Largest length of source text in a message.
const LONGEST_VALUE: usize = 60;

/// Path from the root of a scene to one of its values.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Path(Vec<Step>);

/// Step from a value to one of its elements.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    Key(String),
    Index(usize),
}

impl Path {
    /// The path of the value under `key`, which may be any text.
    pub fn key(&self, key: &str) -> Self {
        self.step(Step::Key(key.to_owned()))
    }

    /// The path of an element of a list, counted from 0.
    pub fn index(&self, index: usize) -> Self {
        self.step(Step::Index(index))
    }

    /// The path below this one by bare keys separated by dots, as in `mesh.spacing`.
    pub fn at(&self, keys: &str) -> Self {
        keys.split('.').fold(self.clone(), |path, key| path.key(key))
    }

    /// The path of the table or list that holds the value; the root is its own parent.
    pub fn parent(&self) -> Self {
        Self(self.0[..self.0.len().saturating_sub(1)].to_vec())
    }

    /// The key of the value in its table; empty for elements of lists and for the root.
    pub fn last_key(&self) -> &str {
        match self.0.last() {
            Some(Step::Key(key)) => key,
            _ => "",
        }
    }

    /// From the root to the value.
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Returns true if this value is part of the value at `other` (or is that value).
    pub fn is_within(&self, other: &Path) -> bool {
        self.0.starts_with(&other.0)
    }

    fn step(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Key(key) => {
                    let dot = if i == 0 { "" } else { "." };
                    if is_bare(key) { write!(f, "{dot}{key}")? } else { write!(f, "{dot}{key:?}")? }
                }
            }
        }
        Ok(())
    }
}

/// Returns true if TOML accepts this key without quotes.
fn is_bare(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// A scene's text together with the positions of its values.
#[derive(Debug)]
pub struct Source<'a> {
    file: String,
    text: &'a str,
    /// Positions of the line ends.
    ends: Vec<usize>,
    root: Spanned<DeValue<'a>>,
    /// Numbers in SI units for which the text has a number with a unit.
    numbers: BTreeMap<Path, f64>,
    substances: Vec<NamedSubstance>,
}

impl<'a> Source<'a> {
    /// Parses TOML; the error lists every invalid line.
    pub fn parse(text: &'a str, file: &str) -> Result<Self, SceneError> {
        let (table, errors) = DeTable::parse_recoverable(text);
        let root = Spanned::new(table.span(), DeValue::Table(table.into_inner()));
        let bytes = text.bytes().enumerate();
        let ends = bytes.filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at).collect();
        let source = Self {
            file: file.to_owned(),
            text,
            ends,
            root,
            numbers: BTreeMap::new(),
            substances: Vec::new(),
        };
        let mut problems: Vec<_> = errors.iter().map(|error| source.not_toml(error)).collect();
        problems.dedup_by_key(|problem| problem.line);
        SceneError::unless_empty(problems)?;
        Ok(source)
    }

    /// The whole scene, always a table.
    pub fn root(&self) -> &DeValue<'a> {
        self.root.get_ref()
    }

    /// The value at `path`, if there is one.
    pub fn value(&self, path: &Path) -> Option<&DeValue<'a>> {
        self.node(&path.0).map(Spanned::get_ref)
    }

    /// The number for which the text at `path` has a text with a unit, in SI units.
    pub fn number(&self, path: &Path) -> Option<f64> {
        self.numbers.get(path).copied()
    }

    /// All such numbers.
    pub fn numbers(&self) -> &BTreeMap<Path, f64> {
        &self.numbers
    }

    /// Makes the text at `path` stand for a number.
    pub fn set_number(&mut self, path: Path, value: f64) {
        self.numbers.insert(path, value);
    }

    /// Substances of the library that the scene names.
    pub fn substances(&self) -> &[NamedSubstance] {
        &self.substances
    }

    /// Notes that the table of a substance has its constants.
    pub fn add_substance(&mut self, named: NamedSubstance) {
        self.substances.push(named);
    }

    /// Bytes of the text that hold the value at `path`.
    pub fn span(&self, path: &Path) -> Option<Range<usize>> {
        self.node(&path.0).map(Spanned::span)
    }

    /// Puts another value in the place of the one at `path`.
    pub fn replace(&mut self, path: &Path, value: DeValue<'a>) {
        if let Some(node) = self.node_mut(&path.0) {
            *node.get_mut() = value;
        }
    }

    /// Adds `[TABLE.KEY]` with the span of the text that asks for it.
    pub fn insert(&mut self, [table, key]: [&str; 2], span: &Range<usize>, value: DeValue<'a>) {
        let spanned = |key: &str| Spanned::new(span.clone(), Cow::Owned(key.to_owned()));
        let DeValue::Table(root) = self.root.get_mut() else { return };
        if !root.contains_key(table) {
            root.insert(spanned(table), Spanned::new(span.clone(), DeValue::Table(DeTable::new())));
        }
        if let Some(DeValue::Table(table)) = root.get_mut(table).map(Spanned::get_mut) {
            table.insert(spanned(key), Spanned::new(span.clone(), value));
        }
    }

    /// A problem with the value at `path`; if it is missing, with its table.
    pub fn problem(&self, path: &Path, message: String, allowed: String) -> Problem {
        // The innermost table around a missing value.
        let around = (0..=path.0.len()).rev().find_map(|steps| self.node(&path.0[..steps]));
        let span = around.map_or(0..0, Spanned::span);
        Problem {
            file: self.file.clone(),
            line: Some(self.line_of_offset(span.start)),
            path: path.to_string(),
            value: self.node(&path.0).map(|node| self.text_of(node)).unwrap_or_default(),
            message,
            allowed,
            excerpt: self.excerpt(&span),
        }
    }

    /// A problem with the last key of `path`, whatever its value.
    pub fn problem_of_key(&self, path: &Path, message: String, allowed: String) -> Problem {
        let problem = self.problem(path, message, allowed);
        let Some(DeValue::Table(table)) = self.value(&path.parent()) else { return problem };
        let key = table.keys().find(|key| key.get_ref() == path.last_key());
        let excerpt = key.and_then(|key| self.excerpt(&key.span()));
        Problem { excerpt: excerpt.or(problem.excerpt.clone()), ..problem }
    }

    fn excerpt(&self, span: &Range<usize>) -> Option<Excerpt> {
        if span.is_empty() && span.start == 0 {
            return None;
        }
        Excerpt::new(self.text, &self.ends, span)
    }

    fn node(&self, steps: &[Step]) -> Option<&Spanned<DeValue<'a>>> {
        steps.iter().try_fold(&self.root, |node, step| match step {
            Step::Key(key) => node.get_ref().get(key.as_str()),
            Step::Index(index) => node.get_ref().get(*index),
        })
    }

    fn node_mut(&mut self, steps: &[Step]) -> Option<&mut Spanned<DeValue<'a>>> {
        steps.iter().try_fold(&mut self.root, |node, step| match (node.get_mut(), step) {
            (DeValue::Table(table), Step::Key(key)) => table.get_mut(key.as_str()),
            (DeValue::Array(list), Step::Index(index)) => list.get_mut(*index),
            _ => None,
        })
    }

    /// First line of a value as written; empty for tables under a header.
    fn text_of(&self, node: &Spanned<DeValue<'a>>) -> String {
        let text = self.text.get(node.span()).unwrap_or_default();
        let is_number = text.starts_with(|c: char| c.is_ascii_digit() || "+-in".contains(c));
        let own = match node.get_ref() {
            DeValue::Float(float) => Some(float.as_str()),
            DeValue::Integer(integer) => Some(integer.as_str()),
            _ => None,
        };
        // Constants of a substance stand where its name does.
        if let Some(constant) = own.filter(|_| !is_number) {
            return constant.to_owned();
        }
        let has_header = match node.get_ref() {
            DeValue::Table(_) => !text.starts_with('{'),
            DeValue::Array(array) => {
                let tables = array.first().is_some_and(|first| first.get_ref().is_table());
                tables && text.starts_with("[[")
            }
            _ => false,
        };
        if has_header { String::new() } else { shortened(text) }
    }

    fn line_of_offset(&self, offset: usize) -> usize {
        1 + self.ends.partition_point(|&end| end < offset)
    }

    fn not_toml(&self, error: &toml::de::Error) -> Problem {
        let span = error.span().unwrap_or(self.text.len()..self.text.len());
        let excerpt = self.excerpt(&span);
        let line = self.text.lines().nth(self.line_of_offset(span.start) - 1).unwrap_or_default();
        let (message, allowed) = match error.message().split_once(", expected ") {
            _ if let Some(slip) = slip::explanation(line) => slip,
            Some((message, expected)) => (message, expected),
            None if error.message() == "duplicate key" => ("duplicate key", "each key once"),
            None => (error.message(), "TOML 1.0"),
        };
        Problem {
            file: self.file.clone(),
            line: Some(self.line_of_offset(span.start)),
            path: String::new(),
            value: shortened(self.text.get(span).unwrap_or_default()),
            message: format!("not TOML: {message}"),
            allowed: allowed.to_owned(),
            excerpt,
        }
    }
}

/// The first line of a text, truncated to a maximum length.
pub(crate) fn shortened(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default().trim_end();
    let cut: String = line.chars().take(LONGEST_VALUE).collect();
    if cut.len() < text.trim_end().len() { format!("{cut}…") } else { cut }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a = 1\n\n[body.\"odd name\"]\nm = { x = 0.5,\n  y = [1,\n    2] }\n\
        [[load]]\nn = 1\n[[load]]\nn = '''p\nq'''\n";

    fn place(path: Path) -> (usize, String, String) {
        let source = Source::parse(TEXT, "file").unwrap();
        let problem = source.problem(&path, String::new(), String::new());
        (problem.line.unwrap(), problem.path, problem.value)
    }

    fn expect(path: Path, line: usize, shown: &str, value: &str) {
        assert_eq!(place(path), (line, shown.to_owned(), value.to_owned()));
    }

    #[test]
    fn values_are_found_under_headers_in_inline_tables_and_in_lists() {
        let root = Path::default();
        expect(root.at("a"), 1, "a", "1");
        let body = root.at("body").key("odd name");
        expect(body.clone(), 3, "body.\"odd name\"", "");
        expect(body.at("m.x"), 4, "body.\"odd name\".m.x", "0.5");
        expect(body.at("m.y").index(1), 6, "body.\"odd name\".m.y[1]", "2");
        expect(root.at("load"), 7, "load", "");
        expect(root.at("load").index(1), 9, "load[1]", "");
    }

    #[test]
    fn long_value_is_truncated() {
        expect(Path::default().at("load").index(1).at("n"), 10, "load[1].n", "'''p…");
    }

    #[test]
    fn missing_value_reports_the_line_of_its_table() {
        expect(Path::default().at("load").index(0).at("on"), 7, "load[0].on", "");
    }

    #[test]
    fn invalid_toml_reports_every_line() {
        let error = Source::parse("a = \nb = 1\nb = 2\nc = 'x\n", "file").unwrap_err();
        let lines: Vec<_> = error.problems.iter().map(|problem| problem.line).collect();
        assert_eq!(lines, [Some(1), Some(3), Some(4)], "{error}");
    }
}
