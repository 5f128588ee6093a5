use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use impinge::model::tolerance::estimate::OutputError;
use impinge::model::tolerance::{self, BodyEstimate, percent};
use impinge::model::{Forecast, Model, ParticleForecast, Timeline, check_memory, forecast};
use impinge::runtime::{Usage, available_memory};
use impinge::scene::{
    self, Coupling, Droplet, Face, Field, Load, MaterialChoice, Probe, Scene, Shape, Solid, Wall,
};
use impinge::variables::{ArrayRegistry, Causality, Quantity, Registry, Value, Variable};
use serde::Serialize;

use super::CliError;
use super::patience;
use super::table::table;
use super::units::{decimal, engineering, kelvin, lasting};

/// Say what a scene will model, and what is left out and why
#[derive(Args)]
pub struct Check {
    /// The scene, a TOML file
    scene: PathBuf,
    /// Say of every output what it is
    #[arg(long)]
    outputs: bool,
}

impl Check {
    /// Reports on the scene.
    pub fn execute(&self) -> Result<String, CliError> {
        let begun = Usage::now();
        let (scene, warnings) = patience::read(&self.scene)?;
        super::warn(&warnings);
        check_memory(&scene, available_memory()).map_err(CliError::Model)?;
        if let Some(note) = tolerance::note_on_sample(&scene) {
            super::print_message("note", &note);
        }
        let levels = tolerance::levels(&scene, available_memory());
        let (scene, estimates) = tolerance::estimates(&levels.scene);
        let preparation = Preparation { begun, done: Usage::now() };
        for warning in tolerance::warnings(&scene, &estimates) {
            super::print_message("warning", &warning);
        }
        let reduced =
            tolerance::reduced_model(&scene, available_memory()).map_err(CliError::Model)?;
        for warning in reduced.iter().flat_map(Model::reduction_warnings) {
            super::print_message("warning", &warning);
        }
        let sections = [
            ("Bodies", bodies(&scene)),
            ("Bodies without extent", lumps(&scene)),
            ("Droplets", droplets(&scene)),
            ("Faces", faces(&scene)),
            ("Loads", loads(&scene)),
            ("Probes", probes(&scene)),
            ("Fields", fields(&scene)),
            ("Walls", walls(&scene)),
            ("Couplings", couplings(&scene)),
            ("Model", notes(&scene, &preparation)),
            ("Errors by the mesh", errors(&estimates)),
        ];
        let mut text = head(&scene);
        for (title, body) in sections.iter().filter(|(_, body)| !body.is_empty()) {
            let _ = write!(text, "\n{title}\n{body}");
        }
        text.push_str(&reductions(reduced.as_ref(), &levels.notes));
        text.push_str(&variables(&scene, self.outputs));
        Ok(text)
    }
}

/// Usage of this process while it chose and judged meshes; a run does the same before it builds its model.
struct Preparation {
    begun: Usage,
    done: Usage,
}

impl Preparation {
    /// Processor time [s], which is the time on an idle machine: trials take one thread.
    fn time(&self) -> f64 {
        self.done.processor_time - self.begun.processor_time
    }

    /// Memory of a process that prepares and then holds so much data [B]: trials are given up before models are built.
    fn process_memory(&self, data: f64) -> f64 {
        self.done.peak_memory.max(self.begun.peak_memory + data)
    }

    /// The cost of a run in words: that of its preparation and that of its model.
    fn cost(&self, forecast: &Forecast) -> String {
        let total = forecast.run_time() + self.time();
        let memory = self.process_memory(forecast.memory()) / 1e6;
        let of_it = match self.time() {
            time if time > NOTABLE * total => {
                format!(", {} of it to choose and judge meshes", lasting(time))
            }
            _ => String::new(),
        };
        format!(
            "`impinge run` takes about {} on idle cores{of_it}, and {memory:.0} MB",
            lasting(total)
        )
    }
}

/// Part of a run from which on `check` reports the time of its preparation.
const NOTABLE: f64 = 0.1;

