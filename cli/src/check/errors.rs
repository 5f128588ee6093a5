//! Table of the outputs' errors.

use std::fmt::Write;

use impinge::model::tolerance::estimate::OutputError;
use impinge::model::tolerance::{BodyEstimate, percent};

use crate::table::table;

/// Largest number of listed outputs with errors, per body.
const MOST_ERRORS: usize = 12;

/// Lists the errors of outputs, the largest first, and what the estimates omit.
pub fn errors(estimates: &[BodyEstimate]) -> String {
    let mut text = String::new();
    for estimate in estimates {
        let mut outputs: Vec<_> = estimate.outputs.iter().collect();
        outputs.sort_by(|a, b| b.total().total_cmp(&a.total()));
        let row = |one: &&OutputError| {
            [one.name.clone(), percent(one.along), percent(one.through), percent(one.total())]
        };
        let rows: Vec<_> = outputs.iter().take(MOST_ERRORS).map(row).collect();
        if !rows.is_empty() {
            let heading = ["output", "along the surface", "through the thickness", "of its range"];
            text.push_str(&table(heading, &rows));
        }
        if outputs.len() > MOST_ERRORS {
            let more = outputs.len() - MOST_ERRORS;
            let _ = writeln!(text, "  {more} more outputs have smaller errors");
        }
        for note in &estimate.notes {
            let _ = writeln!(text, "  - {}: {note}", estimate.body);
        }
    }
    text
}
