//! Filaments that a moving nozzle lays on solids.

use std::collections::BTreeSet;

use impinge::advice::parse_with_warnings;
use impinge::model::State;

use crate::common::{Trial, off, sweep};

const WAX: &str = "{ substance = \"n-eicosane\", at = \"60 °C\", contact_angle = \"20°\" }";
const SOLDER: &str = "{ substance = \"sac305\", contact_angle = \"40°\" }";
const GLYCEROL: &str = "{ substance = \"glycerol\", at = \"40 °C\" }";
const CONCRETE: &str = "{ density = 2200.0, viscosity = { law = \"bingham\", yield_stress = 600.0, plastic_viscosity = 15.0 }, \
                        specific_heat = 900.0, conductivity = 1.5 }";
const SILICONE: &str = "{ density = 1050.0, viscosity = { law = \"herschel_bulkley\", yield_stress = 40.0, consistency = 30.0, \
                        exponent = 0.5 }, specific_heat = 1500.0, conductivity = 0.25, surface_tension = 0.021 }";

/// A straight strand of a fluid on a plate of a material, with further keys of the filament.
fn line(fluid: &str, temperature: f64, material: &str, keys: &str) -> String {
    format!(
        r#"
name = "Line"
stop_time = 1.0
step = 0.1
[body.ink]
kind = "filament"
fluid = {fluid}
nozzle = {{ diameter = 0.8e-3, height = 0.7e-3, temperature = {temperature}, flow = 8e-9 }}
path = {{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }}
most = 1e-8
{keys}
[body.plate]
kind = "solid"
shape = {{ box = [14e-3, 10e-3, 1e-3] }}
material = "{material}"
initial_temperature = 293.15
mesh = {{ spacing = 1e-3, order = 1 }}
faces = {{ bottom = {{ clamped = true }} }}
[[coupling]]
from = "ink"
to = "plate.top"
traction = false
"#
    )
}

fn run(text: &str, steps: usize) -> Trial {
    let mut trial = Trial::new(text);
    (0..steps).for_each(|_| trial.step(1.0 / steps as f64));
    trial
}

/// Volume, heat and momentum balance, and nothing leaves the range of the temperatures, in long steps and short ones.
#[test]
fn balances_close_for_all_fluids() {
    let air = "convection = { coefficient = 30.0, ambient = 300.0 }";
    let all = [
        (WAX, 343.0, "soda-lime-glass"),
        (WAX, 343.0, "copper"),
        (SOLDER, 520.0, "fr4"),
        (SOLDER, 520.0, "copper"),
        (GLYCEROL, 330.0, "pmma"),
        (CONCRETE, 310.0, "steel-304"),
        (SILICONE, 360.0, "aluminium"),
    ];
    for (fluid, temperature, material) in sweep(&all, &[0, 3, 4, 5]) {
        let text = line(fluid, temperature, material, air);
        let mut heats = Vec::new();
        for steps in [4, 20] {
            let mut trial = run(&text, steps);
            let said = format!("{fluid} on {material} in {steps} steps");
            let [volume, drift] =
                ["volume", "volume_drift"].map(|key| trial.get(&format!("ink.{key}")));
            assert!((volume / 8e-9 - 1.0).abs() < 1e-12 && drift.abs() < 1e-12 * volume, "{said}");
            let [heat, missing] =
                ["heat", "heat_drift"].map(|key| trial.get(&format!("ink.{key}")));
            assert!(heat > 0.0 && missing.abs() < 1e-10 * heat, "{said}: {missing} of {heat}");
            let received = trial.get("plate.heat_in");
            assert!((received / heat - 1.0).abs() < 1e-12, "{said}: {received} of {heat}");
            let coldest = trial.get("ink.min_temperature");
            let hottest = trial.get("plate.max_temperature");
            assert!(coldest > 293.0 && hottest < temperature, "{said}: {coldest} {hottest}");
            assert!(trial.get("ink.max_temperature") < temperature + 1e-9, "{said}");
            heats.push(heat);
        }
        assert!((heats[0] / heats[1] - 1.0).abs() < 0.06, "{fluid} on {material}: {heats:?}");
    }
}

