//! The schema of scenes as tables for people: a row for each key.

use impinge::limits::keyword;
use serde_json::Value;

/// Headings of `docs/scene.md` with a table, and where in the schema the table that they describe stands.
pub const SECTIONS: [(&str, &str); 71] = [
    ("The whole", ""),
    ("`fidelity`", "/$defs/Fidelity"),
    ("`solver`", "/$defs/Solver"),
    ("`[refinement.BODY]`", "/$defs/MeshFactors"),
    ("`[resolved.BODY]`", "/$defs/ResolvedLevel"),
    ("`[body.NAME]` of a solid", "/$defs/Body/oneOf/0"),
    ("`shape` of a solid", "/$defs/Shape"),
    ("`shape.disc`", "/$defs/Disc"),
    ("`material` of a solid", "/$defs/Material"),
    ("`melting` of a material", "/$defs/Melting"),
    ("`frozen` of a fluid", "/$defs/Frozen"),
    ("`evaporation` of a fluid", "/$defs/Evaporation"),
    ("`creep` of a material", "/$defs/Creep"),
    ("`hardening` of a material", "/$defs/Saturation"),
    ("`kcc` of a material", "/$defs/Kcc"),
    ("`strength` of `kcc`", "/$defs/SurfaceKeys"),
    ("`residual` of `kcc`", "/$defs/ResidualKeys"),
    ("`damage` of `kcc`", "/$defs/DamageKeys"),
    ("`compaction` of `kcc`", "/$defs/CompactionKeys"),
    ("`meridians` of `kcc`", "/$defs/MeridianKeys"),
    ("`shear_relaxation` of a material", "/$defs/Branch"),
    ("`shift` of a material", "/$defs/Shift"),
    ("`weibull` of a material", "/$defs/Weibull"),
    ("`slow_growth` of `weibull`", "/$defs/SlowGrowth"),
    ("`fracture` of a material", "/$defs/Cracking"),
    ("`layers` of a solid", "/$defs/Layer"),
    ("`sph` of a solid", "/$defs/SphSettings"),
    ("`mesh` of a solid", "/$defs/Mesh"),
    ("`faces.FACE` of a solid", "/$defs/Face"),
    ("`faces.FACE.convection` of a solid", "/$defs/Convection"),
    ("`faces.FACE.radiation` of a solid", "/$defs/Radiation"),
    ("`bath` of a solid", "/$defs/Bath"),
    ("`notches` of a solid", "/$defs/Notch"),
    ("`[body.NAME]` of a solid of large strain", "/$defs/Body/oneOf/3"),
    ("`start` of a solid of large strain", "/$defs/LargeStrainStart"),
    ("`mesh` of a solid of large strain", "/$defs/LargeStrainMesh"),
    ("`rkpm` of a solid of large strain", "/$defs/KernelSettings"),
    ("`sph` of a solid of large strain", "/$defs/ParticleSettings"),
    ("`shape.ball`", "/$defs/Ball"),
    ("`shape.quadrilateral`", "/$defs/Quadrilateral"),
    ("`shape.strand`", "/$defs/Strand"),
    ("`shape.part`", "/$defs/Part"),
    ("`faces.FACE` of a solid of large strain", "/$defs/HeldFace"),
    ("`[body.NAME]` of a droplet", "/$defs/Body/oneOf/1"),
    ("`fluid` of a droplet", "/$defs/Fluid"),
    ("`viscosity` of a fluid", "/$defs/ViscosityLaw"),
    ("`arrhenius` of a viscosity", "/$defs/Arrhenius"),
    ("`arrivals` of a droplet", "/$defs/Arrival"),
    ("`record` of a droplet", "/$defs/Recording"),
    ("`[body.NAME]` of a filament", "/$defs/Body/oneOf/4"),
    ("`nozzle` of a filament", "/$defs/Nozzle"),
    ("`path` of a filament", "/$defs/PathTable"),
    ("`path` of a filament by G-code", "/$defs/PathFile"),
    ("`[body.NAME]` of a lattice", "/$defs/Body/oneOf/5"),
    ("`material` of a lattice", "/$defs/QuasiBrittle"),
    ("`softening` of a lattice", "/$defs/SofteningKeys"),
    ("`notch` of a lattice", "/$defs/LatticeNotch"),
    ("`support.three_point` of a lattice", "/$defs/ThreePoint"),
    ("`[[target]]`", "/$defs/Target"),
    ("`[body.NAME]` of a reservoir", "/$defs/Body/oneOf/2"),
    ("`[[load]]`", "/$defs/Load"),
    ("`footprint` of a load or wall", "/$defs/Footprint"),
    ("`start` of a load", "/$defs/LoadStart"),
    ("`range` of a load", "/$defs/LoadRange"),
    ("`[[probe]]`", "/$defs/Probe"),
    ("`[[flaw]]`", "/$defs/Flaw"),
    ("`growth` of a flaw", "/$defs/CrackGrowth"),
    ("`[[field]]`", "/$defs/Field"),
    ("`[[wall]]`", "/$defs/Wall"),
    ("`start` of a wall", "/$defs/WallStart"),
    ("`[[coupling]]`", "/$defs/Coupling"),
];

