//! Momenta and energy are conserved, Newton's method converges quadratically, and steps are of second order.

use super::super::tests::bodies;
use super::*;
use crate::laws::solid::large_strain::{Deviator, LargeStrainLaw, MaxwellBranch, Relaxing};
use crate::math::matrix3::cross;
use crate::runtime::allowance::Interrupt;
use crate::space::{Form, Mesh, finite_elements};

/// Nodes of bodies whose steps are quick.
const SMALL: usize = 60;

/// A body that is free, with velocities that stretch and turn it.
fn thrown(body: Deformable) -> (ImplicitDynamics, Motion) {
    let held = vec![[false; 3]; body.nodes()];
    let dynamics = ImplicitDynamics::new(body, &held, LoadedFaces::default(), 0.0).unwrap();
    let mut motion = dynamics.start([0.0; 3]);
    let nodes = dynamics.body.space.nodes.iter();
    for (velocity, at) in motion.velocity.iter_mut().zip(nodes) {
        let turned = cross([0.4, 1.3, 0.5], *at);
        *velocity = match dynamics.body.space.form {
            Form::Axisymmetric => [0.5 * at[0] * at[2], 0.0, 0.3 * at[2]],
            _ => [0, 1, 2].map(|a| turned[a] + 0.5 * at[a] * at[2] + 0.1),
        };
    }
    dynamics.body.flatten(&mut motion.velocity);
    (dynamics, motion)
}

fn step(dynamics: &ImplicitDynamics, motion: &mut Motion, dt: f64) -> Stepped {
    let interrupt = Interrupt::default();
    let displacements = vec![[0.0; 3]; dynamics.body.nodes()];
    let drive = Drive { displacements, loads: Vec::new() };
    dynamics.step(motion, &drive, dt, &Allowance::of_step(&interrupt)).unwrap()
}

/// Momentum, angular momentum, kinetic and stored energy.
fn conserved(dynamics: &ImplicitDynamics, motion: &Motion) -> ([f64; 3], [f64; 3], [f64; 2]) {
    let body = &dynamics.body;
    let (mut momentum, mut turning, mut kinetic) = ([0.0; 3], [0.0; 3], 0.0);
    for node in 0..body.nodes() {
        let (v, u) = (motion.velocity[node], motion.displacement[node]);
        let at = [0, 1, 2].map(|a| body.space.nodes[node][a] + u[a]);
        let about = cross(at, v);
        for a in 0..3 {
            momentum[a] += body.mass[node] * v[a];
            turning[a] += body.mass[node] * about[a];
            kinetic += 0.5 * body.mass[node] * v[a] * v[a];
        }
    }
    let mut history = motion.history.clone();
    let over = body.in_all(Course::NONE);
    let stresses = body.respond(&motion.displacement, &over, &mut history, &body.team()).unwrap();
    (momentum, turning, [kinetic, stresses.energy])
}

fn elastic(body: Deformable) -> Deformable {
    Deformable::new(body.space, LargeStrainLaw::elastic(5.0, 2.0), 1.0, [false; 2], 1)
}

#[test]
fn momenta_and_energy_are_conserved_in_steps_of_any_length() {
    for body in bodies().into_iter().filter(|body| body.nodes() < SMALL) {
        let round = body.space.form == Form::Axisymmetric;
        // Quadratic elements of as many nodes are stiffer where they are curved.
        let pace = body.space.order as f64;
        let (dynamics, mut motion) = thrown(elastic(body));
        let (momentum, turning, [kinetic, _]) = conserved(&dynamics, &motion);
        let drift = [0.05 / pace, 0.2 / pace].map(|dt| {
            let mut motion = motion.clone();
            let mut drift: f64 = 0.0;
            for _ in 0..(1.0_f64 / dt) as usize {
                step(&dynamics, &mut motion, dt);
                let (now, turn, [moving, stored]) = conserved(&dynamics, &motion);
                for a in (0..3).filter(|_| !round) {
                    assert!((now[a] - momentum[a]).abs() < 1e-10);
                    assert!((turn[a] - turning[a]).abs() < 1e-9, "{turn:?} {turning:?}");
                }
                let work = motion.ledger.internal_work;
                assert!((moving + work - kinetic).abs() < 1e-10 * kinetic);
                drift = drift.max(((moving + stored) / kinetic - 1.0).abs());
            }
            drift
        });
        // Of the fourth order: the fifth power of each step.
        assert!(drift[1] < 2e-3 && drift[0] < drift[1] / 40.0, "{drift:?}");
        let residuals = step(&dynamics, &mut motion, 0.2).residuals;
        let r = &residuals[..residuals.len() - 1];
        let last = r.len() - 1;
        assert!(r[last] < 0.1 * r[last - 1].powf(1.5), "{residuals:?}");
    }
}

#[test]
fn steps_are_of_second_order() {
    let branches = vec![MaxwellBranch { fraction: 0.6, time: 0.4 }];
    let deviator = Deviator::Relaxing(Relaxing { branches });
    let law = LargeStrainLaw { bulk: 5.0, shear: 2.0, deviator };
    let mesh = Mesh::of_box(Form::Plane, [-1.0, 0.0, -0.5], [1.0, 0.0, 0.0], [4, 1, 2]);
    let body = Deformable::new(finite_elements(&mesh), law, 1.0, [false; 2], 1);
    let (dynamics, motion) = thrown(body);
    let places = [20, 80, 320].map(|count| {
        let mut motion = motion.clone();
        (0..count).for_each(|_| {
            step(&dynamics, &mut motion, 1.0 / f64::from(count));
        });
        motion.displacement
    });
    let error = |n: usize| {
        let pairs = places[n].iter().flatten().zip(places[2].iter().flatten());
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let order = 0.5 * (error(0) / error(1)).log2();
    assert!((1.8..2.2).contains(&order), "{order}");
}
