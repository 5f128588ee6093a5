//! Stress intensity of flaws: against closed forms, by rows and by solutions, and what is refused and warned of.

use std::f64::consts::PI;

use closed_form::edge_crack::{edge, energy_release, penny, shocked};
use impinge::advice::parse_with_warnings;
use impinge::scene;

use crate::common::{Trial, off};

const PER_KELVIN: f64 = 340e9 * 8e-6 / 0.78;
const DIFFUSIVITY: f64 = 31.0 / (3980.0 * 880.0);

/// A plate held along the surface, that is cooled on top.
fn plate(steps: f64, mesh: &str, flaws: &str) -> String {
    let step = 0.01 / steps;
    format!(
        "name = \"Plate\"\nstop_time = 0.01\nstep = {step}\n[body.plate]\nkind = \"solid\"\n\
         shape = {{ box = [3e-3, 2e-3, 10e-3] }}\ninitial_temperature = 573.15\n\
         material = {{ model = \"thermoelastic\", density = 3980.0, specific_heat = 880.0, conductivity = 31.0, \
         young = 340e9, poisson = 0.22, expansion = 8e-6, toughness = 3.8e6 }}\n{mesh}\n[body.plate.faces]\n\
         top = {{ temperature = 536.25 }}\nsides = {{ roller = true }}\n\
         bottom = {{ temperature = 573.15, roller = true }}\n{flaws}\n"
    )
}

fn flaw(name: &str, keys: &str) -> String {
    format!(
        "[[flaw]]\nname = \"{name}\"\nin = \"plate\"\n{keys}\n\
         gives = [\"stress_intensity\", \"energy_release_rate\", \"safety\"]\n"
    )
}

fn scratch(name: &str, depth: &str) -> String {
    flaw(name, &format!("at = [1e-4, -3e-4, 0.0]\nnormal = [1.0, 0.5, 0.0]\ndepth = {depth}"))
}

/// `√(κt)` at the end [m].
fn diffusion() -> f64 {
    (DIFFUSIVITY * 0.01).sqrt()
}

#[test]
fn shocked_edge_cracks_have_the_intensity_of_the_half_plane() {
    let depths = [0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0];
    let flaws = depths
        .iter()
        .enumerate()
        .map(|(i, own)| scratch(&format!("s{i}"), &format!("{:e}", own * diffusion())));
    let flaws: String = flaws.chain([scratch("worst", "\"worst\"")]).collect();
    let accurate = "[fidelity]\ntolerance = 1e-3\n";
    let mut trial = Trial::new(&plate(1.0, "", &(flaws + accurate)));
    trial.step(0.01);
    let scale = 36.9 * PER_KELVIN * diffusion().sqrt();
    for (i, depth) in depths.into_iter().enumerate() {
        let found = trial.get(&format!("s{i}.stress_intensity"));
        let wanted = scale * shocked(depth);
        assert!(off(found, wanted) < 2e-3, "{depth}: {found} {wanted}");
        let release = trial.get(&format!("s{i}.energy_release_rate"));
        assert!(off(release, energy_release(found, 340e9, 0.22)) < 1e-12);
        assert!(off(trial.get(&format!("s{i}.safety")), 3.8e6 / found) < 1e-12);
    }
    let worst = trial.get("worst.stress_intensity");
    assert!(off(worst, 1.34485 * scale) < 1e-3, "{worst}");
    assert!(off(trial.get("worst.depth"), 1.1305 * diffusion()) < 0.05);
}

