//! The classical flows at coarse resolution; `tests/verification/flows.rs` refines them.

use crate::classical_flows::{Column, Flow, Poiseuille, Setup, TaylorGreen, tilted_lattice};
use impinge::method::sph::{Extent, Viscous};

#[test]
fn flow_between_plates_becomes_a_parabola_and_drags_at_them() {
    let mut flow = Poiseuille::start(10, 4.0);
    flow.advance(0.1 * Poiseuille::TIME);
    flow.advance(0.1 * Poiseuille::TIME);
    let mean = |shear: Vec<f64>| shear.iter().sum::<f64>() / shear.len() as f64;
    let exact = Poiseuille::mean_shear(0.1 * Poiseuille::TIME, 0.2 * Poiseuille::TIME);
    let starting = mean(Poiseuille::shear(&flow)) / exact - 1.0;
    flow.advance(0.8 * Poiseuille::TIME);
    flow.advance(0.1 * Poiseuille::TIME);
    let steady = mean(Poiseuille::shear(&flow)) / (0.5 * Poiseuille::GRADIENT) - 1.0;
    let profile = Poiseuille::error(&flow, 1.1 * Poiseuille::TIME);
    println!("relative errors: shear {starting:.1e}, {steady:.1e}, profile {profile:.1e}");
    let errors = [starting, steady, profile];
    assert!(starting.abs() < 0.02 && steady.abs() < 2e-3 && profile < 0.05, "{errors:?}");
}

#[test]
fn what_drives_the_fluid_arrives_at_the_plates() {
    let mut flow = Poiseuille::start(10, 3.0);
    let before = flow.totals();
    flow.advance(0.5 * Poiseuille::TIME);
    let now = flow.totals();
    let driven = now.impulse_of_gravity[0];
    // Both plates get the same, of which one is counted.
    let arrived = now.momentum[0] + 2.0 * now.impulse_to_wall[0];
    assert!((arrived / driven - 1.0).abs() < 1e-3, "{arrived} of {driven}");
    assert!((now.mass / before.mass - 1.0).abs() < 1e-13);
}

#[test]
fn vortices_decay_at_the_rate_of_their_viscosity() {
    let mut flow = TaylorGreen::start(10, 4.0);
    let before = flow.totals();
    flow.advance(1.0);
    let now = flow.totals();
    let rate = (before.kinetic_energy / now.kinetic_energy).ln();
    let error = rate / TaylorGreen::DECAY - 1.0;
    println!(
        "relative error of the rate {error:.1e}, of velocities {:.1e}",
        TaylorGreen::error(&flow, 1.0)
    );
    assert!(error.abs() < 0.04, "{error}");
    assert!(TaylorGreen::error(&flow, 1.0) < 0.05);
    // Nothing is there to take momentum.
    assert!(now.momentum.iter().all(|p| p.abs() < 1e-6 * now.mass));
}

#[test]
fn a_column_at_rest_stays_so_and_its_wall_carries_it() {
    let mut flow = Column::start(16);
    flow.advance(4.0 * Column::time());
    flow.advance(4.0 * Column::time());
    let force = Column::force(&flow) - 1.0;
    let pressure = flow.norm(|p, i| [p.pressure[i]], |at| [Column::pressure(at)]);
    let motion = Column::motion(&flow);
    println!("relative errors: weight {force:.1e}, pressure {pressure:.1e}; motion {motion:.1e}");
    assert!(force.abs() < 5e-3 && pressure < 0.01 && motion < 1e-4);
    assert!((flow.totals().height - (1.0 - 0.5 / 16.0)).abs() < 0.01);
}

#[test]
fn pressure_that_is_solved_holds_a_column_at_rest_in_few_steps() {
    let mut flow = Column::start_with(16, 1e-3, Viscous::WithPressure { rate: 1.0 });
    flow.advance(4.0 * Column::time());
    flow.advance(4.0 * Column::time());
    let pressure = flow.norm(|p, i| [p.pressure[i]], |at| [Column::pressure(at)]);
    let (force, motion) = (Column::force(&flow) - 1.0, Column::motion(&flow));
    let totals = flow.totals();
    let iterations = totals.iterations / totals.steps;
    println!(
        "relative errors: weight {force:.1e}, pressure {pressure:.1e}; motion {motion:.1e}; {} steps of {iterations:.1} \
         iterations",
        totals.steps
    );
    assert!(force.abs() < 5e-3 && pressure < 0.01 && motion < 1e-4);
    // Sound would take twenty times as many.
    assert!(totals.steps < 200.0 && iterations < 15.0);
}

/// Through a period and back in at its other side, again and again.
#[test]
fn a_uniform_motion_goes_on_through_periods() {
    let (spacing, points) = tilted_lattice(5);
    let setup = Setup {
        spacing,
        support: 3.0,
        density: 1000.0,
        viscosity: 1.0.into(),
        sound_speed: 10.0,
        shifting: true,
        viscous: Viscous::Explicit,
        gravity: [0.0; 3],
        extents: [Extent::Periodic(1.0), Extent::Open, Extent::Periodic(1.0)],
        cells: None,
    };
    let velocity = [1.0, -0.4];
    let mut flow = Flow::start(setup, &points, |_| velocity, |_| 0.0);
    flow.advance(3.25);
    let error = flow.norm(|p, i| [p.velocity[i][0], p.velocity[i][2]], |_| velocity);
    assert!(error < 1e-5, "{error}");
    let totals = flow.totals();
    assert!(totals.density_range.iter().all(|ratio| (ratio - 1.0).abs() < 1e-5));
    // The lattice has come to stand a quarter and seven tenths of a period further.
    let particles = flow.particles();
    for [x, z] in points {
        let moved = [(x + 0.25).rem_euclid(1.0), (z + 0.7).rem_euclid(1.0)];
        let nearest = particles.position.iter().map(|p| {
            let apart = [p[0] - moved[0], p[2] - moved[1]].map(|d| d - d.round());
            apart[0].hypot(apart[1])
        });
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-4);
    }
}
