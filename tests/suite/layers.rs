//! Bodies of several materials: heat through layers against series, balances, mechanics against laminates.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::closed_form::{Back, CompositeSlab, Conductor, SlabLayer};

/// Density, specific heat, conductivity, Young's modulus, Poisson's ratio, expansion.
pub type Row = [f64; 6];

pub const ALL: &str = r#""temperature", "stress", "displacement""#;

pub const ALUMINA: Row = [3950.0, 900.0, 10.0, 300e9, 0.21, 8.1e-6];
pub const DIAMOND: Row = [3515.0, 510.0, 2200.0, 1.22e12, 0.07, 1e-6];
pub const COPPER: Row = [8960.0, 385.0, 400.0, 117e9, 0.34, 17e-6];
pub const LEAD: Row = [11_340.0, 129.0, 35.0, 16e9, 0.44, 29e-6];
pub const GLASS: Row = [2500.0, 840.0, 1.1, 70e9, 0.22, 9e-6];
pub const PTFE: Row = [2200.0, 1000.0, 0.25, 0.5e9, 0.46, 1.2e-4];
pub const AEROGEL: Row = [100.0, 1000.0, 0.02, 1e6, 0.2, 4e-6];

pub fn material([density, specific_heat, conductivity, young, poisson, expansion]: Row) -> String {
    format!(
        "{{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, \
         conductivity = {conductivity:?}, young = {young:?}, poisson = {poisson:?}, expansion = {expansion:?} }}"
    )
}

/// Material, thickness, contact resistance with the layer above; from the top.
pub type Stack<'a> = &'a [(Row, f64, f64)];

pub fn layers(stack: Stack) -> String {
    let layer = |(i, &(row, thickness, resistance)): (usize, &(Row, f64, f64))| {
        let contact =
            if i > 0 { format!(", contact_resistance = {resistance:?}") } else { String::new() };
        format!("{{ material = {}, thickness = {thickness:?}{contact} }}", material(row))
    };
    let list: Vec<String> = stack.iter().enumerate().map(layer).collect();
    format!("layers = [ {} ]", list.join(", "))
}

pub fn thickness(stack: Stack) -> f64 {
    stack.iter().map(|layer| layer.1).sum()
}

/// A body of a shape made of something; stop time and step, more keys of the body, faces and tables.
pub fn body(
    shape: &str,
    made_of: &str,
    [stop, step]: [f64; 2],
    keys: &str,
    faces: &str,
    rest: &str,
) -> String {
    format!(
        r#"
name = "Layers"
stop_time = {stop:?}
step = {step:?}
[body.plate]
kind = "solid"
shape = {{ {shape} }}
{made_of}
initial_temperature = 300.0
{keys}
[body.plate.faces]
{faces}
{rest}
"#
    )
}

pub fn square(width: f64, thickness: f64) -> String {
    format!("box = [{width:?}, {width:?}, {thickness:?}]")
}

pub fn probe(name: &str, at: [f64; 3], side: &str, gives: &str) -> String {
    let side = if side.is_empty() { String::new() } else { format!("side = {side:?}\n") };
    format!("[[probe]]\nname = {name:?}\nin = \"plate\"\nat = {at:?}\n{side}gives = [{gives}]\n")
}

pub fn slab(stack: Stack, back: Back) -> CompositeSlab {
    let layer =
        |&([density, heat, conductivity, ..], thickness, contact_resistance): &(Row, f64, f64)| {
            let body = Conductor { conductivity, heat_capacity: density * heat };
            SlabLayer { body, thickness, contact_resistance }
        };
    CompositeSlab { layers: stack.iter().map(layer).collect(), back }
}

/// Time that heat takes through a stack [s].
pub fn passage(stack: Stack) -> f64 {
    let root = |&([density, heat, k, ..], thickness, _): &(Row, f64, f64)| {
        thickness * (density * heat / k).sqrt()
    };
    stack.iter().map(root).sum::<f64>().powi(2)
}

/// Probes at tops and bottoms of all layers and in their middles: name, layer, depth.
pub fn places(stack: Stack) -> (String, Vec<(String, usize, f64)>) {
    let (mut text, mut list, mut top) = (String::new(), Vec::new(), 0.0);
    for (i, (_, thickness, _)) in stack.iter().enumerate() {
        let last = i + 1 == stack.len();
        for (part, share) in [("top", 0.0), ("middle", 0.5), ("bottom", 1.0)] {
            let side = match part {
                "bottom" if !last => "above",
                "top" if i > 0 => "below",
                _ => "",
            };
            let (name, depth) = (format!("{part}_{i}"), top + share * thickness);
            text += &probe(&name, [0.0, 0.0, -depth], side, "\"temperature\"");
            list.push((name, i, depth));
        }
        top += thickness;
    }
    (text, list)
}

