//! Solids that touch, and several bodies that meet on one.

use crate::common::{Trial, off, sweep};
use impinge::closed_form::{Conductor, Contact, ResistiveContact};
use impinge::model::forecast;
use impinge::scene::parse;

/// Density, specific heat and conductivity.
type Material = [f64; 3];

const COPPER: Material = [8960.0, 385.0, 400.0];
const ALUMINA: Material = [3950.0, 900.0, 10.0];
const AEROGEL: Material = [100.0, 1000.0, 0.015];
const MERCURY: Material = [13534.0, 139.5, 8.3];
const GLASS: Material = [2500.0, 840.0, 1.0];
const DIAMOND: Material = [3515.0, 510.0, 2200.0];

fn conductor([density, specific_heat, conductivity]: Material) -> Conductor {
    Conductor { conductivity, heat_capacity: density * specific_heat }
}

/// A plate on a bed; each has a shape, a material, a temperature and a mesh.
fn stack(
    [bed, plate]: [(&str, Material, f64, &str); 2],
    [conductance, interval]: [f64; 2],
    rest: &str,
) -> String {
    let body = |name: &str,
                (shape, [density, heat, conductivity], temperature, mesh): (
        &str,
        Material,
        f64,
        &str,
    )| {
        format!(
            "[body.{name}]\nkind = \"solid\"\nshape = {{ {shape} }}\ninitial_temperature = {temperature:?}\n\
             mesh = {{ {mesh} }}\nmaterial = {{ model = \"thermoelastic\", density = {density:?}, \
             specific_heat = {heat:?}, conductivity = {conductivity:?} }}\n"
        )
    };
    format!(
        "name = \"Stack\"\nstop_time = 1.0\nstep = 0.1\n{}{}[[coupling]]\nfrom = \"bed.top\"\nto = \"plate.bottom\"\n\
         conductance = {conductance:e}\ninterval = {interval:e}\n{rest}",
        body("bed", bed),
        body("plate", plate)
    )
}

fn probe(name: &str, body: &str, z: f64) -> String {
    format!(
        "[[probe]]\nname = \"{name}\"\nin = \"{body}\"\nat = [0.0, 0.0, {z:?}]\ngives = [\"temperature\"]\n"
    )
}

/// All heat that leaves the one enters the other.
fn assert_balanced(trial: &mut Trial) {
    let [bed, plate] = ["bed.heat_in", "plate.heat_in"].map(|name| trial.get(name));
    assert!((bed + plate).abs() <= 1e-12 * bed.abs(), "{bed} {plate}");
    for body in ["bed", "plate"] {
        assert!(trial.heat_residual(body) < 1e-9, "{body}");
    }
}

#[test]
fn half_spaces_in_resistive_contact_have_their_closed_form() {
    let pairs = [
        (COPPER, ALUMINA),
        (GLASS, AEROGEL),
        (MERCURY, DIAMOND),
        (AEROGEL, AEROGEL),
        (DIAMOND, GLASS),
        (ALUMINA, MERCURY),
    ];
    for (number, (below, above)) in pairs.into_iter().enumerate() {
        let bodies = Contact {
            first: conductor(below),
            first_temperature: 500.0,
            second: conductor(above),
            second_temperature: 300.0,
        };
        let fastest = bodies.first.diffusivity().max(bodies.second.diffusivity());
        let stop: f64 = 1e-2;
        let thickness = 8.0 * (fastest * stop).sqrt();
        for biot in if number < 2 { &[0.3, 10.0][..] } else { &[10.0] } {
            let least = bodies.first.effusivity().min(bodies.second.effusivity());
            let conductance = biot * least / stop.sqrt();
            let shape = format!("box = [1.0, 1.0, {thickness:e}]");
            // As fine for each as its heat goes deep.
            let mesh = |conductor: Conductor| {
                let deep = (conductor.diffusivity() * stop).sqrt();
                format!("spacing = 0.5, depth_spacing = {:e}, growth = 1.4", 0.2 * deep)
            };
            let meshes = [mesh(bodies.first), mesh(bodies.second)];
            let text = stack(
                [(&shape, below, 500.0, &meshes[0]), (&shape, above, 300.0, &meshes[1])],
                [conductance, stop / 20.0],
                &(probe("under", "bed", 0.0) + &probe("over", "plate", -thickness)),
            );
            let exact = ResistiveContact { bodies, conductance };
            let mut trial = Trial::new(&text);
            trial.step(stop);
            assert_balanced(&mut trial);
            let surfaces = exact.surfaces(stop);
            for (name, wanted) in ["under.temperature", "over.temperature"].iter().zip(surfaces) {
                let found = trial.get(name);
                assert!((found - wanted).abs() < 1e-4 * 200.0, "{name} {biot}: {found} {wanted}");
            }
        }
    }
}

