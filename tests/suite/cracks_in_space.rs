//! Cracks that run in space: against sections, bodies without cracks and their closed forms.

use crate::common::{Trial, off};

const YOUNG: f64 = 340e9;
const EXPANSION: f64 = 8e-6;
const STRENGTH: f64 = 300e6;
const ENERGY: f64 = 45.0;
const START: f64 = 600.0;

/// A box of alumina with keys of its `fracture`, faces and further tables.
fn scene(shape: &str, fracture: &str, faces: &str, more: &str) -> String {
    format!(
        "name = \"Cracks\"\nstop_time = 10.0\nstep = 1.0\n[body.plate]\nkind = \"solid\"\n{shape}\n\
         initial_temperature = {START}\n\
         material = {{ model = \"thermoelastic\", density = 3980.0, specific_heat = 880.0, conductivity = 31.0, \
         young = {YOUNG}, poisson = 0.22, expansion = {EXPANSION}{fracture} }}\n\
         [body.plate.faces]\n{faces}\n{more}\n"
    )
}

const AT1: &str = ", fracture = { model = \"at1\", strength = 300e6, energy = 45.0 }";

/// Drop of temperature that stresses a bar between rollers to a part of its strength [K].
fn drop(part: f64) -> f64 {
    part * STRENGTH / (YOUNG * EXPANSION)
}

/// A bar whose ends cannot approach each other, free to contract across.
fn bar_scene(fracture: &str, more: &str) -> String {
    let shape = "shape = { box = [0.8e-3, 0.1e-3, 0.1e-3] }";
    let faces = "left = { roller = true }\nright = { roller = true }\nfront = { roller = true }\n\
                 bottom = { temperature = 600.0, roller = true }\ntop = { temperature = 600.0 }";
    scene(shape, fracture, faces, more)
}

fn cool(trial: &mut Trial, drop: f64) {
    trial.set("plate.top.temperature", START - drop);
    trial.set("plate.bottom.temperature", START - drop);
    trial.step(1.0);
}

#[test]
fn bar_in_space_breaks_at_its_strength_across_its_section() {
    let scattered = AT1.replace("energy = 45.0", "energy = 45.0, scatter = 0.04, seed = 3");
    let probe = "[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [0.3e-3, 0.01e-3, -0.03e-3]\n\
                 gives = [\"stress\", \"damage\"]";
    let mut trial = Trial::new(&bar_scene(&scattered, probe));
    cool(&mut trial, drop(0.9));
    assert!(off(trial.get("p.stress_xx"), 0.9 * STRENGTH) < 1e-3);
    assert!(trial.get("p.stress_yy").abs() < 1e-3 * STRENGTH);
    assert_eq!(trial.get("plate.crack_count"), 0.0);
    let elastic = 0.5 * (0.9 * STRENGTH).powi(2) / YOUNG * 8e-12;
    assert!(off(trial.get("plate.elastic_energy"), elastic) < 1e-3);
    cool(&mut trial, drop(1.04));
    cool(&mut trial, drop(1.05));
    assert_eq!(trial.get("plate.crack_count"), 1.0);
    assert!(trial.get("p.stress_xx").abs() < 0.02 * STRENGTH);
    // It breaks at a roller, where half the profile of a crack is inside.
    let area = trial.get("plate.crack_area");
    assert!((0.5e-8..0.6e-8).contains(&area), "{area}");
    let first = ["x", "y", "z"].map(|axis| trial.get(&format!("plate.first_crack_{axis}")));
    assert!(
        first[0].abs() <= 0.4e-3 && first[1].abs() <= 0.05e-3 && (-1e-4..=0.0).contains(&first[2])
    );
    assert!(off(trial.get("plate.dissipated_energy"), ENERGY * area) < 1e-12);
}

/// With `star_convex` a bar breaks under tension at its strength, and under compression at the other one.
#[test]
fn bars_break_under_compression_at_the_strength_that_is_asked_for() {
    for ratio in [2.0, 6.0] {
        let split = format!(
            "energy = 45.0, split = \"star_convex\", compressive_strength = {:e}",
            ratio * STRENGTH
        );
        let scene = bar_scene(&AT1.replace("energy = 45.0", &split), "");
        for (sign, ratio) in [(1.0, 1.0), (-1.0, ratio)] {
            let mut trial = Trial::new(&scene);
            let mut damage = |part: f64| {
                cool(&mut trial, sign * drop(part * ratio));
                trial.get("plate.max_damage")
            };
            // Rollers hold it across at three faces, so that its stress is even.
            assert_eq!(damage(0.98), 0.0, "{sign} {ratio}");
            assert!(damage(1.03) > 0.0, "{sign} {ratio}");
        }
    }
}