pub const STACKS: [Stack<'static>; 6] = [
    &[(GLASS, 20e-6, 0.0), (ALUMINA, 240e-6, 1e-6)],
    &[(DIAMOND, 0.1e-3, 0.0), (AEROGEL, 0.2e-3, 0.0)],
    &[(PTFE, 1e-6, 0.0), (COPPER, 1e-3, 0.0)],
    &[(COPPER, 50e-6, 0.0), (GLASS, 80e-6, 3e-6), (LEAD, 200e-6, 0.0)],
    &[(AEROGEL, 30e-6, 0.0), (DIAMOND, 300e-6, 1e-4), (PTFE, 100e-6, 1e-7)],
    &[(LEAD, 0.1e-3, 0.0), (LEAD, 0.2e-3, 0.0)],
];

/// A disc, whose modes along the surface are few.
pub fn disc(thickness: f64) -> String {
    format!("disc = {{ radius = {:?}, thickness = {thickness:?} }}", 3.0 * thickness)
}

/// Largest error at the top, at interfaces and in between over the rise of the top, in ten steps until heat has
/// gone through the stack.
pub fn error_against_series(stack: Stack, back: Back, sudden: bool, mesh: &str) -> [f64; 2] {
    const STEPS: u32 = 10;
    let top = if sudden { "top = { temperature = 340.0 }" } else { "top = { flux = 1e5 }" };
    let bottom = if back == Back::Held { "bottom = { temperature = 300.0 }" } else { "" };
    let (text, list) = places(stack);
    let text = format!("{text}\n[fidelity]\ntolerance = 1e-3\n");
    let times = [passage(stack), passage(stack) / f64::from(STEPS)];
    let faces = format!("{top}\n{bottom}");
    let scene = body(&disc(thickness(stack)), &layers(stack), times, mesh, &faces, &text);
    let mut trial = Trial::new(&scene);
    let series = slab(stack, back);
    let series = if sudden { series.under_temperature(40.0) } else { series.under_flux(1e5) };
    let mut worst = [0.0_f64; 2];
    for step in 1..=STEPS {
        trial.step(times[1]);
        let t = f64::from(step) * times[1];
        let scale = series.rise((0, 0.0), t);
        for (name, layer, depth) in &list {
            let value = trial.get(&format!("{name}.temperature")) - 300.0;
            let error = (value - series.rise((*layer, *depth), t)).abs() / scale;
            let place = usize::from(*depth > 0.0);
            worst[place] = worst[place].max(error);
        }
        if sudden && back == Back::Insulated {
            let came_in = -trial.get("plate.heat_lost");
            let area = PI * (3.0 * thickness(stack)).powi(2);
            assert!(off(came_in, area * series.heat(t)) < 1e-3, "{stack:?} {t:e}: {came_in}");
        }
        let residual = trial.heat_residual("plate");
        assert!(residual < 1e-9, "{stack:?} {back:?} {sudden}: {residual:e}");
    }
    worst
}

#[test]
fn layers_under_flux_and_sudden_temperature_follow_the_series_of_the_composite_slab() {
    for stack in STACKS {
        for back in [Back::Insulated, Back::Held] {
            for sudden in [false, true] {
                let [top, inside] = error_against_series(stack, back, sudden, "");
                assert!(
                    top < 3e-4 && inside < 2e-3,
                    "{stack:?} {back:?} {sudden}: {top:e} {inside:e}"
                );
            }
        }
    }
}

#[test]
fn temperatures_in_layers_converge_at_the_order_of_the_elements() {
    // Layers of like delays, so that equal elements resolve them alike.
    let stack: Stack = &[(LEAD, 0.1e-3, 0.0), (ALUMINA, 0.06e-3, 2e-6), (LEAD, 0.1e-3, 0.0)];
    for (order, rate) in [(1, 2.0), (2, 4.0)] {
        for back in [Back::Insulated, Back::Held] {
            let error = |spacing: f64| {
                let mesh = format!(
                    "mesh = {{ spacing = 0.3e-3, depth_spacing = {spacing:?}, growth = 1.0, order = {order} }}"
                );
                let errors = error_against_series(stack, back, false, &mesh);
                errors[0].max(errors[1])
            };
            let coarse = if order == 1 { 2.5e-6 } else { 5e-6 };
            let (first, second) = (error(coarse), error(0.5 * coarse));
            let observed = (first / second).log2();
            let wanted = observed > rate - 0.35;
            assert!(wanted, "order {order} {back:?}: {first:e}, {second:e}, rate {observed}");
        }
    }
}