/// Stress that falls off within the first element has its worst crack there: below the first of the depths that an
/// element has, and above those that are given.
#[test]
fn worst_depths_are_found_within_the_first_element() {
    let depths = [1e-5, 2e-5, 4e-5, 6e-5, 8e-5, 1e-4, 1.5e-4, 2e-4, 3e-4];
    let given = depths.iter().enumerate();
    let given = given.map(|(i, depth)| scratch(&format!("s{i}"), &format!("{depth:e}")));
    let flaws: String = given.chain([scratch("worst", "\"worst\"")]).collect();
    let mut trial = Trial::new(&plate(1.0, COARSE, &flaws));
    trial.step(5e-4);
    let [worst, depth] =
        ["stress_intensity", "depth"].map(|key| trial.get(&format!("worst.{key}")));
    assert!(depth > 0.0 && depth < 2e-4, "{depth}");
    for (i, given) in depths.into_iter().enumerate() {
        let found = trial.get(&format!("s{i}.stress_intensity"));
        assert!(found <= 1.002 * worst, "{found} at {given:e}, {worst} at {depth:e}");
    }
    assert!(trial.warnings_on_values().contains(&"flaw_unresolved"));
}

/// Constants that are tables are taken at the present temperature of the front.
#[test]
fn energy_is_released_with_the_present_constants() {
    let penny = "at = [0.0, 0.0, -5e-3]\nnormal = [1.0, 0.0, 0.0]\ndepth = 1e-4\nshape = \"penny\"";
    let flaws = [scratch("edge", "1e-4"), scratch("worst", "\"worst\""), flaw("penny", penny)];
    let table = "young = { temperature = [540.0, 573.15], value = [680e9, 340e9] }";
    let text = plate(1.0, "stress_free_temperature = 613.15", &flaws.concat())
        .replace("536.25", "540.0")
        .replace("bottom = { temperature = 573.15", "bottom = { temperature = 540.0")
        .replace("young = 340e9", table);
    let mut trial = Trial::new(&text);
    trial.step(1e3);
    for name in ["edge", "worst", "penny"] {
        let [found, release] = ["stress_intensity", "energy_release_rate"]
            .map(|key| trial.get(&format!("{name}.{key}")));
        assert!(off(release, energy_release(found, 680e9, 0.22)) < 1e-6, "{name}: {release}");
    }
}

/// Cracks of a row that are far apart are alone; those of a dense one have the energy `pσ²/(2E′)` of the stress at
/// their tip, and worst depths are less deep.
#[test]
fn cracks_of_a_row_shield_each_other() {
    let depth = 2.0 * diffusion();
    let row = |name: &str, depth: &str, spacing: f64| {
        scratch(name, depth).replace("depth =", &format!("spacing = {spacing:e}\ndepth ="))
    };
    let given = format!("{depth:e}");
    let flaws = [
        scratch("alone", &given),
        row("far", &given, 200.0 * depth),
        row("beside", &given, depth),
        row("dense", &given, 0.02 * depth),
        scratch("worst", "\"worst\""),
        row("worst_of_row", "\"worst\"", 2.0 * depth),
    ];
    let accurate = "[fidelity]\ntolerance = 1e-3\n";
    let mut trial = Trial::new(&plate(1.0, "", &(flaws.concat() + accurate)));
    trial.step(0.01);
    let mut intensity = |name: &str| trial.get(&format!("{name}.stress_intensity"));
    let [alone, far, beside, dense] = ["alone", "far", "beside", "dense"].map(&mut intensity);
    assert!(off(far, alone) < 2e-3, "{far} {alone}");
    assert!(dense < beside && beside < alone, "{dense} {beside} {alone}");
    // The stress at the tip, and its slope over a part of the distance.
    let at_tip = 36.9 * PER_KELVIN * libm::erfc(0.5 * depth / diffusion());
    let wanted = at_tip * (0.01 * depth).sqrt();
    assert!((1.0..1.01).contains(&(dense / wanted)), "{dense} {wanted}");
    let [worst, of_row] = ["worst", "worst_of_row"].map(&mut intensity);
    assert!(of_row < worst, "{of_row} {worst}");
    let [worst, of_row] = ["worst", "worst_of_row"].map(|name| trial.get(&format!("{name}.depth")));
    assert!(0.0 < of_row && of_row < worst, "{of_row} {worst}");
}

