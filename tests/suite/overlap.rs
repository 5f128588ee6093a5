//! Drops that are repeated and come down on the films of others.

use std::f64::consts::PI;

use crate::common::{Trial, off, sweep};
use impinge::advice;
use impinge::model::tolerance::warnings;
use impinge::scene;

/// ρ, µ, c, k, σ and D, U.
const WAX: [f64; 7] = [800.0, 1.2e-2, 2200.0, 0.15, 0.025, 6e-5, 6.0];
const WATER: [f64; 7] = [980.0, 4e-4, 4186.0, 0.66, 0.064, 1e-4, 10.0];
const TIN: [f64; 7] = [6970.0, 1.8e-3, 245.0, 31.0, 0.55, 1e-4, 5.0];
const GLYCEROL: [f64; 7] = [1240.0, 0.1, 2600.0, 0.29, 0.06, 1e-4, 20.0];
const ALUMINIUM: [f64; 7] = [2380.0, 1.2e-3, 1080.0, 90.0, 0.87, 1e-4, 5.0];

const GLASS: &str = "density = 2500.0, specific_heat = 800.0, conductivity = 1.0";
const STEEL: &str = "density = 7900.0, specific_heat = 500.0, conductivity = 16.0";
const PTFE: &str = "density = 2200.0, specific_heat = 1000.0, conductivity = 0.25";
const AEROGEL: &str = "density = 100.0, specific_heat = 1000.0, conductivity = 0.02";
const COPPER: &str = "density = 8960.0, specific_heat = 385.0, conductivity = 400.0";

/// Drops by a method, with further keys.
fn drops(liquid: [f64; 7], method: &str, temperature: f64, keys: &str) -> String {
    let [density, viscosity, heat, conductivity, tension, diameter, speed] = liquid;
    let spacing = if method == "film" { 0.0 } else { diameter / 8.0 };
    let spacing = if spacing > 0.0 { format!("spacing = {spacing:?}\n") } else { String::new() };
    format!(
        "name = \"Drops\"\nstop_time = 1e-2\nstep = 1e-4\n[body.drop]\nkind = \"droplet\"\nmethod = \
         \"{method}\"\ndiameter = {diameter:?}\nimpact_velocity = {speed:?}\ninitial_temperature = \
         {temperature:?}\n{spacing}fluid = {{ density = {density:?}, viscosity = {viscosity:?}, specific_heat = \
         {heat:?}, conductivity = {conductivity:?}, surface_tension = {tension:?} }}\n{keys}\n"
    )
}

const ON_DEMAND: &str = "release = \"input\"\nmost = 3000\n";
const BOX: &str = "shape = { box = [6e-4, 6e-4, 2e-4] }\nmesh = { spacing = 3e-5, depth_spacing = 2e-6, growth \
                   = 1.5, order = 1 }";
const DISC: &str = "shape = { disc = { radius = 4e-4, thickness = 2e-4 } }\nmesh = { spacing = 2e-5, depth_spacing \
                    = 2e-6, growth = 1.5, order = 1 }";

/// A plate below them.
fn plate(shape: &str, material: &str, temperature: f64) -> String {
    format!(
        "[body.plate]\nkind = \"solid\"\n{shape}\nmaterial = {{ model = \"thermoelastic\", {material} \
         }}\ninitial_temperature = {temperature:?}\n[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\ntraction = \
         false\nradius = 2e-4\n"
    )
}

/// Tiles below them, which are held at a temperature.
fn tiles(temperature: f64) -> String {
    format!(
        "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ tiles = {{ count = [8, 8], size = [1e-3, 1e-3] }} \
         }}\nstart = {{ temperature = {temperature:?} }}\n"
    )
}

fn heat_of(liquid: [f64; 7], difference: f64) -> f64 {
    let [density, _, heat, _, _, diameter, _] = liquid;
    PI / 6.0 * diameter.powi(3) * density * heat * difference
}

