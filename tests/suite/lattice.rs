//! Strips of concrete as lattices of links that soften and break.

use impinge::advice::parse_with_warnings;
use impinge::model::{State, forecast};

use crate::common::Trial;

/// A notched beam, with further keys.
fn beam(keys: &str) -> String {
    format!(
        r#"
name = "Beam"
stop_time = 1.0
step = 0.1
[body.beam]
kind = "lattice"
length = 0.25
depth = 76.2e-3
thickness = 0.1524
spacing = 9.5e-3
notch = {{ depth = 19e-3, width = 2e-3 }}
support = {{ three_point = {{ span = 0.2286 }} }}
{keys}
material = {{ density = 2323.0, young = 30e9, poisson = 0.2, softening = {{ model = "openings", strength = 4.5e6, openings = [9.05e-6, 197e-6], share = 0.13 }} }}
"#
    )
}

/// A strip pulled at its ends.
fn pulled(material: &str, keys: &str) -> String {
    format!(
        r#"
name = "Strip"
stop_time = 1.0
step = 0.1
[body.strip]
kind = "lattice"
length = 0.2
depth = 0.1
thickness = 0.05
support = "ends"
{keys}
material = {{ density = 2300.0, {material} }}
"#
    )
}

const STRONG: &str =
    "softening = { model = \"openings\", strength = 1e8, openings = [1e-5, 2e-4], share = 0.13 }";

/// Opens a notch to a width [m] in equal steps; returns the loads.
fn open(trial: &mut Trial, name: &str, to: f64, steps: usize) -> Vec<f64> {
    let of_step = |step: usize| {
        trial.set(name, to * step as f64 / steps as f64);
        trial.step(0.1);
        trial.get("beam.force")
    };
    (1..=steps).map(of_step).collect()
}

/// Work of the load is stored and dissipated, whatever is prescribed and whether cracks close or not.
#[test]
fn energy_of_a_breaking_beam_balances() {
    for (keys, input) in [
        ("control = \"opening\"", "beam.opening"),
        ("control = \"opening\"\narrangement = \"along\"\ncontact = false", "beam.opening"),
        ("control = \"displacement\"", "beam.displacement"),
    ] {
        let mut trial = Trial::new(&beam(keys));
        let loads = open(&mut trial, input, 6e-5, 8);
        let peak = loads.iter().copied().fold(0.0, f64::max);
        assert!(peak > 4e3 && peak < 9e3, "{keys}: {loads:?}");
        let [work, drift, dissipated] = ["mechanical_work", "energy_drift", "dissipated_energy"]
            .map(|key| trial.get(&format!("beam.{key}")));
        assert!(drift.abs() < 1e-4 * work, "{keys}: {drift:e} J of {work:e} J");
        let damage = trial.get("beam.max_damage");
        assert!(dissipated > 0.1 * work && damage > 0.8, "{keys}: {dissipated:e} J, {damage}");
    }
}

/// A crack that is closed again dissipates nothing more; damaged links are softer, and bear pressure if they close.
#[test]
fn closing_a_crack_dissipates_nothing() {
    let mut trial = Trial::new(&beam("control = \"opening\""));
    open(&mut trial, "beam.opening", 5e-5, 5);
    let (dissipated, damage) = (trial.get("beam.dissipated_energy"), trial.get("beam.max_damage"));
    for opening in [2e-5, 0.0, -5e-6, 2e-5, 4.9e-5] {
        trial.set("beam.opening", opening);
        trial.step(0.1);
        let closed = trial.get("beam.force");
        assert!(closed * opening >= 0.0, "{closed} N at {opening:e} m");
    }
    assert_eq!(trial.get("beam.dissipated_energy"), dissipated);
    assert_eq!(trial.get("beam.max_damage"), damage);
}

