//! A unit that may use one thread leaves none, and those that factorisations and droplets use end with
//! them: masters unload its library, and many units share a machine. The count is that of the whole process, so this
//! test has one to itself.

#![cfg(target_os = "linux")]

use std::time::{Duration, Instant};

use impinge::model::{Cache, Model};
use impinge::scene;

const SCENES: [&str; 2] = [include_str!("fmi/fuzz/scene.toml"), include_str!("fmi/scene.toml")];

/// Enough particles for some threads.
const DROP: &str = r#"
name = "Drop"
stop_time = 1e-6
step = 1e-8
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 4e-6
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
"#;

fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").unwrap().count()
}

fn step(text: &str, threads: usize) {
    let scene = scene::parse(text, "scene.toml").unwrap();
    let model = Model::build(&scene, threads).unwrap();
    let mut state = model.initial_state();
    let mut cache = Cache::default();
    model.step(&mut state, &mut cache, 1e-8).unwrap();
    for (name, _) in scene.solids() {
        model.nodal_fields(&state, &mut cache, name).unwrap();
    }
}

#[test]
fn no_thread_is_left() {
    let before = threads();
    for text in SCENES {
        step(text, 1);
        expect(before);
        step(text, 3);
        expect(before);
    }
    step(DROP, 3);
    expect(before);
}

/// The system counts a thread for a moment after it has ended.
fn expect(count: usize) {
    let begin = Instant::now();
    while threads() > count && begin.elapsed() < Duration::from_secs(10) {
        std::thread::yield_now();
    }
    assert_eq!(threads(), count);
}
