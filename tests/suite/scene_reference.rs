//! `docs/scene.schema.json` is what follows from the types of scenes, the tables of `docs/scene.md` are what follows
//! from it, and both have every key that a scene may have, and no other. `WRITE_REFERENCE=1` writes both anew.

mod tables;

use std::collections::BTreeSet;
use std::{env, fs};

use impinge::laws::fluid::viscosity::FluidLaw;
use impinge::scene::{SCHEMA, derived_schema, parse};
use serde::Serialize;
use serde_json::Value;
use serde_json::ser::{PrettyFormatter, Serializer};

const PLATE: &str = include_str!("../scenes/plate.toml");
const DROP: &str = include_str!("../scenes/drop.toml");
const IMPACT: &str = include_str!("../scenes/impact.toml");
const FILAMENT: &str = include_str!("../scenes/filament.toml");
const LATTICE: &str = include_str!("../scenes/lattice.toml");
const CONCRETE: &str = include_str!("../scenes/concrete.toml");

/// A section, a scene with a place in it that takes the section's keys, what stands there, what
/// stands there with a key that there is not, and keys that choose the section's type.
type Section = (&'static str, &'static str, &'static str, &'static str, &'static [&'static str]);

const SECTIONS: [Section; 69] = [
    ("The whole", PLATE, "stop_time =", "zz = 1\nstop_time =", &[]),
    ("`fidelity`", PLATE, "level =", "zz = 1\nlevel =", &[]),
    ("`solver`", PLATE, "stop_time =", "solver = { zz = 1 }\nstop_time =", &[]),
    (
        "`[refinement.BODY]`",
        PLATE,
        "stop_time =",
        "refinement = { plate = { zz = 1 } }\nstop_time =",
        &[],
    ),
    (
        "`[resolved.BODY]`",
        PLATE,
        "stop_time =",
        "resolved = { plate = { zz = 1 } }\nstop_time =",
        &[],
    ),
    (
        "`[body.NAME]` of a solid",
        PLATE,
        "initial_temperature",
        "zz = 1\ninitial_temperature",
        &["kind"],
    ),
    ("`shape` of a solid", IMPACT, "shape = {", "shape = { zz = 1, aa = 1 } # {", &[]),
    ("`shape.disc`", IMPACT, "shape = {", "shape = { disc = { zz = 1 } } # {", &[]),
    (
        "`material` of a solid",
        PLATE,
        "\"thermoelastic\"",
        "\"viscoplastic\", zz = 1",
        &[
            "model",
            "substance",
            "at",
            "hardening",
            "shear_relaxation",
            "bulk_relaxation",
            "shift",
            "kcc",
        ],
    ),
    (
        "`melting` of a material",
        PLATE,
        "density = 3950.0",
        "density = 3950.0, melting = { zz = 1 }",
        &[],
    ),
    (
        "`creep` of a material",
        PLATE,
        "\"thermoelastic\"",
        "\"viscoplastic\", creep = { zz = 1 }",
        &[],
    ),
    (
        "`hardening` of a material",
        PLATE,
        "\"thermoelastic\"",
        "\"elastoplastic\", hardening = { zz = 1 }",
        &[],
    ),
    (
        "`shear_relaxation` of a material",
        PLATE,
        "\"thermoelastic\"",
        "\"viscoelastic\", shear_relaxation = [{ zz = 1 }]",
        &[],
    ),
    ("`kcc` of a material", CONCRETE, "dilatancy =", "zz = 1\ndilatancy =", &[]),
    ("`strength` of `kcc`", CONCRETE, "strength = { a0", "strength = { zz = 1, a0", &[]),
    ("`residual` of `kcc`", CONCRETE, "residual = {", "residual = { zz = 1,", &[]),
    ("`damage` of `kcc`", CONCRETE, "damage = {", "damage = { zz = 1,", &[]),
    ("`compaction` of `kcc`", CONCRETE, "dilatancy =", "compaction = { zz = 1 }\ndilatancy =", &[]),
    ("`meridians` of `kcc`", CONCRETE, "dilatancy =", "meridians = { zz = 1 }\ndilatancy =", &[]),
    (
        "`shift` of a material",
        PLATE,
        "\"thermoelastic\"",
        "\"viscoelastic\", shear_relaxation = [], shift = { law = \"wlf\", zz = 1 }",
        &["law", "activation_energy"],
    ),
    (
        "`weibull` of a material",
        PLATE,
        "density = 3950.0",
        "density = 3950.0, weibull = { zz = 1 }",
        &[],
    ),
    (
        "`slow_growth` of `weibull`",
        PLATE,
        "density = 3950.0",
        "density = 3950.0, weibull = { modulus = 5.0, strength = 1e8, area = 1.0, slow_growth = { zz = 1 } }",
        &[],
    ),
    (
        "`fracture` of a material",
        PLATE,
        "density = 3950.0",
        "density = 3950.0, fracture = { zz = 1 }",
        &[],
    ),
    ("`layers` of a solid", PLATE, "material = {", "layers = [{ zz = 1 }] # {", &[]),
    ("`sph` of a solid", PLATE, "heat = \"fem\"", "heat = \"sph\"\nsph = { zz = 1 }", &[]),
    ("`mesh` of a solid", PLATE, "mesh = {", "mesh = { zz = 1,", &[]),
    ("`faces.FACE` of a solid", PLATE, "sides = {", "sides = { zz = 1,", &[]),
    (
        "`faces.FACE.convection` of a solid",
        PLATE,
        "[body.plate.faces]",
        "[body.plate.faces]\ntop = { convection = { zz = 1 } }",
        &[],
    ),
    (
        "`faces.FACE.radiation` of a solid",
        PLATE,
        "[body.plate.faces]",
        "[body.plate.faces]\ntop = { radiation = { zz = 1 } }",
        &[],
    ),
    (
        "`bath` of a solid",
        PLATE,
        "initial_temperature",
        "bath = { zz = 1 }\ninitial_temperature",
        &[],
    ),
    (
        "`notches` of a solid",
        PLATE,
        "initial_temperature",
        "notches = [{ zz = 1 }]\ninitial_temperature",
        &[],
    ),
    (
        "`[body.NAME]` of a solid of large strain",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nzz = 1\n[body.plate]",
        &["kind"],
    ),
    (
        "`start` of a solid of large strain",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nstart = { zz = 1 }\n[body.plate]",
        &[],
    ),
    (
        "`mesh` of a solid of large strain",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nmesh = { zz = 1 }\n[body.plate]",
        &[],
    ),
    (
        "`rkpm` of a solid of large strain",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nrkpm = { zz = 1 }\n[body.plate]",
        &[],
    ),
    (
        "`sph` of a solid of large strain",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nsph = { zz = 1 }\n[body.plate]",
        &[],
    ),
    (
        "`shape.ball`",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nshape = { ball = { zz = 1 } }\n[body.plate]",
        &[],
    ),
    (
        "`shape.quadrilateral`",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nshape = { quadrilateral = { zz = 1 } }\n[body.plate]",
        &[],
    ),
    (
        "`shape.strand`",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nshape = { strand = { zz = 1 } }\n[body.plate]",
        &[],
    ),
    (
        "`shape.part`",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nshape = { part = { zz = 1 } }\n[body.plate]",
        &[],
    ),
    (
        "`faces.FACE` of a solid of large strain",
        PLATE,
        "[body.plate]",
        "[body.gel]\nkind = \"solid\"\nstrain = \"finite\"\nfaces = { top = { zz = 1 } }\n[body.plate]",
        &[],
    ),
    ("`[body.NAME]` of a droplet", DROP, "diameter =", "zz = 1\ndiameter =", &["kind"]),
    ("`fluid` of a droplet", DROP, "fluid = {", "fluid = { zz = 1,", &[]),
    (
        "`evaporation` of a fluid",
        DROP,
        "viscosity = 1e-3",
        "viscosity = 1e-3, evaporation = { zz = 1 }",
        &[],
    ),
    ("`frozen` of a fluid", DROP, "viscosity = 1e-3", "viscosity = 1e-3, frozen = { zz = 1 }", &[]),
    (
        "`arrhenius` of a viscosity",
        DROP,
        "viscosity = 1e-3",
        "viscosity = { law = \"newtonian\", value = 1e-3, arrhenius = { zz = 1 } }",
        &[],
    ),
    ("`arrivals` of a droplet", DROP, "arrivals = [{", "arrivals = [{ zz = 1,", &[]),
    ("`record` of a droplet", DROP, "gravity = 9.81", "record = { zz = 1 }", &[]),
    ("`[body.NAME]` of a filament", FILAMENT, "spacing =", "zz = 1\nspacing =", &["kind"]),
    ("`nozzle` of a filament", FILAMENT, "nozzle = {", "nozzle = { zz = 1,", &[]),
    ("`path` of a filament", FILAMENT, "path = {", "path = { zz = 1,", &[]),
    (
        "`path` of a filament by G-code",
        FILAMENT,
        "time = [0.0, 1.0, 2.0], x = [-5e-3, 5e-3, 5e-3], y = [0.0, 0.0, 4e-3]",
        "file = \"a.gcode\", zz = 1",
        &[],
    ),
    ("`[body.NAME]` of a lattice", LATTICE, "spacing =", "zz = 1\nspacing =", &["kind"]),
    ("`material` of a lattice", LATTICE, "density =", "zz = 1\ndensity =", &[]),
    ("`softening` of a lattice", LATTICE, "softening = {", "softening = { zz = 1,", &[]),
    ("`notch` of a lattice", LATTICE, "notch = {", "notch = { zz = 1,", &[]),
    (
        "`support.three_point` of a lattice",
        LATTICE,
        "three_point = {",
        "three_point = { zz = 1,",
        &[],
    ),
    ("`[[target]]`", FILAMENT, "[[target]]", "[[target]]\nzz = 1", &[]),
    (
        "`[body.NAME]` of a reservoir",
        PLATE,
        "[body.plate]",
        "[body.chuck]\nkind = \"reservoir\"\nzz = 1\n[body.plate]",
        &["kind"],
    ),
    ("`[[load]]`", PLATE, "[[load]]", "[[load]]\nzz = 1", &[]),
    ("`footprint` of a load or wall", DROP, "rings =", "zz =", &[]),
    ("`start` of a load", PLATE, "start = {", "start = { zz = 1,", &[]),
    ("`range` of a load", PLATE, "carries =", "range = { zz = 1 }\ncarries =", &[]),
    ("`[[probe]]`", PLATE, "[[probe]]", "[[probe]]\nzz = 1", &[]),
    ("`[[flaw]]`", PLATE, "[[probe]]", "[[flaw]]\nzz = 1\n[[probe]]", &[]),
    ("`growth` of a flaw", PLATE, "[[probe]]", "[[flaw]]\ngrowth = { zz = 1 }\n[[probe]]", &[]),
    ("`[[field]]`", PLATE, "[[probe]]", "[[field]]\nzz = 1\n[[probe]]", &[]),
    ("`[[wall]]`", DROP, "[[wall]]", "[[wall]]\nzz = 1", &[]),
    ("`start` of a wall", DROP, "start = {", "start = { zz = 1,", &[]),
];