/// Weight and momentum reach the plate as a force; after the nozzle has stopped it is the weight.
#[test]
fn the_plate_carries_the_strand() {
    let text = line(CONCRETE, 310.0, "steel-304", "").replace("flow = 8e-9", "flow = 0.0");
    let mut trial = Trial::new(&text.replace("traction = false", ""));
    trial.set("ink.flow", 8e-9);
    (0..5).for_each(|_| trial.step(0.1));
    trial.set("ink.flow", 0.0);
    trial.step(0.1);
    let weight = 9.81 * trial.get("ink.mass");
    assert!((trial.get("ink.force") / weight - 1.0).abs() < 1e-9);
}

/// A wall of cement paste warns once its lowest layer cannot bear what is above, and not before there is a stack.
#[test]
fn stacks_that_yield_are_warned_of() {
    let text = r#"
name = "Wall"
stop_time = 8.0
step = 0.5
[body.ink]
kind = "filament"
fluid = { density = 2050.0, viscosity = { law = "bingham", yield_stress = 180.0, plastic_viscosity = 4.0 }, specific_heat = 1600.0, conductivity = 1.0 }
nozzle = { diameter = 12e-3, height = 10e-3, temperature = 295.0, flow = 0.0 }
path = { time = [0.0, 1.9, 2.0, 3.9, 4.0, 5.9, 6.0, 7.9], x = [0.0, 0.1, 0.1, 0.0, 0.0, 0.1, 0.1, 0.0], y = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], z = [0.01, 0.01, 0.02, 0.02, 0.03, 0.03, 0.04, 0.04], flow = [6e-6, 0.0, 6e-6, 0.0, 6e-6, 0.0, 6e-6, 0.0] }
most = 1e-3
"#;
    let mut trial = Trial::new(text);
    let mut subjects = BTreeSet::new();
    for (until, wanted) in [(2.0, false), (8.0, true)] {
        while trial.state.time < until - 1e-9 {
            trial.step(0.5);
            let found = trial.model.warnings(&trial.state).into_iter();
            let yields = found.filter(|warning| warning.finding().id == "stack_yields");
            subjects.extend(yields.map(|warning| warning.subject().to_owned()));
        }
        let ratio = trial.get("ink.bearing_ratio");
        let found = trial.model.warnings(&trial.state);
        let is_warned = found.iter().any(|warning| warning.finding().id == "stack_yields");
        assert_eq!(is_warned, wanted, "{until} s: {ratio}");
        assert_eq!(ratio > 1.0, wanted, "{until} s: {ratio}");
    }
    // Hosts are warned of a load, and of one that has doubled.
    let most = 1 + trial.get("ink.bearing_ratio").log2() as usize;
    assert!((1..=most).contains(&subjects.len()), "{subjects:?}");
}

/// Two lines of wax on each other give the plate almost the heat of short intervals at the default one.
#[test]
fn frozen_stacks_depend_little_on_the_interval() {
    let run = |interval: &str| {
        let text = format!(
            r#"
name = "Stack"
stop_time = 8.0
step = 1.0
[body.ink]
kind = "filament"
fluid = {WAX}
nozzle = {{ diameter = 0.8e-3, height = 0.4e-3, temperature = 333.0, flow = 0.0 }}
path = {{ time = [0.0, 2.0, 2.5, 4.5], x = [-5e-3, 5e-3, 5e-3, -5e-3], y = [0.0, 0.0, 0.0, 0.0], z = [0.4e-3, 0.4e-3, 0.8e-3, 0.8e-3], flow = [2e-9, 0.0, 2e-9, 0.0] }}
most = 1e-7
[body.plate]
kind = "solid"
shape = {{ box = [14e-3, 6e-3, 1.5e-3] }}
material = "soda-lime-glass"
initial_temperature = 293.15
mesh = {{ spacing = 0.4e-3 }}
[[coupling]]
from = "ink"
to = "plate.top"
traction = false
{interval}
"#
        );
        let mut trial = Trial::new(&text);
        (0..8).for_each(|_| trial.step(1.0));
        trial.get("ink.heat")
    };
    let [usual, short] = ["", "interval = 10e-3"].map(run);
    println!("{usual} J at the default interval, {short} J at 10 ms");
    assert!(usual > 1.0 && (usual / short - 1.0).abs() < 0.03, "{usual} {short}");
}

