//! Droplets: balances, closed forms, and independence of how they are computed.

use std::f64::consts::PI;

use crate::falling_drop::{COLD, DIAMETER, HOT, RINGS, SPEED, WATER, falling_drop, run};
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Placement, Precision, Release,
    StepShares, Wall,
};
use impinge::port::WallCells;

/// A drop of some particles over its diameter that is about to hit a wall.
fn impact(across: f64) -> DropletPlan {
    falling_drop(across, WATER)
}

#[test]
fn what_the_droplet_loses_the_wall_gains() {
    for placement in [Placement::Lattice, Placement::BlueNoise] {
        let mirrors = [placement == Placement::Lattice; 2];
        let drop = DropletSph::new(DropletPlan { placement, mirrors, ..impact(14.0) }, 1);
        let mut state = drop.initial_state();
        let before = drop.totals(&state);
        let mass = 1000.0 * PI / 6.0 * DIAMETER.powi(3);
        assert!((before.mass / mass - 1.0).abs() < 1e-12);
        assert!((before.momentum[2] / (-mass * SPEED) - 1.0).abs() < 1e-12);
        let mut to_rings = 0.0;
        for _ in 0..6 {
            drop.advance(&mut state, &[COLD; RINGS], 0.25e-6).unwrap();
            let now = drop.totals(&state);
            assert!((now.mass / before.mass - 1.0).abs() < 1e-13);
            let momentum = now.momentum[2] + now.impulse_to_wall[2] - before.momentum[2];
            // Pair forces are equal and opposite to the last bit of single precision.
            assert!((momentum / before.momentum[2]).abs() < 1e-7, "{momentum:e}");
            assert!((now.heat + now.heat_to_wall).abs() < 1e-7 * now.heat_to_wall);
            let exchange = drop.exchange(&state);
            to_rings += exchange.heat.iter().sum::<f64>() + exchange.heat_outside;
            assert!((to_rings / now.heat_to_wall - 1.0).abs() < 1e-12);
        }
        let now = drop.totals(&state);
        assert!(now.heat_to_wall > 0.0 && now.impulse_to_wall[2] < 0.0);
        assert!(now.kinetic_energy < before.kinetic_energy);
        assert!(now.spread_diameter > 1.2 * DIAMETER && now.height < 0.8 * DIAMETER);
    }
}

