//! The line of a scene that a problem is about, with marks below the text at fault.

use std::fmt;
use std::ops::Range;

/// Longest part of a line that is shown, in characters.
const WIDEST: usize = 100;
/// Characters before the marked text that a long line keeps.
const BEFORE: usize = 40;

/// A line of a scene's text, and what of it is marked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    /// Number of the line, counted from 1.
    line: usize,
    text: String,
    /// Marked characters of the text.
    marked: Range<usize>,
}

impl Excerpt {
    /// The line that holds the first byte of `span`, of a text whose lines end at the bytes `ends`.
    pub fn new(text: &str, ends: &[usize], span: &Range<usize>) -> Option<Self> {
        let index = ends.partition_point(|&end| end < span.start);
        let begin = index.checked_sub(1).map_or(0, |last| ends[last] + 1);
        let line = text.get(begin..ends.get(index).copied().unwrap_or(text.len()))?;
        let line = line.trim_end();
        let count = |end: usize| line.get(..end.min(line.len())).map(|part| part.chars().count());
        let (from, to) = (count(span.start.checked_sub(begin)?)?, count(span.end - begin)?);
        let skipped = if line.chars().count() > WIDEST { from.saturating_sub(BEFORE) } else { 0 };
        let shown = line.chars().skip(skipped).take(WIDEST);
        let text: String = shown.map(|c| if c.is_control() { ' ' } else { c }).collect();
        let last = text.chars().count().max(from - skipped + 1);
        let marked = from - skipped..(to - skipped).clamp(from - skipped + 1, last);
        Some(Self { line: index + 1, text, marked })
    }
}

impl fmt::Display for Excerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        let marks = "^".repeat(self.marked.len());
        writeln!(f, "{margin} |")?;
        writeln!(f, "{number} | {}", self.text)?;
        write!(f, "{margin} | {}{marks}", " ".repeat(self.marked.start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, part: &str) -> String {
        let ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
        let at = text.find(part).unwrap();
        Excerpt::new(text, &ends, &(at..at + part.len())).unwrap().to_string()
    }

    #[test]
    fn marks_stand_below_the_text() {
        let text = "a = 1\ntemperature = \"90 °C\" # warm\r\nb = 2";
        let wanted = "  |\n2 | temperature = \"90 °C\" # warm\n  |               ^^^^^^^";
        assert_eq!(shown(text, "\"90 °C\""), wanted);
        assert_eq!(shown(text, "b"), "  |\n3 | b = 2\n  | ^");
    }

    #[test]
    fn marks_end_with_the_line() {
        assert_eq!(shown("a = [1,\n  2]\n", "[1,\n  2]"), "  |\n1 | a = [1,\n  |     ^^^");
        assert_eq!(shown("a = \nb = 1", "\n"), "  |\n1 | a =\n  |    ^");
    }

    #[test]
    fn long_lines_are_cut_around_the_marks() {
        let text = format!("a = [{}, 7.5, {}]", "1, ".repeat(100), "2, ".repeat(100));
        let shown = shown(&text, "7.5");
        let lines: Vec<&str> = shown.lines().collect();
        let at = lines[2].find('^').unwrap();
        assert_eq!(&lines[1][at..at + 3], "7.5");
        assert!(lines[1].len() < 110, "{shown}");
    }
}