/// A strand of a slow nozzle holds the flow over the speed, heat balances, and its width and heat hardly follow the
/// communication step; fluid that rises around the nozzle is warned of.
#[test]
fn slow_nozzles_lay_strands() {
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    for (fluid, temperature, ratio) in [(WAX, 343.0, 0.1), (SILICONE, 360.0, 0.05)] {
        let text = line(fluid, temperature, "steel-304", "");
        let slow = "{ time = [0.0, 1.0], x = [-2e-3, 2e-3], y = [0.0, 0.0] }";
        let text = text.replace(path, slow).replace("most = 1e-8", "most = 1e-6");
        let section = 0.25 * std::f64::consts::PI * 0.64e-6 / ratio;
        let text = text.replace("flow = 8e-9", &format!("flow = {}", section * 4e-3));
        let found = [1, 4, 20, 100].map(|steps| {
            let mut trial = run(&text, steps);
            let [width, height, heat, drift, warm] =
                ["width", "height", "heat", "heat_drift", "heat_stored"]
                    .map(|key| trial.get(&format!("ink.{key}")));
            assert!((width * height / section - 1.0).abs() < 1e-9, "{fluid}: {width} {height}");
            assert!(drift.abs() < 1e-10 * warm.abs(), "{fluid}: {drift} of {warm}");
            let warnings = trial.model.warnings(&trial.state);
            let is_warned = warnings.iter().any(|one| one.finding().id == "nozzle_is_slow");
            assert!(is_warned || fluid == WAX, "{warnings:?}");
            [width, heat]
        });
        for [width, heat] in found {
            let [last_width, last_heat] = found[3];
            assert!((width / last_width - 1.0).abs() < 0.03, "{fluid}: {found:?}");
            assert!((heat / last_heat - 1.0).abs() < 0.06, "{fluid}: {found:?}");
        }
    }
}

/// Lines beside each other are warned of where more than half of one lies inside the other, whatever their width.
#[test]
fn lines_mostly_inside_each_other_are_warned_of() {
    let text = line(SILICONE, 300.0, "steel-304", "");
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    let outlet = 0.25 * std::f64::consts::PI * 0.64e-6;
    for ratio in [0.5, 1.0, 2.0, 4.0] {
        // Legs of 10 mm in 0.4 s, and the pressed width on 0.4 mm, but for thin strands as wide as high.
        let section: f64 = ratio * outlet;
        let width = (section / 0.4e-3).max(section.sqrt());
        for (apart, wanted) in
            [(0.05, true), (0.3, true), (0.48, true), (0.52, false), (0.9, false)]
        {
            let y = apart * width;
            let lines = format!(
                "{{ time = [0.0, 0.4, 0.5, 0.9], x = [-5e-3, 5e-3, 5e-3, -5e-3], y = [0.0, 0.0, {y}, {y}], flow = \
                 [{0}, 0.0, {0}, 0.0] }}",
                section * 25e-3
            );
            let text = text.replace(path, &lines).replace("height = 0.7e-3", "height = 0.4e-3");
            let text = text.replace(", flow = 8e-9", "").replace("most = 1e-8", "most = 1e-6");
            let (_, warnings) = parse_with_warnings(&text, "scene.toml").unwrap();
            let found = warnings.iter().any(|one| one.finding().id == "strand_laid_along_itself");
            assert_eq!(found, wanted, "{ratio} {apart}: {warnings:?}");
        }
    }
}

/// On an insulated plane in air a strand cools as a lump, at its Biot number of 0.01: `T = T_a + (T_0 − T_a) exp(−h A
/// t/(ρ c V))`.
#[test]
fn strands_in_air_cool_as_lumps() {
    let keys = "convection = { coefficient = 15.0, ambient = 290.0 }";
    let text = line(&CONCRETE.replace("600.0", "1e6"), 350.0, "steel-304", keys);
    let text = &text[..text.find("[body.plate]").unwrap()];
    let mut trial = Trial::new(text);
    trial.set("ink.flow", 8e-6);
    trial.step(1e-3);
    trial.set("ink.flow", 0.0);
    let [width, height] = ["width", "height"].map(|key| trial.get(&format!("ink.{key}")));
    let start = trial.get("ink.max_temperature");
    for (duration, from) in [(20.0, 0.0), (0.5, 20.0), (60.0, 20.5)] {
        trial.step(duration);
        let exposed = (width + 2.0 * height) / (width * height);
        let decay = (-15.0 * exposed * (duration + from) / (2200.0 * 900.0)).exp();
        let expected = 290.0 + (start - 290.0) * decay;
        let found = trial.get("ink.max_temperature");
        assert!((found - expected).abs() < 0.01 * (start - 290.0), "{found} {expected}");
    }
}