const STRONG: &str = ", fracture = { model = \"at1\", length = 60e-6, energy = 15e3 }";
const PROBE: &str = "[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [1e-4, 0.6e-4, -1e-4]\n\
                     gives = [\"stress\", \"displacement\", \"temperature\"]";
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];
const SPOT: &str = "[[load]]\nname = \"spot\"\non = \"plate.top\"\ncarries = [\"heat_flux\", \"pressure\", \"shear\"]\n\
                    footprint = { disc = { radius = 0.15e-3 } }\nstart = { x = 0.1e-3, y = 0.05e-3 }";
const SHAPE: &str =
    "shape = { box = [0.6e-3, 0.5e-3, 0.3e-3] }\nsymmetry = \"none\"\nmesh = { spacing = 20e-6 }";

#[test]
fn intact_box_is_the_box_that_does_not_crack() {
    let faces = "bottom = { clamped = true }";
    let run = |fracture: &str| {
        let mut trial = Trial::new(&scene(SHAPE, fracture, faces, &format!("{SPOT}\n{PROBE}")));
        trial.set("spot.heat_flux", 2e6);
        trial.set("spot.pressure", 3e6);
        trial.set("spot.shear_y", 1e6);
        trial.step(2e-3);
        trial
    };
    let (mut cracking, mut usual) = (run(STRONG), run(""));
    assert_eq!(cracking.get("plate.max_damage"), 0.0);
    let of = |trial: &mut Trial| COMPONENTS.map(|own| trial.get(&format!("p.stress_{own}")));
    let (one, other) = (of(&mut cracking), of(&mut usual));
    let scale = other.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    for (one, other) in one.iter().zip(other) {
        assert!((one - other).abs() < 0.05 * scale, "{one} {other}");
    }
    assert!(off(cracking.get("p.temperature") - START, usual.get("p.temperature") - START) < 0.02);
}

#[test]
fn quarter_cracks_as_the_whole_does() {
    let faces = "bottom = { clamped = true }";
    let run = |symmetry: &str| {
        let shape = format!(
            "shape = {{ box = [0.58e-3, 0.58e-3, 0.16e-3] }}\nsymmetry = \"{symmetry}\"\nmesh = {{ spacing = 20e-6 }}"
        );
        let spot = SPOT.replace("start = { x = 0.1e-3, y = 0.05e-3 }", "");
        let mut trial = Trial::new(&scene(&shape, AT1, faces, &spot));
        trial.set("spot.heat_flux", -1.2e8);
        let mut found = Vec::new();
        for _ in 0..3 {
            trial.step(2e-4);
            let names = ["max_damage", "crack_area", "elastic_energy", "dissipated_energy"];
            found.push(names.map(|name| trial.get(&format!("plate.{name}"))));
        }
        found
    };
    let (whole, quarter) = (run("none"), run("quarter"));
    assert!(whole[2][0] > 0.6, "{whole:?}");
    for (whole, quarter) in whole.iter().zip(&quarter) {
        // The quarter has nodes in the planes of symmetry, where damage is highest.
        let bounds = [0.04, 4e-3, 4e-3, 4e-3];
        for ((one, other), bound) in whole.iter().zip(quarter).zip(bounds) {
            assert!((one - other).abs() <= bound * one.abs(), "{whole:?} {quarter:?}");
        }
    }
}

#[test]
fn states_and_threads_leave_no_bit_of_cracks_in_space_changed() {
    let text = bar_scene(AT1, "");
    let run = |threads: usize, restarts: bool| {
        let mut trial = Trial::on_threads(&text, threads);
        for part in [0.9, 1.04] {
            if restarts {
                let saved = trial.state.clone();
                cool(&mut trial, drop(part));
                trial.restart(&saved);
            }
            cool(&mut trial, drop(part));
        }
        ["plate.crack_area", "plate.mechanical_work", "plate.max_principal"]
            .map(|name| trial.get(name).to_bits())
    };
    let usual = run(1, false);
    assert_eq!(run(3, false), usual);
    assert_eq!(run(1, true), usual);
}
