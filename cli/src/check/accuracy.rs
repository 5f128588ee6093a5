//! Expected errors beside the tolerance, in a few lines.

use std::fmt::Write;

use impinge::advice::{HeatError, LatticeErrors, Resolution};
use impinge::model::forecast;
use impinge::model::tolerance::{BodyEstimate, percent, warned_from};
use impinge::scene::Scene;

/// Most outputs that are listed on lines of their own.
const MOST: usize = 4;
/// Most gaps of the estimates that are listed.
const MOST_GAPS: usize = 3;
/// Notes that are shown: on gaps of an estimate, which begin with the first of these or have the second, and on a
/// discretisation with a smaller error, which have the third.
const SHOWN: [&str; 3] = ["no estimate", "left out", "would err by"];

/// Error of an output, or the largest of the elements of an array.
struct Line {
    name: String,
    /// Part of the output's range.
    error: f64,
    mark: char,
    elements: usize,
}

/// Marks the expected error of each output, the largest first, and those that drops bring; then names what has no
/// estimate.
///
/// ✓ is within the tolerance, ✗ is warned of, and ≈ is between: estimates of chosen meshes are high by a factor of two,
/// those of drops follow from measurements of others, and those of large strain from small inputs.
pub fn accuracy(scene: &Scene, estimates: &[BodyEstimate]) -> Vec<String> {
    let tolerance = scene.fidelity.tolerance;
    let lines = by_output(scene, estimates);
    let width = lines.iter().take(MOST).map(|line| line.name.chars().count()).max().unwrap_or(0);
    let mut text: Vec<String> = lines
        .iter()
        .take(MOST)
        .map(|Line { name, error, mark, elements }| {
            let mut line = format!("{mark} {name:width$}  {}", percent(*error));
            if *elements > 1 {
                let _ = write!(line, " at the worst of {elements} places");
            }
            line
        })
        .collect();
    if let Some(first) = text.first_mut() {
        let _ = write!(first, " of its range (wanted: {})", percent(tolerance));
    }
    if let [next, ..] = &lines[MOST.min(lines.len())..] {
        let (more, most) = (lines.len() - MOST, percent(next.error));
        text.push(format!("{} {more} more, {most} at most", next.mark));
    }
    let landing = scene.droplets().filter(|(name, _)| scene.has_surface_below(name));
    text.extend(landing.filter_map(|(name, droplet)| {
        let own = of_drop(name, &Resolution::of(scene, (name, droplet))?, tolerance);
        // Records and films of drops that overlap differ from particles by more.
        let alone = droplet.is_replayed() && droplet.drops() > 1;
        Some(format!("{own}{}", if alone { ", of a drop that overlaps no other" } else { "" }))
    }));
    text.extend(forecast(scene).filaments.iter().filter_map(|strand| {
        let error = strand.heat_error?;
        let mark = if error <= tolerance { '✓' } else { '≈' };
        Some(format!(
            "{mark} {}, by the mesh below: heat within {:.0} %",
            strand.name,
            100.0 * error
        ))
    }));
    text.extend(
        scene
            .lattices()
            .map(|(name, lattice)| of_lattice(name, &LatticeErrors::of(lattice), tolerance)),
    );
    if text.iter().any(|line| line.starts_with('≈')) {
        text.push(
            "(≈: near the tolerance; in rough estimates, as of drops and of large strain, beyond it, too)".to_owned(),
        );
    }
    let notes = |estimate: &BodyEstimate| {
        let is_shown = |note: &&String| {
            note.starts_with(SHOWN[0]) || SHOWN[1..].iter().any(|words| note.contains(words))
        };
        let shown = |note: &String| format!("{}: {note}", estimate.body);
        estimate.notes.iter().filter(is_shown).map(shown).collect::<Vec<_>>()
    };
    text.extend(estimates.iter().flat_map(notes).take(MOST_GAPS));
    text
}

/// Errors of a drop by its particles: of its heat if it has any, of its spread and of its force.
fn of_drop(name: &str, resolution: &Resolution, tolerance: f64) -> String {
    let (mut parts, mut worst) = (Vec::new(), 0.0_f64);
    if let Some(HeatError { expected, half, .. }) = resolution.heat() {
        worst = worst.max(expected.abs() + half);
        let [expected, half] = [expected, half].map(|part| 100.0 * part);
        parts.push(format!("heat by the stop time {expected:+.0} ± {half:.0} %"));
    }
    let [low, high] = resolution.spread().map(|error| 100.0 * error);
    worst = worst.max(0.01 * high);
    parts.push(format!("largest spread {low:.0} to {high:.0} %"));
    if resolution.outside_of_force().is_none() {
        worst = worst.max(resolution.force());
        parts.push(format!("means of force {:.0} %", 100.0 * resolution.force()));
    }
    let mark = if worst <= tolerance { '✓' } else { '≈' };
    format!("{mark} {name}, by its particles: {}", parts.join(", "))
}

/// Errors of a lattice by its particles: of its stiffness, of its largest load if it is bent, and of the energy of a
/// crack.
fn of_lattice(name: &str, errors: &LatticeErrors, tolerance: f64) -> String {
    let LatticeErrors { stiffness, energy, peak, rows, enough } = *errors;
    let worst = stiffness.max(energy).max(peak.unwrap_or(0.0));
    let mark = if worst <= tolerance { '✓' } else { '≈' };
    let [of_stiffness, of_energy] = [stiffness, energy].map(part_or_factor);
    let of_break = match peak.map(part_or_factor) {
        Some(peak) => format!("largest load {peak}, work of a break {of_energy}"),
        None => format!("energy of a crack {of_energy}"),
    };
    let finer = enough.map_or_else(String::new, |rows| format!("; take {rows:.0} or more"));
    format!(
        "{mark} {name}, by its {rows:.0} particles over the depth: stiffness {of_stiffness}, {of_break}{finer}"
    )
}

/// An error as a part, or as the factor of a quantity that is a multiple of what it should be.
fn part_or_factor(error: f64) -> String {
    if error < 2.0 { percent(error) } else { format!("a factor of {:.0}", 1.0 + error) }
}

/// Errors by output, the largest first; elements of an array are one line.
fn by_output(scene: &Scene, estimates: &[BodyEstimate]) -> Vec<Line> {
    let tolerance = scene.fidelity.tolerance;
    let mut lines: Vec<Line> = Vec::new();
    for estimate in estimates {
        let warned_from = warned_from(scene, &estimate.body);
        let mark = |error: f64| match error {
            kept if kept <= tolerance => '✓',
            near if near <= warned_from => '≈',
            _ => '✗',
        };
        for output in &estimate.outputs {
            let name = output.name.split('[').next().unwrap_or(&output.name);
            let error = output.total();
            match lines.iter_mut().find(|line| line.name == name) {
                Some(line) => {
                    line.error = line.error.max(error);
                    line.mark = mark(line.error);
                    line.elements += 1;
                }
                None => lines.push(Line {
                    name: name.to_owned(),
                    error,
                    mark: mark(error),
                    elements: 1,
                }),
            }
        }
    }
    lines.sort_by(|a, b| b.error.total_cmp(&a.error));
    lines
}