/// Air that warms within a step is as warm at each time as its derivatives say: the strand gives it as much heat in one
/// long step as in many short ones.
#[test]
fn air_follows_its_derivatives_within_a_step() {
    let text = r#"
name = "Air"
stop_time = 3.0
step = 0.1
[body.ink]
kind = "filament"
fluid = { density = 900.0, viscosity = 2.0, specific_heat = 2000.0, conductivity = 0.2, surface_tension = 0.03, contact_angle = 0.8 }
nozzle = { diameter = 0.8e-3, height = 0.7e-3, temperature = 353.15, flow = 5e-9 }
path = { time = [0.0, 1.0], x = [-5e-3, 5e-3], y = [0.0, 0.0] }
most = 3e-8
convection = { coefficient = 200.0, ambient = 293.15 }
"#;
    for [slope, bend] in [[20.0, 0.0], [0.0, 40.0 / 3.0]] {
        let lost = |steps: usize| {
            let mut trial = Trial::new(text);
            for n in 0..steps {
                let time = 3.0 * n as f64 / steps as f64;
                trial.set("ink.ambient", 293.15 + time * (slope + 0.5 * time * bend));
                trial.set_derivative("ink.ambient", 1, slope + time * bend);
                trial.set_derivative("ink.ambient", 2, bend);
                trial.step(3.0 / steps as f64);
            }
            trial.get("ink.heat_lost")
        };
        let [long, short] = [1, 60].map(lost);
        assert!((long / short - 1.0).abs() < 0.01, "{slope} {bend}: {long} J, {short} J");
    }
}

/// Inputs with derivatives move the nozzle as the table of the same path does, in steps of any length.
#[test]
fn inputs_follow_polynomials() {
    let table =
        line(WAX, 343.0, "soda-lime-glass", "").replace("height = 0.7e-3", "height = 0.6e-3");
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    assert!(table.contains(path));
    let by_inputs = table.replace(path, "\"input\"");
    let mut expected = run(&table, 2);
    let mut trial = Trial::new(&by_inputs);
    for (place, speed) in [([-5e-3, -2e-3], [20e-3, 0.0]), ([5e-3, -2e-3], [0.0, 10e-3])] {
        for (axis, name) in ["ink.nozzle_x", "ink.nozzle_y"].into_iter().enumerate() {
            trial.set(name, place[axis]);
            trial.set_derivative(name, 1, speed[axis]);
        }
        trial.step(0.5);
    }
    for key in ["length", "width", "heat", "min_temperature", "solid_fraction"] {
        let [found, wanted] = [&mut trial, &mut expected].map(|one| one.get(&format!("ink.{key}")));
        assert!((found / wanted - 1.0).abs() < 1e-9, "{key}: {found} {wanted}");
    }
    // From rest, at 0.04 m/s², while the flow grows from nothing.
    let mut trial = Trial::new(&by_inputs.replace("flow = 8e-9", "flow = 0.0"));
    trial.set("ink.nozzle_x", -5e-3);
    trial.set_derivative("ink.nozzle_x", 2, 0.04);
    trial.set_derivative("ink.flow", 1, 1.6e-8);
    trial.step(0.5);
    assert!((trial.get("ink.volume") / 2e-9 - 1.0).abs() < 1e-12);
    assert!((trial.get("ink.length") / 5e-3 - 1.0).abs() < 1e-9);
}

/// A strand in a bend has the length of the path; where the nozzle stands still it piles up.
#[test]
fn outputs_describe_the_strand_and_its_target() {
    let target = "[[target]]\nof = \"ink\"\nline = [[-5e-3, -2e-3], [5e-3, -2e-3], [5e-3, 6e-3]]\n";
    let text = line(SILICONE, 300.0, "steel-304", "") + target;
    let mut trial = run(&text, 10);
    assert!((trial.get("ink.length") / 15e-3 - 1.0).abs() < 0.01);
    assert!(trial.get("ink.largest_deviation") < 2e-4 && trial.get("ink.deviation") < 1e-5);
    let bare = 3e-3 - 0.5 * trial.get("ink.last_width");
    assert!((trial.get("ink.gap") - bare).abs() < 1e-6, "{}", trial.get("ink.gap"));
    trial.set("ink.flow", 2e-9);
    // The table has ended, and with it the flow.
    trial.step(1.0);
    assert!((trial.get("ink.volume") / 8e-9 - 1.0).abs() < 1e-12);
}