/// Sudden breaks release energy and never take any, however far links open within them.
#[test]
fn sudden_breaks_release_energy() {
    const CONCRETE: &str = "young = 18e9, poisson = 0.17, softening = { model = \"openings\", strength = 3e6, openings = \
                            [12e-6, 150e-6], share = 0.2 }";
    for arrangement in ["across", "along", "random"] {
        let keys = format!("spacing = 8e-3\narrangement = \"{arrangement}\"");
        let mut trial = Trial::new(&pulled(CONCRETE, &keys));
        let mut before = 0.0;
        // Pulled, closed and pulled apart.
        for to in [1e-5, 2e-5, 3e-5, 4e-5, -1e-5, 3e-5, 5e-5, 1e-4, 3e-4] {
            trial.set("strip.displacement", to);
            trial.step(0.1);
            let [released, dissipated] = ["released_energy", "dissipated_energy"]
                .map(|key| trial.get(&format!("strip.{key}")));
            let least = before - 1e-3 * dissipated;
            assert!(released >= least, "{arrangement} at {to:e}: {released:e} after {before:e}");
            before = released;
        }
        assert!(trial.get("strip.max_damage") == 1.0);
    }
}

/// A break that ends in an equilibrium to which it does not lead seems to take energy. It happens in few samples.
#[test]
fn breaks_that_take_energy_are_warned_of() {
    let takes_energy = |seed: usize| {
        let keys = format!("control = \"opening\"\narrangement = \"random\"\nseed = {seed}");
        let text = beam(&keys)
            .replace("length = 0.25", "length = 0.25908")
            .replace("spacing = 9.5e-3", "spacing = 7.62e-3")
            .replace("depth = 19e-3, width = 2e-3", "depth = 25.4e-3");
        let mut trial = Trial::new(&text);
        let mut is_warned = false;
        for n in 1..=52 {
            let fine = f64::from(n.min(28)) * 2e-6;
            let coarse = f64::from((n - 28).max(0)) / 24.0 * (0.6e-3 - 56e-6);
            trial.set("beam.opening", fine + coarse);
            trial.step(0.1);
            let [released, dissipated] = ["released_energy", "dissipated_energy"]
                .map(|key| trial.get(&format!("beam.{key}")));
            let found = trial.model.warnings(&trial.state);
            is_warned = found.iter().any(|warning| warning.finding().id == "breaks_take_energy");
            assert_eq!(
                is_warned,
                released < -0.02 * dissipated,
                "{n}: {released:e} {dissipated:e}"
            );
        }
        is_warned
    };
    assert!((0..32).any(takes_energy));
}

/// Loads do not depend on the number of communication steps.
#[test]
fn communication_steps_do_not_matter() {
    let [few, many] = [3, 24].map(|steps| {
        let mut trial = Trial::new(&beam("control = \"opening\""));
        open(&mut trial, "beam.opening", 9e-5, steps);
        (trial.get("beam.force"), trial.get("beam.dissipated_energy"))
    });
    assert!((few.0 / many.0 - 1.0).abs() < 1e-4, "{few:?} {many:?}");
    assert!((few.1 / many.1 - 1.0).abs() < 1e-2, "{few:?} {many:?}");
}

/// The stiffness of a strip between platens tends to that of a bar whose ends cannot contract: it exceeds `E A/L` by
/// the lateral constraint, and falls below it by the half rows at the faces.
#[test]
fn pulled_strips_have_the_stiffness_of_bars() {
    for (poisson, bound) in [(0.0, 0.03), (0.2, 0.05), (1.0 / 3.0, 0.08)] {
        for arrangement in ["across", "along", "random"] {
            let material = format!("young = 30e9, poisson = {poisson:?}, {STRONG}");
            let keys = format!("spacing = 5e-3\narrangement = \"{arrangement}\"");
            let mut trial = Trial::new(&pulled(&material, &keys));
            trial.set("strip.displacement", 1e-6);
            trial.step(0.1);
            let bar = 30e9 * 0.1 * 0.05 * 1e-6 / 0.2;
            let off = trial.get("strip.force") / bar - 1.0;
            assert!(off.abs() < bound, "ν {poisson}, {arrangement}: {off:.4}");
        }
    }
}