/// Releases `count` drops, if any, and makes steps; fails where the top of a plate goes beyond its own and the drops'
/// temperature by more than a thirtieth of their difference, which piles on coarse cells overshoot, or where heat is
/// lost.
fn bounded(text: &str, count: f64, (drop, wall): (f64, f64), steps: &[f64]) -> Trial {
    let mut trial = Trial::new(text);
    if count > 0.0 {
        trial.set("drop.release", count);
    }
    let allowed = (drop - wall).abs() / 30.0;
    for &step in steps {
        trial.step(step);
        let fields = trial.fields("plate");
        let [nx, ny, _] = fields.axes.each_ref().map(Vec::len);
        let top = &fields.temperature[fields.temperature.len() - nx * ny..];
        let lowest = top.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = top.iter().copied().fold(0.0, f64::max);
        let (low, high) = (drop.min(wall) - allowed, drop.max(wall) + allowed);
        assert!(lowest > low && highest < high, "{count} drops: {lowest} to {highest} K");
        let [given, taken] = ["drop.heat", "plate.heat_in"].map(|name| trial.get(name));
        assert!((given - taken).abs() <= 1e-12 * given.abs(), "{given} J become {taken} J");
    }
    assert!(trial.heat_residual("plate") < 1e-9);
    trial
}

/// 60 drops of 400 K at once would bring glass to 1600 K if each gave what it gives alone, 2000 to 44 000 K.
#[test]
fn any_number_of_drops_at_once_leaves_a_plate_between_its_own_and_their_temperature() {
    let steps = [2e-5, 1e-4, 1e-4, 1e-3];
    let all = [
        (WAX, GLASS, BOX, [400.0, 320.0], "record"),
        (WAX, PTFE, DISC, [320.0, 400.0], "film"),
        (TIN, GLASS, DISC, [600.0, 300.0], "film"),
        (ALUMINIUM, AEROGEL, DISC, [950.0, 300.0], "film"),
        (WATER, COPPER, BOX, [290.0, 500.0], "film"),
        (GLYCEROL, STEEL, DISC, [450.0, 300.0], "film"),
    ];
    for (liquid, material, shape, [drop, wall], method) in sweep(&all, &[0, 3, 4]) {
        let text = drops(liquid, method, drop, ON_DEMAND) + &plate(shape, material, wall);
        for count in sweep(&[1.0, 3.0, 60.0], &[2]) {
            let mut trial = bounded(&text, count, (drop, wall), &steps);
            let part = trial.get("drop.heat") / (count * heat_of(liquid, drop - wall));
            assert!(part > 0.0 && part < 1.0 + 1e-9, "{count} drops give {part} of their heat");
        }
    }
    let text = drops(WAX, "film", 400.0, ON_DEMAND) + &plate(DISC, GLASS, 320.0);
    bounded(&text, 2000.0, (400.0, 320.0), &[1e-4, 1e-4]);
}

/// One drop of 650 K every 25 µs.
#[test]
fn drops_one_after_another_leave_a_plate_below_their_temperature() {
    let arrivals = (0..40).map(|n| format!("{{ time = {:?} }}", 2.5e-5 * f64::from(n)));
    let keys = format!("arrivals = [{}]", arrivals.collect::<Vec<_>>().join(", "));
    for (liquid, material) in [(TIN, GLASS), (WAX, PTFE), (WATER, GLASS)] {
        let text = drops(liquid, "film", 650.0, &keys) + &plate(DISC, material, 320.0);
        bounded(&text, 0.0, (650.0, 320.0), &[1e-4; 12]);
    }
}

/// Of drops of several temperatures the hottest bounds.
#[test]
fn the_hottest_drop_on_a_place_bounds_its_temperature() {
    let text = drops(TIN, "film", 400.0, ON_DEMAND) + &plate(DISC, GLASS, 320.0);
    let mut trial = Trial::new(&text);
    for (count, temperature) in [(20.0, 400.0), (22.0, 650.0), (60.0, 400.0)] {
        trial.set("drop.release", count);
        trial.set("drop.temperature", temperature);
        (0..4).for_each(|_| trial.step(2e-5));
        let bound = if count > 20.0 { 650.0 } else { 400.0 };
        let highest = trial.get("plate.max_temperature");
        assert!(highest < bound + 1.0, "{count}: {highest}");
    }
}

