//! Solids of large strain above a `[[wall]]`: what its cells receive is what the body gives, in any model of the body
//! and in any number of steps, and what a solid in the same unit would receive.

use impinge::model::Cache;
use impinge::runtime::allowance::Allowance;

use crate::common::{Trial, off};

/// A warm gel that falls with further keys.
fn gel(keys: &str, more: &str) -> String {
    format!(
        r#"
name = "Gel"
stop_time = 0.02
step = 2e-4
[body.gel]
kind = "solid"
strain = "finite"
inertia = true
initial_temperature = 330.0
material = {{ model = "neo_hookean", density = 1000.0, specific_heat = 4000.0, conductivity = 0.6, young = 20e3, poisson = 0.4 }}
{keys}
{more}
"#
    )
}

const BALL: &str = "shape = { ball = { radius = 5e-3 } }\nmesh = { spacing = 1e-3 }\n\
                    start = { velocity = [0.0, 0.0, -1.0] }";
const BOX: &str = "shape = { box = [8e-3, 6e-3, 5e-3] }\nmesh = { spacing = 1e-3 }\n\
                   start = { velocity = [0.0, 0.0, -1.0] }";
/// Along x, with friction.
const SLIDES: &str = "shape = { box = [8e-3, 6e-3, 5e-3] }\nmesh = { spacing = 1e-3 }\n\
                      friction = 0.3\nstart = { velocity = [0.5, 0.0, -1.0] }";

fn wall(footprint: &str, keys: &str) -> String {
    format!(
        "[[wall]]\nname = \"wall\"\nunder = \"gel\"\nfootprint = {{ {footprint} }}\n\
         start = {{ temperature = 290.0 }}\n{keys}\n"
    )
}

/// Cells that the gel does not leave, and some that it does.
const WIDE_RINGS: &str = "rings = { count = 8, radius = 12e-3 }";
const NARROW_RINGS: &str = "rings = { count = 4, radius = 2e-3 }";
const WIDE_TILES: &str = "tiles = { count = [8, 6], size = [24e-3, 18e-3] }";
const NARROW_TILES: &str = "tiles = { count = [3, 3], size = [4e-3, 4e-3] }";
const CONDUCTS: &str = "conductance = 1000.0";

/// Names of a quantity of all cells, and their areas [m²].
fn cells(footprint: &str, key: &str) -> Vec<(String, f64)> {
    let ring = |count: u32, radius: f64| {
        let width = radius / f64::from(count);
        let area = move |n: u32| std::f64::consts::PI * width * width * f64::from(2 * n - 1);
        (1..=count).map(|n| (format!("wall.{key}[{n}]"), area(n))).collect()
    };
    let tiles = |[nx, ny]: [u32; 2], area: f64| {
        let name = |i: u32, j: u32| (format!("wall.{key}[{i},{j}]"), area);
        (1..=nx).flat_map(|i| (1..=ny).map(move |j| name(i, j))).collect()
    };
    match footprint {
        WIDE_RINGS => ring(8, 12e-3),
        NARROW_RINGS => ring(4, 2e-3),
        WIDE_TILES => tiles([8, 6], 24e-3 * 18e-3 / 48.0),
        _ => tiles([3, 3], 4e-3 * 4e-3 / 9.0),
    }
}

/// Sum over all cells of a quantity times their area.
fn total(trial: &mut Trial, footprint: &str, key: &str) -> f64 {
    cells(footprint, key).iter().map(|(name, area)| area * trial.get(name)).sum()
}

const STEP: f64 = 2e-4;