/// Strips are as long as they should be, whatever part of a column is left at their ends: mass and compliance follow
/// the length.
#[test]
fn hexagons_fill_strips_of_any_length() {
    for (arrangement, bound) in [("across", 0.005), ("along", 0.015)] {
        let mut moduli = Vec::new();
        for length in [0.1, 0.105, 0.11, 0.117, 0.125, 0.2] {
            let material = format!("young = 30e9, poisson = 0.0, {STRONG}");
            let keys = format!("spacing = 1e-2\narrangement = \"{arrangement}\"");
            let text = pulled(&material, &keys);
            let mut trial =
                Trial::new(&text.replace("length = 0.2", &format!("length = {length}")));
            let mass = 2300.0 * length * 0.1 * 0.05;
            assert!((trial.get("strip.mass") / mass - 1.0).abs() < 1e-12, "{arrangement} {length}");
            trial.set("strip.displacement", 1e-7);
            trial.step(0.1);
            moduli.push(trial.get("strip.force") * length / (30e9 * 0.1 * 0.05 * 1e-7));
        }
        let last = moduli[moduli.len() - 1];
        let even = moduli.iter().all(|own| (own / last - 1.0).abs() < bound);
        assert!(even && last > 0.93 && last < 1.0, "{arrangement}: {moduli:?}");
    }
}

/// A notch without width cuts links beside a column that stands where it is, and takes out no particles.
#[test]
fn cuts_at_a_column_are_like_those_beside_it() {
    let column = 0.75_f64.sqrt() * 76.2e-3 / 8.0;
    let run = |at: f64| {
        let notch = format!("depth = 19e-3, at = {at:e}, width = 0.0");
        let text = beam("control = \"opening\"").replace("depth = 19e-3, width = 2e-3", &notch);
        let mut trial = Trial::new(&text);
        let mass = trial.get("beam.mass");
        (mass, open(&mut trial, "beam.opening", 1e-6, 1)[0])
    };
    let (beside, at) = (run(2.5 * column - 1e-6), run(2.5 * column));
    assert!((at.0 / beside.0 - 1.0).abs() < 1e-12, "{at:?} {beside:?}");
    assert!((at.1 / beside.1 - 1.0).abs() < 1e-9, "{at:?} {beside:?}");
}

/// A saved state continues to the bit, in another instance and on other numbers of threads.
#[test]
fn states_continue_to_the_bit() {
    let text = beam("control = \"opening\"");
    let mut trial = Trial::new(&text);
    open(&mut trial, "beam.opening", 4e-5, 4);
    let saved: State = trial.state.clone();
    let end = |trial: &mut Trial| {
        trial.set("beam.opening", 8e-5);
        trial.step(0.1);
        (trial.state.clone(), trial.get("beam.force"))
    };
    let wanted = end(&mut trial);
    for threads in [1, 2, 3] {
        let mut other = Trial::on_threads(&text, threads);
        open(&mut other, "beam.opening", 1e-5, 1);
        other.restart(&saved);
        assert!(end(&mut other) == wanted, "{threads} threads");
    }
}

/// States that no run produces are refused: damage beyond its range, forces that do not balance, forgotten damage.
#[test]
fn impossible_states_are_refused() {
    let mut trial = Trial::new(&beam("control = \"opening\""));
    open(&mut trial, "beam.opening", 4e-5, 4);
    let own = trial.state.bodies[0].clone();
    trial.model.check_state(&trial.state).unwrap();
    // The fields are displacements, which are small, damage, and five sums.
    let [force, prescribed, work] = [5, 4, 3].map(|from_end| own.len() - from_end);
    let damaged = (0..force).find(|&n| own[n] > 0.5).unwrap();
    for (place, value, words) in [
        (damaged, 1.5, "between 0 and 1"),
        (damaged, 0.0, "less damage"),
        (force, 2.0 * own[force], "do not balance"),
        (prescribed, 1e-3, "are prescribed"),
        (work, 10.0, "no cause"),
        (0, 1e-3, "do not balance"),
    ] {
        let mut state = trial.state.clone();
        state.bodies[0][place] = value;
        let refusal = trial.model.check_state(&state).unwrap_err().to_string();
        assert!(refusal.contains(words), "{refusal} for {words}");
    }
}