const PAGE: &str = "docs/scene.md";
const SCHEMA_FILE: &str = "docs/scene.schema.json";

fn reference() -> String {
    fs::read_to_string(PAGE).unwrap()
}

/// Whether what is checked in is written instead of compared.
fn writes() -> bool {
    env::var_os("WRITE_REFERENCE").is_some()
}

/// The schema that follows from the types, as it is checked in.
fn schema_text() -> String {
    let mut text = Vec::new();
    let formatter = PrettyFormatter::with_indent(b" ");
    derived_schema().serialize(&mut Serializer::with_formatter(&mut text, formatter)).unwrap();
    String::from_utf8(text).unwrap() + "\n"
}

#[test]
fn the_schema_follows_from_the_types() {
    let text = schema_text();
    if writes() {
        fs::write(SCHEMA_FILE, &text).unwrap();
    } else {
        let same = text.lines().zip(SCHEMA.lines()).position(|(new, old)| new != old);
        let line = same.map_or(text.lines().count().min(SCHEMA.lines().count()), |line| line) + 1;
        assert!(
            text == SCHEMA,
            "{SCHEMA_FILE}:{line} is not what follows; WRITE_REFERENCE=1 writes it"
        );
    }
}

/// The page with the table of each section in place of the one that stands there.
fn with_tables(page: &str, schema: &Value) -> String {
    let mut sections = page.split("\n## ").map(str::to_owned).collect::<Vec<_>>();
    for (heading, pointer) in tables::SECTIONS {
        let section = sections.iter_mut().find(|text| text.lines().next() == Some(heading));
        let section = section.unwrap_or_else(|| panic!("no section {heading}"));
        let is_row = |line: &&str| line.starts_with("| ") || line.starts_with("|-");
        let old: String = section.split_inclusive('\n').filter(is_row).collect();
        assert!(section.contains(&old), "the table of {heading} is in parts");
        *section = section.replace(&old, &tables::table(schema, pointer));
    }
    assert_eq!(sections.len(), tables::SECTIONS.len() + 1, "a section has no table");
    sections.join("\n## ")
}

