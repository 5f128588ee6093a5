//! Drops of many fluids on plates of many materials: temperatures of contact, and none beyond those at first.

use std::f64::consts::PI;

use crate::common::{Trial, off, sweep};
use crate::resting_layer::{Below, RestingLayer};
use impinge::closed_form::{Conductor, Contact, ResistiveContact};
use impinge::laws::{Freezing, Melting, Viscosity};
use impinge::method::sph::Fluid;

/// Density, specific heat, conductivity, surface tension, viscosity in SI units.
const FLUIDS: [(&str, [f64; 5]); 8] = [
    ("sodium", [930.0, 1300.0, 70.0, 0.19, 5e-4]),
    ("tin", [6980.0, 250.0, 30.0, 0.54, 2e-3]),
    ("mercury", [13534.0, 139.0, 8.5, 0.485, 1.5e-3]),
    ("water", [1000.0, 4180.0, 0.6, 0.072, 1e-3]),
    ("wax", [780.0, 2400.0, 0.2, 0.025, 5e-3]),
    ("glycerol", [1260.0, 2400.0, 0.28, 0.063, 0.3]),
    // Nothing that exists, for the ends of the range of effusivities.
    ("insulator", [1000.0, 1000.0, 1e-3, 0.05, 1e-3]),
    ("conductor", [9000.0, 400.0, 400.0, 1.0, 4e-3]),
];

/// Density, specific heat, conductivity.
const SOLIDS: [(&str, [f64; 3]); 7] = [
    ("copper", [8960.0, 385.0, 390.0]),
    ("alumina", [3950.0, 900.0, 10.0]),
    ("stainless steel", [8000.0, 500.0, 15.0]),
    ("glass", [2500.0, 840.0, 1.1]),
    ("polymer", [1200.0, 1500.0, 0.2]),
    ("aerogel", [100.0, 1000.0, 0.02]),
    ("lightest aerogel", [2.0, 1000.0, 0.02]),
];

const HOT: f64 = 600.0;
const COLD: f64 = 300.0;
const STOP: f64 = 5e-6;
const STEPS: usize = 10;
/// How far a plate may go beyond the range, over its width, with linear elements, with quadratic ones, which
/// overshoot beside a sharp edge of heat, and with particles, for which the modes of elements stand in.
const BEYOND: [f64; 3] = [5e-3, 0.08, 0.025];
/// Ways of heat [m] short beside the width of the contact, so that it goes straight down.
const NARROW: f64 = 5e-6;

fn scene(fluid: [f64; 5], solid: [f64; 3], shape: &str, heat: &str, order: usize) -> String {
    let [density, specific_heat, conductivity, tension, viscosity] = fluid;
    let [solid_density, capacity, k] = solid;
    // A sixth of how far heat comes.
    let depth = ((k / (solid_density * capacity) * STOP).sqrt() / 6.0).min(2e-5);
    format!(
        r#"
name = "Contact"
stop_time = {STOP:?}
step = {:?}
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 2.0
initial_temperature = {HOT:?}
spacing = 8e-6
fluid = {{ density = {density:?}, viscosity = {viscosity:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?}, surface_tension = {tension:?} }}
[body.plate]
kind = "solid"
shape = {{ {shape} }}
heat = "{heat}"
material = {{ model = "thermoelastic", density = {solid_density:?}, specific_heat = {capacity:?}, conductivity = {k:?}, young = 70e9, poisson = 0.25, expansion = 8e-6 }}
initial_temperature = {COLD:?}
mesh = {{ spacing = 8e-6, depth_spacing = {depth:?}, growth = 1.5, order = {order} }}
[[coupling]]
from = "drop"
to = "plate.top"
radius = 7.5e-5
traction = false
[[probe]]
name = "centre"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#,
        STOP / STEPS as f64,
    )
}

/// Rings of a wall that are as wide as two particles [m].
const RINGS: usize = 6;
const WIDTH: f64 = 1.6e-5;