/// Loads of heat off all planes of symmetry, on faces that have no temperature, and elements twice as wide as usual
/// about them: balances and rates hold on any mesh.
fn loads(faces: &str) -> String {
    let held = |face: &str| faces.contains(&format!("{face} = {{ temperature"));
    let spot = if held("top") { "bottom" } else { "top" };
    let patch = if held("bottom") { "top" } else { "bottom" };
    format!(
        r#"
[refinement.plate]
along = 0.5
through = 1.0
[[load]]
name = "spot"
on = "plate.{spot}"
footprint = {{ gaussian = {{ radius = 0.2e-3 }} }}
carries = ["heat_flux"]
start = {{ heat_flux = 4e6, x = 0.13e-3, y = -0.08e-3 }}
[[load]]
name = "patch"
on = "plate.{patch}"
footprint = {{ tiles = {{ count = [2, 1], size = [0.5e-3, 0.4e-3] }} }}
carries = ["heat_flux"]
start = {{ heat_flux = [[1e6], [3e6]] }}
"#
    )
}

fn readings(trial: &mut Trial) -> Vec<f64> {
    let names = trial.outputs();
    names.iter().map(|name| trial.get(name)).collect()
}

#[test]
fn two_layers_of_one_material_are_one_body_of_it() {
    let probes: String =
        [[0.11e-3, 0.07e-3, 0.0], [-0.3e-3, 0.2e-3, -0.15e-3], [0.0, -0.1e-3, -0.3e-3]]
            .iter()
            .enumerate()
            .map(|(i, &at)| probe(&format!("p{i}"), at, "", ALL))
            .collect();
    for faces in [
        "sides = { clamped = true }\nbottom = { temperature = 310.0 }",
        "left = { temperature = 290.0, clamped = true }\nright = { flux = 2e5 }\ntop = { convection = { coefficient = 1e5, ambient = 350.0 } }",
        "sides = { convection = { coefficient = 4e4, ambient = 320.0 }, clamped = true }\nbottom = { flux = 3e5 }",
    ] {
        let rest = format!("{}{probes}", loads(faces));
        for order in [1, 2] {
            let mesh = format!(
                "mesh = {{ spacing = 0.2e-3, depth_spacing = 0.025e-3, growth = 1.0, order = {order} }}"
            );
            let trial = |made_of: &str| {
                Trial::new(&body(
                    &square(1.2e-3, 0.3e-3),
                    made_of,
                    [1e-2, 1e-3],
                    &mesh,
                    faces,
                    &rest,
                ))
            };
            let mut whole = trial(&format!("material = {}", material(ALUMINA)));
            let mut halves = trial(&layers(&[(ALUMINA, 0.15e-3, 0.0), (ALUMINA, 0.15e-3, 0.0)]));
            for _ in 0..2 {
                whole.step(1e-3);
                halves.step(1e-3);
                let names = whole.outputs();
                let (one, two) = (readings(&mut whole), readings(&mut halves));
                for group in [".temperature", ".displacement", "heat_"] {
                    let is_in = |name: &str| name.contains(group) && !name.contains("drift");
                    let members = (0..names.len()).filter(|&i| is_in(&names[i]));
                    let largest = members.clone().map(|i| one[i].abs()).fold(0.0, f64::max);
                    for i in members {
                        let difference = (one[i] - two[i]).abs() / largest;
                        assert!(
                            difference <= 1e-10,
                            "{faces} {order} {}: {difference:e}",
                            names[i]
                        );
                    }
                }
                assert!(halves.heat_residual("plate") < 1e-9);
            }
        }
    }
}

