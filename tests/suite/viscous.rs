//! Implicit viscosity: its rates, its conservation, and fluids that yield, against closed forms.

use std::f64::consts::PI;

use impinge::closed_form::ShearWave;
use impinge::kernel::Kernel;
use impinge::laws::{Table, Viscosity};
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Placement, Precision, Viscous,
};

use crate::classical_flows::{Flow, Setup, lattice, tilted_lattice};
use crate::thick_flows::Channel;

const IMPLICIT: Viscous = Viscous::Implicit { rate: 1.0 };

/// A fluid of density 1000 kg/m³ in a periodic square of 1 m.
fn periodic(spacing: f64, viscosity: impl Into<Viscosity>) -> Setup {
    Setup {
        spacing,
        support: 3.0,
        density: 1000.0,
        viscosity: viscosity.into(),
        sound_speed: 10.0,
        shifting: false,
        viscous: IMPLICIT,
        gravity: [0.0; 3],
        extents: [Extent::Periodic(1.0), Extent::Open, Extent::Periodic(1.0)],
        cells: None,
    }
}

fn wave_of(viscosity: f64) -> ShearWave {
    ShearWave { speed: 1e-3, wavelength: 1.0, viscosity: viscosity / 1000.0 }
}

/// Viscosity that the decay of a shear wave of length 1 m shows, over the actual one.
fn decay(spacing: f64, points: &[[f64; 2]], viscosity: f64, duration: f64) -> f64 {
    decay_rate(periodic(spacing, viscosity), points, duration) / wave_of(viscosity).rate()
}

/// Decay rate of a shear wave of length 1 m [1/s].
fn decay_rate(setup: Setup, points: &[[f64; 2]], duration: f64) -> f64 {
    let size = 1e-3;
    let wave = move |z: f64| (2.0 * PI * z).sin();
    let mut flow = Flow::start(setup, points, |[_, z]| [size * wave(z), 0.0], |_| 0.0);
    flow.advance(duration);
    let p = flow.particles();
    let waves = || p.position.iter().map(|x| wave(x[2]));
    let sum: f64 = waves().zip(&p.velocity).map(|(wave, v)| wave * v[0]).sum();
    let kept = sum / waves().map(|wave| wave * wave).sum::<f64>() / size;
    let steps = flow.totals().steps;
    // The rate of implicit Euler steps that keep as much.
    (kept.powf(-1.0 / steps) - 1.0) * steps / duration
}

#[test]
fn shear_waves_decay_alike_along_and_across_a_lattice() {
    let square = |m: usize| decay(1.0 / m as f64, &lattice(m, m, 1.0 / m as f64), 1e4, 5e-3);
    let tilted = |m: usize| {
        let (spacing, points) = tilted_lattice(m);
        decay(spacing, &points, 1e4, 5e-3)
    };
    // Explicit sums depend on the direction.
    let explicit = |(spacing, points): (f64, Vec<[f64; 2]>)| {
        let setup = Setup { viscous: Viscous::Explicit, ..periodic(spacing, 10.0) };
        decay_rate(setup, &points, 0.3) / wave_of(10.0).rate() - 1.0
    };
    let [along, across] = [(0.05, lattice(20, 20, 0.05)), tilted_lattice(9)].map(explicit);
    println!("explicit: {along:.1e} along the lattice, {across:.1e} across a tilted one");
    assert!(along < -0.01 && across > 0.01, "{along} {across}");
    let [coarse, fine] = [square(10), square(20)].map(|ratio| ratio - 1.0);
    let turned = tilted(9) - 1.0;
    println!("errors: {coarse:.1e}, {fine:.1e}, tilted {turned:.1e}");
    assert!(coarse.abs() < 3e-3 && fine.abs() < 1e-3 && turned.abs() < 4e-3, "{fine} {turned}");
}

#[test]
fn steps_longer_than_the_decay_follow_implicit_euler() {
    // A thousand decay times.
    let duration = 1e3 / wave_of(1e6).rate();
    let ratio = decay(0.05, &lattice(20, 20, 0.05), 1e6, duration);
    assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
}

#[test]
fn viscosity_follows_the_temperature_of_particles() {
    let points = lattice(10, 10, 0.1);
    let constant = decay_rate(periodic(0.1, 1e4), &points, 5e-3);
    // All particles are at 300 K, between the entries.
    let table = Table { temperature: vec![200.0, 400.0], value: vec![1e3, 1e5] };
    let of_table = decay_rate(periodic(0.1, Viscosity::Table(table)), &points, 5e-3);
    assert!((of_table / constant - 1.0).abs() < 1e-6, "{of_table} {constant}");
}

