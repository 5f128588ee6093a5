//! Cracks that run: strength, energy and place, sections against bodies without cracks, states, and warnings.

use impinge::advice::parse_with_warnings;
use impinge::model::tolerance::estimates;

use crate::common::{Trial, off};

const YOUNG: f64 = 340e9;
const EXPANSION: f64 = 8e-6;
const START: f64 = 600.0;

/// A material that cracks at 300 MPa, with keys of its `fracture`.
fn alumina(fracture: &str) -> String {
    format!(
        "material = {{ model = \"thermoelastic\", density = 3980.0, specific_heat = 880.0, conductivity = 31.0, \
         young = {YOUNG}, poisson = 0.22, expansion = {EXPANSION}{fracture} }}"
    )
}

fn scene(shape: &str, material: &str, faces: &str, more: &str) -> String {
    format!(
        "name = \"Cracks\"\nstop_time = 10.0\nstep = 1.0\n[body.plate]\nkind = \"solid\"\n{shape}\n\
         initial_temperature = {START}\n{material}\n[body.plate.faces]\n{faces}\n{more}\n"
    )
}

const STRIP: &str = "shape = { box = [1e-3, 1e-3, 0.4e-3] }\nsection = \"plane_stress\"";
const HELD: &str = "left = { roller = true }\nright = { roller = true }\n\
                    bottom = { temperature = 600.0, roller = true }\ntop = { temperature = 600.0 }";
const AT1: &str =
    ", fracture = { model = \"at1\", strength = 300e6, energy = 45.0, scatter = 0.04 }";

/// A strip between rollers, and the drop of temperature that stresses it to a part of its strength [K].
fn held_strip() -> (Trial, impl Fn(f64) -> f64) {
    // Its weakest place is far from the rollers, which would cut the profile of the crack.
    let fracture = AT1.replace("scatter = 0.04", "scatter = 0.04, seed = 1");
    let trial = Trial::new(&scene(STRIP, &alumina(&fracture), HELD, ""));
    (trial, |part| part * 300e6 / (YOUNG * EXPANSION))
}

fn cool(trial: &mut Trial, drop: f64) {
    trial.set("plate.top.temperature", START - drop);
    trial.set("plate.bottom.temperature", START - drop);
    trial.step(1.0);
}

#[test]
fn notched_strip_breaks_at_its_notch() {
    let notch = format!("{STRIP}\nnotches = [{{ from = [0.2e-3, 0.0], to = [0.2e-3, -0.15e-3] }}]");
    let probe = |name: &str, x: f64| {
        format!(
            "[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = [{x}, 0.0, -0.3e-3]\ngives = [\"damage\"]\n"
        )
    };
    let probes = probe("below", 0.2e-3) + &probe("far", -0.2e-3);
    let mut trial = Trial::new(&scene(&notch, &alumina(AT1), HELD, &probes));
    assert_eq!(trial.get("plate.max_damage"), 1.0);
    assert_eq!(trial.get("plate.crack_count"), 1.0);
    let depth = trial.get("plate.crack_depth");
    assert!((0.15e-3..0.18e-3).contains(&depth), "{depth}");
    let lengths = ["plate.crack_length", "plate.crack_growth"].map(|name| trial.get(name));
    assert!(off(lengths[0], 0.15e-3) < 1e-12 && lengths[1] == 0.0, "{lengths:?}");
    assert_eq!(trial.get("plate.elastic_energy"), 0.0);
    let drop = |part: f64| part * 300e6 / (YOUNG * EXPANSION);
    cool(&mut trial, drop(0.05));
    assert_eq!(FIRST.map(|name| trial.get(name)), [0.0; 3]);
    assert_eq!(trial.get("plate.crack_growth"), 0.0);
    cool(&mut trial, drop(0.75));
    assert!(trial.get("below.damage") > 0.9);
    assert!(trial.get("far.damage") < 0.1);
    assert_eq!(trial.get("plate.crack_count"), 1.0);
    let time = trial.get("plate.first_crack_time");
    assert!(time > 1.0 && time <= 2.0, "{time}");
    // The whole strip breaks within a step, from the end of the notch on.
    let [_, x, z] = FIRST.map(|name| trial.get(name));
    assert!((x - 0.2e-3).abs() < 0.05e-3 && (-0.22e-3..-0.14e-3).contains(&z), "{x} {z}");
    let length = trial.get("plate.crack_length");
    assert!(off(length, 0.4e-3) < 0.03, "{length}");
    assert!(off(trial.get("plate.crack_growth"), length - 0.15e-3) < 1e-9);
}