#[test]
fn heat_balances_in_layers_under_every_condition() {
    let stack: Stack =
        &[(DIAMOND, 5e-6, 0.0), (PTFE, 40e-6, 1e-6), (COPPER, 200e-6, 1e-7), (AEROGEL, 55e-6, 0.0)];
    for faces in [
        "",
        "left = { temperature = 310.0 }\nright = { temperature = 290.0 }\nbottom = { temperature = 320.0 }",
        "front = { temperature = 305.0 }\nbottom = { convection = { coefficient = 1e4, ambient = 280.0 } }\nleft = { flux = 1e5 }",
        "top = { temperature = 330.0 }\nsides = { temperature = 300.0 }",
        "top = { convection = { coefficient = 1e5, ambient = 280.0 } }\nsides = { flux = 3e4 }",
    ] {
        let text = body(
            &square(1.2e-3, 0.3e-3),
            &layers(stack),
            [1e-2, 1e-3],
            "mesh = { spacing = 0.2e-3, depth_spacing = 20e-6 }",
            faces,
            &loads(faces),
        );
        let mut trial = Trial::new(&text);
        trial.set_derivative("spot.heat_flux", 1, 1e6);
        trial.set_derivative("spot.heat_flux", 2, -1e5);
        for dt in [1e-9, 1e-6, 1e-4, 1e-2, 1.0] {
            trial.step(dt);
            let residual = trial.heat_residual("plate");
            assert!(residual < 1e-9, "{faces:?} after {dt:e}: {residual:e}");
        }
    }
}

#[test]
fn steps_of_any_length_give_the_same_heat() {
    let stack: Stack = &[(PTFE, 20e-6, 0.0), (COPPER, 280e-6, 1e-6)];
    let faces = "bottom = { temperature = 320.0 }";
    let rest = loads(faces) + &probe("p", [0.1e-3, 0.0, -20e-6], "below", "\"temperature\"");
    let run = |steps: u32| {
        let text = body(
            &square(1.2e-3, 0.3e-3),
            &layers(stack),
            [1e-2, 1e-3],
            "mesh = { spacing = 0.1e-3, depth_spacing = 8e-6 }",
            faces,
            &rest,
        );
        let mut trial = Trial::new(&text);
        trial.set_derivative("patch.heat_flux[2,1]", 1, 4e8);
        for _ in 0..steps {
            trial.step(3e-3 / f64::from(steps));
        }
        [trial.get("p.temperature") - 300.0, trial.get("plate.heat_lost")]
    };
    let (one, many) = (run(1), run(30));
    for (one, many) in one.into_iter().zip(many) {
        assert!(off(one, many) < 1e-9, "{one} {many}");
    }
}

#[test]
fn rates_in_layers_are_the_limit_of_differences() {
    let stack: Stack = &[(PTFE, 20e-6, 0.0), (COPPER, 280e-6, 1e-6)];
    let probes = probe("above", [0.1e-3, 0.0, -20e-6], "above", ALL)
        + &probe("below", [0.1e-3, 0.0, -20e-6], "below", ALL);
    let faces = "bottom = { temperature = 320.0, clamped = true }\nleft = { temperature = 295.0 }\ntop = { convection = { coefficient = 1e4, ambient = 350.0 } }";
    let mesh = "mesh = { spacing = 0.6e-3, depth_spacing = 20e-6 }";
    let text = body(
        &square(1.2e-3, 0.3e-3),
        &layers(stack),
        [1e-2, 1e-3],
        mesh,
        faces,
        &format!("{}{probes}", loads(faces)),
    );
    let mut trial = Trial::new(&text);
    trial.set_derivative("spot.heat_flux", 1, 1e9);
    trial.step(1e-3);
    let names: Vec<String> = trial
        .outputs()
        .into_iter()
        .filter(|name| !name.contains("max") && !name.contains("drift"))
        .collect();
    let rates = trial.rates(&names);
    let start: Vec<f64> = names.iter().map(|name| trial.get(name)).collect();
    let dt = 1e-7;
    trial.step(dt);
    for ((name, rate), start) in names.iter().zip(rates).zip(start) {
        let difference = (trial.get(name) - start) / dt;
        let scale = rate.abs().max(1e-9 * start.abs() / dt);
        assert!((difference - rate).abs() < 1e-3 * scale, "{name}: {rate:e} {difference:e}");
    }
}

