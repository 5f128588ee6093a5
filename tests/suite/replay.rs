//! Drops that are repeated: each gives what the one drop gives that is known, wherever and whenever it comes down.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::model::ModelError;
use impinge::model::tolerance::warnings;
use impinge::scene;
use impinge::warning::Warning;

const DIAMETER: f64 = 1e-4;
const SPEED: f64 = 20.0;
const DENSITY: f64 = 1000.0;
const HEAT: f64 = 4180.0;
pub const STEP: f64 = 5e-7;

/// A coarse drop of ink at 350 K, with further keys.
pub fn drop(method: &str, keys: &str) -> String {
    let spacing = if method == "film" { "" } else { "spacing = 1e-5\n" };
    format!(
        "name = \"Drops\"\nstop_time = 2e-5\nstep = {STEP:?}\n[body.drop]\nkind = \"droplet\"\nmethod = \"{method}\"\ndiameter = \
         {DIAMETER:?}\nimpact_velocity = {SPEED:?}\ninitial_temperature = 350.0\n{spacing}fluid = {{ density = {DENSITY:?}, \
         viscosity = 4e-3, specific_heat = {HEAT:?}, conductivity = 0.6, surface_tension = 0.05 }}\n{keys}\n"
    )
}

/// A plate below it, with further keys of the coupling.
pub fn plate(temperature: f64, keys: &str) -> String {
    format!(
        "[body.plate]\nkind = \"solid\"\nshape = {{ box = [1e-3, 1e-3, 1e-4] }}\nmaterial = {{ model = \"thermoelastic\", \
         density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }}\ninitial_temperature = {temperature:?}\nmesh = {{ \
         spacing = 2.5e-5, depth_spacing = 1e-6, growth = 1.5, order = 1 }}\n[[coupling]]\nfrom = \"drop\"\nto = \
         \"plate.top\"\ntraction = false\nradius = 1.5e-4\n{keys}\n"
    )
}

/// Tiles below it, which are held at 300 K.
pub const TILES: &str = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = { tiles = { count = [8, 8], size = [1e-3, \
                     1e-3] } }\nstart = { temperature = 300.0 }\n";
const ON_DEMAND: &str = "release = \"input\"\nmost = 5\n";

fn mass() -> f64 {
    PI / 6.0 * DIAMETER.powi(3) * DENSITY
}

/// Heat that a drop has to give to what is at 300 K.
pub fn content() -> f64 {
    mass() * HEAT * 50.0
}

pub fn steps(trial: &mut Trial, count: usize) {
    (0..count).for_each(|_| trial.step(STEP));
}

pub fn get<const N: usize>(trial: &mut Trial, keys: [&str; N]) -> [f64; N] {
    keys.map(|key| trial.get(&format!("drop.{key}")))
}

#[test]
fn a_single_drop_gives_what_its_particles_give() {
    let mut heats = Vec::new();
    for (method, momentum) in [("sph", 0.05), ("record", 0.05), ("film", 1e-3)] {
        // Films of coarser drops are thinner than their particles.
        let text = drop(method, "").replace("spacing = 1e-5", "spacing = 6.25e-6");
        let mut trial = Trial::new(&(text + &plate(300.0, "")));
        steps(&mut trial, 40);
        let [given, stored, pushed] = get(&mut trial, ["heat", "heat_stored", "impulse_z"]);
        let taken = trial.get("plate.heat_in");
        assert!(off(taken, given) < 1e-12, "{method}: {given} J become {taken} J");
        assert!(off(-stored, given) < 1e-6, "{method}: {stored} {given}");
        assert!(trial.heat_residual("plate") < 1e-9);
        let part = pushed / (mass() * SPEED);
        assert!((part + 1.0).abs() < momentum, "{method}: {part}");
        heats.push(given / content());
    }
    assert!(off(heats[1], heats[0]) < 0.05, "{heats:?}");
    assert!(off(heats[2], heats[0]) < 0.2, "{heats:?}");
}

