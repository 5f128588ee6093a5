//! Drops that inputs release: they are those of arrivals, wait for their place, and all that they bring is accounted
//! for.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::model::tolerance::warnings;
use impinge::model::{ModelError, forecast};
use impinge::scene;

const STEP: f64 = 1e-7;
const DIAMETER: f64 = 1e-4;
const DENSITY: f64 = 1000.0;
const HEAT: f64 = 4180.0;
const TILES: &str = "tiles = { count = [8, 8], size = [4e-4, 4e-4] }";
const RINGS: &str = "rings = { count = 4, radius = 2e-4 }";

/// A coarse drop with further keys.
fn drop(keys: &str) -> String {
    format!(
        "name = \"Drops\"\nstop_time = 4e-6\nstep = {STEP:?}\n[body.drop]\nkind = \"droplet\"\ndiameter = \
         {DIAMETER:?}\nimpact_velocity = 20.0\ninitial_temperature = 350.0\nspacing = 1e-5\nheight = 2e-5\nfluid = {{ \
         density = {DENSITY:?}, viscosity = 1e-3, specific_heat = {HEAT:?}, conductivity = 0.6 }}\n{keys}\n"
    )
}

fn wall(footprint: &str) -> String {
    format!(
        "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ {footprint} }}\nstart = {{ temperature = 300.0 }}\n"
    )
}

fn plate(shape: &str) -> String {
    format!(
        "[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\nmaterial = {{ model = \"thermoelastic\", density = \
         3950.0, specific_heat = 900.0, conductivity = 10.0 }}\ninitial_temperature = 300.0\nmesh = {{ spacing = 2e-5, \
         depth_spacing = 2e-6, growth = 1.0, order = 1 }}\n[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\ntraction \
         = false\n"
    )
}

const BOX: &str = "box = [6e-4, 6e-4, 2e-5]";
const ON_DEMAND: &str = "release = \"input\"\nmost = 5\n";

fn ask(trial: &mut Trial, inputs: &[(&str, f64)]) {
    inputs.iter().for_each(|(key, value)| trial.set(&format!("drop.{key}"), *value));
}

fn steps(trial: &mut Trial, count: usize) {
    (0..count).for_each(|_| trial.step(STEP));
}

/// Released and waiting.
fn counts(trial: &mut Trial) -> [f64; 2] {
    ["released", "waiting"].map(|key| trial.get(&format!("drop.{key}")))
}

#[test]
fn drops_that_still_wait_at_the_end_are_warned_of() {
    let mut trial = Trial::new(&(drop(ON_DEMAND) + &wall(TILES)));
    steps(&mut trial, 1);
    let found = trial.model.closing_warnings(&trial.state);
    assert_eq!(found[0].finding().id, "no_drop_asked_for");
    ask(&mut trial, &[("release", 1.0)]);
    steps(&mut trial, 1);
    assert_eq!(trial.model.closing_warnings(&trial.state), []);
    ask(&mut trial, &[("release", 2.0)]);
    steps(&mut trial, 1);
    assert_eq!(counts(&mut trial), [1.0, 1.0]);
    let found = trial.model.closing_warnings(&trial.state);
    assert!(found[0].to_string().contains("1 of 2 drops asked for are not released"), "{found:?}");
}

