//! Uniform strain is exact, rotation costs no energy, and tangents are derivatives, on any mesh.

use super::tangent::{Linearised, Stiffness, Terms};
use super::*;
use crate::laws::solid::large_strain::{Deviator, LargeStrainLaw, MaxwellBranch, Relaxing};
use crate::math::matrix3::{IDENTITY, Matrix3};
use crate::space::{Form, Mesh, finite_elements};

fn law() -> LargeStrainLaw {
    let branches = vec![MaxwellBranch { fraction: 0.6, time: 0.1 }];
    let deviator = Deviator::Relaxing(Relaxing { branches });
    LargeStrainLaw { bulk: 5.0, shear: 2.0, deviator }
}

pub(super) fn bodies() -> Vec<Deformable> {
    let meshes = [
        Mesh::of_ball(Form::Plane, 1.0, 2, 2, [false; 2]),
        Mesh::of_ball(Form::Axisymmetric, 1.0, 2, 2, [true, false]),
        Mesh::of_ball(Form::Solid, 1.0, 2, 1, [false; 2]),
        Mesh::of_cylinder(1, [1.0, 0.5], [2, 1, 2], [false; 2]),
        Mesh::of_box(Form::Solid, [-1.0, -1.0, -1.0], [1.0, 1.0, 0.0], [3, 2, 2]),
        Mesh::of_ball_by((Form::Plane, 2), 1.0, [1, 1], [false; 2]),
        Mesh::of_ball_by((Form::Axisymmetric, 2), 1.0, [1, 1], [true, false]),
        Mesh::of_ball_by((Form::Solid, 2), 1.0, [1, 1], [false; 2]),
    ];
    let body = |mesh| Deformable::new(finite_elements(&mesh), law(), 1.0, [false; 2], 1);
    let section = Mesh::of_ball(Form::Plane, 1.0, 2, 2, [false; 2]);
    let alone = finite_elements(&section).with_points_alone();
    let sheet = Deformable::new(alone, law(), 1.0, [false; 2], 1).of_sheet();
    meshes.into_iter().map(body).chain([sheet]).collect()
}

/// Displacements under which the deformation gradient is uniform.
pub(super) fn uniform(body: &Deformable, gradient: &Matrix3) -> Vec<[f64; 3]> {
    let moved = |at: &[f64; 3]| {
        [0, 1, 2].map(|a| (0..3).map(|b| gradient[a][b] * at[b]).sum::<f64>() - at[a])
    };
    let mut u: Vec<[f64; 3]> = body.space.nodes.iter().map(moved).collect();
    body.flatten(&mut u);
    u
}

/// A gradient that the form of a body allows.
pub(super) fn allowed(form: Form) -> Matrix3 {
    match form {
        Form::Plane => [[1.3, 0.0, 0.4], [0.0, 1.0, 0.0], [-0.2, 0.0, 0.8]],
        Form::Axisymmetric => [[1.2, 0.0, 0.0], [0.0, 1.2, 0.0], [0.0, 0.0, 0.7]],
        Form::Solid => [[1.2, 0.3, -0.1], [0.1, 0.8, 0.2], [-0.2, 0.1, 1.1]],
    }
}

#[test]
fn uniform_strain_is_exact() {
    for body in bodies() {
        let team = &body.team();
        let gradient = allowed(body.space.form);
        let u = uniform(&body, &gradient);
        for point in 0..body.space.volume.len() {
            let found = body.gradient(&body.space.volume, point, &u);
            for n in 0..9 {
                let (found, wanted) = (found[n / 3][n % 3], gradient[n / 3][n % 3]);
                assert!((found - wanted).abs() < 1e-13, "{:?}", body.space.form);
            }
        }
        // Nodes inside bear no force.
        let mut history = vec![0.0; body.history()];
        let stresses =
            body.respond(&u, &body.in_all(Course::of(0.01)), &mut history, team).unwrap();
        let forces = body.forces(&stresses, team);
        let mut outside = vec![false; body.nodes()];
        let boundary = &body.space.boundary.samples;
        for point in 0..boundary.len() {
            boundary.row(point).iter().for_each(|value| outside[value.node as usize] = true);
        }
        let is_inside = |&(node, _): &(usize, &[f64; 3])| {
            let on_axis = body.space.form == Form::Axisymmetric && body.fixed[node][0];
            !outside[node] && !on_axis
        };
        let most = forces.iter().flatten().fold(0.0, |most: f64, f| most.max(f.abs()));
        for (node, force) in forces.iter().enumerate().filter(is_inside) {
            let rest = force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
            // The hoop stress of a ring is in equilibrium with its neighbours up to quadrature.
            let round = body.space.form == Form::Axisymmetric;
            let tolerance = if round { 0.02 } else { 1e-13 };
            assert!(rest < tolerance * most, "{:?} {node} {rest:e}", body.space.form);
        }
        let flat = body.space.form != Form::Solid;
        for axis in
            (0..3).filter(|&axis| !(flat && axis == 1) && body.space.form != Form::Axisymmetric)
        {
            let sum: f64 = forces.iter().map(|force| force[axis]).sum();
            assert!(sum.abs() < 1e-12 * most, "{sum:e}");
        }
    }
}

