//! Pressures have the resultant of their surface, and their stiffness is a derivative.

use super::super::tests::{allowed, bodies, uniform};
use super::*;

/// A body whose whole surface is a loaded face, with displacements that are not uniform.
fn pressed() -> Vec<(Deformable, LoadedFaces, Vec<[f64; 3]>)> {
    let with_face = |body: Deformable| {
        let loaded = LoadedFaces::new(&body, &[&|_| true]);
        let mut u = uniform(&body, &allowed(body.space.form));
        u.iter_mut().enumerate().for_each(|(n, u)| u[2] += 0.02 * (n as f64).sin());
        (body, loaded, u)
    };
    bodies().into_iter().map(with_face).collect()
}

fn forces(
    body: &Deformable,
    loaded: &LoadedFaces,
    u: &[[f64; 3]],
    load: FaceLoad,
) -> Vec<[f64; 3]> {
    let mut forces = vec![[0.0; 3]; u.len()];
    loaded.add_forces(body, u, &[load], &mut forces);
    forces
}

#[test]
fn uniform_pressure_has_no_resultant_and_works_on_the_volume() {
    let pressure = FaceLoad { pressure: 2.0, traction: [0.0; 3] };
    for (body, loaded, u) in pressed() {
        let found = forces(&body, &loaded, &u, pressure);
        for &axis in body.space.form.axes() {
            // The force of a ring has no resultant along its radius.
            if axis == 2 || body.space.form != Form::Axisymmetric {
                let sum: f64 = found.iter().map(|force| force[axis]).sum();
                assert!(sum.abs() < 1e-12, "{:?} {axis} {sum:e}", body.space.form);
            }
        }
        if body.space.form == Form::Axisymmetric {
            continue;
        }
        // Σ f · x = −p dim V of what surrounds the volume of the deformed body.
        let uniform = uniform(&body, &allowed(body.space.form));
        let found = forces(&body, &loaded, &uniform, pressure);
        let places = body.space.nodes.iter().zip(&uniform);
        let moment = found
            .iter()
            .zip(places)
            .map(|(f, (at, u))| (0..3).map(|a| f[a] * (at[a] + u[a])).sum::<f64>());
        let dilatation = crate::math::matrix3::inverse(&allowed(body.space.form)).1;
        let volume = dilatation * body.space.volume.weights.iter().sum::<f64>();
        let dimensions = body.space.form.axes().len() as f64;
        let error = moment.sum::<f64>() / (-2.0 * dimensions * volume) - 1.0;
        assert!(error.abs() < 2e-2, "{:?} {error:e}", body.space.form);
    }
}

#[test]
fn load_stiffness_is_the_derivative_of_the_forces() {
    let load = FaceLoad { pressure: 2.0, traction: [0.3, 0.0, -0.7] };
    for (body, loaded, u) in pressed() {
        let change: Vec<[f64; 3]> =
            (0..u.len()).map(|n| [(1.3 * n as f64).sin(), 0.0, (0.7 * n as f64).sin()]).collect();
        let moved = |by: f64| {
            let add = |(u, v): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|a| u[a] + by * v[a]);
            let u: Vec<[f64; 3]> = u.iter().zip(&change).map(add).collect();
            forces(&body, &loaded, &u, load)
        };
        let (up, down) = (moved(1e-6), moved(-1e-6));
        let mut found = vec![[0.0; 3]; u.len()];
        for LoadStiffness { nodes, matrix } in loaded.stiffness(&body, &u, &[load], 1.0) {
            let width = 3 * nodes.len();
            for (a, &row) in nodes.iter().enumerate() {
                for (b, &column) in nodes.iter().enumerate() {
                    for (i, c) in (0..9).map(|n| (n / 3, n % 3)) {
                        let entry = matrix[(3 * a + i) * width + 3 * b + c];
                        found[row as usize][i] -= entry * change[column as usize][c];
                    }
                }
            }
        }
        for (node, found) in found.iter().enumerate() {
            for a in 0..3 {
                let slope = (up[node][a] - down[node][a]) / 2e-6;
                assert!((found[a] - slope).abs() < 1e-8, "{:?} {node}", body.space.form);
            }
        }
    }
}
