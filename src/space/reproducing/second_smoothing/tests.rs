use super::super::{Integration, Reproducing, reproducing};
use super::*;
use crate::space::{Mesh, Space};

const RADII: [f64; 3] = [2.0, 3.3, 5.0];

/// A box of uneven nodes and a circle or ball, each with the mean distance of nodes.
fn meshes() -> Vec<(Mesh, f64)> {
    let mut uneven = Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [8, 0, 8]);
    for (number, node) in uneven.nodes.iter_mut().enumerate() {
        let inside = |x: f64| x > 0.01 && x < 0.99;
        if inside(node[0]) && inside(node[2]) {
            node[0] += 0.03 * (number as f64).sin();
            node[2] += 0.03 * (2.0 * number as f64).cos();
        }
    }
    vec![
        (uneven, 0.125),
        (Mesh::of_ball(Form::Plane, 1.0, 3, 3, [false; 2]), 0.17),
        (Mesh::of_box(Form::Solid, [0.0; 3], [1.0, 0.75, 0.5], [4, 3, 2]), 0.25),
    ]
}

fn space(mesh: &Mesh, integration: Integration, smoothing: Option<f64>) -> Space {
    reproducing(mesh, Reproducing { integration, smoothing, ..Reproducing::default() }).unwrap()
}

fn each(mut test: impl FnMut(&Mesh, Integration, f64)) {
    for (mesh, spacing) in meshes() {
        for integration in [Integration::Scni, Integration::Nsni] {
            RADII.into_iter().for_each(|radius| test(&mesh, integration, radius * spacing));
        }
    }
}

/// The gradient of linear displacements is exact everywhere, corners included.
#[test]
fn linear_fields_keep_their_gradient() {
    each(|mesh, integration, radius| {
        let space = space(mesh, integration, Some(radius));
        for point in 0..space.volume.len() {
            let mut sums = [[0.0; 3]; 4];
            for value in space.volume.row(point) {
                let at = space.nodes[value.node as usize];
                for (sum, factor) in sums.iter_mut().zip([1.0, at[0], at[1], at[2]]) {
                    (0..3).for_each(|a| sum[a] += factor * value.gradient[a]);
                }
            }
            for &axis in mesh.form.axes() {
                for &other in mesh.form.axes() {
                    let wanted = if axis == other { 1.0 } else { 0.0 };
                    assert!((sums[axis + 1][other] - wanted).abs() < 1e-12, "{:?}", sums);
                }
                assert!(sums[0][axis].abs() < 1e-11, "{:?}", sums[0]);
            }
        }
    });
}

/// Patch test: constant stress balances with its tractions on the boundary at every node.
#[test]
fn constant_stress_balances() {
    each(|mesh, integration, radius| {
        let space = space(mesh, integration, Some(radius));
        let mut sums = vec![[0.0; 3]; space.nodes.len()];
        let mut size = 0.0_f64;
        for point in 0..space.volume.len() {
            for value in space.volume.row(point) {
                let own = value.gradient.map(|x| space.volume.weights[point] * x);
                (0..3).for_each(|a| sums[value.node as usize][a] += own[a]);
                size = size.max(own[0].abs());
            }
        }
        let boundary = &space.boundary;
        for point in 0..boundary.samples.len() {
            for value in boundary.samples.row(point) {
                let share = boundary.samples.weights[point] * value.value;
                let normal = boundary.normals[point];
                (0..3).for_each(|a| sums[value.node as usize][a] -= share * normal[a]);
            }
        }
        let most = sums.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(most < 1e-12 * size.max(1.0), "{integration:?} {most:e} {size}");
    });
}

/// Strain that changes linearly stays in the middle, and is smoothed within the radius of a boundary.
#[test]
fn linear_strain_stays_away_from_boundaries() {
    let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [2.0, 0.0, 2.0], [16, 0, 16]);
    let radius = 0.4;
    let [once, twice] =
        [None, Some(radius)].map(|smoothing| space(&mesh, Integration::Scni, smoothing));
    let strain = |space: &Space, point: usize| -> f64 {
        let of = |value: &Value| value.gradient[0] * space.nodes[value.node as usize][0].powi(2);
        space.volume.row(point).iter().map(of).sum()
    };
    let mut changed = 0.0_f64;
    for (point, at) in once.volume.at.iter().enumerate() {
        let difference = (strain(&twice, point) - strain(&once, point)).abs();
        // Cells within two supports of a boundary have neighbours of another size.
        let depth = [at[0], at[2]].iter().map(|x| x.min(2.0 - x)).fold(f64::INFINITY, f64::min);
        if depth > 2.3 * radius {
            assert!(difference < 2e-3, "{at:?} {difference:e}");
        }
        changed = changed.max(difference);
    }
    assert!(changed > 0.05, "{changed}");
}

/// A single displaced node strains a width of the material, whatever the distance of nodes.
#[test]
fn strain_spreads_over_the_radius() {
    let radius = 0.3;
    let widths = [40, 80].map(|count| {
        let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [2.0, 0.0, 0.2], [count, 0, count / 10]);
        let space = space(&mesh, Integration::Scni, Some(radius));
        // A crack at x = 1: all nodes beyond it move.
        let strain = |point: usize| -> f64 {
            let moved = |value: &&Value| space.nodes[value.node as usize][0] > 1.0 + 1e-9;
            space.volume.row(point).iter().filter(moved).map(|value| value.gradient[0]).sum()
        };
        let (mut sum, mut square) = (0.0, 0.0);
        for point in 0..space.volume.len() {
            sum += space.volume.weights[point] * strain(point);
            square += space.volume.weights[point] * strain(point).powi(2);
        }
        sum * sum / (0.2 * square)
    });
    assert!((widths[0] / widths[1] - 1.0).abs() < 0.1, "{widths:?}");
    assert!(widths[1] > radius && widths[1] < 2.0 * radius, "{widths:?}");
}