/// Mercury at We 5.6, which spreads to 1.8 D where fits for fast impacts have less than D, on what conducts better and
/// far less than it does.
#[test]
fn slow_drops_give_what_their_particles_give_to_conductors_and_insulators() {
    for material in [
        "density = 3950.0, specific_heat = 900.0, conductivity = 10.0",
        "density = 240.0, specific_heat = 1900.0, conductivity = 0.085",
    ] {
        let heat = |method: &str| {
            let text = format!(
                "name = \"Mercury\"\nstop_time = 2e-4\nstep = 1e-5\n[body.drop]\nkind = \"droplet\"\nmethod = \
                 \"{method}\"\nsymmetry = \"quarter\"\ndiameter = 2e-4\nimpact_velocity = 1.0\ninitial_temperature = \
                 360.0\nspacing = 1.7e-5\nfluid = {{ density = 13500.0, viscosity = 1.5e-3, specific_heat = 140.0, \
                 conductivity = 8.5, surface_tension = 0.485 }}\n[body.plate]\nkind = \"solid\"\nshape = {{ disc = {{ \
                 radius = 8e-4, thickness = 2e-4 }} }}\nmaterial = {{ model = \"thermoelastic\", {material} \
                 }}\ninitial_temperature = 310.0\n[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\n"
            );
            let mut trial = Trial::new(&text);
            (0..20).for_each(|_| trial.step(1e-5));
            trial.get("drop.heat")
        };
        let [particles, repeated] = ["sph", "record"].map(heat);
        assert!(off(repeated, particles) < 0.06, "{material}: {repeated} J beside {particles} J");
    }
}

/// What is given within a step that is far longer than a drop takes to come down or to cool reaches the plate when it
/// should: one step and two hundred leave it as warm. So do steps that begin while drops cool, and several drops.
#[test]
fn steps_far_longer_than_drops_take_to_cool_leave_plates_as_warm() {
    const GLASS: &str = "density = 2500.0, specific_heat = 800.0, conductivity = 1.0";
    const STEEL: &str = "density = 7900.0, specific_heat = 500.0, conductivity = 16.0";
    let arrivals =
        "arrivals = [{ time = 0.0, x = 0.0, y = 0.0 }, { time = 4e-3, x = 0.0, y = 0.0 }]";
    for (method, material, keys) in
        [("film", GLASS, ""), ("film", STEEL, ""), ("film", GLASS, arrivals), ("record", STEEL, "")]
    {
        let text = format!(
            "{}[body.plate]\nkind = \"solid\"\nshape = {{ disc = {{ radius = 1e-3, thickness = 1e-3 }} }}\nmaterial = {{ \
             model = \"thermoelastic\", {material} }}\ninitial_temperature = 300.0\n[[coupling]]\nfrom = \"drop\"\nto = \
             \"plate.top\"\n[[probe]]\nname = \"centre\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = \
             [\"temperature\"]\n",
            drop(method, keys)
        );
        let mut trial = Trial::new(&text);
        let start = trial.state.clone();
        // 50 and 1600 D/U.
        for time in [2.5e-4, 8e-3] {
            let mut risen = |count: usize| {
                trial.restart(&start);
                (0..count).for_each(|_| trial.step(time / count as f64));
                trial.get("centre.temperature") - 300.0
            };
            let fine = risen(200);
            for count in [1, 3] {
                let found = risen(count);
                assert!(
                    off(found, fine) < 0.01,
                    "{method} {material} {time} {count}: {found} {fine}"
                );
            }
        }
    }
}

/// Exchanges of other bodies cut steps further, but keep no moments of drops.
#[test]
fn exchanges_of_other_bodies_leave_a_plate_as_warm_under_drops() {
    let arrivals = "arrivals = [{ time = 3.3e-4, x = 1e-4 }, { time = 1.2e-3, x = -1e-4 }]";
    let heat = |others: &str, count: usize| {
        let text = drop("film", arrivals) + &plate(300.0, "").replace("10.0 }", "1.0 }") + others;
        let mut trial = Trial::new(&text);
        (0..count).for_each(|_| trial.step(4e-3 / count as f64));
        trial.get("drop.heat")
    };
    let chuck = "[body.chuck]\nkind = \"reservoir\"\nheat_capacity = 1.0\ninitial_temperature = 300.0\n[[coupling]]\nfrom \
                 = \"chuck.top\"\nto = \"plate.bottom\"\nconductance = 1e3\ninterval = 2e-3\n";
    let ink = "[body.ink]\nkind = \"filament\"\nfluid = { density = 1e3, viscosity = 1.0, specific_heat = 1e3, conductivity \
               = 0.2 }\nnozzle = { diameter = 2e-4, height = 3e-4, temperature = 320.0 }\nmost = 1e-9\npath = { time = \
               [1.0, 2.0], x = [3e-4, 3e-4], y = [-3e-4, 3e-4] }\n[[coupling]]\nfrom = \"ink\"\nto = \"plate.top\"\n";
    for others in ["", chuck, ink] {
        let [long, short] = [1, 40].map(|count| heat(others, count));
        assert!(off(long, short) < 0.02, "{others}: {long} J in one step, {short} J in 40");
    }
}