/// Places that are set without derivatives are reached evenly by the end of the step: the same strand as of the table,
/// a step late, and a warning says so once.
#[test]
fn places_without_derivatives_are_approached_evenly() {
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    let table = line(WAX, 343.0, "soda-lime-glass", "");
    let mut expected = run(&table, 10);
    let mut trial = Trial::new(&table.replace(path, "\"input\""));
    trial.set("ink.flow", 0.0);
    trial.set("ink.nozzle_x", -5e-3);
    trial.set("ink.nozzle_y", -2e-3);
    trial.step(0.1);
    trial.set("ink.flow", 8e-9);
    // The first step has no way yet.
    trial.step(1e-6);
    for n in 1..=10 {
        let part = 0.2 * f64::from(n);
        trial.set("ink.nozzle_x", -5e-3 + 10e-3 * part.min(1.0));
        trial.set("ink.nozzle_y", -2e-3 + 5e-3 * (part - 1.0).max(0.0));
        trial.step(0.1);
    }
    for (key, most) in [("length", 3e-3), ("width", 5e-3), ("heat", 0.02), ("volume", 1e-4)] {
        let [found, wanted] = [&mut trial, &mut expected].map(|one| one.get(&format!("ink.{key}")));
        assert!((found / wanted - 1.0).abs() < most, "{key}: {found} {wanted}");
    }
    assert!((trial.get("ink.touchdown_y") - 3e-3).abs() < 1e-5);
    let told = trial.model.warnings(&trial.state);
    assert_eq!(
        told.iter().filter(|one| one.finding().id == "nozzle_is_late").count(),
        1,
        "{told:?}"
    );
}

/// G-code lays what the table of the same motion does, and brings its own flow.
#[test]
fn code_moves_the_nozzle_as_a_table_does() {
    let table = line(WAX, 343.0, "soda-lime-glass", "");
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    let mut expected = run(&table, 10);
    // 4e-9 m³ of filament of 1 mm on each leg.
    let length = 4.0 / (0.25 * std::f64::consts::PI);
    let code = format!(
        "M83\\nG0 X-5 Y-2 Z0.7 F6000\\nG1 X5 E{length} F1200\\nG1 Y3 E{length} F600\\nG1 E-1 F600"
    );
    let by_code = table
        .replace(path, "{ file = \"a.gcode\", filament_diameter = 1e-3 }")
        .replace(", flow = 8e-9", "")
        + &format!("[files]\n\"a.gcode\" = \"{code}\"\n");
    let mut trial = run(&by_code, 10);
    for key in ["length", "width", "heat", "min_temperature", "solid_fraction", "volume"] {
        let [found, wanted] = [&mut trial, &mut expected].map(|one| one.get(&format!("ink.{key}")));
        assert!((found / wanted - 1.0).abs() < 1e-9, "{key}: {found} {wanted}");
    }
    trial.step(0.3);
    assert!((trial.get("ink.volume") / 8e-9 - 1.0).abs() < 1e-9);
}

/// A scene on disk gets the texts of the files that it names, and refuses names that lead elsewhere.
#[test]
fn scenes_bring_the_files_that_they_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    let of = |name: &str| {
        let text = line(WAX, 343.0, "soda-lime-glass", "").replace(", flow = 8e-9", "");
        text.replace(path, &format!("{{ file = \"{name}\" }}"))
    };
    let code = "G0 X0 Y0 ; \"quoted\" 'and' \\ more\nG1 X3 E0.1 F600\n";
    std::fs::create_dir(folder.path().join("paths")).unwrap();
    std::fs::write(folder.path().join("paths/a.gcode"), code).unwrap();
    let place = folder.path().join("scene.toml");
    std::fs::write(&place, of("paths/a.gcode")).unwrap();
    let scene = impinge::scene::read(&place).unwrap();
    assert_eq!(scene.files["paths/a.gcode"], code);
    let text = impinge::scene::text_of(&place, "scene.toml").unwrap();
    assert!(text.starts_with(&of("paths/a.gcode")));
    // A text that has them needs no files.
    std::fs::remove_dir_all(folder.path().join("paths")).unwrap();
    std::fs::write(&place, &text).unwrap();
    assert_eq!(impinge::scene::read(&place).unwrap().files, scene.files);
    for (name, words) in [
        ("paths/a.gcode", "cannot be read"),
        ("../a.gcode", "not below the folder"),
        ("/etc/passwd", "not below the folder"),
        ("", "not below the folder"),
    ] {
        std::fs::write(&place, of(name)).unwrap();
        let refused = impinge::scene::read(&place).unwrap_err().to_string();
        assert!(refused.contains(words) && refused.contains("scene.toml:9:"), "{refused}");
    }
}