/// A drop of `arrivals` waits, too, while fluid that stays tall is where it starts, and a warning says so; it continues
/// from a saved state.
#[test]
fn arrivals_wait_for_their_place() {
    let text = |height: &str| {
        let keys = "gravity = 9.81\narrivals = [{ time = 0.0 }, { time = 0.03 }]\n[[wall]]\nname = \"wall\"\nunder = \
                    \"drop\"\nfootprint.rings = { count = 5, radius = 4e-3 }";
        format!(
            "name = \"Pile\"\nstop_time = 0.06\nstep = 5e-3\n[body.drop]\nkind = \"droplet\"\ndiameter = 2e-3\n\
             impact_velocity = 0.1\ninitial_temperature = 300.0\nspacing = 0.2e-3\nheight = {height}\nfluid = {{ density = \
             1200.0, viscosity = 0.3, specific_heat = 2400.0, conductivity = 0.0, surface_tension = 0.06, contact_angle = \
             2.4 }}\n{keys}\n"
        )
    };
    let mass = PI / 6.0 * 2e-3_f64.powi(3) * 1200.0;
    for (height, released) in [("1e-3", 1.0), ("4e-3", 2.0)] {
        let mut trial = Trial::new(&text(height));
        (0..12).for_each(|_| trial.step(5e-3));
        assert!(off(trial.get("drop.mass"), released * mass) < 1e-9, "{height}");
        assert!(trial.get("drop.max_density") < 1.1 * 1200.0, "{height}");
        let said = trial.model.warnings(&trial.state);
        let late: Vec<_> = said.iter().map(|one| one.to_string()).collect();
        let is_told = late.iter().any(|one| one.contains("the drop due at 0.03 s is not released"));
        assert_eq!(is_told, released == 1.0, "{late:?}");
        trial.model.check_state(&trial.state).unwrap();
    }
    // Without the fluid in its way no run makes it wait.
    let mut trial = Trial::new(&text("4e-3"));
    (0..5).for_each(|_| trial.step(5e-3));
    let mut forged = trial.state.clone();
    forged.bodies[0][0] = 0.035;
    let refusal = trial.model.check_state(&forged).unwrap_err().to_string();
    assert!(refusal.contains("1 drops released, where 2 are due"), "{refusal}");
}

#[test]
fn drops_on_demand_are_those_of_arrivals_to_the_bit() {
    let arrivals =
        "symmetry = \"none\"\narrivals = [{ x = 4e-5 }, { time = 1e-6, x = -9e-5, y = 3e-5 }]\n";
    for below in [wall(TILES), plate(BOX), String::new()] {
        let mut timed = Trial::new(&(drop(arrivals) + &below));
        let mut asked = Trial::new(&(drop(ON_DEMAND) + &below));
        ask(&mut asked, &[("release", 1.0), ("x", 4e-5)]);
        for step in 0..16 {
            if step == 10 {
                ask(&mut asked, &[("release", 2.0), ("x", -9e-5), ("y", 3e-5)]);
            }
            timed.step(STEP);
            asked.step(STEP);
        }
        // The mesh of a plate lies about the arrivals, and its nodes differ by rounding.
        let exact = !below.contains("plate");
        // Of what is zero there is rounding alone.
        let is_compared = |name: &&String| exact || !name.ends_with("heat_drift");
        for name in timed.outputs().iter().filter(is_compared) {
            let [one, other] = [&mut timed, &mut asked].map(|trial| trial.get(name));
            let same = one.to_bits() == other.to_bits();
            assert!(same || (!exact && off(one, other) < 1e-9), "{name}: {one} {other}");
        }
        assert_eq!(counts(&mut asked), [2.0, 0.0]);
    }
}

/// What is round takes drops on its axis alone, which are rings then; on demand they are those of arrivals.
#[test]
fn drops_on_demand_on_what_is_round_are_rings() {
    for below in [wall(RINGS), plate("disc = { radius = 3e-4, thickness = 2e-5 }")] {
        let mut timed = Trial::new(&(drop("") + &below));
        let mut asked = Trial::new(&(drop(ON_DEMAND) + &below));
        ask(&mut asked, &[("release", 1.0)]);
        for _ in 0..16 {
            timed.step(STEP);
            asked.step(STEP);
        }
        for key in ["heat", "impulse_z", "kinetic_energy", "spread_diameter", "particles"] {
            let name = format!("drop.{key}");
            let [one, other] = [&mut timed, &mut asked].map(|trial| trial.get(&name));
            assert!(off(one, other) < 1e-9, "{name}: {one} {other}");
        }
        let rings = PI / 8.0 * (DIAMETER / 1e-5).powi(2);
        assert!(off(asked.get("drop.particles"), rings) < 0.1);
        let mass = PI / 6.0 * DENSITY * DIAMETER.powi(3);
        assert!(off(asked.get("drop.mass"), mass) < 1e-12);
        let momentum = asked.get("drop.momentum_z") + asked.get("drop.impulse_z");
        assert!(off(momentum, -20.0 * mass) < 1e-6, "{momentum}");
        let [given, kept] = ["heat", "heat_stored"].map(|key| asked.get(&format!("drop.{key}")));
        assert!(given > 0.0 && off(given, -kept) < 1e-6, "{given} {kept}");
    }
}

