//! The unit's documentation: one page of HTML made from scene and registry, and the licences.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use impinge::scene::Scene;
use impinge::variables::{
    ArrayRegistry, ArrayVariable, Causality, Content, Registry, Value, Variable,
};

use crate::archive::Entries;
use crate::version::Version;
use crate::words;

const STYLE: &str = include_str!("documentation.css");

/// Texts for the folder `documentation/licenses`.
pub fn licences() -> Entries {
    let texts = [
        ("LICENSE-MIT.txt", include_str!("../../LICENSE-MIT")),
        ("LICENSE-APACHE.txt", include_str!("../../LICENSE-APACHE")),
        ("THIRD-PARTY.md", include_str!("../../THIRD-PARTY.md")),
    ];
    let entry = |(name, text): (&str, &str)| {
        (format!("documentation/licenses/{name}"), text.as_bytes().to_vec())
    };
    BTreeMap::from(texts.map(entry))
}

/// The page of a scene's unit.
pub fn page(scene: &Scene, fmi: Version, reductions: &[String]) -> String {
    let (registry, arrays) = (Registry::of(scene), ArrayRegistry::of(scene));
    let title = escape(&scene.name);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<img src=\"../{}\" alt=\"Section of the scene\" width=\"200\" \
         height=\"150\">\n<div>\n<h1>{title}</h1>\n<p>{}</p>\n</div>\n</header>\n",
        fmi.icon(),
        escape(&scene.description)
    );
    section(&mut html, "What is modelled", &modelled(scene, reductions));
    section(&mut html, "How to run it", &how_to_run(scene, &registry, &arrays, fmi));
    for (causality, heading, text) in [
        (Causality::Input, "Inputs", "Held constant during a communication step."),
        (Causality::Output, "Outputs", "Values at the end of a communication step."),
        (Causality::Parameter, "Parameters", "They may be set until initialisation ends."),
    ] {
        let rows = rows(&registry, &arrays, causality, fmi);
        if !rows.is_empty() {
            section(&mut html, heading, &format!("<p>{text}</p>\n{}", table(&rows)));
        }
    }
    if fmi == Version::Three {
        constants(&mut html, &arrays);
    }
    let _ = write!(
        html,
        "<footer>Made by impinge {} from <code>resources/scene.toml</code>. Licences are in \
         <code>documentation/licenses</code>.</footer>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    );
    html
}

/// Where points and cells are, which units of FMI 3.0 tell as constants.
fn constants(html: &mut String, arrays: &ArrayRegistry) {
    let item = |v: &ArrayVariable| {
        let Content::Constants(quantity, _) = &v.content else { return None };
        let (name, unit, words) = (name(v), quantity.unit(), escape(&v.description));
        Some(format!("<li><code>{name}</code> [{unit}]: {words}</li>\n"))
    };
    let items: String = arrays.variables.iter().filter_map(item).collect();
    if !items.is_empty() {
        section(html, "Constants", &format!("<ul>\n{items}</ul>\n"));
    }
}

/// Name of a variable of FMI 3.0, with the counts of its elements.
fn name(variable: &ArrayVariable) -> String {
    match &variable.dimensions[..] {
        [] => variable.name.clone(),
        counts => {
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            format!("{} ({})", variable.name, counts.join(" × "))
        }
    }
}

fn section(html: &mut String, heading: &str, content: &str) {
    let _ = writeln!(html, "<section>\n<h2>{heading}</h2>\n{content}</section>");
}

fn modelled(scene: &Scene, reductions: &[String]) -> String {
    let mut lines = words::of(scene);
    lines.extend(errors(scene));
    lines.extend(reductions.iter().map(|note| format!("{note}.")));
    let list: String = lines.iter().map(|line| format!("<li>{}</li>\n", escape(line))).collect();
    format!(
        "<ul>\n{list}</ul>\n<p>Values are in SI units, temperatures in kelvin. The default \
         experiment ends at {} with communication steps of {}; steps may have any size.</p>\n",
        words::quantity(scene.stop_time, "s"),
        words::quantity(scene.step, "s")
    )
}

/// Known errors of outputs, body by body.
fn errors(scene: &Scene) -> impl Iterator<Item = String> {
    let tolerance = scene.fidelity.tolerance;
    scene.refinement.iter().filter_map(move |(name, mesh)| {
        let error = mesh.estimated_error?;
        let kept = if error > tolerance { "more than" } else { "within" };
        Some(format!(
            "{name}: on its mesh errors of outputs are about {error:.0e} of their ranges over the default experiment, {kept} \
             the tolerance of {tolerance:e}."
        ))
    })
}