#[test]
fn shocks_tell_when_flaws_can_grow_at_the_earliest() {
    // l_c = (3.8/128.7)² m, 0.5529 l_c, and the time in which heat goes that far.
    let notes = Trial::new(&plate(1.0, "", &scratch("own", "1e-5"))).model.notes().join("\n");
    for part in ["falls by 36.9 K", "1.29e8 Pa", "8.72e-4 m", "4.82e-4 m", "0.0263 s"] {
        assert!(notes.contains(part), "{part} in {notes}");
    }
    // A chuck that is colder than all faces.
    let chuck = "[body.chuck]\nkind = \"reservoir\"\nheat_capacity = 400.0\ninitial_temperature = 500.0\n[[coupling]]\n\
                 from = \"chuck.top\"\nto = \"plate.bottom\"\nconductance = 1e5\n";
    let text = plate(1.0, "", &(scratch("own", "1e-5") + chuck));
    let text = text.replace("bottom = { temperature = 573.15, roller", "bottom = { roller");
    let notes = Trial::new(&text).model.notes().join("\n");
    assert!(notes.contains("falls by 73.1 K"), "{notes}");
}

#[test]
fn uniform_tension_opens_cracks_from_every_face() {
    let at = |name: &str, at: &str, normal: &str| {
        flaw(name, &format!("at = {at}\nnormal = {normal}\ndepth = 4e-5"))
    };
    let all = [
        at("bottom", "[0.0, 0.0, -10e-3]", "[0.0, 3.0, 0.0]"),
        at("left", "[-1.5e-3, 2e-4, -4e-3]", "[0.0, -2.0, 0.0]"),
        at("right", "[1.5e-3, 2e-4, -4e-3]", "[0.0, 1e-3, 0.0]"),
        at("back", "[1e-3, 1e-3, -4e-3]", "[1.0, 0.0, 0.0]"),
        flaw(
            "inside",
            "at = [2e-4, 1e-4, -4e-3]\nnormal = [1.0, 0.0, 0.0]\ndepth = 1e-4\nshape = \"penny\"",
        ),
    ];
    let text =
        plate(1.0, "stress_free_temperature = 613.15", &all.concat()).replace("536.25", "573.15");
    let mut trial = Trial::new(&text);
    trial.step(0.01);
    let stress = 40.0 * PER_KELVIN;
    for name in ["bottom", "left", "right", "back"] {
        let found = trial.get(&format!("{name}.stress_intensity"));
        assert!(off(found, edge(4e-5, |_| stress)) < 1e-6, "{name}: {found}");
        assert!(off(found, 1.12152 * stress * (PI * 4e-5).sqrt()) < 1e-3);
    }
    let found = trial.get("inside.stress_intensity");
    assert!(off(found, penny(1e-4, stress)) < 1e-6, "{found}");
}

/// Stress that decays within a fiftieth of a penny's radius has its mean along the front.
#[test]
fn pennies_beside_a_shocked_face_have_their_integral() {
    let (radius, below) = (5e-4, 2e-5);
    let time = (0.02_f64 * radius).powi(2) / DIFFUSIVITY;
    let keys = format!(
        "at = [0.0, 0.0, {:e}]\nnormal = [1.0, 0.0, 0.0]\ndepth = {radius:e}\nshape = \"penny\"",
        -radius - below
    );
    let mesh = "mesh = { spacing = 1e-3, depth_spacing = 1e-6 }";
    let mut trial = Trial::new(&plate(1.0, mesh, &flaw("p", &keys)));
    trial.step(time);
    let found = trial.get("p.stress_intensity");
    let stress = |depth: f64| 36.9 * PER_KELVIN * libm::erfc(depth / (0.04 * radius));
    let middle = |n: usize, count: usize| (n as f64 + 0.5) / count as f64;
    let mean = |r: f64| {
        let heights = (0..2000).map(|n| r * (PI * middle(n, 2000)).cos());
        heights.map(|height| stress(radius + below - height)).sum::<f64>() / 2000.0
    };
    let parts = (0..500).map(|n| 0.5 * PI * middle(n, 500));
    let sum: f64 = parts.map(|angle| mean(radius * angle.sin()) * angle.sin()).sum();
    let wanted = 2.0 * (radius / PI).sqrt() * sum * 0.5 * PI / 500.0;
    assert!(off(found, wanted) < 1e-2, "{found} {wanted}");
}