/// The scene cut in two: the drop above rings of a wall, and the plate below rings of a load with a probe each.
fn halves(text: &str, effusivity: f64) -> [String; 2] {
    let (head, bodies) = text.split_once("[body.drop]").unwrap();
    let (drop, rest) = bodies.split_once("[body.plate]").unwrap();
    let (plate, _) = rest.split_once("[[coupling]]").unwrap();
    let rings = format!("rings = {{ count = {RINGS}, radius = {:?} }}", RINGS as f64 * WIDTH);
    let wall = format!(
        "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ {rings} }}\neffusivity = {effusivity:?}\nstart = \
         {{ temperature = {COLD:?} }}\n"
    );
    let load = format!(
        "[[load]]\nname = \"rings\"\non = \"plate.top\"\nfootprint = {{ {rings} }}\ncarries = [\"heat_flux\"]\n"
    );
    let probe = |ring: usize| {
        let radius = (ring as f64 - 0.5) * WIDTH;
        format!(
            "[[probe]]\nname = \"ring{ring}\"\nin = \"plate\"\nat = [{radius:?}, 0.0, 0.0]\ngives = [\"temperature\"]\n"
        )
    };
    let probes: String = (1..=RINGS).map(probe).collect();
    [format!("{head}[body.drop]{drop}{wall}"), format!("{head}[body.plate]{plate}{load}{probes}")]
}

const BOX: &str = "box = [4e-4, 4e-4, 2e-4]";
const DISC: &str = "disc = { radius = 2e-4, thickness = 2e-4 }";

/// Runs a pair and holds its temperatures and its heat; that of the centre at the end.
fn run(name: &str, text: &str, beyond: f64) -> f64 {
    run_of(name, text, beyond).get("centre.temperature")
}

/// The heat of a pair that is run as above [J].
fn heat_of_run(name: &str, text: &str, beyond: f64) -> f64 {
    run_of(name, text, beyond).get("drop.heat")
}

fn run_of(name: &str, text: &str, beyond: f64) -> Trial {
    let mut trial = Trial::new(text);
    let room = beyond * (HOT - COLD);
    for _ in 0..STEPS {
        trial.step(STOP / STEPS as f64);
        let highest = trial.get("plate.max_temperature");
        assert!(highest <= HOT + room, "{name}: the plate is at {highest} K");
        let centre = trial.get("centre.temperature");
        assert!(centre >= COLD - room, "{name}: the centre is at {centre} K");
        let [low, high] = ["min", "max"].map(|end| trial.get(&format!("drop.{end}_temperature")));
        assert!(low >= COLD && high <= HOT + 1e-9, "{name}: the drop is at {low} to {high} K");
    }
    let [given, taken] = ["drop.heat", "plate.heat_in"].map(|total| trial.get(total));
    assert!(given > 0.0 && off(taken, given) < 1e-12, "{name}: {given} J, {taken} J");
    assert!(off(-trial.get("drop.heat_stored"), given) < 1e-6, "{name}");
    trial
}

/// Linear and quadratic elements take turns, so that every fluid and every solid meets both.
#[test]
fn every_pair_takes_its_temperature_of_contact() {
    let effusivity = |[density, capacity, k]: [f64; 3]| (density * capacity * k).sqrt();
    let reach = |[density, capacity, k]: [f64; 3]| (k / (density * capacity) * STOP).sqrt();
    let pairs: Vec<(usize, usize)> = (0..FLUIDS.len())
        .flat_map(|row| (0..SOLIDS.len()).map(move |column| (row, column)))
        .collect();
    let third: Vec<usize> = (0..pairs.len()).step_by(3).collect();
    for (row, column) in sweep(&pairs, &third) {
        let ((fluid_name, fluid), (solid_name, solid)) = (FLUIDS[row], SOLIDS[column]);
        let order = 1 + (row + column) % 2;
        let name = format!("{fluid_name} on {solid_name}, elements of order {order}");
        let centre = run(&name, &scene(fluid, solid, BOX, "fem", order), BEYOND[order - 1]);
        let warm = [fluid[0], fluid[1], fluid[2]];
        let [hot, cold] = [warm, solid].map(effusivity);
        let contact = (hot * HOT + cold * COLD) / (hot + cold);
        let error = (centre - contact) / (HOT - COLD);
        if reach(warm).max(reach(solid)) < NARROW {
            // Twelve particles over the diameter have hardly come to rest on the wall by now.
            assert!(error.abs() < 0.12, "{name}: {centre} K, not {contact} K");
        } else {
            // Heat that goes to all sides takes the centre with it.
            assert!((-0.3..0.12).contains(&error), "{name}: {centre} K, not {contact} K");
        }
    }
}