#[test]
fn nothing_is_there_before_it_is_released() {
    let mut trial = Trial::new(&(drop(ON_DEMAND) + &wall(TILES)));
    steps(&mut trial, 3);
    let numbers = trial.state.bodies[0].len();
    assert!(numbers < 400, "{numbers}");
    for key in [
        "mass",
        "particles",
        "heat",
        "momentum_z",
        "released",
        "waiting",
        "spread_diameter",
        "height",
    ] {
        assert_eq!(trial.get(&format!("drop.{key}")), 0.0, "{key}");
    }
    assert_eq!(trial.get("drop.max_temperature"), 350.0);
    ask(&mut trial, &[("release", 1.0)]);
    trial.step(STEP);
    let one = (trial.state.bodies[0].len() - numbers) / 30;
    assert_eq!(one as f64, trial.get("drop.particles"));
    let said = forecast(trial.model.scene());
    assert!((said.droplets[0].particles as f64 / (5 * one) as f64 - 1.0).abs() < 0.08, "{said:?}");
}

/// Three drops at one place: each starts when the one before has left it, as it was asked for.
#[test]
fn a_drop_waits_until_its_place_is_free() {
    let mut trial = Trial::new(&(drop(ON_DEMAND) + &wall(TILES)));
    ask(&mut trial, &[("release", 3.0), ("temperature", 360.0), ("speed", 30.0)]);
    trial.step(STEP);
    assert_eq!(counts(&mut trial), [1.0, 2.0]);
    // Beside them there is room, for one that was asked for later, and is as the inputs are now.
    ask(&mut trial, &[("release", 4.0), ("temperature", 310.0), ("speed", 0.0), ("x", 1.3e-4)]);
    trial.step(STEP);
    assert_eq!(counts(&mut trial), [2.0, 2.0]);
    let particles = trial.get("drop.particles");
    let saved = trial.state.clone();
    let mut before = counts(&mut trial);
    // A drop that rests beside the place of the others, and moves no further, is not in their way.
    let mut starts = Vec::new();
    for step in 0..120 {
        trial.step(STEP);
        let now = counts(&mut trial);
        assert_eq!(now[0] + now[1], 4.0);
        if now != before {
            assert_eq!(now[0], before[0] + 1.0);
            assert_eq!(trial.get("drop.particles"), 0.5 * particles * now[0]);
            assert_eq!(trial.get("drop.max_temperature"), 360.0, "it is as it was asked for");
            starts.push(step);
        }
        before = now;
    }
    assert!(!starts.is_empty(), "{before:?}");
    // A drop of its speed takes so long to leave its place and half a distance of particles; it bounces off none.
    let leaves = (DIAMETER + 0.5e-5) / 30.0 / STEP;
    assert!(starts[0] as f64 + 2.0 > 0.6 * leaves, "{starts:?} {leaves}");
    let end = trial.state.clone();
    trial.restart(&saved);
    steps(&mut trial, 120);
    assert_eq!(trial.state, end, "a saved state goes on to the bit");
}

