//! `docs/substances.md` is what follows from the library; `WRITE_REFERENCE=1` writes its tables and sources anew.

use std::fmt::Write;
use std::{env, fs};

use impinge::limits::number;
use impinge::substances::{Kind, Sheet, Substance};
use toml::Value;

const PAGE: &str = "docs/substances.md";
/// Temperature at which the page shows constants [K].
const SHOWN_AT: f64 = 293.0;
const WIDTH: usize = 120;

/// Columns of constants: key, heading and unit in which the page shows it.
type Column = (&'static str, &'static str, f64);

const SOLID: [Column; 6] = [
    ("density", "density [kg/m³]", 1.0),
    ("specific_heat", "specific heat [J/(kg K)]", 1.0),
    ("conductivity", "conductivity [W/(m K)]", 1.0),
    ("young", "Young's modulus [GPa]", 1e9),
    ("poisson", "Poisson's ratio", 1.0),
    ("expansion", "expansion [1e-6/K]", 1e-6),
];

const FLUID: [Column; 13] = [
    ("density", "density [kg/m³]", 1.0),
    ("viscosity", "viscosity [Pa s]", 1.0),
    ("specific_heat", "specific heat [J/(kg K)]", 1.0),
    ("conductivity", "conductivity [W/(m K)]", 1.0),
    ("surface_tension", "surface tension [N/m]", 1.0),
    ("freezes_at", "freezes [K]", 1.0),
    ("melting.latent_heat", "latent heat [kJ/kg]", 1e3),
    ("frozen.specific_heat", "frozen: specific heat [J/(kg K)]", 1.0),
    ("frozen.conductivity", "frozen: conductivity [W/(m K)]", 1.0),
    ("boils_at", "boils [K]", 1.0),
    ("evaporation.latent_heat", "evaporation: latent heat [kJ/kg]", 1e3),
    ("evaporation.molar_mass", "evaporation: molar mass [kg/mol]", 1.0),
    ("evaporation.diffusivity", "evaporation: diffusivity [m²/s]", 1.0),
];

fn float(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64)).unwrap()
}

/// A constant at a temperature: linear between the knots of its table.
fn at(value: &Value, temperature: f64) -> f64 {
    let Some(table) = value.as_table() else { return float(value) };
    let [knots, values] = ["temperature", "value"]
        .map(|key| table[key].as_array().unwrap().iter().map(float).collect::<Vec<_>>());
    let after = knots.partition_point(|knot| *knot <= temperature).clamp(1, knots.len() - 1);
    let [from, to] = [knots[after - 1], knots[after]];
    let part = ((temperature - from) / (to - from)).clamp(0.0, 1.0);
    values[after - 1] + part * (values[after] - values[after - 1])
}

/// Four digits, those of melting and boiling points all.
fn digits(value: f64, key: &str) -> String {
    if key.ends_with("_at") {
        number(value)
    } else {
        format!("{value:.3e}").parse::<f64>().unwrap().to_string()
    }
}

/// The constant at a key, or at a key within a table.
fn constant<'a>(sheet: &'a Sheet, key: &str) -> Option<&'a Value> {
    match key.split_once('.') {
        Some((table, key)) => sheet.constants.get(table)?.get(key),
        None => sheet.constants.get(key),
    }
}

fn melting(sheet: &Sheet) -> String {
    let Some(melting) = sheet.constants.get("melting") else { return String::new() };
    let [solidus, liquidus] = ["solidus", "liquidus"].map(|key| float(&melting[key]));
    if solidus == liquidus {
        number(solidus)
    } else {
        format!("{} to {}", number(solidus), number(liquidus))
    }
}

fn table(
    substances: &[Substance],
    columns: &[Column],
    melts: bool,
    sources: &mut Vec<String>,
) -> String {
    let mut heads = vec!["name", "title", "valid [K]"];
    heads.extend(columns.iter().map(|(_, head, _)| head));
    heads.extend(melts.then_some("melts [K]"));
    heads.push("sources");
    let mut text = format!("| {} |\n|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    for substance in substances {
        let sheet = substance.sheet();
        let [low, high] = sheet.valid;
        let shown = if (low..=high).contains(&SHOWN_AT) { SHOWN_AT } else { low };
        let mut cells = vec![
            format!("`{}`", substance.name),
            sheet.title.clone(),
            format!("{} to {}", number(low), number(high)),
        ];
        cells.extend(columns.iter().map(|(key, _, unit)| {
            constant(&sheet, key)
                .map_or(String::new(), |value| digits(at(value, shown) / unit, key))
        }));
        cells.extend(melts.then(|| melting(&sheet)));
        let numbers = sheet.sources.iter().map(|source| {
            let found = sources.iter().position(|other| other == source);
            let place = found.unwrap_or_else(|| {
                sources.push(source.clone());
                sources.len() - 1
            });
            (place + 1).to_string()
        });
        cells.push(numbers.collect::<Vec<_>>().join(", "));
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text
}

/// A numbered list, wrapped.
fn list(sources: &[String]) -> String {
    let mut text = String::new();
    for (i, source) in sources.iter().enumerate() {
        let mut line = format!("{}.", i + 1);
        for word in source.split(' ') {
            if line.chars().count() + 1 + word.chars().count() > WIDTH {
                let _ = writeln!(text, "{line}");
                line = "  ".to_owned();
            }
            line = format!("{line} {word}");
        }
        let _ = writeln!(text, "{line}");
    }
    text
}

#[test]
fn the_page_follows_from_the_library() {
    let page = fs::read_to_string(PAGE).unwrap();
    let is_row = |line: &&str| line.starts_with("| ") || line.starts_with("|-");
    let mut sections: Vec<String> = page.split("\n## ").map(str::to_owned).collect();
    assert_eq!(sections.len(), 4, "{PAGE}: an introduction, solids, fluids and sources");
    let mut sources = Vec::new();
    let new = [
        table(Kind::Solid.all(), &SOLID, true, &mut sources),
        table(Kind::Fluid.all(), &FLUID, false, &mut sources),
    ];
    for (section, new) in sections[1..=2].iter_mut().zip(new) {
        let old: String = section.split_inclusive('\n').filter(is_row).collect();
        *section = section.replace(&old, &new);
    }
    sections[3] = format!("Sources\n\n{}", list(&sources));
    let wanted = sections.join("\n## ");
    if env::var_os("WRITE_REFERENCE").is_some() {
        fs::write(PAGE, wanted).unwrap();
        return;
    }
    for (line, (new, old)) in wanted.lines().zip(page.lines()).enumerate() {
        assert_eq!(new, old, "{PAGE}:{}; WRITE_REFERENCE=1 writes it", line + 1);
    }
    assert_eq!(wanted, page);
}