#[test]
fn discs_and_particles_take_the_heat_too() {
    for (fluid_name, fluid) in [FLUIDS[0], FLUIDS[3]] {
        for (solid_name, solid) in [SOLIDS[1], SOLIDS[4], SOLIDS[5]] {
            let of = |shape, heat| {
                let name = format!("{fluid_name} on {solid_name}, {heat}");
                let beyond = BEYOND[if heat == "sph" { 2 } else { 0 }];
                run(&name, &scene(fluid, solid, shape, heat, 1), beyond)
            };
            let reference = of(BOX, "fem");
            for (shape, heat) in [(DISC, "fem"), (DISC, "sph")] {
                let found = of(shape, heat);
                let name = format!("{fluid_name} on {solid_name}, {heat}");
                assert!(
                    (found - reference).abs() < 0.06 * (HOT - COLD),
                    "{name}: {found} {reference}"
                );
            }
        }
    }
}

/// Steps of a master that joins the units of a drop and of a plate, in turn and without iterating: the mean flux of
/// a step would take the plate 27 % beyond its temperature of contact, if the drop did not remember what it gave.
#[test]
fn two_units_that_take_turns_make_nothing_hotter_than_the_drop() {
    take_turns("quarter", true);
}

/// Rings as wide as two particles tell less of one scene where particles are rings, too.
#[test]
fn drops_of_rings_that_take_turns_make_nothing_hotter_than_they_are() {
    take_turns("auto", false);
}

/// Pairs of units beside one scene, whose heat is compared or not.
fn take_turns(symmetry: &str, is_compared: bool) {
    const TURNS: usize = 50;
    for ((fluid_name, fluid), (solid_name, solid), apart) in [
        (FLUIDS[0], SOLIDS[2], 0.1),
        (FLUIDS[1], SOLIDS[3], 0.2),
        (FLUIDS[3], SOLIDS[1], 0.03),
        (FLUIDS[3], SOLIDS[5], 0.35),
        (FLUIDS[4], SOLIDS[0], 0.002),
        (FLUIDS[5], SOLIDS[4], 0.08),
    ] {
        let text = scene(fluid, solid, DISC, "fem", 1);
        let keys = format!("spacing = 8e-6\nsymmetry = \"{symmetry}\"\nfluid");
        let text = text.replace("spacing = 8e-6\nfluid", &keys);
        let mut whole = Trial::new(&text);
        let effusivity = solid.iter().product::<f64>().sqrt();
        let [mut drop, mut plate] = halves(&text, effusivity).map(|text| Trial::new(&text));
        for turn in 0..TURNS {
            let name = format!("{fluid_name} on {solid_name}, turn {turn}");
            whole.step(STOP / TURNS as f64);
            drop.step(STOP / TURNS as f64);
            for ring in 1..=RINGS {
                let flux = drop.get(&format!("wall.heat_flux[{ring}]"));
                plate.set(&format!("rings.heat_flux[{ring}]"), flux);
            }
            plate.step(STOP / TURNS as f64);
            for ring in 1..=RINGS {
                let temperature = plate.get(&format!("ring{ring}.temperature"));
                assert!(temperature < HOT + BEYOND[0] * (HOT - COLD), "{name}: {temperature} K");
                drop.set(&format!("wall.temperature[{ring}]"), temperature);
            }
            // Rings are as wide as two particles, and a probe is in the middle of each.
            let [one, two] = [&mut whole, &mut plate].map(|trial| trial.get("plate.heat_in"));
            let is_early = turn < TURNS / 4;
            assert!(!is_compared || is_early || off(two, one) < apart, "{name}: {one} J, {two} J");
        }
        let [given, taken] = [drop.get("drop.heat"), plate.get("plate.heat_in")];
        assert!(off(taken, given) < 1e-3, "{fluid_name} on {solid_name}: {given} J, {taken} J");
    }
}