#[test]
fn all_that_drops_bring_is_accounted_for() {
    let mass = PI / 6.0 * DIAMETER.powi(3) * DENSITY;
    for below in [wall(TILES), plate(BOX)] {
        let mut trial = Trial::new(&(drop(ON_DEMAND) + &below));
        let (mut brought, mut count) = ([0.0; 2], 0.0);
        // Speeds and temperatures.
        for (n, (speed, temperature)) in
            [(20.0, 350.0), (35.0, 320.0), (10.0, 370.0)].into_iter().enumerate()
        {
            count += 1.0;
            let x = [-1.2e-4, 0.0, 1.2e-4][n];
            ask(
                &mut trial,
                &[("release", count), ("x", x), ("speed", speed), ("temperature", temperature)],
            );
            brought = [brought[0] + mass * HEAT * (temperature - 350.0), brought[1] - mass * speed];
            steps(&mut trial, 12);
            assert!(off(trial.get("drop.mass"), count * mass) < 1e-9);
            assert_eq!(counts(&mut trial), [count, 0.0]);
            let [given, stored] =
                ["heat", "heat_stored"].map(|key| trial.get(&format!("drop.{key}")));
            let scale = mass * HEAT * 50.0;
            assert!((given + stored).abs() < 1e-6 * scale, "{given} {stored}");
            let momentum = trial.get("drop.momentum_z") + trial.get("drop.impulse_z");
            assert!(off(momentum, brought[1]) < 1e-4, "{momentum} {}", brought[1]);
            for axis in ["x", "y"] {
                let along =
                    ["momentum", "impulse"].map(|key| trial.get(&format!("drop.{key}_{axis}")));
                assert!((along[0] + along[1]).abs() < 1e-4 * -brought[1], "{axis}: {along:?}");
            }
        }
        let given = trial.get("drop.heat");
        assert!(given > 1e-9, "{given}");
        if below.contains("plate") {
            assert!(off(trial.get("plate.heat_in"), given) < 1e-12);
            assert!(trial.heat_residual("plate") < 1e-9);
        }
    }
}

fn refusal(trial: &mut Trial) -> String {
    let before = trial.state.clone();
    let refused = trial.try_step(STEP).expect_err("no refusal");
    assert!(matches!(refused, ModelError::Body(_)), "{refused}");
    assert_eq!(trial.state.bodies, before.bodies);
    refused.to_string()
}

#[test]
fn what_no_drop_can_be_like_is_refused() {
    let refused = |text: &str, inputs: &[(&str, f64)], words: &str| {
        let mut trial = Trial::new(text);
        ask(&mut trial, &[("release", 1.0)]);
        trial.step(STEP);
        ask(&mut trial, inputs);
        let said = refusal(&mut trial);
        assert!(said.contains(words), "{inputs:?}: {said}");
        let fine =
            [("release", 2.0), ("x", 0.0), ("y", 0.0), ("speed", 5.0), ("temperature", 340.0)];
        ask(&mut trial, &fine);
        trial.step(STEP);
        assert_eq!(counts(&mut trial), [1.0, 1.0]);
    };
    let tiles = drop(ON_DEMAND) + &wall(TILES);
    for count in [1.5, -1.0, 0.999] {
        refused(&tiles, &[("release", count)], "is no number of drops (allowed: 0, 1, 2, …)");
    }
    refused(
        &tiles,
        &[("release", 0.0)],
        "0 drops, where 1 have been asked for: the count of all drops does not fall",
    );
    refused(
        &tiles,
        &[("release", 6.0)],
        "6 drops, of which there are 5 at most (`most` of the scene)",
    );
    refused(&tiles, &[("speed", -1.0)], "allowed: 0 to 40 m/s");
    refused(&tiles, &[("speed", 40.1)], "allowed: 0 to 40 m/s");
    refused(&tiles, &[("temperature", 0.0)], "0 K is not above absolute zero");
    refused(&tiles, &[("x", 1e9)], "places are lost in rounding there");
    let centred = "(allowed: 0)";
    refused(
        &(drop(ON_DEMAND) + &wall(RINGS)),
        &[("x", 1e-6)],
        "a wall of rings needs drops straight down at x = 0, y = 0",
    );
    let disc = drop(ON_DEMAND) + &plate("disc = { radius = 3e-4, thickness = 2e-5 }");
    refused(&disc, &[("y", 1e-6)], centred);
    let quarter = drop(&format!("{ON_DEMAND}symmetry = \"quarter\"\n"));
    refused(&(quarter + &wall(TILES)), &[("y", -1e-6)], "a model of a part of the drops needs");
    let plate = drop(ON_DEMAND) + &plate(BOX);
    refused(&plate, &[("y", -2.51e-4)], "that is beside `plate` (allowed: -0.00025 to 0.00025 m)");
}

