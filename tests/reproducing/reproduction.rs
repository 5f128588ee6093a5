//! Functions reproduce the polynomials of their basis, with gradients, anywhere in a body.

use impinge::space::{
    Form, Functions, Integration, Kernel, Mesh, Refused, Reproducing, Row, Shape, reproducing,
};

use super::linear::{Random, perturb};

fn meshes() -> Vec<Mesh> {
    let mut meshes = vec![
        Mesh::of_box(Form::Plane, [-1.0, 0.0, -2.0], [1.0, 0.0, 0.0], [6, 0, 8]),
        Mesh::of_ball(Form::Plane, 1.0, 3, 3, [true, false]),
        Mesh::of_box(Form::Axisymmetric, [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [5, 0, 6]),
        Mesh::of_ball(Form::Axisymmetric, 1.0, 3, 3, [true, false]),
        Mesh::of_box(Form::Solid, [-1.0, -1.0, -1.0], [1.0, 1.0, 0.0], [5, 4, 5]),
        Mesh::of_ball(Form::Solid, 1.0, 2, 2, [true, true]),
    ];
    meshes.iter_mut().for_each(|mesh| perturb(mesh, 0.2));
    meshes
}

/// Places in cells: means of their corners with random positive weights.
fn places(mesh: &Mesh) -> Vec<[f64; 3]> {
    let mut random = Random::new();
    let place = |cell: &Vec<u32>| {
        let weights: Vec<f64> = cell.iter().map(|_| random.next() + 1.0).collect();
        let sum: f64 = weights.iter().sum();
        [0, 1, 2].map(|a| {
            let part = |(&node, w): (&u32, &f64)| w / sum * mesh.nodes[node as usize][a];
            cell.iter().zip(&weights).map(part).sum()
        })
    };
    mesh.cells.iter().map(place).collect()
}

#[test]
fn polynomials_up_to_the_order_of_the_basis() {
    let kinds = [
        (1, Kernel::CubicSpline, Shape::Box, 1.75),
        (1, Kernel::QuarticSpline, Shape::Round, 1.6),
        (2, Kernel::CubicSpline, Shape::Box, 2.75),
        (2, Kernel::QuarticSpline, Shape::Box, 3.0),
    ];
    for mesh in meshes() {
        for (basis, kernel, shape, support) in kinds {
            let settings = Reproducing { basis, kernel, shape, support, ..Reproducing::default() };
            let functions = Functions::of(&mesh, settings).unwrap();
            let axes = mesh.form.axes();
            let mut row = Row::default();
            for at in places(&mesh).into_iter().chain(mesh.nodes.clone()) {
                functions.evaluate(at, true, &mut row).unwrap();
                assert!(row.nodes.is_sorted());
                let on_plane =
                    [0, 1].map(|a| at[a] == 0.0 && mesh.nodes.iter().all(|x| x[a] >= 0.0));
                let sum = |of: &dyn Fn([f64; 3]) -> f64| -> [f64; 4] {
                    let mut sums = [0.0; 4];
                    for value in row.values() {
                        let p = of(mesh.nodes[value.node as usize]);
                        sums[0] += value.value * p;
                        (0..3).for_each(|k| sums[1 + k] += value.gradient[k] * p);
                    }
                    sums
                };
                let check = |found: [f64; 4], value: f64, gradient: [f64; 3]| {
                    assert!(
                        (found[0] - value).abs() < 1e-12,
                        "{settings:?} {at:?} {found:?} {value}"
                    );
                    for k in 0..3 {
                        // Across a plane of symmetry there are no derivatives.
                        let expected = if k < 2 && on_plane[k] { 0.0 } else { gradient[k] };
                        assert!(
                            (found[1 + k] - expected).abs() < 2e-10,
                            "{settings:?} {at:?} {found:?}"
                        );
                    }
                };
                let unit =
                    |k: usize, value: f64| [0, 1, 2].map(|a| if a == k { value } else { 0.0 });
                check(sum(&|_| 1.0), 1.0, [0.0; 3]);
                for &a in axes {
                    check(sum(&|x| x[a]), at[a], unit(a, 1.0));
                    for &b in axes.iter().filter(|_| basis == 2) {
                        let gradient = [0, 1, 2].map(|k| unit(a, at[b])[k] + unit(b, at[a])[k]);
                        check(sum(&|x| x[a] * x[b]), at[a] * at[b], gradient);
                    }
                }
            }
        }
    }
}

#[test]
fn gradients_are_differences_of_values() {
    for mesh in meshes() {
        for (basis, shape, support) in
            [(1, Shape::Round, 1.6), (1, Shape::Box, 1.75), (2, Shape::Box, 2.75)]
        {
            let settings = Reproducing { basis, shape, support, ..Reproducing::default() };
            let functions = Functions::of(&mesh, settings).unwrap();
            let values = |at: [f64; 3]| {
                let mut values = vec![0.0; mesh.nodes.len()];
                let mut row = Row::default();
                functions.evaluate(at, false, &mut row).unwrap();
                row.values().for_each(|value| values[value.node as usize] = value.value);
                values
            };
            for at in places(&mesh).into_iter().step_by(7) {
                let mut row = Row::default();
                functions.evaluate(at, true, &mut row).unwrap();
                for &a in mesh.form.axes() {
                    let step = 1e-5;
                    let moved = [-step, step].map(|step| {
                        let mut at = at;
                        at[a] += step;
                        values(at)
                    });
                    for value in row.values() {
                        let n = value.node as usize;
                        let difference = (moved[1][n] - moved[0][n]) / (2.0 * step);
                        assert!(
                            (difference - value.gradient[a]).abs() < 1e-5,
                            "{settings:?} {at:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Kernels that end at a plane leave little weight near it; functions stay accurate all the same.
#[test]
fn polynomials_next_to_planes_of_symmetry() {
    let mut mesh = Mesh::of_ball(Form::Axisymmetric, 1.0, 3, 3, [true, false]);
    perturb(&mut mesh, 0.2);
    let settings = Reproducing { basis: 2, support: 2.75, ..Reproducing::default() };
    let functions = Functions::of(&mesh, settings).unwrap();
    let mut row = Row::default();
    for (r, limit) in [(1e-2, 1e-11), (1e-4, 1e-9), (1e-6, 1e-7), (0.0, 1e-13)] {
        for n in 0..20 {
            let at = [r, 0.0, -0.95 + 0.1 * f64::from(n)];
            functions.evaluate(at, true, &mut row).unwrap();
            let mut sums = [0.0; 3];
            for value in row.values() {
                let x = mesh.nodes[value.node as usize];
                sums[0] += value.value * x[0] * x[2];
                sums[1] += value.gradient[0] * x[0] * x[2];
                sums[2] += value.value * x[2] * x[2];
            }
            assert!((sums[0] - r * at[2]).abs() < limit, "{at:?} {sums:?}");
            assert!(r == 0.0 || (sums[1] - at[2]).abs() < 1e5 * limit, "{at:?} {sums:?}");
            assert!((sums[2] - at[2] * at[2]).abs() < limit, "{at:?} {sums:?}");
        }
    }
}

#[test]
fn functions_of_other_nodes_vanish_on_planes_of_symmetry() {
    let mut mesh = Mesh::of_ball(Form::Solid, 1.0, 2, 2, [true, true]);
    perturb(&mut mesh, 0.2);
    let space = reproducing(&mesh, Reproducing::default()).unwrap();
    let rows = space.at_nodes.unwrap();
    let mut planes = 0;
    for (n, at) in mesh.nodes.iter().enumerate() {
        for a in (0..2).filter(|&a| at[a] == 0.0) {
            planes += 1;
            assert!(rows.row(n).iter().all(|value| mesh.nodes[value.node as usize][a] == 0.0));
        }
    }
    assert!(planes > 40);
}

#[test]
fn lumped_volumes_are_positive_and_sum_to_the_volume() {
    for mesh in meshes() {
        for (basis, support) in [(1, 1.75), (2, 2.75)] {
            for integration in [Integration::Gauss(2), Integration::Scni, Integration::Nsni] {
                let settings =
                    Reproducing { basis, support, integration, ..Reproducing::default() };
                let space = reproducing(&mesh, settings).unwrap();
                let volume: f64 = space.volume.weights.iter().sum();
                assert!(space.shares.iter().all(|&share| share > 0.0));
                assert!((space.shares.iter().sum::<f64>() / volume - 1.0).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn too_small_supports_are_refused_with_place_and_remedy() {
    let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 0.1], [8, 0, 1]);
    let settings = Reproducing { basis: 2, support: 2.5, ..Reproducing::default() };
    let refused = reproducing(&mesh, settings).unwrap_err();
    assert!(matches!(refused, Refused::FewNeighbours { neighbours: 6.., terms: 6, .. }));
    let text = refused.to_string();
    assert!(
        text.contains("raise `support` above 2.5") && text.contains("nodes that reach ("),
        "{text}"
    );

    // With two spacings, the third node from an end does not reach it.
    let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [10.0, 0.0, 10.0], [10, 0, 10]);
    let refused = |support: f64| {
        reproducing(&mesh, Reproducing { basis: 2, support, ..Reproducing::default() }).err()
    };
    assert!(matches!(refused(2.0), Some(Refused::Setting(_))));
    assert!(matches!(refused(2.0001), Some(Refused::FewNeighbours { .. })));
    assert_eq!(refused(2.1), None);
    for (basis, support, integration) in [
        (3, 4.0, Integration::Scni),
        (1, f64::NAN, Integration::Scni),
        (1, 2.0, Integration::Gauss(0)),
    ] {
        let settings = Reproducing { basis, support, integration, ..Reproducing::default() };
        assert!(matches!(reproducing(&mesh, settings), Err(Refused::Setting(_))));
    }
}