#[test]
fn plates_without_resistance_of_their_own_even_out_at_third_order() {
    // Heat capacities c per area, conductance h: the difference falls as exp(−h (1/c₁ + 1/c₂) t).
    let material = |conductivity: f64| [1.0, 1.0, conductivity];
    let shapes = ["box = [1.0, 1.0, 2.0]", "box = [1.0, 1.0, 0.5]"];
    let mesh = "spacing = 0.5, depth_spacing = 0.5";
    let error = |parts: f64| {
        let text = stack(
            [(shapes[0], material(1e9), 400.0, mesh), (shapes[1], material(1e9), 300.0, mesh)],
            [1.0, 1.0 / parts],
            &probe("plate_top", "plate", 0.0),
        );
        let mut trial = Trial::new(&text);
        trial.step(1.0);
        assert_balanced(&mut trial);
        let even = (2.0 * 400.0 + 0.5 * 300.0) / 2.5;
        let exact = even - 100.0 * 2.0 / 2.5 * (-2.5f64).exp();
        (trial.get("plate_top.temperature") - exact).abs()
    };
    let errors = [4.0, 8.0, 16.0].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((2.7..3.3).contains(&order), "{errors:?}");
    }
}

#[test]
fn a_stack_conducts_as_its_resistances_in_a_row() {
    let faces = "[body.bed.faces]\nbottom = { temperature = 420.0 }\n[body.plate.faces]\ntop = { temperature = 300.0 }\n";
    for (kind, area) in [
        (["box = [0.3, 0.2, 0.01]", "box = [0.3, 0.2, 0.002]"], 0.06),
        (
            [
                "disc = { radius = 0.1, thickness = 0.01 }",
                "disc = { radius = 0.1, thickness = 0.002 }",
            ],
            std::f64::consts::PI * 0.01,
        ),
    ] {
        let mesh = "spacing = 0.05, depth_spacing = 1e-3";
        let other = "spacing = 0.03, depth_spacing = 1e-3, order = 1";
        for conductance in [1e-3, 5e3, 1e12] {
            let text = stack(
                [(kind[0], COPPER, 300.0, mesh), (kind[1], GLASS, 300.0, other)],
                [conductance, 1e9],
                faces,
            );
            let mut trial = Trial::new(&text);
            for _ in 0..3 {
                trial.step(1e6);
            }
            let before = trial.get("plate.heat_lost");
            trial.step(1e3);
            let flow = (trial.get("plate.heat_lost") - before) / 1e3;
            let resistance = 0.01 / COPPER[2] + 1.0 / conductance + 0.002 / GLASS[2];
            let wanted = 120.0 * area / resistance;
            assert!(off(flow, wanted) < 1e-6, "{conductance}: {flow} {wanted}");
            assert!(
                (trial.get("bed.heat_in") + trial.get("plate.heat_in")).abs() < 1e-9 * wanted * 3e6
            );
        }
    }
}

/// A small plate with a hot spot on a larger bed, and the two as they would be without resistance.
fn small_on_large(conductance: f64, spacing: [f64; 2]) -> String {
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { disc = { radius = 2e-3 } }\n\
                carries = [\"heat_flux\"]\nstart = { heat_flux = 1e6, x = 1e-3, y = 5e-4 }\n";
    let rest = format!("{load}{}{}", probe("spot_top", "plate", 0.0), probe("under", "bed", -1e-4));
    let [bed, plate] =
        spacing.map(|spacing| format!("spacing = {spacing:e}, depth_spacing = 2e-4, growth = 1.3"));
    stack(
        [
            ("box = [0.03, 0.024, 0.003]", ALUMINA, 300.0, &bed),
            ("box = [0.012, 0.01, 0.001]", GLASS, 300.0, &plate),
        ],
        [conductance, 2e-2],
        &rest,
    )
}

#[test]
fn plates_of_different_sizes_and_meshes_lose_no_heat() {
    let run = |spacing: [f64; 2]| {
        let mut trial = Trial::new(&small_on_large(2e3, spacing));
        for _ in 0..5 {
            trial.step(0.1);
        }
        let [bed, plate] = ["bed", "plate"].map(|body| {
            assert!(trial.heat_residual(body) < 1e-9, "{body}");
            trial.get(&format!("{body}.heat_stored"))
        });
        let load = std::f64::consts::PI * 4e-6 * 1e6 * 0.5;
        assert!(off(bed + plate, load) < 1e-9, "{bed} {plate} {load}");
        [bed, trial.get("spot_top.temperature") - 300.0, trial.get("under.temperature") - 300.0]
    };
    let (coarse, fine) = (run([1e-3, 5e-4]), run([7e-4, 3e-4]));
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(off(*coarse, fine) < 0.01, "{coarse:?} {fine:?}");
    }
}

