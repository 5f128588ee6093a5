//! Particle updates a second of the droplet method: all rates of a time step, neighbour search included.
//!
//! `cargo bench --bench droplet [-- SIDE THREADS STEPS RUNS CALLS]`: a cube of SIDE³ particles,
//! lightly stirred, advanced by STEPS time steps in so many calls.

use std::time::Instant;

use impinge::kernel::Kernel;
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Placement, Precision, Release, Viscous,
};

const SPACING: f64 = 1e-5;
const SOUND: f64 = 100.0;

/// `lean` leaves out heat, shifting and what corrects the density diffusion.
fn plan(lean: bool, surface_tension: f64) -> DropletPlan {
    let fluid = Fluid {
        density: 1000.0,
        viscosity: 1e-3.into(),
        specific_heat: 4000.0,
        conductivity: if lean { 0.0 } else { 0.6 },
        surface_tension,
        sound_speed: SOUND,
        freezing: None,
    };
    let release = Release {
        time: 0.0,
        centre: [0.0; 3],
        diameter: 10.0 * SPACING,
        velocity: [0.0; 3],
        temperature: 300.0,
    };
    DropletPlan {
        dimension: 3,
        axisymmetric: false,
        spacing: SPACING,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid,
        placement: Placement::Lattice,
        precision: Precision::Single,
        viscous: Viscous::Explicit,
        density_diffusion: 0.1,
        corrected_diffusion: !lean,
        shifting: !lean,
        gravity: [0.0; 3],
        mirrors: [false; 2],
        extents: [Extent::Open; 3],
        demand: None,
        feed: None,
        releases: vec![release],
        wall: None,
    }
}

/// A cube whose particles are displaced a little at random and move with a swirl.
fn cube(side: usize) -> ParticleFields {
    let mut cube = ParticleFields::default();
    let noise = |n: usize| 0.1 * SPACING * ((n as f64 * 0.754_877_666).fract() - 0.5);
    for n in 0..side.pow(3) {
        let place = [n % side, n / side % side, n / side / side];
        let [x, y, z] = [0, 1, 2].map(|a| place[a] as f64 * SPACING + noise(3 * n + a));
        let half = 0.5 * side as f64 * SPACING;
        cube.position.push([x, y, z]);
        cube.velocity.push([-(y - half), x - half, 0.0].map(|v| 0.02 * SOUND * v / half));
        cube.mass.push(1000.0 * SPACING.powi(3));
        cube.density.push(1000.0);
        cube.temperature.push(300.0 + (z / SPACING).sin());
    }
    cube
}

/// Updates a second; the count of steps is the program's own.
fn rate(drop: &DropletSph, cube: &ParticleFields, steps: f64, calls: usize) -> f64 {
    let mut state = drop.state_of(cube);
    // Shorter than that of fluid at rest, for the speed that this one has.
    let step = 0.9 * DropletSph::forecast(drop.plan()).1;
    let begin = Instant::now();
    for _ in 0..calls {
        drop.advance(&mut state, &[], steps * step / calls as f64).expect("the flow is slow");
    }
    let seconds = begin.elapsed().as_secs_f64();
    let totals = drop.totals(&state);
    totals.steps * totals.particles / seconds
}

fn main() {
    let numbers: Vec<usize> = std::env::args().filter_map(|word| word.parse().ok()).collect();
    let number = |n: usize, default: usize| numbers.get(n).copied().unwrap_or(default);
    let (side, threads, steps) = (number(0, 47), number(1, 1), number(2, 20) as f64);
    let (runs, calls) = (number(3, 5), number(4, 1));
    let cube = cube(side);
    println!(
        "{} particles, {threads} threads, {calls} calls, medians of {runs} runs",
        cube.mass.len()
    );
    for (what, lean, tension) in [
        ("momentum, continuity, plain density diffusion", true, 0.0),
        ("and heat, corrected diffusion, shifting", false, 0.0),
        ("and surface tension", false, 0.07),
    ] {
        let drop = DropletSph::new(plan(lean, tension), threads);
        let mut rates: Vec<f64> = (0..runs).map(|_| rate(&drop, &cube, steps, calls)).collect();
        rates.sort_by(f64::total_cmp);
        println!("{what}: {:.3} million updates a second", 1e-6 * rates[runs / 2]);
    }
}