#[test]
fn the_tables_follow_from_the_schema() {
    let schema = serde_json::from_str(&schema_text()).unwrap();
    let page = reference();
    let wanted = with_tables(&page, &schema);
    if writes() {
        fs::write(PAGE, wanted).unwrap();
    } else {
        for (line, (new, old)) in wanted.lines().zip(page.lines()).enumerate() {
            assert_eq!(new, old, "{PAGE}:{}; WRITE_REFERENCE=1 writes it", line + 1);
        }
        assert_eq!(wanted.len(), page.len());
    }
}

/// Every description that names a unit names the one that the key has.
#[test]
fn descriptions_name_the_units_of_their_keys() {
    fn look(schema: &Value, wrong: &mut Vec<String>) {
        let text = |key: &str| schema.get(key).and_then(Value::as_str);
        if let (Some(unit), Some(description)) = (text("unit"), text("description")) {
            // What stands between backticks is code.
            let words: String = description.split('`').step_by(2).collect();
            let mut named = words.split(" [").skip(1).filter_map(|rest| rest.split_once(']'));
            if named.any(|(named, _)| named != unit) {
                wrong.push(format!("{description} ({unit})"));
            }
        }
        match schema {
            Value::Object(parts) => parts.values().for_each(|part| look(part, wrong)),
            Value::Array(parts) => parts.iter().for_each(|part| look(part, wrong)),
            _ => {}
        }
    }
    let mut wrong = Vec::new();
    look(&serde_json::from_str(SCHEMA).unwrap(), &mut wrong);
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// The text below a heading of the reference.
fn section<'a>(text: &'a str, heading: &str) -> &'a str {
    let mut sections = text.split("\n## ").skip(1);
    let found = sections.find(|section| section.lines().next() == Some(heading));
    found.unwrap_or_else(|| panic!("no section {heading}"))
}

