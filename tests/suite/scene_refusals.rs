//! Scenes that make sense are read; of all others the file, line, value and what is allowed are
//! named. The refusals themselves are listed in `scenes/refusals.toml`.

use std::path::Path;

use impinge::scene::{Carries, CellValues, FaceName, Grid, Place, Scene, parse, read};
use serde::Deserialize;

const PLATE: &str = include_str!("../scenes/plate.toml");
const DISC: &str = include_str!("../scenes/disc.toml");
const TILES: &str = include_str!("../scenes/tiles.toml");
const DROP: &str = include_str!("../scenes/drop.toml");
const IMPACT: &str = include_str!("../scenes/impact.toml");
const GEL: &str = include_str!("../scenes/gel.toml");
const CONCRETE: &str = include_str!("../scenes/concrete.toml");
const FILAMENT: &str = include_str!("../scenes/filament.toml");
const LATTICE: &str = include_str!("../scenes/lattice.toml");
const CRACK: &str = include_str!("../scenes/crack.toml");
const SCENES: [(&str, &str); 10] = [
    ("plate", PLATE),
    ("disc", DISC),
    ("tiles", TILES),
    ("drop", DROP),
    ("impact", IMPACT),
    ("gel", GEL),
    ("concrete", CONCRETE),
    ("filament", FILAMENT),
    ("lattice", LATTICE),
    ("crack", CRACK),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Refusals {
    refused: Vec<Refusal>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Refusal {
    what: String,
    scene: String,
    /// Pairs of a text that occurs once in the scene and the text that stands there instead.
    edits: Vec<[String; 2]>,
    /// The whole message after `scene.toml:`.
    says: String,
}

impl Refusal {
    fn text(&self) -> String {
        let (_, scene) = SCENES.iter().find(|(name, _)| *name == self.scene).unwrap();
        self.edits.iter().fold(scene.to_string(), |text, [from, to]| edited(&text, from, to))
    }
}

/// The text with a part of it, which occurs once, replaced.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} does not occur once");
    text.replace(from, to)
}

fn accepted(text: &str) -> Scene {
    parse(text, "scene.toml").unwrap_or_else(|error| panic!("refused:\n{error}\nin\n{text}"))
}

fn refused(text: &str) -> String {
    match parse(text, "scene.toml") {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_refusal_names_file_line_value_and_what_is_allowed() {
    let table: Refusals = toml::from_str(include_str!("../scenes/refusals.toml")).unwrap();
    let mut wrong = Vec::new();
    for refusal in table.refused {
        let expected = format!("scene.toml:{}", refusal.says);
        match parse(&refusal.text(), "scene.toml") {
            Ok(_) => wrong.push(format!("{}: accepted", refusal.what)),
            Err(error) if error.to_string() != expected => {
                wrong.push(format!("{}:\n  {error}\ninstead of\n  {expected}", refusal.what));
            }
            Err(_) => {}
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn scenes_that_make_sense_are_accepted() {
    for (_, scene) in SCENES {
        accepted(scene);
    }
    let fixed = "sides = { clamped = true }";
    for sides in [
        "sides = { roller = true }\ntop = { roller = true }",
        "left = { clamped = true }\nright = { flux = 1e3 }",
        "sides = { clamped = true }\nleft = { temperature = 300.0 }",
        "sides = { flux = 0.0 }\nback = { clamped = true }",
    ] {
        accepted(&edited(PLATE, fixed, sides).replace(r#", "pressure", "shear"]"#, "]"));
    }
    for at in ["[1e-3, -1e-3, -0.26e-3]", "[0, 0, 0]", "[1.0000000001e-3, 0.0, 1e-14]"] {
        accepted(&edited(PLATE, "at = [0.0, 0.0, 0.0]", &format!("at = {at}")));
    }
    for place in ["on = \"plate.top\"", "in = \"plate\"\nplane = { z = -0.3e-3 }"] {
        accepted(&edited(DISC, "in = \"plate\"\nplane = { y = 0.0 }", place));
    }
    for symmetry in ["none", "quarter"] {
        accepted(&edited(PLATE, "\"auto\"     ", &format!("\"{symmetry}\"")));
    }
}

/// Bounds are numbers of a text, which must be read to the last digit.
#[test]
fn what_is_at_the_end_of_a_range_is_accepted() {
    for (from, ends) in [
        ("density = 3950.0", ["density = 1e-60", "density = 1e60"]),
        ("expansion = 8.1e-6", ["expansion = -1e60", "expansion = 1e60"]),
        ("poisson = 0.21", ["poisson = 0.499999999", "poisson = -0.999999999"]),
        (
            "initial_temperature = 293.15",
            ["initial_temperature = 1e-300", "initial_temperature = 1e9"],
        ),
    ] {
        for to in ends {
            accepted(&edited(PLATE, from, to));
        }
    }
    for (from, ends) in [
        ("viscosity = 1e-3", ["viscosity = 1e-9", "viscosity = 1e6"]),
        ("specific_heat = 4180.0", ["specific_heat = 0.1", "specific_heat = 1e7"]),
        ("surface_tension = 0.07", ["surface_tension = 0.0", "contact_angle = 3.141592653589793"]),
    ] {
        for to in ends {
            accepted(&edited(DROP, from, to));
        }
    }
}

#[test]
fn droplets_may_be_alone_above_walls_or_on_solids() {
    let (free, _) = DROP.split_once("[[wall]]").unwrap();
    accepted(free);
    let tiles = edited(
        DROP,
        "rings = { count = 3, radius = 2e-4 }",
        "tiles = { count = [3, 1], size = [4e-4, 4e-4] }",
    );
    let tiles = edited(&tiles, "[300.0, 301.0, 302.0]", "[[300.0], [301.0], [302.0]]");
    accepted(&edited(&tiles, "dimension = 3", "dimension = 2"));
    accepted(&edited(&tiles, "{ time = 0.0 }", "{ x = 1e-4 }"));
    accepted(&edited(DROP, ", sound_speed = 120.0", ""));
    accepted(&edited(DROP, "symmetry = \"auto\"", "symmetry = \"quarter\""));
    let disc =
        edited(IMPACT, "box = [1e-3, 1e-3, 2e-4]", "disc = { radius = 1e-3, thickness = 2e-4 }");
    let disc = edited(&disc, "{ x = 2e-4, y = -1e-4 }", "{ time = 1e-6 }");
    accepted(&disc);
    let axisymmetric = "symmetry = \"axisymmetric\"";
    accepted(&edited(&disc, "spacing = 1e-5", &format!("spacing = 1e-5\n{axisymmetric}")));
    accepted(&edited(DROP, "symmetry = \"auto\"", axisymmetric));
    accepted(&edited(free, "symmetry = \"auto\"", axisymmetric));
    let heat_alone = edited(IMPACT, "sides = { clamped = true }", "");
    let heat_alone = edited(&heat_alone, "interval = 5e-8", "traction = false");
    assert!(!accepted(&heat_alone).asks_mechanics("plate"));
    assert!(accepted(IMPACT).asks_mechanics("plate"));
}

/// Whether particles are rings, and where the drop mirrors itself.
#[test]
fn part_of_a_droplet_is_modelled_where_that_is_exact() {
    let keys = |scene: &str, keys: &str| edited(scene, "symmetry = \"auto\"", keys);
    let tiles = edited(
        DROP,
        "rings = { count = 3, radius = 2e-4 }",
        "tiles = { count = [2, 2], size = [4e-4, 4e-4] }",
    );
    let tiles = edited(&tiles, "[300.0, 301.0, 302.0]", "300.0");
    let free = DROP.split("[[wall]]").next().unwrap();
    let arrivals = "arrivals = [{ time = 0.0 }, { time = 1e-5 }]";
    let on_demand = |scene: &str| edited(scene, arrivals, "release = \"input\"\nmost = 2");
    let blue_noise = edited(DROP, "\"lattice\"", "\"blue_noise\"");
    let plane = edited(&tiles, "dimension = 3", "dimension = 2");
    let plane = edited(&plane, "[2, 2]", "[2, 1]");
    let on_box = edited(IMPACT, "{ x = 2e-4, y = -1e-4 }", "{ time = 1e-6 }");
    let on_disc =
        edited(&on_box, "box = [1e-3, 1e-3, 2e-4]", "disc = { radius = 1e-3, thickness = 2e-4 }");
    let at_angle = edited(&on_box, "spacing = 1e-5", "spacing = 1e-5\nimpact_angle = 0.5");
    let round_on_box =
        edited(&on_box, "spacing = 1e-5", "spacing = 1e-5\nsymmetry = \"axisymmetric\"");
    let recorded = edited(DROP, "method = \"sph\"", "method = \"record\"");
    let (none, both) = ([false; 2], [true; 2]);
    for (name, scene, wanted) in [
        ("above rings", DROP.to_owned(), (true, none)),
        ("above rings, on demand", on_demand(DROP), (true, none)),
        ("above rings, at random", blue_noise, (false, none)),
        ("above rings, recorded", recorded, (false, both)),
        ("above rings, a quarter", keys(DROP, "symmetry = \"quarter\""), (false, both)),
        ("above rings, whole", keys(DROP, "symmetry = \"none\""), (false, none)),
        ("above tiles", tiles.clone(), (false, both)),
        ("above tiles, on demand", on_demand(&tiles), (false, none)),
        ("above tiles, plane", plane, (false, [true, false])),
        ("free", free.to_owned(), (false, both)),
        ("free, round", keys(free, "symmetry = \"axisymmetric\""), (true, none)),
        ("on a disc", on_disc, (true, none)),
        ("on a box", on_box, (false, both)),
        ("on a box, at an angle", at_angle, (false, [false, true])),
        ("on a box, round", round_on_box, (true, none)),
        ("on a box, aside", IMPACT.to_owned(), (false, none)),
    ] {
        let scene = accepted(&scene);
        let drop = scene.droplet("drop").unwrap();
        assert_eq!((drop.is_axisymmetric(), drop.mirrors()), wanted, "{name}");
        // A scene that is written and read again is the same.
        let again = accepted(&toml::to_string(&scene).unwrap());
        assert_eq!(again, scene, "{name}");
    }
}

#[test]
fn what_a_droplet_leaves_out_is_chosen() {
    let scene = accepted(IMPACT);
    let drop = scene.droplet("drop").unwrap();
    assert_eq!((drop.gap(), drop.sound_speed()), (5e-6, 200.0));
    assert_eq!((drop.mirrors(), drop.is_centred()), ([false; 2], false));
    assert_eq!((scene.wall_under("drop"), scene.coupling_from("drop")), (None, Some(0)));
    assert!(scene.droplet("plate").is_none() && scene.solid("drop").is_none());
    // A surface's own speed √(2σ/(ρΔx)) counts where it is the fastest.
    let with_tension =
        edited(DROP, "surface_tension = 0.07, sound_speed = 120.0", "surface_tension = 0.7");
    let sound = accepted(&with_tension).droplet("drop").unwrap().sound_speed();
    assert!((sound / (10.0 * (1.4f64 / 5e-3).sqrt()) - 1.0).abs() < 1e-12, "{sound}");
    // Re = 2000 without surface tension: 0.87 · 2000^(1/5).
    assert!((drop.spread_diameter() / 1e-4 - 3.978).abs() < 1e-3);
}

#[test]
fn mechanics_needs_no_support_where_nothing_asks_for_it() {
    let free = edited(PLATE, "sides = { clamped = true }", "");
    let free = edited(&free, r#"["heat_flux", "pressure", "shear"]"#, r#"["heat_flux"]"#);
    let free = edited(&free, r#"["temperature", "stress", "displacement"]"#, r#"["temperature"]"#);
    let free = edited(&free, r#"["temperature", "von_mises"]"#, r#"["temperature"]"#);
    assert!(!accepted(&free).asks_mechanics("plate"));
    assert!(accepted(PLATE).asks_mechanics("plate"));
    assert!(!accepted(PLATE).asks_mechanics("anvil"));
}

#[test]
fn a_gaussian_may_have_its_tails_off_the_face() {
    let wide = edited(PLATE, "{ disc = { radius = 30e-6", "{ gaussian = { radius = 1e-3");
    accepted(&wide);
}

#[test]
fn what_is_read_is_what_stands_in_the_scene() {
    let scene = accepted(TILES);
    assert_eq!((scene.name.as_str(), scene.stop_time, scene.step), ("Tiled", 1.0, 0.1));
    let load = &scene.load[0];
    assert_eq!(load.body_and_face(), ("block", FaceName::Top));
    assert_eq!(load.carries, [Carries::HeatFlux, Carries::Shear]);
    let rows = vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 6.0]];
    assert_eq!(load.start.heat_flux, Some(CellValues::Tiles(rows)));
    let block = scene.solid("block").unwrap();
    assert_eq!(block.face(FaceName::Front).flux, Some(-10.0));
    let (body, place) = scene.field[0].body_and_place();
    assert_eq!((body, place), ("block", Place::Face(FaceName::Left)));
    assert_eq!(Grid::of(&scene.field[0], block).size, [2e-3, 1e-3]);
}

#[test]
fn sides_are_the_four_lateral_faces_of_a_box() {
    let heated = edited(PLATE, "bottom = { temp", "left = { flux = 2.0 }\nbottom = { temp");
    let scene = accepted(&heated);
    let plate = scene.solid("plate").unwrap();
    let left = plate.face(FaceName::Left);
    assert_eq!((left.clamped, left.flux), (true, Some(2.0)));
    let back = plate.face(FaceName::Back);
    assert_eq!((back.clamped, back.flux), (true, None));
    assert!(!plate.face(FaceName::Top).clamped);
}

#[test]
fn a_body_is_needed() {
    let empty = refused("name = 'n'\nstop_time = 1\nstep = 1\n[body]\n");
    assert_eq!(empty, "scene.toml:4: body: there is no body; allowed: [body.NAME]");
    let missing = refused("name = 'n'\nstop_time = 1\nstep = 1\n");
    assert_eq!(missing, "scene.toml:1: body: the key `body` is missing; allowed: a table");
}

#[test]
fn all_problems_are_reported_at_once() {
    let text = edited(PLATE, "density = 3950.0", "desnity = \"heavy\"");
    let text = edited(&text, "young = 300e9", "young = true");
    let text = edited(&text, "heat = \"fem\"", "heat = \"peridynamic\"");
    let text = edited(&text, "mesh = { spacing", "mesh = { spacig");
    let text = edited(&text, "carries = [\"heat_flux\", ", "carries = [\"cold_flux\", ");
    let text = edited(&text, "at = [0.0, 0.0, 0.0]", "at = [0.0, nan, 0.0]");
    let text = edited(&text, "grid = [16, 16]", "grid = 16");
    let error = parse(&text, "scene.toml").unwrap_err();
    let places: Vec<_> = error.problems.iter().map(|problem| problem.path.as_str()).collect();
    assert_eq!(
        places,
        [
            "body.plate.material.desnity",
            "body.plate.material.young",
            "body.plate.heat",
            "body.plate.mesh.spacig",
            "load[0].carries[0]",
            "probe[0].at[1]",
            "field[0].grid"
        ],
        "{error}"
    );

    let text = edited(PLATE, "poisson = 0.21", "poisson = 0.5");
    let text = edited(&text, "on = \"plate.top\"\nfoot", "on = \"plate.lid\"\nfoot");
    let text = edited(&text, "tolerance = 1e-3", "tolerance = 1.5");
    let error = parse(&text, "scene.toml").unwrap_err();
    let lines: Vec<_> = error.problems.iter().map(|problem| problem.line).collect();
    assert_eq!(lines, [Some(9), Some(20), Some(40)], "{error}");
}

/// As many as this once took minutes: their lines were counted from the beginning for each.
#[test]
fn very_many_problems_are_reported_each_with_its_line() {
    const COUNT: usize = 20_000;
    let probe = "\n[[probe]]\nname = \"centre\"\nin = \"nowhere\"\nat = [0, 0, 0]\ngives = []\n";
    let text = format!("{PLATE}{}", probe.repeat(COUNT));
    let first = PLATE.lines().count();
    let error = parse(&text, "scene.toml").unwrap_err();
    assert_eq!(error.problems.len(), 3 * COUNT);
    let last = error.problems.last().unwrap();
    assert_eq!(last.path, format!("probe[{COUNT}].gives"));
    assert_eq!(last.line, Some(first + 6 * COUNT));
}

#[test]
fn a_file_is_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes");
    assert_eq!(read(&folder.join("plate.toml")).unwrap(), accepted(PLATE));
    let missing = folder.join("nowhere.toml");
    let error = read(&missing).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}: cannot be read: ", missing.display())), "{error}");
}

#[test]
fn no_beginning_of_a_scene_is_too_short_to_be_judged() {
    for (_, scene) in SCENES {
        for (end, _) in scene.char_indices() {
            let _ = parse(&scene[..end], "scene.toml");
        }
    }
}

#[test]
fn no_damage_to_a_scene_is_too_odd_to_be_judged() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for _ in 0..1000 {
        for (_, scene) in SCENES {
            let text = damaged(scene, &mut random);
            match parse(&text, "scene.toml") {
                Ok(scene) => look_up_everything(&scene),
                Err(error) => assert!(!error.problems.is_empty() && !error.to_string().is_empty()),
            }
        }
    }
}

/// Asks a checked scene what can be asked of it.
fn look_up_everything(scene: &Scene) {
    for load in &scene.load {
        let (body, face) = load.body_and_face();
        scene.solid(body).unwrap().face(face);
    }
    for field in &scene.field {
        let (body, _) = field.body_and_place();
        let grid = Grid::of(field, scene.solid(body).unwrap());
        assert!(grid.points().flatten().all(f64::is_finite));
    }
}

/// The scene with a few bytes replaced, or a piece of it cut out and put elsewhere.
fn damaged(scene: &str, random: &mut Random) -> String {
    const BYTES: &[u8] = b"\"'[]{}=.,#-+_0159eixn \n\r\\\x00\x7f\xc3\xff";
    let mut bytes = scene.as_bytes().to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(4) {
            0 => bytes[at] = BYTES[random.below(BYTES.len())],
            1 => bytes.insert(at, BYTES[random.below(BYTES.len())]),
            2 => drop(bytes.remove(at)),
            _ => {
                let end = (at + random.below(40)).min(bytes.len());
                let piece: Vec<u8> = bytes.drain(at..end).collect();
                let to = random.below(bytes.len());
                bytes.splice(to..to, piece);
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The generator xorshift64 (G. Marsaglia, J. Stat. Softw. 8 (2003) 14).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % bound.max(1) as u64) as usize
    }
}