#[test]
fn closed_cracks_have_no_intensity_and_are_safe() {
    let flaws = [scratch("some", "1e-4"), scratch("worst", "\"worst\"")].concat();
    let mut trial = Trial::new(&plate(1.0, "", &flaws).replace("536.25", "600.0"));
    trial.step(0.01);
    for name in ["some", "worst"] {
        assert_eq!(trial.get(&format!("{name}.stress_intensity")), 0.0);
        assert_eq!(trial.get(&format!("{name}.energy_release_rate")), 0.0);
        assert_eq!(trial.get(&format!("{name}.safety")), 1e6);
    }
    assert_eq!(trial.get("worst.depth"), 0.0);
}

/// A disc and a box under a spot, with flaws at which stress varies along all directions.
fn spotted(shape: &str, steps: f64, at: &str, load: &str) -> String {
    let flaws = [
        flaw("edge", &format!("at = {at}\nnormal = [0.6, 0.8, 0.0]\ndepth = 2e-4")),
        flaw(
            "penny",
            "at = [2e-4, 1e-4, -1.2e-4]\nnormal = [1.0, 1.0, 0.5]\ndepth = 1e-4\nshape = \"penny\"",
        ),
    ];
    format!(
        "name = \"Plate\"\nstop_time = 1e-2\nstep = {}\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         material = {{ model = \"thermoelastic\", density = 3980.0, specific_heat = 880.0, conductivity = 31.0, \
         young = 340e9, poisson = 0.22, expansion = 8e-6, toughness = 3.8e6 }}\ninitial_temperature = 500.0\n\
         mesh = {{ spacing = 2e-4, depth_spacing = 1e-4 }}\n[body.plate.faces]\nbottom = {{ clamped = true }}\n\
         [[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ gaussian = {{ radius = 0.4e-3 }} }}\n\
         carries = [\"heat_flux\", \"pressure\"]\nstart = {{ heat_flux = -3e7, pressure = 1e6{load} }}\n{}",
        1e-2 / steps,
        flaws.concat()
    )
}

const CASES: [[&str; 3]; 2] = [
    ["box = [3e-3, 2e-3, 1e-3]", "[3e-4, 1e-4, 0.0]", ", x = 1e-4"],
    ["disc = { radius = 1.5e-3, thickness = 1e-3 }", "[3e-4, 1e-4, 0.0]", ""],
];

#[test]
fn rows_and_solutions_agree_and_derivatives_are_those_of_differences() {
    for [shape, at, load] in CASES {
        // A long default experiment pays for rows, a short one does not.
        let [mut by_rows, mut solved] =
            [100.0, 1.0].map(|steps| Trial::new(&spotted(shape, steps, at, load)));
        for trial in [&mut by_rows, &mut solved] {
            trial.step(1e-3);
        }
        for name in ["edge", "penny"] {
            let name = format!("{name}.stress_intensity");
            let (row, solution) = (by_rows.get(&name), solved.get(&name));
            assert!(row > 0.0 && off(row, solution) < 1e-9, "{shape} {name}: {row} {solution}");
            for key in ["stress_intensity", "energy_release_rate", "safety"] {
                let name = name.replace("stress_intensity", key);
                for trial in [&mut by_rows, &mut solved] {
                    let names = [name.clone()];
                    let rate = trial.changes(&names, &[("spot.pressure", 1.0)])[0];
                    let mut at = |pressure: f64| {
                        trial.set("spot.pressure", 1e6 + pressure);
                        trial.get(&name)
                    };
                    let (above, below) = (at(1e4), at(-1e4));
                    at(0.0);
                    let wanted = (above - below) / 2e4;
                    assert!(off(rate, wanted) < 1e-5, "{shape} {name}: {rate} {wanted}");
                }
            }
        }
    }
}