/// Work is rounding before a beam is bent and after it is straight again.
#[test]
fn states_after_an_elastic_cycle_are_accepted() {
    let mut trial = Trial::new(&beam("control = \"displacement\""));
    for displacement in [0.0, 1e-6, 2e-6, 1e-6, 0.0, 0.0] {
        trial.set("beam.displacement", displacement);
        trial.step(0.1);
        assert_eq!(trial.model.check_state(&trial.state), Ok(()), "{displacement}");
    }
    let mut forged = trial.state.clone();
    let work = forged.bodies[0].len() - 3;
    forged.bodies[0][work] += 1e-6;
    let refusal = trial.model.check_state(&forged).unwrap_err().to_string();
    assert!(refusal.contains("no cause"), "{refusal}");
}

/// Pulls or bends over a time [s] in equal steps; returns the loads.
fn move_over(trial: &mut Trial, name: &str, (to, time): (f64, f64), steps: usize) -> Vec<f64> {
    let body = name.split('.').next().unwrap().to_owned();
    let of_step = |step: usize| {
        trial.set(name, to * step as f64 / steps as f64);
        trial.step(time / steps as f64);
        trial.get(&format!("{body}.force"))
    };
    (1..=steps).map(of_step).collect()
}

const CONCRETE: &str = "young = 30e9, poisson = 0.2, softening = { model = \"openings\", strength = 4.5e6, openings = [9.05e-6, 197e-6], share = 0.13 }";

/// A beam that is bent slowly has the loads of one in equilibrium.
#[test]
fn slow_motion_is_equilibrium() {
    let peak = |keys: &str, time: f64| {
        let mut trial = Trial::new(&beam(keys));
        let loads = move_over(&mut trial, "beam.displacement", (3.6e-5, time), 18);
        loads.into_iter().fold(0.0, f64::max)
    };
    let resting = peak("", 1.0);
    let moving = peak("inertia = true\ndamping = 2e3", 12e-3);
    assert!((moving / resting - 1.0).abs() < 0.01, "{moving} N for {resting} N");
}

/// A strip that is torn: its work is stored, dissipated, damped or that of motion, and it falls to pieces. The error of
/// explicit steps is below 2 % of the work.
#[test]
fn energy_of_a_torn_strip_balances() {
    for (keys, least) in [
        ("arrangement = \"random\"\nseed = 1", 2.0),
        ("arrangement = \"along\"\ndamping = 2e3", 2.0),
        ("arrangement = \"random\"\ncontact = false", 2.0),
    ] {
        let keys = format!("spacing = 5e-3\ninertia = true\n{keys}");
        let mut trial = Trial::new(&pulled(CONCRETE, &keys));
        assert_eq!(trial.get("strip.fragments"), 1.0);
        move_over(&mut trial, "strip.displacement", (6e-4, 1.2e-4), 12);
        let of = |key: &str| trial.get(&format!("strip.{key}"));
        let [work, drift, dissipated, kinetic, damped, fragments] = [
            "mechanical_work",
            "energy_drift",
            "dissipated_energy",
            "kinetic_energy",
            "damped_energy",
            "fragments",
        ]
        .map(of);
        assert!(drift.abs() < 0.02 * work, "{keys}: {drift:e} J of {work:e} J");
        assert!(dissipated > 0.01 * work && kinetic > 0.1 * work, "{keys}: {dissipated} {kinetic}");
        // Faces of cracks that meet lose energy, too.
        assert_eq!(damped > 0.0, !keys.contains("contact = false"), "{keys}: {damped}");
        assert!(fragments >= least, "{keys}: {fragments}");
    }
}

/// A saved motion continues to the bit, in another instance and on other numbers of threads.
#[test]
fn motion_continues_to_the_bit_on_any_threads() {
    let text = pulled(CONCRETE, "spacing = 5e-3\ninertia = true\narrangement = \"random\"");
    let mut trial = Trial::new(&text);
    move_over(&mut trial, "strip.displacement", (2e-4, 4e-5), 4);
    let saved: State = trial.state.clone();
    let end = |trial: &mut Trial| {
        trial.set("strip.displacement", 3e-4);
        trial.step(2e-5);
        (trial.state.clone(), trial.get("strip.force"))
    };
    let wanted = end(&mut trial);
    for threads in [1, 3] {
        let mut other = Trial::on_threads(&text, threads);
        move_over(&mut other, "strip.displacement", (1e-4, 1e-5), 1);
        other.restart(&saved);
        assert!(end(&mut other) == wanted, "{threads} threads");
    }
}