const WATER: Conductor = Conductor { conductivity: 0.6, heat_capacity: 4e6 };

/// Water of [`WATER`]'s constants.
const FLUID: Fluid = Fluid {
    density: 1000.0,
    viscosity: Viscosity::Constant(3e-4),
    specific_heat: 4000.0,
    conductivity: 0.6,
    surface_tension: 0.0,
    sound_speed: 50.0,
    freezing: None,
};

/// Largest error of the heat, at any of the times and spacings.
const RESISTED: f64 = 0.01;

/// Two half spaces, over three decades of time and of Biot numbers hΔx/k and more, on particles from ten times as wide
/// as the thermal layer to an eighth of it. The first times are shorter than a step of the coarser ones.
#[test]
fn layers_cool_through_a_resistance() {
    let time: f64 = 3.5e-6;
    let deep = (PI * WATER.diffusivity() * time).sqrt();
    for wall in sweep(&[None, Some(6000.0), Some(500.0), Some(100.0)], &[0, 2]) {
        let second = Conductor { conductivity: 1.0, heat_capacity: wall.map_or(1e30, |e| e * e) };
        let bodies =
            Contact { first: WATER, first_temperature: HOT, second, second_temperature: COLD };
        for fineness in sweep(&[0.1, 0.5, 2.0, 8.0], &[0, 2]) {
            let spacing = deep / fineness;
            for resisting in sweep(&[0.03, 0.3, 1.0, 3.0, 30.0, 1e3], &[0, 2, 4]) {
                let conductance = resisting * WATER.effusivity() / time.sqrt();
                let rows = (6.0 * fineness).ceil().max(6.0) as usize;
                let below = Below { effusivity: wall, conductance: Some(conductance) };
                let mut layer = RestingLayer::of(FLUID, (spacing, rows), HOT, below);
                let exact = ResistiveContact { bodies, conductance };
                let (mut heat, mut now) = (0.0, 0.0);
                let mut error = |next: f64| {
                    heat += layer.advance(COLD, next - now);
                    now = next;
                    heat / exact.heat(now) - 1.0
                };
                let errors = [1e-3, 1e-2, 0.1, 1.0].map(|part| error(part * time));
                let biot = conductance * spacing / WATER.conductivity;
                println!(
                    "Bi {biot:.2e}, {fineness} particles, e {wall:?}, {resisting}: {errors:.4?}"
                );
                let largest = errors.iter().fold(0.0, |most: f64, error| most.max(error.abs()));
                assert!(largest < RESISTED, "Bi {biot}, {fineness}, {wall:?}: {errors:?}");
            }
        }
    }
}

/// Largest errors of the heat after a wall has crossed the temperature of release, and after it has come nearer to it.
/// The jump counts from the temperature of the layer, not from that of the wall before.
const CROSSED: f64 = 0.25;
const NEARER: f64 = 0.87;