/// A crack in the plane of symmetry breaks one row of elements, half of which is meshed, and costs as much as elsewhere.
#[test]
fn cracks_in_the_plane_of_symmetry_cost_what_others_do() {
    let law = ", fracture = { model = \"at1\", strength = 300e6, energy = 45.0 }";
    let run = |symmetry: &str| {
        let notch = "notches = [{ from = [0.0, 0.0], to = [0.0, -0.15e-3] }]";
        let shape = format!("{STRIP}\nsymmetry = \"{symmetry}\"\n{notch}");
        let mut trial = Trial::new(&scene(&shape, &alumina(law), HELD, ""));
        [0.05, 0.75].map(|part| {
            cool(&mut trial, part * 300e6 / (YOUNG * EXPANSION));
            ["dissipated_energy", "crack_length"].map(|name| trial.get(&format!("plate.{name}")))
        })
    };
    let [[start, at_rest], [dissipated, length]] = run("quarter");
    let [[whole_start, _], [whole, _]] = run("none");
    assert!(off(start, whole_start) < 0.02, "{start} J, {whole_start} J of the whole");
    assert!(off(dissipated, whole) < 0.02, "{dissipated} J, {whole} J of the whole");
    assert!(off(at_rest, 0.15e-3) < 1e-12 && off(length, 0.4e-3) < 0.03, "{at_rest} {length}");
}

/// Time and place of the first crack.
const FIRST: [&str; 3] = ["plate.first_crack_time", "plate.first_crack_x", "plate.first_crack_z"];

/// Damage around the ends of a notch is as long as 1.6 ℓ, and stays when it does not grow.
#[test]
fn notches_at_rest_have_their_length() {
    // Ten elements of a third of ℓ within the strip; one that leans, from an edge.
    let within = ("{ from = [-0.1e-3, -0.2e-3], to = [0.1125e-3, -0.2e-3] }", 0.2125e-3);
    let leans = ("{ from = [-0.3e-3, 0.0], to = [-0.2e-3, -0.1e-3] }", 0.1e-3 * 2.0_f64.sqrt());
    // The first in two parts that lie on each other.
    let twice = (
        "{ from = [-0.1e-3, -0.2e-3], to = [0.05e-3, -0.2e-3] }, { from = [0.1125e-3, -0.2e-3], to = [0.0, -0.2e-3] }",
        0.2125e-3,
    );
    for (notches, wanted) in [within, leans, twice] {
        let shape = format!("{STRIP}\nnotches = [{notches}]");
        let mut trial = Trial::new(&scene(&shape, &alumina(AT1), HELD, ""));
        for part in [0.0, 0.1, 0.2] {
            cool(&mut trial, part * 300e6 / (YOUNG * EXPANSION));
            let names = ["plate.crack_length", "plate.crack_growth", "plate.crack_area"];
            let [length, growth, area] = names.map(|name| trial.get(name));
            assert!(off(length, wanted) < 1e-12 && growth == 0.0, "{length} {growth} {wanted}");
            assert!(off(area, wanted * 1e-3) < 1e-12, "{area}");
        }
    }
}

#[test]
fn held_strip_breaks_at_its_strength() {
    let (mut trial, drop) = held_strip();
    cool(&mut trial, drop(0.95));
    let volume = 1e-3 * 1e-3 * 0.4e-3;
    let stress = 0.95 * 300e6;
    let elastic = 0.5 * stress * stress / YOUNG * volume;
    assert_eq!(trial.get("plate.max_damage"), 0.0);
    assert_eq!(trial.get("plate.first_crack_time"), 0.0);
    assert!(off(trial.get("plate.elastic_energy"), elastic) < 1e-3);
    assert!(off(trial.get("plate.mechanical_work"), elastic) < 1e-3);
    assert!(off(trial.get("plate.max_principal"), stress) < 1e-3);
    cool(&mut trial, drop(1.04));
    assert!(trial.get("plate.max_damage") > 0.99);
    let length = trial.get("plate.crack_length");
    assert!(off(length, 0.4e-3) < 0.02, "{length}");
    assert!(off(trial.get("plate.crack_area"), length * 1e-3) < 1e-12);
    assert!(off(trial.get("plate.dissipated_energy"), 45.0 * length * 1e-3) < 1e-12);
    assert!(trial.get("plate.elastic_energy") < 0.05 * elastic);
    assert_eq!(trial.get("plate.crack_count"), 1.0);
    let first = trial.get("plate.first_crack_time");
    assert!(first > 1.0 && first <= 2.0, "{first}");
    // Damage at the place of the first crack is that of a crack.
    let [x, z] = [FIRST[1], FIRST[2]].map(|name| trial.get(name));
    let probe = format!(
        "[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [{x:e}, 0.0, {z:e}]\ngives = [\"damage\"]\n"
    );
    let fracture = AT1.replace("scatter = 0.04", "scatter = 0.04, seed = 1");
    let mut again = Trial::new(&scene(STRIP, &alumina(&fracture), HELD, &probe));
    cool(&mut again, drop(0.95));
    cool(&mut again, drop(1.04));
    assert!(again.get("p.damage") > 0.9, "{x} {z}");
    // Its time is last in the state, after the time since the start and its place.
    trial.model.check_state(&trial.state).unwrap();
    for wrong in [-1.0, 2.5] {
        let mut state = trial.state.clone();
        *state.bodies[0].last_mut().unwrap() = wrong;
        let refusal = trial.model.check_state(&state).unwrap_err().to_string();
        assert!(refusal.contains("a first crack at"), "{refusal}");
    }
    let mut state = trial.state.clone();
    let length = state.bodies[0].len();
    state.bodies[0][length - 2] = 1e-3;
    let refusal = trial.model.check_state(&state).unwrap_err().to_string();
    assert!(refusal.contains("a first crack at ["), "{refusal}");
    let depth = trial.get("plate.crack_depth");
    assert!(off(depth, 0.4e-3) < 1e-9, "{depth}");
}