/// A load faster than waves is refused, and so are states that no motion produces.
#[test]
fn impossible_motion_is_refused() {
    let text = pulled(CONCRETE, "spacing = 5e-3\ninertia = true");
    let mut trial = Trial::new(&text);
    move_over(&mut trial, "strip.displacement", (4e-4, 8e-5), 4);
    let own = trial.state.bodies[0].clone();
    trial.model.check_state(&trial.state).unwrap();
    // The fields are displacements, velocities, damage and eight sums.
    let [prescribed, work, damped] = [8, 4, 2].map(|from_end| own.len() - from_end);
    let damaged = (0..prescribed).rfind(|&n| own[n] > 0.5).unwrap();
    for (place, value, words) in [
        (damaged, 1.5, "between 0 and 1"),
        (damaged, 0.0, "less damage"),
        (prescribed, 1e-3, "otherwise than it is held"),
        (work, 2.0 * own[work], "no cause"),
        (damped, -1.0, "not negative"),
    ] {
        let mut state = trial.state.clone();
        state.bodies[0][place] = value;
        let refusal = trial.model.check_state(&state).unwrap_err().to_string();
        assert!(refusal.contains(words), "{refusal} for {words}");
    }
    trial.set("strip.displacement", 0.1);
    let refusal = trial.try_step(1e-5).unwrap_err().to_string();
    assert!(refusal.contains("faster than waves"), "{refusal}");
}

/// A strip between platens breaks suddenly, and what that releases is counted; afterwards the crack is bridged by the
/// same load in every sample, `share · strength · (w₃ − w)/(w₃ − w₂)` of the section but for its facets, which are
/// inclined.
#[test]
fn torn_strips_of_all_samples_are_bridged() {
    for (seed, arrangement) in [(0, "random"), (0, "across")] {
        let keys = format!("spacing = 1e-2\narrangement = \"{arrangement}\"\nseed = {seed}");
        let mut trial = Trial::new(&pulled(CONCRETE, &keys));
        move_over(&mut trial, "strip.displacement", (6e-5, 1.0), 3);
        let bridge = 0.13 * 4.5e6 * 0.1 * 0.05 * (197.0 - 60.0) / (197.0 - 9.05);
        let of = |key: &str| trial.get(&format!("strip.{key}"));
        let [force, work, released, drift] =
            ["force", "mechanical_work", "released_energy", "energy_drift"].map(of);
        assert!((0.9..1.5).contains(&(force / bridge)), "{keys}: {force} N for {bridge} N");
        assert!(released > 0.1 * work && drift.abs() < 1e-3 * work, "{keys}: {released} {work}");
    }
}

/// Strips torn by motion dissipate the same in all samples, and what those do that break in equilibrium, half of which
/// jump to another one.
#[test]
fn cracks_of_motion_dissipate_as_those_of_equilibrium() {
    let [mut resting, moving] = ["", "inertia = true\ndamping = 2e3"].map(|keys| {
        let of_sample = |seed: usize| {
            let keys = format!("spacing = 1e-2\nseed = {seed}\n{keys}");
            let mut trial = Trial::new(&pulled(CONCRETE, &keys));
            move_over(&mut trial, "strip.displacement", (4e-4, 1e-3), 8);
            assert_eq!(trial.get("strip.max_damage"), 1.0);
            trial.get("strip.dissipated_energy")
        };
        (0..7).map(of_sample).collect::<Vec<_>>()
    });
    let mean = moving.iter().sum::<f64>() / moving.len() as f64;
    assert!(moving.iter().all(|own| (own / mean - 1.0).abs() < 0.03), "{moving:?}");
    resting.sort_by(f64::total_cmp);
    assert!((resting[3] / mean - 1.0).abs() < 0.12, "{resting:?} J for {mean} J");
}