#[test]
fn rotation_costs_no_energy() {
    for body in bodies().into_iter().filter(|body| body.space.form != Form::Axisymmetric) {
        let (s, c) = 2.0_f64.sin_cos();
        let turn = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]];
        let team = &body.team();
        let mut history = vec![0.0; body.history()];
        let stresses = body
            .respond(&uniform(&body, &turn), &body.in_all(Course::of(0.1)), &mut history, team)
            .unwrap();
        assert!(stresses.energy.abs() < 1e-13);
        assert!(body.forces(&stresses, team).iter().flatten().all(|f| f.abs() < 1e-13));
    }
}

#[test]
fn the_stiffness_is_the_derivative_of_the_forces() {
    for body in bodies() {
        let team = &body.team();
        let mut before = vec![0.0; body.history()];
        let over = &body.in_all(Course { time: 0.05, stretch: 1.2, growth: 0.0 });
        let half = |a: usize, b: usize| 0.5 * (IDENTITY[a][b] + allowed(body.space.form)[a][b]);
        let gradient = std::array::from_fn(|a| std::array::from_fn(|b| half(a, b)));
        body.respond(&uniform(&body, &gradient), over, &mut before, team).unwrap();
        let mut u = uniform(&body, &allowed(body.space.form));
        u.iter_mut().enumerate().for_each(|(n, u)| u[2] += 0.02 * (n as f64).sin());
        let forces = |u: &[[f64; 3]]| {
            let mut history = before.clone();
            let stresses = body.respond(u, over, &mut history, team).unwrap();
            body.forces(&stresses, team)
        };
        let (deformations, dilatations) = body.deformations(&u, (over, &before), team);
        let state = Linearised { deformations, dilatations, before: &before, over };
        // Held, so that the stiffness has an inverse.
        let mut held = body.fixed.clone();
        held[0] = [true; 3];
        held[1] = [true; 3];
        held[2] = [true; 3];
        let stiffness = Stiffness::new(&body, &held, &[]).unwrap();
        let of_group = &|group| state.group(&body, group);
        let terms = Terms { of_group, inertia: 0.0, loads: &[], is_symmetric: true };
        let factor = stiffness.factor(&body, &terms, team).unwrap();
        let mut change: Vec<[f64; 3]> = (0..body.nodes())
            .map(|n| [(1.3 * n as f64).sin(), (2.1 * n as f64).cos(), (0.7 * n as f64).sin()])
            .collect();
        for (change, held) in change.iter_mut().zip(&held) {
            (0..3).filter(|&a| held[a]).for_each(|a| change[a] = 0.0);
        }
        let moved = |by: f64| {
            let add = |(u, v): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|a| u[a] + by * v[a]);
            forces(&u.iter().zip(&change).map(add).collect::<Vec<_>>())
        };
        let (up, down) = (moved(1e-6), moved(-1e-6));
        let slope: Vec<[f64; 3]> =
            up.iter().zip(&down).map(|(a, b)| [0, 1, 2].map(|n| -(a[n] - b[n]) / 2e-6)).collect();
        let found = stiffness.solve(&factor, &slope);
        let error = found.iter().flatten().zip(change.iter().flatten());
        let error = error.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 2e-6, "{:?} {error:e}", body.space.form);
    }
}

/// Two stretches that change their signs leave the dilatation as it was.
#[test]
fn bodies_that_pass_through_their_planes_are_found() {
    let mesh = Mesh::of_box(Form::Solid, [0.0, 0.0, -1.0], [1.0, 1.0, 0.0], [2, 2, 2]);
    for mirrored in [[false; 2], [true, false], [true; 2]] {
        let body = Deformable::new(finite_elements(&mesh), law(), 1.0, mirrored, 1);
        let turned = uniform(&body, &[[-0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(through_mirror(&body, &turned).is_some(), mirrored[0], "{mirrored:?}");
        let narrow = uniform(&body, &[[0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(through_mirror(&body, &narrow), None);
    }
}
