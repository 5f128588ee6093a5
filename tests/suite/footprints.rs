//! A ring is an outer disc less an inner one, whatever it carries and wherever it goes.

use std::f64::consts::PI;

use impinge::closed_form::special::ierfc;

use crate::common::{Trial, off};

const ALUMINA: &str = "model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 30.0, \
                       young = 300e9, poisson = 0.21, expansion = 8.1e-6";
const AEROGEL: &str = "model = \"thermoelastic\", density = 100.0, specific_heat = 1000.0, conductivity = 0.02, \
                       young = 1e6, poisson = 0.2, expansion = 1e-5";

fn load(name: &str, footprint: &str, carries: &str, start: &str) -> String {
    format!(
        "[[load]]\nname = \"{name}\"\non = \"plate.top\"\nfootprint = {{ {footprint} }}\ncarries = [{carries}]\n\
         start = {{ {start} }}\n"
    )
}

fn plate(material: &str, shape: &str, mesh: &str, loads: &str) -> String {
    let probes: String = [[0.0, 0.0, 0.0], [1.1e-4, 4e-5, 0.0], [2e-4, 0.0, -5e-5]]
        .iter()
        .enumerate()
        .map(|(i, at)| {
            format!(
                "[[probe]]\nname = \"p{i}\"\nin = \"plate\"\nat = {at:?}\ngives = [\"temperature\", \"stress\", \"displacement\"]\n"
            )
        })
        .collect();
    format!(
        "name = \"Plate\"\nstop_time = 1e-3\nstep = 1e-4\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = 300.0\nmaterial = {{ {material} }}\nmesh = {{ {mesh} }}\n[body.plate.faces]\n\
         bottom = {{ clamped = true, convection = {{ coefficient = 50.0, ambient = 300.0 }} }}\n{loads}{probes}"
    )
}

const BOX: &str = "box = [8e-4, 6e-4, 2e-4]";
const DISC: &str = "disc = { radius = 4e-4, thickness = 2e-4 }";
const MESH: &str = "spacing = 6e-5, depth_spacing = 4e-5";
/// Radii of the ring.
const INNER: f64 = 6e-5;
const OUTER: f64 = 1.5e-4;

/// The scene with a ring, and that with two discs, the inner one of the opposite sign.
fn both(material: &str, shape: &str, place: &str) -> [Trial; 2] {
    let is_box = shape == BOX;
    let carries = if is_box {
        "\"heat_flux\", \"pressure\", \"shear\""
    } else {
        "\"heat_flux\", \"pressure\""
    };
    let amounts = |sign: f64| {
        let shear = if is_box {
            format!(", shear_x = {:e}, shear_y = {:e}", sign * 3e5, sign * -2e5)
        } else {
            String::new()
        };
        format!("heat_flux = {:e}, pressure = {:e}{shear}{place}", sign * 1e5, sign * 1e6)
    };
    let ring = format!("ring = {{ inner = {INNER:e}, outer = {OUTER:e} }}");
    let one = load("ring", &ring, carries, &amounts(1.0));
    let two = load("out", &format!("disc = {{ radius = {OUTER:e} }}"), carries, &amounts(1.0))
        + &load("hole", &format!("disc = {{ radius = {INNER:e} }}"), carries, &amounts(-1.0));
    [one, two].map(|loads| Trial::new(&plate(material, shape, MESH, &loads)))
}

/// Largest difference of outputs, over the largest of their kind.
fn difference(values: [&[f64]; 2], names: &[String]) -> f64 {
    let kind = |name: &String| name.rsplit('.').next().unwrap()[..4].to_owned();
    let scale = |name: &String| {
        let alike = names.iter().zip(values[0]).filter(|(other, _)| kind(other) == kind(name));
        alike.map(|(_, value)| value.abs()).fold(f64::MIN_POSITIVE, f64::max)
    };
    let all = names.iter().zip(values[0].iter().zip(values[1]));
    all.map(|(name, (a, b))| (a - b).abs() / scale(name)).fold(0.0, f64::max)
}

#[test]
fn a_ring_does_what_its_discs_do() {
    let moved = ", x = 5e-5, y = -8e-5";
    for (material, shape, place) in
        [(ALUMINA, BOX, moved), (AEROGEL, BOX, ""), (ALUMINA, DISC, ""), (AEROGEL, DISC, "")]
    {
        let [mut ring, mut discs] = both(material, shape, place);
        let names = ring.outputs();
        for _ in 0..2 {
            let found = [&mut ring, &mut discs].map(|trial| {
                trial.step(1e-4);
                assert!(trial.heat_residual("plate") < 1e-9);
                names.iter().map(|name| trial.get(name)).collect::<Vec<_>>()
            });
            let off = difference([&found[0], &found[1]], &names);
            assert!(off < 1e-9, "{shape} {place}: {off}");
        }
        let heat = 1e5 * PI * (OUTER - INNER) * (OUTER + INNER) * 2e-4;
        assert!(off(ring.get("plate.heat_in"), heat) < 1e-12);
    }
}