/// Constants of the library that links have replace those of a table.
#[test]
fn substances_name_the_constants_of_links() {
    let softening = CONCRETE.split_once("softening").unwrap().1;
    let text = pulled(CONCRETE, "spacing = 1e-2");
    let named = text.replace(
        &format!("density = 2300.0, {CONCRETE}"),
        &format!("substance = \"concrete\", softening{softening}"),
    );
    let [own, named] = [text, named].map(|text| {
        let mut trial = Trial::new(&text);
        move_over(&mut trial, "strip.displacement", (1e-6, 1.0), 1);
        [trial.get("strip.force"), trial.get("strip.mass")]
    });
    assert!((named[0] / own[0] - 31.0 / 30.0).abs() < 1e-9 && named[1] == own[1], "{named:?}");
}

/// Pieces that fly apart, turn and meet gain no energy, also long after the load has stopped.
#[test]
fn pieces_that_meet_gain_no_energy() {
    let mut trial = Trial::new(&beam("inertia = true"));
    move_over(&mut trial, "beam.displacement", (2e-3, 4e-4), 4);
    assert!(trial.get("beam.fragments") > 1.0);
    for _ in 0..10 {
        trial.step(5e-4);
    }
    let of = |key: &str| trial.get(&format!("beam.{key}"));
    let [work, drift, damped] = ["mechanical_work", "energy_drift", "damped_energy"].map(of);
    assert!(drift.abs() < 0.02 * work, "{drift} J of {work} J");
    assert!(damped >= 0.0, "{damped}");
}

/// Warnings of a scene that begin with `links_`, with their texts.
fn warned(text: &str) -> Vec<(&'static str, String)> {
    let (_, found) = parse_with_warnings(text, "scene.toml").unwrap();
    let own = found.iter().filter(|own| own.finding().id.starts_with("links_"));
    own.map(|own| (own.finding().id, own.to_string())).collect()
}

/// Links that store much up to their strength take more than the area below their law, which is warned of with a
/// spacing that does; notes have the area itself.
#[test]
fn links_too_long_for_their_law_are_warned_of() {
    let brittle = CONCRETE.replace("9.05e-6, 197e-6", "1e-6, 20e-6").replace("4.5e6", "10e6");
    // They store s f/(E (w₂ + α₁ w₃)) = 0.01 · 10/(30e3 · 3.6e-6) of it.
    let text = pulled(&brittle, "spacing = 1e-2");
    let found = warned(&text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        found[0].1,
        "scene.toml:11: body.strip.spacing = 1e-2: up to its strength a link this long stores 93 % of the area below \
         its law, 18 J/m², and its break takes both: cracks take too much energy, and loads are too high; set a \
         `spacing` of 0.0027 m or less [links_store_more_than_their_law]"
    );
    assert_eq!(warned(&pulled(&brittle, "spacing = 2.7e-3")), []);
    assert_eq!(warned(&pulled(CONCRETE, "spacing = 1e-2")), []);
    let notes = |text: &str| {
        forecast(&impinge::scene::parse(text, "scene.toml").unwrap()).lattices.remove(0).notes
    };
    let said = "the area below their law is 18 J/m², a link takes 34.7 J/m², with what it stores up to that, and a \
                crack";
    assert!(notes(&text).iter().any(|note| note.contains(said)), "{:?}", notes(&text));
    let glass = CONCRETE.replace("9.05e-6, 197e-6", "1e-8, 2e-7").replace("4.5e6", "50e6");
    let found = warned(&pulled(&glass, "spacing = 5e-3"));
    let said = "stores 230 times the area below its law, 0.9 J/m²";
    assert!(found[0].1.contains(said) && found[0].1.contains("more than a million"), "{found:?}");
}