/// Drops that hardly fall are pulled down by tension, and give what momentum they have; fast thin ones go on until they
/// are as wide as Roisman (2009) or Pasandideh-Fard et al. (1996) say.
#[test]
fn films_give_all_momentum_of_slow_drops_and_spread_as_wide_as_fast_ones_do() {
    for speed in [0.1, 0.3, 1.0] {
        let text = drop("film", "").replace(&format!("{SPEED:?}"), &format!("{speed:?}"));
        let mut trial = Trial::new(&(text + &plate(300.0, "")));
        (0..20).for_each(|_| trial.step(2e-4));
        let part = -trial.get("drop.impulse_z") / (mass() * speed);
        assert!((part - 1.0).abs() < 1e-4, "{speed} m/s: {part}");
        // What has come to rest stays as wide.
        let spread = trial.get("drop.spread_diameter");
        trial.step(10.0);
        trial.step(1.0);
        assert!(off(trial.get("drop.spread_diameter"), spread) < 0.05, "{speed} m/s: {spread}");
    }
    let text = drop("film", "").replace("viscosity = 4e-3", "viscosity = 1e-4");
    let mut trial = Trial::new(&(text.replace(&format!("{SPEED:?}"), "80.0") + TILES));
    let widest = (0..400).map(|_| {
        trial.step(1e-7);
        trial.get("drop.spread_diameter")
    });
    let found = widest.fold(0.0, f64::max) / DIAMETER;
    let (reynolds, weber): (f64, f64) = (8e4, 12_800.0);
    let inertial = 0.87 * reynolds.powf(0.2) - 0.4 * reynolds.powf(0.4) / weber.sqrt();
    let energetic = ((weber + 12.0) / (3.0 + 4.0 * weber / reynolds.sqrt())).sqrt();
    let expected = inertial.max(energetic);
    assert!(expected > 7.0 && off(found, expected) < 0.02, "{found} of {expected}");
}

/// A record that ends while the drop still comes down leaves out some of its momentum and heat, which is said.
#[test]
fn records_that_end_early_are_warned_of() {
    for method in ["record", "film"] {
        for (duration, says) in [("1e-6", true), ("2e-4", false)] {
            let keys = format!("record = {{ duration = {duration} }}");
            let text = drop(method, &keys) + &plate(300.0, "");
            let (_, found) = impinge::advice::parse_with_warnings(&text, "scene").unwrap();
            let cut = found.iter().any(|one| one.to_string().contains("the record ends"));
            assert_eq!(cut, says, "{method} {duration}: {found:?}");
        }
    }
}

/// Drops far apart give what each gives alone, wherever they are.
#[test]
fn drops_are_superposed() {
    let heat = |arrivals: &str| {
        let keys = format!("symmetry = \"none\"\narrivals = [{arrivals}]");
        let mut trial = Trial::new(&(drop("record", &keys) + &plate(300.0, "")));
        steps(&mut trial, 30);
        (trial.get("drop.heat"), trial.get("drop.overlapping"))
    };
    let one = heat("{ x = 2.6e-4 }").0;
    let (two, apart) = heat("{ x = -2.6e-4, y = 1e-5 }, { x = 2.6e-4 }");
    assert!(off(two, 2.0 * one) < 1e-9, "{two} {one}");
    assert_eq!(apart, 0.0);
    // Where the second meets the first's warm place it gives less.
    let (near, together) = heat("{ x = 2.6e-4 }, { time = 5e-6, x = 2.6e-4 }");
    assert_eq!(together, 1.0);
    assert!(near < 1.95 * one && near > one, "{near} {one}");
}