#[test]
fn rates_of_bodies_in_contact_are_the_limit_of_differences() {
    let mut trial = Trial::new(&small_on_large(2e3, [3e-3, 2e-3]));
    trial.step(0.2);
    let names: Vec<String> =
        ["spot_top.temperature", "under.temperature", "bed.heat_in", "plate.heat_stored"]
            .map(String::from)
            .into();
    let rates = trial.rates(&names);
    let saved = trial.state.clone();
    let before: Vec<f64> = names.iter().map(|name| trial.get(name)).collect();
    let error = |dt: f64, trial: &mut Trial| {
        trial.restart(&saved);
        trial.step(dt);
        let found = names.iter().zip(&before).map(|(name, before)| (trial.get(name) - before) / dt);
        found.zip(&rates).map(|(found, rate)| off(found, *rate)).fold(0.0, f64::max)
    };
    let errors = [1e-5, 1e-6].map(|dt| error(dt, &mut trial));
    assert!(errors[1] < 2e-3 && errors[1] < 0.2 * errors[0], "{errors:?}");
}

#[test]
fn a_restored_state_goes_on_to_the_bit_and_on_any_number_of_threads() {
    let text = small_on_large(2e3, [2e-3, 1e-3]);
    let mut trial = Trial::new(&text);
    trial.step(0.1);
    let saved = trial.state.clone();
    trial.step(0.1);
    let ahead = trial.state.clone();
    let mut other = Trial::on_threads(&text, 3);
    other.restart(&saved);
    other.step(0.1);
    assert_eq!(other.state, ahead);
}

#[test]
fn three_plates_exchange_through_both_contacts_at_once() {
    let mut text = stack(
        [
            ("box = [0.02, 0.02, 0.002]", COPPER, 500.0, "spacing = 0.01, depth_spacing = 2e-4"),
            ("box = [0.02, 0.02, 0.001]", GLASS, 300.0, "spacing = 0.01, depth_spacing = 1e-4"),
        ],
        [1e4, 1e-2],
        &probe("middle", "plate", -5e-4),
    );
    text += "[body.lid]\nkind = \"solid\"\nshape = { box = [0.02, 0.02, 0.002] }\ninitial_temperature = 500.0\n\
             material = { model = \"thermoelastic\", density = 8960.0, specific_heat = 385.0, conductivity = 400.0 }\n\
             mesh = { spacing = 0.01, depth_spacing = 2e-4 }\n\
             [[coupling]]\nfrom = \"plate.top\"\nto = \"lid.bottom\"\nconductance = 1e4\n";
    // By symmetry nothing passes the middle of the plate: half of it on one of the others is the same.
    let half = stack(
        [
            ("box = [0.02, 0.02, 0.002]", COPPER, 500.0, "spacing = 0.01, depth_spacing = 2e-4"),
            ("box = [0.02, 0.02, 0.0005]", GLASS, 300.0, "spacing = 0.01, depth_spacing = 1e-4"),
        ],
        [1e4, 1e-2],
        &probe("middle", "plate", 0.0),
    );
    let (mut trial, mut half) = (Trial::new(&text), Trial::new(&half));
    for _ in 0..3 {
        trial.step(0.1);
        half.step(0.1);
        let (lid, bed) = (trial.get("lid.heat_in"), trial.get("bed.heat_in"));
        assert!(off(lid, bed) < 1e-9, "{lid} {bed}");
        let [found, wanted] =
            [&mut trial, &mut half].map(|trial| trial.get("middle.temperature") - 300.0);
        assert!(off(found, wanted) < 1e-3, "{found} {wanted}");
    }
}

fn droplet(name: &str, x: f64, fluid: &str) -> String {
    format!(
        "[body.{name}]\nkind = \"droplet\"\ndiameter = 1e-4\nimpact_velocity = 10.0\ninitial_temperature = 350.0\n\
         spacing = 1.25e-5\narrivals = [{{ x = {x:?}, y = 0.0 }}]\nfluid = {{ {fluid} }}\n"
    )
}

const WATER: &str =
    "density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6";
