//! Probability of failure of brittle bodies: against closed forms, and against what the same bodies read in parts.

use std::f64::consts::PI;

use closed_form::brittle_failure::{equibiaxial_ratio, linear_stress, shock_depth};
use impinge::advice::parse_with_warnings;
use impinge::scene;

use crate::common::{Trial, off};

const BOX: &str = "box = [3e-3, 2e-3, 1e-3]";
const DISC: &str = "disc = { radius = 1.5e-3, thickness = 1e-3 }";
/// `EαΔT/(1 − ν)` per kelvin [Pa/K].
const PER_KELVIN: f64 = 340e9 * 8e-6 / 0.78;
const DIFFUSIVITY: f64 = 31.0 / (3980.0 * 880.0);
const STRENGTH: f64 = 300e6;

fn alumina(weibull: &str) -> String {
    format!(
        "{{ model = \"thermoelastic\", density = 3980.0, specific_heat = 880.0, conductivity = 31.0, young = 340e9, \
         poisson = 0.22, expansion = 8e-6{weibull} }}"
    )
}

fn flaws(modulus: u32, keys: &str) -> String {
    alumina(&format!(", weibull = {{ modulus = {modulus}.0, strength = 300e6, {keys} }}"))
}

/// A plate between two temperatures, held along the surface: its stress is `PER_KELVIN` times the temperature below the
/// stress-free one.
fn held(shape: &str, material: &str, [start, free]: [f64; 2], [top, bottom]: [f64; 2]) -> String {
    format!(
        "name = \"Plate\"\nstop_time = 1.0\nstep = 1.0\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         {material}\ninitial_temperature = {start}\nstress_free_temperature = {free}\n[body.plate.faces]\n\
         top = {{ temperature = {top} }}\nbottom = {{ temperature = {bottom}, roller = true }}\n\
         sides = {{ roller = true }}\n"
    )
}

fn one(material: &str) -> String {
    format!("material = {material}")
}

/// Ratio of the risk of equibiaxial tension to that of uniaxial tension.
fn biaxial(modulus: u32, directions: &str) -> f64 {
    if directions == "normal" { equibiaxial_ratio(modulus) } else { 2.0 }
}