#[test]
fn a_ring_that_moves_and_grows_changes_outputs_as_its_discs_do() {
    for (shape, moves) in
        [(BOX, &[("x", 0.3), ("y", -0.2), ("radius", 0.1)][..]), (DISC, &[("radius", 0.1)])]
    {
        let [mut ring, mut discs] = both(ALUMINA, shape, "");
        let names = ring.outputs();
        for (key, rate) in moves {
            let share = if *key == "radius" { INNER / OUTER } else { 1.0 };
            ring.set_derivative(&format!("ring.{key}"), 1, *rate);
            discs.set_derivative(&format!("out.{key}"), 1, *rate);
            discs.set_derivative(&format!("hole.{key}"), 1, *rate * share);
        }
        let found = [&mut ring, &mut discs].map(|trial| trial.rates(&names));
        let apart = difference([&found[0], &found[1]], &names);
        assert!(apart < 1e-9, "{shape}: {apart}");
        // The heat of a whole step is the integral of the area.
        let radius = |t: f64| 1.0 + 0.1 / OUTER * t;
        let heat: f64 = {
            let dt = 2e-4;
            let mean =
                (radius(0.0).powi(2) + 4.0 * radius(0.5 * dt).powi(2) + radius(dt).powi(2)) / 6.0;
            1e5 * PI * (OUTER - INNER) * (OUTER + INNER) * mean * dt
        };
        ring.step(2e-4);
        assert!(off(ring.get("plate.heat_in"), heat) < 1e-10, "{shape}");
        assert!(ring.heat_residual("plate") < 1e-9);
    }
}

#[test]
fn the_mesh_sees_both_edges_of_a_ring() {
    for (shape, low) in [(BOX, -OUTER), (DISC, 0.0)] {
        for (inner, outer) in [(INNER, OUTER), (1.3e-4, OUTER)] {
            let ring = format!("ring = {{ inner = {inner:e}, outer = {outer:e} }}");
            let text =
                plate(ALUMINA, shape, "", &load("ring", &ring, "\"heat_flux\"", "heat_flux = 1e5"));
            let usual = "[refinement.plate]\nalong = 1.0\nthrough = 1.0\n";
            let mut trial = Trial::new(&(text + usual));
            let axes = trial.fields("plate").axes;
            let widest = axes[0]
                .windows(2)
                .filter(|pair| pair[0] >= low && pair[1] <= outer)
                .map(|pair| pair[1] - pair[0])
                .fold(0.0, f64::max);
            // Five nodes over the width of the ring at least, ten over a radius.
            let wanted = (0.2 * (outer - inner)).min(0.1 * outer);
            assert!(widest < 1.01 * wanted, "{shape} {inner}: {widest} {wanted}");
        }
    }
}

/// Beside a hole, a chosen mesh is as fine as beside a disc of its radius.
#[test]
fn a_chosen_mesh_sees_the_hole_of_a_ring() {
    let material =
        "model = \"thermoelastic\", density = 1000.0, specific_heat = 1000.0, conductivity = 1.0";
    let (inner, outer) = (3e-5_f64, 3e-4_f64);
    // Heat has come half-way into the hole.
    let time = (0.47 * inner).powi(2) / 1e-6;
    for shape in ["box = [2e-3, 2e-3, 4e-4]", "disc = { radius = 1e-3, thickness = 4e-4 }"] {
        let rise = |loads: &str| {
            let scene = format!(
                "name = \"Plate\"\nstop_time = {time:e}\nstep = {time:e}\n[body.plate]\nkind = \"solid\"\n\
                 shape = {{ {shape} }}\ninitial_temperature = 300.0\nmaterial = {{ {material} }}\n{loads}[[probe]]\n\
                 name = \"centre\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [\"temperature\"]\n"
            );
            let mut trial = Trial::new(&scene);
            trial.step(time);
            trial.get("centre.temperature") - 300.0
        };
        let flux = |sign: &str| format!("heat_flux = {sign}1e5");
        let ring = format!("ring = {{ inner = {inner:e}, outer = {outer:e} }}");
        let found = rise(&load("ring", &ring, "\"heat_flux\"", &flux("")));
        // What is under the middle of a wide disc, and what a disc of the hole's size takes from it (H. S. Carslaw
        // and J. C. Jaeger 1959, §10.5).
        let length = f64::sqrt(1e-6 * time);
        let below = |radius: f64| {
            let z = radius / (2.0 * length);
            2e5 * length / 1.0 * (ierfc(0.0) - ierfc(z))
        };
        let wanted = below(outer) - below(inner);
        let under = below(outer);
        assert!((found - wanted).abs() < 0.02 * under, "{shape}: {found}, not {wanted} of {under}");
    }
}