/// A program that sets the first input and plots the first outputs.
fn how_to_run(scene: &Scene, registry: &Registry, arrays: &ArrayRegistry, fmi: Version) -> String {
    let of = |causality| {
        let has_causality = move |v: &&ArrayVariable| v.causality(registry) == Some(causality);
        arrays.variables.iter().filter(has_causality)
    };
    let start: Vec<String> =
        of(Causality::Input).take(1).filter_map(|v| start_of(v, registry, fmi)).collect();
    let names = of(Causality::Output).flat_map(|v| match fmi {
        Version::Two => v.elements(registry).iter().map(|element| element.name.clone()).collect(),
        Version::Three if v.dimensions.is_empty() => vec![v.name.clone()],
        Version::Three => Vec::new(),
    });
    let outputs: Vec<String> = names.take(3).map(|name| format!("\"{name}\"")).collect();
    let program = format!(
        "from fmpy import simulate_fmu\nfrom fmpy.util import plot_result\n\n\
         result = simulate_fmu(\n    \"{}.fmu\",\n    stop_time={:?},\n    output_interval={:?},\n    \
         start_values={{{}}},\n    output=[{}],\n)\nplot_result(result)\n",
        scene.name,
        scene.stop_time,
        scene.step,
        start.join(", "),
        outputs.join(", ")
    );
    format!(
        "<p>Any tool that imports FMI {} co-simulation units can run it. With \
         <a href=\"https://github.com/CATIA-Systems/FMPy\">FMPy</a>:</p>\n<pre>{}</pre>\n",
        fmi.name(),
        escape(&program)
    )
}

/// An entry of the dictionary of start values.
fn start_of(variable: &ArrayVariable, registry: &Registry, fmi: Version) -> Option<String> {
    let first = &variable.elements(registry)[0];
    let start = words::number(first.real_start()?);
    Some(match (fmi, &variable.dimensions[..]) {
        (Version::Two, _) | (_, []) => format!("\"{}\": {start}", first.name),
        (_, counts) => {
            let count = counts.iter().product::<usize>();
            format!("\"{}\": [{start}] * {count}", variable.name)
        }
    })
}

/// A variable, or all elements of an array.
struct Row<'a> {
    elements: &'a [Variable],
    name: String,
    meaning: String,
}

/// A row a variable of the version; in FMI 2.0 for all neighbours that differ only in their indices.
fn rows<'a>(
    registry: &'a Registry,
    arrays: &ArrayRegistry,
    causality: Causality,
    fmi: Version,
) -> Vec<Row<'a>> {
    let of_causality = arrays.variables.iter().filter(|v| v.causality(registry) == Some(causality));
    let row = |variable: &ArrayVariable| {
        let elements = variable.elements(registry);
        let name = match (fmi, &variable.dimensions[..]) {
            (_, []) => variable.name.clone(),
            (Version::Two, _) => span(variable, elements),
            (Version::Three, _) => name(variable),
        };
        Row { elements, name, meaning: variable.description.clone() }
    };
    of_causality.map(row).collect()
}

/// First and last element of an array; of the last one only its indices if they stand in brackets.
fn span(array: &ArrayVariable, elements: &[Variable]) -> String {
    let [first, .., last] = elements else { return elements[0].name.clone() };
    let indices = last.name.strip_prefix(&array.name).filter(|rest| rest.starts_with('['));
    format!("{} … {}", first.name, indices.unwrap_or(&last.name))
}

fn table(rows: &[Row]) -> String {
    let with_start = rows.iter().any(|row| row.elements[0].start.is_some());
    let start_head = if with_start { "<th>start</th>" } else { "" };
    let mut html = format!(
        "<table>\n<thead><tr><th>name</th><th>unit</th>{start_head}<th>meaning</th></tr></thead>\n\
         <tbody>\n"
    );
    for row in rows {
        let start = if with_start {
            format!("<td class=\"number\">{}</td>", start(row))
        } else {
            String::new()
        };
        let _ = writeln!(
            html,
            "<tr><td><code>{}</code></td><td>{}</td>{start}<td>{}</td></tr>",
            escape(&row.name),
            row.elements[0].quantity.map_or("", |quantity| quantity.unit()),
            escape(&row.meaning)
        );
    }
    html + "</tbody>\n</table>\n"
}

fn start(row: &Row) -> String {
    let first = &row.elements[0].start;
    match first {
        Some(_) if row.elements.iter().any(|element| element.start != *first) => {
            "by element".into()
        }
        Some(Value::Real(value)) => words::number(*value),
        Some(Value::Integer(value)) => value.to_string(),
        Some(Value::Text(text)) => escape(&format!("{text:?}")),
        None => String::new(),
    }
}

pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    #[test]
    fn arrays_are_one_row_and_texts_are_escaped() {
        let mut scene = impinge::scene::parse(SCENE, "scene.toml").unwrap();
        scene.description = "hot & <fast>".into();
        let html = page(&scene, Version::Two, &[]);
        assert!(html.contains("<code>surface.temperature[1,1] … [4,4]</code>"), "{html}");
        assert!(!html.contains("surface.temperature[2,2]"));
        assert!(html.contains("temperature at point i, j of the grid on plate.top"));
        assert!(html.contains("<p>hot &amp; &lt;fast&gt;</p>"));
        scene.naming = impinge::scene::Naming::Flat;
        let html = page(&scene, Version::Two, &[]);
        assert!(html.contains("surface_temperature_1_1 … surface_temperature_4_4</code>"));
        assert!(!html.contains("surface_temperature_2_2"));
    }

    #[test]
    fn the_page_of_fmi_3_names_whole_arrays() {
        let scene = impinge::scene::parse(SCENE, "scene.toml").unwrap();
        let html = page(&scene, Version::Three, &[]);
        assert!(html.contains("<code>surface.temperature (4 × 4)</code>"), "{html}");
        assert!(html.contains("imports FMI 3.0") && html.contains("terminalsAndIcons/icon.png"));
        assert!(!html.contains("[1,1]"));
    }
}