#[test]
fn drops_on_demand_are_those_of_arrivals() {
    let arrivals =
        "height = 3e-5\narrivals = [{ x = 2e-4 }, { time = 5e-6, x = -2e-4, y = 3e-5 }]\n";
    let asked = format!("height = 3e-5\n{ON_DEMAND}");
    for method in ["record", "film"] {
        let mut timed = Trial::new(&(drop(method, arrivals) + TILES));
        let mut asked = Trial::new(&(drop(method, &asked) + TILES));
        for (count, x, y) in [(1.0, 2e-4, 0.0), (2.0, -2e-4, 3e-5)] {
            asked.set("drop.release", count);
            asked.set("drop.x", x);
            asked.set("drop.y", y);
            (0..10).for_each(|_| {
                timed.step(STEP);
                asked.step(STEP);
            });
        }
        // The time of the release is a sum of steps. Films have records at more speeds where inputs set these, and then
        // on other rings.
        let bound = if method == "record" { 1e-9 } else { 1e-3 };
        for name in ["drop.heat", "drop.impulse_z", "drop.mass", "drop.active"] {
            let [one, other] = [&mut timed, &mut asked].map(|trial| trial.get(name));
            assert!(off(one, other) < bound, "{method} {name}: {one} {other}");
        }
        assert_eq!(asked.get("drop.released"), 2.0);
        assert_eq!(asked.get("drop.waiting"), 0.0);
    }
}

#[test]
fn a_saved_state_goes_on_to_the_bit_on_any_number_of_threads() {
    let text = drop("record", ON_DEMAND) + &plate(300.0, "");
    let mut trial = Trial::new(&text);
    let ask = |trial: &mut Trial, count: f64| {
        trial.set("drop.release", count);
        trial.set("drop.x", 1e-4 * count);
    };
    ask(&mut trial, 2.0);
    steps(&mut trial, 7);
    let saved = trial.state.clone();
    trial.model.check_state(&saved).unwrap();
    ask(&mut trial, 4.0);
    steps(&mut trial, 7);
    let end = trial.state.clone();
    let before = trial.get("drop.heat_flow");
    let mut other = Trial::on_threads(&text, 2);
    other.restart(&saved);
    ask(&mut other, 4.0);
    steps(&mut other, 7);
    assert_eq!(other.state, end);
    assert_eq!(other.get("drop.heat_flow").to_bits(), before.to_bits());
}

#[test]
fn a_drop_that_falls_from_above_comes_later_and_faster() {
    let from = |height: f64, gravity: f64| {
        let keys = format!("height = {height:?}\ngravity = {gravity:?}\n");
        let mut trial = Trial::new(&(drop("film", &keys) + TILES));
        let first = (1..400).find(|_| {
            trial.step(STEP);
            trial.get("drop.heat") > 0.0
        });
        let time = first.unwrap() as f64 * STEP;
        steps(&mut trial, 200);
        (time, trial.get("drop.impulse_z") / (mass() * SPEED))
    };
    let (time, momentum) = from(1e-3, 0.0);
    assert!((time - 1e-3 / SPEED).abs() < 2.0 * STEP, "{time}");
    // What is known of a film ends when 1.4e-6 of its momentum is left.
    assert!((momentum + 1.0).abs() < 1e-5, "{momentum}");
    // v² = U² + 2gh
    let fast = (SPEED * SPEED + 2.0 * 1e5 * 1e-3_f64).sqrt();
    let (time, momentum) = from(1e-3, 1e5);
    assert!((time - 2e-3 / (SPEED + fast)).abs() < 2.0 * STEP, "{time}");
    assert!((momentum + fast / SPEED).abs() < 1e-5, "{momentum}");
}

fn refusal(trial: &mut Trial) -> String {
    let before = trial.state.clone();
    let refused = trial.try_step(STEP).expect_err("no refusal");
    assert!(matches!(refused, ModelError::Body(_)), "{refused}");
    assert_eq!(trial.state.bodies, before.bodies);
    refused.to_string()
}

#[test]
fn what_is_not_known_is_refused() {
    let refused = |text: &str, all: &[((&str, f64), &str)]| {
        let mut trial = Trial::new(text);
        trial.set("drop.release", 1.0);
        trial.step(STEP);
        let falling = trial.state.clone();
        for &(input, words) in all {
            trial.restart(&falling);
            trial.set(input.0, input.1);
            let said = refusal(&mut trial);
            assert!(said.contains(words), "{input:?}: {said}");
        }
    };
    let one = [
        (("drop.speed", 20.1), "touches the wall at 20 to 20 m/s"),
        (("drop.angle", 0.1), "(allowed: 0)"),
        (("drop.release", 0.0), "does not fall"),
        (("drop.temperature", 0.0), "absolute zero"),
    ];
    refused(&(drop("record", ON_DEMAND) + TILES), &one);
    let film = (("drop.speed", 81.0), "touches the wall at 5 to 80 m/s");
    refused(&(drop("film", ON_DEMAND) + TILES), &[film]);
    let beside = (("drop.x", 4.6e-4), "that is beside `plate`");
    refused(&(drop("film", ON_DEMAND) + &plate(300.0, "")), &[beside]);
}