/// Eight like drops are one of twice the diameter: a film twice as thick on four times the area, which gives its heat
/// four times as late.
#[test]
fn like_drops_on_one_place_are_one_of_all_volumes() {
    let heat = |count: f64, time: f64| {
        let mut trial = Trial::new(&(drops(WAX, "film", 400.0, ON_DEMAND) + &tiles(320.0)));
        trial.set("drop.release", count);
        (0..100).for_each(|_| trial.step(0.01 * time));
        trial.get("drop.heat") / (count * heat_of(WAX, 80.0))
    };
    for time in sweep(&[2e-4, 1e-3, 4e-3], &[0, 2]) {
        let [one, eight] = [heat(1.0, time), heat(8.0, 4.0 * time)];
        assert!(one > 0.1 && off(eight, one) < 0.03, "{time}: {eight} {one}");
    }
}

/// What cannot be given at once is given later, and momentum at once.
#[test]
fn drops_on_one_place_give_all_heat_and_momentum() {
    for method in ["film", "record"] {
        let mut trial = Trial::new(&(drops(WAX, method, 400.0, ON_DEMAND) + &tiles(320.0)));
        trial.set("drop.release", 27.0);
        (0..10).for_each(|_| trial.step(1e-4));
        let momentum = 27.0 * heat_of(WAX, 1.0) / WAX[2] * WAX[6];
        let part = -trial.get("drop.impulse_z") / momentum;
        assert!((part - 1.0).abs() < if method == "film" { 1e-4 } else { 0.06 }, "{part}");
        let mut steps = 0;
        while trial.get("drop.active") > 0.0 {
            trial.step(1e-2);
            steps += 1;
            assert!(steps < 10_000);
        }
        let all = 27.0 * heat_of(WAX, 80.0);
        assert!(
            off(trial.get("drop.heat"), all) < 1e-9,
            "{method}: {}",
            trial.get("drop.heat") / all
        );
    }
}

/// A pile elsewhere changes nothing, to the last bit of what a drop alone gives.
#[test]
fn drops_that_do_not_meet_others_give_what_they_give_alone() {
    let heat = |pile: bool| {
        let mut arrivals = vec!["{ x = 2.2e-4 }"];
        if pile {
            arrivals.extend(["{ time = 1e-5, x = -2.2e-4 }", "{ time = 3e-5, x = -2.2e-4 }"]);
        }
        let keys = format!("arrivals = [{}]", arrivals.join(", "));
        let mut trial = Trial::new(&(drops(WAX, "film", 400.0, &keys) + &tiles(320.0)));
        (0..5).for_each(|_| trial.step(2e-5));
        let cells = (5..=8).flat_map(|i| (1..=8).map(move |j| [i, j]));
        let names = cells.map(|[i, j]| format!("wall.heat_flux[{i},{j}]"));
        names.map(|name| trial.get(&name).to_bits()).collect::<Vec<u64>>()
    };
    assert_eq!(heat(true), heat(false));
}

