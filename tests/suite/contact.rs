//! Drops of many fluids on plates of many materials: temperatures of contact, and none beyond those at first.

use crate::common::{Trial, off};

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
    trial.get("centre.temperature")
}

/// Linear and quadratic elements take turns, so that every fluid and every solid meets both.
#[test]
fn every_pair_takes_its_temperature_of_contact() {
    let effusivity = |[density, capacity, k]: [f64; 3]| (density * capacity * k).sqrt();
    let reach = |[density, capacity, k]: [f64; 3]| (k / (density * capacity) * STOP).sqrt();
    for (row, (fluid_name, fluid)) in FLUIDS.into_iter().enumerate() {
        for (column, (solid_name, solid)) in SOLIDS.into_iter().enumerate() {
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
