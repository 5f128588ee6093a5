//! Fluids that freeze on a wall: layers at rest against closed forms and a one-dimensional oracle, drops of scenes with
//! their balances, outputs and refusals.

use std::f64::consts::PI;

use crate::common::{Trial, off, sweep};
use crate::resting_layer::{Below, RestingLayer};
use impinge::closed_form::{Conductor, FreezingColumn, FreezingContact};
use impinge::laws::{Freezing, Melting, Viscosity};
use impinge::method::sph::Fluid;

/// Frozen and molten tin, stainless steel.
const FROZEN: Conductor = Conductor { conductivity: 62.0, heat_capacity: 6970.0 * 244.0 };
const MOLTEN: Conductor = Conductor { conductivity: 33.0, heat_capacity: 6970.0 * 244.0 };
const STEEL: Conductor = Conductor { conductivity: 14.9, heat_capacity: 7900.0 * 477.0 };
const DENSITY: f64 = 6970.0;
const LATENT: f64 = 59e3;
const MELTS_AT: f64 = 505.0;

/// Molten tin at a temperature on steel at another [K].
fn tin_on_steel([fluid, wall]: [f64; 2]) -> FreezingContact {
    FreezingContact {
        wall: STEEL,
        frozen: FROZEN,
        molten: MOLTEN,
        latent: DENSITY * LATENT,
        melts_at: MELTS_AT,
        wall_temperature: wall,
        fluid_temperature: fluid,
    }
}

/// Heat given to the wall by a time, of a flux like 1/√t [J/m²].
fn given(bodies: &FreezingContact, time: f64) -> f64 {
    2.0 * time * bodies.flux(time)
}

/// Tin of a closed form's constants.
fn fluid(bodies: &FreezingContact) -> Fluid {
    Fluid {
        density: DENSITY,
        viscosity: Viscosity::Constant(2e-3),
        specific_heat: bodies.molten.heat_capacity / DENSITY,
        conductivity: bodies.molten.conductivity,
        surface_tension: 0.0,
        sound_speed: 50.0,
        freezing: Some(Freezing {
            melting: Melting {
                solidus: bodies.melts_at,
                liquidus: bodies.melts_at,
                latent_heat: bodies.latent / DENSITY,
            },
            specific_heat: bodies.frozen.heat_capacity / DENSITY,
            conductivity: bodies.frozen.conductivity,
        }),
    }
}

/// A layer of tin on a half space, which heat does not pass through in a time.
fn layer(
    bodies: &FreezingContact,
    (spacing, time): (f64, f64),
    conductance: Option<f64>,
) -> RestingLayer {
    let rows = 6.0 * (bodies.molten.diffusivity() * time).sqrt() / spacing;
    let below = Below { effusivity: Some(bodies.wall.effusivity()), conductance };
    let arranged = (spacing, rows.max(6.0) as usize);
    RestingLayer::of(fluid(bodies), arranged, bodies.fluid_temperature, below)
}

/// Thickness of what is frozen, a particle by its part [m].
fn front(layer: &RestingLayer) -> f64 {
    let particles = layer.drop.particles(&layer.state);
    let frozen: f64 =
        particles.mass.iter().zip(&particles.solid_fraction).map(|(m, part)| m * part).sum();
    frozen / (DENSITY * layer.area)
}

/// Four pairs of temperatures, and the digits of the closed form: λ and the temperature of contact [K].
const CASES: [([f64; 2], [f64; 2]); 4] = [
    ([505.01, 298.15], [0.269269, 468.19]),
    ([513.0, 298.15], [0.254518, 469.79]),
    ([505.01, 423.15], [0.124516, 497.42]),
    ([513.0, 423.15], [0.110241, 498.21]),
];