/// A ball of fluid as thick as honey, or a thousand times thicker, in free space.
fn ball(viscosity: f64, viscous: Viscous) -> (DropletSph, ParticleFields) {
    let spacing = 1e-3;
    let fluid = Fluid {
        density: 1000.0,
        viscosity: viscosity.into(),
        specific_heat: 1000.0,
        conductivity: 0.0,
        surface_tension: 0.0,
        sound_speed: 10.0,
        freezing: None,
    };
    let plan = DropletPlan {
        dimension: 3,
        axisymmetric: false,
        spacing,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid,
        placement: Placement::Lattice,
        precision: Precision::Double,
        viscous,
        density_diffusion: 0.1,
        corrected_diffusion: true,
        shifting: false,
        gravity: [0.0; 3],
        mirrors: [false; 2],
        extents: [Extent::Open; 3],
        releases: Vec::new(),
        demand: None,
        feed: None,
        wall: None,
    };
    let axis = || -4..=4;
    let places = axis().flat_map(|i| axis().flat_map(move |j| axis().map(move |k| [i, j, k])));
    let mut particles = ParticleFields::default();
    for place in places.filter(|place| place.iter().map(|i| i * i).sum::<i32>() <= 16) {
        let [x, y, z] = place.map(|i| f64::from(i) * spacing);
        particles.position.push([x, y, z]);
        particles.velocity.push([-10.0 * y, 10.0 * x, 0.0]);
        particles.mass.push(1000.0 * spacing.powi(3));
        particles.density.push(1000.0);
        particles.temperature.push(300.0);
    }
    (DropletSph::new(plan, 1), particles)
}

/// Angular momentum about z [kg m²/s].
fn spin(particles: &ParticleFields) -> f64 {
    let of = |i: usize| {
        let ([x, y, _], [u, v, _]) = (particles.position[i], particles.velocity[i]);
        particles.mass[i] * (x * v - y * u)
    };
    (0..particles.mass.len()).map(of).sum()
}

#[test]
fn thick_fluid_spins_as_a_rigid_body() {
    for viscous in [IMPLICIT, Viscous::WithPressure { rate: 1.0 }] {
        spins_as_a_rigid_body(viscous);
    }
}

fn spins_as_a_rigid_body(viscous: Viscous) {
    let (drop, particles) = ball(1e3, viscous);
    let mut state = drop.state_of(&particles);
    let energy = drop.totals(&state).kinetic_energy;
    // An eighth of a turn, through many viscous times.
    drop.advance(&mut state, &[], 0.08).unwrap();
    let after = drop.particles(&state);
    let totals = drop.totals(&state);
    assert!((spin(&after) / spin(&particles) - 1.0).abs() < 1e-10);
    let kept = totals.kinetic_energy / energy - 1.0;
    println!("{} steps, energy {kept:.1e}", totals.steps);
    // Of first order in the angle of a step.
    assert!(kept.abs() < 0.02, "{kept}");
}

#[test]
fn paste_below_its_yield_stress_rests_in_a_channel() {
    // The wall bears GH/2 = 0.45 Pa.
    let mut flow = Channel::PASTE.start(11, 1.8, |_| 0.0);
    flow.advance(0.5);
    let totals = flow.totals();
    assert_eq!(totals.yielded_mass, 0.0);
    // The weight is carried: within a second it would fall at 1.8 m/s.
    println!("speed {:.1e} m/s, creep {:.1e} 1/s", totals.max_speed, totals.creep);
    assert!(totals.max_speed < 1e-3, "{}", totals.max_speed);
}

#[test]
fn paste_flows_around_a_plug() {
    assert!((Channel::PASTE.exact().velocity(0.25) - 1.066667).abs() < 1e-6);
    let [coarse, fine] = [11, 21].map(|rows| Channel::PASTE.error(rows));
    let bingham = Channel::BINGHAM.error(21);
    println!("errors {coarse:.1e}, {fine:.1e}; {bingham:.1e} of Bingham's fluid");
    assert!(bingham < 5e-3, "{bingham}");
    assert!(fine < 0.01 && (coarse / fine).log2() > 1.2, "{coarse} {fine}");
}
