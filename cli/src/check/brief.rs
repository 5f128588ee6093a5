//! A scene's report in about ten lines.

use std::fmt::Write;

use impinge::model::tolerance::BodyEstimate;
use impinge::model::{Forecast, Timeline};
use impinge::output::FilesForecast;
use impinge::scene::{Lattice, Load, Scene};

use super::accuracy::accuracy;
use super::cost::Preparation;
use super::omissions::omissions;
use super::words::key;
use crate::units::{engineering, lasting, megabytes};

/// Results of the check that the report shows.
pub struct Findings<'f> {
    pub forecast: &'f Forecast,
    pub preparation: &'f Preparation,
    pub estimates: &'f [BodyEstimate],
    pub files: FilesForecast,
    /// Number of warnings that were printed.
    pub warnings: usize,
}

/// Width of the column of topics.
const TOPICS: usize = 14;

/// The report.
pub fn brief(scene: &Scene, findings: &Findings) -> String {
    let mut text = head(scene);
    let mut add = |topic: &str, lines: &[String]| {
        for (i, line) in lines.iter().enumerate() {
            let topic = if i == 0 { topic } else { "" };
            let _ = writeln!(text, "  {topic:TOPICS$}{line}");
        }
    };
    add("models", &[models(scene, findings.forecast)]);
    let cost = findings.preparation.cost(findings.forecast, findings.files.table_time);
    let costs: Vec<_> = [cost].into_iter().chain(by_inputs(scene, findings.forecast)).collect();
    add("takes", &costs);
    add("writes", &[writes(&findings.files, scene)]);
    add("not modelled", &omissions(scene, findings.forecast));
    add("accuracy", &accuracy(scene, findings.estimates));
    let warnings = match findings.warnings {
        0 => "none".to_owned(),
        1 => "1, above".to_owned(),
        count => format!("{count}, above"),
    };
    add("warnings", &[warnings]);
    add(
        "more",
        &["--verbose: conditions, meshes, errors; --list: parameters, inputs, outputs".to_owned()],
    );
    text
}

/// Name, description and steps of a scene.
fn head(scene: &Scene) -> String {
    let mut text = scene.name.clone();
    if !scene.description.is_empty() {
        let _ = write!(text, ": {}", scene.description);
    }
    let steps = Timeline::new(scene.step, scene.stop_time).count;
    let [step, stop] = [scene.step, scene.stop_time].map(|time| engineering(time, "s"));
    let (level, tolerance) = (key(&scene.fidelity.level), scene.fidelity.tolerance);
    let _ = writeln!(
        text,
        "\n  {:TOPICS$}{steps} of {step} to {stop}; fidelity {level}, tolerance {tolerance}",
        "steps"
    );
    text
}

fn models(scene: &Scene, forecast: &Forecast) -> String {
    let solids = forecast.bodies.iter().map(|body| {
        let nodes = body.nodes.iter().filter(|count| **count > 1);
        let nodes: Vec<_> = nodes.map(usize::to_string).collect();
        let reduced = if body.reduced.is_some() { ", reduced" } else { "" };
        format!("{}: {} nodes{reduced}", body.name, nodes.join(" × "))
    });
    let droplets = forecast.droplets.iter().map(|body| match body.particles {
        0 => format!("{}: closed forms", body.name),
        particles => {
            let freezes = scene.freezing_of(&body.name).map_or_else(String::new, |freezing| {
                format!(", freezing below {} K", freezing.melting.liquidus)
            });
            format!("{}: {particles} particles{freezes}", body.name)
        }
    });
    let large_strains = forecast
        .large_strains
        .iter()
        .map(|body| format!("{}: {} nodes of large strain", body.name, body.nodes));
    let filaments =
        forecast.filaments.iter().map(|body| format!("{}: {} {}", body.name, body.count, body.of));
    let lattices = forecast
        .lattices
        .iter()
        .map(|body| format!("{}: {} particles of a lattice", body.name, body.particles));
    let all: Vec<_> =
        solids.chain(droplets).chain(large_strains).chain(filaments).chain(lattices).collect();
    if all.is_empty() { "nothing with an extent".to_owned() } else { all.join("; ") }
}

/// Times of lattices in equilibrium beyond those of their default input, zero, at which no link softens.
fn by_inputs(scene: &Scene, forecast: &Forecast) -> Vec<String> {
    let of_lattice = |(name, lattice): (&str, &Lattice)| {
        let own = forecast.lattices.iter().find(|own| own.name == name)?;
        let input = lattice.inputs().into_iter().next()?;
        let (more, key) = (lasting(own.time_per_metre? * MICROMETRE), input.key);
        Some(format!(
            "for the {key} that `{name}.{key}` has by default, {}: up to some {more} more for each µm of it",
            input.start
        ))
    };
    let of_load = |load: &Load| {
        let (name, _) = load.on.split_once('.')?;
        let body = forecast.bodies.iter().find(|body| body.name == name)?;
        let radius = load.start_radius()?;
        let ways = [load.range.x, load.range.y].into_iter().flatten();
        let farthest = ways.fold(0.0, |most: f64, [low, high]| most.max(high - low));
        let more = farthest / radius * body.way_time;
        (more > NOTABLE * forecast.run_time()).then(|| {
            let (radius, time) = (engineering(radius, "m"), lasting(body.way_time));
            format!(
                "for `{}` where it starts: some {time} more for each {radius} that it moves",
                load.name
            )
        })
    };
    let of_loads = scene.load.iter().filter_map(of_load);
    scene.lattices().filter_map(of_lattice).chain(of_loads).collect()
}

/// Part of the time of a run from which on the report has that of a load which crosses its range.
const NOTABLE: f64 = 0.2;

/// [m]
const MICROMETRE: f64 = 1e-6;

fn writes(files: &FilesForecast, scene: &Scene) -> String {
    // With the file from which a report is made.
    format!("{} files, about {} in out/{}", files.count + 1, megabytes(files.bytes), scene.name)
}