/// Between two speeds that are recorded a drop gives what its own particles give.
#[test]
fn speeds_between_those_recorded_are_interpolated() {
    let given = |keys: &str, speeds: &[f64]| -> Vec<[f64; 2]> {
        let mut trial = Trial::new(&(drop("record", &format!("{ON_DEMAND}{keys}")) + TILES));
        let start = trial.state.clone();
        let mut at = |&speed: &f64| {
            trial.restart(&start);
            trial.set("drop.release", 1.0);
            trial.set("drop.speed", speed);
            steps(&mut trial, 24);
            let [heat, impulse] = get(&mut trial, ["heat", "impulse_z"]);
            [heat / content(), impulse / (mass() * speed)]
        };
        speeds.iter().map(&mut at).collect()
    };
    let recorded = given("record = { speeds = [16.0, 20.0] }\n", &[18.0, 20.0]);
    let [between, end] = [recorded[0], recorded[1]];
    let own = drop("record", ON_DEMAND).replace("impact_velocity = 20.0", "impact_velocity = 18.0");
    let mut trial = Trial::new(&(own + TILES));
    trial.set("drop.release", 1.0);
    steps(&mut trial, 24);
    let exact = trial.get("drop.heat") / content();
    assert!(off(between[0], exact) < 0.05, "{between:?} {exact}");
    assert!((between[1] + 1.0).abs() < 0.05, "{between:?}");
    // At the ends it is what is recorded there.
    assert!(off(end[0], given("", &[20.0])[0][0]) < 0.02, "{end:?}");
}

/// The same for liquids from metal to wax: a film gives all its momentum, and of its heat a part that grows.
#[test]
fn films_of_all_liquids_keep_their_balances() {
    // ρ, µ, c, k, σ and U.
    let liquids = [
        [13534.0, 1.53e-3, 139.0, 8.5, 0.485, 4.0],
        [6970.0, 1.8e-3, 245.0, 31.0, 0.55, 5.0],
        [980.0, 4e-4, 4186.0, 0.66, 0.064, 10.0],
        [760.0, 6.5e-4, 2700.0, 0.16, 0.019, 10.0],
        [1240.0, 0.1, 2600.0, 0.29, 0.06, 20.0],
        [800.0, 1.2e-2, 2200.0, 0.15, 0.025, 10.0],
    ];
    for [density, viscosity, heat, conductivity, tension, speed] in liquids {
        let text = drop("film", "")
            .replace("1000.0", &format!("{density:?}"))
            .replace("4e-3", &format!("{viscosity:?}"))
            .replace("4180.0", &format!("{heat:?}"))
            .replace("0.6,", &format!("{conductivity:?},"))
            .replace("0.05 }", &format!("{tension:?} }}"))
            .replace("impact_velocity = 20.0", &format!("impact_velocity = {speed:?}"));
        let mut trial = Trial::new(&(text + &plate(300.0, "")));
        let (mass, mut last) = (PI / 6.0 * DIAMETER.powi(3) * density, 0.0);
        for _ in 0..40 {
            trial.step(0.1 * DIAMETER / speed);
            let [given, momentum] = get(&mut trial, ["heat", "impulse_z"]);
            assert!(given >= last && given < mass * heat * 50.0, "{density}: {given}");
            assert!(momentum.abs() < mass * speed * (1.0 + 1e-9));
            last = given;
        }
        let spread = trial.get("drop.spread_diameter") / DIAMETER;
        assert!((0.9..6.0).contains(&spread), "{density}: {spread}");
        assert!(off(trial.get("plate.heat_in"), last) < 1e-12);
        assert!(trial.heat_residual("plate") < 1e-9);
        // A plate of 300 K warms no further than the drop.
        assert!(trial.get("plate.max_temperature") < 350.0);
    }
}

