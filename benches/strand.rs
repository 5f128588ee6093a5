//! Time, iterations and sections of strands of particles.
//!
//! `cargo bench --bench strand [-- FLUID ACROSS LENGTH THREADS SPEED HEIGHT]`: a nozzle of 1 mm lays a straight strand
//! of LENGTH diameters and, with a SPEED below zero, goes round a corner of 90° in its middle. ACROSS particles lie
//! over the nozzle, which moves SPEED times as fast as its fluid comes, HEIGHT diameters above the plate. FLUID is one
//! of `thick` (10 Pa s), `thin` (1 Pa s), `paste`, `honey`, `chocolate`, `pdms`, `water`, `tin` and `warm`, a paste that
//! cools on glass.

use std::env;
use std::time::Instant;

#[path = "../tests/common/mod.rs"]
#[allow(dead_code)]
mod common;

use common::Trial;

const DIAMETER: f64 = 1e-3;
const OUTLET: f64 = 0.785_398e-6;

/// Glass below a strand that cools.
const PLATE: &str = r#"
[body.plate]
kind = "solid"
shape = { box = [LENGTH, 6e-3, 1e-3] }
material = { substance = "soda-lime-glass", at = 300.0 }
initial_temperature = 293.15
mesh = { spacing = 1e-3, order = 1 }
[[coupling]]
from = "ink"
to = "plate.top"
traction = false
"#;

/// Constants of a fluid but for those of heat, and the speed at which it comes [m/s].
fn fluid(name: &str) -> (&'static str, f64) {
    match name {
        "thick" => ("density = 1000.0, viscosity = 10.0", 0.02),
        "thin" => ("density = 1000.0, viscosity = 1.0", 0.02),
        "paste" => (
            "density = 1000.0, viscosity = { law = \"bingham\", yield_stress = 60.0, plastic_viscosity = 2.0 }",
            0.02,
        ),
        "honey" => (
            "density = 1400.0, viscosity = 8.0, surface_tension = 0.06, contact_angle = \"60°\"",
            0.02,
        ),
        "chocolate" => (
            "density = 1250.0, surface_tension = 0.04, viscosity = { law = \"herschel_bulkley\", yield_stress = 8.0, \
             consistency = 4.0, exponent = 0.8 }",
            0.03,
        ),
        "pdms" => (
            "density = 970.0, viscosity = 3.5, surface_tension = 0.021, contact_angle = \"20°\"",
            0.01,
        ),
        "water" => (
            "density = 1000.0, viscosity = 1e-3, surface_tension = 0.072, contact_angle = \"60°\"",
            0.1,
        ),
        "tin" => (
            "density = 6970.0, viscosity = 1.9e-3, surface_tension = 0.544, contact_angle = \"140°\"",
            0.1,
        ),
        "warm" => (
            "density = 1000.0, viscosity = { law = \"bingham\", yield_stress = 100.0, plastic_viscosity = 1.0 }",
            0.02,
        ),
        other => panic!("{other}: no fluid of this bench"),
    }
}

/// Length and volume of what is laid.
fn length_and_volume(trial: &mut Trial) -> [f64; 2] {
    let [length, width, height] =
        ["length", "width", "height"].map(|key| trial.get(&format!("ink.{key}")));
    [length, length * width * height]
}

fn main() {
    let given: Vec<String> = env::args().skip(1).filter(|word| word != "--bench").collect();
    let number = |n: usize, usual: f64| given.get(n).map_or(usual, |word| word.parse().unwrap());
    let name = given.first().map_or("thick", String::as_str);
    let (constants, comes) = fluid(name);
    let [across, length, threads] = [number(1, 5.0), number(2, 8.0), number(3, 1.0)];
    let [speed, height] = [number(4, 1.0), number(5, 1.0)];
    let moves = comes * speed.abs();
    let (half, time) = (0.5 * length * DIAMETER, length * DIAMETER / moves);
    let (times, x, y) = match speed < 0.0 {
        false => (format!("0.0, {time}"), format!("{}, {half}", -half), "0.0, 0.0".to_owned()),
        true => (
            format!("0.0, {}, {time}", 0.5 * time),
            format!("{}, 0.0, 0.0", -half),
            format!("0.0, 0.0, {half}"),
        ),
    };
    let flow = comes * OUTLET;
    let target = match speed < 0.0 {
        true => format!("[[-{half}, 0.0], [0.0, 0.0], [0.0, {half}]]"),
        false => format!("[[-{half}, 0.0], [{half}, 0.0]]"),
    };
    let step = 0.4 * DIAMETER / moves;
    let (conductivity, plate) = match name {
        "warm" => (0.5, PLATE.replace("LENGTH", &format!("{:e}", (length + 4.0) * DIAMETER))),
        _ => (0.0, String::new()),
    };
    let mut trial = Trial::on_threads(
        &format!(
            "name = \"Strand\"\nstop_time = {time}\nstep = {step}\n[body.ink]\n\
             kind = \"filament\"\nmethod = \"particles\"\n\
             fluid = {{ {constants}, specific_heat = 2000.0, conductivity = {conductivity} }}\n\
             nozzle = {{ diameter = 1e-3, height = {:e}, temperature = 340.0, flow = {flow:e} }}\n\
             path = {{ time = [{times}], x = [{x}], y = [{y}] }}\nmost = {:e}\nspacing = {:e}\n\
             [[target]]\nof = \"ink\"\nline = {target}\n{plate}",
            height * DIAMETER,
            1.05 * flow * time,
            DIAMETER / across
        ),
        threads as usize,
    );
    let begin = Instant::now();
    let steps = (time / step).round() as usize;
    let mut laid = [0.0; 2];
    // Without the last, at whose end all fluid counts as laid.
    for n in 0..steps - 1 {
        if let Err(refusal) = trial.try_step(step) {
            println!("{name}: {refusal}");
            return;
        }
        if n == steps / 2 {
            laid = length_and_volume(&mut trial);
        }
    }
    let spent = begin.elapsed().as_secs_f64();
    let now = length_and_volume(&mut trial);
    let section = (now[1] - laid[1]) / (now[0] - laid[0]) / OUTLET;
    let mut get = |key: &str| trial.get(&format!("ink.{key}"));
    let [particles, made, products] = ["particles", "steps", "pressure_iterations"].map(&mut get);
    let millimetres =
        ["width", "height", "last_width", "lag", "deviation", "largest_deviation", "gap"]
            .map(|key| format!("{key} {:.4}", 1e3 * get(key)));
    let densities = ["min_density", "max_density"].map(|key| get(key).round());
    println!(
        "{name} {across} {length} {speed} {height}: {spent:.1} s, {particles} particles, {made} steps \
         of {products:.1} products, {:.2} us; section {:+.2} %; {}; densities {densities:?}",
        1e6 * spent / (0.5 * particles * made),
        100.0 * (section * speed.abs() - 1.0),
        millimetres.join(", "),
    );
}