#[test]
fn equilibrium_of_turned_axes_is_that_of_the_disc() {
    // The same flaw, turned about the axis.
    let of = |at: &str, normal: &str| {
        let [shape, given, load] = CASES[1];
        let text = spotted(shape, 1.0, given, load).replace(given, at);
        let mut trial = Trial::new(&text.replace("[0.6, 0.8, 0.0]", normal));
        trial.step(1e-3);
        trial.get("edge.stress_intensity")
    };
    let one = of("[3e-4, 1e-4, 0.0]", "[0.6, 0.8, 0.0]");
    let other = of("[-1e-4, 3e-4, 0.0]", "[-0.8, 0.6, 0.0]");
    assert!(off(one, other) < 1e-9, "{one} {other}");
}

#[test]
fn steps_that_miss_a_peak_deep_cracks_and_yielding_bodies_are_warned_of() {
    let warned = |text: &str| {
        let (_, warnings) = parse_with_warnings(text, "scene").unwrap();
        let ids = warnings.iter().map(|warning| warning.finding().id);
        ids.filter(|id| id.starts_with("flaw")).collect::<Vec<_>>()
    };
    let fine = scratch("s", "1e-4");
    assert_eq!(warned(&plate(20.0, "", &fine)), Vec::<&str>::new());
    assert_eq!(warned(&plate(1.0, "", &fine)), ["flaw_peak_missed"]);
    assert_eq!(warned(&plate(20.0, "", &scratch("s", "2e-3"))), ["flaw_near_face", "flaw_deep"]);
    let yielding = plate(20.0, "", &fine)
        .replace("thermoelastic", "elastoplastic")
        .replace("young", "yield_stress = 1e9, young");
    assert_eq!(warned(&yielding), ["flaw_in_yielding_body"]);
    let relaxing = plate(20.0, "", &fine)
        .replace("thermoelastic", "viscoelastic")
        .replace("young", "shear_relaxation = [{ fraction = 0.5, time = 1.0 }], young");
    assert_eq!(warned(&relaxing), ["flaw_in_relaxing_body"]);
}

#[test]
fn flaws_beside_faces_are_warned_of() {
    let warned = |keys: &str| {
        let (_, warnings) =
            parse_with_warnings(&plate(20.0, "", &flaw("s", keys)), "scene").unwrap();
        let messages = warnings.iter().map(|warning| warning.to_string());
        messages.filter(|message| message.contains("goes on there")).collect::<Vec<_>>()
    };
    let edge =
        |x: f64, normal: &str| format!("at = [{x:e}, 0.0, 0.0]\nnormal = {normal}\ndepth = 1e-4");
    let penny = |z: f64| {
        format!("at = [0.0, 0.0, {z:e}]\nnormal = [0.0, 0.0, 1.0]\ndepth = 2e-4\nshape = \"penny\"")
    };
    let near = warned(&edge(1.4e-3, "[1.0, 0.0, 0.0]"));
    assert!(
        near.len() == 1
            && near[0].contains("1e-4 m from `right`")
            && near[0].contains("from 5e-4 m"),
        "{near:?}"
    );
    // Far away, across the face, and in its plane of symmetry.
    for free in [
        edge(0.9e-3, "[1.0, 0.0, 0.0]"),
        edge(1.4e-3, "[0.0, 1.0, 0.0]"),
        edge(1.5e-3, "[1.0, 0.0, 0.0]"),
    ] {
        assert!(warned(&free).is_empty(), "{free}");
    }
    // Along a slanted normal the face is farther.
    assert_eq!(warned(&edge(1.4e-3, "[0.19, 1.0, 0.0]")).len(), 0);
    assert_eq!(warned(&edge(1.4e-3, "[0.25, 1.0, 0.0]")).len(), 1);
    let text = plate(
        20.0,
        "",
        &flaw("s", "at = [0.0, 0.0, -10e-3]\nnormal = [1.0, 0.0, 0.0]\ndepth = 1e-4"),
    );
    let (_, warnings) = parse_with_warnings(&text, "scene").unwrap();
    assert!(warnings.iter().any(|warning| warning.finding().id == "flaw_on_symmetry"));
    let near = warned(&penny(-3e-4));
    assert!(near.len() == 1 && near[0].contains("3e-4 m from `top`"), "{near:?}");
    assert!(warned(&penny(-5e-4)).is_empty());
}