#[test]
fn a_count_that_is_interpolated_is_refused() {
    let mut trial = Trial::new(&(drop(ON_DEMAND) + &wall(TILES)));
    trial.set_derivative("drop.release", 1, 1.0 / STEP);
    assert!(refusal(&mut trial).contains("a count has no time derivative"));
}

#[test]
fn a_plane_model_has_drops_on_demand_too() {
    let text = drop(&format!("{ON_DEMAND}dimension = 2\n"))
        + &wall("tiles = { count = [8, 1], size = [4e-4, 1.0] }");
    let mut trial = Trial::new(&text);
    ask(&mut trial, &[("release", 1.0), ("x", -8e-5)]);
    steps(&mut trial, 2);
    ask(&mut trial, &[("release", 2.0), ("x", 8e-5), ("speed", 25.0)]);
    steps(&mut trial, 10);
    assert_eq!(counts(&mut trial), [2.0, 0.0]);
    let momentum = trial.get("drop.momentum_z") + trial.get("drop.impulse_z");
    let mass = PI / 4.0 * DIAMETER * DIAMETER * DENSITY;
    assert!(off(momentum, -45.0 * mass) < 1e-4, "{momentum}");
}

/// States that no run leads to, by the place of a number among those before the cells: counts contradict each other.
#[test]
fn states_that_contradict_the_count_are_refused() {
    let mut trial = Trial::new(&drop(ON_DEMAND));
    ask(&mut trial, &[("release", 3.0)]);
    trial.step(STEP);
    let state = trial.state.clone();
    trial.model.check_state(&state).unwrap();
    // Behind the ledger: asked, then six numbers of each drop that waits.
    let ledger = state.bodies[0].iter().position(|&number| number == 3.0).unwrap();
    for (place, value, words) in [
        (1, 2.0, "more drops wait"),
        (1, 0.5, "drops released of 3"),
        (1, 4.0, "drops released of 3"),
        (ledger, 2.0, "more drops wait"),
        (ledger, 6.0, "of at most 5"),
        (ledger, -1.0, "of at most 5"),
        (ledger + 1, 1e12, "a waiting drop at"),
        (ledger + 4, 1e9, "a waiting drop at"),
        (ledger + 6, -1.0, "a waiting drop at"),
        (ledger + 1 + 12, 1.0, "more drops wait"),
    ] {
        let mut forged = state.clone();
        forged.bodies[0][place] = value;
        let refused = trial.model.check_state(&forged).unwrap_err().to_string();
        assert!(refused.contains(words), "{place} {value}: {refused}");
    }
    let mut forged = state.clone();
    forged.bodies[0][1] = 2.0;
    forged.bodies[0][ledger + 1 + 6..][..6].fill(0.0);
    let refused = trial.model.check_state(&forged).unwrap_err().to_string();
    assert!(refused.contains("particles, where 2 drops have"), "{refused}");
}

/// Drops fall on the middle of a disc, and anywhere on a box.
#[test]
fn drops_that_may_miss_the_fine_mesh_are_warned_of() {
    for (shape, wanted) in [(BOX, 1), ("disc = { radius = 3e-4, thickness = 2e-5 }", 0)] {
        let scene = scene::parse(&(drop(ON_DEMAND) + &plate(shape)), "scene.toml").unwrap();
        let found = warnings(&scene, &[]);
        let of_landing = found.iter().filter(|warning| warning.to_string().contains("fine out to"));
        assert_eq!(of_landing.count(), wanted, "{shape}");
    }
}

