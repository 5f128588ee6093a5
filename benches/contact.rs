//! A layer of fluid at rest or sheared on a thick plate, both half spaces while heat has not gone through: how far are
//! heat and temperature of contact from the closed form (H. S. Carslaw, J. C. Jaeger 1959, § 2.8)?
//!
//! `cargo bench --bench contact -- SPACING RATIO PRANDTL EXCHANGES SHEAR`: distance of particles over the thickness
//! √(πκt) of the layer of heat in the fluid, effusivity of the fluid over that of the plate, Prandtl number of the
//! fluid, exchanges over which the time is cut, and by how much the fluid is sheared in the time. Prints one line of
//! JSON.

use std::env;
use std::f64::consts::PI;

use impinge::closed_form::{Conductor, Contact};
use impinge::method::sph::{DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Wall};
use impinge::model::{Cache, Model};
use impinge::port::WallCells;
use impinge::scene;
use impinge::variables::{Registry, Slot};

#[allow(dead_code, reason = "one of several files with set-ups of flows")]
#[path = "../tests/common/falling_drop.rs"]
mod falling_drop;

use falling_drop::{COLD, DIAMETER, HOT, falling_drop};

const TIME: f64 = 3.5e-6;
const DENSITY: f64 = 1000.0;
const DIFFUSIVITY: f64 = 1.5e-7;
const SOLID: Conductor = Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 };
const PLATE: &str = r#"
name = "Plate"
stop_time = 3.5e-6
step = 5e-8
[body.plate]
kind = "solid"
shape = { box = [1e-4, 1e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 293.15
mesh = { spacing = 5e-5, depth_spacing = 1e-7, growth = 1.2 }
[[load]]
name = "fluid"
on = "plate.top"
footprint = { tiles = { count = [1, 1], size = [1e-4, 1e-4] } }
carries = ["heat_flux"]
[[probe]]
name = "surface"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#;

/// The fluid's particles, periodic along the wall, and the area that they stand on [m²].
fn layer(fluid: Fluid, spacing: f64, shear: f64) -> (DropletSph, Vec<f64>, f64) {
    let thickness = (PI * DIFFUSIVITY * TIME).sqrt();
    let rows = (8.0 * thickness / spacing).ceil().max(4.0) as usize;
    let columns = 6;
    let period = columns as f64 * spacing;
    let tiles = WallCells::Tiles { count: [1, 1], size: [4.0 * period; 2] };
    let mut plan = DropletPlan {
        mirrors: [false; 2],
        extents: [Extent::Periodic(period), Extent::Periodic(period), Extent::Open],
        wall: Some(Wall {
            cells: tiles,
            contact_angle: 0.5 * PI,
            effusivity: Some(SOLID.effusivity()),
            conductance: None,
        }),
        ..falling_drop(DIAMETER / spacing, fluid)
    };
    // What is released tells the temperature before contact, and never comes.
    plan.releases[0].time = 1.0;
    let mut particles = ParticleFields::default();
    for n in 0..columns * columns * rows {
        let place = [n % columns, n / columns % columns, n / (columns * columns)];
        let at = place.map(|i| (i as f64 + 0.5) * spacing);
        particles.position.push(at);
        particles.velocity.push([shear * at[2] / TIME, 0.0, 0.0]);
        particles.mass.push(DENSITY * spacing.powi(3));
        particles.density.push(DENSITY);
        particles.temperature.push(HOT);
    }
    let drop = DropletSph::new(plan, 1);
    let state = drop.state_of(&particles);
    (drop, state, period * period)
}

fn main() {
    let given: Vec<f64> = env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let [fineness, ratio, prandtl, exchanges, shear] = given[..] else {
        println!("SPACING RATIO PRANDTL EXCHANGES SHEAR");
        return;
    };
    let conductivity = ratio * SOLID.effusivity() * DIFFUSIVITY.sqrt();
    let capacity = conductivity / DIFFUSIVITY;
    let fluid = Fluid {
        density: DENSITY,
        viscosity: (prandtl * DIFFUSIVITY * DENSITY).into(),
        specific_heat: capacity / DENSITY,
        conductivity,
        surface_tension: 0.0,
        sound_speed: 50.0,
        freezing: None,
    };
    let spacing = fineness * (PI * DIFFUSIVITY * TIME).sqrt();
    let (drop, mut particles, area) = layer(fluid, spacing, shear);
    let contact = Contact {
        first: Conductor { conductivity, heat_capacity: capacity },
        first_temperature: HOT,
        second: SOLID,
        second_temperature: COLD,
    };

    let text = scene::parse(PLATE, "plate").expect("a scene");
    let plate = Model::build(&text, 1).expect("a plate");
    let registry = Registry::of(&text);
    let slot = |name: &str| {
        let place = registry.find(name).expect("a variable");
        registry.variables[place].slot.clone()
    };
    let (Slot::Input(flux_input), Slot::Output(surface)) =
        (slot("fluid.heat_flux[1,1]"), slot("surface.temperature"))
    else {
        panic!("an input and an output")
    };
    let (mut state, mut cache) = (plate.initial_state(), Cache::default());
    let interval = TIME / exchanges;
    let (mut wall, mut heat, mut hottest) = (COLD, 0.0, COLD);
    for _ in 0..exchanges as usize {
        drop.advance(&mut particles, &[wall], interval).expect("an exchange");
        let given = drop.exchange(&particles).heat[0] / area;
        heat += given;
        state.inputs[flux_input] = given / interval;
        plate.step(&mut state, &mut cache, interval).expect("a step");
        wall = plate.output(&state, &mut cache, &surface).expect("a temperature");
        hottest = f64::max(hottest, wall);
    }
    let [coldest, warmest] = drop.totals(&particles).temperature_range;
    let rise = contact.temperature_of_contact() - COLD;
    println!(
        r#"{{"heat": {:?}, "rise": {:?}, "highest": {:?}, "beyond": {:?}}}"#,
        heat / contact.heat(TIME) - 1.0,
        (wall - COLD) / rise - 1.0,
        (hottest - COLD) / rise - 1.0,
        (COLD - coldest).max(warmest - HOT).max(hottest - HOT).max(0.0) / (HOT - COLD),
    );
}