/// Once the whole plate is cold the worst depth is all of it, for which the formula of a half plane does not hold.
#[test]
fn worst_depths_beyond_the_half_plane_are_warned_of() {
    let text = plate(20.0, "", &scratch("s", "\"worst\""));
    let cooled = text.replace("bottom = { temperature = 573.15", "bottom = { temperature = 540.0");
    assert_ne!(text, cooled);
    for (scene, time, deep) in [(&text, 5e-4, false), (&cooled, 60.0, true)] {
        let mut trial = Trial::new(scene);
        trial.step(time);
        let depth = trial.get("s.depth");
        let told = trial.warnings_on_values().contains(&"flaw_worst_is_deep");
        assert_eq!((told, depth > 1e-3), (deep, deep), "{depth}");
    }
}

#[test]
fn coarse_meshes_are_warned_of() {
    let mesh = "mesh = { spacing = 5e-4, depth_spacing = 5e-4, growth = 1.0 }";
    for (depth, wanted) in [("1e-4", true), ("3e-3", false)] {
        let mut trial = Trial::new(&plate(1.0, mesh, &scratch("s", depth)));
        trial.step(0.01);
        let found = trial.model.warnings(&trial.state);
        let is_warned = found.iter().any(|own| own.finding().id == "flaw_unresolved");
        assert_eq!(is_warned, wanted, "{depth}");
    }
}

#[test]
fn the_depth_is_a_parameter_unless_it_is_searched() {
    let text = plate(1.0, "", &[scratch("s", "1e-4"), scratch("w", "\"worst\"")].concat());
    let scene = scene::parse(&text, "scene").unwrap();
    let registry = impinge::variables::Registry::of(&scene);
    let causality = |name: &str| {
        let variable = registry.variables.iter().find(|own| own.name == name).unwrap();
        variable.causality()
    };
    use impinge::variables::Causality::{Output, Parameter};
    assert_eq!(causality("s.depth"), Parameter);
    assert_eq!(causality("w.depth"), Output);
    assert_eq!(causality("plate.toughness"), Parameter);
}

/// A mesh on which uniform stress is exact, like on any other.
const COARSE: &str = "mesh = { spacing = 5e-4, depth_spacing = 5e-4, growth = 1.0 }";
const GROWTH: &str = "growth = { exponent = 10.0, speed = 2.0 }";

/// Depth after slow growth from 40 µm, in `K = Y σ √a`: `a^(1 − n/2)` falls by `(n/2 − 1) v₀ (Yσ/K_Ic)^n t` (A. G.
/// Evans & S. M. Wiederhorn 1974, doi 10.1007/BF00035405).
fn grown(stress: f64, time: f64) -> f64 {
    let rate = 4.0 * 2.0 * (edge(1.0, |_| 1.0) * stress / 3.8e6).powi(10);
    (4e-5_f64.powi(-4) - rate * time).powf(-0.25)
}