/// A strip on its own, which cold from above and below bends by itself, under a pull from the top.
#[test]
fn what_is_torn_off_is_warned_of() {
    let held = HELD.replace("top = { temperature = 600.0 }", "");
    let pull = "[[load]]\nname = \"pull\"\non = \"plate.top\"\ncarries = [\"pressure\"]\n\
                footprint = { tiles = { count = [1, 1], size = [1e-3, 1e-3] } }";
    let mut trial = Trial::new(&scene(STRIP, &alumina(AT1), &held, pull));
    let ids = |trial: &Trial| -> Vec<&str> {
        let found = trial.model.warnings(&trial.state);
        found.iter().map(|warning| warning.finding().id).collect()
    };
    trial.set("pull.pressure[1,1]", -250e6);
    trial.step(1.0);
    assert_eq!(ids(&trial), [""; 0]);
    trial.set("pull.pressure[1,1]", -330e6);
    trial.step(1.0);
    assert_eq!(ids(&trial), ["torn_apart"]);
}

/// Warnings at the end of a run of a strip that cools until it breaks, in small steps.
fn warnings_of_broken_strip(fracture: &str) -> Vec<&'static str> {
    let mut trial = Trial::new(&scene(STRIP, &alumina(fracture), HELD, ""));
    for part in [0.9, 1.01, 1.02, 1.03, 1.05, 1.1, 1.2] {
        cool(&mut trial, part * 300e6 / (YOUNG * EXPANSION));
    }
    assert!(trial.get("plate.max_damage") > 0.99);
    let found = trial.model.closing_warnings(&trial.state);
    found.iter().map(|warning| warning.finding().id).collect()
}

#[test]
fn even_damage_is_warned_of_even_after_a_crack() {
    let even = AT1.replace(", scatter = 0.04", "");
    let mut trial = Trial::new(&scene(STRIP, &alumina(&even), HELD, ""));
    // In one step from nothing, rounding would single out a crack.
    for part in [0.95, 1.04] {
        cool(&mut trial, part * 300e6 / (YOUNG * EXPANSION));
    }
    let found = trial.model.closing_warnings(&trial.state);
    let ids: Vec<_> = found.iter().map(|warning| warning.finding().id).collect();
    assert_eq!(ids, ["damage_is_even"]);
    assert_eq!(warnings_of_broken_strip(&even), ["damage_is_even"]);
    assert_eq!(warnings_of_broken_strip(AT1), [""; 0]);
}

/// A body far from breaking, cooled from the top.
fn uneven(shape: &str, faces: &str, fracture: &str, more: &str) -> Trial {
    let mut trial = Trial::new(&scene(shape, &alumina(fracture), faces, more));
    trial.set("plate.top.temperature", START - 20.0);
    trial.step(2e-3);
    trial
}

const STRONG: &str = ", fracture = { model = \"at1\", length = 60e-6, energy = 15e3 }";
const PROBE: &str = "[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [1e-4, 0.0, -1e-4]\n\
                     gives = [\"stress\", \"displacement\", \"temperature\"]";

