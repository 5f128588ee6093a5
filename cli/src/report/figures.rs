//! Numbers at the top of a page.

use impinge::scene::{Droplet, Scene};
use impinge::variables::Quantity;

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
    for (body, droplet) in scene.droplets() {
        let spread = name(scene, body, "spread_diameter");
        found.extend(highest(outputs, (body, &spread), "Largest spread", "m"));
        let heat = outputs.last(&name(scene, body, "heat")).map(|value| Figure {
            label: "Heat given".to_owned(),
            value: Some(value),
            unit: unit_of_heat(droplet).to_owned(),
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

/// Unit of the heat of a droplet; that of a plane one is per metre of depth.
fn unit_of_heat(droplet: &Droplet) -> &'static str {
    let whole = Quantity::Energy;
    if droplet.dimension == 2 { whole.per_depth().unit() } else { whole.unit() }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_of_plane_drops_is_per_metre_of_depth() {
        for (dimension, unit) in [(3, "J"), (2, "J/m")] {
            let text = format!(
                "name = \"Drop\"\nstop_time = 3e-7\nstep = 1e-7\n[body.drop]\nkind = \"droplet\"\n\
                 diameter = 1e-4\nimpact_velocity = 20.0\ninitial_temperature = 350.0\nspacing = 1e-5\n\
                 dimension = {dimension}\nfluid = {{ density = 1000.0, viscosity = 1e-3, \
                 specific_heat = 4180.0, conductivity = 0.6 }}\n[[wall]]\nname = \"wall\"\nunder = \"drop\"\n\
                 footprint = {{ tiles = {{ count = [2, 1], size = [2e-4, 2e-4] }} }}\n"
            );
            let scene = impinge::scene::parse(&text, "scene.toml");
            let scene = scene.unwrap_or_else(|error| panic!("{error}"));
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("table.csv");
            std::fs::write(&path, "time [s],drop.heat [J]\n0.0,0.0\n1.0,2.0\n").unwrap();
            let found = figures(&scene, &Outputs::read(&path).unwrap(), &[]);
            let heat = found.iter().find(|figure| figure.label == "Heat given").unwrap();
            assert_eq!((heat.value, heat.unit.as_str()), (Some(2.0), unit));
        }
    }
}