/// `check` warns of unusual heights, targets beyond the plate, strands without fluid, along themselves or beyond the
/// run; large and coarse meshes, and contacts near the freezing point.
#[test]
fn doubtful_strands_are_warned_of() {
    let target = "[[target]]\nof = \"ink\"\nline = [[0.0, 0.0], [5e-3, 0.0]]\n";
    let fine = line(WAX, 343.0, "copper", "") + target;
    let told = |text: &str| -> Vec<&'static str> {
        let (scene, warnings) = parse_with_warnings(text, "scene.toml").unwrap();
        let of_meshes = impinge::model::tolerance::warnings(&scene, &[]);
        warnings.into_iter().chain(of_meshes).map(|warning| warning.finding().id).collect()
    };
    assert_eq!(told(&fine), [""; 0]);
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    let walls = |x: &str, y: &str, z: &str| {
        let time = "time = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]";
        fine.replace(path, &format!("{{ {time}, x = [{x}], y = [{y}]{z} }}"))
    };
    let back = ("-5e-3, 5e-3, -5e-3, 5e-3, -5e-3, 5e-3", "0.0, 0.0, 0.0, 0.0, 0.0, 0.0");
    let rising = ", z = [0.7e-3, 0.7e-3, 0.7e-3, 1.4e-3, 1.4e-3, 1.4e-3]";
    let cross = ("-5e-3, 5e-3, 5e-3, 0.0, 0.0, 0.0", "0.0, 0.0, 4e-3, 4e-3, -4e-3, -4.5e-3");
    assert_eq!(told(&walls(cross.0, cross.1, "")), [""; 0], "lines may cross");
    let wide = fine.replace("[14e-3, 10e-3, 1e-3]", "[0.1, 0.1, 1e-3]");
    let wide = wide.replace("spacing = 1e-3, order = 1", "spacing = 1e-4, growth = 1.0");
    for (changed, id) in [
        (fine.replace("height = 0.7e-3", "height = 9e-3"), "nozzle_height_unusual"),
        (fine.replace("[5e-3, 0.0]]", "[8e-3, 0.0]]"), "target_beyond_plate"),
        (fine.replace("flow = 8e-9", "flow = 0.0"), "no_fluid_comes"),
        (walls(back.0, back.1, ""), "strand_laid_along_itself"),
        (walls(back.0, back.1, rising), "strand_laid_along_itself"),
        (fine.replace("stop_time = 1.0", "stop_time = 0.9"), "route_outlasts_run"),
        (fine.replace("copper", "soda-lime-glass"), "strand_freezes_at_contact"),
        (fine.replace("copper", "soda-lime-glass"), "mesh_below_strand_is_coarse"),
        (wide.replace(path, "\"input\""), "mesh_below_strand_is_large"),
    ] {
        assert!(told(&changed).contains(&id), "{id}: {:?}", told(&changed));
    }
}

#[test]
fn refused_steps_change_nothing() {
    let text = line(WAX, 343.0, "soda-lime-glass", "").replace("flow = 8e-9", "flow = 6e-9");
    let path = "{ time = [0.0, 0.5, 1.0], x = [-5e-3, 5e-3, 5e-3], y = [-2e-3, -2e-3, 3e-3] }";
    for (name, value, words) in [
        ("flow", 2e-8, "more than `most`"),
        ("flow", -1e-9, "goes back into the nozzle"),
        ("nozzle_z", 0.0, "above the plate"),
        ("nozzle_temperature", -1.0, "not above absolute zero"),
    ] {
        let mut trial = Trial::new(&text.replace(path, "\"input\""));
        trial.step(0.2);
        let before = trial.state.clone();
        trial.set(&format!("ink.{name}"), value);
        let refusal = trial.try_step(0.8).unwrap_err().to_string();
        assert!(refusal.contains(words), "{refusal}");
        assert_eq!(trial.state.bodies, before.bodies, "{name}");
    }
}