/// Largest difference of readings over the largest stress, displacement and change of temperature.
fn difference(one: &mut Trial, other: &mut Trial, names: [&[&str]; 3]) -> f64 {
    let mut of_kind = |names: &[&str], base: f64| {
        let pairs = names.iter().map(|name| [one.get(name), other.get(name)]);
        let pairs: Vec<_> = pairs.collect();
        let largest = pairs.iter().map(|pair| (pair[1] - base).abs()).fold(0.0, f64::max);
        pairs.iter().map(|[a, b]| (a - b).abs()).fold(0.0, f64::max) / largest
    };
    let parts = [of_kind(names[0], 0.0), of_kind(names[1], 0.0), of_kind(names[2], START)];
    parts.into_iter().fold(0.0, f64::max)
}

#[test]
fn intact_section_is_the_box_between_rollers() {
    let faces =
        "top = { temperature = 600.0 }\nbottom = { roller = true }\nleft = { roller = true }";
    let shape = "shape = { box = [1e-3, 0.5e-3, 0.4e-3] }";
    let section = format!("{shape}\nsection = \"plane_strain\"");
    let walls = format!("{faces}\nfront = {{ roller = true }}\nback = {{ roller = true }}");
    let whole = format!("{shape}\nsymmetry = \"none\"\nmesh = {{ spacing = 20e-6 }}");
    let mut section = uneven(&section, faces, STRONG, PROBE);
    let mut whole = uneven(&whole, &walls, "", PROBE);
    let names: [&[&str]; 3] = [
        &["p.stress_xx", "p.stress_yy", "p.stress_zz", "p.stress_xz", "p.stress_xy"],
        &["p.displacement_x", "p.displacement_y", "p.displacement_z"],
        &["p.temperature"],
    ];
    let found = difference(&mut section, &mut whole, names);
    assert!(found < 0.02, "{found}");
    assert_eq!(section.get("plate.max_damage"), 0.0);
}

#[test]
fn intact_disc_is_the_disc_that_does_not_crack() {
    let faces = "top = { temperature = 600.0 }\nbottom = { roller = true }";
    let shape = "shape = { disc = { radius = 0.6e-3, thickness = 0.4e-3 } }";
    let mut cracking = uneven(shape, faces, STRONG, PROBE);
    let mut usual = uneven(&format!("{shape}\nmesh = {{ spacing = 20e-6 }}"), faces, "", PROBE);
    let names: [&[&str]; 3] = [
        &["p.stress_xx", "p.stress_yy", "p.stress_zz", "p.stress_xz"],
        &["p.displacement_x", "p.displacement_z"],
        &["p.temperature"],
    ];
    let found = difference(&mut cracking, &mut usual, names);
    assert!(found < 0.02, "{found}");
}

#[test]
fn states_and_threads_leave_no_bit_changed() {
    let text = scene(STRIP, &alumina(AT1), HELD, "");
    let drop = |part: f64| part * 300e6 / (YOUNG * EXPANSION);
    let parts = [0.9, 1.04];
    let run = |threads: usize, restarts: bool| {
        let mut trial = Trial::on_threads(&text, threads);
        for part in parts {
            if restarts {
                let saved = trial.state.clone();
                cool(&mut trial, drop(part));
                trial.restart(&saved);
            }
            cool(&mut trial, drop(part));
        }
        ["plate.crack_length", "plate.mechanical_work", "plate.max_principal"]
            .map(|name| trial.get(name).to_bits())
    };
    let usual = run(1, false);
    assert_eq!(run(3, false), usual);
    assert_eq!(run(1, true), usual);
}

#[test]
fn damage_never_heals_and_closed_cracks_bear_pressure() {
    let (mut trial, drop) = held_strip();
    cool(&mut trial, drop(1.04));
    let area = trial.get("plate.crack_area");
    assert!(trial.get("plate.max_damage") > 0.99);
    cool(&mut trial, -drop(1.0));
    assert!(trial.get("plate.crack_area") >= area);
    // As an intact strip would be stressed by the same heat.
    let stress = trial.get("plate.elastic_energy") * 2.0 * YOUNG / (1e-3 * 1e-3 * 0.4e-3);
    assert!(off(stress.sqrt(), 300e6) < 0.01, "{}", stress.sqrt());
}

