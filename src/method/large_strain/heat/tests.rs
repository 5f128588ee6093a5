//! Steps of heat: closed forms with their orders, balances, and the deformed body.

use std::f64::consts::PI;

use super::*;
use crate::laws::solid::large_strain::LargeStrainLaw;
use crate::method::large_strain::Deformable;
use crate::runtime::allowance::{Allowance, Interrupt};
use crate::space::{
    Form, Kernel, Mesh, Reproducing, Side, Sides, Space, finite_elements, particles, reproducing,
};

const CAPACITY: f64 = 2.0;
const CONDUCTIVITY: f64 = 0.5;
const DIFFUSIVITY: f64 = CONDUCTIVITY / CAPACITY;

/// A slab of unit height in z, of two square elements along x.
fn mesh(count: usize) -> Mesh {
    Mesh::of_box(Form::Plane, [0.0; 3], [2.0 / count as f64, 0.0, 1.0], [2, 1, count])
}

fn kernels(kernel: Kernel) -> Reproducing {
    Reproducing { kernel, held: Sides::of(&[Side::Top, Side::Bottom]), ..Reproducing::default() }
}

fn spaces(count: usize) -> Vec<Space> {
    let mesh = mesh(count);
    vec![
        finite_elements(&mesh),
        reproducing(&mesh, kernels(Kernel::CubicSpline)).unwrap(),
        reproducing(&mesh, kernels(Kernel::QuarticSpline)).unwrap(),
        particles(&mesh, 2.2).unwrap(),
    ]
}

/// A body whose nodes at these heights are held, with its conduction.
fn body(space: Space, heights: &[f64]) -> (Deformable, Conduction) {
    let law = LargeStrainLaw::elastic(1.0, 1.0);
    let body = Deformable::new(space, law, 1.0, [false; 2], 1);
    let layer = HeatOfLayer { capacity: CAPACITY, conductivity: CONDUCTIVITY };
    let held = body.space.nodes.iter().map(|at| heights.contains(&at[2])).collect();
    let conduction = Conduction::new(&body, vec![layer], held).unwrap();
    (body, conduction)
}

fn drive(body: &Deformable, value: impl Fn([f64; 3]) -> f64) -> HeatDrive {
    let held = body.space.nodes.iter().map(|&at| [value(at); 2]).collect();
    HeatDrive { held, ..HeatDrive::default() }
}

fn advance(
    (body, conduction): &(Deformable, Conduction),
    u: &[[f64; 3]],
    temperature: &mut Vec<f64>,
    drive: &HeatDrive,
    duration: f64,
) -> Passed {
    let interrupt = Interrupt::default();
    let allowance = Allowance::of_updates(&interrupt, f64::INFINITY);
    conduction.advance((body, u), temperature, drive, duration, &allowance).unwrap()
}

fn stored(conduction: &Conduction, temperature: &[f64]) -> f64 {
    conduction.capacity.iter().zip(temperature).map(|(c, t)| c * t).sum()
}

/// Mean temperature of a slab that is insulated below and held at 1 above, from 0 on (H. S. Carslaw and J. C. Jaeger,
/// *Conduction of Heat in Solids*, Oxford 1959, §3.3).
fn mean_of_slab(fourier: f64) -> f64 {
    let term = |n: i32| {
        let k = (f64::from(n) + 0.5) * PI;
        2.0 / (k * k) * (-k * k * fourier).exp()
    };
    1.0 - (0..200).map(term).sum::<f64>()
}

#[test]
fn slabs_warm_as_the_series_says() {
    let fourier = 0.05;
    let error = |space: Space, steps: usize| {
        let own = body(space, &[1.0]);
        let still = vec![[0.0; 3]; own.0.nodes()];
        let drive = drive(&own.0, |_| 1.0);
        let mut temperature: Vec<f64> =
            own.1.held.iter().map(|&held| f64::from(u8::from(held))).collect();
        let mut entered = stored(&own.1, &temperature);
        for _ in 0..steps {
            let duration = fourier / DIFFUSIVITY / steps as f64;
            entered -= advance(&own, &still, &mut temperature, &drive, duration).through_held;
        }
        let found = stored(&own.1, &temperature);
        assert!((found - entered).abs() < 1e-12, "{found} {entered}");
        assert!(temperature.iter().all(|t| (-1e-2..=1.0 + 1e-9).contains(t)));
        found / own.1.capacity.iter().sum::<f64>() / mean_of_slab(fourier) - 1.0
    };
    for (n, name) in ["fem", "rkpm", "efg", "sph"].into_iter().enumerate() {
        let [coarse, fine] = [20, 40].map(|count| error(spaces(count).swap_remove(n), 10).abs());
        let order = if name == "sph" { 0.9 } else { 1.7 };
        assert!(fine < 4e-3 && (coarse / fine).log2() > order, "{name}: {coarse:.2e} {fine:.2e}");
    }
    // One step or many: parts are as short as they have to be.
    for steps in [1, 3, 100] {
        assert!(error(finite_elements(&mesh(40)), steps).abs() < 2e-3, "{steps}");
    }
}

