//! Bodies of several materials: heat through layers against series, balances, mechanics against laminates.

use crate::common::{Trial, off};
use impinge::closed_form::{Back, CompositeSlab, Conductor, SlabLayer};
use impinge::closed_form::{BondedLayer, BondedPlate};
use impinge::model::NodalFields;

/// Density, specific heat, conductivity, Young's modulus, Poisson's ratio, expansion.
type Row = [f64; 6];

const ALUMINA: Row = [3950.0, 900.0, 10.0, 300e9, 0.21, 8.1e-6];
const DIAMOND: Row = [3515.0, 510.0, 2200.0, 1.22e12, 0.07, 1e-6];
const COPPER: Row = [8960.0, 385.0, 400.0, 117e9, 0.34, 17e-6];
const LEAD: Row = [11_340.0, 129.0, 35.0, 16e9, 0.44, 29e-6];
const GLASS: Row = [2500.0, 840.0, 1.1, 70e9, 0.22, 9e-6];
const PTFE: Row = [2200.0, 1000.0, 0.25, 0.5e9, 0.46, 1.2e-4];
const AEROGEL: Row = [100.0, 1000.0, 0.02, 1e6, 0.2, 4e-6];

fn material([density, specific_heat, conductivity, young, poisson, expansion]: Row) -> String {
    format!(
        "{{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, \
         conductivity = {conductivity:?}, young = {young:?}, poisson = {poisson:?}, expansion = {expansion:?} }}"
    )
}

/// Material, thickness, contact resistance with the layer above; from the top.
type Stack<'a> = &'a [(Row, f64, f64)];

fn layers(stack: Stack) -> String {
    let layer = |(i, &(row, thickness, resistance)): (usize, &(Row, f64, f64))| {
        let contact =
            if i > 0 { format!(", contact_resistance = {resistance:?}") } else { String::new() };
        format!("{{ material = {}, thickness = {thickness:?}{contact} }}", material(row))
    };
    let list: Vec<String> = stack.iter().enumerate().map(layer).collect();
    format!("layers = [ {} ]", list.join(", "))
}

fn thickness(stack: Stack) -> f64 {
    stack.iter().map(|layer| layer.1).sum()
}

/// A body of these layers that is wider than thick; more keys of the body, faces and tables.
fn body(
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

fn square(width: f64, thickness: f64) -> String {
    format!("box = [{width:?}, {width:?}, {thickness:?}]")
}

fn probe(name: &str, at: [f64; 3], side: &str, gives: &str) -> String {
    let side = if side.is_empty() { String::new() } else { format!("side = {side:?}\n") };
    format!("[[probe]]\nname = {name:?}\nin = \"plate\"\nat = {at:?}\n{side}gives = [{gives}]\n")
}

fn slab(stack: Stack, back: Back) -> CompositeSlab {
    let layer =
        |&([density, heat, conductivity, ..], thickness, contact_resistance): &(Row, f64, f64)| {
            let body = Conductor { conductivity, heat_capacity: density * heat };
            SlabLayer { body, thickness, contact_resistance }
        };
    CompositeSlab { layers: stack.iter().map(layer).collect(), back }
}

/// Time that heat takes through a stack [s].
fn passage(stack: Stack) -> f64 {
    let root = |&([density, heat, k, ..], thickness, _): &(Row, f64, f64)| {
        thickness * (density * heat / k).sqrt()
    };
    stack.iter().map(root).sum::<f64>().powi(2)
}

/// Probes at tops and bottoms of all layers and in their middles: name, layer, depth.
fn places(stack: Stack) -> (String, Vec<(String, usize, f64)>) {
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

const STACKS: [Stack<'static>; 6] = [
    &[(GLASS, 20e-6, 0.0), (ALUMINA, 240e-6, 1e-6)],
    &[(DIAMOND, 0.1e-3, 0.0), (AEROGEL, 0.2e-3, 0.0)],
    &[(PTFE, 1e-6, 0.0), (COPPER, 1e-3, 0.0)],
    &[(COPPER, 50e-6, 0.0), (GLASS, 80e-6, 3e-6), (LEAD, 200e-6, 0.0)],
    &[(AEROGEL, 30e-6, 0.0), (DIAMOND, 300e-6, 1e-4), (PTFE, 100e-6, 1e-7)],
    &[(LEAD, 0.1e-3, 0.0), (LEAD, 0.2e-3, 0.0)],
];

#[test]
fn layers_under_flux_and_sudden_temperature_follow_the_series_of_the_composite_slab() {
    for stack in STACKS {
        let stop = passage(stack);
        let steps = 10;
        for back in [Back::Insulated, Back::Held] {
            for sudden in [false, true] {
                let top =
                    if sudden { "top = { temperature = 340.0 }" } else { "top = { flux = 1e5 }" };
                let bottom =
                    if back == Back::Held { "bottom = { temperature = 300.0 }" } else { "" };
                let (text, list) = places(stack);
                let faces = format!("{top}\n{bottom}");
                let shape = square(4.0 * thickness(stack), thickness(stack));
                let times = [stop, stop / f64::from(steps)];
                let mut trial = Trial::new(&body(&shape, &layers(stack), times, "", &faces, &text));
                let series = slab(stack, back);
                let rise = |layer: usize, depth: f64, t: f64| match sudden {
                    false => series.rise_under_flux(1e5, (layer, depth), t),
                    true => series.rise_under_temperature(40.0, (layer, depth), t),
                };
                for step in 1..=steps {
                    trial.step(times[1]);
                    let t = f64::from(step) * times[1];
                    let scale = rise(0, 0.0, t);
                    for (name, layer, depth) in &list {
                        let value = trial.get(&format!("{name}.temperature")) - 300.0;
                        let wanted = rise(*layer, *depth, t);
                        let error = (value - wanted).abs() / scale;
                        assert!(
                            error < 3e-4,
                            "{stack:?} {back:?} {sudden} {name} at {t:e}: {value} {wanted}"
                        );
                    }
                    assert!(trial.heat_residual("plate") < 1e-9);
                }
            }
        }
    }
}