#[test]
fn a_saved_pile_goes_on_to_the_bit_and_lags_that_no_run_leads_to_are_refused() {
    let text = drops(TIN, "film", 600.0, ON_DEMAND) + &plate(DISC, GLASS, 300.0);
    let mut trial = Trial::new(&text);
    trial.set("drop.release", 12.0);
    (0..3).for_each(|_| trial.step(1e-5));
    let saved = trial.state.clone();
    trial.model.check_state(&saved).unwrap();
    (0..3).for_each(|_| trial.step(1e-5));
    let mut other = Trial::on_threads(&text, 2);
    other.restart(&saved);
    (0..3).for_each(|_| other.step(1e-5));
    assert_eq!(other.state, trial.state);
    let body = trial.model.scene().body.keys().position(|name| name == "drop").unwrap();
    // Behind thirteen sums and the heat of cells, and of each drop five numbers and 32 rings.
    let cells = saved.bodies[body][12];
    let lag = 13 + cells as usize + 5 + 32;
    for (place, value) in [(lag, 1.0), (lag, -1e-9), (lag + 32, 1.0), (lag + 32, -1e-9)] {
        let mut forged = saved.clone();
        forged.bodies[body][place] = value;
        let refused = trial.model.check_state(&forged).unwrap_err().to_string();
        assert!(refused.contains("lags behind"), "{place} {value}: {refused}");
    }
    assert!(cells > 1.0);
    for (place, value, words) in [(12, cells - 1.0, "no number"), (13, 1.0, "more than drops gave")]
    {
        let mut forged = saved.clone();
        forged.bodies[body][place] = value;
        let refused = trial.model.check_state(&forged).unwrap_err().to_string();
        assert!(refused.contains(words), "{place} {value}: {refused}");
    }
    let mut forged = saved.clone();
    forged.bodies[body][5] = 13.0;
    assert!(trial.model.check_state(&forged).unwrap_err().to_string().contains("on one place"));
}

/// One tile of 64 that is hotter than the drop gets nothing; its neighbours get what they do without it, but for the
/// wall's mean that rings meet.
#[test]
fn hot_tiles_leave_the_heat_of_others_as_it_is() {
    let given = |hot: f64| {
        let text = drops(WATER, "film", 370.0, "") + &tiles(300.0);
        let mut trial = Trial::new(&text);
        trial.set("wall.temperature[5,5]", hot);
        let area = (1e-3 / 8.0_f64).powi(2);
        let cells =
            || (1..=8).flat_map(|i| (1..=8).map(move |j| format!("wall.heat_flux[{i},{j}]")));
        let mut sum = 0.0;
        for _ in 0..40 {
            trial.step(2.5e-5);
            let before = trial.state.clone();
            assert!(hot < 370.0 || trial.get("wall.heat_flux[5,5]") == 0.0);
            let fluxes: f64 = cells().map(|name| trial.get(&name)).sum();
            sum += 2.5e-5 * (area * fluxes + trial.get("wall.heat_flow_outside"));
            trial.model.check_state(&before).unwrap();
            trial.restart(&before);
        }
        let heat = trial.get("drop.heat");
        assert!(off(sum, heat) < 1e-12, "{sum} {heat}");
        heat
    };
    let [even, uneven] = [300.0, 380.0].map(given);
    assert!(
        uneven < even && uneven > 0.7 * even,
        "{even} J without the hot tile, {uneven} J with it"
    );
}

/// A spot hotter than the drop gets nothing, and what lies around it is warmed to no more than the drop.
#[test]
fn hot_spots_are_not_heated() {
    for method in ["film", "record"] {
        let top = |flux: f64, count: f64| {
            let load = format!(
                "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ disc = {{ radius = 3e-5 }} }}\ncarries = \
                 [\"heat_flux\"]\nstart = {{ heat_flux = {flux:?}, x = 9e-5 }}\n"
            );
            let fine = BOX.replace("spacing = 3e-5", "spacing = 1.5e-5");
            let text = drops(WATER, method, 370.0, ON_DEMAND) + &plate(&fine, GLASS, 300.0) + &load;
            let mut trial = Trial::new(&text);
            (0..4).for_each(|_| trial.step(2.5e-4));
            trial.set("drop.release", count);
            (0..8).for_each(|_| trial.step(1e-4));
            assert!(trial.heat_residual("plate") < 1e-9);
            let fields = trial.fields("plate");
            let [nx, ny, _] = fields.axes.each_ref().map(Vec::len);
            let top = fields.temperature[fields.temperature.len() - nx * ny..].to_vec();
            (trial.get("drop.heat"), top)
        };
        let (even, _) = top(0.0, 1.0);
        let (uneven, warmed) = top(5e6, 1.0);
        let (_, free) = top(5e6, 0.0);
        let hottest = free.iter().copied().fold(0.0, f64::max);
        assert!(hottest > 390.0, "{hottest} K");
        let beside = warmed.iter().zip(&free).filter(|(_, free)| **free < 355.0);
        let most = beside.map(|(warmed, _)| *warmed).fold(0.0, f64::max);
        assert!(most < 371.0, "{method}: {most} K beside the spot");
        assert!(uneven > 0.7 * even && uneven < even, "{method}: {uneven} J beside {even} J");
    }
}