#[test]
fn linear_fields_conduct_evenly_through_deformed_bodies() {
    // Half as high and twice as wide: four times the conductance.
    let gradient = |at: [f64; 3]| [at[0], 0.0, -0.5 * at[2]];
    for (n, space) in spaces(8).into_iter().enumerate() {
        let own = body(space, &[0.0, 1.0]);
        let u: Vec<[f64; 3]> = own.0.space.nodes.iter().map(|&at| gradient(at)).collect();
        let linear = |at: [f64; 3]| 3.0 * at[2] - 1.0;
        let mut temperature: Vec<f64> = own.0.space.nodes.iter().map(|&at| linear(at)).collect();
        let passed = advance(&own, &u, &mut temperature, &drive(&own.0, linear), 100.0);
        for (at, t) in own.0.space.nodes.iter().zip(own.0.at_nodes(&temperature)) {
            assert!((t - linear(*at)).abs() < 1e-11, "{n} {at:?} {t}");
        }
        assert!(passed.through_held.abs() < 1e-10);
        let flow = own.1.outflow(&own.1.conductances(&own.0, &u, &own.0.team()), &temperature);
        let top: f64 =
            (0..flow.len()).filter(|&n| own.0.space.nodes[n][2] == 1.0).map(|n| flow[n]).sum();
        let expected = CONDUCTIVITY * (2.0 * 0.25) * 3.0 / 0.5;
        assert!((top / expected - 1.0).abs() < 1e-12, "{n} {top} {expected}");
    }
}

#[test]
fn films_flows_and_held_nodes_balance() {
    for (n, space) in spaces(12).into_iter().enumerate() {
        let own = body(space, &[1.0]);
        let count = own.0.nodes();
        let u: Vec<[f64; 3]> = (0..count)
            .map(|n| [0.01 * (n as f64).sin(), 0.0, 0.01 * (2.0 * n as f64).cos()])
            .collect();
        let mut drive = drive(&own.0, |at| 1.0 + at[0]);
        drive.flows = (0..count).map(|n| [1e-3 * n as f64, 0.0]).collect();
        let film = |node| Film { node, conductance: 0.1, ambient: [3.0, -1.0] };
        drive.films = (0..3).map(film).collect();
        let mut temperature = vec![0.2; count];
        for duration in [1e-6, 1e-2, 1.0, 1e4] {
            let before = stored(&own.1, &temperature);
            let passed = advance(&own, &u, &mut temperature, &drive, duration);
            let out = passed.through_held + passed.through_films.iter().sum::<f64>();
            let missing = stored(&own.1, &temperature) - before - passed.brought_in + out;
            let scale = passed.brought_in.abs() + out.abs() + before.abs();
            assert!(missing.abs() < 1e-11 * scale, "{n} {duration} {missing:.1e} {scale:.1e}");
        }
    }
}

#[test]
fn exponential_cooling_of_a_small_body_by_a_film() {
    let own = body(finite_elements(&mesh(4)), &[]);
    let still = vec![[0.0; 3]; own.0.nodes()];
    let total: f64 = own.1.capacity.iter().sum();
    // Conductances in proportion to capacities keep the temperature uniform.
    let film = |node: usize| Film { node, conductance: own.1.capacity[node], ambient: [0.0; 2] };
    let films = (0..own.0.nodes()).map(film).collect();
    let drive = HeatDrive { held: vec![[0.0; 2]; own.0.nodes()], films, ..HeatDrive::default() };
    let mut temperature = vec![1.0; own.0.nodes()];
    advance(&own, &still, &mut temperature, &drive, 2.0);
    let expected = total * (-2.0_f64).exp();
    assert!((stored(&own.1, &temperature) / expected - 1.0).abs() < 2e-3);
}