/// A scene of 1 ms of a body below a Gaussian spot of 1 W with these keys, with probes at places along x.
fn below_a_spot(body: &str, spot: &str, places: &[f64]) -> String {
    let probes: String = places
        .iter()
        .enumerate()
        .map(|(n, x)| {
            format!(
                "[[probe]]\nname = \"at{n}\"\nin = \"body\"\nat = [{x}, 0.0, 0.0]\ngives = [\"temperature\"]\n"
            )
        })
        .collect();
    format!(
        "name = \"Spot\"\nstop_time = 1e-3\nstep = 1e-3\n[body.body]\nkind = \"solid\"\n{body}\n\
         initial_temperature = 293.15\nmaterial = {{ model = \"thermoelastic\", density = 3950.0, \
         specific_heat = 900.0, conductivity = 10.0 }}\n[[load]]\nname = \"spot\"\non = \"body.top\"\n\
         carries = [\"power\"]\n{spot}\n{probes}"
    )
}

/// Rises at these places after 1 ms in equal steps, while an input of the spot changes at a rate.
fn rises(text: &str, places: &[f64], (input, rate): (&str, f64), steps: usize) -> Vec<f64> {
    let mut trial = Trial::new(text);
    trial.set_derivative(input, 1, rate);
    (0..steps).for_each(|_| trial.step(1e-3 / steps as f64));
    (0..places.len()).map(|n| trial.get(&format!("at{n}.temperature")) - 293.15).collect()
}

/// Bodies that touch exchange heat once a step, within which a footprint is sampled as on a body that touches nothing.
#[test]
fn footprints_move_on_bodies_in_contact_as_on_others() {
    let places = [-0.3e-3, 0.4e-3];
    let plate = below_a_spot(
        "shape = { box = [2e-3, 0.5e-3, 0.2e-3] }\n\
         mesh = { spacing = 50e-6, depth_spacing = 25e-6, growth = 1.0, order = 1 }",
        "footprint = { gaussian = { radius = 80e-6 } }\nstart = { power = 1.0, x = -0.7e-3 }\n\
         range = { x = [-0.7e-3, 0.7e-3] }",
        &places,
    );
    let chuck = "[body.chuck]\nkind = \"reservoir\"\nheat_capacity = 400.0\ninitial_temperature = 293.15\n[[coupling]]\n\
                 from = \"chuck.top\"\nto = \"body.bottom\"\nconductance = 1e-3\n";
    for method in ["modal", "newton"] {
        let run = |rest: &str, steps: usize| {
            let text = format!("{plate}{rest}[solver]\nmethod = \"{method}\"\n");
            rises(&text, &places, ("spot.x", 1.4), steps)
        };
        let alone = run("", 1);
        assert!(alone.iter().all(|&rise| rise > 10.0), "{method} {alone:?}");
        for steps in [1, 3] {
            let touched = run(chuck, steps);
            for (one, other) in alone.iter().zip(&touched) {
                assert!(off(*other, *one) < 2e-3, "{method}, {steps}: {alone:?} {touched:?}");
            }
        }
    }
}

/// A spot that shrinks to a tenth of its radius in one step, or grows from that, heats as it does in many.
#[test]
fn footprints_that_shrink_within_a_step_are_followed_to_their_least_size() {
    for (start, rate) in [(300e-6, -0.27), (30e-6, 0.27)] {
        let text = below_a_spot(
            "shape = { disc = { radius = 1e-3, thickness = 0.2e-3 } }\n\
             mesh = { spacing = 10e-6, depth_spacing = 5e-6, growth = 1.3 }",
            &format!(
                "footprint = {{ gaussian = {{ radius = 300e-6 }} }}\n\
                 start = {{ power = 1.0, radius = {start} }}\nrange = {{ radius = [30e-6, 300e-6] }}"
            ),
            &[0.0],
        );
        let [once, often] =
            [1, 300].map(|steps| rises(&text, &[0.0], ("spot.radius", rate), steps)[0]);
        assert!(off(once, often) < 2e-4, "{rate}: {once} {often}");
    }
}