/// Three films on one place were compared with particles.
#[test]
fn more_films_on_one_place_than_were_measured_are_warned_of_in_that_step() {
    let mut trial = Trial::new(&(drops(WAX, "film", 400.0, ON_DEMAND) + &tiles(320.0)));
    for (count, warns) in [(3.0, false), (4.0, true)] {
        trial.set("drop.release", count);
        trial.step(1e-5);
        let said = trial.model.warnings(&trial.state);
        assert_eq!(
            said.iter().any(|words| words.to_string().contains("more than 3 films")),
            warns,
            "{said:?}"
        );
    }
}

#[test]
fn arrivals_on_more_films_than_were_measured_are_foretold() {
    let said = |count: usize, apart: f64, delay: f64| {
        let arrival =
            |n: usize| format!("{{ time = {:?}, x = {:?} }}", delay * n as f64, apart * n as f64);
        let arrivals: Vec<String> = (0..count).map(arrival).collect();
        let keys = format!("height = 1e-4\narrivals = [{}]", arrivals.join(", "));
        let text = drops(WAX, "film", 400.0, &keys) + &tiles(320.0);
        let found = warnings(&scene::parse(&text, "scene").unwrap(), &[]);
        let own = advice::parse_with_warnings(&text, "scene").unwrap().1;
        let all = found.iter().chain(&own).map(ToString::to_string);
        all.filter(|one| one.contains("films that still transfer heat")).count()
    };
    assert_eq!(said(3, 0.0, 1e-4), 0);
    assert_eq!(said(4, 0.0, 1e-4), 1);
    assert_eq!(said(9, 1e-4, 1e-4), 0);
    assert_eq!(said(9, 0.0, 1.0), 0);
}

/// Drops of two bodies know nothing of each other, and inputs may bring them anywhere.
#[test]
fn two_bodies_whose_drops_inputs_may_let_meet_are_warned_of() {
    let said = |keys: &str, others: &str| {
        let first = drops(WATER, "film", 370.0, keys);
        let body = first.find("[body.drop]").unwrap();
        let second = drops(WATER, "film", 370.0, others)[body..].replace("body.drop", "body.other");
        let wide = BOX.replace("6e-4, 6e-4", "1.2e-3, 1.2e-3");
        let below = plate(&wide, GLASS, 300.0);
        let coupling = below.find("[[coupling]]").unwrap();
        let further = below[coupling..].replace("\"drop\"", "\"other\"");
        let text = format!("{first}{second}{below}{further}");
        let found = advice::parse_with_warnings(&text, "scene").unwrap().1;
        let ids = found.iter().map(ToString::to_string);
        let of_two = |words: &String| words.contains("spread over each other");
        ids.filter(of_two).map(|words| words.contains("may let")).collect::<Vec<_>>()
    };
    let [near, far] = ["arrivals = [{ x = 1e-4 }]", "arrivals = [{ x = -4.5e-4 }]"];
    assert_eq!(said(ON_DEMAND, ON_DEMAND), [true]);
    assert_eq!(said(near, ON_DEMAND), [true]);
    assert_eq!(said(near, ""), [false]);
    assert!(said("arrivals = [{ x = 4.5e-4 }]", far).is_empty());
}