#[test]
fn saved_states_continue_to_the_bit() {
    let text = line(WAX, 343.0, "soda-lime-glass", "");
    let mut trial = Trial::new(&text);
    (0..3).for_each(|_| trial.step(0.1));
    let saved: State = trial.state.clone();
    let go_on = |trial: &mut Trial| {
        (0..4).for_each(|n| trial.step(0.05 + 0.01 * f64::from(n)));
        trial.state.bodies.clone()
    };
    let first = go_on(&mut trial);
    trial.restart(&saved);
    assert_eq!(go_on(&mut trial), first);
    let mut other = Trial::on_threads(&text, 2);
    other.restart(&saved);
    assert_eq!(go_on(&mut other), first);
}

/// Any number of a state that a run cannot produce is refused, or leads to finite outputs or a refusal.
#[test]
fn damaged_states_do_no_harm() {
    let text = line(WAX, 343.0, "soda-lime-glass", "");
    let mut trial = run(&text, 3);
    let saved = trial.state.clone();
    let (mut refused, count) = (0, saved.bodies[0].len());
    for place in (0..count).step_by(7) {
        for value in [f64::NAN, -1.0, 3.5, 1e300] {
            let mut damaged = saved.clone();
            if damaged.bodies[0][place] == value {
                continue;
            }
            damaged.bodies[0][place] = value;
            match trial.model.check_state(&damaged) {
                Err(_) => refused += 1,
                Ok(()) => {
                    trial.restart(&damaged);
                    if trial.try_step(1e-3).is_ok() {
                        assert!(trial.get("ink.heat_stored").is_finite(), "{value} at {place}");
                    }
                }
            }
        }
    }
    assert!(refused >= 2 * count / 7, "{refused} of {count}");
}

/// A strand loses heat to plate and air at once: an `interval` far above the time in which heat crosses it would give
/// too much of it to one of them.
#[test]
fn long_intervals_share_heat_between_plate_and_air_alike() {
    let shares = |conductance: &str, interval: &str| {
        let mut trial = Trial::new(&format!(
            "name = \"Strand\"\nstop_time = 10.0\nstep = 10.0\n[body.ink]\nkind = \"filament\"\nmethod = \"line\"\nfluid = \
             {{ density = 1200.0, viscosity = {{ law = \"bingham\", yield_stress = 200.0, plastic_viscosity = 50.0 }}, \
             specific_heat = 2000.0, conductivity = 1.0 }}\nnozzle = {{ diameter = 1e-3, height = 0.8e-3, temperature = \
             360.0, flow = 1.57e-8 }}\npath = {{ time = [0.0, 0.3], x = [-3e-3, 3e-3], y = [0.0, 0.0] }}\nmost = \
             1e-8\nspacing = 0.25e-3\nconvection = {{ coefficient = 40.0, ambient = 300.0 }}\n[body.plate]\nkind = \
             \"solid\"\nshape = {{ box = [9e-3, 3e-3, 1e-3] }}\nmaterial = {{ model = \"thermoelastic\", density = \
             2500.0, specific_heat = 850.0, conductivity = 1.0 }}\ninitial_temperature = 300.0\nmesh = {{ spacing = \
             0.25e-3, depth_spacing = 0.2e-3, growth = 1.0, order = 1 }}\n[[coupling]]\nfrom = \"ink\"\nto = \
             \"plate.top\"\ntraction = false\n{conductance}\n{interval}\n"
        ));
        trial.step(10.0);
        [trial.get("ink.heat"), trial.get("ink.heat_lost")]
    };
    for conductance in ["", "conductance = 300.0"] {
        let [plate, air] = shares(conductance, "");
        let [long_plate, long_air] = shares(conductance, "interval = 10.0");
        assert!(off(long_plate, plate) < 0.01, "{conductance}: {long_plate} J of {plate} J");
        assert!(off(long_air, air) < 0.05, "{conductance}: {long_air} J of {air} J");
    }
}
