//! Sines as coefficients and as solutions in one coordinate. Nodes of a strip with equal coefficients across it have
//! the functions of one coordinate, because kernels are products.
//!
//! The cases are those of Chen (2019), Meshfree viscoelastic modeling, M.Sc. thesis, Pennsylvania State University,
//! ch. 3; the expected numbers are an independent program's.

use std::f64::consts::PI;

use impinge::space::{Form, Integration, Mesh, Reproducing, Space, Value, reproducing};

use super::linear::{System, scalar_error};

fn strip(low: f64, high: f64, nodes: usize, support: f64, points: usize) -> Space {
    let mesh = Mesh::of_box(Form::Plane, [low, 0.0, 0.0], [high, 0.0, 1.0], [nodes - 1, 0, 1]);
    let integration = Integration::Gauss(points);
    reproducing(&mesh, Reproducing { support, integration, ..Reproducing::default() }).unwrap()
}

fn agree(found: f64, expected: f64) -> bool {
    (found / expected - 1.0).abs() < 6e-3
}

#[test]
fn sine_as_coefficients() {
    for (support, coarse, fine) in [
        (1.5, 6.41e-2, 1.017e-3),
        (2.0, 1.13e-1, 1.821e-3),
        (2.5, 1.73e-1, 2.840e-3),
        (3.0, 2.42e-1, 4.100e-3),
    ] {
        for (nodes, expected) in [(11, coarse), (81, fine)] {
            let space = strip(-PI, PI, nodes, support, 2);
            let d: Vec<f64> = space.nodes.iter().map(|x| x[0].sin()).collect();
            let error = scalar_error(&space.volume, &d, |x| x[0].sin());
            assert!(agree(error, expected), "{support} {nodes} {error:e} {expected:e}");
        }
    }
}

#[test]
fn product_of_sines_as_coefficients() {
    for (nodes, expected) in [(11, 8.00e-1), (21, 2.244e-1), (41, 5.768e-2)] {
        let cells = [nodes - 1, 0, nodes - 1];
        let mesh = Mesh::of_box(Form::Plane, [-PI, 0.0, -PI], [PI, 0.0, PI], cells);
        let integration = Integration::Gauss(2);
        let settings = Reproducing { support: 3.0, integration, ..Reproducing::default() };
        let space = reproducing(&mesh, settings).unwrap();
        let product = |x: [f64; 3]| x[0].sin() * x[2].sin();
        let d: Vec<f64> = mesh.nodes.iter().map(|&x| product(x)).collect();
        let error = scalar_error(&space.volume, &d, product);
        assert!(agree(error, expected), "{nodes} {error:e}");
    }
}

/// Values and slopes along x of the functions of columns of nodes.
fn columns(row: &[Value], nodes: usize) -> Vec<(usize, f64, f64)> {
    let mut sums = vec![(0.0, 0.0); nodes];
    for value in row {
        let sum = &mut sums[value.node as usize % nodes];
        sum.0 += value.value;
        sum.1 += value.gradient[0];
    }
    let column = |n: usize| (n, sums[n].0, sums[n].1);
    (0..nodes).map(column).filter(|column| column.1 != 0.0).collect()
}

/// u″ + k²u = 0 with u = sin k(1 − x)/sin k, whose ends fix nodal values.
#[test]
fn helmholtz() {
    let cases =
        [(2.0, [2.38e-4, 6.43e-5, 1.37e-5, 3.26e-6]), (10.0, [6.82e-1, 5.42e-3, 7.05e-4, 1.32e-4])];
    for (k, expected) in cases {
        for (nodes, expected) in [6, 11, 21, 41].into_iter().zip(expected) {
            let space = strip(0.0, 1.0, nodes, 3.0, 5);
            let mut system = System::of(nodes);
            for p in 0..space.volume.len() {
                let row = columns(space.volume.row(p), nodes);
                let values: Vec<(usize, [f64; 1])> = row.iter().map(|c| (c.0, [c.1])).collect();
                let slopes: Vec<(usize, [f64; 1])> = row.iter().map(|c| (c.0, [c.2])).collect();
                system.add(space.volume.weights[p], &slopes, &slopes);
                system.add(-k * k * space.volume.weights[p], &values, &values);
            }
            let exact = |x: f64| (k * (1.0 - x)).sin() / k.sin();
            let at_nodes = space.at_nodes.as_ref().unwrap();
            let row = |node: usize| {
                columns(at_nodes.row(node), nodes).iter().map(|c| (c.0, c.1)).collect()
            };
            let rows: Vec<Vec<(usize, f64)>> = (0..nodes).map(row).collect();
            let d = system.solve_transformed(&rows, |i| match i {
                0 => Some(1.0),
                _ => (i == nodes - 1).then_some(0.0),
            });
            let d: Vec<f64> = (0..2 * nodes).map(|node| d[node % nodes]).collect();
            let error = scalar_error(&space.volume, &d, |x| exact(x[0]));
            assert!(agree(error, expected), "{k} {nodes} {error:e} {expected:e}");
        }
    }
}