/// The keys in the first column of a section's table.
fn documented(section: &str) -> BTreeSet<String> {
    let key = |line: &str| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned());
    section.lines().filter_map(key).collect()
}

/// The keys that the parser offers in place of an unknown one.
fn known(scene: &str, from: &str, to: &str) -> BTreeSet<String> {
    let text = scene.replacen(from, to, 1);
    assert_ne!(text, scene, "{from:?} does not occur");
    let error = parse(&text, "scene.toml").expect_err("a key that there is not was accepted");
    let mut lists = error.problems.iter().filter(|problem| {
        let of_key = problem.message.contains("`zz`") || problem.value.contains("zz");
        of_key && (problem.message.contains("`zz`") || problem.allowed.contains(", "))
    });
    let problem = lists.next_back().unwrap_or_else(|| panic!("{error}"));
    let allowed = problem.allowed.strip_prefix("one of ").unwrap_or(&problem.allowed);
    allowed.split(", ").map(str::to_owned).collect()
}

#[test]
fn the_reference_has_every_key_and_no_other() {
    let text = reference();
    let coupling = ("`[[coupling]]`", IMPACT, "[[coupling]]", "[[coupling]]\nzz = 1", &[][..]);
    for (heading, scene, from, to, tags) in SECTIONS.into_iter().chain([coupling]) {
        let mut keys = known(scene, from, to);
        keys.extend(tags.iter().map(|tag| tag.to_string()));
        assert_eq!(documented(section(&text, heading)), keys, "{heading}");
    }
    let of_laws = "`viscosity` of a fluid";
    let keys = FluidLaw::NAMES.iter().flat_map(|law| {
        let table = format!("viscosity = {{ law = \"{law}\", zz = 1 }}");
        known(DROP, "viscosity = 1e-3", &table)
    });
    let keys: BTreeSet<String> = keys.chain(["law".to_owned()]).collect();
    assert_eq!(documented(section(&text, of_laws)), keys);
    assert_eq!(text.matches("\n## ").count(), SECTIONS.len() + 2, "a section is not compared");
}

#[test]
fn every_row_says_unit_meaning_default_and_range() {
    for line in reference().lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        assert!(cells.len() == 5 && !cells[2].is_empty(), "{line}");
    }
}

#[test]
fn the_example_is_a_scene() {
    let text = reference();
    let example = text.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    parse(example, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
}