/// Pressures of cells with what is beyond them are the force of the contact, and what they sum to over a bounce is the
/// momentum of the gel; shear along x is what has braked it.
#[test]
fn cells_receive_the_momentum_of_the_gel() {
    for (body, footprint) in [
        (BALL, WIDE_RINGS),
        (BALL, NARROW_RINGS),
        (BALL, WIDE_TILES),
        (BOX, NARROW_RINGS),
        (BOX, WIDE_TILES),
        (SLIDES, WIDE_TILES),
        (SLIDES, NARROW_TILES),
    ] {
        let mut trial = Trial::new(&gel(body, &wall(footprint, "")));
        let start = ["x", "z"].map(|axis| trial.get(&format!("gel.momentum_{axis}")));
        let [mut given, mut beyond, mut sheared] = [0.0; 3];
        for _ in 0..60 {
            trial.step(STEP);
            let outside = trial.get("wall.force_outside");
            let force = total(&mut trial, footprint, "pressure") + outside;
            let whole = trial.get("gel.contact_force");
            assert!((force - whole).abs() <= 1e-12 * whole, "{footprint} {force} {whole}");
            given += STEP * force;
            beyond += STEP * outside;
            if body == SLIDES {
                sheared += STEP * total(&mut trial, footprint, "shear_x");
            }
        }
        let [drift, now] = ["x", "z"].map(|axis| trial.get(&format!("gel.momentum_{axis}")));
        assert!(now > 0.5 * -start[1], "{footprint}: no bounce, {now}");
        assert!(off(given, now - start[1]) < 1e-9, "{footprint} {given} {now} {start:?}");
        assert_eq!(beyond > 0.0, [NARROW_RINGS, NARROW_TILES].contains(&footprint), "{beyond}");
        if body == SLIDES {
            let braked = start[0] - drift;
            let impulse = trial.get("gel.impulse_x");
            assert!(braked > 0.1 * start[0] && off(impulse, braked) < 1e-9, "{impulse} {braked}");
            match footprint {
                WIDE_TILES => assert!(off(sheared, braked) < 1e-9, "{sheared} {braked}"),
                _ => assert!(sheared > 0.0 && sheared < braked, "{sheared} {braked}"),
            }
        }
    }
}

/// Heat of cells with that beyond them is what the gel has lost.
#[test]
fn cells_receive_the_heat_of_the_gel() {
    for (body, footprint) in
        [(BALL, WIDE_RINGS), (BALL, NARROW_RINGS), (BOX, WIDE_TILES), (BOX, NARROW_TILES)]
    {
        let mut trial = Trial::new(&gel(body, &wall(footprint, CONDUCTS)));
        let [mut given, mut beyond] = [0.0; 2];
        for n in 0..40 {
            // A wall that changes over a step.
            for (name, _) in cells(footprint, "temperature") {
                trial.set(&name, 290.0 + 0.1 * f64::from(n));
                trial.set_derivative(&name, 1, 0.1 / STEP);
            }
            trial.step(STEP);
            let outside = STEP * trial.get("wall.heat_flow_outside");
            given += STEP * total(&mut trial, footprint, "heat_flux") + outside;
            beyond += outside;
        }
        let [stored, heat] = ["gel.heat_stored", "gel.heat"].map(|key| trial.get(key));
        assert!(stored < 0.0 && off(given, -stored) < 1e-10, "{footprint} {given} {stored}");
        assert!(off(given, heat) < 1e-12, "{footprint} {given} {heat}");
        let leaves = [NARROW_RINGS, NARROW_TILES].contains(&footprint);
        assert_eq!(beyond > 0.0, leaves, "{footprint} {beyond}");
    }
}

/// Without a conductance no heat passes, and the temperatures of cells change nothing.
#[test]
fn no_heat_passes_without_a_conductance() {
    let run = |warm: f64| {
        let mut trial = Trial::new(&gel(BALL, &wall(WIDE_RINGS, "")));
        trial.set("wall.temperature[1]", warm);
        (0..20).for_each(|_| trial.step(STEP));
        assert_eq!(total(&mut trial, WIDE_RINGS, "heat_flux"), 0.0);
        assert_eq!(trial.get("wall.heat_flow_outside"), 0.0);
        trial.state.bodies
    };
    assert_eq!(run(290.0), run(400.0));
}

