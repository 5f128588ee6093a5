//! Expected errors beside the tolerance, in a few lines.

use std::fmt::Write;

use impinge::advice::{HeatError, Resolution};
use impinge::model::tolerance::{BodyEstimate, percent};
use impinge::scene::Scene;

/// Most outputs that are listed on lines of their own.
const MOST: usize = 4;

/// Error of an output, or the largest of the elements of an array.
struct Line {
    name: String,
    /// Part of the output's range.
    error: f64,
    elements: usize,
}

/// Marks the expected error of each output, the largest first, and those that drops bring.
pub fn accuracy(scene: &Scene, estimates: &[BodyEstimate]) -> Vec<String> {
    let tolerance = scene.fidelity.tolerance;
    let mark = |error: f64| if error <= tolerance { '✓' } else { '✗' };
    let lines = by_output(estimates);
    let width = lines.iter().take(MOST).map(|line| line.name.chars().count()).max().unwrap_or(0);
    let mut text: Vec<String> = lines
        .iter()
        .take(MOST)
        .map(|Line { name, error, elements }| {
            let mut line = format!("{} {name:width$}  {}", mark(*error), percent(*error));
            if *elements > 1 {
                let _ = write!(line, " at the worst of {elements} places");
            }
            line
        })
        .collect();
    if let [next, ..] = &lines[MOST.min(lines.len())..] {
        let (more, most) = (lines.len() - MOST, percent(next.error));
        text.push(format!("{} {more} more, {most} at most", mark(next.error)));
    }
    text.extend(scene.droplets().filter_map(|(name, droplet)| {
        let HeatError { expected, half, .. } = Resolution::of(scene, (name, droplet))?.heat()?;
        let mark = mark(expected.abs() + half);
        let [expected, half] = [expected, half].map(|part| 100.0 * part);
        Some(format!("{mark} heat of {name}, and what it warms: {expected:+.0} ± {half:.0} % by its particles"))
    }));
    text
}

/// Errors by output, the largest first; elements of an array are one line.
fn by_output(estimates: &[BodyEstimate]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for output in estimates.iter().flat_map(|estimate| &estimate.outputs) {
        let name = output.name.split('[').next().unwrap_or(&output.name);
        let error = output.total();
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => {
                line.error = line.error.max(error);
                line.elements += 1;
            }
            None => lines.push(Line { name: name.to_owned(), error, elements: 1 }),
        }
    }
    lines.sort_by(|a, b| b.error.total_cmp(&a.error));
    lines
}