/// A wall that is hotter than the fluid, then colder than at the release or less hot. The exact heat is the sum of that
/// of a hot contact and that of a later one of the change, as all constants are.
#[test]
fn walls_change_their_temperature() {
    let (hot, time) = (340.0, 0.02);
    let melting = Melting { solidus: 200.0, liquidus: 200.0, latent_heat: 3e5 };
    let freezing = Freezing { melting, specific_heat: 2000.0, conductivity: 2.0 };
    let second = Conductor { conductivity: 1.0, heat_capacity: 1e30 };
    let bodies = Contact { first: WATER, first_temperature: 1.0, second, second_temperature: 0.0 };
    for (next, bound) in [(280.0, CROSSED), (310.0, NEARER)] {
        let mut largest = 0.0_f64;
        for (conductance, freezing) in [(None, None), (None, Some(freezing)), (Some(1e4), None)] {
            let exact = ResistiveContact { bodies, conductance: conductance.unwrap_or(1e12) };
            for spacing in [80e-6, 40e-6] {
                let rows = (8e-4 / spacing) as usize;
                let below = Below { effusivity: None, conductance };
                let fluid = Fluid { sound_speed: 1.0, freezing, ..FLUID };
                let mut layer = RestingLayer::of(fluid, (spacing, rows), COLD, below);
                layer.advance(hot, time);
                let (mut heat, mut now) = (0.0, 0.0);
                let mut error = |end: f64| {
                    heat += layer.advance(next, end - now);
                    now = end;
                    let past = (COLD - hot) * (exact.heat(time + now) - exact.heat(time));
                    heat / (past + (hot - next) * exact.heat(now)) - 1.0
                };
                let errors = [0.05, 0.5].map(|part| error(part * time));
                let freezes = freezing.is_some();
                println!("{next} K, {conductance:?}, freezes {freezes}, {spacing}: {errors:.3?}");
                largest = errors.iter().fold(largest, |most, error| most.max(error.abs()));
            }
        }
        assert!(largest < bound, "to {next} K: {largest}");
    }
}

/// Heat of drops on plates: balanced, between the initial temperatures, in proportion to a small conductance, and that
/// of perfect contact through a large one.
#[test]
fn drops_transfer_heat_through_a_resistance() {
    for ((fluid_name, fluid), (solid_name, solid)) in [
        (FLUIDS[3], SOLIDS[1]),
        (FLUIDS[1], SOLIDS[3]),
        (FLUIDS[0], SOLIDS[5]),
        (FLUIDS[4], SOLIDS[0]),
    ] {
        let perfect = scene(fluid, solid, DISC, "fem", 1);
        let heat = |conductance: Option<f64>| {
            let key = conductance.map_or(String::new(), |h| format!("conductance = {h:e}\n"));
            let text = perfect.replace("traction = false\n", &format!("traction = false\n{key}"));
            let name = format!("{fluid_name} on {solid_name}, {conductance:?}");
            heat_of_run(&name, &text, BEYOND[0])
        };
        let [least, twice, some, much, most] = [1.0, 2.0, 1e5, 1e7, 1e14].map(|h| heat(Some(h)));
        let all = heat(None);
        let name = format!("{fluid_name} on {solid_name}");
        println!("{name}: {least:e} {twice:e} {some:e} {much:e} {most:e} {all:e}");
        assert!(off(twice, 2.0 * least) < 1e-3, "{name}: {least} J, {twice} J");
        assert!([twice, some, much, most].is_sorted(), "{name}: {some} J, {much} J, {most} J");
        assert!(off(most, all) < 0.03, "{name}: {most} J, {all} J");
    }
}

/// The key of a wall acts as that of a coupling does.
#[test]
fn walls_of_prescribed_temperature_resist_too() {
    let ((_, fluid), (_, solid)) = (FLUIDS[3], SOLIDS[1]);
    let [text, _] = halves(&scene(fluid, solid, DISC, "fem", 1), 1.0);
    let held = text.replace("effusivity = 1.0\n", "");
    let heat = |key: &str| {
        let mut trial = Trial::new(&held.replace("[[wall]]\n", &format!("[[wall]]\n{key}")));
        (0..STEPS).for_each(|_| trial.step(STOP / STEPS as f64));
        let [given, lost] = ["drop.heat", "drop.heat_stored"].map(|total| trial.get(total));
        assert!(given > 0.0 && off(-lost, given) < 1e-6, "{key}: {given} J, {lost} J");
        given
    };
    let [all, most] = ["", "conductance = 1e14\n"].map(heat);
    let [least, twice] = ["conductance = 1.0\n", "conductance = 2.0\n"].map(heat);
    assert!(off(most, all) < 0.01, "{most} J, {all} J");
    assert!(off(twice, 2.0 * least) < 1e-4 && twice < 1e-3 * all, "{least} J, {twice} J");
}