/// What the model will cost and what was chosen, without building it.
fn notes(scene: &Scene, preparation: &Preparation) -> String {
    let mut text = String::new();
    let forecast = forecast(scene);
    let cost = preparation.cost(&forecast);
    for body in forecast.bodies {
        let [columns, rows, layers] = body.nodes;
        let [heat, mechanics] = body.unknowns;
        let _ = writeln!(
            text,
            "  {}: {columns} × {rows} × {layers} nodes of order {}, unknowns: heat {heat}, \
             displacement {mechanics}",
            body.name, body.order
        );
        for (axis, [least, most]) in ["x", "y", "z"].iter().zip(body.spacing) {
            if most > 0.0 {
                let (least, most) = (metres(least), metres(most));
                let _ = writeln!(text, "    nodes along {axis}: {least} to {most} apart");
            }
        }
        if let Some(particles) = &body.particles {
            let _ = writeln!(text, "    {}", conduction(particles, columns * rows * layers));
        }
        let step_time = lasting(body.step_time);
        let _ = match body.reduced {
            None => writeln!(
                text,
                "    about {:.0} MB, {} to build, {step_time} a step whose stresses are read",
                body.memory / 1e6,
                lasting(body.build_time)
            ),
            Some(None) => writeln!(
                text,
                "    reduced: about {:.0} MB and {} to get there, then {step_time} a step with all that is read",
                body.memory / 1e6,
                lasting(body.build_time)
            ),
            Some(Some(unknowns)) => writeln!(
                text,
                "    reduced to {unknowns} unknowns of {:.1} kB, {} to get there, about {step_time} a step with all that is read",
                body.memory / 1e3,
                lasting(body.build_time)
            ),
        };
        for note in &body.notes {
            let _ = writeln!(text, "    - {note}");
        }
    }
    for body in forecast.droplets {
        let _ = match body.particles {
            0 => writeln!(text, "  {}: closed forms", body.name),
            particles => writeln!(
                text,
                "  {}: {particles} particles, about {:.0} time steps of {} and shorter",
                body.name,
                body.steps,
                engineering(body.time_step, "s")
            ),
        };
        let _ = writeln!(
            text,
            "    about {:.0} MB, {} for all its steps and exchanges",
            body.memory / 1e6,
            lasting(body.run_time)
        );
        for note in &body.notes {
            let _ = writeln!(text, "    - {note}");
        }
    }
    let _ = writeln!(text, "  {cost}");
    text
}

/// Most outputs of a body whose errors are listed.
const MOST_ERRORS: usize = 12;

