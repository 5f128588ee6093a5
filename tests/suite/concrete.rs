//! Blocks of concrete that hit the plane: damage, fragments, balances and states.

use crate::common::Trial;

const SCENE: &str = include_str!("../scenes/concrete.toml");

fn run(scene: &str, steps: usize) -> Trial {
    let mut trial = Trial::new(scene);
    (0..steps).for_each(|_| trial.step(2e-5));
    trial
}

#[test]
fn intact_blocks_are_one_fragment() {
    let mut trial = run(&SCENE.replace("-20.0", "-0.01"), 5);
    assert_eq!(trial.get("block.fragments"), 1.0);
    assert_eq!(trial.get("block.max_damage"), 0.0);
    let mass = trial.get("block.mass");
    assert!((mass / (2400.0 * 0.06 * 0.12) - 1.0).abs() < 1e-12);
    assert!((trial.get("block.largest_fragment_mass") / mass - 1.0).abs() < 1e-12);
    let momentum = trial.get("block.momentum_x").hypot(trial.get("block.momentum_z"));
    let speed = trial.get("block.largest_fragment_speed");
    assert!((speed - momentum / mass).abs() < 1e-12);
}

#[test]
fn blocks_break_and_balance() {
    let mut trial = run(SCENE, 10);
    let start = 0.5 * trial.get("block.mass") * 20.0 * 20.0;
    let [kinetic, stored, dissipated] =
        ["block.kinetic", "block.stored", "block.dissipated"].map(|name| trial.get(name));
    assert!(((kinetic + stored + dissipated) / start - 1.0).abs() < 0.01);
    assert!(dissipated > 0.05 * start);
    assert!(trial.get("block.max_damage") > 0.95);
    let mean = trial.get("block.mean_damage");
    assert!(mean > 0.01 && mean < 1.0, "{mean}");
    // What the plane receives, the block loses.
    let lost = trial.get("block.momentum_z") + 20.0 * trial.get("block.mass");
    assert!((lost + trial.get("block.impulse_z")).abs() < 1e-9 * lost);
    let broken = trial.get("block.broken_mass");
    let largest = trial.get("block.largest_fragment_mass");
    assert!(broken > 0.0 && broken + largest <= trial.get("block.mass") * (1.0 + 1e-12));
}

/// A block that mirrors itself is that of half of it, fragments included, but for kernels cut at the mirror; without a
/// second smoothing it is halved by default.
#[test]
fn mirrored_blocks_have_the_fragments_of_whole_ones() {
    let plain = SCENE.replace("rkpm = { smoothing = 25e-3 }", "");
    let plain = plain.replace("spacing = 10e-3", "spacing = 5e-3");
    let [mut half, mut whole] = ["auto", "none"].map(|symmetry| {
        run(&plain.replace("inertia", &format!("symmetry = \"{symmetry}\"\ninertia")), 2)
    });
    for name in ["max_damage", "mean_damage", "fragments", "largest_fragment_mass", "broken_mass"] {
        let [a, b] = [&mut half, &mut whole].map(|trial| trial.get(&format!("block.{name}")));
        assert!((a - b).abs() <= 1e-2 * b.abs(), "{name} {a} {b}");
    }
}

#[test]
fn saved_states_continue_bit_for_bit() {
    let mut first = run(SCENE, 4);
    let saved = first.state.clone();
    let outputs = |trial: &mut Trial| {
        ["kinetic", "mean_damage", "dissipated", "fragments", "width"]
            .map(|name| trial.get(&format!("block.{name}")).to_bits())
    };
    (0..3).for_each(|_| first.step(2e-5));
    let mut second = Trial::new(SCENE);
    second.restart(&saved);
    (0..3).for_each(|_| second.step(2e-5));
    assert_eq!(outputs(&mut first), outputs(&mut second));
}