/// Layers of which the front crosses a fifth, two and eight: errors of the heat at any of twenty times, and the
/// distance of the front from that of the closed form over a particle.
#[test]
fn layers_freeze_as_half_spaces_do() {
    for (temperatures, [growth, _]) in CASES {
        let exact = tin_on_steel(temperatures);
        assert!(off(exact.growth(), growth) < 2e-3, "{} {growth}", exact.growth());
        for (across, tolerated) in sweep(&[(0.2, 0.008), (2.0, 0.021), (8.0, 0.009)], &[0, 1]) {
            let time = 1e-4;
            let spacing = exact.front(time) / across;
            let mut layer = layer(&exact, (spacing, time), None);
            let (mut heat, mut worst) = (0.0, [0.0_f64; 2]);
            for part in 1..=20 {
                heat += layer.advance(exact.wall_temperature, time / 20.0);
                let now = time * f64::from(part) / 20.0;
                let errors =
                    [heat / given(&exact, now) - 1.0, (front(&layer) - exact.front(now)) / spacing];
                worst = [0, 1].map(|n| worst[n].max(errors[n].abs()));
            }
            println!(
                "{temperatures:?}, {across} across: heat {:.4}, front {:.3} of a particle",
                worst[0], worst[1]
            );
            assert!(
                worst[0] < tolerated && worst[1] < 0.1,
                "{temperatures:?}, {across}: {worst:?}"
            );
        }
    }
}

/// The same through a resistance, against an enthalpy method of 800 cells a body.
#[test]
fn layers_freeze_through_a_resistance() {
    let time = 1e-4;
    for (temperatures, _) in sweep(&[CASES[1], CASES[3]], &[0]) {
        let bodies = tin_on_steel(temperatures);
        let deep = |body: Conductor| 8.0 * (body.diffusivity() * time).sqrt();
        for conductance in sweep(&[1e5, 1e6, 2e7], &[1]) {
            let column = FreezingColumn {
                bodies,
                solidus: bodies.melts_at,
                conductance,
                wall_thickness: deep(bodies.wall),
                fluid_thickness: deep(bodies.frozen),
                cells: 800,
            };
            let exact = column.run(time, 1600);
            for across in sweep(&[2.0, 8.0], &[0]) {
                let spacing = bodies.front(time) / across;
                let mut layer = layer(&bodies, (spacing, time), Some(conductance));
                let (mut heat, mut now) = (0.0, 0.0);
                let mut errors = Vec::new();
                for n in [160, 400, 800, 1600] {
                    let at = exact[n - 1];
                    heat += layer.advance(bodies.wall_temperature, at.time - now);
                    now = at.time;
                    let front = front(&layer) - at.front;
                    errors.push([heat / at.heat - 1.0, front / spacing]);
                }
                let biot = conductance * spacing / MOLTEN.conductivity;
                println!("{temperatures:?}, Bi {biot:.2}, {across} across: {errors:.4?}");
                for [heat, front] in &errors {
                    assert!(heat.abs() < 0.012 && front.abs() < 0.1, "{errors:?}");
                }
            }
        }
    }
}

const SCENE: &str = r#"
name = "Freezing"
stop_time = 4e-4
step = 2e-5
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 1.0
initial_temperature = 520.0
spacing = 8e-6
precision = "double"
fluid = { density = 6970.0, viscosity = 1.9e-3, specific_heat = 244.0, conductivity = 33.0, surface_tension = 0.544, contact_angle = 1.0, melting = { solidus = 505.0, liquidus = 505.0, latent_heat = 59e3 }, frozen = { conductivity = 62.0 } }
[[wall]]
name = "wall"
under = "drop"
footprint = { rings = { count = 10, radius = 2e-4 } }
start = { temperature = 300.0 }
"#;

fn set_wall(trial: &mut Trial, temperature: f64) {
    for ring in 1..=10 {
        trial.set(&format!("wall.temperature[{ring}]"), temperature);
    }
}