const TIN: &str =
    "density = 6990.0, viscosity = 1.8e-3, specific_heat = 250.0, conductivity = 30.0";

fn target(name: &str) -> String {
    format!(
        "[body.{name}]\nkind = \"solid\"\nshape = {{ box = [1e-3, 6e-4, 1e-4] }}\ninitial_temperature = 300.0\n\
         material = {{ model = \"thermoelastic\", density = 2500.0, specific_heat = 840.0, conductivity = 1.0, \
         young = 70e9, poisson = 0.22, expansion = 9e-6 }}\nsymmetry = \"none\"\n\
         mesh = {{ spacing = 2.5e-5, depth_spacing = 1e-6, growth = 2.0, order = 1 }}\n\
         faces = {{ bottom = {{ clamped = true }} }}\n"
    )
}

fn couple(from: &str, to: &str) -> String {
    format!("[[coupling]]\nfrom = \"{from}\"\nto = \"{to}.top\"\ninterval = 1e-7\nradius = 1e-4\n")
}

fn look(body: &str, x: f64) -> String {
    let name = if x < 0.0 { "left" } else { "right" };
    format!(
        "[[probe]]\nname = \"{body}_{name}\"\nin = \"{body}\"\nat = [{x:?}, 0.0, 0.0]\n\
         gives = [\"temperature\", \"stress\"]\n"
    )
}

const HEAD: &str = "name = \"Drops\"\nstop_time = 2e-6\nstep = 1e-6\n";

#[test]
fn droplets_of_two_fluids_on_one_plate_each_do_what_they_do_alone() {
    let probes = look("plate", -2.5e-4) + &look("plate", 2.5e-4);
    let water = droplet("water", -2.5e-4, WATER);
    let tin = droplet("tin", 2.5e-4, TIN);
    let plate = target("plate");
    let both = couple("water", "plate") + &couple("tin", "plate");
    let mut together = Trial::new(&format!("{HEAD}{water}{tin}{plate}{both}{probes}"));
    let alone = [(&water, "water"), (&tin, "tin")].map(|(drop, name)| {
        // The other's part of the mesh is fine by a load that carries nothing.
        let x = if name == "water" { 2.5e-4 } else { -2.5e-4 };
        let fine = format!(
            "[[load]]\nname = \"none\"\non = \"plate.top\"\nfootprint = {{ disc = {{ radius = 1e-4 }} }}\n\
             carries = [\"heat_flux\"]\nstart = {{ x = {x:?} }}\n"
        );
        Trial::new(&format!("{HEAD}{drop}{plate}{}{fine}{probes}", couple(name, "plate")))
    });
    let [mut water, mut tin] = alone;
    for trial in [&mut together, &mut water, &mut tin] {
        (0..2).for_each(|_| trial.step(1e-6));
    }
    let given: f64 = ["water.heat", "tin.heat"].iter().map(|name| together.get(name)).sum();
    assert!(off(together.get("plate.heat_in"), given) < 1e-12);
    for (single, name) in [(&mut water, "water"), (&mut tin, "tin")] {
        for key in ["heat", "impulse_z", "spread_diameter"] {
            let key = format!("{name}.{key}");
            let (found, wanted) = (together.get(&key), single.get(&key));
            assert!(off(found, wanted) < 2e-2, "{key}: {found} {wanted}");
        }
    }
    // The plate is linear: what it feels is the sum.
    for key in ["left.temperature", "right.temperature", "left.stress_zz", "right.stress_zz"] {
        let key = format!("plate_{key}");
        let base = if key.ends_with("temperature") { 300.0 } else { 0.0 };
        let sum = water.get(&key) + tin.get(&key) - 2.0 * base;
        let found = together.get(&key) - base;
        assert!(off(found, sum) < 5e-2, "{key}: {found} {sum}");
    }
}

#[test]
fn a_droplet_on_each_of_two_plates_minds_its_own() {
    let (water, tin) = (droplet("water", 0.0, WATER), droplet("tin", 0.0, TIN));
    let one = target("first") + &couple("water", "first");
    let two = target("second") + &couple("tin", "second");
    let mut together = Trial::new(&format!("{HEAD}{water}{tin}{one}{two}"));
    let mut first = Trial::new(&format!("{HEAD}{water}{one}"));
    let mut second = Trial::new(&format!("{HEAD}{tin}{two}"));
    for trial in [&mut together, &mut first, &mut second] {
        (0..2).for_each(|_| trial.step(1e-6));
    }
    for (alone, names) in [
        (&mut first, ["water.heat", "water.force", "first.max_temperature", "first.max_von_mises"]),
        (&mut second, ["tin.heat", "tin.force", "second.max_temperature", "second.max_von_mises"]),
    ] {
        for name in names {
            assert_eq!(together.get(name), alone.get(name), "{name}");
        }
    }
}