/// States that no run leads to, by the place of a number.
#[test]
fn states_that_contradict_themselves_are_refused() {
    let mut trial = Trial::new(&(drop("film", ON_DEMAND) + &plate(300.0, "")));
    trial.set("drop.release", 2.0);
    steps(&mut trial, 3);
    let state = trial.state.clone();
    trial.model.check_state(&state).unwrap();
    let body = trial.model.scene().body.keys().position(|name| name == "drop").unwrap();
    // Time, last step, asked, released, overlapping, films, heat, impulse, the last drop that has ended, cells of
    // uneven heat; then contact, place, speed, temperature, rings.
    let first = 13;
    for (place, value, words) in [
        (0, -1.0, "a last step"),
        (1, 1.0, "a last step"),
        (2, 7.0, "of at most 5"),
        (2, 1.5, "asked for"),
        (3, 3.0, "released of 5"),
        (4, 3.0, "on others"),
        (6, f64::NAN, "not finite"),
        (10, 1.0, "a last drop"),
        (11, 1e3, "a last drop"),
        (12, 1.0, "of no number of drops"),
        (first, 1.0, "touches the wall"),
        (first, -1.0, "m/s and"),
        (first + 1, 1.0, "beyond what drops reach"),
        (first + 3, 1e3, "1000 m/s"),
        (first + 4, -3.0, "-3 K"),
        (first + 5, 0.0, "some of its rings"),
        (first + 6, -1.0, "some of its rings"),
    ] {
        let mut forged = state.clone();
        forged.bodies[body][place] = value;
        let refused = trial.model.check_state(&forged).unwrap_err().to_string();
        assert!(refused.contains(words), "{place} {value}: {refused}");
    }
    let mut cut = state.clone();
    cut.bodies[body].pop();
    assert!(trial.model.check_state(&cut).is_err());
}

#[test]
fn drops_on_others_are_noticed_and_told_at_the_end() {
    let mut trial = Trial::new(&(drop("film", ON_DEMAND) + TILES));
    for (count, x) in [(1.0, 0.0), (2.0, 1e-4), (3.0, 4.5e-4)] {
        trial.set("drop.release", count);
        trial.set("drop.x", x);
        steps(&mut trial, 4);
    }
    assert_eq!(trial.get("drop.overlapping"), 1.0);
    let said = trial.model.closing_warnings(&trial.state);
    assert!(said.iter().any(|words| words.to_string().contains("1 of 3 drops")), "{said:?}");
}

/// Thin and fast, its film breaks up within the record; a slow one stays whole.
#[test]
fn strays_of_a_record_are_told_as_particles_tell_theirs() {
    let said = |speed: &str| {
        let text = drop("record", "record = { duration = 5e-6 }")
            .replace("impact_velocity = 20.0", speed)
            .replace("viscosity = 4e-3", "viscosity = 5e-4")
            .replace(", surface_tension = 0.05", "")
            .replace("spacing = 1e-5", "spacing = 1.5e-5");
        let mut trial = Trial::new(&(text + TILES));
        assert_eq!(trial.model.closing_warnings(&trial.state), []);
        steps(&mut trial, 1);
        trial.model.closing_warnings(&trial.state)
    };
    let broken = said("impact_velocity = 80.0");
    assert!(
        broken.len() == 1 && broken[0].to_string().contains("by the end of the record"),
        "{broken:?}"
    );
    assert_eq!(said("impact_velocity = 2.0"), []);
}

/// What is scarce is told ahead.
#[test]
fn a_forecast_counts_what_is_recorded() {
    let told = |method: &str| {
        let text = drop(method, ON_DEMAND) + TILES;
        impinge::model::forecast(&scene::parse(&text, "scene").unwrap())
    };
    let [particles, record, film] = ["sph", "record", "film"].map(told);
    assert_eq!(film.droplets[0].particles, 0);
    let quarter = record.droplets[0].particles as f64;
    assert!(quarter > 0.0 && quarter < 0.06 * particles.droplets[0].particles as f64);
    assert!(record.droplets[0].run_time > film.droplets[0].run_time);
}

/// What is said ahead of drops on a plate of a conductivity, with more keys of drop and coupling.
fn warned(method: &str, conductivity: f64, drop_keys: &str, radius: &str) -> Vec<Warning> {
    let text = format!("{}{}", drop(method, drop_keys), plate(300.0, ""))
        .replace("conductivity = 10.0", &format!("conductivity = {conductivity:?}"))
        .replace("radius = 1.5e-4", radius);
    warnings(&scene::parse(&text, "scene").unwrap(), &[])
}

#[test]
fn drops_on_demand_are_warned_of_where_the_mesh_is_fine_around_the_middle_alone() {
    for method in ["sph", "record"] {
        let found = warned(method, 30.0, ON_DEMAND, "");
        assert!(found.len() == 1 && found[0].to_string().contains("`radius`"), "{found:?}");
        assert!(warned(method, 30.0, ON_DEMAND, "radius = 1.5e-4").is_empty());
        assert!(warned(method, 30.0, "", "").is_empty());
    }
}
