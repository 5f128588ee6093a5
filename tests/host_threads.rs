//! A unit that may use one thread starts none: masters unload its library, and many units share a
//! machine. The count is that of the whole process, so this test has one to itself.

#![cfg(target_os = "linux")]

use impinge::model::{Cache, Model};
use impinge::scene;

const SCENES: [&str; 2] = [include_str!("fmi/fuzz/scene.toml"), include_str!("fmi/scene.toml")];

fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").unwrap().count()
}

#[test]
fn a_model_of_one_thread_starts_none() {
    let before = threads();
    for text in SCENES {
        let scene = scene::parse(text, "scene.toml").unwrap();
        let model = Model::build(&scene, 1).unwrap();
        let mut state = model.initial_state();
        model.step(&mut state, &mut Cache::default(), 1e-8).unwrap();
        assert_eq!(threads(), before, "{}", scene.name);
    }
}
