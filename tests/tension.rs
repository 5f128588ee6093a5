//! Surface tension of droplets: balances, and motions that it drives.

#[path = "common/capillary.rs"]
#[allow(dead_code)]
mod capillary;

use std::f64::consts::PI;

use capillary::{
    DENSITY, RADIUS, TENSION, elongation, found_half_width, half_width, on_wall, period, plan,
    stretched,
};
use impinge::body::sph::DropletPlan;

#[test]
fn a_stretched_drop_swings_at_rayleighs_period() {
    let (drop, mut state) = stretched(plan(3, 20.0, 1e-3), 1.1);
    let energy = |state: &[f64]| {
        let totals = drop.totals(state);
        totals.kinetic_energy + totals.compression_energy + totals.surface_energy
    };
    let start = energy(&state);
    let plane = 4.0 * PI * RADIUS * RADIUS * TENSION;
    assert!((start / plane - 1.1).abs() < 0.15, "{}", start / plane);
    let mut crossings = Vec::new();
    let mut before = elongation(&drop.particles(&state));
    for step in 1..=60 {
        drop.advance(&mut state, &[], period() / 50.0).unwrap();
        assert!(energy(&state) < 1.03 * start);
        let now = elongation(&drop.particles(&state));
        if now * before < 0.0 {
            crossings.push((f64::from(step) - now / (now - before)) / 50.0);
        }
        before = now;
    }
    assert!(crossings.len() >= 2, "{crossings:?}");
    let swing = 2.0 * (crossings[1] - crossings[0]);
    assert!((swing - 1.0).abs() < 0.15, "period over Rayleigh's: {swing}");
}

#[test]
fn surface_tension_gives_a_drop_no_momentum() {
    let whole = DropletPlan { mirrors: [false; 2], ..plan(3, 12.0, 1e-3) };
    let (drop, mut state) = stretched(whole, 1.2);
    drop.advance(&mut state, &[], 0.2 * period()).unwrap();
    let totals = drop.totals(&state);
    let speed = (TENSION / (DENSITY * RADIUS)).sqrt();
    for momentum in totals.momentum {
        assert!(momentum.abs() < 1e-7 * totals.mass * speed, "{momentum:e}");
    }
    assert!(totals.kinetic_energy > 0.0);
}

#[test]
fn a_drop_spreads_where_it_wets_and_draws_back_where_it_does_not() {
    let width = |angle: f64| {
        let (drop, mut state) = on_wall(24.0, angle);
        drop.advance(&mut state, &[300.0], 3.0 * period()).unwrap();
        found_half_width(&drop.particles(&state), drop.plan().spacing)
    };
    let [wets, right, beads] = [PI / 3.0, PI / 2.0, PI / 1.5].map(width);
    assert!((right - half_width(PI / 2.0)).abs() < 0.05, "{right}");
    assert!(wets > right + 0.05 && beads < right - 0.05, "{wets} {right} {beads}");
}
