//! `docs/scene.md` has every key that a scene may have, and no other.

use std::collections::BTreeSet;
use std::fs;

use impinge::scene::parse;

const PLATE: &str = include_str!("../scenes/plate.toml");
const DROP: &str = include_str!("../scenes/drop.toml");
const IMPACT: &str = include_str!("../scenes/impact.toml");

/// A section, a scene with a place in it that takes the section's keys, what stands there, what
/// stands there with a key that there is not, and keys that choose the section's type.
type Section = (&'static str, &'static str, &'static str, &'static str, &'static [&'static str]);

const SECTIONS: [Section; 27] = [
    ("The whole", PLATE, "stop_time =", "zz = 1\nstop_time =", &[]),
    ("`fidelity`", PLATE, "level =", "zz = 1\nlevel =", &[]),
    ("`solver`", PLATE, "stop_time =", "solver = { zz = 1 }\nstop_time =", &[]),
    (
        "`[body.NAME]` of a solid",
        PLATE,
        "initial_temperature",
        "zz = 1\ninitial_temperature",
        &["kind"],
    ),
    ("`shape` of a solid", IMPACT, "shape = {", "shape = { zz = 1, aa = 1 } # {", &[]),
    ("`shape.disc`", IMPACT, "shape = {", "shape = { disc = { zz = 1 } } # {", &[]),
    ("`material` of a solid", PLATE, "density = 3950.0", "density = 3950.0, zz = 1", &["model"]),
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
        "density = 3950.0",
        "density = 3950.0, creep = { zz = 1 }",
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
    ("`[body.NAME]` of a droplet", DROP, "diameter =", "zz = 1\ndiameter =", &["kind"]),
    ("`fluid` of a droplet", DROP, "fluid = {", "fluid = { zz = 1,", &[]),
    ("`arrivals` of a droplet", DROP, "arrivals = [{", "arrivals = [{ zz = 1,", &[]),
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
    ("`[[field]]`", PLATE, "[[probe]]", "[[field]]\nzz = 1\n[[probe]]", &[]),
    ("`[[wall]]`", DROP, "[[wall]]", "[[wall]]\nzz = 1", &[]),
    ("`start` of a wall", DROP, "start = {", "start = { zz = 1,", &[]),
];

fn reference() -> String {
    fs::read_to_string("docs/scene.md").unwrap()
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
    assert_eq!(text.matches("\n## ").count(), SECTIONS.len() + 1, "a section is not compared");
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