/// Temperatures that jump on a face are overshot on a mesh that is as coarse as cracks allow.
#[test]
fn temperatures_of_bodies_that_crack_are_estimated() {
    let shape = "shape = { box = [1e-3, 1e-3, 1e-3] }\nsection = \"plane_strain\"";
    let law = alumina(", fracture = { model = \"at1\", length = 0.15e-3, energy = 15e3 }");
    let faces = "top = { temperature = 300.0 }\nbottom = { clamped = true }";
    let near = "[[probe]]\nname = \"near\"\nin = \"plate\"\nat = [0.0, 0.0, -5e-5]\n\
                gives = [\"temperature\"]";
    let errors = |step: f64, mesh: &str| -> f64 {
        let shape = format!("{shape}{mesh}");
        let times = format!("stop_time = {}\nstep = {step}", 10.0 * step);
        let text = scene(&shape, &law, faces, near).replace("stop_time = 10.0\nstep = 1.0", &times);
        let scene = impinge::scene::parse(&text, "scene").unwrap();
        let (_, found) = estimates(&scene);
        found[0].worst().unwrap()
    };
    let [quick, slow] = [1e-6, 1e-2].map(|step| errors(step, ""));
    assert!(quick > 0.05 && slow < 0.02, "{quick} {slow}");
    let own = errors(1e-6, "\nmesh = { spacing = 5e-5, depth_spacing = 5e-5 }");
    assert!(off(own, quick) < 1e-9, "{own} {quick}");
}

#[test]
fn damage_as_wide_as_the_body_is_warned_of() {
    let wide = alumina(", fracture = { model = \"at2\", length = 0.2e-3, energy = 15.0 }");
    let (_, warnings) = parse_with_warnings(&scene(STRIP, &wide, HELD, ""), "scene").unwrap();
    let ids: Vec<_> = warnings.iter().map(|warning| warning.finding().id).collect();
    assert_eq!(ids, ["damage_wider_than_body", "crack_peak_missed"]);
}

/// Stress in the surfaces of a strip of 0.4 mm has fallen to half its peak 0.7 ms after a shock.
#[test]
fn steps_that_miss_a_shock_are_warned_of() {
    let warned_of = |shape: &str, step: &str, faces: &str| {
        let text = scene(shape, &alumina(AT1), faces, "");
        let text = text.replace("\nstep = 1.0", &format!("\nstep = {step}"));
        let (_, warnings) = parse_with_warnings(&text, "scene").unwrap();
        warnings.iter().map(|warning| warning.finding().id).collect::<Vec<_>>()
    };
    let warned = |step: &str, faces: &str| warned_of(STRIP, step, faces);
    let slow = "top = { convection = { coefficient = 10.0, ambient = 300.0 } }\nbottom = { roller = true }\n\
                left = { roller = true }";
    assert_eq!(warned("1e-3", HELD), ["crack_peak_missed"]);
    assert_eq!(warned("5e-4", HELD), Vec::<&str>::new());
    assert_eq!(warned("1.0", slow), Vec::<&str>::new());
    let dry = "bottom = { roller = true }\nleft = { roller = true, flux = 0.0 }";
    // Biot numbers 16 000 and 0.16 through its thickness of 1 mm, and 0.08.
    let uneven = "plate_unevenly_warm";
    for (coefficient, missed) in
        [(1e6, &[uneven, "crack_peak_missed"][..]), (1e4, &[uneven]), (5e3, &[])]
    {
        let dipped = format!(
            "{STRIP}\nbath = {{ coefficient = {coefficient:e}, ambient = 300.0, speed = 1e-2 }}\n\
             mesh = {{ spacing = 2e-5, depth_spacing = 2e-5, growth = 1.0 }}"
        );
        assert_eq!(warned_of(&dipped, "1e-3", dry), missed, "{coefficient}");
        // A plane of symmetry that the bath wets.
        let wet = dry.replace(", flux = 0.0", "");
        let found = warned_of(&dipped, "1e-3", &wet);
        assert!(
            found.contains(&"bath_wets_symmetry") && found.len() == missed.len() + 1,
            "{found:?}"
        );
    }
}

/// A section on which a run takes two hours, and the strength with which it takes some ten minutes.
#[test]
fn long_runs_have_a_proposal_that_shortens_them() {
    let forecast = |strength: &str| {
        let law = alumina(&AT1.replace("300e6", strength));
        let shape = "shape = { box = [20e-3, 1e-3, 8e-3] }\nsection = \"plane_stress\"";
        let text = scene(shape, &law, HELD, "").replace("stop_time = 10.0", "stop_time = 400.0");
        let scene = impinge::scene::parse(&text, "scene").unwrap();
        let found = impinge::model::forecast(&scene);
        (found.run_time(), found.bodies[0].savings.clone())
    };
    let (long, proposal) = forecast("300e6");
    let proposal = proposal.unwrap();
    assert!(proposal.contains("`fracture.strength = 1.7e8`"), "{proposal}");
    assert!(proposal.contains("`symmetry = \"quarter\"`"), "{proposal}");
    let (short, _) = forecast("1.7e8");
    assert!(short < long / 5.0, "{short} {long}");
}