#[test]
fn constants_of_layers_are_parameters() {
    let named = |coating: &str| {
        format!("[material.coating]\n{coating}\n[material.base]\n{}", table(COPPER))
    };
    let made_of = "layers = [ { material = \"coating\", thickness = 20e-6 }, { material = \"base\", thickness = 100e-6, contact_resistance = 1e-6 }, { material = \"coating\", thickness = 20e-6 } ]";
    let probes = probe("p", [0.0, 0.0, 0.0], "", "\"temperature\"");
    let text = |coating: &str| {
        body(
            &disc(140e-6),
            made_of,
            [1e-3, 1e-4],
            "",
            "top = { flux = 1e5 }",
            &format!("{probes}{}", named(coating)),
        )
    };
    let read = |trial: &mut Trial| {
        trial.step(1e-3);
        trial.get("p.temperature")
    };
    let glass = read(&mut Trial::new(&text(&table(GLASS))));
    let mut changed = GLASS;
    changed[2] = 3.0;
    let wanted = read(&mut Trial::new(&text(&table(changed))));
    assert!((wanted - glass).abs() > 1e-3);
    let mut scene = impinge::scene::parse(&text(&table(GLASS)), "scene.toml").unwrap();
    let registry = impinge::variables::Registry::of(&scene);
    let set = |scene: &mut impinge::scene::Scene, name: &str, value: f64| {
        let place = registry.find(name).unwrap_or_else(|| panic!("no {name}"));
        let impinge::variables::Slot::Parameter(parameter) = &registry.variables[place].slot else {
            panic!("{name}")
        };
        parameter.set(scene, value);
        assert_eq!(parameter.get(scene), value);
    };
    set(&mut scene, "plate.coating.conductivity", 3.0);
    assert_eq!(read(&mut Trial::of(scene.clone())), wanted);
    set(&mut scene, "plate.layer[2].contact_resistance", 1e-4);
    assert!(read(&mut Trial::of(scene)) > wanted + 1e-3);
    assert!(
        registry.find("plate.conductivity").is_none()
            && registry.find("plate.base.young").is_some()
    );
}

fn table(row: Row) -> String {
    material(row).trim_matches(['{', '}', ' ']).replace(", ", "\n")
}

/// A drop of hot water at 2 m/s on a plate.
fn drop_on(made_of: &str, film: Row, thickness: f64) -> Trial {
    let rest = r#"
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 2.0
initial_temperature = 360.0
spacing = 8e-6
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6, surface_tension = 0.072 }
[[coupling]]
from = "drop"
to = "plate.top"
"#
    .to_owned()
        + &probe("p", [0.0, 0.0, 0.0], "", "\"temperature\"");
    // A sixth of how far heat comes.
    let [density, heat, conductivity, ..] = film;
    let depth = ((conductivity / (density * heat) * 5e-6).sqrt() / 6.0).min(thickness).min(4e-7);
    let mesh = format!("mesh = {{ spacing = 8e-6, depth_spacing = {:?}, order = 1 }}", depth);
    let shape = "disc = { radius = 2e-4, thickness = 1e-4 }";
    Trial::new(&body(shape, made_of, [5e-6, 5e-7], &mesh, "bottom = { clamped = true }", &rest))
}

#[test]
fn a_drop_on_a_coating_gives_what_the_plate_gets_and_leaves_no_range_of_temperatures() {
    for (film, base, thickness) in [
        (PTFE, COPPER, 1e-7),
        (COPPER, AEROGEL, 1e-6),
        (DIAMOND, GLASS, 2e-6),
        (GLASS, DIAMOND, 5e-6),
        (ALUMINA, LEAD, 1e-6),
        (AEROGEL, COPPER, 3e-6),
    ] {
        let stack: Stack = &[(film, thickness, 0.0), (base, 1e-4 - thickness, 1e-8)];
        let mut trial = drop_on(&layers(stack), film, thickness);
        for _ in 0..10 {
            trial.step(5e-7);
            let (given, got) = (trial.get("drop.heat"), trial.get("plate.heat_in"));
            assert!((given - got).abs() <= 1e-12 * given.abs().max(1e-9), "{given:e} {got:e}");
            let fields = trial.fields("plate");
            for temperature in fields.temperature {
                let beyond = (temperature - 360.0).max(300.0 - temperature) / 60.0;
                assert!(beyond < 5e-3, "{film:?} on {base:?}: {temperature}");
            }
        }
        assert!(trial.get("p.temperature") > 300.0 && trial.heat_residual("plate") < 1e-9);
    }
}

#[test]
fn a_drop_feels_two_layers_of_one_material_as_one() {
    let mut whole = drop_on(&format!("material = {}", material(GLASS)), GLASS, 4e-7);
    let mut halves = drop_on(&layers(&[(GLASS, 5e-5, 0.0), (GLASS, 5e-5, 0.0)]), GLASS, 4e-7);
    for _ in 0..4 {
        whole.step(5e-7);
        halves.step(5e-7);
    }
    for name in ["drop.heat", "p.temperature"] {
        let (one, two) = (whole.get(name), halves.get(name));
        assert!(off(two, one) < 1e-3, "{name}: {one:e} {two:e}");
    }
}
