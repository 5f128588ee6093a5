//! What droplets are said to cost is what they cost: time steps, and time to compute them.

use std::fs;

use impinge::model::{Cache, Model, Timeline, forecast};
use impinge::scene::{Scene, parse};
use impinge::variables::{Registry, Slot};

/// Processor time of this process [s]; nothing else of it runs meanwhile.
fn processor_time() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap();
    let numbers: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    let ticks = |place: usize| numbers[place].parse::<f64>().unwrap();
    (ticks(11) + ticks(12)) / 100.0
}

/// Name, viscosity, surface tension, speed, particles over the diameter, stop time, step, what lies below.
type Case = (&'static str, f64, f64, f64, f64, f64, f64, &'static str);

const WALL: &str = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\n\
                    footprint = { rings = { count = 20, radius = 2e-3 } }\nstart = { temperature = 300.0 }\n";
const PLATE: &str = "[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\n[body.plate]\nkind = \"solid\"\n\
                     shape = { box = [6e-3, 6e-3, 1e-3] }\nmaterial = { model = \"thermoelastic\", density = \
                     3950.0, specific_heat = 900.0, conductivity = 10.0 }\ninitial_temperature = 300.0\n";

const CASES: [Case; 6] = [
    ("ball in free space", 1e-3, 0.0, 2.0, 20.0, 4e-4, 4e-5, ""),
    ("ball with tension", 1e-3, 0.072, 2.0, 20.0, 4e-4, 4e-5, ""),
    ("drop on a wall", 1e-3, 0.072, 2.0, 20.0, 5e-4, 2e-5, WALL),
    ("viscous drop", 1.4, 0.063, 2.0, 16.0, 2e-4, 2e-5, WALL),
    ("short steps", 1.4, 0.063, 2.0, 16.0, 3e-4, 2e-6, WALL),
    ("drop on a plate", 1e-3, 0.072, 2.0, 16.0, 2e-4, 1e-5, PLATE),
];

fn scene((_, viscosity, tension, speed, across, stop, step, below): Case) -> Scene {
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
fn run(scene: &Scene) -> f64 {
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

/// Other work on the machine slows this down by up to a half, beside the factor of 1.5 that is promised of an
/// idle core.
const BUSY: f64 = 1.5;
const PROMISED: f64 = 1.5;

#[test]
fn droplets_take_the_steps_and_the_time_that_was_said() {
    for case in CASES {
        let scene = scene(case);
        let said = forecast(&scene);
        let start = processor_time();
        let steps = run(&scene);
        let time = processor_time() - start;
        let ratio = steps / said.droplets[0].steps;
        assert!((0.8..1.25).contains(&ratio), "{}: {ratio} of the steps said", case.0);
        let ratio = time / said.run_time();
        println!("{}: {time:.2} s, {ratio:.2} of the time said", case.0);
        let bounds = 1.0 / PROMISED..PROMISED * BUSY;
        assert!(bounds.contains(&ratio), "{}: {time} s, {ratio} of the time said", case.0);
    }
}