/// A plate that neither moves nor warms receives from a gel in its own unit what the cells of a wall do.
#[test]
fn a_wall_is_a_plate_that_does_not_respond() {
    let plate = r#"
[body.plate]
kind = "solid"
shape = { disc = { radius = 15e-3, thickness = 2e-3 } }
initial_temperature = 290.0
material = { model = "thermoelastic", density = 2e4, specific_heat = 1e6, conductivity = 1e6, young = 1e12, poisson = 0.2 }
mesh = { spacing = 1e-3 }
faces = { bottom = { clamped = true } }
[[coupling]]
from = "gel"
to = "plate.top"
conductance = 1000.0
interval = 2e-4
"#;
    let warm = format!("{BALL}\nfriction = 0.3");
    let mut one = Trial::new(&gel(&warm, plate));
    let mut two = Trial::new(&gel(&warm, &wall(WIDE_RINGS, CONDUCTS)));
    for _ in 0..40 {
        one.step(STEP);
        two.step(STEP);
        for key in ["contact_force", "momentum_z", "width", "friction_heat"] {
            let [own, other] = [&mut one, &mut two].map(|of| of.get(&format!("gel.{key}")));
            assert!((own - other).abs() <= 1e-9 * own.abs(), "{key} {own} {other}");
        }
    }
    let [heat, other] = [&mut one, &mut two].map(|of| of.get("gel.heat"));
    println!("heat to a plate {heat}, to a wall {other}");
    assert!(other > 0.0 && off(other, heat) < 1e-3, "{heat} {other}");
}

/// A quarter of a gel gives each cell what the whole gives it.
#[test]
fn parts_of_a_gel_give_the_cells_the_same() {
    let run = |symmetry: &str, footprint: &str| {
        let body = format!("{BOX}\nfriction = 0.2\nsymmetry = \"{symmetry}\"");
        let mut trial = Trial::new(&gel(&body, &wall(footprint, CONDUCTS)));
        (0..6).for_each(|_| trial.step(STEP));
        let keys: &[&str] = match footprint {
            WIDE_RINGS => &["pressure", "heat_flux", "shear_r"],
            _ => &["pressure", "heat_flux", "shear_x", "shear_y"],
        };
        let mut of = |key: &str| -> Vec<f64> {
            cells(footprint, key).iter().map(|(name, _)| trial.get(name)).collect()
        };
        keys.iter().map(|key| of(key)).collect::<Vec<_>>()
    };
    for footprint in [WIDE_RINGS, WIDE_TILES] {
        let [whole, quarter] = ["none", "quarter"].map(|symmetry| run(symmetry, footprint));
        for (quantity, (whole, quarter)) in whole.iter().zip(&quarter).enumerate() {
            // Heat takes steps of its own, whose errors a norm over the model bounds.
            let tolerance = if quantity == 1 { 1e-5 } else { 1e-7 };
            let scale = whole.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            assert!(scale > 0.0, "{footprint}");
            for (own, other) in whole.iter().zip(quarter) {
                assert!((own - other).abs() < tolerance * scale, "{footprint} {own} {other}");
            }
        }
    }
}

/// A plane gel presses on a row of tiles, per metre of depth.
#[test]
fn a_plane_gel_presses_on_a_row_of_tiles() {
    let footprint = "tiles = { count = [8, 1], size = [20e-3, 1e-4] }";
    let body = format!("{BOX}\ndimension = 2\nfriction = 0.2");
    let mut trial = Trial::new(&gel(&body, &wall(footprint, CONDUCTS)));
    let mut given = 0.0;
    for _ in 0..15 {
        trial.step(STEP);
        let mut sum = |key: &str| -> f64 {
            (1..=8).map(|n| 2.5e-3 * trial.get(&format!("wall.{key}[{n},1]"))).sum()
        };
        let [pressure, heat, shear] = ["pressure", "heat_flux", "shear_x"].map(&mut sum);
        given += STEP * heat;
        let force = trial.get("gel.contact_force");
        assert!((pressure - force).abs() <= 1e-12 * force, "{pressure} {force}");
        assert!(shear.abs() <= 1e-9 * force, "{shear} {force}");
    }
    let heat = trial.get("gel.heat");
    assert!(heat > 0.0 && off(given, heat) < 1e-10, "{given} {heat}");
}

/// A ball over tiles is modelled in space, over rings by a meridian section.
#[test]
fn cells_choose_the_model_of_a_ball() {
    let is_round = |footprint: &str| {
        let text = gel(BALL, &wall(footprint, ""));
        let scene = impinge::scene::parse(&text, "scene").unwrap();
        scene.large_strains().next().unwrap().1.is_axisymmetric()
    };
    assert_eq!([WIDE_RINGS, WIDE_TILES].map(is_round), [true, false]);
}

