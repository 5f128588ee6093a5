//! The unit's documentation: one page of HTML made from scene and registry, and the licences.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use impinge::scene::Scene;
use impinge::variables::{Causality, Registry, Value, Variable};

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
pub fn page(scene: &Scene, fmi: Version) -> String {
    let registry = Registry::of(scene);
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
    section(&mut html, "What is modelled", &modelled(scene));
    section(&mut html, "How to run it", &how_to_run(scene, &registry, fmi));
    for (causality, heading, text) in [
        (Causality::Input, "Inputs", "Held constant during a communication step."),
        (Causality::Output, "Outputs", "Values at the end of a communication step."),
        (Causality::Parameter, "Parameters", "They may be set until initialisation ends."),
    ] {
        let rows = fold(registry.variables.iter().filter(|v| v.causality() == causality));
        if !rows.is_empty() {
            section(&mut html, heading, &format!("<p>{text}</p>\n{}", table(&rows)));
        }
    }
    let _ = write!(
        html,
        "<footer>Made by impinge {} from <code>resources/scene.toml</code>. Licences are in \
         <code>documentation/licenses</code>.</footer>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    );
    html
}

fn section(html: &mut String, heading: &str, content: &str) {
    let _ = writeln!(html, "<section>\n<h2>{heading}</h2>\n{content}</section>");
}

fn modelled(scene: &Scene) -> String {
    let lines = words::of(scene);
    let list: String = lines.iter().map(|line| format!("<li>{}</li>\n", escape(line))).collect();
    format!(
        "<ul>\n{list}</ul>\n<p>Values are in SI units, temperatures in kelvin. The default \
         experiment ends at {} with communication steps of {}; steps may have any size.</p>\n",
        words::quantity(scene.stop_time, "s"),
        words::quantity(scene.step, "s")
    )
}

/// A program that sets the first input and plots the first outputs.
fn how_to_run(scene: &Scene, registry: &Registry, fmi: Version) -> String {
    let first = |causality, count| {
        registry.of_causality(causality).take(count).map(|i| &registry.variables[i])
    };
    let start: Vec<String> = first(Causality::Input, 1)
        .filter_map(|v| {
            v.real_start().map(|start| format!("\"{}\": {}", v.name, words::number(start)))
        })
        .collect();
    let outputs: Vec<String> =
        first(Causality::Output, 3).map(|v| format!("\"{}\"", v.name)).collect();
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

/// A variable, or all elements of an array.
struct Row<'a> {
    first: &'a Variable,
    last: &'a Variable,
    same_start: bool,
}

/// Neighbours that differ only in their indices become one row.
fn fold<'a>(variables: impl Iterator<Item = &'a Variable>) -> Vec<Row<'a>> {
    let mut rows: Vec<Row> = Vec::new();
    for variable in variables {
        match rows.last_mut() {
            Some(row) if variable.name.contains('[') && base(variable) == base(row.first) => {
                row.same_start &= variable.start == row.first.start;
                row.last = variable;
            }
            _ => rows.push(Row { first: variable, last: variable, same_start: true }),
        }
    }
    rows
}

fn base(variable: &Variable) -> &str {
    variable.name.split('[').next().unwrap_or_default()
}

fn table(rows: &[Row]) -> String {
    let with_start = rows.iter().any(|row| row.first.start.is_some());
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
            escape(&name(row)),
            row.first.quantity.map_or("", |quantity| quantity.unit()),
            escape(&meaning(row))
        );
    }
    html + "</tbody>\n</table>\n"
}

fn name(row: &Row) -> String {
    if std::ptr::eq(row.first, row.last) {
        return row.first.name.clone();
    }
    let last_index = row.last.name.trim_start_matches(base(row.last));
    format!("{} … {last_index}", row.first.name)
}

fn start(row: &Row) -> String {
    match &row.first.start {
        Some(_) if !row.same_start => "by element".into(),
        Some(Value::Real(value)) => words::number(*value),
        Some(Value::Integer(value)) => value.to_string(),
        Some(Value::Text(text)) => escape(&format!("{text:?}")),
        None => String::new(),
    }
}

/// What first and last element have in common, an ellipsis for the words in which they differ.
fn meaning(row: &Row) -> String {
    let mut words: Vec<&str> = Vec::new();
    for (a, b) in row.first.description.split(' ').zip(row.last.description.split(' ')) {
        let word = if a == b { a } else { "…" };
        if word != "…" || words.last() != Some(&"…") {
            words.push(word);
        }
    }
    words.join(" ")
}

fn escape(text: &str) -> String {
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
        let html = page(&scene, Version::Two);
        assert!(html.contains("<code>surface.temperature[1,1] … [4,4]</code>"), "{html}");
        assert!(!html.contains("surface.temperature[2,2]"));
        assert!(html.contains("temperature at point … of the grid on plate.top"));
        assert!(html.contains("<p>hot &amp; &lt;fast&gt;</p>"));
    }
}