#[test]
fn faces_of_different_sizes_touch_at_any_conductance_and_step() {
    let pairs = [(MERCURY, GLASS), (DIAMOND, AEROGEL), (COPPER, COPPER), (AEROGEL, AEROGEL)];
    let shapes = [
        [
            "disc = { radius = 1e-2, thickness = 4e-3 }",
            "disc = { radius = 5e-3, thickness = 2e-3 }",
        ],
        ["box = [2e-2, 1e-2, 4e-3]", "box = [6e-3, 8e-3, 2e-3]"],
    ];
    for [bed, plate] in shapes {
        // Boxes take long: two pairs of them that differ do.
        let count = if bed.starts_with("box") { 2 } else { pairs.len() };
        for (below, above) in pairs.into_iter().take(count) {
            let all = [(1e4, 1e-3), (1e7, 1.0), (1e6, 1e5), (1e15, 1.0)];
            for (conductance, step) in sweep(&all, &[0, 3]) {
                // Only short steps need elements of boxes as small as they are by default.
                let is_wide = bed.starts_with("box") && step > 10.0;
                let mesh = if is_wide { "spacing = 2e-3, growth = 1.6" } else { "growth = 1.6" };
                let text = stack(
                    [(bed, below, 300.0, mesh), (plate, above, 600.0, mesh)],
                    [conductance, 1e9],
                    "",
                );
                let mut trial = Trial::new(&text);
                for _ in 0..2 {
                    let stepped = trial.try_step(step);
                    assert!(
                        stepped.is_ok(),
                        "{bed} {below:?} {above:?} {conductance} {step}: {stepped:?}"
                    );
                    let [bed, plate] = ["bed.heat_in", "plate.heat_in"].map(|name| trial.get(name));
                    assert!((bed + plate).abs() <= 1e-9 * bed.abs(), "{bed} {plate}");
                    let [bed, plate] =
                        ["bed", "plate"].map(|name| trial.get(&format!("{name}.max_temperature")));
                    // Short steps overshoot beside the contact by what coarse elements do.
                    assert!(bed < 606.0 && plate < 606.0, "{conductance} {step}: {bed} {plate}");
                }
            }
        }
    }
}

#[test]
fn heat_does_not_go_from_cold_to_hot_in_long_steps() {
    // A thin plate on a bed with fourteen times its heat: it never falls below the bed's temperature.
    let bed = "disc = { radius = 5e-3, thickness = 4e-3 }";
    for (plate, conductance) in [(2e-4, 1e3), (2e-3, 1e5)] {
        let plate = format!("disc = {{ radius = 5e-3, thickness = {plate:e} }}");
        for step in [0.1, 1.0, 6.25, 25.0, 1e3] {
            let text = stack(
                [(bed, COPPER, 300.0, "spacing = 1e-3"), (&plate, COPPER, 600.0, "spacing = 1e-4")],
                [conductance, 1e9],
                &probe("plate_top", "plate", 0.0),
            );
            let mut trial = Trial::new(&text);
            for _ in 0..3 {
                trial.step(step);
                let [bed, plate] =
                    ["bed.max_temperature", "plate_top.temperature"].map(|name| trial.get(name));
                assert!(plate > bed - 0.3, "{step}: {plate} {bed}");
            }
        }
    }
}

#[test]
fn a_step_beyond_numbers_is_refused() {
    let mut trial = Trial::new(&small_on_large(2e3, [3e-3, 2e-3]));
    let before = trial.state.clone();
    assert!(trial.try_step(1e300).is_err());
    assert_eq!(trial.state, before);
    trial.step(0.1);
}

#[test]
fn forecasts_count_exchanges_between_solids() {
    let said = |interval: f64| {
        let text = small_on_large(2e3, [2e-3, 1e-3])
            .replace("interval = 2e-2", &format!("interval = {interval:e}"));
        forecast(&parse(&text, "scene.toml").unwrap()).run_time()
    };
    let [once, often] = [said(0.1), said(0.1 / 64.0)];
    let alone = {
        let text = small_on_large(2e3, [2e-3, 1e-3]);
        let (text, _) = text.split_once("[[coupling]]").unwrap();
        forecast(&parse(text, "scene.toml").unwrap()).run_time()
    };
    assert!(once > 1.2 * alone && often > 20.0 * once, "{alone} {once} {often}");
}