#[test]
fn growth_under_steady_tension_has_the_closed_form_in_steps_of_any_length() {
    let keys = format!("at = [0.0, 0.0, -10e-3]\nnormal = [0.0, 1.0, 0.0]\ndepth = 4e-5\n{GROWTH}");
    let text =
        plate(1.0, &format!("stress_free_temperature = 613.15\n{COARSE}"), &flaw("s", &keys));
    let text = text.replace("536.25", "573.15");
    let stress = 40.0 * PER_KELVIN;
    let wanted = grown(stress, 0.01);
    assert!(wanted > 1.1 * 4e-5 && wanted < 2.0 * 4e-5);
    for steps in [1, 5] {
        let mut trial = Trial::new(&text);
        assert_eq!(trial.get("s.grown_depth"), 4e-5);
        (0..steps).for_each(|_| trial.step(0.01 / f64::from(steps)));
        let found = trial.get("s.grown_depth");
        assert!(off(found - 4e-5, wanted - 4e-5) < 1e-4, "{steps}: {found} {wanted}");
        // K is that of the present depth.
        assert!(off(trial.get("s.stress_intensity"), edge(found, |_| stress)) < 1e-5);
    }
}

/// A bar under a load, with a flaw in its side.
fn pulled() -> Trial {
    let keys =
        format!("at = [-1.5e-3, 0.0, -5e-3]\nnormal = [0.0, 0.0, 1.0]\ndepth = 4e-5\n{GROWTH}");
    let load = "[[load]]\nname = \"pull\"\non = \"plate.top\"\ncarries = [\"pressure\"]\n\
                footprint = { tiles = { count = [1, 1], size = [3e-3, 2e-3] } }\n";
    let text = plate(1.0, COARSE, &(flaw("s", &keys) + load))
        .replace("top = { temperature = 536.25 }\nsides = { roller = true }\n", "")
        .replace(
            "bottom = { temperature = 573.15, roller",
            "right = { roller = true }\nfront = { roller = true }\nbottom = { roller",
        );
    Trial::new(&text)
}

#[test]
fn growth_adds_up_over_cycles_and_states_continue() {
    let stress = 1.2e8;
    let mut trial = pulled();
    let cycle = |trial: &mut Trial| {
        for pressure in [-stress, 0.0] {
            trial.set("pull.pressure[1,1]", pressure);
            trial.step(0.005);
        }
    };
    (0..2).for_each(|_| cycle(&mut trial));
    let saved = trial.state.clone();
    cycle(&mut trial);
    let found = trial.get("s.grown_depth");
    assert!(off(found - 4e-5, grown(stress, 0.015) - 4e-5) < 1e-3, "{found}");
    let mut other = pulled();
    other.restart(&saved);
    cycle(&mut other);
    assert_eq!(other.state, trial.state);
    assert_eq!(trial.get("s.stress_intensity"), 0.0);
}

#[test]
fn flaw_at_its_toughness_runs_and_impossible_depths_are_refused() {
    let mut trial = pulled();
    trial.set("pull.pressure[1,1]", -4e8);
    trial.step(1e-6);
    assert_eq!(trial.get("s.grown_depth"), 3e-3);
    let ids = trial.model.warnings(&trial.state);
    assert!(ids.iter().any(|own| own.finding().id == "flaw_has_grown"));
    trial.model.check_state(&trial.state).unwrap();
    let own = &trial.state.bodies[0];
    let place = own.iter().rposition(|value| *value == 3e-3).unwrap();
    for depth in [3e-5, 4e-3, f64::NAN] {
        let mut state = trial.state.clone();
        state.bodies[0][place] = depth;
        assert!(trial.model.check_state(&state).is_err(), "{depth}");
    }
}