#[test]
fn bent_plates_have_the_risk_of_linear_stress() {
    // Planes on rollers beside a box are planes of symmetry, without flaws.
    for (shape, area, around) in [(BOX, 6e-6, 0.0), (DISC, PI * 2.25e-6, 2.0 * PI * 1.5e-3)] {
        for (modulus, directions) in [(5, "independent"), (20, "normal")] {
            for free in [333.15, 413.15] {
                let most = (free - 293.15) * PER_KELVIN / STRENGTH;
                let part = linear_stress(f64::from(modulus), (free - 393.15) / (free - 293.15));
                let risk = biaxial(modulus, directions) * most.powi(modulus as i32);
                for (keys, wanted) in [
                    ("volume = 1e-9", area * 1e-3 * part / 1e-9),
                    ("area = 1e-6", (area + around * 1e-3 * part) / 1e-6),
                ] {
                    let keys = format!("{keys}, directions = \"{directions}\"");
                    let material = one(&flaws(modulus, &keys));
                    let text = held(shape, &material, [343.15, free], [293.15, 393.15]);
                    let mut trial = Trial::new(&text);
                    trial.step(1.0);
                    let mut wanted = risk * wanted;
                    if keys.starts_with("area") && free > 393.15 {
                        let low = (free - 393.15) / (free - 293.15);
                        wanted += risk * low.powi(modulus as i32) * area / 1e-6;
                    }
                    for key in ["present_failure_risk", "failure_risk"] {
                        // A body that was in tension all over keeps that of its beginning.
                        if key == "failure_risk" && free > 343.15 {
                            continue;
                        }
                        let found = trial.get(&format!("plate.{key}"));
                        // The jump at time zero is part of what was met.
                        let most = if key == "failure_risk" { 1e-5 } else { 1e-6 };
                        assert!(
                            off(found, wanted) < most,
                            "{shape} {keys} {free}: {found} {wanted}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn suddenly_cooled_half_spaces_have_their_risk() {
    for (modulus, tolerance) in [(5, 1e-3), (10, 2e-3), (20, 5e-3)] {
        let material = one(&flaws(modulus, "volume = 1e-9"));
        let thick = BOX.replace("1e-3]", "10e-3]");
        let text = held(&thick, &material, [573.15, 573.15], [536.25, 573.15]);
        let mut trial = Trial::new(&text.replace(" = 1.0\nstep = 1.0", " = 0.01\nstep = 0.01"));
        trial.step(0.01);
        let stress = (36.9 * PER_KELVIN / STRENGTH).powi(modulus as i32);
        let depth = (DIFFUSIVITY * 0.01).sqrt() * shock_depth(f64::from(modulus));
        let wanted = 2.0 * stress * depth * 6e-6 / 1e-9;
        let found = trial.get("plate.failure_risk");
        assert!(off(found, wanted) < tolerance, "m {modulus}: {found} {wanted}");
        assert_eq!(trial.get("plate.failure_probability"), -(-found).exp_m1());
        let place = ["x", "y", "z"].map(|axis| trial.get(&format!("plate.failure_place_{axis}")));
        assert_eq!(place, [0.0; 3]);
    }
}

/// A plate at 400 K, without stress then, between temperatures of its faces that follow each other, each for a second
/// in which heat comes to rest; `keys` are of its mesh.
fn turned(material: &str, keys: &str, faces: &[[f64; 2]]) -> Trial {
    let text = held(BOX, material, [400.0, 400.0], [400.0, 400.0]);
    let text = text.replace("initial_temperature", &format!("{keys}\ninitial_temperature"));
    let mut trial = Trial::new(&text);
    for [top, bottom] in faces {
        trial.set("plate.top.temperature", *top);
        trial.set("plate.bottom.temperature", *bottom);
        trial.step(1.0);
        trial.model.check_state(&trial.state).unwrap();
    }
    trial
}

const FIRST_ORDER: &str =
    "mesh = { spacing = 1e-3, depth_spacing = 1e-3, growth = 1.0, order = 1 }";

/// A unit loads what it has saved while compression grows beside tension.
#[test]
fn states_are_possible_while_compression_grows() {
    for keys in ["volume = 1e-9", "area = 1e-6"] {
        let faces = [[300.0, 401.0], [299.9, 900.0], [299.8, 401.0], [200.0, 900.0]];
        turned(&one(&flaws(10, keys)), FIRST_ORDER, &faces);
        turned(&one(&flaws(20, keys)), "", &faces);
    }
}

/// Tension that grows at one node of an element while others lose theirs is not mixed with stresses of other moments.
#[test]
fn tension_keeps_the_compression_of_its_moment() {
    let material = one(&flaws(10, "volume = 1e-9"));
    // Stress falls linearly from the top to where it turns to compression, almost at the bottom.
    let wanted = 2.0 * (100.0 * PER_KELVIN / STRENGTH).powi(10) * 6.0 / 11.0 * 100.0 / 101.0;
    for keys in ["", FIRST_ORDER] {
        for bottom in [420.0, 450.0, 500.0, 900.0] {
            let mut trial = turned(&material, keys, &[[300.0, 401.0], [299.9, bottom]]);
            let found = trial.get("plate.failure_risk") / wanted;
            assert!((0.999..1.02).contains(&found), "{keys} {bottom}: {found}");
        }
        // Tension that grows much is that of the new moment, with its compression.
        let mut trial = turned(&material, keys, &[[300.0, 401.0], [250.0, 450.0]]);
        let found = trial.get("plate.failure_risk") / trial.get("plate.present_failure_risk");
        assert!((0.999..1.02).contains(&found), "{keys}: {found}");
    }
}

/// Under a steady temperature of a face tension reaches deeper as the other face cools.
#[test]
fn tension_that_spreads_at_its_height_counts() {
    let material = one(&flaws(10, "volume = 1e-9"));
    for keys in ["", FIRST_ORDER] {
        let mut trial = turned(&material, keys, &[[300.0, 900.0], [300.0, 600.0], [300.0, 450.0]]);
        let found = trial.get("plate.failure_risk") / trial.get("plate.present_failure_risk");
        assert!((0.999..1.02).contains(&found), "{keys}: {found}");
    }
}

/// Flaws that grow slowly under a steady tension on one face, while the other is warmed, have the risk that a fine mesh
/// gives them.
#[test]
fn slow_growth_beside_changing_compression_needs_no_fine_mesh() {
    let keys = "volume = 1e-9, slow_growth = { exponent = 20.0, constant = 1e14 }";
    let material = one(&flaws(10, keys));
    let fine = "mesh = { spacing = 1e-3, depth_spacing = 2e-5, growth = 1.0 }";
    let [coarse, fine] = ["", fine].map(|keys| {
        let faces = [[300.0, 401.0], [300.0, 900.0], [300.0, 900.0], [300.0, 900.0]];
        turned(&material, keys, &faces).get("plate.failure_risk")
    });
    // The power of the stress, averaged over 20 000 places through the thickness.
    assert!(off(fine, 300.10) < 2e-3, "{fine}");
    assert!((0.8..2.0).contains(&(coarse / fine)), "{coarse} {fine}");
}

/// A body in tension at time zero keeps that, also where its faces are at once at the temperature without stress.
#[test]
fn stress_before_prescribed_temperatures_act_is_met() {
    for keys in ["", ", slow_growth = { exponent = 20.0, constant = 1e14 }"] {
        let material = one(&flaws(10, &format!("volume = 1e-9{keys}")));
        let mut trial = Trial::new(&held(BOX, &material, [400.0, 500.0], [500.0, 500.0]));
        trial.step(1.0);
        trial.model.check_state(&trial.state).unwrap();
        let wanted = 2.0 * (100.0 * PER_KELVIN / STRENGTH).powi(10) * 6.0;
        let found = trial.get("plate.failure_risk");
        assert!(off(found, wanted) < 1e-6, "{keys}: {found} {wanted}");
        assert!(trial.get("plate.present_failure_risk") < 1e-9);
    }
}

/// A quarter between rollers has a quarter of the risk of the whole box, of flaws in the volume and on its faces.
#[test]
fn planes_on_rollers_have_no_flaws() {
    let of = |keys: &str, size: &str, more: &str| {
        let mut trial = Trial::new(&format!(
            "name = \"Plate\"\nstop_time = 0.01\nstep = 0.01\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [{size}, {size}, 1e-3] }}\n{}\ninitial_temperature = 400.0\n\
             mesh = {{ spacing = 5e-4, depth_spacing = 1e-4 }}\n[body.plate.faces]\n\
             top = {{ temperature = 300.0 }}\nbottom = {{ clamped = true }}\n{more}",
            one(&flaws(2, keys)),
        ));
        trial.step(0.01);
        trial
    };
    for (keys, gives, density) in [
        ("volume = 1e-9", "failure_density", true),
        ("area = 1e-6", "surface_failure_density", false),
    ] {
        let rollers = "left = { roller = true }\nfront = { roller = true }\n".to_owned();
        let at_plane = probe("p", [-1e-3, 0.0, -1e-4], gives);
        let mut quarter = of(keys, "2e-3", &(rollers + &at_plane));
        let whole = of(keys, "4e-3", "").get("plate.failure_risk");
        let found = 4.0 * quarter.get("plate.failure_risk");
        assert!(off(found, whole) < 1e-2, "{keys}: {found} {whole}");
        assert_eq!(quarter.get(&format!("p.{gives}")) > 0.0, density, "{keys}");
    }
}

/// A probe of a plate, and what it gives.
fn probe(name: &str, at: [f64; 3], gives: &str) -> String {
    format!("\n[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = {at:?}\ngives = [\"{gives}\"]\n")
}

/// Within a plate between two temperatures the density follows the stress of the plate, `PER_KELVIN` times the
/// temperature below the stress-free one; on the faces, too.
#[test]
fn densities_follow_the_stress_at_points() {
    let density = |biaxial: f64, cold: f64, size: f64| {
        biaxial * (cold * PER_KELVIN / STRENGTH).powi(10) / size
    };
    let heights: [f64; 3] = [0.0, -0.25e-3, -0.6e-3];
    for (keys, ratio, gives, size) in [
        ("volume = 2e-9", 2.0, "failure_density", 2e-9),
        ("volume = 2e-9, directions = \"normal\"", equibiaxial_ratio(10), "failure_density", 2e-9),
        ("area = 3e-6", 2.0, "surface_failure_density", 3e-6),
    ] {
        // Points on the rim of a disc are on a face, whatever their height, those on rollers beside a box are not.
        let is_on_face = gives == "surface_failure_density";
        let (shape, x) = if is_on_face { (DISC, -1.5e-3) } else { (BOX, -1.5e-3) };
        let y = if is_on_face { 0.0 } else { 0.3e-3 };
        let points = heights.iter().enumerate();
        let points = points.map(|(n, &z)| probe(&format!("p{n}"), [x, y, z], gives));
        let plate = held(shape, &one(&flaws(10, keys)), [333.15, 333.15], [293.15, 393.15]);
        let mut trial = Trial::new(&(plate + &points.collect::<String>()));
        trial.step(1.0);
        for (n, z) in heights.iter().enumerate() {
            let found = trial.get(&format!("p{n}.{gives}"));
            let wanted = density(ratio, (40.0 + 1e5 * z).max(0.0), size);
            let scale = density(ratio, 40.0, size);
            assert!((found - wanted).abs() < 2e-5 * scale, "{keys} at {z}: {found} {wanted}");
        }
        // Warmed throughout, nothing is in tension: the density so far stays.
        let before = trial.get(&format!("p0.{gives}"));
        trial.step(1.0);
        assert!(trial.get(&format!("p0.{gives}")) >= before);
    }
}

/// Means of the density over the tiles of a face add up to the risk of flaws on this face.
#[test]
fn densities_over_a_face_add_up_to_the_risk() {
    let field = "\n[[field]]\nname = \"map\"\non = \"plate.top\"\ngives = [\"surface_failure_density\"]\n\
                 footprint = { tiles = { count = [15, 10], size = [3e-3, 2e-3] } }\n";
    let text = spot(&one(&flaws(4, "area = 1e-6")), "", COLD);
    let mut trial = Trial::new(&(text + field));
    trial.step(1e-3);
    let cell = 3e-3 / 15.0 * 2e-3 / 10.0;
    let all = (1..=15)
        .flat_map(|i| (1..=10).map(move |j| format!("map.surface_failure_density[{i},{j}]")));
    let found = all.map(|name| trial.get(&name)).sum::<f64>() * cell;
    let risk = trial.get("plate.failure_risk");
    // The bottom and the sides bear little.
    assert!(found > 0.9 * risk && found < 1.02 * risk, "{found} {risk}");
}

/// A plate of some material under a cold spot.
fn spot(material: &str, keys: &str, load: &str) -> String {
    format!(
        "name = \"Plate\"\nstop_time = 1e-2\nstep = 1e-3\n[body.plate]\nkind = \"solid\"\n\
         shape = {{ box = [3e-3, 2e-3, 1e-3] }}\n{material}\ninitial_temperature = 500.0\n\
         mesh = {{ spacing = 2e-4, depth_spacing = 1e-4 }}\n{keys}\n[body.plate.faces]\n\
         bottom = {{ clamped = true }}\n[[load]]\nname = \"spot\"\non = \"plate.top\"\n\
         footprint = {{ gaussian = {{ radius = 0.4e-3 }} }}\ncarries = [\"heat_flux\"]\n{load}\n"
    )
}

/// A bar under a pull along z [Pa], with flaws that grow slowly.
fn pulled(keys: &str) -> Trial {
    let faces = "bottom = { roller = true }\nleft = { roller = true }\nfront = { roller = true }";
    let material = one(&flaws(10, keys));
    Trial::new(&format!(
        "name = \"Bar\"\nstop_time = 1e-2\nstep = 1e-3\n[body.plate]\nkind = \"solid\"\nshape = {{ {BOX} }}\n\
         {material}\ninitial_temperature = 300.0\nmesh = {{ spacing = 1e-3 }}\n[body.plate.faces]\n{faces}\n\
         [[load]]\nname = \"pull\"\non = \"plate.top\"\ncarries = [\"pressure\"]\n\
         footprint = {{ tiles = {{ count = [1, 1], size = [3e-3, 2e-3] }} }}\n"
    ))
}

/// Under a pull that comes and goes, glass in water breaks as if `σ^(n−2) + σ^n t/B` were that of a stress.
#[test]
fn flaws_that_grow_slowly_break_under_repeated_stress() {
    let (exponent, constant) = (16.0, 3.4e12);
    let keys = "volume = 1e-9, slow_growth = { exponent = 16.0, constant = 3.4e12 }";
    let mut trial = pulled(keys);
    let mut loaded = 0.0;
    for (pull, duration) in [(0.0, 1e-3), (100e6, 4e-4), (100e6, 1e-4), (0.0, 2e-3), (100e6, 2e-3)]
    {
        trial.set("pull.pressure[1,1]", -pull);
        let saved = trial.state.clone();
        trial.step(duration);
        trial.restart(&saved);
        trial.step(duration);
        loaded += if pull > 0.0 { duration } else { 0.0 };
        let stress = if loaded > 0.0 { 100e6_f64 } else { 0.0 };
        let inert =
            stress * (1.0 + stress * stress * loaded / constant).powf(1.0 / (exponent - 2.0));
        let wanted = 6.0 * (inert / STRENGTH).powi(10);
        let found = trial.get("plate.failure_risk");
        assert!((found - wanted).abs() <= 1e-6 * wanted, "{loaded}: {found} {wanted}");
    }
    let mut other = pulled("volume = 1e-9");
    other.set("pull.pressure[1,1]", -100e6);
    other.step(5e-3);
    assert!(trial.get("plate.failure_risk") > 2.0 * other.get("plate.failure_risk"));
}

/// Growth that no run leads to.
#[test]
fn states_of_flaws_that_shrank_are_refused() {
    let mut trial = pulled("volume = 1e-9, slow_growth = { exponent = 16.0, constant = 3.4e12 }");
    trial.set("pull.pressure[1,1]", -100e6);
    trial.step(1e-3);
    let mut state = trial.state.clone();
    trial.model.check_state(&state).unwrap();
    let unknowns = &mut state.bodies[0];
    let grown = unknowns.iter().rposition(|own| *own > 0.0 && *own < 1.0);
    unknowns[grown.expect("flaws have grown")] = -1.0;
    assert!(trial.model.check_state(&state).is_err());
}

const COLD: &str = "start = { heat_flux = -4e7 }";

#[test]
fn what_was_reached_stays_and_grows_place_by_place() {
    let text = spot(&one(&flaws(10, "volume = 1e-9")), "", &format!("{COLD}\n{RANGE}"));
    let mut trial = Trial::new(&text);
    let (mut highest, mut singly) = (0.0_f64, 0.0_f64);
    for step in 0..6 {
        trial.set("spot.x", if step < 3 { -0.6e-3 } else { 0.6e-3 });
        trial.step(1e-3);
        let (so_far, now) =
            (trial.get("plate.failure_risk"), trial.get("plate.present_failure_risk"));
        assert!(so_far >= highest && so_far >= now * (1.0 - 1e-6), "step {step}");
        highest = so_far;
        singly = singly.max(now);
    }
    assert!(highest > 1.3 * singly, "two places add up: {highest} {singly}");
    // A flux into the body takes the tension away.
    trial.set("spot.heat_flux", 1e8);
    trial.step(5e-3);
    assert_eq!(trial.get("plate.failure_risk"), highest);
    assert!(trial.get("plate.present_failure_risk") < 0.1 * highest);
    let x = trial.get("plate.failure_place_x");
    assert!((x.abs() - 0.6e-3).abs() < 2e-4, "{x}");
}

const RANGE: &str = "range = { x = [-0.8e-3, 0.8e-3] }";

/// The derivative of the risk of the moment is the limit of differences: with respect to inputs which act at once, and
/// to time.
#[test]
fn present_risk_has_a_derivative() {
    const FACES: &str =
        "[body.plate.faces]\nbottom = { clamped = true }\nleft = { temperature = 480.0 }\n";
    for keys in ["volume = 1e-9", "volume = 1e-9, directions = \"normal\"", "area = 1e-6"] {
        let load = COLD.replace("{ heat", "{ x = 0.4e-3, pressure = -2e7, heat");
        let text = spot(&one(&flaws(6, keys)), "", &format!("{load}\n{RANGE}"))
            .replace("[body.plate.faces]\nbottom = { clamped = true }\n", FACES)
            .replace("[\"heat_flux\"]", "[\"heat_flux\", \"pressure\"]");
        let mut trial = Trial::new(&text);
        trial.step(1e-3);
        let names = ["plate.present_failure_risk".to_owned()];
        let start = trial.state.clone();
        for (input, step) in [("spot.pressure", 1e4), ("plate.left.temperature", 1e-2)] {
            let found = trial.changes(&names, &[(input, 1.0)])[0];
            let [above, below] = [step, -step].map(|by| {
                trial.restart(&start);
                trial.set(input, start.inputs[trial.input(input)] + by);
                trial.get(&names[0])
            });
            trial.restart(&start);
            let wanted = (above - below) / (2.0 * step);
            assert!(wanted != 0.0 && off(found, wanted) < 1e-4, "{keys} {input}: {found} {wanted}");
        }
        let h = 1e-7;
        let below = trial.get(&names[0]);
        trial.step(h);
        let found = trial.rates(&names)[0];
        trial.restart(&start);
        trial.step(2.0 * h);
        let wanted = (trial.get(&names[0]) - below) / (2.0 * h);
        assert!(off(found, wanted) < 2e-3, "{keys}: {found} {wanted}");
    }
}

#[test]
fn mirror_images_count_like_the_whole_body() {
    let load = format!("{}\n{RANGE}", COLD.replace("{ heat", "{ x = 0.5e-3, heat"));
    for keys in ["volume = 1e-9", "area = 1e-6, directions = \"normal\""] {
        let of = |symmetry: &str| {
            let mut trial = Trial::new(&spot(&one(&flaws(10, keys)), symmetry, &load));
            trial.step(1e-3);
            [
                trial.get("plate.failure_risk"),
                trial.get("plate.present_failure_risk"),
                trial.get("plate.failure_place_x"),
            ]
        };
        let (half, whole) = (of(""), of("symmetry = \"none\""));
        for (half, whole) in half.iter().zip(whole) {
            assert!(off(*half, whole) < 1e-6, "{keys}: {half} {whole}");
        }
        assert!((half[2] - 0.5e-3).abs() < 1.1e-4);
    }
}

#[test]
fn layers_count_where_flaws_are_known() {
    let layers = |upper: &str, lower: &str| {
        format!(
            "layers = [{{ material = {upper}, thickness = 0.4e-3 }}, {{ material = {lower}, thickness = 0.6e-3 }}]"
        )
    };
    let (with, without) = (flaws(10, "volume = 1e-9"), alumina(""));
    let risk = |material: &str| {
        let mut trial = Trial::new(&spot(material, "", COLD));
        trial.step(1e-3);
        trial.get("plate.failure_risk")
    };
    let [upper, lower] = [layers(&with, &without), layers(&without, &with)].map(|own| risk(&own));
    let both = risk(&layers(&with, &with));
    assert!(off(upper + lower, both) < 1e-9, "{upper} + {lower}, {both}");
    assert!(upper > 10.0 * lower && lower >= 0.0);
    // A reference volume ten times as large is a tenth of the risk.
    let larger = risk(&layers(&flaws(10, "volume = 1e-8"), &without));
    assert!(off(10.0 * larger, upper) < 1e-9);
}

#[test]
fn bodies_that_yield_and_melt_have_a_risk() {
    let steel = flaws(10, "volume = 1e-9")
        .replace("thermoelastic", "elastoplastic")
        .replace("young", "yield_stress = 1e8, young");
    let mut elastic = Trial::new(&spot(&one(&flaws(10, "volume = 1e-9")), "", COLD));
    let mut yielding = Trial::new(&spot(&one(&steel), "symmetry = \"quarter\"", COLD));
    for trial in [&mut elastic, &mut yielding] {
        trial.step(1e-3);
    }
    let [elastic, limited] = [&mut elastic, &mut yielding].map(|own| own.get("plate.failure_risk"));
    assert!(limited > 0.0 && limited < 0.5 * elastic, "{limited} {elastic}");
    assert!(yielding.get("plate.max_plastic_strain") > 0.0);
}

#[test]
fn saved_states_go_on_to_the_bit_and_others_are_refused() {
    let text = spot(&one(&flaws(10, "volume = 1e-9")), "", COLD);
    let mut trial = Trial::new(&text);
    trial.step(1e-3);
    let saved = trial.state.clone();
    let risk = trial.get("plate.failure_risk");
    let go_on = |trial: &mut Trial| {
        trial.set("spot.heat_flux", 2e7);
        trial.step(1e-3);
        trial.get("plate.failure_risk").to_bits()
    };
    let first = go_on(&mut trial);
    let mut other = Trial::on_threads(&text, 3);
    other.restart(&saved);
    assert_eq!(go_on(&mut other), first);
    assert_eq!(trial.state, other.state);
    let last = saved.bodies[0].len() - 1;
    let risk = saved.bodies[0].iter().position(|&own| own == risk).unwrap();
    for (place, wrong) in [f64::NAN, f64::INFINITY, f64::MIN]
        .into_iter()
        .flat_map(|wrong| [(last, wrong), (risk, wrong)])
        .chain([(risk, 0.0), (risk, 1e3)])
    {
        let mut state = saved.clone();
        state.bodies[0][place] = wrong;
        assert!(trial.model.check_state(&state).is_err(), "{place}: {wrong}");
    }
    assert!(trial.model.check_state(&saved).is_ok());
}

#[test]
fn any_modulus_and_any_stress_have_a_probability() {
    for (modulus, strength, wanted) in [(100, 1e12, 0.0), (100, 1e3, 1.0), (1, 1e9, -1.0)] {
        let material = flaws(modulus, "volume = 1e-9")
            .replace("strength = 300e6", &format!("strength = {strength:e}"));
        let mut trial = Trial::new(&spot(&one(&material), "", COLD));
        trial.step(1e-3);
        let probability = trial.get("plate.failure_probability");
        if wanted >= 0.0 {
            assert_eq!(probability, wanted);
        } else {
            assert!(probability > 0.0 && probability < 1.0, "{probability}");
        }
    }
}

#[test]
fn nothing_mechanical_is_solved_before_a_risk_is_read_or_a_step_taken() {
    // Of a modulus that no other test has: bodies that are alike share their factors.
    let text = spot(&one(&flaws(10, "volume = 1e-9")), "", COLD);
    let trial = Trial::new(&text.replace("young = ", "young = 1"));
    assert_eq!(trial.model.factor_entries(), 0);
}

/// Modulus, strength [Pa] and toughness [Pa √m] of brittle materials.
const BRITTLE: [(&str, f64, f64, f64); 5] = [
    ("silicon nitride", 20.0, 800e6, 7e6),
    ("alumina", 10.0, 380e6, 3.5e6),
    ("window glass", 5.0, 50e6, 0.75e6),
    ("fibre of silica", 60.0, 14e9, 0.8e6),
    ("concrete", 12.0, 4e6, 1e6),
];

#[test]
fn real_brittle_materials_are_plausible_and_values_in_other_units_are_not() {
    let warned = |(modulus, strength, toughness): (f64, f64, f64)| {
        let keys = format!(
            ", toughness = {toughness:e}, weibull = {{ modulus = {modulus:?}, strength = {strength:e}, volume = 1e-9 }}"
        );
        let text = spot(&one(&alumina(&keys)), "", COLD);
        let (_, warnings) = parse_with_warnings(&text, "scene").unwrap();
        warnings.iter().map(|warning| warning.finding().id).collect::<Vec<_>>()
    };
    for (name, modulus, strength, toughness) in BRITTLE {
        assert_eq!(warned((modulus, strength, toughness)), Vec::<&str>::new(), "{name}");
        assert_eq!(warned((modulus, 1e-6 * strength, toughness)), ["wrong_unit"], "{name}");
        assert_eq!(warned((modulus, strength, 1e-6 * toughness)), ["wrong_unit"], "{name}");
    }
}

#[test]
fn substances_have_no_flaws_unless_the_scene_says_so() {
    let text = spot("material = \"alumina\"", "", COLD);
    let scene = scene::parse(&text, "scene").unwrap();
    assert!(!scene.solid("plate").unwrap().has_flaws());
}

/// A risk on elements that are longer than half a thickness at a free side is warned of, one on shorter ones, and one
/// beside sides on rollers, are not; stress there falls within a thickness.
#[test]
fn unresolved_rims_are_warned_of() {
    let disc = "disc = { radius = 10e-3, thickness = 1e-3 }";
    let told = |sides: &str, mesh: &str| {
        let material = format!("mesh = {{ {mesh} }}\n{}", one(&flaws(10, "volume = 1e-9")));
        let text = held(disc, &material, [293.15, 293.15], [293.15, 393.15])
            .replace("sides = { roller = true }\n", sides);
        let mut trial = Trial::new(&text);
        trial.step(1.0);
        let found = trial.model.warnings(&trial.state);
        found.iter().any(|one| one.to_string().contains("elements at its free sides"))
    };
    assert!(told("", "spacing = 1e-3, growth = 1.0, order = 1"));
    assert!(!told("", "spacing = 0.4e-3, growth = 1.0, order = 1"));
    assert!(!told("sides = { roller = true }\n", "spacing = 1e-3, growth = 1.0, order = 1"));
}

/// The risk of a disc of 30 thicknesses with a linear temperature over its limit, by the length of elements at its rim
/// (`docs/theory/fracture.md`).
#[test]
fn risk_beside_a_free_rim_follows_the_mesh() {
    let disc = "disc = { radius = 30e-3, thickness = 1e-3 }";
    let [coarse, middle, fine, limit] = [3e-3, 0.5e-3, 0.2e-3, 0.1e-3].map(|spacing| {
        let depth = f64::min(spacing, 1e-3);
        let mesh = format!(
            "mesh = {{ spacing = {spacing:e}, depth_spacing = {depth:e}, growth = 1.0 }}\n{}",
            one(&flaws(10, "volume = 1e-9"))
        );
        let text = held(disc, &mesh, [343.15, 343.15], [293.15, 393.15])
            .replace("sides = { roller = true }\n", "");
        let mut trial = Trial::new(&text);
        trial.step(1.0);
        trial.get("plate.failure_risk")
    });
    let wanted = [(coarse, 0.76), (middle, 0.96), (fine, 1.0)];
    for (risk, part) in wanted {
        assert!((risk / limit - part).abs() < 0.01, "{coarse} {middle} {fine} {limit}");
    }
}