#[test]
fn threads_change_no_bit() {
    let alone = run(&DropletSph::new(impact(24.0), 1), 3);
    for threads in [2, 5] {
        let together = run(&DropletSph::new(impact(24.0), threads), 3);
        assert!(alone.iter().zip(&together).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

#[test]
fn short_advances_keep_the_order_and_say_what_a_long_one_says() {
    let drop = DropletSph::new(impact(24.0), 1);
    let before = run(&drop, 2);
    let [mut short, mut long] = [before.clone(), before.clone()];
    let time = 5e-8;
    for _ in 0..25 {
        drop.advance(&mut short, &[COLD; RINGS], time / 25.0).unwrap();
    }
    drop.advance(&mut long, &[COLD; RINGS], time).unwrap();
    let [before, now] = [&before, &short].map(|state| drop.particles(state).position);
    for (x, y) in before.iter().zip(&now) {
        let way: f64 = (0..3).map(|a| (x[a] - y[a]).powi(2)).sum();
        assert!(way.sqrt() < 3.0 * SPEED * time, "another particle, or a very fast one");
    }
    let [short, long] = [&short, &long].map(|state| drop.totals(state));
    for (a, b) in [
        (short.kinetic_energy, long.kinetic_energy),
        (short.heat_to_wall, long.heat_to_wall),
        (short.impulse_to_wall[2], long.impulse_to_wall[2]),
        (short.max_pressure, long.max_pressure),
    ] {
        assert!((a / b - 1.0).abs() < 0.01, "{a} {b}");
    }
}

/// Position, velocity and density of all particles.
fn flow(drop: &DropletSph, state: &[f64]) -> Vec<u64> {
    let ParticleFields { position, velocity, density, .. } = drop.particles(state);
    let vectors = position.into_iter().chain(velocity).flatten();
    vectors.chain(density).map(f64::to_bits).collect()
}

#[test]
fn heat_that_is_left_out_changes_no_bit_of_the_flow() {
    for (corrected_diffusion, shifting) in [(true, true), (false, false)] {
        let plan = DropletPlan { corrected_diffusion, shifting, ..impact(16.0) };
        let warm = DropletSph::new(plan.clone(), 1);
        let fluid = Fluid { conductivity: 0.0, ..WATER };
        let without = DropletSph::new(DropletPlan { fluid, ..plan }, 1);
        let [warm_state, state] = [&warm, &without].map(|drop| run(drop, 4));
        assert_eq!(flow(&warm, &warm_state), flow(&without, &state));
        assert!(warm.totals(&warm_state).heat_to_wall > 0.0);
        assert_eq!(without.totals(&state).heat_to_wall, 0.0);
        assert_eq!(without.totals(&state).temperature_range, [HOT; 2]);
    }
}

#[test]
fn what_the_diffusion_does_not_need_may_be_left_out() {
    // Shifting needs moments; without either, sums are added up in another order.
    let plan = DropletPlan { corrected_diffusion: false, ..impact(16.0) };
    let full = DropletSph::new(plan.clone(), 1);
    let lean = DropletSph::new(DropletPlan { shifting: false, ..plan }, 1);
    let corrected = DropletSph::new(impact(16.0), 1);
    // Not long enough for particles to be shifted.
    let [full, lean, corrected] = [full, lean, corrected].map(|drop| {
        let mut state = drop.initial_state();
        drop.advance(&mut state, &[COLD; RINGS], 2.5e-8).unwrap();
        assert!(drop.totals(&state).steps > 1.0);
        drop.particles(&state).density
    });
    let apart = |other: &[f64]| {
        let pairs = full.iter().zip(other);
        pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!(apart(&lean) < 1e-7, "{:e}", apart(&lean));
    assert!(apart(&corrected) > 1e-5, "{:e}", apart(&corrected));
}

#[test]
fn a_saved_state_goes_on_as_if_nothing_had_happened() {
    let drop = DropletSph::new(impact(12.0), 1);
    let mut saved = run(&drop, 2);
    assert!(drop.check_state(&saved).is_ok() && drop.check_state(&saved[1..]).is_err());
    let other = DropletSph::new(impact(12.0), 1);
    other.advance(&mut saved, &[COLD; RINGS], 0.25e-6).unwrap();
    let straight = run(&drop, 3);
    assert!(saved.iter().zip(&straight).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn single_precision_of_pairs_does_no_harm() {
    let single = DropletSph::new(impact(14.0), 1);
    let double = DropletSph::new(DropletPlan { precision: Precision::Double, ..impact(14.0) }, 1);
    // Until the flow is chaotic, single particles agree.
    let [a, b] = [&single, &double].map(|drop| drop.particles(&run(drop, 1)));
    let moved = a.position.iter().map(|x| x[2]).fold(0.0, f64::max);
    let [a, b] = [a, b].map(|particles| {
        let mut heights: Vec<f64> = particles.position.iter().map(|x| x[2]).collect();
        heights.sort_by(f64::total_cmp);
        heights
    });
    let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-3 * moved, "{apart:e} of {moved:e}");
    let [a, b] = [&single, &double].map(|drop| drop.totals(&run(drop, 6)));
    assert!((a.kinetic_energy / b.kinetic_energy - 1.0).abs() < 0.01);
    assert!((a.heat_to_wall / b.heat_to_wall - 1.0).abs() < 0.05);
    assert!((a.impulse_to_wall[2] / b.impulse_to_wall[2] - 1.0).abs() < 0.01);
}

#[test]
fn a_quarter_stands_for_the_whole() {
    let quarter = DropletSph::new(impact(12.0), 1);
    let whole = DropletSph::new(DropletPlan { mirrors: [false; 2], ..impact(12.0) }, 1);
    let [a, b] = [&quarter, &whole].map(|drop| drop.totals(&run(drop, 1)));
    assert_eq!(4.0 * a.particles, b.particles);
    assert!((a.mass / b.mass - 1.0).abs() < 1e-12);
    assert!((a.kinetic_energy / b.kinetic_energy - 1.0).abs() < 2e-3);
    assert!((a.impulse_to_wall[2] / b.impulse_to_wall[2] - 1.0).abs() < 2e-3);
    assert!((a.heat_to_wall / b.heat_to_wall - 1.0).abs() < 2e-2);
}

#[test]
fn a_droplet_flies_freely_until_it_hits() {
    let mut plan = impact(12.0);
    plan.releases[0].centre[2] += 4e-5;
    plan.gravity = [0.0, 0.0, -9.81e5];
    let drop = DropletSph::new(plan, 1);
    let mut state = drop.initial_state();
    drop.advance(&mut state, &[COLD; RINGS], 0.5e-6).unwrap();
    let now = drop.totals(&state);
    let speed = SPEED + 9.81e5 * 0.5e-6;
    assert!((now.momentum[2] / (-now.mass * speed) - 1.0).abs() < 1e-9);
    assert_eq!(now.impulse_to_wall, [0.0; 3]);
    assert_eq!(now.heat_to_wall, 0.0);
}

#[test]
fn a_train_arrives_drop_by_drop() {
    let mut plan = impact(10.0);
    let first = plan.releases[0];
    plan.releases.push(Release { time: 1e-6, centre: [0.0, 0.0, 2.5e-4], ..first });
    let drop = DropletSph::new(plan, 1);
    let mut state = drop.initial_state();
    let one = drop.totals(&state).particles;
    drop.advance(&mut state, &[COLD; RINGS], 0.9e-6).unwrap();
    assert_eq!(drop.totals(&state).particles, one);
    drop.advance(&mut state, &[COLD; RINGS], 0.2e-6).unwrap();
    assert_eq!(drop.totals(&state).particles, 2.0 * one);
    assert_eq!(drop.check_state(&state), Ok(()));
}

#[test]
fn a_flow_faster_than_sound_is_refused_and_changes_nothing() {
    let mut plan = impact(10.0);
    plan.fluid.sound_speed = 10.0;
    let drop = DropletSph::new(plan, 1);
    let mut state = drop.initial_state();
    let mut refused = None;
    for _ in 0..40 {
        let before = state.clone();
        if let Err(failure) = drop.advance(&mut state, &[COLD; RINGS], 0.1e-6) {
            assert_eq!(state, before);
            refused = Some(failure.to_string());
            break;
        }
    }
    assert!(refused.expect("a refusal").contains("speed of sound"));
}

#[test]
fn fluid_below_absolute_zero_is_refused_and_changes_nothing() {
    let drop = DropletSph::new(impact(10.0), 1);
    let mut state = run(&drop, 2);
    let before = state.clone();
    let failure = drop.advance(&mut state, &[-1e6; RINGS], 0.5e-6).unwrap_err().to_string();
    assert!(failure.contains("would cool to -") && failure.contains("absolute zero"), "{failure}");
    assert_eq!(state, before);
    drop.advance(&mut state, &[COLD; RINGS], 0.5e-6).unwrap();
}

/// Heat that a resting block of water between insulated sides gives to a wall of constant temperature, over the closed
/// form `2 k ΔT √(t/(π a))` of a half space. It is the same all over the wall, so a block of twelve particles' width
/// does.
fn contact_heat(spacing: f64) -> f64 {
    let (width, height, time) = (12.0 * spacing, 2.4e-5, 40e-6);
    let mut plan = impact(DIAMETER / spacing);
    plan.fluid.sound_speed = 5.0;
    plan.fluid.viscosity = 1e-2.into();
    let cells = WallCells::Tiles { count: [1, 1], size: [1e-3, 1e-3] };
    plan.wall = Some(Wall { cells, contact_angle: 0.5 * PI, effusivity: None, conductance: None });
    plan.extents = [Extent::Closed(0.5 * width), Extent::Closed(0.5 * width), Extent::Open];
    let drop = DropletSph::new(plan, 1);
    let mut block = ParticleFields::default();
    let count = |length: f64| (length / spacing).round() as usize;
    let at = |i: usize| (i as f64 + 0.5) * spacing;
    for i in 0..count(0.5 * width) {
        for j in 0..count(0.5 * width) {
            for k in 0..count(height) {
                block.position.push([at(i), at(j), at(k)]);
                block.velocity.push([0.0; 3]);
                block.mass.push(1000.0 * spacing.powi(3));
                block.density.push(1000.0);
                block.temperature.push(HOT);
            }
        }
    }
    let mut state = drop.state_of(&block);
    drop.advance(&mut state, &[COLD], time).unwrap();
    let diffusivity = WATER.conductivity / (WATER.density * WATER.specific_heat);
    let heat = 2.0 * WATER.conductivity * (HOT - COLD) * (time / (PI * diffusivity)).sqrt();
    drop.totals(&state).heat_to_wall / (heat * width * width)
}

/// From particles as thick as the thermal layer, 4.3 µm, to a quarter of that.
#[test]
fn contact_heat_is_that_of_a_half_space_at_any_spacing() {
    let errors = [4e-6, 2e-6, 1e-6].map(|spacing| contact_heat(spacing) - 1.0);
    println!("relative errors of the contact heat: {errors:?}");
    assert!(errors.iter().all(|error| error.abs() < 0.01), "{errors:?}");
}

/// Waves of density grow where Euler's method diffuses them in steps beyond its limit, which those of sound are at δ =
/// 1.
#[test]
fn steps_are_short_enough_for_density_diffusion() {
    let plan = DropletPlan { density_diffusion: 1.0, ..impact(12.0) };
    let after = |shares: StepShares| {
        let drop = DropletSph::with_shares(plan.clone(), 1, shares);
        let mut state = drop.initial_state();
        let advanced = drop.advance(&mut state, &[COLD; RINGS], 1e-6);
        advanced.map(|()| drop.totals(&state).impulse_to_wall[2])
    };
    let unbounded = StepShares { diffusive: f64::INFINITY, ..StepShares::default() };
    assert!(after(unbounded).is_err());
    let usual = run(&DropletSph::new(impact(12.0), 1), 4);
    let usual = DropletSph::new(impact(12.0), 1).totals(&usual).impulse_to_wall[2];
    let found = after(StepShares::default()).unwrap();
    assert!((found / usual - 1.0).abs() < 0.1, "{found} {usual}");
}