/// From 64 flaws on, those that no rows serve share the stress of the nodes: the same as from their own points, on the
/// mirrored parts of a plate, too, whatever the direction of their planes.
#[test]
fn many_flaws_are_read_like_a_few() {
    let flaw = |n: usize| {
        let [x, y] = [2e-3 * (0.7 * n as f64).sin(), 1.2e-3 * (1.9 * n as f64).cos()];
        let [along, across] = [(0.3 * n as f64).cos(), (0.3 * n as f64).sin()];
        format!(
            "[[flaw]]\nname = \"f{n}\"\nin = \"plate\"\nat = [{x}, {y}, 0.0]\nnormal = [{along}, {across}, 0.0]\n\
             depth = {:e}\ngives = [\"stress_intensity\"]\n",
            5e-5 + 2e-6 * n as f64
        )
    };
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { gaussian = { radius = 0.8e-3 } }\n\
                carries = [\"heat_flux\", \"shear\"]\n\
                start = { heat_flux = -5e6, shear_x = 1e6, x = 0.7e-3, y = 0.4e-3 }\n";
    let plate = |flaws: &str| {
        format!(
            "name = \"Plate\"\nstop_time = 1e-2\nstep = 2e-3\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [6e-3, 4e-3, 2e-3] }}\ninitial_temperature = 500.0\n\
             mesh = {{ spacing = 5e-4, depth_spacing = 1e-4 }}\nfaces.bottom = {{ clamped = true }}\n\
             faces.top = {{ convection = {{ coefficient = 2e4, ambient = 300.0 }} }}\n\
             material = {{ model = \"thermoelastic\", density = 6050.0, specific_heat = 450.0, conductivity = 2.0, young \
             = 205e9, poisson = 0.31, expansion = 10.5e-6, toughness = 8e6, weibull = {{ modulus = 10.0, strength = 500e6, \
             volume = 1e-9 }} }}\n{load}{flaws}"
        )
    };
    let read = |flaws: &[usize]| {
        let text: String = flaws.iter().map(|&n| flaw(n)).collect();
        let mut trial = Trial::new(&plate(&text));
        trial.step(2e-3);
        trial.step(2e-3);
        let of = |n: &usize| trial.get(&format!("f{n}.stress_intensity"));
        flaws.iter().map(of).collect::<Vec<f64>>()
    };
    let all: Vec<usize> = (0..70).collect();
    let some: Vec<usize> = all.iter().copied().step_by(5).collect();
    let (many, few) = (read(&all), read(&some));
    let scale = few.iter().copied().fold(0.0, f64::max);
    assert!(scale > 1e5);
    for (n, few) in some.iter().zip(few) {
        assert!((many[*n] - few).abs() < 1e-10 * scale, "{n}: {} {few}", many[*n]);
    }
}

/// A flaw on an interface lies in the layer above, also where thicknesses add up to less than its depth by rounding.
#[test]
fn mouths_on_interfaces_lie_in_the_layer_above() {
    let layer = |young: &str, toughness: &str, thickness: &str| {
        format!(
            "{{ thickness = {thickness}, material = {{ model = \"thermoelastic\", density = 3980.0, \
             specific_heat = 880.0, conductivity = 31.0, young = {young}, poisson = 0.2, \
             expansion = 8e-6, toughness = {toughness} }} }}"
        )
    };
    let layers = [
        layer("340e9", "3e6", "1e-4"),
        layer("340e9", "3e6", "3e-4"),
        layer("70e9", "1e6", "16e-4"),
    ];
    let at = |name: &str, z: &str| {
        let keys = format!("at = [2e-3, 0.0, {z}]\nnormal = [0.0, 1.0, 0.0]\ndepth = 1e-4");
        flaw(name, &keys)
    };
    let text = format!(
        "name = \"Coated\"\nstop_time = 1.0\nstep = 1.0\n[body.plate]\nkind = \"solid\"\n\
         shape = {{ box = [4e-3, 4e-3, 2e-3] }}\ninitial_temperature = 293.15\n\
         stress_free_temperature = 393.15\nlayers = [{}]\n[body.plate.faces]\nbottom = {{ roller = true }}\n\
         front = {{ clamped = true }}\nback = {{ clamped = true }}\n{}",
        layers.join(", "),
        [at("above", "-3.9999e-4"), at("on", "-4e-4"), at("below", "-4.0001e-4")].concat()
    );
    let mut trial = Trial::new(&text);
    trial.step(1.0);
    for key in ["stress_intensity", "energy_release_rate", "safety"] {
        let [above, on, below] =
            ["above", "on", "below"].map(|name| trial.get(&format!("{name}.{key}")));
        assert!(off(on, above) < 1e-3, "{key}: {on} for {above}");
        assert!(off(below, above) > 0.3, "{key}: {below} beside {above}");
    }
}