/// Errors of outputs, the largest first, and what estimates leave out.
fn errors(estimates: &[BodyEstimate]) -> String {
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

/// Orders and bounds of solids that are reduced, and what levels that were left open came to.
fn reductions(model: Option<&Model>, levels: &[String]) -> String {
    let mut notes = levels.to_vec();
    notes.extend(model.into_iter().flat_map(Model::notes));
    let lines: String = notes.into_iter().map(|note| format!("  {note}\n")).collect();
    if lines.is_empty() { lines } else { format!("\nReduction\n{lines}") }
}

/// What particles do in a communication step.
fn conduction(forecast: &ParticleForecast, count: usize) -> String {
    let ParticleForecast { neighbours, sub_steps, products, euler_steps } = forecast;
    let parts = if *sub_steps == 1 { "sub-step" } else { "sub-steps" };
    format!(
        "heat: {count} particles of {neighbours} neighbours; about {sub_steps} {parts} of {products} \
         products a communication step, where explicit Euler steps would need {euler_steps}"
    )
}

fn head(scene: &Scene) -> String {
    let seconds = |value| engineering(value, "s");
    let steps = Timeline::new(scene.step, scene.stop_time).count;
    let mut text = scene.name.clone();
    if !scene.description.is_empty() {
        let _ = write!(text, ": {}", scene.description);
    }
    let (step, stop) = (seconds(scene.step), seconds(scene.stop_time));
    let fidelity = key(&scene.fidelity.level);
    let tolerance = scene.fidelity.tolerance;
    let _ = writeln!(
        text,
        "\n  {steps} steps of {step} to {stop}; fidelity {fidelity}, tolerance {tolerance}"
    );
    text
}

fn bodies(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .solids()
        .map(|(name, solid)| {
            [
                name.to_owned(),
                shape(&solid.shape),
                law(solid),
                kelvin(solid.initial_temperature),
                key(&solid.heat),
                key(&solid.symmetry),
            ]
        })
        .collect();
    table(["body", "shape", "material", "initially", "heat", "symmetry"], &rows)
}

fn lumps(scene: &Scene) -> String {
    let rows: Vec<_> = scene.lumps().map(|(name, words)| [name.to_owned(), words]).collect();
    table(["body", "what"], &rows)
}

fn droplets(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .droplets()
        .map(|(name, droplet)| {
            let drops = match droplet.drops() {
                count if droplet.is_on_demand() => {
                    format!("up to {count} of {}", metres(droplet.diameter))
                }
                1 => metres(droplet.diameter),
                count => format!("{count} of {}", metres(droplet.diameter)),
            };
            [
                name.to_owned(),
                drops,
                speed(droplet),
                kelvin(droplet.initial_temperature),
                key(&droplet.method),
                if droplet.has_particles() { metres(droplet.spacing) } else { "none".to_owned() },
                key(&droplet.kernel),
            ]
        })
        .collect();
    let heading =
        ["droplet", "diameter", "speed", "initially", "method", "distance of particles", "kernel"];
    table(heading, &rows)
}

fn speed(droplet: &Droplet) -> String {
    let speed = engineering(droplet.impact_velocity, "m/s");
    match droplet.is_straight() {
        true => speed,
        false => format!("{speed} at {:.1}°", droplet.impact_angle.to_degrees()),
    }
}

fn walls(scene: &Scene) -> String {
    let row = |wall: &Wall| [wall.name.clone(), wall.under.clone(), wall.footprint.label(metres)];
    let rows: Vec<_> = scene.wall.iter().map(row).collect();
    table(["wall", "under", "cells"], &rows)
}

fn couplings(scene: &Scene) -> String {
    let row = |coupling: &Coupling| {
        let carried = match (coupling.conductance, coupling.traction) {
            (Some(conductance), _) => {
                format!(
                    "heat, {}",
                    engineering(conductance, Quantity::HeatTransferCoefficient.unit())
                )
            }
            (None, true) => "heat, pressure, shear".to_owned(),
            (None, false) => "heat".to_owned(),
        };
        [coupling.from.clone(), coupling.to.clone(), carried]
    };
    let rows: Vec<_> = scene.coupling.iter().map(row).collect();
    table(["from", "to", "carries"], &rows)
}

fn faces(scene: &Scene) -> String {
    let mut rows = Vec::new();
    for (body, solid) in scene.solids() {
        for (face, condition) in &solid.faces {
            let name = format!("{body}.{}", key(face));
            rows.push([name, thermal(condition), mechanical(condition).into()]);
        }
    }
    table(["face", "thermal", "mechanical"], &rows)
}

fn loads(scene: &Scene) -> String {
    let row = |load: &Load| {
        [load.name.clone(), load.on.clone(), load.footprint.label(metres), keys(&load.carries)]
    };
    let rows: Vec<_> = scene.load.iter().map(row).collect();
    table(["load", "on", "footprint", "carries"], &rows)
}

fn probes(scene: &Scene) -> String {
    let row = |probe: &Probe| {
        let at = probe.at.map(metres).join(", ");
        [probe.name.clone(), probe.body.clone(), at, keys(&probe.gives)]
    };
    let rows: Vec<_> = scene.probe.iter().map(row).collect();
    table(["probe", "in", "at x, y, z", "gives"], &rows)
}

fn fields(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .field
        .iter()
        .map(|field| {
            let size = field.size.map_or("whole".into(), |size| size.map(metres).join(" × "));
            let sampling = match (&field.footprint, field.grid) {
                (Some(footprint), _) => format!("means over {}", footprint.label(metres)),
                (None, grid) => {
                    let [nx, ny] = grid.unwrap_or_default();
                    format!("{nx} × {ny} points, {size}")
                }
            };
            [field.name.clone(), place(field), sampling, keys(&field.gives)]
        })
        .collect();
    table(["field", "on", "values", "gives"], &rows)
}

/// The face or section of a field.
fn place(field: &Field) -> String {
    match (&field.on, &field.body, field.plane) {
        (Some(face), ..) => face.clone(),
        (None, Some(body), Some(plane)) => {
            let (axis, at) = match plane {
                scene::Plane::X(at) => ("x", at),
                scene::Plane::Y(at) => ("y", at),
                scene::Plane::Z(at) => ("z", at),
            };
            format!("{body}, {axis} = {}", metres(at))
        }
        (None, body, _) => body.clone().unwrap_or_default(),
    }
}

/// The variables by causality: how many, and each with its unit and start value, arrays folded; of outputs what
/// they are, where that is `told`.
fn variables(scene: &Scene, told: bool) -> String {
    let (registry, arrays) = (Registry::of(scene), ArrayRegistry::of(scene));
    let kinds = [
        ("Parameters", Causality::Parameter),
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
    ];
    let mut text = String::new();
    for (title, causality) in kinds {
        let of_causality =
            arrays.variables.iter().filter(|v| v.causality(&registry) == Some(causality));
        let list: Vec<&[Variable]> = of_causality.map(|v| v.elements(&registry)).collect();
        let values: usize = list.iter().map(|elements| elements.len()).sum();
        let count = match list.len() {
            names if names == values => format!("{names}"),
            names => format!("{names}, {values} values"),
        };
        let rows: Vec<_> = list
            .into_iter()
            .map(|elements| {
                let unit = elements[0].quantity.map_or("", |quantity| quantity.unit());
                // The name with the highest indices tells how many there are.
                let last = &elements[elements.len() - 1];
                let more = match causality {
                    Causality::Output if told => last.description.clone(),
                    _ => start(elements),
                };
                [last.name.clone(), unit.to_owned(), more]
            })
            .collect();
        let heading = match causality {
            Causality::Output if told => "what it is",
            Causality::Output => "",
            _ => "start",
        };
        let _ = write!(text, "\n{title} ({count})\n{}", table(["name", "unit", heading], &rows));
    }
    text
}

/// The start value that all elements share.
fn start(elements: &[Variable]) -> String {
    let first = &elements[0].start;
    if elements.iter().any(|element| element.start != *first) {
        return "various".into();
    }
    match first {
        None => String::new(),
        Some(Value::Real(value)) => decimal(*value),
        Some(Value::Integer(value)) => value.to_string(),
        Some(Value::Text(value)) => format!("{value:?}"),
    }
}

fn shape(shape: &Shape) -> String {
    match shape {
        Shape::Box(extents) => format!("box {}", extents.map(metres).join(" × ")),
        Shape::Disc(disc) => {
            format!("disc, radius {}, thickness {}", metres(disc.radius), metres(disc.thickness))
        }
    }
}

fn thermal(face: &Face) -> String {
    if let Some(temperature) = face.temperature {
        kelvin(temperature)
    } else if let Some(convection) = face.convection {
        format!("convection, {} W/(m² K) to {}", convection.coefficient, kelvin(convection.ambient))
    } else if let Some(flux) = face.flux {
        format!("flux {}", engineering(flux, "W/m²"))
    } else {
        "insulated".into()
    }
}

fn mechanical(face: &Face) -> &'static str {
    match (face.clamped, face.roller) {
        (true, _) => "clamped",
        (false, true) => "roller",
        (false, false) => "free",
    }
}

fn metres(value: f64) -> String {
    engineering(value, "m")
}

/// What a body is made of: the name of its material or constitutive law, or its layers.
fn law(solid: &Solid) -> String {
    let layers = solid.layers.iter().flatten();
    let own = solid.material.iter().map(material);
    let layers =
        layers.map(|layer| format!("{} {}", metres(layer.thickness), material(&layer.material)));
    own.chain(layers).collect::<Vec<_>>().join(" on ")
}

fn material(choice: &MaterialChoice) -> String {
    let table = toml::Value::try_from(choice.material()).ok();
    let model = table.as_ref().and_then(|table| table.get("model")?.as_str());
    choice.name.clone().unwrap_or_else(|| model.unwrap_or_default().to_owned())
}

/// The word that stands for a value in the scene.
fn key(value: &impl Serialize) -> String {
    match toml::Value::try_from(value) {
        Ok(toml::Value::String(word)) => word,
        _ => String::new(),
    }
}

fn keys(values: &[impl Serialize]) -> String {
    values.iter().map(key).collect::<Vec<_>>().join(", ")
}