/// States amid contact continue bit for bit, and damaged ones are refused.
#[test]
fn states_in_contact_continue_bit_for_bit() {
    let body = format!("{BALL}\nfriction = 0.3");
    let mut trial = Trial::new(&gel(&body, &wall(NARROW_RINGS, CONDUCTS)));
    (0..12).for_each(|_| trial.step(STEP));
    assert!(trial.get("wall.force_outside") > 0.0);
    let saved = trial.state.clone();
    assert_eq!(trial.model.check_state(&saved), Ok(()));
    let run = |trial: &mut Trial| {
        trial.set("wall.temperature[2]", 300.0);
        (0..5).for_each(|_| trial.step(STEP));
        let names = trial.outputs();
        names.iter().map(|name| trial.get(name).to_bits()).collect::<Vec<_>>()
    };
    let first = run(&mut trial);
    let ended = trial.state.clone();
    trial.restart(&saved);
    assert_eq!(run(&mut trial), first);
    assert_eq!(trial.state, ended);
}

/// Means over a step in parts are those over all its parts.
#[test]
fn parts_of_a_step_are_joined() {
    let body = format!("{BALL}\nfriction = 0.3");
    let mut trial = Trial::new(&gel(&body, &wall(NARROW_RINGS, CONDUCTS)));
    (0..12).for_each(|_| trial.step(STEP));
    let mut names: Vec<String> = ["pressure", "shear_r", "heat_flux"]
        .iter()
        .flat_map(|key| cells(NARROW_RINGS, key).into_iter().map(|(name, _)| name))
        .collect();
    names.extend(
        ["wall.force_outside", "wall.heat_flow_outside", "gel.contact_force"].map(String::from),
    );
    let mut sums = vec![0.0; names.len()];
    let before = trial.state.clone();
    for part in [0.5, 0.3, 0.2] {
        trial.step(part * STEP);
        for (sum, name) in sums.iter_mut().zip(&names) {
            *sum += part * trial.get(name);
        }
    }
    trial.restart(&before);
    let (mut cache, allowance) = (Cache::default(), Allowance::default());
    trial.step(0.5 * STEP);
    for (part, ahead) in [(0.3, 0.5), (0.2, 0.2)] {
        let parts = (part * STEP, ahead * STEP);
        trial.model.step_on(&allowance, &mut trial.state, &mut cache, parts).unwrap();
    }
    trial.restart(&trial.state.clone());
    for (sum, name) in sums.iter().zip(&names) {
        let joined = trial.get(name);
        assert!((joined - sum).abs() <= 1e-12 * sum.abs(), "{name} {joined} {sum}");
        assert!(*sum != 0.0, "{name}");
    }
}

/// `check` warns of a wall of another temperature to which no heat passes.
#[test]
fn walls_without_a_conductance_are_warned_of() {
    let told = |keys: &str| {
        let text = gel(BALL, &wall(WIDE_RINGS, keys));
        let (_, found) = impinge::advice::parse_with_warnings(&text, "scene").unwrap();
        found.iter().any(|warning| warning.finding().id == "no_heat_passes")
    };
    assert_eq!(["", CONDUCTS].map(told), [true, false]);
}

/// A flat disc that lands presses evenly on all rings below it, up to the axis, and warms them evenly.
#[test]
fn even_contact_is_even_up_to_the_axis() {
    let disc = "shape = { disc = { radius = 10e-3, thickness = 5e-3 } }\nmesh = { spacing = 1e-3 }\n\
                start = { velocity = [0.0, 0.0, -1.0] }";
    for count in [18_u32, 9, 4] {
        let footprint = format!("rings = {{ count = {count}, radius = 9e-3 }}");
        let mut trial = Trial::new(&gel(disc, &wall(&footprint, CONDUCTS)));
        trial.step(2e-5);
        for key in ["pressure", "heat_flux"] {
            let mut of = |ring: u32| trial.get(&format!("wall.{key}[{ring}]"));
            let last = of(count);
            let worst = (1..count).map(|ring| off(of(ring), last)).fold(0.0, f64::max);
            println!("{count} rings, {key}: {worst}");
            assert!(worst < 0.08, "{count} {key} {worst}");
        }
    }
}
