//! Droplets of six kinds whose cost is foretold.

use impinge::model::{Cache, Model, Timeline};
use impinge::scene::{Scene, parse};
use impinge::variables::{Registry, Slot};

/// Name, viscosity, surface tension, speed, particles over the diameter, stop time, step, what lies below.
pub type Case = (&'static str, f64, f64, f64, f64, f64, f64, &'static str);

const WALL: &str = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\n\
                    footprint = { rings = { count = 20, radius = 2e-3 } }\nstart = { temperature = 300.0 }\n";
const PLATE: &str = "[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\n[body.plate]\nkind = \"solid\"\n\
                     shape = { box = [6e-3, 6e-3, 1e-3] }\nmaterial = { model = \"thermoelastic\", density = \
                     3950.0, specific_heat = 900.0, conductivity = 10.0 }\ninitial_temperature = 300.0\n";

pub const CASES: [Case; 6] = [
    ("ball in free space", 1e-3, 0.0, 2.0, 20.0, 4e-4, 4e-5, ""),
    ("ball with tension", 1e-3, 0.072, 2.0, 20.0, 4e-4, 4e-5, ""),
    ("drop on a wall", 1e-3, 0.072, 2.0, 20.0, 5e-4, 2e-5, WALL),
    ("viscous drop", 1.4, 0.063, 2.0, 16.0, 2e-4, 2e-5, WALL),
    ("short steps", 1.4, 0.063, 2.0, 16.0, 3e-4, 2e-6, WALL),
    ("drop on a plate", 1e-3, 0.072, 2.0, 16.0, 2e-4, 1e-5, PLATE),
];

pub fn scene((_, viscosity, tension, speed, across, stop, step, below): Case) -> Scene {
    let spacing = 1e-3 / across;
    let text = format!(
        "name = \"Drop\"\nstop_time = {stop:e}\nstep = {step:e}\nsolver = {{ threads = 1 }}\n[body.drop]\n\
         kind = \"droplet\"\ndiameter = 1e-3\nimpact_velocity = {speed:?}\ninitial_temperature = 350.0\n\
         spacing = {spacing:e}\nfluid = {{ density = 1000.0, viscosity = {viscosity:?}, specific_heat = 4180.0, \
         conductivity = 0.6, surface_tension = {tension:?} }}\n{below}"
    );
    parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// Time steps that the droplet took.
pub fn steps_of(scene: &Scene) -> f64 {
    let model = Model::build(scene, 1).unwrap();
    let (mut state, mut cache) = (model.initial_state(), Cache::default());
    let registry = Registry::of(scene);
    let mut steps = 0.0;
    let timeline = Timeline::new(scene.step, scene.stop_time);
    for n in 0..timeline.count {
        model.step(&mut state, &mut cache, timeline.length(n)).unwrap();
        let mut reader = model.reader(&state, &mut cache).unwrap();
        for variable in &registry.variables {
            let Slot::Output(output) = &variable.slot else { continue };
            let value = reader.value(output).unwrap();
            if variable.name == "drop.steps" {
                steps = value;
            }
        }
    }
    steps
}
