//! The classical flows at coarse resolution; `tests/verification/flows.rs` refines them.

#[allow(dead_code)]
#[path = "common/classical_flows.rs"]
mod classical_flows;

use classical_flows::{Column, Poiseuille, TaylorGreen};

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
    assert!(starting.abs() < 0.02 && steady.abs() < 1e-3 && profile < 0.05);
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
    assert!(force.abs() < 5e-3 && pressure < 0.05 && motion < 1e-4);
    assert!((flow.totals().height - (1.0 - 0.5 / 16.0)).abs() < 0.01);
}