#[test]
fn a_scene_says_either_when_or_how_many() {
    let refused = |keys: &str, words: &str| {
        let error = scene::parse(&drop(keys), "scene.toml").unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused("release = \"input\"\n", "body.drop.most: inputs release the drops");
    refused(&format!("{ON_DEMAND}arrivals = [{{ time = 0.0 }}]"), "which have no times of arrival");
    refused("most = 3", "`arrivals` release the drops");
    refused("release = \"input\"\nmost = 0", "allowed: 1 to 10000");
    refused("release = \"input\"\nmost = 10001", "allowed: 1 to 10000");
    refused("release = \"now\"\nmost = 1", "allowed: arrivals, input");
    refused(
        "release = \"input\"\nmost = 10000\nplacement = \"blue_noise\"\nsupport = 3.0\nspacing = 4e-6",
        "spacing",
    );
}

/// Before the first drop nothing yields.
#[test]
fn yielding_fluid_runs_before_its_first_drop() {
    let law = "{ law = \"bingham\", yield_stress = 5.0, plastic_viscosity = 0.01 }";
    let text = drop(ON_DEMAND).replace("viscosity = 1e-3", &format!("viscosity = {law}"));
    let mut trial = Trial::new(&(text + &wall(TILES)));
    let read = |trial: &mut Trial| {
        ["yielded_fraction", "creep", "mass"].map(|key| trial.get(&format!("drop.{key}")))
    };
    assert_eq!(read(&mut trial), [0.0; 3]);
    steps(&mut trial, 1);
    assert_eq!(read(&mut trial), [0.0; 3]);
    ask(&mut trial, &[("release", 1.0)]);
    steps(&mut trial, 2);
    let [yielded, _, mass] = read(&mut trial);
    assert!((0.0..=1.0).contains(&yielded) && mass > 0.0, "{yielded} of {mass} kg");
}

/// Fluid beyond the edge of a plate has nothing below: it keeps its heat, and all temperatures stay between those of
/// drop and plate, whatever the drops of the scene would be like.
#[test]
fn fluid_over_an_edge_relaxes_towards_nothing() {
    for corner in [[1.0e-4, 0.0], [1.0e-4, 0.9e-4], [-1.0e-4, 1.0e-4]] {
        let scene = drop(ON_DEMAND) + &plate("box = [3e-4, 3e-4, 2e-5]");
        let mut trial = Trial::new(&scene);
        let [x, y] = corner;
        // The scene's own temperature, 350 K, lies beyond both.
        ask(&mut trial, &[("release", 1.0), ("x", x), ("y", y), ("temperature", 320.0)]);
        let mut given: f64 = 0.0;
        for _ in 0..100 {
            trial.step(STEP);
            given = given.max(trial.get("drop.heat").abs());
            let [most, least] =
                ["max", "min"].map(|key| trial.get(&format!("drop.{key}_temperature")));
            assert!(most <= 320.0 + 1e-2 && least >= 300.0 - 1e-2, "{corner:?}: {least} to {most}");
        }
        let drift = trial.get("drop.heat_drift").abs();
        assert!(trial.get("drop.force_outside").abs() + trial.get("drop.released") > 0.0);
        assert!(given > 1e-9 && drift < 1e-4 * given, "{corner:?}: {drift} J of {given} J");
    }
}

/// Drops far from each other do not know of each other: the heat that they give is the sum of what each gives alone,
/// whatever their temperatures.
#[test]
fn drops_of_different_warmth_give_what_each_gives_alone() {
    let scene = drop(ON_DEMAND) + &wall("tiles = { count = [12, 6], size = [6e-4, 3e-4] }");
    let places = [-1.5e-4, 1.5e-4];
    let heat = |temperatures: &[Option<f64>; 2]| {
        let mut trial = Trial::new(&scene);
        for (x, temperature) in places.iter().zip(temperatures) {
            if let Some(temperature) = temperature {
                let release = trial.get("drop.released") + 1.0;
                ask(&mut trial, &[("release", release), ("x", *x), ("temperature", *temperature)]);
            }
            steps(&mut trial, 20);
        }
        steps(&mut trial, 40);
        trial.get("drop.heat")
    };
    let alone = heat(&[Some(350.0), None]);
    for other in [350.0, 349.999, 330.0, 300.0, 280.0] {
        let second = heat(&[None, Some(other)]);
        let both = heat(&[Some(350.0), Some(other)]);
        let off = off(both, alone + second);
        // In one model their fluids share the steps in time.
        assert!(off < 1.5e-2, "{other} K: {both} instead of {alone} + {second}, off by {off}");
    }
}