/// Frozen, molten and frozen again: the heat is balanced, latent heat returns, and all of it shows in the outputs.
#[test]
fn heat_is_balanced_through_freezing_and_melting() {
    let mut trial = Trial::new(SCENE);
    let mass = trial.get("drop.mass");
    let mut frozen = Vec::new();
    for wall in [300.0, 700.0, 300.0] {
        set_wall(&mut trial, wall);
        for _ in 0..20 {
            trial.step(2e-5);
            let [drift, heat] = ["drop.heat_drift", "drop.heat"].map(|name| trial.get(name));
            assert!(drift.abs() < 1e-9 * (mass * LATENT), "{drift} J of {heat} J");
        }
        let [fraction, part, latent, arrest, stored, warmth] = [
            "solid_fraction",
            "frozen_mass",
            "latent_heat",
            "arrest_time",
            "heat_stored",
            "mean_temperature",
        ]
        .map(|name| trial.get(&format!("drop.{name}")));
        assert!(off(part, fraction * mass) < 1e-12 || fraction == 0.0);
        assert!(off(latent, part * LATENT) < 1e-12 || fraction == 0.0);
        // Both phases have one specific heat.
        assert!(off(stored, mass * 244.0 * (warmth - 520.0) - latent) < 1e-9, "{stored}");
        let on_wall: f64 = (1..=10)
            .map(|ring| {
                let area = f64::from(2 * ring - 1) * PI * 4e-10;
                area * trial.get(&format!("wall.frozen[{ring}]"))
            })
            .sum();
        assert!(off(DENSITY * on_wall, part) < 1e-9 || fraction == 0.0, "{on_wall}");
        frozen.push((fraction, arrest));
    }
    println!("{frozen:?}");
    let [(first, arrest), (molten, free), (again, later)] = frozen[..] else { panic!() };
    assert!(first > 0.999 && molten == 0.0 && again > 0.999, "{frozen:?}");
    assert!(arrest > 0.0 && arrest < 4e-4 && free == 0.0 && later > 8e-4, "{frozen:?}");
}

/// Tin on a warm plate freezes where an input, a flux or a load cools that, as on a plate that is cold at first.
#[test]
fn drops_freeze_whatever_cools_the_plate() {
    let plate = r#"
[body.plate]
kind = "solid"
shape = { disc = { radius = 0.4e-3, thickness = 50e-6 } }
material = { model = "thermoelastic", density = 8900.0, specific_heat = 385.0, conductivity = 390.0 }
initial_temperature = 600.0
faces.bottom = { KEY }
[[coupling]]
from = "drop"
to = "plate.top"
traction = false
"#;
    let drop = &SCENE[..SCENE.find("[[wall]]").unwrap()];
    let drop = drop
        .replace("initial_temperature = 520.0", "initial_temperature = 620.0")
        .replace("spacing = 8e-6", "spacing = 1.2e-5");
    let mut heats = Vec::new();
    for (key, input, value) in [
        ("temperature = 600.0", "plate.bottom.temperature", 400.0),
        ("temperature = 400.0", "plate.bottom.temperature", 400.0),
        ("flux = 0.0", "plate.bottom.flux", -5e7),
    ] {
        let mut trial = Trial::new(&format!("{drop}{}", plate.replace("KEY", key)));
        (0..5).for_each(|_| trial.step(2e-5));
        trial.set(input, value);
        (0..45).for_each(|_| trial.step(2e-5));
        let names = ["drop.solid_fraction", "drop.heat", "drop.mass"];
        let [frozen, heat, mass] = names.map(|name| trial.get(name));
        assert!(frozen > 0.99 && heat > mass * LATENT, "{key}: {frozen}, {heat} J");
        heats.push(heat / mass);
    }
    // From 620 K to 400 K, with the latent heat, however it came to that.
    let wanted = 244.0 * 220.0 + LATENT;
    assert!(heats[..2].iter().all(|heat| off(*heat, wanted) < 0.01), "{heats:?} {wanted}");
}

/// Frozen drops rest to the bit under gravity, and press with their weight.
#[test]
fn frozen_drops_do_not_creep() {
    let mut trial = Trial::new(&SCENE.replace("spacing = 8e-6", "spacing = 8e-6\ngravity = 98.1"));
    (0..40).for_each(|_| trial.step(2e-5));
    let frozen = trial.get("drop.solid_fraction");
    assert!((frozen - 1.0).abs() < 1e-12, "{frozen}");
    let read = |trial: &mut Trial| {
        ["height", "spread_diameter", "max_speed"].map(|name| trial.get(&format!("drop.{name}")))
    };
    let before = read(&mut trial);
    (0..20).for_each(|_| trial.step(2e-5));
    assert_eq!(read(&mut trial), before);
    assert_eq!(before[2], 0.0);
    let weight = trial.get("drop.mass") * 98.1;
    assert!(off(trial.get("drop.force"), weight) < 1e-6, "{weight}");
}