/// The keys of the table that stands at `pointer` in the schema, as Markdown.
pub fn table(schema: &Value, pointer: &str) -> String {
    let table = schema.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}"));
    let mut text =
        String::from("| key | unit | meaning | default | allowed |\n|---|---|---|---|---|\n");
    for row in rows(schema, table) {
        text += &row.line();
    }
    text
}

/// A key as tables show it.
struct Row<'s> {
    key: &'s str,
    unit: &'s str,
    meaning: String,
    default: String,
    /// Values that are allowed, and what else must hold.
    values: Vec<String>,
    condition: &'s str,
}

impl Row<'_> {
    fn line(&self) -> String {
        let Row { key, unit, meaning, default, values, condition } = self;
        let mut allowed = values.join(", ");
        if allowed.is_empty() && condition.is_empty() && !unit.is_empty() {
            allowed += "any";
        }
        if !allowed.is_empty() && !condition.is_empty() {
            allowed += "; ";
        }
        allowed += condition;
        let cells = [&format!("`{key}`"), *unit, meaning, default, &allowed];
        let cells: Vec<String> = cells.iter().map(|cell| spaced(cell)).collect();
        format!("|{}|\n", cells.join("|"))
    }
}

fn spaced(cell: &str) -> String {
    if cell.is_empty() { " ".to_owned() } else { format!(" {cell} ") }
}

/// The rows of a table; where several tables are alternatives, of all their keys, each once.
fn rows<'s>(schema: &'s Value, table: &'s Value) -> Vec<Row<'s>> {
    let mut rows: Vec<Row> = Vec::new();
    let alone = std::slice::from_ref(table);
    for alternative in choices(table).map_or(alone, Vec::as_slice) {
        let Some(keys) = alternative.get("properties").and_then(Value::as_object) else { continue };
        for (key, own) in keys {
            // What stands at an alternative with a single key is said of this.
            let around = if keys.len() == 1 { alternative } else { own };
            let new = row(schema, alternative, (key, own), around);
            match rows.iter_mut().find(|row| row.key == key) {
                None => rows.push(new),
                Some(known) => known.add(new.values),
            }
        }
    }
    rows
}

impl Row<'_> {
    fn add(&mut self, values: Vec<String>) {
        for value in values {
            if !self.values.contains(&value) {
                self.values.push(value);
            }
        }
    }
}

fn row<'s>(
    schema: &'s Value,
    table: &'s Value,
    (key, own): (&'s str, &'s Value),
    around: &'s Value,
) -> Row<'s> {
    let text = |name: &str| {
        let text = own.get(name).or_else(|| around.get(name));
        text.and_then(Value::as_str).unwrap_or_default()
    };
    let unit = text(keyword::UNIT);
    let meaning = text("description").replace(&format!(" [{unit}]"), "");
    let mut meaning = meaning.trim_end_matches('.').to_owned();
    if let Some(heading) = section_of(own) {
        meaning += &format!(" ([keys](#{}))", anchor(heading));
    }
    let required = table.get("required").and_then(Value::as_array);
    let is_required = required.is_some_and(|keys| keys.iter().any(|name| name == key));
    let default = match own.get(keyword::OTHERWISE).and_then(Value::as_str) {
        Some(otherwise) => otherwise.to_owned(),
        None if is_required => String::new(),
        None => own.get("default").map_or("none".to_owned(), shown),
    };
    Row {
        key,
        unit,
        meaning,
        default,
        values: values(schema, own),
        condition: text(keyword::CONDITION),
    }
}