/// Stiffness of a beam in bending over that of Timoshenko's, by the deflections of two spans, in whose difference the
/// dents below the load and above the supports cancel.
fn bent_stiffness(ratio: f64, rows: usize, arrangement: &str) -> (f64, bool) {
    let (young, depth) = (30e9, 0.1);
    let text = |span: f64| {
        let spacing = depth / rows as f64;
        pulled(
            &format!("young = {young:e}, poisson = {ratio:?}, {STRONG}"),
            &format!("spacing = {spacing:?}\narrangement = \"{arrangement}\"\nscatter = 0.0"),
        )
        .replace("length = 0.2", "length = 0.65")
        .replace("\"ends\"", &format!("{{ three_point = {{ span = {span:?} }} }}"))
    };
    let spans = [0.3, 0.6];
    let found = spans.map(|span| {
        let mut trial = Trial::new(&text(span));
        trial.set("strip.displacement", 1e-6);
        trial.step(0.1);
        1e-6 / trial.get("strip.force")
    });
    let wanted = spans.map(|span: f64| {
        let (area, second) = (0.05 * depth, 0.05 * depth.powi(3) / 12.0);
        let shear = 0.5 * young / (1.0 + ratio);
        span.powi(3) / (48.0 * young * second) + span / (4.0 * shear * 5.0 / 6.0 * area)
    });
    let is_warned = warned(&text(0.6)).iter().any(|own| own.0 == "links_stiffen_bending");
    ((wanted[1] - wanted[0]) / (found[1] - found[0]), is_warned)
}

/// Bending is right to 15 %, half rows that are missing at the faces included, or warned of.
#[test]
fn beams_that_links_stiffen_are_warned_of() {
    for (arrangement, rows, ratio, is_wrong) in [
        ("across", 12, -0.99, true),
        ("across", 12, -0.97, true),
        ("across", 12, -0.93, false),
        ("across", 12, -0.5, false),
        ("across", 24, -0.97, false),
        ("along", 12, -0.99, true),
        ("along", 12, -0.93, false),
        ("random", 12, -0.95, true),
        ("random", 12, -0.89, false),
    ] {
        let (stiffness, is_warned) = bent_stiffness(ratio, rows, arrangement);
        let case = format!("{arrangement}, {rows} rows, ν {ratio}: {stiffness:.3}");
        assert_eq!((stiffness - 1.0).abs() > 0.15, is_wrong, "{case}");
        assert_eq!(is_warned, is_wrong, "{case}");
    }
    let text = pulled(
        &CONCRETE.replace("poisson = 0.2", "poisson = -0.99"),
        "spacing = 8.333333e-3\ninitial_temperature = 300.0",
    );
    assert_eq!(warned(&text), []);
    let bent = text.replace("\"ends\"", "{ three_point = { span = 0.18 } }");
    let found = warned(&bent);
    let said = "at a ratio of -0.99 links resist bending by themselves, and make the strip stiffer by 139 % of its \
                stiffness in bending; set a ratio of -0.93 or more, or a `spacing` of 0.0031 m or less";
    assert!(found.len() == 1 && found[0].1.contains(said), "{found:?}");
    assert_eq!(warned(&bent.replace("8.333333e-3", "3.1e-3")), []);
    assert_eq!(warned(&bent.replace("-0.99", "-0.93")), []);
}

/// Strips that reach just beyond their supports are as stiff as longer ones: what lies there bears nothing.
#[test]
fn supports_near_the_ends_keep_their_span() {
    let force = |arrangement: &str, length: f64| {
        let text = format!(
            r#"
name = "Strip"
stop_time = 1.0
step = 1.0
[body.strip]
kind = "lattice"
length = {length}
depth = 0.03
thickness = 0.02
spacing = 5e-3
arrangement = "{arrangement}"
support = {{ three_point = {{ span = 0.1 }} }}
control = "displacement"
material = {{ density = 2300.0, young = 30e9, poisson = 0.2, softening = {{ model = "openings", strength = 4e6, openings = [9e-6, 197e-6], share = 0.13 }} }}
"#
        );
        let mut trial = Trial::new(&text);
        trial.set("strip.displacement", 1e-7);
        trial.step(1.0);
        trial.get("strip.force")
    };
    for arrangement in ["across", "along"] {
        let long = force(arrangement, 0.13);
        for length in [0.11, 0.1125, 0.115] {
            let ratio = force(arrangement, length) / long;
            assert!((0.95..1.03).contains(&ratio), "{arrangement}, {length} m: {ratio}");
        }
    }
}
