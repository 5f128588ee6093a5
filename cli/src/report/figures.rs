//! Numbers at the top of a page.

use impinge::scene::Scene;

use super::document::{Figure, Timing};
use super::names::name;
use super::outputs::Outputs;
use crate::units::engineering;

/// Extremes of the bodies of a run over time, and what the run took.
pub fn figures(scene: &Scene, outputs: &Outputs, timings: &[Timing]) -> Vec<Figure> {
    let mut found = Vec::new();
    for (body, _) in scene.solids() {
        for (key, label, unit) in [
            ("max_temperature", "Highest temperature", "K"),
            ("max_von_mises", "Highest von Mises stress", "Pa"),
        ] {
            found.extend(highest(outputs, (body, &name(scene, body, key)), label, unit));
        }
    }
    for (body, _) in scene.droplets() {
        let spread = name(scene, body, "spread_diameter");
        found.extend(highest(outputs, (body, &spread), "Largest spread", "m"));
        let heat = outputs.last(&name(scene, body, "heat")).map(|value| Figure {
            label: "Heat given".to_owned(),
            value: Some(value),
            unit: "J".to_owned(),
            note: body.to_owned(),
        });
        found.extend(heat);
    }
    let seconds: f64 = timings.iter().map(|timing| timing.seconds).sum();
    if seconds > 0.0 {
        let stop = engineering(outputs.times.last().copied().unwrap_or(0.0), "s");
        let note = format!("for {stop}");
        found.push(Figure {
            label: "Run took".into(),
            value: Some(seconds),
            unit: "s".into(),
            note,
        });
    }
    found
}

/// The highest value of an output and its time.
fn highest(
    outputs: &Outputs,
    (body, name): (&str, &str),
    label: &str,
    unit: &str,
) -> Option<Figure> {
    let values = outputs.values(name)?;
    let at = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
    let time = engineering(outputs.times[at], "s");
    Some(Figure {
        label: label.to_owned(),
        value: Some(values[at]),
        unit: unit.to_owned(),
        note: format!("{body}, at {time}"),
    })
}