/// The heading of the section with the keys of the table, or of each table, that a key takes.
fn section_of(own: &Value) -> Option<&'static str> {
    let choices = choices(own).into_iter().flatten();
    let parts =
        choices.chain(["items", "additionalProperties"].iter().filter_map(|key| own.get(key)));
    let mut references = parts.chain([own]).filter_map(|part| part.get("$ref")?.as_str());
    references.find_map(|reference| {
        let section = SECTIONS.iter().find(|(_, pointer)| *pointer == &reference[1..]);
        section.map(|(heading, _)| *heading)
    })
}

/// What links to a heading of a page in Markdown name.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

/// A default value.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => format!("`{text}`"),
        Value::Number(_) => number(value.as_f64().unwrap_or_default()),
        Value::Bool(value) => value.to_string(),
        Value::Null | Value::Array(_) | Value::Object(_) => "none".to_owned(),
    }
}

/// What the schema of a key allows: names, or bounds of numbers.
fn values(schema: &Value, own: &Value) -> Vec<String> {
    let own = resolved(schema, own);
    if let Some(list) = choices(own) {
        let all = list.iter().filter(|choice| is_plain(resolved(schema, choice)));
        let mut found: Vec<String> = Vec::new();
        for value in all.flat_map(|choice| values(schema, choice)) {
            if !found.contains(&value) {
                found.push(value);
            }
        }
        return found;
    }
    let names = own.get("enum").and_then(Value::as_array);
    let names = names.into_iter().flatten().chain(own.get("const"));
    let mut found: Vec<String> = names.map(shown).collect();
    match kind(own) {
        Some("boolean") => found = vec!["true".to_owned(), "false".to_owned()],
        Some("array") => {
            found.extend(lengths(own));
            let items = own.get("items");
            found.extend(items.into_iter().flat_map(|items| values(schema, items)));
        }
        Some("number" | "integer") => found.extend(bounds(own)),
        _ => {}
    }
    found
}

/// How long a list may be, where it may have several lengths but not any.
fn lengths(schema: &Value) -> Option<String> {
    let [least, most] = ["minItems", "maxItems"].map(|key| schema.get(key).and_then(Value::as_u64));
    let [least, most] = [least?, most?];
    (least != most).then(|| format!("{least} to {most}"))
}

/// The schema that a reference leads to, or the schema itself.
fn resolved<'s>(schema: &'s Value, part: &'s Value) -> &'s Value {
    let reference = part.get("$ref").and_then(Value::as_str);
    reference.map_or(part, |reference| schema.pointer(&reference[1..]).unwrap())
}

/// The schemas of which a value must follow one.
fn choices(schema: &Value) -> Option<&Vec<Value>> {
    schema.get("oneOf").or_else(|| schema.get("anyOf"))?.as_array()
}

/// A number with six digits, as people write it.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap();
    let is_short = rounded == 0.0 || (1e-3..1e4).contains(&rounded.abs());
    if is_short { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// The type of a schema, or the first of several, which the others are shorthand for.
fn kind(schema: &Value) -> Option<&str> {
    let kind = schema.get("type")?;
    kind.get(0).unwrap_or(kind).as_str()
}

/// Whether a schema is that of a name, a number or a list.
fn is_plain(schema: &Value) -> bool {
    schema.get("type").is_none_or(|name| name != "object")
}

/// The bounds of a number, in words.
fn bounds(schema: &Value) -> Option<String> {
    let bound = |name: &str| schema.get(name).and_then(Value::as_f64);
    let is_whole = kind(schema) == Some("integer");
    let (low, above) = (bound("minimum"), bound("exclusiveMinimum"));
    let (high, below) = (bound("maximum"), bound("exclusiveMaximum"));
    Some(match (low, above, high, below) {
        (Some(low), _, Some(high), _) if is_whole && high - low == 1.0 => {
            format!("{}, {}", number(low), number(high))
        }
        (Some(low), _, Some(high), _) if is_whole && high >= 1e5 => {
            format!("whole, {} to {}", number(low), number(high))
        }
        (Some(low), _, Some(high), _) => format!("{} to {}", number(low), number(high)),
        (_, Some(above), Some(high), _) => format!("above {}, to {}", number(above), number(high)),
        (_, Some(above), _, Some(below)) => {
            format!("above {}, below {}", number(above), number(below))
        }
        (_, Some(above), None, None) => format!("above {}", number(above)),
        _ => return None,
    })
}
