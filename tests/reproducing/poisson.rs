//! ∇²u = (x² + z²) u with u = exp(xz) on the unit square, whose boundary values are imposed in four ways.
//!
//! The case is that of Chen (2019), Meshfree viscoelastic modeling, M.Sc. thesis, Pennsylvania State University, ch.
//! 3; the expected numbers are an independent program's.

use impinge::space::{Form, Integration, Mesh, Reproducing, Side, Space, reproducing};

use super::linear::{Essential, System, poisson, prescribe_scalar, scalar_error, scalars};

fn exact(x: [f64; 3]) -> f64 {
    (x[0] * x[2]).exp()
}

fn space(nodes: usize, integration: Integration) -> Space {
    let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [nodes - 1, 0, nodes - 1]);
    reproducing(&mesh, Reproducing { integration, ..Reproducing::default() }).unwrap()
}

fn system(space: &Space) -> System {
    poisson(space, |x| -(x[0] * x[0] + x[2] * x[2]) * exact(x))
}

fn with(space: &Space, how: Essential) -> Vec<f64> {
    let mut system = system(space);
    prescribe_scalar(&mut system, space, how, exact);
    system.solve()
}

/// Multipliers that are linear between the nodes of the boundary.
fn multipliers(space: &Space, nodes: usize) -> Vec<f64> {
    let unknowns = nodes * nodes;
    let count = 4 * (nodes - 1);
    let mut system = system(space).bordered(count);
    let boundary = &space.boundary.samples;
    for p in 0..boundary.len() {
        let x = boundary.at[p];
        let along = match space.boundary.sides[p] {
            Side::Bottom => x[0],
            Side::Right => 1.0 + x[2],
            Side::Top => 3.0 - x[0],
            _ => 4.0 - x[2],
        };
        let place = along * (nodes - 1) as f64;
        let (before, part) = (place.floor() as usize, place.fract());
        let hats = [(unknowns + before, [1.0 - part]), (unknowns + (before + 1) % count, [part])];
        let values = scalars(boundary.row(p));
        system.add(boundary.weights[p], &values, &hats);
        system.add(boundary.weights[p], &hats, &values);
        system.load(boundary.weights[p], &hats, [exact(x)]);
    }
    system.solve()
}

fn transformation(space: &Space) -> Vec<f64> {
    let at_nodes = space.at_nodes.as_ref().unwrap();
    let row = |node: usize| at_nodes.row(node).iter().map(|v| (v.node as usize, v.value)).collect();
    let rows: Vec<Vec<(usize, f64)>> = (0..at_nodes.len()).map(row).collect();
    system(space).solve_transformed(&rows, |i| {
        let x = space.nodes[i];
        let is_outside = [x[0], x[2]].iter().any(|&x| x == 0.0 || x == 1.0);
        is_outside.then(|| exact(x))
    })
}

#[test]
fn four_ways_to_impose_boundary_values() {
    let expected = [
        ("multipliers", [8.30e-3, 1.10e-3, 2.04e-4, 3.89e-5]),
        ("penalty", [8.30e-3, 2.97e-3, 2.66e-4, 4.21e-5]),
        ("nitsche", [8.30e-3, 2.97e-3, 2.64e-4, 4.07e-5]),
        ("transformation", [1.59e-2, 1.55e-3, 2.61e-4, 4.85e-5]),
        ("small penalty", [7.89e-3, 1.11e-3, 6.6e-4, 6.6e-4]),
        ("nitsche, small penalty", [8.25e-3, 1.08e-3, 1.98e-4, 3.68e-5]),
    ];
    for (k, nodes) in [3, 6, 11, 21].into_iter().enumerate() {
        let space = space(nodes, Integration::Gauss(2));
        let fine = self::space(nodes, Integration::Gauss(5));
        for (way, expected) in expected {
            let d = match way {
                "multipliers" => multipliers(&space, nodes),
                "penalty" => with(&space, Essential::Penalty(1e5)),
                "nitsche" => with(&space, Essential::Nitsche(1e5)),
                "transformation" => transformation(&space),
                "small penalty" => with(&space, Essential::Penalty(1e3)),
                _ => with(&space, Essential::Nitsche(1e3)),
            };
            let error = scalar_error(&fine.volume, &d, exact);
            assert!((error / expected[k] - 1.0).abs() < 1e-2, "{way} {nodes} {error:e}");
        }
    }
}
